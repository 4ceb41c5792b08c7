"""The style, the size and the files of figures."""

import io
import itertools
import math
import re
from collections.abc import Generator, Iterable, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from pathlib import Path
from threading import RLock
from typing import Any, Literal, TypeVar

import numpy as np
from matplotlib import rc_context, rcParams, rcParamsDefault
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.colors import is_color_like, to_hex, to_rgb, to_rgba
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FixedFormatter, Formatter

from rockflex.foundation.checks import is_one_of
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path, write_given_file
from rockflex.foundation.language import Language, chosen_language, translated, use_language
from rockflex.foundation.number_format import unit_with_prefix
from rockflex.foundation.shown import shown
from rockflex.foundation.units import (
    QUANTITIES,
    Decimal,
    SystemName,
    Unit,
    UnitSystem,
    checked_unit_system,
    named_unit,
    with_decimal_commas,
)

# Okabe & Ito's palette, which colour-blind readers can tell apart.
BLACK, GRAY, GREEN, RED = "#000000", "#8c8c8c", "#009e73", "#d55e00"
BLUE, ORANGE, SKY, PURPLE, YELLOW = "#0072b2", "#e69f00", "#56b4e9", "#cc79a7", "#f0e442"
SHADE = "#e9edf2"
SMALL = "small"  # letters of notes, relative to font.size
_FONT = 9.0
MAX_LEGEND_COLUMNS = 8
NOTEBOOK_DPI, PIXEL_RATIO = 100, 2  # points of a notebook an inch, and dots a point: sharp on screens of many dots

_STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": _FONT,
    "axes.labelsize": 9.0,
    "axes.titlesize": 9.0,
    "axes.linewidth": 0.7,
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.unicode_minus": True,
    "figure.facecolor": "white",
    "grid.color": "#d9d9d9",
    "grid.linewidth": 0.5,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "lines.linewidth": 1.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "mathtext.fontset": "dejavusans",
    "path.simplify": True,
    "pdf.fonttype": 42,
    "savefig.bbox": "standard",
    "svg.hashsalt": "rockflex",
}
_INK, _DARK_GROUND = "#d7dbe0", "#14181d"
_DARK: dict[Any, Any] = _STYLE | {
    "axes.edgecolor": _INK,
    "axes.facecolor": _DARK_GROUND,
    "axes.labelcolor": _INK,
    "figure.facecolor": _DARK_GROUND,
    "grid.color": "#39414a",
    "text.color": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
}
# Black on white without a grid, in the letters that journals ask for.
_JOURNAL: dict[Any, Any] = _STYLE | {"axes.grid": False, "axes.linewidth": 0.5}
Theme = Literal["light", "dark", "journal"]
THEMES: dict[str, dict[Any, Any]] = {"light": _STYLE, "dark": _DARK, "journal": _JOURNAL}
_LOCK = RLock()
# A date in the file would make equal figures differ.
_UNDATED: dict[str, dict[str, Any]] = {".png": {}, ".pdf": {"CreationDate": None}, ".svg": {"Date": None}}
_DPI = 200


_T = TypeVar("_T")


@dataclass(frozen=True)
class LineStyle:
    """Colour and line style of one curve."""

    color: str
    dashes: str | tuple[int, tuple[float, ...]]
    width: float = 1.0

    @property
    def look(self) -> dict[str, Any]:
        """Colour and line style as keywords of matplotlib."""
        return {"color": self.color, "linestyle": self.dashes}


_DASHES = ("-", (0, (6, 2)), (0, (1, 1)), (0, (6, 1, 1, 1, 1, 1)))
LINE_STYLES = tuple(LineStyle(color, dashes) for dashes in _DASHES for color in (PURPLE, ORANGE, SKY))
"""Line styles of models without a fixed style, the most distinct first; blue is left to reference lines."""
ALTERNATIVE_STYLES = tuple(
    LineStyle(color, dashes)
    for color, dashes in zip(
        (BLACK, RED, GREEN, PURPLE, ORANGE, SKY),
        ("-", (0, (6, 2)), (0, (1, 1)), (0, (6, 1, 1, 1)), (0, (3, 1)), (0, (6, 1, 1, 1, 1, 1))),
        strict=True,
    )
)
"""Line styles of alternatives, which colours and dashes tell apart."""


