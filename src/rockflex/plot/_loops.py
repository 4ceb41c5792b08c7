"""Moments over rotations and forces over elongations: of bases, of elements, and of superstructures."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number, unit_with_prefix
from rockflex.plot import _figures as figures
from rockflex.plot import _history as histories
from rockflex.plot._figures import BLACK, BLUE, GRAY, GREEN, ORANGE, PURPLE, RED, SKY, SMALL, Lines, Size
from rockflex.plot._history import ResponseCurve
from rockflex.response._moment_rotation import (
    MomentRotation,
    MomentRotationOnSprings,
    element_resistance,
    large_resistance,
    resistance_on_springs,
    weight_resistance,
)
from rockflex.response._quasi_static import static_path
from rockflex.response._response import Response
from rockflex.structure._base_element import BaseElement
from rockflex.structure._pivot import Pivot
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import RockingStructure, rocking_properties_of

_COLORS = (SKY, ORANGE, PURPLE, GREEN, RED, "#7a5195")  # of elements, in their order
_PER_ROW = 2
_LIMIT = 1.1
_RUNS_PER_ROW = 3
_WITHOUT_TENDONS = r"$\pm(m_{tot}\,g\,B - L_0^r\,g\,|θ|)$"
_WITH_TENDONS = r"$\pm(M_r - (L_0^r\,g - k_t)\,|θ|)$"
_LAW_MARGIN = 1.18


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
    """Return the path of a base from a cyclic pushover, or from the history of a run."""
    given: Any = result
    if hasattr(given, "weight_moment"):  # a quasi-static path
        return BaseLoops(
            "", given.elements, given.rotation, given.weight_moment, given.element_moment, given.element_elongation,
            given.element_force, given.spring_moment, given.edge_uplift,
        )  # fmt: skip
    if not hasattr(given, "history"):
        raise InputError(
            f"result must be a Response or a MomentRotation, but {type(given).__name__} was given. Give what simulate "
            "or moment_rotation returned."
        )
    (curve,) = curves = histories.response_curves(given)
    if not curve.lifts:
        raise InputError(
            "The base of this response cannot lift, so it has no loops. Give the response of a model that rocks, such "
            'as "2DOF-S".'
        )
    return _loops_of_run(curve, histories.response_figure_title(curves, None))


def _loops_of_run(curve: ResponseCurve, title: str = "") -> BaseLoops:
    history, until_fall = curve.history, curve.before_fall
    p, side = history.model.properties, history.side.astype(np.int64)
    on_springs = resistance_on_springs(history)
    springs = edges = None
    drawn: slice | NDArray[np.intp] = until_fall
    if on_springs is not None:
        weight, parts = on_springs.weight, on_springs.elements
        springs, edges = on_springs.springs[drawn], history.edge_uplift[drawn]
    else:
        drawn = np.flatnonzero(history.side[until_fall] != 0.0)
        if history.model.complete:
            weight, parts = large_resistance(p, side, history.rotation, history.element_force)
        else:
            weight = weight_resistance(p, side, history.rotation)
            parts = element_resistance(p, side, history.element_force)
        weight = (1.0 + history.vertical_ground_acceleration / GRAVITY) * weight
    return BaseLoops(
        title, p.elements, history.rotation[drawn], weight[drawn], parts[drawn],
        history.element_elongation[until_fall], history.element_force[until_fall], springs, edges,
    )  # fmt: skip


def is_moment_path_independent(properties: RockingProperties) -> bool:
    """Whether the resisting moment depends on the rotation alone: all elements stay elastic."""
    return not any(each.dissipates for each in properties.elements)


def _element_name(elements: Sequence[BaseElement], place: int) -> str:
    """Name of an element in a figure, with its number, counted from 1, and its position."""
    element = elements[place]
    where = element.where_in(figures.axis_unit("length"))
    return f"{place + 1} {translated(element.words)}, {where}"


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
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e9, base_mass=10e3,
    ...     half_width=1.5, damping_ratio=0.02
    ... )
    >>> fuse = rf.YieldingDissipator(stiffness=60e6, yield_force=150e3)
    >>> held = rf.Restrained(wall,
    ...     [rf.Tendon(initial_force=300e3, stiffness=8e6), fuse])
    >>> figure = rf.plot_loops(rf.moment_rotation(held, [0.02, -0.02, 0.0]))
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['M [MN m]', 'F [kN]', 'F [kN]']
    """
    loops = base_loops(result)
    drawn = [] if loops.edges is None else [_draw_edge_loops]
    drawn += [partial(_draw_element_loop, place=place) for place in range(len(loops.elements))]
    count = len(drawn)
    with figures.applied_figure_style(size=size):
        narrow = figures.is_narrow()
        rows = count if narrow else max(math.ceil(count / _PER_ROW), 1)
        beside = 0 if narrow else math.ceil(count / rows)
        figure = figures.new_figure(4.2 + 2.2 * beside, max(3.6, (3.3 if narrow else 0.7) + 2.3 * rows))
        figure.get_layout_engine().set(w_pad=0.07)  # pyright: ignore
        if narrow:
            grid = figure.add_gridspec(1 + rows, 1, height_ratios=(1.4, *[1.0] * rows))
            base = figure.add_subplot(grid[0, 0])
        else:
            grid = figure.add_gridspec(rows, 1 + beside, width_ratios=(1.7, *[1.0] * beside))
            base = figure.add_subplot(grid[:, 0])
        _draw_base_loop(base, loops)
        for place, draw in enumerate(drawn):
            row, column = (1 + place, 0) if narrow else (place // beside, 1 + place % beside)
            draw(figure.add_subplot(grid[row, column]), loops)
        heading = figures.literal_text(title) if title is not None else loops.title
        figures.add_legend_above(figure, base.get_lines(), title=heading, handlelength=2.0)
    return figure


def _draw_base_loop(axes: Axes, loops: BaseLoops) -> None:
    moment = loops.moment
    factor, unit = figures.axis_unit("moment", max(map(abs, (*moment, 0.0))))
    turn = figures.axis_unit("rotation")
    rotation = loops.rotation / turn.size
    axes.plot(rotation, moment / factor, color=BLACK, linewidth=1.4, label=translated("total"), zorder=3.0)
    if loops.elements or loops.springs is not None:
        axes.plot(rotation, loops.weight / factor, color=GRAY, linewidth=0.9, label=translated("weight"))
    if loops.springs is not None:
        axes.plot(rotation, loops.springs / factor, color=BLUE, linewidth=0.9, label=translated("springs"))
    for place, part in enumerate(loops.parts.T):
        color, name = _COLORS[place % len(_COLORS)], _element_name(loops.elements, place)
        axes.plot(rotation, part / factor, color=color, linewidth=0.9, label=name)
    axes.set(xlabel=turn.heading("θ"), ylabel=f"M [{unit}]")
    axes.locator_params(axis="x", nbins=6)


def _draw_edge_loops(axes: Axes, loops: BaseLoops) -> None:
    edges = cast("Array", loops.edges)
    unit, turn = figures.axis_unit("displacement", usual="mm"), figures.axis_unit("rotation")
    names = (translated("left"), translated("right"))
    axes.axhline(0.0, color=GRAY, linewidth=0.6, label="_level")
    for edge, style, name in zip(edges.T / unit.size, ("-", (0, (4, 2))), names, strict=True):
        axes.plot(loops.rotation / turn.size, edge, color=BLUE, linestyle=style, linewidth=1.1, label=name)
    labels = {"xlabel": turn.heading("θ"), "ylabel": unit.heading(translated("rise"))}
    axes.set(title=translated("edges of the base"), **labels)
    axes.locator_params(axis="x", nbins=4)
    axes.legend(handlelength=2.0)


def _draw_element_loop(axes: Axes, loops: BaseLoops, place: int) -> None:
    force = loops.force[:, place]
    factor, unit = figures.axis_unit("force", max(map(abs, (*force, 0.0))))
    across = figures.axis_unit("displacement")
    axes.plot(
        loops.elongation[:, place] / across.size, force / factor, color=_COLORS[place % len(_COLORS)], linewidth=1.1
    )
    axes.set(title=_element_name(loops.elements, place), xlabel=across.heading("δ"), ylabel=f"F [{unit}]")
    axes.locator_params(axis="x", nbins=4)


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
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S-BW",
    ...                        bouc_wen=rf.BoucWen(yield_displacement=0.01))
    >>> figure = rf.plot_hysteresis(response)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('$u_{\\mathrm{top}}$ relative [m]', '$V_b$ [kN]')
    """
    curves = histories.response_curves(responses, labels)
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(4.2, 3.6)
        lines = _draw_hysteresis(figure.subplots(), curves)
        histories.add_legend(figure, curves, lines, {}, title)
    return figure


def plot_yielding(
    responses: Response | Iterable[Response],
    labels: Sequence[str] | None = None,
    *,
    lines: Lines | None = None,
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
    lines
        Colour and line style of each response, as in `plot_history`. Default: by model.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S-BW",
    ...                        bouc_wen=rf.BoucWen(yield_displacement=0.01))
    >>> figure = rf.plot_yielding(response)
    >>> len(figure.axes), figure.axes[-1].get_xlabel()
    (3, '$u_{\\mathrm{top}}$ relative [m]')
    """
    curves = histories.response_curves(responses, labels, lines)
    with figures.applied_figure_style(size=size):
        tall, narrow = max(1.45, 0.155 * (len(curves) + 2)), figures.is_narrow()
        figure = figures.new_figure(8.6, 2.0 * tall + 2.6 * narrow + 0.9)
        if narrow:
            grid = figure.add_gridspec(3, 1, height_ratios=(tall, tall, 2.6))
        else:
            grid = figure.add_gridspec(2, 2, width_ratios=(1.55, 1.0))
        top = figure.add_subplot(grid[0, 0])
        panels: list[Axes] = [top, figure.add_subplot(grid[1, 0], sharex=top)]
        quantities = histories.panel_quantities(("rotation", "top_displacement"))
        for axes, quantity, mark in zip(panels, quantities, "AB", strict=True):
            histories.draw_panel(axes, quantity, curves, mark)
        histories.shade_uplifts(panels, curves)
        top.tick_params(labelbottom=False)
        panels[1].set(xlabel=translated("time [s]"), xlim=(0.0, histories.time_axis_limits(curves)[1]))
        loops = figure.add_subplot(grid[2, 0] if narrow else grid[:, 1])
        handles = _draw_hysteresis(loops, curves)
        figures.label_panel(loops, "C")
        figure.align_ylabels(panels)
        histories.add_legend(figure, curves, handles, {}, title)
    return figure


