"""Loops: resisting moment and elements of a base, and the restoring force of the superstructure."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._number_format import short_number, unit_with_prefix
from rockflex.modal import (
    BaseElement,
    ElementLaw,
    FrictionDamper,
    RockingProperties,
    Tendon,
    ViscousDamper,
    YieldingDissipator,
)
from rockflex.plot._history import (
    add_response_legend,
    draw_history_panel,
    panel_quantities,
    quantity_axis_scale,
    shade_uplifts,
)
from rockflex.plot._response_curves import ResponseCurve, response_curves, response_figure_title
from rockflex.plot._style import (
    BLACK,
    BLUE,
    GRAY,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    Size,
    add_legend_above,
    is_narrow_figure,
    label_panel,
    literal_text,
    new_figure,
    with_figure_style,
)
from rockflex.response import (
    History,
    MomentRotation,
    MomentRotationOnSprings,
    Response,
    element_resistance,
    large_resistance,
    resistance_on_springs,
    weight_resistance,
)

_COLORS = (SKY, ORANGE, PURPLE, GREEN, RED, "#7a5195")  # of elements, in their order
_ELEMENT_NAMES: dict[type[BaseElement], str] = {
    Tendon: "tendon",
    YieldingDissipator: "fuse",
    ViscousDamper: "viscous damper",
    FrictionDamper: "friction damper",
}
_PER_ROW = 2


def _element_name(element: BaseElement) -> str:
    return element.words if isinstance(element, ElementLaw) else _ELEMENT_NAMES[type(element)]


@dataclass(frozen=True, eq=False)
class BaseLoops:
    """The paths of a base, without the states in contact, and of its elements.

    Attributes
    ----------
    title
        Name of the motion; empty for a quasi-static path.
    elements
        The elements, in their order.
    rotation
        θ in rad, shape (n,).
    weight, parts
        Contributions to the resisting moment in N m: of the weight, shape (n,), and of the elements, shape (n, E).
    elongation, force
        δ in m and F in N of the elements, also in contact, shape (m, E).
    springs
        Contribution of the springs under the base in N m, shape (n,); None on rigid ground.
    edges
        Rise of the left and of the right edge of a base on springs in m, shape (n, 2); None on rigid ground.
    """

    title: str
    elements: tuple[BaseElement, ...]
    rotation: Array
    weight: Array
    parts: Array
    elongation: Array
    force: Array
    springs: Array | None = None
    edges: Array | None = None

    @property
    def moment(self) -> Array:
        """Resisting moment in N m, shape (n,)."""
        moment = self.weight + self.parts.sum(axis=1)
        return moment if self.springs is None else moment + self.springs


def base_loops(result: MomentRotation | MomentRotationOnSprings | Response) -> BaseLoops:
    """Return the path of a base from a cyclic pushover, or from the history of a run.

    Raises
    ------
    InputError
        If `result` is neither, has no history, or is of a base that cannot lift.
    """
    if isinstance(result, MomentRotation | MomentRotationOnSprings):
        on_springs = isinstance(result, MomentRotationOnSprings)
        return BaseLoops(
            title="",
            elements=result.elements,
            rotation=result.rotation,
            weight=result.weight_moment,
            parts=result.element_moment,
            elongation=result.element_elongation,
            force=result.element_force,
            springs=result.spring_moment if on_springs else None,
            edges=result.edge_uplift if on_springs else None,
        )
    given: Any = result
    if not hasattr(given, "history"):
        raise InputError(
            f"result must be a Response or a MomentRotation, but {type(given).__name__} was given. Give what simulate "
            "or moment_rotation returned."
        )
    (curve,) = curves = response_curves(result)
    if not curve.lifts:
        raise InputError(
            "The base of this response cannot lift, so it has no loops. Give the response of a model that rocks, such "
            'as "2DOF-S".'
        )
    history, until_fall = curve.history, curve.before_fall
    title, elements = response_figure_title(curves, None), history.model.properties.elements
    resistance = resistance_on_springs(history)
    if resistance is not None:
        return BaseLoops(
            title=title,
            elements=elements,
            rotation=history.rotation[until_fall],
            weight=resistance.weight[until_fall],
            parts=resistance.elements[until_fall],
            elongation=history.element_elongation[until_fall],
            force=history.element_force[until_fall],
            springs=resistance.springs[until_fall],
            edges=history.edge_uplift[until_fall],
        )
    rocking = np.flatnonzero(history.side[until_fall] != 0.0)
    weight, parts = resisting_moments(history)
    return BaseLoops(
        title=title,
        elements=elements,
        rotation=history.rotation[rocking],
        weight=weight[rocking],
        parts=parts[rocking],
        elongation=history.element_elongation[until_fall],
        force=history.element_force[until_fall],
    )


def resisting_moments(history: History) -> tuple[Array, Array]:
    """Return the resisting moments of the weight (n,) and of the elements (n, E) in N m; zero in contact."""
    p, side = history.model.properties, history.side.astype(np.int64)
    heavier = 1.0 + history.vertical_ground_acceleration / GRAVITY
    if history.model.complete:
        weight, parts = large_resistance(p, side, history.rotation, history.element_force)
        return heavier * weight, parts
    weight = weight_resistance(p, side, history.rotation)
    return heavier * weight, element_resistance(p, side, history.element_force)


def is_moment_path_independent(properties: RockingProperties) -> bool:
    """Whether the resisting moment depends on the rotation alone: all elements stay elastic."""
    return all(
        not any(branch.yields for branch in each.law.values())
        if isinstance(each, ElementLaw)
        else isinstance(each, Tendon) and each.post_yield_ratio is None
        for each in properties.elements
    )


def element_name(element: BaseElement, number: int) -> str:
    """Name of an element in a figure, with its number, counted from 1, and its position."""
    return f"{number} {_element_name(element)}, x = {short_number(element.position)} m"


def plot_loops(
    result: MomentRotation | MomentRotationOnSprings | Response, *, title: str | None = None, size: Size | None = None
) -> Figure:
    """Plot the resisting moment of a base over its rotation, and the force of each element over its elongation.

    The resisting moment M is the sum of the parts of the weight and of the elements, about the pivot about which the
    base rotates; it is plotted with its parts. Tendons that stay elastic add to the spine of the flag, elements that
    yield or slide its loops. The figure shows a cyclic pushover, or the history of a run, in which viscous dampers
    contribute and contact is a vertical line. A run that overturns is shown up to the rotation of balance.

    On springs the moments are those about the axis of the masses, and the springs are one more part. One more axes has
    the rise of either edge of the base over the rotation; where it is negative, the edge has settled.

    Parameters
    ----------
    result
        What `moment_rotation` returned, or a response with its history.
    title
        Default: the name of the motion.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes with M over θ in rad, on springs one with the rise of the edges in mm, then one axes per element with F
        over δ in m; M and F in units that suit their sizes.

    Raises
    ------
    InputError
        If `result` is neither, has no history, or is of a base that cannot lift; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> wall = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e9, base_mass=10e3, half_width=1.5, damping_ratio=0.02
    ... )
    >>> fuse = rf.YieldingDissipator(stiffness=60e6, yield_force=150e3)
    >>> held = rf.Restrained(wall, [rf.Tendon(initial_force=300e3, stiffness=8e6), fuse])
    >>> figure = rf.plot_loops(rf.moment_rotation(held, [0.02, -0.02, 0.0]))
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['M [MN m]', 'F [kN]', 'F [kN]']
    """
    loops = base_loops(result)
    drawn = [] if loops.edges is None else [_draw_edge_loops]
    drawn += [partial(_draw_element_loop, place=place) for place in range(len(loops.elements))]
    count = len(drawn)
    with with_figure_style(size=size):
        rows = count if is_narrow_figure() else max(math.ceil(count / _PER_ROW), 1)
        beside = 0 if is_narrow_figure() else math.ceil(count / rows)
        figure = new_figure(4.2 + 2.2 * beside, max(3.6, (3.3 if is_narrow_figure() else 0.7) + 2.3 * rows))
        figure.get_layout_engine().set(w_pad=0.07)  # pyright: ignore
        if is_narrow_figure():
            grid = figure.add_gridspec(1 + rows, 1, height_ratios=(1.4, *[1.0] * rows))
            base = figure.add_subplot(grid[0, 0])
        else:
            grid = figure.add_gridspec(rows, 1 + beside, width_ratios=(1.7, *[1.0] * beside))
            base = figure.add_subplot(grid[:, 0])
        _draw_base_loop(base, loops)
        for place, draw in enumerate(drawn):
            row, column = (1 + place, 0) if is_narrow_figure() else (place // beside, 1 + place % beside)
            draw(figure.add_subplot(grid[row, column]), loops)
        lines = base.get_lines()
        add_legend_above(
            figure, lines, title=literal_text(title) if title is not None else loops.title, handlelength=2.0
        )
    return figure


def _draw_base_loop(axes: Axes, loops: BaseLoops) -> None:
    moment = loops.moment
    factor, unit = unit_with_prefix(max(map(abs, (*moment, 0.0))), "N m")
    axes.plot(loops.rotation, moment / factor, color=BLACK, linewidth=1.4, label="total", zorder=3.0)
    if loops.elements or loops.springs is not None:
        axes.plot(loops.rotation, loops.weight / factor, color=GRAY, linewidth=0.9, label="weight")
    if loops.springs is not None:
        axes.plot(loops.rotation, loops.springs / factor, color=BLUE, linewidth=0.9, label="springs")
    for place, element in enumerate(loops.elements):
        axes.plot(
            loops.rotation, loops.parts[:, place] / factor, color=_element_color(place), linewidth=0.9,
            label=element_name(element, place + 1),
        )  # fmt: skip
    axes.set(xlabel="θ [rad]", ylabel=f"M [{unit}]")
    axes.locator_params(axis="x", nbins=6)


def _draw_edge_loops(axes: Axes, loops: BaseLoops) -> None:
    edges = cast("Array", loops.edges)
    axes.axhline(0.0, color=GRAY, linewidth=0.6, label="_level")
    for edge, style, name in zip(edges.T, ("-", (0, (4, 2))), ("left", "right"), strict=True):
        axes.plot(loops.rotation, 1e3 * edge, color=BLUE, linestyle=style, linewidth=1.1, label=name)
    axes.set(title="edges of the base", xlabel="θ [rad]", ylabel="rise [mm]")
    axes.locator_params(axis="x", nbins=4)
    axes.legend(handlelength=2.0)


def _draw_element_loop(axes: Axes, loops: BaseLoops, place: int) -> None:
    force = loops.force[:, place]
    factor, unit = unit_with_prefix(max(map(abs, (*force, 0.0))), "N")
    axes.plot(loops.elongation[:, place], force / factor, color=_element_color(place), linewidth=1.1)
    axes.set(title=element_name(loops.elements[place], place + 1), xlabel="δ [m]", ylabel=f"F [{unit}]")
    axes.locator_params(axis="x", nbins=4)


def _element_color(place: int) -> str:
    return _COLORS[place % len(_COLORS)]


def plot_hysteresis(
    responses: Response | Iterable[Response],
    labels: Sequence[str] | None = None,
    *,
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    r"""Plot the restoring force V_b of the superstructure over its top displacement u_top.

    For one mode V_b is Eq. 37 of Silva & Stojadinović 2024 times m*_1, and an elastic superstructure gives a line; for
    several modes V_b is not a function of u_top. Overturning is plotted until the weight overturns the structure.

    Parameters
    ----------
    responses
        One response or several, each with its history.
    labels
        A name for each response in the legend. Default: the models, with the motions if a model occurs twice.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes; u_top in m, V_b in a unit that suits its size.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, or the number of labels differs; or the size is
        unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S-BW",
    ...                        bouc_wen=rf.BoucWen(yield_displacement=0.01))
    >>> figure = rf.plot_hysteresis(response)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$u_{\\mathrm{top}}$, relative [m]', '$V_b$ [kN]')
    """
    curves = response_curves(responses, labels)
    with with_figure_style(size=size):
        figure = new_figure(4.2, 3.6)
        lines = _draw_hysteresis(figure.subplots(), curves)
        add_response_legend(figure, curves, lines, [curve.label for curve in curves], title)
    return figure


def plot_yielding(
    responses: Response | Iterable[Response],
    labels: Sequence[str] | None = None,
    *,
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    r"""Plot rotation θ and top displacement u_top over time, and the hysteresis of the superstructure.

    The figure is that of Silva & Stojadinović 2024, Figs. 16 and 17. Peaks and uplifts are shown as in `plot_history`,
    loops as in `plot_hysteresis`.

    Parameters
    ----------
    responses
        One response or several, each with its history.
    labels
        A name for each response in the legend. Default: the models, with the motions if a model occurs twice.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Three axes: A, θ in rad over s; B, u_top in m over s; C, V_b, in the unit that suits its size, over m.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, or the number of labels differs; or the size is
        unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S-BW",
    ...                        bouc_wen=rf.BoucWen(yield_displacement=0.01))
    >>> figure = rf.plot_yielding(response)
    >>> len(figure.axes), figure.axes[-1].get_xlabel()
    (3, '$u_{\\mathrm{top}}$, relative [m]')
    """
    curves = response_curves(responses, labels)
    with with_figure_style(size=size):
        tall = max(1.45, 0.155 * (len(curves) + 2))
        figure = new_figure(8.6, (2.0 * tall if not is_narrow_figure() else 2.0 * tall + 2.6) + 0.9)
        if is_narrow_figure():
            grid = figure.add_gridspec(3, 1, height_ratios=(tall, tall, 2.6))
        else:
            grid = figure.add_gridspec(2, 2, width_ratios=(1.55, 1.0))
        top = figure.add_subplot(grid[0, 0])
        histories: list[Axes] = [top, figure.add_subplot(grid[1, 0], sharex=top)]
        for axes, quantity, mark in zip(
            histories, panel_quantities(("rotation", "top_displacement")), "AB", strict=True
        ):
            draw_history_panel(axes, quantity, curves, mark)
        shade_uplifts(histories, curves)
        top.tick_params(labelbottom=False)
        histories[1].set(xlabel="time [s]", xlim=(0.0, max(float(curve.history.time[-1]) for curve in curves)))
        loops = figure.add_subplot(grid[2, 0] if is_narrow_figure() else grid[:, 1])
        lines = _draw_hysteresis(loops, curves)
        label_panel(loops, "C")
        figure.align_ylabels(histories)
        add_response_legend(figure, curves, lines, [curve.label for curve in curves], title)
    return figure


def _draw_hysteresis(axes: Axes, curves: list[ResponseCurve]) -> list[Artist]:
    """Fill a panel with V_b over u_top; return a line for each curve."""
    displacement, force = panel_quantities(("top_displacement", "base_shear"))
    _, across, right = quantity_axis_scale(displacement, curves)
    factor, unit, high = quantity_axis_scale(force, curves)
    axes.set(xlim=(-right, right), ylim=(-high, high))
    axes.locator_params(axis="x", nbins=5)
    axes.set(xlabel=f"{displacement.symbol} [{across}]", ylabel=f"{force.symbol} [{unit}]")
    lines: list[Artist] = []
    for curve in curves:
        drawn = curve.before_fall
        lines += axes.plot(
            displacement.of(curve.history)[drawn], force.of(curve.history)[drawn] / factor, color=curve.style.color,
            linestyle=curve.style.dashes, linewidth=curve.style.width, label=curve.label, zorder=curve.order,
        )  # fmt: skip
    return lines
