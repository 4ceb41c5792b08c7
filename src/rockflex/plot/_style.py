"""Style of all figures: sizes, colours and line styles, without changing the settings of the caller."""

import io
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import RLock
from typing import Any

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

# Okabe & Ito's palette, which colour-blind readers can tell apart.
BLACK, GRAY, GREEN, RED = "#000000", "#8c8c8c", "#009e73", "#d55e00"
BLUE, ORANGE, SKY, PURPLE = "#0072b2", "#e69f00", "#56b4e9", "#cc79a7"
YELLOW = "#f0e442"
SHADE = "#e9edf2"
SMALL = 7.5

COARSE, FINE = 100, 2  # points of a notebook an inch, and dots a point: sharp on screens of many dots

_STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.0,
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
_INK, _NIGHT = "#d7dbe0", "#14181d"
_DARK: dict[Any, Any] = _STYLE | {
    "axes.edgecolor": _INK,
    "axes.facecolor": _NIGHT,
    "axes.labelcolor": _INK,
    "figure.facecolor": _NIGHT,
    "grid.color": "#39414a",
    "text.color": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
}
THEMES = {"light": _STYLE, "dark": _DARK}
_LOCK = RLock()


@dataclass(frozen=True)
class Look:
    """Colour and line style of one curve."""

    color: str
    dashes: str | tuple[int, tuple[float, ...]]
    width: float = 1.0


_DASHES = ("-", (0, (6, 2)), (0, (1, 1)), (0, (6, 1, 1, 1, 1, 1)))
LOOKS = tuple(Look(color, dashes) for dashes in _DASHES for color in (PURPLE, ORANGE, SKY))
"""Looks for models without one of their own, the most distinct first; blue is left to reference lines."""


@contextmanager
def styled(theme: str = "light") -> Generator[None, None, None]:
    """Apply the style while a figure is drawn; matplotlib's settings are global, so one thread at a time."""
    with _LOCK, rc_context(THEMES[theme]):
        yield


def literal(text: str) -> str:
    """Escape names so that they are not read as mathematics."""
    return text.replace("$", r"\$")


class NotebookFigure(Figure):
    """A figure that a notebook shows when it is the last expression of a cell, without pyplot and without a magic.

    Where matplotlib's inline backend is active, its own way of showing figures comes first, so none is shown twice.
    """

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        content = io.BytesIO()
        with styled():
            self.savefig(content, format="png", dpi=FINE * COARSE)
        width, height = (round(COARSE * inches) for inches in self.get_size_inches())
        return content.getvalue(), {"width": width, "height": height}


def new_figure(width: float, height: float) -> Figure:
    """Empty figure of a size in inches, without a window or an entry in the global list of figures."""
    return NotebookFigure(figsize=(width, height), layout="constrained")


def letter(axes: Axes, text: str) -> None:
    """Panel letter outside the axes, left of their upper corner."""
    axes.annotate(
        text, (0.0, 1.0), xytext=(-46, 1), xycoords="axes fraction", textcoords="offset points", weight="bold", va="top"
    )


def columns(names: list[str], width: int) -> int:
    """Number of columns of a legend, if a row has room for `width` letters; the legend fills column by column."""
    for count in range(len(names), 1, -1):
        rows = -(-len(names) // count)
        if sum(max(map(len, names[i : i + rows])) + 7 for i in range(0, len(names), rows)) <= width:
            return count
    return 1
