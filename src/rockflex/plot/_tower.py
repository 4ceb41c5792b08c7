"""The geometry of a tapered tower."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Wedge

from rockflex._checks import checked_positive
from rockflex._errors import InputError
from rockflex._number_format import short_number
from rockflex.plot._style import (
    BLUE,
    GRAY,
    RED,
    SHADE,
    SMALL,
    Size,
    is_narrow_figure,
    label_panel,
    new_figure,
    with_figure_style,
)
from rockflex.structure import TaperedTower

_EDGE = "#404040"
_SLICE = 0.015  # height of the slice over that of the tower


def plot_tower(tower: TaperedTower, section: float | None = None, *, size: Size | None = None) -> Figure:
    """Plot a tower's elevation, and one of its sections with its contribution to I_θ.

    The figure is that of Silva & Stojadinović 2024, Fig. 14. A slice of mass m at the height z turns about the pivot O
    with m((R² + r²)/4 + Δ²), where Δ² = z² + B² (Eq. 33).

    Parameters
    ----------
    tower
        A `TaperedTower`.
    section
        Height z of the section in m, at most the tower's height. Default: half the height.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes, elevation and section, in m. Widths and heights of the elevation have different scales.

    Raises
    ------
    InputError
        If no tower is given, or the section is outside it; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> tower = rf.TaperedTower(height=200, base_radius=8, top_radius=4, wall=1, density=2400, elastic_modulus=25e9,
    ...                         damping_ratio=0.02)
    >>> figure = rf.plot_tower(tower)
    >>> len(figure.axes), figure.axes[0].get_ylabel()
    (2, 'height [m]')
    """
    if not hasattr(tower, "top_radius"):
        raise InputError(f"tower must be a TaperedTower, but {type(tower).__name__} was given.")
    z = 0.5 * tower.height if section is None else checked_positive("section", section, "m")
    if z > tower.height:
        raise InputError(f"section must be at most the height of the tower, {tower.height:g} m, but {z:g} m was given.")
    with with_figure_style(size=size):
        figure = new_figure(6.3, 7.2 if is_narrow_figure() else 4.6)
        if is_narrow_figure():
            left, right = figure.subplots(2, 1, height_ratios=(1.5, 1.0))
        else:
            left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
        _draw_tower_elevation(left, tower, z)
        _draw_tower_section(right, tower, z)
        label_panel(left, "A")
        label_panel(right, "B")
    return figure


def _outer_tower_radius(tower: TaperedTower, z: float) -> float:
    return tower.base_radius + (tower.top_radius - tower.base_radius) * z / tower.height


def _draw_tower_elevation(axes: Axes, tower: TaperedTower, z: float) -> None:
    height, base, top = tower.height, tower.base_radius, tower.top_radius
    levels = np.array([0.0, height])
    outer = np.array([base, top])
    inner = np.maximum(outer - tower.wall, 0.0)
    for side in (-1.0, 1.0):
        axes.fill_betweenx(
            levels, side * inner, side * outer, facecolor=SHADE, edgecolor=_EDGE, linewidth=0.9, label="_wall"
        )
    radius = _outer_tower_radius(tower, z)
    slab = z + 0.5 * _SLICE * height * np.array([-1.0, 1.0])
    axes.fill_betweenx(slab, -radius, radius, facecolor=BLUE, alpha=0.5, linewidth=0.0, label="_slice")
    axes.axvline(0.0, color=GRAY, linestyle=(0, (8, 2, 1, 2)), linewidth=0.7, label="_axis")
    axes.axhline(0.0, color=_EDGE, linewidth=1.2, label="_ground")
    axes.plot([base, 0.0], [0.0, z], color=RED, linewidth=1.0, label="_arm")
    axes.plot([base], [0.0], "o", color=RED, markersize=4.5, clip_on=False, zorder=4.0, label="_pivot")
    _annotate_tower(axes, "O", (base, 0.0), (5, 4), RED)
    arm = float(np.hypot(z, base))
    _annotate_tower(axes, rf"$Δ$ = {arm:.4g} m", (0.5 * base, 0.5 * z), (3, 6), RED, boxed=True)
    reach = 1.5 * max(base, top)
    axes.set(xlim=(-reach, 1.75 * max(base, top)), ylim=(-0.12 * height, 1.09 * height))
    _draw_tower_dimension(axes, (-1.25 * max(base, top), 0.0), (-1.25 * max(base, top), height))
    _annotate_tower(axes, rf"$H$ = {height:g} m", (-1.25 * max(base, top), 0.5 * height), (-3, 0), _EDGE, turned=True)
    _draw_tower_dimension(axes, (0.0, -0.045 * height), (base, -0.045 * height))
    _annotate_tower(axes, rf"$B$ = $R_c$ = {base:g} m", (0.5 * base, -0.045 * height), (0, -4), _EDGE, below=True)
    _draw_tower_dimension(axes, (0.0, 1.03 * height), (top, 1.03 * height))
    _annotate_tower(axes, rf"$R_{{\mathrm{{top}}}}$ = {top:g} m", (top, 1.03 * height), (4, -3), _EDGE)
    _annotate_tower(
        axes, rf"$t_c$ = {tower.wall:g} m", (_outer_tower_radius(tower, 0.78 * height), 0.78 * height), (4, -3), _EDGE
    )
    _annotate_tower(axes, rf"$z$ = {z:g} m", (radius, z), (4, -3), BLUE)
    axes.set(xlabel="width [m]", ylabel="height [m]")
    axes.grid(visible=False)
    axes.set_title("elevation, widths enlarged")


def _draw_tower_section(axes: Axes, tower: TaperedTower, z: float) -> None:
    outer = _outer_tower_radius(tower, z)
    inner = max(outer - tower.wall, 0.0)
    axes.add_patch(Wedge((0.0, 0.0), outer, 0.0, 360.0, width=outer - inner, facecolor=SHADE, edgecolor="none"))
    for radius in (outer, inner):
        axes.add_patch(Circle((0.0, 0.0), radius, fill=False, edgecolor=_EDGE, linewidth=0.9))
    reach = 1.25 * outer
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.axhline(0.0, color=GRAY, linestyle=(0, (8, 2, 1, 2)), linewidth=0.7, label="_axis")
    axes.axvline(0.0, color=GRAY, linestyle=(0, (8, 2, 1, 2)), linewidth=0.7, label="_axis")
    for radius, degrees, name in ((outer, 40.0, "R"), (inner, 140.0, "r")):
        angle = np.deg2rad(degrees)
        end = (radius * float(np.cos(angle)), radius * float(np.sin(angle)))
        axes.annotate("", end, (0.0, 0.0), arrowprops={"arrowstyle": "-|>", "color": BLUE, "linewidth": 1.0})
        middle = (0.5 * end[0], 0.5 * end[1])
        _annotate_tower(axes, f"${name}$ = {short_number(radius)} m", middle, (0, 0), BLUE, boxed=True)
    axes.set_xlabel(r"$I = m\,[(R^2 + r^2)/4 + Δ^2]$, $Δ^2 = z^2 + B^2$")
    axes.grid(visible=False)
    axes.set_ylabel("[m]")
    axes.set_anchor("N")
    axes.set_title(f"section at {z:g} m")


def _draw_tower_dimension(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    axes.annotate(
        "", end, start, arrowprops={"arrowstyle": "<|-|>", "color": _EDGE, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
    )


def _annotate_tower(
    axes: Axes,
    text: str,
    at: tuple[float, float],
    offset: tuple[float, float],
    color: str,
    *,
    turned: bool = False,
    below: bool = False,
    boxed: bool = False,
) -> None:
    """Write next to a point, `offset` points away."""
    axes.annotate(
        text, at, xytext=offset, textcoords="offset points", color=color, fontsize=SMALL, annotation_clip=False,
        ha="right" if turned else "center" if below or boxed else "left",
        va="center" if turned or boxed else "top" if below else "bottom", rotation=90.0 if turned else 0.0,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0} if boxed else None,
    )  # fmt: skip