Lines = Sequence[tuple[str, str]]
"""Colour and line style of each curve as matplotlib writes them, such as ``("black", "-")``."""
_NAMED = {"black": BLACK, "gray": GRAY, "green": GREEN, "red": RED, "blue": BLUE, "orange": ORANGE}
_LINES = ("-", "--", "-.", ":")


def given_line_styles(lines: Lines, count: int) -> list[LineStyle]:
    """Return the line styles that a caller gives; plain names are colours that colour-blind readers can tell apart."""
    if len(lines) != count or not all(is_color_like(color) and style in _LINES for color, style in lines):
        raise InputError(
            f"lines must be {count} pairs of a colour and one of {', '.join(_LINES)}, one per response, such as "
            f'("black", "-"), but {shown(lines)} was given.'
        )
    return [LineStyle(_NAMED.get(color, color), style) for color, style in lines]


Size = Literal["column", "page"] | tuple[float, float]
"""Size of a figure: the width of a journal's column or page, or width and height in inches."""

_WIDTHS = {"column": 3.5, "page": 7.2}  # inches
_NARROW = 4.6  # inches of width below which panels are stacked
_COLUMN_FONT, _LEAST_FONT = 8.0, 7.0  # as journals ask
_FONT_SIZES = ("font.size", "axes.labelsize", "axes.titlesize", "legend.fontsize", "xtick.labelsize", "ytick.labelsize")
_SAVED = ("savefig.bbox", "svg.hashsalt", "pdf.fonttype", "path.simplify")  # so that equal figures give equal files
_DARK_BRIGHTNESS = 0.5  # brightness of a background on which ink is dark

_CHOSEN: ContextVar[tuple[Theme, Size | None]] = ContextVar("chosen", default=("light", None))
_UNITS: ContextVar[UnitSystem | None] = ContextVar("units", default=None)
_SIZE: ContextVar[tuple[float, float | None] | None] = ContextVar("size", default=None)
_DRAWN: ContextVar[list[Figure] | None] = ContextVar("drawn", default=None)


@contextmanager
def figure_style(
    theme: Theme = "light",
    size: Size | None = None,
    *,
    units: SystemName | None = None,
    language: Language | None = None,
    decimal: Decimal | None = None,
) -> Generator[None, None, None]:
    """Draw all figures of a block in a theme and a size; a function's own `size` comes first.

    What is set in matplotlib's ``rcParams`` is kept.

    Parameters
    ----------
    theme
        ``"light"``; ``"dark"``, for screens and slides; or ``"journal"``: letters of 8 points, thin axes, no grid.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.
    units
        Units of responses over time, loops, sets of records, motions, target spectra, shapes of modes and designs:
        ``"kN"``, ``"MN"``, ``"SI"`` or ``"kip-in"``, as in `write_report`. Default: SI units, of forces with the prefix
        that suits their size. Fits and measures of intensity stay in SI units.
    language
        Language of all figures: ``"en"``, ``"de"``, ``"it"``, ``"fr"`` or ``"es"``. Default: English.
    decimal
        Decimal sign of numbers, ``"."`` or ``","``. Default: that of the language.

    Raises
    ------
    InputError
        If there is no such theme, size, system of units, language or sign.

    Examples
    --------
    >>> import rockflex as rf
    >>> with rf.figure_style("journal", "column"):
    ...     figure = rf.plot_motion(rf.ricker_pulse(4.0, 0.6))
    >>> float(figure.get_size_inches()[0])
    3.5
    """
    if not is_one_of(theme, THEMES):
        raise InputError(
            f"theme must be one of {', '.join(map(repr, THEMES))}, but {shown(theme)} was given.", field="theme"
        )
    _figure_size_in_inches(size)
    with use_language(language, decimal), figures_in_units(None if units is None else checked_unit_system(units)):
        token = _CHOSEN.set((theme, size))
        try:
            yield
        finally:
            _CHOSEN.reset(token)


