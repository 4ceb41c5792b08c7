"""Figures of the random population, apart from its study: a study needs no matplotlib."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.papers.silva_stojadinovic_2024.population._statistics import OutcomeGroups, outcome_groups, slope_and_r2
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLUE, GRAY, GREEN, ORANGE, RED, SMALL, Size
from rockflex.plot._study_tables import MARKERS, check_table_columns, measure_axis_name

if TYPE_CHECKING:
    import pandas as pd

BEHAVIOURS = {"shear": r"shear, $ρ=\infty$", "flexure": r"flexure, $ρ=0$"}
_STATUSES = ("behaviour", "status_mdof", "status_2dof")
_CHARACTERISTICS = {
    "n_stories": "stories",
    "aspect_ratio": r"$h^*_1/B$",
    "base_mass_ratio": r"$m_0/m_i$",
    "period": r"$T_1$ [s]",
    "height": r"$H$ [m]",
    "pgv": measure_axis_name("pgv"),
}
_COLORS = {"shear": RED, "flexure": BLUE}
_MAX_BARS = 20  # largest number of values for which each has a bar
_BINS = 20
_MAX_TICKS = 8
_PEAKS = (
    *("n_stories", "aspect_ratio", "period", "max_top_displacement_mdof", "max_top_displacement_2dof"),
    *("max_rotation_mdof", "max_rotation_2dof"),
)
_AGREEMENT_PANELS = (
    ("A", "no_uplift", "top_displacement", r"u_{\mathrm{top,max}}", "m", "no uplift"),
    ("B", "rocking", "top_displacement", r"u_{\mathrm{top,max}}", "m", "rocking"),
    ("C", "rocking", "rotation", r"θ_{\mathrm{max}}", "rad", "rocking"),
)
_MAPS = {
    behaviour: LinearSegmentedColormap.from_list(name, colormaps[name](np.linspace(0.25, 1.0, 64)))
    for behaviour, name in (("shear", "Reds"), ("flexure", "Blues"))
}
_EDGE = "#303030"
_SYMBOLS = {"shear": ("o", ORANGE), "flexure": ("^", GREEN)}


def _checked_outcome_groups(pairs: "pd.DataFrame", columns: tuple[str, ...]) -> tuple[OutcomeGroups, str]:
    """Return the pairs by outcome, and how many others are left out, for which reason."""
    check_table_columns(pairs, (*_STATUSES, *columns), "what run_population returned")
    groups = outcome_groups(pairs)
    if not len(groups.solved):
        raise InputError("No pair was solved. See the column error of the table.")
    fallen = len(groups.solved) - len(groups.resting) - len(groups.rocking)
    counts = ((fallen, "overturned"), (len(pairs) - len(groups.solved), "failed"))
    return groups, ", ".join(f"{count} {word}" for count, word in counts if count)


def draw_square_panel(axes: Axes, x: Array, y: Array, lines: list[str]) -> float:
    """Draw equal axes with the line of equality, and lines of text in the lower right corner; return their end."""
    limit = 1.06 * float(max(x.max(initial=0.0), y.max(initial=0.0))) or 1.0
    axes.plot([0.0, limit], [0.0, limit], color=GRAY, linestyle="--", linewidth=0.8, zorder=1.5, label="_equal")
    axes.set(xlim=(0.0, limit), ylim=(0.0, limit), aspect="equal")
    axes.locator_params(nbins=5)
    axes.text(
        0.97, 0.03, "\n".join(lines), transform=axes.transAxes, fontsize=SMALL, ha="right", linespacing=1.35,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0}, zorder=1.4,
    )  # fmt: skip
    return limit


def decimal_or_dash(value: float, digits: int = 2) -> str:
    """Write a number with a number of decimals; a dash if it is not finite."""
    return f"{value:.{digits}f}".replace("-", "−") if np.isfinite(value) else "–"


def plot_population(pairs: "pd.DataFrame", *, size: Size | None = None) -> Figure:
    """Plot how the characteristics of random structures and the PGV of their records are distributed.

    This is Fig. 8 of Silva & Stojadinović 2024: bars of the number of pairs, flexure stacked on shear.

    Parameters
    ----------
    pairs
        The table of a population study, such as `run_population` returns.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=12,
    ...     seed=1)
    >>> len(rf.plot_population(pairs).axes)
    6
    """
    check_table_columns(pairs, ("behaviour", *_CHARACTERISTICS), "what run_population returned")
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 5.6 if figures.is_narrow() else 4.3)
        panels: list[Axes] = list(figure.subplots(*((3, 2) if figures.is_narrow() else (2, 3))).flat)
        for axes, (name, label), mark in zip(panels, _CHARACTERISTICS.items(), "ABCDEF", strict=True):
            _draw_population_bars(axes, name, pairs)
            axes.set_xlabel(label)
            axes.grid(visible=False, axis="x")
            axes.locator_params(axis="y", integer=True, nbins=6)
            figures.label_panel(axes, mark)
        for axes in panels[:: 2 if figures.is_narrow() else 3]:
            axes.set_ylabel("pairs")
        counts = {name: int((pairs["behaviour"] == name).sum()) for name in BEHAVIOURS}
        handles, _ = panels[0].get_legend_handles_labels()
        names = [f"{BEHAVIOURS[name]} ({count})" for name, count in counts.items()]
        figures.add_legend_above(figure, handles, names)
    return figure


def _draw_population_bars(axes: Axes, name: str, pairs: "pd.DataFrame") -> None:
    values = pairs[name].to_numpy(dtype=float)
    centres, edges = _histogram_bars(values)
    below = np.zeros(centres.size)
    for behaviour, color in _COLORS.items():
        mine = values[(pairs["behaviour"] == behaviour).to_numpy(dtype=bool)]
        counts = np.histogram(mine, edges)[0]
        gap = 0.8 if _has_few_values(values) else 1.0
        axes.bar(
            centres, counts, gap * np.diff(edges), bottom=below, color=color, edgecolor="white",
            linewidth=0.4, label=behaviour,
        )  # fmt: skip
        below += counts
    if _has_few_values(values) and name != "height":
        most = _MAX_TICKS // 2 if figures.is_narrow() else _MAX_TICKS
        axes.set_xticks(centres[:: -(-centres.size // most)])


def _has_few_values(values: Array) -> bool:
    """Whether there are few values, on a grid with few places, so that each has a bar."""
    different = np.unique(values)
    return different.size <= _MAX_BARS and bool(np.ptp(different) <= _MAX_BARS * np.diff(different).min(initial=np.inf))


def _histogram_bars(values: Array) -> tuple[Array, Array]:
    """Return centres and edges of the bars: one for each value if there are few, a fixed number otherwise."""
    different = np.unique(values)
    if not _has_few_values(values):
        edges = np.linspace(different[0], different[-1], _BINS + 1)
    else:
        half = 0.5 * float(np.diff(different).min()) if different.size > 1 else 0.5
        edges = np.arange(different[0] - half, different[-1] + 1.5 * half, 2.0 * half)
    return 0.5 * (edges[1:] + edges[:-1]), edges


def plot_agreement(pairs: "pd.DataFrame", *, size: Size | None = None) -> Figure:
    """Plot peaks of MDOF-S against those of 2DOF-S, one symbol per pair.

    This is Fig. 9 of Silva & Stojadinović 2024. Symbols show the aspect ratio, their size the number of stories, and
    reds (shear) and blues (flexure) the period. R² refers to the line of equality; c1 is the slope of y = c1 x by least
    squares, as in `population_statistics`. Pairs with a model that overturned are left out; their number is given.

    Parameters
    ----------
    pairs
        The table of a population study, such as `run_population` returns.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        Three axes, and a fourth with the legend and two color scales: A, u_top,max in m of pairs without uplift; B and
        C, u_top,max in m and θ_max in rad of pairs that rock.

    Raises
    ------
    InputError
        If the table lacks a column, no pair was solved, or there are more aspect ratios than symbols; or the size is
        unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=12,
    ...     seed=1)
    >>> figure = rf.plot_agreement(pairs)
    >>> [axes.get_title() for axes in figure.axes[:3]]
    ['no uplift', 'rocking', 'rocking']
    """
    groups, left_out = _checked_outcome_groups(pairs, _PEAKS)
    markers = _markers_by_aspect_ratio(pairs)
    periods = pairs["period"].to_numpy(dtype=float)
    scale = Normalize(float(periods.min()), float(periods.max()))
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 9.8 if figures.is_narrow() else 6.0)
        if figures.is_narrow():
            panels: list[Axes] = list(figure.subplots(4, 1, height_ratios=(1.0, 1.0, 1.0, 0.75)))
        else:
            panels = list(figure.subplots(2, 2).flat)
        for axes, (mark, group, quantity, symbol, unit, name) in zip(panels, _AGREEMENT_PANELS, strict=False):
            rows = groups.resting if group == "no_uplift" else groups.rocking
            _draw_agreement(axes, rows, quantity, markers, scale)
            axes.set(xlabel=rf"${symbol}$, 2DOF-S [{unit}]", ylabel=rf"${symbol}$, MDOF-S [{unit}]", title=name)
            figures.label_panel(axes, mark)
        _draw_agreement_legends(figure, panels[3], pairs, markers, scale, left_out)
    return figure


def _markers_by_aspect_ratio(pairs: "pd.DataFrame") -> dict[float, str]:
    ratios = [float(ratio) for ratio in np.unique(pairs["aspect_ratio"].to_numpy(dtype=float))]
    if len(ratios) > len(MARKERS):
        raise InputError(
            f"{len(ratios)} aspect ratios were given, but there are {len(MARKERS)} symbols. Plot some of them."
        )
    return dict(zip(ratios, MARKERS, strict=False))


def _draw_agreement(
    axes: Axes, rows: "pd.DataFrame", quantity: str, markers: dict[float, str], scale: Normalize
) -> None:
    x, y = (rows[f"max_{quantity}_{model}"].to_numpy(dtype=float) for model in ("2dof", "mdof"))
    ratios, behaviours = rows["aspect_ratio"].to_numpy(dtype=float), rows["behaviour"].astype(str).to_numpy()
    size, period = _marker_area(rows["n_stories"].to_numpy(dtype=float)), rows["period"].to_numpy(dtype=float)
    lines = [f"R² = {decimal_or_dash(slope_and_r2(x, y)[1])}, n = {x.size}"]
    for behaviour, colors in _MAPS.items():
        of_behaviour = behaviours == behaviour
        for ratio, marker in markers.items():
            mine = of_behaviour & (ratios == ratio)
            if mine.any():
                axes.scatter(
                    x[mine], y[mine], size[mine], c=period[mine], cmap=colors, norm=scale, marker=marker,
                    edgecolors=_EDGE, linewidths=0.25, alpha=0.85, zorder=2.0, label=f"_{behaviour} {ratio:g}",
                )  # fmt: skip
        lines.append(f"$c_1$ = {decimal_or_dash(slope_and_r2(x[of_behaviour], y[of_behaviour])[0])}, {behaviour}")
    draw_square_panel(axes, x, y, lines)


def _marker_area(stories: Array) -> Array:
    """Return the area of the symbols in points squared."""
    return 3.0 + 2.2 * stories


def _draw_agreement_legends(
    figure: Figure, axes: Axes, pairs: "pd.DataFrame", markers: dict[float, str], scale: Normalize, left_out: str
) -> None:
    """Draw the legends of symbols and sizes, the two scales of the period, and the number of pairs left out."""
    axes.axis("off")
    plain: dict[str, Any] = {"linestyle": "", "color": "white", "markeredgecolor": _EDGE, "markeredgewidth": 0.6}
    symbols = [Line2D([], [], marker=marker, markersize=5.0, label=f"{r:g}", **plain) for r, marker in markers.items()]
    stories = np.unique(np.quantile(pairs["n_stories"].to_numpy(dtype=float), (0.0, 0.5, 1.0), method="nearest"))
    sizes = [
        Line2D([], [], marker="o", markersize=float(np.sqrt(_marker_area(count))), label=f"{count:g}", **plain)
        for count in stories
    ]
    for handles, title, place in ((symbols, r"$h^*_1/B$", 0.0), (sizes, "stories", 0.52)):
        key = axes.legend(
            handles=handles, title=title, loc="upper left", bbox_to_anchor=(place, 1.04), ncols=1 + (len(handles) > 4),
            fontsize=SMALL, title_fontsize=SMALL, handletextpad=0.2, columnspacing=0.8, alignment="left",
        )  # fmt: skip
        if handles is symbols:  # the axes keep the last legend themselves
            axes.add_artist(key)
    for (behaviour, colors), height in zip(_MAPS.items(), (0.46, 0.21), strict=True):
        bar = figure.colorbar(
            ScalarMappable(scale, colors), cax=axes.inset_axes((0.02, height, 0.94, 0.055)), orientation="horizontal"
        )
        bar.set_label(rf"$T_1$ [s], {BEHAVIOURS[behaviour]}", fontsize=SMALL, labelpad=1.0)
        bar.ax.tick_params(labelsize=SMALL)
    if left_out:
        axes.text(0.02, 0.02, f"left out: {left_out}", transform=axes.transAxes, fontsize=SMALL)


@dataclass(frozen=True)
class _CombinationPanel:
    """Columns of y, of its estimate x, of the estimate by 2DOF-S, and of their common divisor; labels of the axes."""

    y: str
    x: str
    alone: str
    unit: str
    ordinate: str
    abscissa: str


_COMBINATION_PANELS = (
    _CombinationPanel(
        "max_second_displacement_mdof", "sd_2", "", "", r"$D_{2,\mathrm{max}}$, MDOF-S [m]", r"$S_d(ω_2)$ [m]"
    ),
    _CombinationPanel(
        "max_top_displacement_mdof", "srss_top_displacement", "max_top_displacement_2dof", "",
        r"$u_{\mathrm{top,max}}$, MDOF-S [m]", r"$u_{\mathrm{top,max}}$, SRSS [m]",
    ),
    _CombinationPanel(
        "max_base_shear_mdof", "srss_base_shear", "max_base_shear_2dof", "structure_mass",
        r"$V_{b,\mathrm{max}}/(m_s\,g)$, MDOF-S", r"$V_{b,\mathrm{max}}/(m_s\,g)$, SRSS",
    ),
    _CombinationPanel(
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
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=12,
    ...     seed=1)
    >>> len(rf.plot_modal_combination(pairs).axes)
    4
    """
    needed = {name for panel in _COMBINATION_PANELS for name in (panel.y, panel.x, panel.alone, panel.unit) if name}
    groups, left_out = _checked_outcome_groups(pairs, tuple(sorted(needed)))
    rows = groups.rocking
    behaviours = rows["behaviour"].astype(str).to_numpy()
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 9.8 if figures.is_narrow() else 6.4)
        axes_of: list[Axes] = list(figure.subplots(*((4, 1) if figures.is_narrow() else (2, 2))).flat)
        for axes, panel, mark in zip(axes_of, _COMBINATION_PANELS, "ABCD", strict=True):
            _draw_combination(axes, panel, rows, behaviours)
            figures.label_panel(axes, mark)
        handles = [
            Line2D([], [], color=color, marker=marker, linestyle="", markersize=3.5, label=BEHAVIOURS[behaviour])
            for behaviour, (marker, color) in _SYMBOLS.items()
        ]
        handles += [
            Line2D([], [], color=GRAY, linestyle="--", linewidth=0.8, label="equal"),
            Line2D([], [], color=BLUE, label="$y = c_1 x$"),
        ]
        title = f"{len(rows)} rocking pairs" + (f"; left out: {left_out}" if left_out else "")
        figures.add_legend_above(figure, handles, title=title, title_size=figures.scaled_font_size(8.0))
    return figure


