"""MDOF-S against 2DOF-S, pair by pair."""

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.papers.silva_stojadinovic_2024.population.plots._pairs import (
    BEHAVIOURS,
    determination,
    groups_of,
    number,
    slope,
    square_panel,
)
from rockflex.plot._study_tables import MARKERS
from rockflex.plot._style import SMALL, Size, letter, narrow, new_figure, styled

if TYPE_CHECKING:
    import pandas as pd

_NEEDED = (
    *("n_stories", "aspect_ratio", "period", "max_top_displacement_mdof", "max_top_displacement_2dof"),
    *("max_rotation_mdof", "max_rotation_2dof"),
)
_PANELS = (
    ("A", "no_uplift", "top_displacement", r"u_{\mathrm{top,max}}", "m", "no uplift"),
    ("B", "rocking", "top_displacement", r"u_{\mathrm{top,max}}", "m", "rocking"),
    ("C", "rocking", "rotation", r"θ_{\mathrm{max}}", "rad", "rocking"),
)
_MAPS = {
    behaviour: LinearSegmentedColormap.from_list(name, colormaps[name](np.linspace(0.25, 1.0, 64)))
    for behaviour, name in (("shear", "Reds"), ("flexure", "Blues"))
}
_EDGE = "#303030"


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
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

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
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=12, seed=1)
    >>> figure = rf.plot_agreement(pairs)
    >>> [axes.get_title() for axes in figure.axes[:3]]
    ['no uplift', 'rocking', 'rocking']
    """
    groups = groups_of(pairs, _NEEDED)
    markers = _markers(pairs)
    periods = pairs["period"].to_numpy(dtype=float)
    scale = Normalize(float(periods.min()), float(periods.max()))
    with styled(size=size):
        figure = new_figure(6.3, 9.8 if narrow() else 6.0)
        if narrow():
            panels: list[Axes] = list(figure.subplots(4, 1, height_ratios=(1.0, 1.0, 1.0, 0.75)))
        else:
            panels = list(figure.subplots(2, 2).flat)
        for axes, (mark, group, quantity, symbol, unit, name) in zip(panels, _PANELS, strict=False):
            rows = groups.resting if group == "no_uplift" else groups.rocking
            _draw(axes, rows, quantity, markers, scale)
            axes.set(xlabel=rf"${symbol}$, 2DOF-S [{unit}]", ylabel=rf"${symbol}$, MDOF-S [{unit}]", title=name)
            letter(axes, mark)
        _write_keys(figure, panels[3], pairs, markers, scale, groups.left_out)
    return figure


def _markers(pairs: "pd.DataFrame") -> dict[float, str]:
    ratios = [float(ratio) for ratio in np.unique(pairs["aspect_ratio"].to_numpy(dtype=float))]
    if len(ratios) > len(MARKERS):
        raise InputError(
            f"{len(ratios)} aspect ratios were given, but there are {len(MARKERS)} symbols. Plot some of them."
        )
    return dict(zip(ratios, MARKERS, strict=False))


def _draw(axes: Axes, rows: "pd.DataFrame", quantity: str, markers: dict[float, str], scale: Normalize) -> None:
    x, y = (rows[f"max_{quantity}_{model}"].to_numpy(dtype=float) for model in ("2dof", "mdof"))
    ratios, behaviours = rows["aspect_ratio"].to_numpy(dtype=float), rows["behaviour"].astype(str).to_numpy()
    size, period = _size(rows["n_stories"].to_numpy(dtype=float)), rows["period"].to_numpy(dtype=float)
    lines = [f"R² = {number(determination(x, y))}, n = {x.size}"]
    for behaviour, colors in _MAPS.items():
        of_behaviour = behaviours == behaviour
        for ratio, marker in markers.items():
            mine = of_behaviour & (ratios == ratio)
            if mine.any():
                axes.scatter(
                    x[mine], y[mine], size[mine], c=period[mine], cmap=colors, norm=scale, marker=marker,
                    edgecolors=_EDGE, linewidths=0.25, alpha=0.85, zorder=2.0, label=f"_{behaviour} {ratio:g}",
                )  # fmt: skip
        lines.append(f"$c_1$ = {number(slope(x[of_behaviour], y[of_behaviour]))}, {behaviour}")
    square_panel(axes, x, y, lines)


def _size(stories: Array) -> Array:
    """Return the area of the symbols in points squared."""
    return 3.0 + 2.2 * stories


def _write_keys(
    figure: Figure, axes: Axes, pairs: "pd.DataFrame", markers: dict[float, str], scale: Normalize, left_out: str
) -> None:
    """Draw the legends of symbols and sizes, the two scales of the period, and the number of pairs left out."""
    axes.axis("off")
    plain: dict[str, Any] = {"linestyle": "", "color": "white", "markeredgecolor": _EDGE, "markeredgewidth": 0.6}
    symbols = [Line2D([], [], marker=marker, markersize=5.0, label=f"{r:g}", **plain) for r, marker in markers.items()]
    stories = np.unique(np.quantile(pairs["n_stories"].to_numpy(dtype=float), (0.0, 0.5, 1.0), method="nearest"))
    sizes = [
        Line2D([], [], marker="o", markersize=float(np.sqrt(_size(count))), label=f"{count:g}", **plain)
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