@contextmanager
def figures_in_units(units: UnitSystem | None) -> Generator[None, None, None]:
    """Draw the figures of a block in a system of units; None for those of the block around."""
    token = _UNITS.set(units or _UNITS.get())
    try:
        yield
    finally:
        _UNITS.reset(token)


def chosen_units() -> UnitSystem | None:
    """Return the system of units of figures, if one is chosen."""
    return _UNITS.get()


def symbol_in_mathematics(symbol: str) -> str:
    """Return a symbol in the chosen language, its words with subscripts in mathematics: "u_top total"."""
    words = (re.sub(r"_([^\W_]{2,}+)", r"_{\\mathrm{\1}}", word) for word in translated(symbol).split(" "))
    return " ".join(f"${word}$" if "_" in word else word for word in words)


def axis_unit(quantity: str, largest: float = 0.0, usual: str = "") -> Unit:
    """Return the unit of an axis: of the chosen system, or the usual one, or of SI with a prefix for the largest."""
    chosen, base = _UNITS.get(), QUANTITIES[quantity][2]
    if chosen is not None:
        return chosen.of(quantity, largest=largest)
    if usual:
        return named_unit(usual)
    return Unit(*unit_with_prefix(largest, base)) if base[0] in "NJP" else Unit(1.0, base)


@contextmanager
def applied_figure_style(size: Size | None = None) -> Generator[None, None, None]:
    """Apply the style while a figure is drawn; matplotlib's settings are global, so one thread at a time."""
    theme, usual_size = _CHOSEN.get()
    inches = _figure_size_in_inches(usual_size if size is None else size)
    with _LOCK:
        small = theme == "journal" or (inches is not None and inches[0] < _NARROW)
        usual = _COLUMN_FONT if small else _FONT
        font = rcParams["font.size"] if _is_style_set_by_caller("font.size") else usual
        lines, marks = (
            rcParams[name] if _is_style_set_by_caller(name) else None
            for name in ("lines.linewidth", "lines.markersize")
        )
        settings: dict[Any, Any] = {
            name: value for name, value in THEMES[theme].items() if name in _SAVED or not _is_style_set_by_caller(name)
        }
        settings |= {name: settings[name] * font / _FONT for name in _FONT_SIZES if name in settings}
        settings["lines.linewidth"] = _STYLE["lines.linewidth"]  # _rescale applies the settings of the caller
        with rc_context(settings):
            figures: list[Figure] = []
            tokens = _SIZE.set(inches), _DRAWN.set(figures)
            try:
                yield
            finally:
                _SIZE.reset(tokens[0])
                _DRAWN.reset(tokens[1])
            for figure in figures:
                _rescale_lines(figure, lines, marks)
                if sum(to_rgb(rcParams["axes.facecolor"])) / 3.0 < _DARK_BRIGHTNESS:
                    _invert_figure_colors(figure)
                for text in figure.findobj(Text) if small and font == usual else ():
                    text.set_fontsize(max(text.get_fontsize(), _LEAST_FONT))  # pyright: ignore
                if chosen_language()[1] == ",":
                    _write_decimal_commas(figure)
                if inches is not None or font != _FONT:
                    _wrap_figure_texts(figure)


def _is_style_set_by_caller(name: Any) -> bool:
    """Whether the caller has set one of matplotlib's settings."""
    return bool(rcParams[name] != rcParamsDefault[name])