def _draw_combination(
    axes: Axes, panel: _CombinationPanel, rows: "pd.DataFrame", behaviours: NDArray[np.object_]
) -> None:
    unit = np.ones(len(rows)) if not panel.unit else _float_column(rows, panel.unit)
    unit = GRAVITY * unit if panel.unit == "structure_mass" else unit
    x, y = _float_column(rows, panel.x) / unit, _float_column(rows, panel.y) / unit
    for behaviour, (marker, color) in _SYMBOLS.items():
        mine = behaviours == behaviour
        axes.plot(
            x[mine], y[mine], marker, color=color, markersize=2.6, markeredgewidth=0.0, alpha=0.6, zorder=2.0,
            label=f"_{behaviour}",
        )  # fmt: skip
    c1, r2 = slope_and_r2(x, y)
    lines = [f"R² = {decimal_or_dash(r2)}"]
    if panel.alone:
        lines.append(f"(2DOF-S alone: {decimal_or_dash(slope_and_r2(_float_column(rows, panel.alone) / unit, y)[1])})")
    limit = draw_square_panel(axes, x, y, [*lines, f"$y$ = {decimal_or_dash(c1)} $x$"])
    if np.isfinite(c1):
        axes.plot([0.0, limit], [0.0, c1 * limit], color=BLUE, linewidth=1.1, zorder=3.0, label="_regression")
    axes.set(xlabel=panel.abscissa, ylabel=panel.ordinate)


def _float_column(rows: "pd.DataFrame", name: str) -> Array:
    return rows[name].to_numpy(dtype=float)