def _draw_hysteresis(axes: Axes, curves: list[ResponseCurve]) -> list[Artist]:
    """Fill a panel with V_b over u_top; return a line for each curve."""
    displacement, force = histories.panel_quantities(("top_displacement", "base_shear"))
    across, right = histories.quantity_axis_scale(displacement, curves)
    unit, high = histories.quantity_axis_scale(force, curves)
    axes.set(xlim=(-right, right), ylim=(-high, high))
    axes.locator_params(axis="x", nbins=5)
    axes.set(xlabel=across.heading(displacement.label), ylabel=unit.heading(force.label))
    lines: list[Artist] = []
    for curve in curves:
        drawn = curve.before_fall
        lines += axes.plot(
            displacement.of(curve.history)[drawn] / across.size, force.of(curve.history)[drawn] / unit.size,
            **curve.style.look, linewidth=curve.style.width, label=curve.label, zorder=curve.order,
        )  # fmt: skip
    return lines


def plot_moment_rotation(
    responses: Response | Iterable[Response], labels: Sequence[str] | None = None, *, size: Size | None = None
) -> Figure:
    """Plot the base moment M_b over the rotation θ, and the static resisting moment of the simplified models.

    The resisting moment is ±(M_r - L_0^r g |θ|), with M_r = m_tot g B (Silva & Stojadinović 2024, Fig. 11 and Eq. 23);
    tendons add their prestress to M_r and their stiffness k_t to the slope, and the two sides differ if the base is
    eccentric or the tendons are not symmetric. With elements that yield, slide or damp, the resisting moment depends on
    the path, and that of the run is plotted: `plot_loops` shows its parts. On springs the static moment is that of
    `moment_rotation`. M_b is the moment of the elastic forces; it
    differs from the resisting moment by rotational inertia and damping. Responses on a fixed base have no rotation and
    are left out. Overturning does not extend the axes.

    Parameters
    ----------
    responses
        One response or several, each with its history.
    labels
        A name for each response. Default: the models, with the motions if a model occurs twice.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per response, three per row, with common scales; θ in rad, M_b in a unit that suits its size.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, the number of labels differs, or no base can
        lift; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> figure = rf.plot_moment_rotation(response)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('', '')
    """
    curves = [curve for curve in histories.response_curves(responses, labels) if curve.lifts]
    if not curves:
        raise InputError(
            "None of the responses has a base that can lift, so there is no moment over rotation to plot. "
            'Give at least one of a model that rocks, such as "2DOF-S".'
        )
    rotation = _LIMIT * (histories.rotation_axis_limit(curves) or max(map(static_line_rotation, curves)))
    largest = max(largest_base_moment_on_axes(curve) for curve in curves)
    factor, unit = figures.axis_unit("moment", largest)
    turn = figures.axis_unit("rotation")
    with figures.applied_figure_style(size=size):
        columns = 1 if figures.is_narrow() else min(len(curves), _RUNS_PER_ROW)
        rows = math.ceil(len(curves) / columns)
        figure = figures.new_figure(2.2 + 1.8 * columns, 0.6 + 2.6 * rows)
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        panels: list[Axes] = list(grid.flat)
        right, high = rotation / turn.size, _LIMIT * largest / factor
        panels[0].set(xlim=(-right, right), ylim=(-high, high))
        panels[0].locator_params(axis="x", nbins=5)
        for axes, curve in zip(panels, curves, strict=False):
            moment = curve.history.base_moment / factor
            theta = curve.history.rotation / turn.size
            axes.plot(theta, moment, color=curve.style.color, linewidth=0.8, label=curve.label)
            axes.add_line(resisting_moment_line(curve, rotation, factor, turn.size))
            axes.set_title(curve.label)
            axes.tick_params(labelbottom=True)
        for axes in panels[len(curves) :]:
            axes.set_axis_off()
        figure.supxlabel(turn.heading("θ"), fontsize="medium")
        figure.supylabel(f"$M_b$ [{unit}]", fontsize="medium")
        kinds = {line.get_label(): line for axes in panels for line in axes.get_lines()[1:]}
        figures.add_legend_above(figure, list(kinds.values()), max_columns=1, handlelength=3.0)
    return figure