def _figure_size_in_inches(size: Size | None) -> tuple[float, float | None] | None:
    """Width and height asked for; the height is None where the figure chooses it."""
    if size is None:
        return None
    if isinstance(size, str):
        if size in _WIDTHS:
            return _WIDTHS[size], None
    else:
        try:
            width, height = (float(each) for each in size)
        except (TypeError, ValueError):
            width = height = math.nan
        if 0.0 < width < math.inf and 0.0 < height < math.inf:
            return width, height
    raise InputError(
        f'size must be "column" (3.5 in wide), "page" (7.2 in wide) or (width, height) in inches, both positive, but '
        f"{shown(size)} was given."
    )


def literal_text(text: str) -> str:
    """Escape names so that they are not read as mathematics."""
    return text.replace("$", r"\$")


class NotebookFigure(Figure):
    """A figure that a notebook shows when it is the last expression of a cell, without pyplot and without a magic.

    Where matplotlib's inline backend is active, its own way of showing figures comes first, so none is shown twice.
    Labels of ticks are made when the figure is drawn, so it is drawn with the settings it was made with.
    """

    settings: dict[Any, Any]

    def draw(self, renderer: RendererBase) -> None:
        """Draw with the settings with which the figure was made."""
        with _LOCK, rc_context(self.settings):
            super().draw(renderer)

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        content = io.BytesIO()
        with applied_figure_style():
            self.savefig(content, format="png", dpi=PIXEL_RATIO * NOTEBOOK_DPI)
        width, height = (round(NOTEBOOK_DPI * inches) for inches in self.get_size_inches())
        return content.getvalue(), {"width": width, "height": height}


def new_figure(width: float, height: float) -> Figure:
    """Empty figure, without a window or an entry in the global list of figures.

    Width and height in inches are those of a figure for which the caller has asked for no size.
    """
    asked = _SIZE.get()
    if asked is not None:
        width, height = asked[0], asked[1] or height
    figure = NotebookFigure(figsize=(width, height), layout="constrained")
    figure.settings = {name: rcParams[name] for name in _DARK}
    drawn = _DRAWN.get()
    if drawn is not None:
        drawn.append(figure)
    return figure


def is_narrow() -> bool:
    """Whether the caller has asked for a figure so narrow that panels must be stacked."""
    asked = _SIZE.get()
    return asked is not None and asked[0] < _NARROW


def is_height_given() -> bool:
    """Whether the caller has asked for a height of the figure."""
    return (_SIZE.get() or (None, None))[1] is not None


def scaled_font_size(size: float) -> float:
    """Size of letters in points that is `size` in a figure with letters of 9 points."""
    return size * rcParams["font.size"] / _FONT


def recoloured_line_styles(styles: Iterable[LineStyle]) -> list[LineStyle]:
    """Line styles in the colours of the caller's own cycle (``axes.prop_cycle``), if there is one."""
    cycle = rcParams["axes.prop_cycle"].by_key().get("color") if _is_style_set_by_caller("axes.prop_cycle") else None
    if not cycle:
        return list(styles)
    return [replace(style, color=color) for style, color in zip(styles, itertools.cycle(cycle), strict=False)]


def assign_distinct(names: Sequence[Any], among: Sequence[_T], what: str) -> dict[Any, _T]:
    """Give each name one of some line styles or symbols; `what` says in the plural what the names are of."""
    if len(names) > len(among):
        raise InputError(
            f"{len(names)} {what} are too many to distinguish in one figure, which can show {len(among)}. Plot fewer "
            "at a time."
        )
    return dict(zip(names, among, strict=False))


def label_panel(axes: Axes, text: str) -> None:
    """Panel letter outside the axes, left of their upper corner."""
    axes.annotate(
        text, (0.0, 1.0), xytext=(-46, 1), xycoords="axes fraction", textcoords="offset points", weight="bold", va="top"
    )


