"""Loops of a base and of its elements."""

import math
from functools import partial
from typing import cast

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._arrays import Array
from rockflex.plot._base_loops import COLORS, BaseLoops, base_loops, name_of
from rockflex.plot._style import BLACK, BLUE, GRAY, Size, columns, literal, narrow, new_figure, styled
from rockflex.plot._units import readable
from rockflex.response import MomentRotation, MomentRotationOnSprings, Response

_PER_ROW = 2


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
    drawn = [] if loops.edges is None else [_draw_edges]
    drawn += [partial(_draw_element, place=place) for place in range(len(loops.elements))]
    count = len(drawn)
    with styled(size=size):
        rows = count if narrow() else max(math.ceil(count / _PER_ROW), 1)
        beside = 0 if narrow() else math.ceil(count / rows)
        figure = new_figure(4.2 + 2.2 * beside, max(3.6, (3.3 if narrow() else 0.7) + 2.3 * rows))
        figure.get_layout_engine().set(w_pad=0.07)  # pyright: ignore
        if narrow():
            grid = figure.add_gridspec(1 + rows, 1, height_ratios=(1.4, *[1.0] * rows))
            base = figure.add_subplot(grid[0, 0])
        else:
            grid = figure.add_gridspec(rows, 1 + beside, width_ratios=(1.7, *[1.0] * beside))
            base = figure.add_subplot(grid[:, 0])
        _draw_base(base, loops)
        for place, draw in enumerate(drawn):
            row, column = (1 + place, 0) if narrow() else (place // beside, 1 + place % beside)
            draw(figure.add_subplot(grid[row, column]), loops)
        lines = base.get_lines()
        names = [str(line.get_label()) for line in lines]
        figure.legend(
            lines, names, loc="outside upper center", ncols=columns(names, 36 + 22 * beside),
            title=literal(title) if title is not None else loops.title, title_fontsize="medium", handlelength=2.0,
        )  # fmt: skip
    return figure


def _draw_base(axes: Axes, loops: BaseLoops) -> None:
    moment = loops.moment
    factor, unit = readable(max(map(abs, (*moment, 0.0))), "N m")
    axes.plot(loops.rotation, moment / factor, color=BLACK, linewidth=1.4, label="total", zorder=3.0)
    if loops.elements or loops.springs is not None:
        axes.plot(loops.rotation, loops.weight / factor, color=GRAY, linewidth=0.9, label="weight")
    if loops.springs is not None:
        axes.plot(loops.rotation, loops.springs / factor, color=BLUE, linewidth=0.9, label="springs")
    for place, element in enumerate(loops.elements):
        axes.plot(
            loops.rotation, loops.parts[:, place] / factor, color=_color(place), linewidth=0.9,
            label=name_of(element, place + 1),
        )  # fmt: skip
    axes.set(xlabel="θ [rad]", ylabel=f"M [{unit}]")
    axes.locator_params(axis="x", nbins=6)


def _draw_edges(axes: Axes, loops: BaseLoops) -> None:
    edges = cast("Array", loops.edges)
    axes.axhline(0.0, color=GRAY, linewidth=0.6, label="_level")
    for edge, style, name in zip(edges.T, ("-", (0, (4, 2))), ("left", "right"), strict=True):
        axes.plot(loops.rotation, 1e3 * edge, color=BLUE, linestyle=style, linewidth=1.1, label=name)
    axes.set(title="edges of the base", xlabel="θ [rad]", ylabel="rise [mm]")
    axes.locator_params(axis="x", nbins=4)
    axes.legend(handlelength=2.0)


def _draw_element(axes: Axes, loops: BaseLoops, place: int) -> None:
    force = loops.force[:, place]
    factor, unit = readable(max(map(abs, (*force, 0.0))), "N")
    axes.plot(loops.elongation[:, place], force / factor, color=_color(place), linewidth=1.1)
    axes.set(title=name_of(loops.elements[place], place + 1), xlabel="δ [m]", ylabel=f"F [{unit}]")
    axes.locator_params(axis="x", nbins=4)


def _color(place: int) -> str:
    return COLORS[place % len(COLORS)]