def static_line_rotation(curve: ResponseCurve) -> float:
    """Rotation up to which the static line is shown: where the moment vanishes, if it does."""
    balance = curve.balance_rotation
    return balance if math.isfinite(balance) else curve.history.model.properties.nominal_overturning_rotation


def largest_base_moment_on_axes(curve: ResponseCurve) -> float:
    """Largest moment on the axes: of the static moment, and of M_b without overturning."""
    moment = curve.response.max_base_moment
    if curve.falls:
        moment = float(np.max(np.abs(curve.history.base_moment[curve.before_fall])))
    p = curve.history.model.properties
    held = 0.0 if is_moment_path_independent(p) else float(np.max(np.abs(_loops_of_run(curve).moment), initial=0.0))
    return max(moment, held, *(pivot.resisting_moment for pivot in p.pivots))


def resisting_moment_line(curve: ResponseCurve, rotation: float, factor: float, turn: float) -> Line2D:
    model, p = curve.history.model, curve.history.model.properties
    if not is_moment_path_independent(p):
        loops = _loops_of_run(curve)
        label = translated("resisting moment of weight and elements")
        return Line2D(loops.rotation / turn, loops.moment / factor, color=BLUE, linewidth=0.8, label=label, zorder=3.0)
    if model.springs is not None:
        push = static_path(p, np.array([rotation, -rotation]), model.springs, model.rest)
        theta, moment, label = push.rotation, push.moment / factor, translated("static, on the springs")
    else:
        right, left = (
            (each.resisting_moment / factor, (each.resisting_moment + each.rocking_stiffness * rotation) / factor)
            for each in (p.pivot(1), p.pivot(-1))
        )
        theta, moment = [-rotation, 0.0, 0.0, rotation], [-left[1], -left[0], *right]
        law = _WITHOUT_TENDONS if p.symmetric and not p.tendons else _WITH_TENDONS
        label = translated("static, {law}" if p.symmetric else "static, {law} of each side", law=law)
    theta = np.asarray(theta) / turn
    return Line2D(theta, moment, color=BLUE, linestyle=(0, (4, 2)), linewidth=1.1, label=label, zorder=3.0)