def add_legend_above(
    figure: Figure,
    handles: Sequence[Artist],
    labels: Sequence[str] | None = None,
    *,
    title: str = "",
    title_size: float | str = "medium",
    max_columns: int = MAX_LEGEND_COLUMNS,
    **options: Any,
) -> None:
    """Add the legend of a figure above its panels, in as many columns as its width holds; it fills column by column."""
    names = [str(handle.get_label()) for handle in handles] if labels is None else list(labels)
    for count in range(min(len(names), max_columns), 0, -1):
        legend = figure.legend(handles, names, loc="outside upper center", ncols=count, **options)
        if count == 1 or legend.get_window_extent().width <= figure.bbox.width:
            legend.set_title(title or None, prop={"size": title_size})  # pyright: ignore[reportArgumentType]
            return
        legend.remove()


def add_legend_beside(figure: Figure, handles: Sequence[Artist]) -> None:
    """Add the legend of a figure to the right of its panels, or above them in a narrow one."""
    if is_narrow():
        add_legend_above(figure, handles)
    else:
        figure.legend(handles=handles, loc="outside right upper")


def write_notes_beside(axes: Axes, notes: list[tuple[str, str]], step: float) -> None:
    """Write lines of text in their colours to the right of a panel, `step` points apart."""
    for row, (text, color) in enumerate(notes):
        axes.annotate(
            text, (1.0, 1.0), xytext=(5.0, -1.0 - step * row), xycoords="axes fraction", textcoords="offset points",
            color=color, fontsize=SMALL, va="top", annotation_clip=False,
        )  # fmt: skip


def _rescale_lines(figure: Figure, width: float | None, mark: float | None) -> None:
    """Scale line widths and marker sizes by the ratio of the caller's settings to the settings here."""
    legends = [*figure.legends, *filter(None, (axes.get_legend() for axes in figure.axes))]
    for line in (line for part in (*figure.axes, *legends) for line in part.get_lines()):
        if width is not None:
            line.set_linewidth(line.get_linewidth() * width / _STYLE["lines.linewidth"])
        if mark is not None:
            line.set_markersize(line.get_markersize() * mark / rcParamsDefault["lines.markersize"])


def _invert_figure_colors(figure: Figure) -> None:
    """Turn black ink into the colour of the caller's text, and white and shades into dark ones."""
    ink, ground = rcParams["text.color"], rcParams["axes.facecolor"]
    turned = {BLACK: ink, "#404040": ink, "#303030": ink, "#ffffff": ground, SHADE: "#2b333c"}
    artists = figure.findobj(include_self=False)
    artists += [box for each in artists if isinstance(each, Text) and (box := each.get_bbox_patch()) is not None]
    for artist in artists:
        filled = hasattr(artist, "get_facecolor")
        for name in ("facecolor", "edgecolor") if filled else ("color", "markerfacecolor", "markeredgecolor"):
            color: Any = getattr(artist, f"get_{name}", lambda: None)()
            if np.shape(color) == (1, 4):  # of all parts of a band
                color = color[0]
            new = turned.get(to_hex(color)) if is_color_like(color) and to_rgba(color)[3] else None  # "none" is black
            if new is not None:
                getattr(artist, f"set_{name}")(new)


class _CommaFormatter(Formatter):
    """Labels of ticks as another formatter writes them, with decimal commas."""

    def __init__(self, written: Formatter) -> None:
        self.written = written

    def __call__(self, x: float, pos: int | None = None) -> str:
        return with_decimal_commas(self.written(x, pos))

    def format_ticks(self, values: Any) -> list[str]:
        return [with_decimal_commas(text) for text in self.written.format_ticks(values)]

    def get_offset(self) -> str:
        return with_decimal_commas(self.written.get_offset())

    def set_locs(self, locs: Any) -> None:
        self.written.set_locs(locs)


_MATHEMATICS = re.compile(r"(?<!\\)\$[^$]*\$")
_COMMA = re.compile(r"(?<=\d),(?=\d)")  # which mathematics would follow with a space


