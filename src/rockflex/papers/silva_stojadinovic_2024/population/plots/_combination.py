"""What the second mode adds: MDOF-S against 2DOF-S combined with the second mode on a fixed base."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.papers.silva_stojadinovic_2024.population.plots._pairs import (
    BEHAVIOURS,
    determination,
    groups_of,
    number,
    slope,
    square_panel,
)
from rockflex.plot._style import BLUE, GRAY, GREEN, ORANGE, Size, letter, narrow, new_figure, points, styled

if TYPE_CHECKING:
    import pandas as pd

_SYMBOLS = {"shear": ("o", ORANGE), "flexure": ("^", GREEN)}


@dataclass(frozen=True)
class _Panel:
    """Columns of y, of its estimate x, of the estimate by 2DOF-S, and of their common divisor; labels of the axes."""

    y: str
    x: str
    alone: str
    unit: str
    ordinate: str
    abscissa: str


_PANELS = (
    _Panel(
        "max_second_displacement_mdof", "sd_2", "", "", r"$D_{2,\mathrm{max}}$, MDOF-S [m]", r"$S_d(ω_2)$ [m]"
    ),
    _Panel(
        "max_top_displacement_mdof", "srss_top_displacement", "max_top_displacement_2dof", "",
        r"$u_{\mathrm{top,max}}$, MDOF-S [m]", r"$u_{\mathrm{top,max}}$, SRSS [m]",
    ),
    _Panel(
        "max_base_shear_mdof", "srss_base_shear", "max_base_shear_2dof", "structure_mass",
        r"$V_{b,\mathrm{max}}/(m_s\,g)$, MDOF-S", r"$V_{b,\mathrm{max}}/(m_s\,g)$, SRSS",
    ),
    _Panel(
        "max_base_moment_mdof", "srss_base_moment", "max_base_moment_2dof", "l0r_g",
        r"$M_{b,\mathrm{max}}/(L_0^r\,g)$, MDOF-S", r"$M_{b,\mathrm{max}}/(L_0^r\,g)$, SRSS",
    ),
)  # fmt: skip


def plot_modal_combination(pairs: "pd.DataFrame", *, size: Size | None = None) -> Figure:
    """Plot peaks of MDOF-S against 2DOF-S combined with the second mode on a fixed base, one symbol per rocking pair.

    This is Fig. 13 of Silva & Stojadinović 2024; the estimates are the square root of the sum of squares (SRSS, Section
    3.4). R² refers to the line of equality, for the estimate and for 2DOF-S only; the blue line is y = c1 x by least
    squares, as in `population_statistics`. Pairs with a model that overturned are left out.

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
        Four axes: A, D_2,max over S_d(ω_2), both in m; B, u_top,max in m; C, V_b,max/(m_s g); D, M_b,max/(L_0^r g).

    Raises
    ------
    InputError
        If the table lacks a column, or no pair was solved; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=12, seed=1)
    >>> len(rf.plot_modal_combination(pairs).axes)
    4
    """
    needed = {name for panel in _PANELS for name in (panel.y, panel.x, panel.alone, panel.unit) if name}
    groups = groups_of(pairs, tuple(sorted(needed)))
    rows = groups.rocking
    behaviours = rows["behaviour"].astype(str).to_numpy()
    with styled(size=size):
        figure = new_figure(6.3, 9.8 if narrow() else 6.4)
        axes_of: list[Axes] = list(figure.subplots(*((4, 1) if narrow() else (2, 2))).flat)
        for axes, panel, mark in zip(axes_of, _PANELS, "ABCD", strict=True):
            _draw(axes, panel, rows, behaviours)
            letter(axes, mark)
        handles = [
            Line2D([], [], color=color, marker=marker, linestyle="", markersize=3.5, label=BEHAVIOURS[behaviour])
            for behaviour, (marker, color) in _SYMBOLS.items()
        ]
        handles += [
            Line2D([], [], color=GRAY, linestyle="--", linewidth=0.8, label="equal"),
            Line2D([], [], color=BLUE, label="$y = c_1 x$"),
        ]
        title = f"{len(rows)} rocking pairs" + (f"; left out: {groups.left_out}" if groups.left_out else "")
        figure.legend(
            handles=handles,
            loc="outside upper center",
            ncols=2 if narrow() else 4,
            title=title,
            title_fontsize=points(8.0),
        )
    return figure


def _draw(axes: Axes, panel: _Panel, rows: "pd.DataFrame", behaviours: NDArray[np.object_]) -> None:
    unit = np.ones(len(rows)) if not panel.unit else _column(rows, panel.unit)
    unit = GRAVITY * unit if panel.unit == "structure_mass" else unit
    x, y = _column(rows, panel.x) / unit, _column(rows, panel.y) / unit
    for behaviour, (marker, color) in _SYMBOLS.items():
        mine = behaviours == behaviour
        axes.plot(
            x[mine], y[mine], marker, color=color, markersize=2.6, markeredgewidth=0.0, alpha=0.6, zorder=2.0,
            label=f"_{behaviour}",
        )  # fmt: skip
    c1 = slope(x, y)
    lines = [f"R² = {number(determination(x, y))}"]
    if panel.alone:
        lines.append(f"(2DOF-S alone: {number(determination(_column(rows, panel.alone) / unit, y))})")
    limit = square_panel(axes, x, y, [*lines, f"$y$ = {number(c1)} $x$"])
    if np.isfinite(c1):
        axes.plot([0.0, limit], [0.0, c1 * limit], color=BLUE, linewidth=1.1, zorder=3.0, label="_regression")
    axes.set(xlabel=panel.abscissa, ylabel=panel.ordinate)


def _column(rows: "pd.DataFrame", name: str) -> Array:
    return rows[name].to_numpy(dtype=float)
