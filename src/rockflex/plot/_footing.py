"""A base on its springs over time: its edges, the pressure under it, and how much of it is in contact."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._number_format import unit_with_prefix
from rockflex.modal import RockingProperties, Springs
from rockflex.plot._response_curves import response_curves, response_figure_title
from rockflex.plot._style import BLACK, BLUE, GRAY, RED, Size, label_panel, literal_text, new_figure, with_figure_style
from rockflex.response import History, Response

MAX_LINES = 4  # springs whose forces are drawn as lines; more springs as a map
_COLORS = (BLUE, RED, BLACK, GRAY)


def plot_footing(response: Response, *, title: str | None = None, size: Size | None = None) -> Figure:
    """Plot a base on springs over time: the rise of its edges, the pressure under it, and its share in contact.

    The pressure, or the force of each spring where the springs have no area, is a map over the width of the base and
    the time, white where the base is off the ground; the forces of up to four springs are lines. The share in contact
    counts each spring with the width nearest to it.

    Parameters
    ----------
    response
        One response with its history, of a structure on a `Ground` with springs.
    title
        Default: the name of the motion.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        Three axes over a common time axis in s, and that of the colours of a map.

    Raises
    ------
    InputError
        If the response has no history, or its base is not on springs; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> bed = rf.winkler_bed(frame.half_width, breadth=3.0, subgrade_modulus=2e8).damped(0.3, 160e3)
    >>> ground = rf.Ground(springs=bed, base_inertia=1e4)
    >>> figure = rf.plot_footing(rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S", ground=ground))
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['rise of edges [mm]', 'x [m]', 'in contact [%]', 'pressure [MPa]']
    """
    (curve,) = curves = response_curves(response)
    history = curve.history
    springs = history.model.springs
    if springs is None:
        raise InputError(
            "The base of this response is not on springs. Simulate it with "
            "ground=Ground(springs=..., base_inertia=...), or use plot_history."
        )
    with with_figure_style(size=size):
        figure = new_figure(6.3, 5.4)
        edges, soil, contact = figure.subplots(3, 1, sharex=True, height_ratios=(1.0, 1.3, 0.7))
        _draw_base_edges(edges, history)
        _draw_soil_pressure(figure, soil, history, springs)
        _draw_base_contact(contact, history, springs)
        for axes, mark in zip((edges, soil, contact), "ABC", strict=True):
            label_panel(axes, mark)
        contact.set_xlabel("time [s]")
        contact.set_xlim(float(history.time[0]), float(history.time[-1]))
        figure.align_ylabels([edges, soil, contact])
        edges.set_title(
            literal_text(curve.label) + (f" under {given}" if (given := response_figure_title(curves, title)) else "")
        )
    return figure


def tributary_shares(springs: Springs, p: RockingProperties) -> Array:
    """Return the share of the width of the base that is nearest to each spring, shape (n_springs,)."""
    places = springs.positions
    middles = 0.5 * (places[1:] + places[:-1])
    ends = np.clip(np.concatenate(([-p.pivot(-1).arm], middles, [p.pivot(1).arm])), -p.pivot(-1).arm, p.pivot(1).arm)
    return np.diff(ends) / (2.0 * p.half_width)


def _draw_base_edges(axes: Axes, history: History) -> None:
    for values, name, color in zip(1e3 * history.edge_uplift.T, ("left", "right"), (BLUE, RED), strict=True):
        axes.plot(history.time, values, color=color, linewidth=0.9, label=f"{name} edge")
    axes.axhline(0.0, color=GRAY, linewidth=0.7)
    axes.set_ylabel("rise of edges [mm]")
    axes.legend(loc="upper right", ncols=2)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.25 * (high - low))  # room for the legend


def _draw_soil_pressure(figure: Figure, axes: Axes, history: History, springs: Springs) -> None:
    area = springs.area
    name, pushes = ("force", history.spring_force) if area is None else ("pressure", history.soil_pressure)
    factor, unit = unit_with_prefix(float(pushes.max()), "N" if area is None else "Pa")
    places = springs.positions
    if places.size <= MAX_LINES:
        for place, force, color in zip(places, pushes.T / factor, _COLORS, strict=False):
            axes.plot(history.time, force, color=color, linewidth=0.9, label=f"x = {place:.3g} m".replace("-", "−"))
        axes.set_ylabel(f"{name} [{unit}]")
        axes.legend(loc="upper right", ncols=places.size)
        axes.set_ylim(0.0, 1.25 * float(pushes.max()) / factor)
        return
    distinct = np.concatenate(([True], np.diff(history.time) > 0.0))
    shown = np.ma.masked_less_equal(pushes[distinct].T / factor, 0.0)
    mesh = axes.pcolormesh(history.time[distinct], places, shown, cmap="YlOrBr", shading="nearest", rasterized=True)
    mesh.set_clim(0.0)
    axes.set_ylabel("x [m]")
    axes.grid(visible=False)
    figure.colorbar(mesh, ax=axes, label=f"{name} [{unit}]", pad=0.01)


def _draw_base_contact(axes: Axes, history: History, springs: Springs) -> None:
    contact_share = (history.spring_force > 0.0) @ tributary_shares(springs, history.model.properties)
    axes.fill_between(history.time, 100.0 * contact_share, color=GRAY, alpha=0.5, linewidth=0.0)
    axes.plot(history.time, 100.0 * contact_share, color=BLACK, linewidth=0.7)
    axes.set(ylim=(0.0, 104.0), ylabel="in contact [%]")