def plot_moment_rotation_laws(
    structure: "RockingStructure | RockingProperties",
    spring: float | None = None,
    *,
    rotation: float | None = None,
    size: Size | None = None,
) -> Figure:
    """Plot the static base moment over the rotation: of a pinned beam on a spring, and of the rocking structure.

    The figure is that of Silva & Stojadinović 2024, Fig. 11: M = k_r θ, and M = ±(M_r + k |θ|) with the slope
    k = -L_0^r g, to which tendons add theirs. While the base stands, M is anything between -M_r and M_r. For an
    eccentric base, or tendons that are not symmetric, M_r and k differ between the two sides. With elements that yield
    or slide, the curve is that of a first push to each side; `plot_loops` shows cycles.

    Parameters
    ----------
    structure
        The rocking structure, or its `RockingProperties`.
    spring
        Stiffness k_r of the pinned beam's spring in N m/rad, positive. Default: L_0^r g, so that the slopes
        differ only in sign.
    rotation
        Largest rotation shown in rad. Default: a little beyond the one at which M vanishes, or the nominal
        overturning rotation where tendons keep it from vanishing.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        Two axes; θ in rad, M in the unit that suits its size.

    Raises
    ------
    InputError
        If no structure is given, or a number is not positive and finite; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> figure = rf.plot_moment_rotation_laws(frame)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('θ [rad]', 'M [MN m]')
    """
    p = rocking_properties_of(structure)
    sides = (p.pivot(1), p.pivot(-1))
    zeros = [side.balance_rotation for side in sides]
    vanishing = [zero for zero in zeros if math.isfinite(zero)]
    default = _LAW_MARGIN * max(vanishing) if vanishing else max(each.nominal_overturning_rotation for each in sides)
    end = default if rotation is None else checked_positive("rotation", rotation, "rad")
    stiffness = p.l0r * GRAVITY if spring is None else checked_positive("spring", spring, "N m/rad")
    pushes: list[tuple[Array, Array]] = []
    for side in (1, -1):  # |θ| and M of a first push to one side, from lift-off on
        push = static_path(p, np.array([side * end]))
        pushes.append((np.abs(push.rotation[1:]), side * push.moment[1:]))
    starts, lasts = ([moment[place] for _, moment in pushes] for place in (0, -1))
    largest = max(float(np.max(np.abs(moment))) for _, moment in pushes)
    factor, unit = unit_with_prefix(largest, "N m")
    line = is_moment_path_independent(p)
    if not line:
        zeros = [_rotation_of_zero_moment(*push) for push in pushes]
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 5.6 if figures.is_narrow() else 3.1)
        left, right = figure.subplots(*((2, 1) if figures.is_narrow() else (1, 2)), sharex=True, sharey=True)
        for axes, mark, title in ((left, "A", "pinned beam on a spring"), (right, "B", "rocking base")):
            axes.axhline(0.0, color=GRAY, linewidth=0.8, label="_axis")
            axes.axvline(0.0, color=GRAY, linewidth=0.8, label="_axis")
            axes.set(title=title, xlabel="θ [rad]")
            axes.tick_params(labelleft=True)
            figures.label_panel(axes, mark)
        left.set(
            ylabel=f"M [{unit}]",
            xlim=(-end, end),
            ylim=(-_LAW_MARGIN * largest / factor, _LAW_MARGIN * largest / factor),
        )
        left.locator_params(axis="x", nbins=5)
        moment = stiffness * end / factor
        left.plot([-end, end], [-moment, moment], color=BLACK, linewidth=1.4, label="pinned beam")
        right.plot(
            np.concatenate((-pushes[1][0][::-1], pushes[0][0])),
            np.concatenate((-pushes[1][1][::-1], pushes[0][1])) / factor,
            color=BLACK, linewidth=1.4, label="rocking",
        )  # fmt: skip
        _write_moment_note(left, f"slope $k_r$ =\n{_moment_with_unit(stiffness, 'N m/rad')}", low=True)
        low = lasts[0] > -0.3 * starts[0]
        crossings = [sign * zero for sign, zero in ((-1.0, zeros[1]), (1.0, zeros[0])) if zero <= end]
        if crossings:
            right.plot(
                crossings, [0.0] * len(crossings), "o", color=BLACK, markersize=4.0, markerfacecolor="white", label="_0"
            )
        slope = _moment_slope_text(sides, symmetric=p.symmetric) if line else ""
        zero = _vanishing_moment_text(zeros, end, symmetric=p.symmetric) if line or min(zeros) <= end else ""
        resisting = [f"$M_r$ = {_moment_with_unit(start, 'N m')}" for start in starts]
        corners = not p.symmetric or low  # where M_r is written; else with the rest
        if corners:
            _write_beside_moment_corner(right, resisting[0], starts[0] / factor, left=True)
        if not p.symmetric:
            _write_beside_moment_corner(right, resisting[1], -starts[1] / factor, left=False)
            for zero_at in crossings:
                right.annotate(
                    f"{short_number(zero_at)} rad", (zero_at, 0.0), xytext=(5, 4), ha="left", va="bottom",
                    textcoords="offset points", fontsize=SMALL,
                )  # fmt: skip
        lines = (slope, zero) if corners else (zero, slope, resisting[0])
        at = 0.48 if low and not p.symmetric else None  # between the axis and the lower corner
        _write_moment_note(right, "\n".join(filter(None, lines)), low=low, at=at)
    return figure


