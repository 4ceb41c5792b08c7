"""Shared by figures of studies: columns of tables, names of axes, styles of models, and a panel for each structure."""

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number
from rockflex.foundation.shown import shown
from rockflex.motion._measures import MEASURES
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLACK, GREEN, LINE_STYLES, PURPLE, RED, LineStyle

if TYPE_CHECKING:
    import pandas as pd

_OWN = {
    "2DOF-S": LineStyle(RED, "-."), "2DOF-C": LineStyle(PURPLE, "--"), "3DOF-S": LineStyle(GREEN, "--"),
    "MDOF-S": LineStyle(BLACK, "-", 2.0),
}  # fmt: skip
MARKERS = ("o", "^", "s", "D", "v", "P", "X", "<", ">", "h", "p", "*", "d", "8", "H")

_MAX_PANELS = 12  # panels in one figure


def model_line_styles(models: Iterable[str]) -> dict[str, LineStyle]:
    """Give each model its own line style, in order of appearance; an `InputError` if there are too many."""
    names = list(dict.fromkeys(models))
    taken = {style for name, style in _OWN.items() if name in names}
    spare = [style for style in LINE_STYLES if style not in taken]
    others = [name for name in names if name not in _OWN]
    if len(others) > len(spare):
        raise InputError(f"{len(names)} models are too many to distinguish in one figure. Plot fewer at a time.")
    styles = _OWN | dict(zip(others, spare, strict=False))
    return dict(zip(names, figures.recoloured_line_styles(styles[name] for name in names), strict=True))


def check_table_columns(table: object, columns: Iterable[str], source: str, called: str = "") -> None:
    """Raise an InputError unless a table has rows and these columns; `source` names the function that returns one."""
    lacking = [name for name in columns if name not in getattr(table, "columns", ())]
    if lacking or not len(table):  # pyright: ignore[reportArgumentType]
        lacks = f"lacks {', '.join(lacking)}" if lacking else "has no rows"
        raise InputError(f"The table{f' {shown(called)}' if called else ''} {lacks}. Give {source}.")


def measure_axis_name(measure: str) -> str:
    """Name of an axis: an intensity measure with its unit, or the name of another column."""
    known = MEASURES.get(measure)
    if known is None:
        return figures.literal_text(measure)
    return known.with_unit(translated(known.label) if known.words == known.label else known.sign)


def names_in_column(column: "pd.Series[Any] | Iterable[object]") -> list[str]:
    """Different names in a column, in order of appearance."""
    return list(dict.fromkeys(str(name) for name in column))


def model_lines_and_symbols(models: Sequence[str]) -> dict[str, tuple[LineStyle, str]]:
    """Give each model its own line and symbol."""
    styles = model_line_styles(models)
    return {model: (style, marker) for (model, style), marker in zip(styles.items(), MARKERS, strict=False)}


def label_log_axis_plainly(axis: Axis) -> None:
    """Label a logarithmic axis of a few decades at 1, 2 and 5, without exponents."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(_plain_tick_label))
    axis.set_minor_formatter(NullFormatter())


def _plain_tick_label(value: float, _: object) -> str:
    return short_number(value)


def model_legend_handles(styles: dict[str, tuple[LineStyle, str]], *, symbols: bool = True) -> list[Line2D]:
    """Entries of a legend, one per model, with its line and its symbol."""
    return [
        Line2D(
            [], [], **style.look, marker=marker if symbols else "", markersize=3.5, markerfacecolor="none",
            markeredgewidth=0.7, label=model,
        )
        for model, (style, marker) in styles.items()
    ]  # fmt: skip


def structure_panels(names: Sequence[str], across: int, height: float, x: str, y: str) -> tuple[Figure, list[Axes]]:
    """Figure with one panel per structure, of a `height` in inches, `across` per row, over the same axes."""
    if len(names) > _MAX_PANELS:
        raise InputError(
            f"{len(names)} structures are too many for one figure; {_MAX_PANELS} fit. Plot fewer at a time."
        )
    columns = 1 if figures.is_narrow() else min(across, len(names))
    rows = math.ceil(len(names) / columns)
    figure = figures.new_figure(4.2 if columns == 1 else 6.3, 0.6 + height * rows)
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    panels: list[Axes] = list(grid.flat)
    for spare in panels[len(names) :]:
        spare.remove()
    for place, (axes, name) in enumerate(zip(panels, names, strict=False)):
        axes.set_title(figures.literal_text(name))
        if place + columns >= len(names):
            axes.set_xlabel(x)
            axes.tick_params(labelbottom=True)
        if place % columns == 0:
            axes.set_ylabel(y)
    return figure, panels[: len(names)]