def _write_decimal_commas(figure: Figure) -> None:
    """Write the numbers at ticks and in texts with decimal commas; names at ticks stay as they are."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            written = axis.get_major_formatter()
            if not isinstance(written, FixedFormatter):
                axis.set_major_formatter(_CommaFormatter(written))
    for text in figure.findobj(Text):
        words = with_decimal_commas(text.get_text())
        text.set_text(_MATHEMATICS.sub(lambda found: _COMMA.sub("{,}", found[0]), words))


def _wrap_figure_texts(figure: Figure) -> None:
    """Break titles and labels into lines that fit."""
    for _ in range(2):  # lines of a title take some of the height from the axes
        figure.draw_without_rendering()
        across, up = figure.bbox.width - _EDGE, figure.bbox.height - _EDGE
        for axes in figure.axes:
            left, right = axes.bbox.x0, axes.bbox.x1
            middle = min(left + right, 2.0 * figure.bbox.width - left - right) - _EDGE  # to the nearer edge, twice
            break_text(axes.title, middle)
            break_text(axes.xaxis.label, middle)
            break_text(axes._left_title, across - left)  # pyright: ignore
            break_text(axes._right_title, right - _EDGE)  # pyright: ignore
            break_text(axes.yaxis.label, axes.bbox.height, turned=True)
        for each in (figure._suptitle, figure._supxlabel, *(key.get_title() for key in figure.legends)):  # pyright: ignore
            break_text(each, across)
        for key in figure.legends:
            widest = max((text.get_window_extent().width for text in key.get_texts()), default=0.0)
            for text in key.get_texts():
                break_text(text, widest - max(key.get_window_extent().width - across, 0.0))
        break_text(figure._supylabel, up, turned=True)  # pyright: ignore


_EDGE = 4.0  # dots that stay free at the edge of a figure
_WORDS = re.compile(r"(?:\$[^$]*\$|[^\s$])+")  # with mathematics in one piece


def break_text(text: Text | None, room: float, *, turned: bool = False) -> None:
    """Break a text between its words, so that it is no longer than `room` dots."""
    if text is None:
        return
    label = text

    def long(words: str) -> bool:
        label.set_text(words)
        box = label.get_window_extent()
        return (box.height if turned else box.width) > room

    whole = label.get_text()
    if not whole or not long(whole):
        return
    lines: list[str] = []
    for line in whole.split("\n"):
        lines.append("")
        for word in _WORDS.findall(line):
            more = f"{lines[-1]} {word}".strip()
            if lines[-1] and long(more):
                lines.append(word)
            else:
                lines[-1] = more
    label.set_text("\n".join(lines))


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Write a figure as PNG (200 dots per inch), PDF or SVG, by the suffix of `path`.

    Missing folders are created. The file is written completely or not at all, and equal figures give equal files.

    Parameters
    ----------
    figure
        A figure of one of the plot functions, or any matplotlib figure.
    path
        Path of the file; an existing file is replaced.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        If the suffix is not .png, .pdf or .svg.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockflex as rf
    >>> folder = Path(tempfile.mkdtemp())
    >>> rf.save_figure(rf.plot_motion(rf.ricker_pulse(4.0, 0.6)),
    ...     folder / "pulse.svg").name
    'pulse.svg'
    """
    target = checked_file_path("path", path)
    suffix = target.suffix.lower()
    if suffix not in _UNDATED:
        raise InputError(
            f"A figure can be saved as .png, .pdf or .svg, but the path {shown(str(path))} ends in "
            f"{shown(target.suffix)}. Change the suffix."
        )
    return write_given_file(target, _figure_file_content(figure, suffix))


def figure_as_svg(figure: Figure) -> str:
    """Return a figure as the text of an SVG file."""
    return _figure_file_content(figure, ".svg").decode()


def figure_as_png(figure: Figure) -> bytes:
    """Return a figure as the content of a PNG file."""
    return _figure_file_content(figure, ".png")


def _figure_file_content(figure: Figure, suffix: str) -> bytes:
    content = io.BytesIO()
    with applied_figure_style():
        figure.savefig(content, format=suffix[1:], dpi=_DPI, metadata=_UNDATED[suffix])
    return content.getvalue()