def _rotation_of_zero_moment(rotation: Array, moment: Array) -> float:
    """Rotation at which the moment first vanishes; infinite if it does not."""
    below = np.flatnonzero((moment[:-1] > 0.0) & (moment[1:] <= 0.0))[:1]
    if not below.size:
        return math.inf
    k = int(below[0])
    return float(rotation[k] + (rotation[k + 1] - rotation[k]) * moment[k] / (moment[k] - moment[k + 1]))


def _moment_slope_text(sides: tuple[Pivot, Pivot], *, symmetric: bool) -> str:
    held = any(side.tendon_stiffness for side in sides)
    name = r"k_t - L_0^r\,g" if held else r"-L_0^r\,g"
    values = [_moment_with_unit(side.rocking_stiffness, "N m/rad") for side in sides]
    both = values[0] if symmetric or not held else f"{values[0]} (right)\n{values[1]} (left)"
    return f"slope ${name}$ =\n{both}"


def _vanishing_moment_text(zeros: list[float], end: float, *, symmetric: bool) -> str:
    """Text about the rotations at which M vanishes, if they are shown; beside the marks if each side has its own."""
    if symmetric and zeros[0] <= end:
        return f"$M$ = 0 at ±{short_number(zeros[0])} rad"
    return "$M$ does not vanish" if all(map(math.isinf, zeros)) else ""


def _moment_with_unit(value: float, unit: str) -> str:
    factor, named = unit_with_prefix(value, unit)
    return f"{short_number(value / factor)} {named}"


def _write_beside_moment_corner(axes: Axes, text: str, moment: float, *, left: bool) -> None:
    """Write next to the corner of the curve at θ = 0, on the free side."""
    axes.annotate(
        text, (0.0, moment), xytext=(-4 if left else 4, 0), ha="right" if left else "left", va="center",
        textcoords="offset points", fontsize=SMALL,
    )  # fmt: skip


def _write_moment_note(axes: Axes, text: str, *, low: bool, at: float | None = None) -> None:
    """Write into the lower or the upper right corner, whichever is free, or below a given height."""
    height = at if at is not None else (0.03 if low else 0.97)
    axes.text(
        0.97, height, text, transform=axes.transAxes, ha="right", va="bottom" if low and at is None else "top",
        fontsize=SMALL, linespacing=1.5,
    )  # fmt: skip
