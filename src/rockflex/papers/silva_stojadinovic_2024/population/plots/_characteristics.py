"""The characteristics of a population of random structures."""

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._arrays import Array
from rockflex.papers.silva_stojadinovic_2024.population.plots._pairs import BEHAVIOURS
from rockflex.plot._study_tables import check_columns, measure_name
from rockflex.plot._style import BLUE, RED, Size, letter, narrow, new_figure, styled

if TYPE_CHECKING:
    import pandas as pd

_PANELS = {
    "n_stories": "stories",
    "aspect_ratio": r"$h^*_1/B$",
    "base_mass_ratio": r"$m_0/m_i$",
    "period": r"$T_1$ [s]",
    "height": r"$H$ [m]",
    "pgv": measure_name("pgv"),
}
_COLORS = {"shear": RED, "flexure": BLUE}
_FEW = 20  # largest number of values for which each has a bar
_BINS = 20
_MOST_TICKS = 8


def plot_population(pairs: "pd.DataFrame", *, size: Size | None = None) -> Figure:
    """Plot how the characteristics of random structures and the PGV of their records are distributed.

    This is Fig. 8 of Silva & Stojadinović 2024: bars of the number of pairs, flexure stacked on shear.

    Parameters
    ----------
    pairs
        The table of a population study, such as `run_population` returns.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Six axes: A, stories; B, h*_1/B; C, base mass over story mass; D, first period in s; E, height in m; F, PGV in
        m/s.

    Raises
    ------
    InputError
        If the table lacks a column or has no rows; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=12, seed=1)
    >>> len(rf.plot_population(pairs).axes)
    6
    """
    check_columns(pairs, ("behaviour", *_PANELS), "what run_population returned")
    with styled(size=size):
        figure = new_figure(6.3, 5.6 if narrow() else 4.3)
        panels: list[Axes] = list(figure.subplots(*((3, 2) if narrow() else (2, 3))).flat)
        for axes, (name, label), mark in zip(panels, _PANELS.items(), "ABCDEF", strict=True):
            _draw(axes, name, pairs)
            axes.set_xlabel(label)
            axes.grid(visible=False, axis="x")
            axes.locator_params(axis="y", integer=True, nbins=6)
            letter(axes, mark)
        for axes in panels[:: 2 if narrow() else 3]:
            axes.set_ylabel("pairs")
        counts = {name: int((pairs["behaviour"] == name).sum()) for name in BEHAVIOURS}
        handles, _ = panels[0].get_legend_handles_labels()
        names = [f"{BEHAVIOURS[name]} ({count})" for name, count in counts.items()]
        figure.legend(handles, names, loc="outside upper center", ncols=2)
    return figure


def _draw(axes: Axes, name: str, pairs: "pd.DataFrame") -> None:
    values = pairs[name].to_numpy(dtype=float)
    centres, edges = _bars(values)
    below = np.zeros(centres.size)
    for behaviour, color in _COLORS.items():
        mine = values[(pairs["behaviour"] == behaviour).to_numpy(dtype=bool)]
        counts = np.histogram(mine, edges)[0]
        gap = 0.8 if _separate(values) else 1.0
        axes.bar(
            centres, counts, gap * np.diff(edges), bottom=below, color=color, edgecolor="white",
            linewidth=0.4, label=behaviour,
        )  # fmt: skip
        below += counts
    if _separate(values) and name != "height":
        most = _MOST_TICKS // 2 if narrow() else _MOST_TICKS
        axes.set_xticks(centres[:: -(-centres.size // most)])


def _separate(values: Array) -> bool:
    """Whether there are few values, on a grid with few places, so that each has a bar."""
    different = np.unique(values)
    return different.size <= _FEW and bool(np.ptp(different) <= _FEW * np.diff(different).min(initial=np.inf))


def _bars(values: Array) -> tuple[Array, Array]:
    """Return centres and edges of the bars: one for each value if there are few, a fixed number otherwise."""
    different = np.unique(values)
    if not _separate(values):
        edges = np.linspace(different[0], different[-1], _BINS + 1)
    else:
        half = 0.5 * float(np.diff(different).min()) if different.size > 1 else 0.5
        edges = np.arange(different[0] - half, different[-1] + 1.5 * half, 2.0 * half)
    return 0.5 * (edges[1:] + edges[:-1]), edges
