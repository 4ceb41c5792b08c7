"""Histories: panels over time, their peaks and uplifts, and bands of varied properties."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from string import ascii_uppercase
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._number_format import short_number, unit_with_prefix
from rockflex._shown import shown
from rockflex.plot._response_curves import (
    ResponseCurve,
    response_curves,
    response_figure_title,
    rotation_axis_limit,
    time_axis_limits,
)
from rockflex.plot._style import (
    BLACK,
    GRAY,
    SHADE,
    Size,
    add_legend_above,
    is_narrow_figure,
    label_panel,
    new_figure,
    scaled_font_size,
    with_figure_style,
    write_notes_beside,
)
from rockflex.response import History, Response

_MARGIN = 1.12
_BAR = 0.025  # height of an uplift bar as a share of the panel
_POINTS = 2000  # across the panel, more than it has dots


@dataclass(frozen=True)
class PanelQuantity:
    """The quantity of a panel."""

    symbol: str
    name: str
    unit: str
    prefixed: bool
    of: Callable[[History], Array]


_QUANTITIES = (
    PanelQuantity("θ", "rotation", "rad", False, lambda h: h.rotation),
    PanelQuantity(r"$u_{\mathrm{top}}$, relative", "top_displacement", "m", False, lambda h: h.top_displacement),
    PanelQuantity(
        r"$u_{\mathrm{top}}$, total", "total_top_displacement", "m", False, lambda h: h.total_top_displacement
    ),
    PanelQuantity(r"$M_b$", "base_moment", "N m", True, lambda h: h.base_moment),
    PanelQuantity(r"$V_b$", "base_shear", "N", True, lambda h: h.base_shear),
    PanelQuantity(r"$ΣF_x$", "horizontal_reaction", "N", True, lambda h: h.horizontal_reaction),
    PanelQuantity("slip", "slip", "m", False, lambda h: h.slip),
    PanelQuantity("rise of edges", "edge_uplift", "m", False, lambda h: h.edge_uplift),
)
_OPTIONAL = ("horizontal_reaction", "slip", "edge_uplift")  # or shown where the ground makes them matter
PANELS = tuple(quantity.name for quantity in _QUANTITIES)


def default_history_panels(curves: list[ResponseCurve]) -> list[str]:
    """All but ΣF_x; total displacement if the height of the top is known, slip and edges if a base slides or heaves."""
    known = all(curve.history.model.properties.top_height is not None for curve in curves)
    usual = [name for name in PANELS if name not in _OPTIONAL and (known or name != "total_top_displacement")]
    layouts = [curve.history.model.layout for curve in curves]
    moves = {
        "slip": any(layout.slip >= 0 for layout in layouts),
        "edge_uplift": any(layout.heave >= 0 for layout in layouts),
    }
    return usual + [name for name, happens in moves.items() if happens]


def panel_quantities(panels: Sequence[str]) -> list[PanelQuantity]:
    """Quantities by name.

    Raises
    ------
    InputError
        If there are none, or one is unknown or repeated.
    """
    names = [panels] if isinstance(panels, str) else list(panels)
    if not names or len(set(names)) < len(names) or not set(names) <= set(PANELS):
        raise InputError(
            f"panels must be one or more of {', '.join(PANELS)}, each once, but {shown(panels)} was given."
        )
    return [next(quantity for quantity in _QUANTITIES if quantity.name == name) for name in names]


def quantity_axis_scale(quantity: PanelQuantity, curves: list[ResponseCurve]) -> tuple[float, str, float]:
    """Divisor, unit and largest magnitude of an axis, with some room."""
    largest = max(_largest_on_history_axis(curve, quantity) for curve in curves)
    if quantity.name == "rotation":
        largest = rotation_axis_limit(curves)
    factor, unit = unit_with_prefix(largest, quantity.unit) if quantity.prefixed else (1.0, quantity.unit)
    return factor, unit, _MARGIN * largest / factor if largest > 0.0 else 1e-3


def draw_history_panel(axes: Axes, quantity: PanelQuantity, curves: list[ResponseCurve], mark: str) -> list[Artist]:
    """Fill one panel over time and list the peaks beside it; return a line for each curve."""
    lines, peaks = draw_history_curves(axes, quantity, curves)
    label_panel(axes, mark)
    notes = [(text, curve.style.color) for text, curve in zip(peaks, curves, strict=True)]
    write_notes_beside(axes, [("peaks", "#404040"), *notes], 10.0)
    return lines


def draw_history_curves(
    axes: Axes, quantity: PanelQuantity, curves: list[ResponseCurve]
) -> tuple[list[Artist], list[str]]:
    """Fill one panel over time; return a line for each curve, and its peak in words."""
    factor, unit, limit = quantity_axis_scale(quantity, curves)
    low = -limit if quantity.name != "edge_uplift" else -_MARGIN * _largest_edge_settlement(curves, limit)
    axes.set(ylim=(low, limit), ylabel=f"{quantity.symbol} [{unit}]")
    lines: list[Artist] = []
    peaks: list[str] = []
    for curve in curves:
        style = curve.style
        first, *others = axes.plot(
            curve.history.time, quantity.of(curve.history) / factor, color=style.color, linestyle=style.dashes,
            linewidth=style.width, label=curve.label, zorder=curve.order,
        )  # fmt: skip
        lines.append(first)
        for right in others:  # the right edge is thinner than the left one
            right.set(linewidth=0.5 * style.width, label="_right")
        if curve.overturned:
            axes.axvline(curve.response.end_time, color=style.color, linestyle=":", linewidth=0.8, zorder=1.5)
        if curve.falls and quantity.name == "rotation":
            _mark_overturning(axes, curve, limit)
        peaks.append(_mark_peak(axes, quantity, curve, factor))
    return lines, peaks


def add_response_legend(
    figure: Figure,
    curves: list[ResponseCurve],
    handles: Sequence[Artist],
    names: Sequence[str],
    title: str | None,
    **options: Any,
) -> None:
    """Add the legend of responses above a figure, under its title."""
    add_legend_above(
        figure,
        handles,
        names,
        title=response_figure_title(curves, title),
        handlelength=2.6,
        columnspacing=1.4,
        **options,
    )


def _largest_on_history_axis(curve: ResponseCurve, quantity: PanelQuantity) -> float:
    """Largest magnitude on the axis."""
    if not curve.falls:
        return float(getattr(curve.response, f"max_{quantity.name}"))
    return float(np.max(np.abs(quantity.of(curve.history)[curve.before_fall])))


def _mark_peak(axes: Axes, quantity: PanelQuantity, curve: ResponseCurve, factor: float) -> str:
    """Circle the true peak, which may be between two nodes of the curve; return its text."""
    if curve.overturned and quantity.name == "rotation":
        return f"overturned, {curve.response.end_time:.2f} s"
    peak = float(getattr(curve.response, f"max_{quantity.name}")) / factor
    if peak == 0.0:
        return "0"
    when, side = _peak_time_and_sign(quantity, curve)
    axes.plot(
        [when], [side * peak], "o", color=curve.style.color, markersize=3.5, markerfacecolor="white",
        markeredgewidth=0.9, zorder=3.0,
    )  # fmt: skip
    return f"{short_number(peak)} at {when:.2f} s"


def _peak_time_and_sign(quantity: PanelQuantity, curve: ResponseCurve) -> tuple[float, float]:
    """Return the time and the sign of a peak."""
    time, values = curve.history.time, quantity.of(curve.history)
    if quantity.name == "edge_uplift":
        return float(time[values.max(axis=1).argmax()]), 1.0
    if quantity.name == "slip":
        node = int(np.abs(values).argmax())
        return float(time[node]), float(np.sign(values[node]))
    when = float(getattr(curve.response, f"time_of_max_{quantity.name}"))
    return when, float(np.sign(np.interp(when, time, values)))


def _largest_edge_settlement(curves: list[ResponseCurve], limit: float) -> float:
    """Return how far the edges sink in m, for the lower end of an axis that reaches up to `limit`."""
    return max(*(curve.response.max_edge_settlement for curve in curves), 0.05 * limit)


def _mark_overturning(axes: Axes, curve: ResponseCurve, limit: float) -> None:
    """Draw a triangle where the rotation finally leaves the panel."""
    rotation, time = curve.history.rotation, curve.history.time
    inside = np.flatnonzero(np.abs(rotation) <= limit)
    last = int(inside[-1]) if inside.size else 0
    if last + 1 == time.size:
        return
    around = slice(last, last + 2)
    when = float(np.interp(limit, np.abs(rotation[around]), time[around]))
    side = float(np.sign(rotation[-1]))
    marker = "^" if side > 0 else "v"
    axes.plot([when], [side * limit], marker, color=curve.style.color, markersize=6.0, clip_on=False, zorder=5.0)


def plot_history(
    responses: Response | Iterable[Response],
    labels: Sequence[str] | None = None,
    *,
    panels: Sequence[str] | None = None,
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    """Plot rotation θ, displacements of the top, base moment M_b and base shear V_b over time, one panel each.

    With ``panels=("rotation", "top_displacement", "base_moment", "base_shear")`` the figure is that of Silva &
    Stojadinović 2024, Fig. 15; with the first two, that of Figs. 3 and 4. Their u_top is relative to the rotating base;
    the total displacement is relative to the ground, and comparable with a fixed base. The times during which the base
    of the most detailed model is uplifted are shaded; if several models rock, bars at the bottom of the first panel
    show the uplifts of each. Circles mark the true peaks, which are listed with their times beside each panel.
    Overturning does not extend the axes: a triangle marks where the rotation leaves its panel, and a dotted line when
    |θ| = π/2.

    Parameters
    ----------
    responses
        One response or several, each with its history, of one structure or of several.
    labels
        A name for each response in the legend. Default: the models, with the motions if a model occurs twice.
    panels
        Which of ``"rotation"``, ``"top_displacement"``, ``"total_top_displacement"``, ``"base_moment"``,
        ``"base_shear"``, ``"horizontal_reaction"``, ``"slip"`` and ``"edge_uplift"`` (of the left edge, and thinner of
        the right one), from the top. Default: all but the last three; without the total displacement if the height of
        the top is not known, and with the slip if a base can slide and the edges if one is on springs.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per panel over a common time axis in s; θ in rad, displacements in m, M_b and V_b in units that suit
        their size.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, the number of labels differs, or a panel is
        unknown; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> figure = rf.plot_history(response, panels=["rotation", "base_moment"])
    >>> len(figure.axes), figure.axes[1].get_xlabel()
    (2, 'time [s]')
    """
    curves = response_curves(responses, labels)
    quantities = panel_quantities(default_history_panels(curves) if panels is None else panels)
    handles: list[Artist] = []
    with with_figure_style(size=size):
        figure = new_figure(6.3, len(quantities) * max(1.45, 0.155 * (len(curves) + 2)) + 0.8)
        grid: list[Axes] = list(figure.subplots(len(quantities), 1, sharex=True, squeeze=False).flat)
        for axes, quantity, mark in zip(grid, quantities, ascii_uppercase, strict=False):
            handles = draw_history_panel(axes, quantity, curves, mark)
        uplifts = shade_uplifts(grid, curves)
        grid[-1].set(xlabel="time [s]", xlim=time_axis_limits(curves))
        figure.align_ylabels()
        names = [curve.label for curve in curves]
        add_response_legend(figure, curves, [*handles, *uplifts.values()], [*names, *uplifts], title)
    return figure


def shade_uplifts(panels: list[Axes], curves: list[ResponseCurve]) -> dict[str, Artist]:
    """Shade the uplifts of the most detailed model; return the entry of the legend that names it, if there are any."""
    rocking = [curve for curve in curves if curve.uplifts.size]
    if not rocking:
        text = "no uplift" if any(curve.lifts for curve in curves) else "fixed base"
        panels[0].text(0.5, 0.75, text, transform=panels[0].transAxes, ha="center", va="center", color="#404040")
        return {}
    main = max(rocking, key=lambda curve: curve.history.model.properties.n_modes)
    for axes in panels:
        _draw_uplift_spans(axes, main, 0.0, 1.0, SHADE, 0.5)
    name = f"uplifted: {main.label}" if len(curves) > 1 else "uplifted"
    entry: dict[str, Artist] = {name: Patch(facecolor=SHADE, edgecolor=GRAY, linewidth=0.4)}
    if len(rocking) == 1:
        return entry
    low, high = panels[0].get_ylim()
    foot = _BAR * (len(rocking) + 1)
    panels[0].set_ylim(low - (high - low) * foot / (1.0 - foot), high)
    for row, curve in enumerate(reversed(rocking)):
        _draw_uplift_spans(panels[0], curve, _BAR * (row + 0.35), 0.7 * _BAR, curve.style.color, 2.6)
    return entry


def _draw_uplift_spans(
    axes: Axes, curve: ResponseCurve, bottom: float, height: float, color: str, order: float
) -> None:
    """Draw a bar over every phase of rocking; bottom and height are fractions of the panel."""
    spans = [(float(start), float(end - start)) for start, end in curve.uplifts]
    axes.broken_barh(
        spans, (bottom, height), transform=axes.get_xaxis_transform(), color=color, linewidth=0.0, zorder=order
    )


def plot_spread(
    responses: Sequence[Response],
    varied: Sequence[Sequence[Response]],
    labels: Sequence[str] | None = None,
    *,
    panels: Sequence[str] = ("rotation", "top_displacement"),
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    """Plot each response with the band from the smallest to the largest value of its variations at each time.

    The band is not a response: it encloses the variations that were run, and says nothing about others. A variation is
    excluded once it has ended or overturns.

    Parameters
    ----------
    responses
        One response per row, with its history.
    varied
        For each of them, the varied responses of the same model: at least one, with histories.
    labels
        A name for each response. Default: the models, with the motions if a model occurs twice.
    panels
        Panels of `plot_history`, from the left.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"``, as wide as a column (3.5 in) or a page (7.2 in) of a journal, or width and height in
        inches. Default: what suits the number of panels.

    Returns
    -------
    matplotlib.figure.Figure
        One row of axes per response and one column per panel, over a common time axis in s.

    Raises
    ------
    InputError
        If the number of groups of variations differs, one is empty or without history, or a panel is unknown; or the
        size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> others = [rf.simulate(frame, rf.ricker_pulse(a, 0.6), "2DOF-S") for a in (3.9, 4.1)]
    >>> figure = rf.plot_spread([response], [others], panels=["rotation"])
    >>> len(figure.axes), figure.axes[0].get_xlabel()
    (1, 'time [s]')
    """
    curves = response_curves(responses, labels)
    if len(varied) != len(curves) or not all(len(group) for group in varied):
        raise InputError(
            f"varied must hold {len(curves)} groups, one per response, each of at least one response, but groups of "
            f"{[len(group) for group in varied]} were given."
        )
    groups = [[_single_response_curve(response) for response in group] for group in varied]
    quantities = panel_quantities(panels)
    everything = [*curves, *(curve for group in groups for curve in group)]
    times = np.linspace(0.0, max(float(curve.history.time[-1]) for curve in curves), _POINTS)
    with with_figure_style(size=size):
        shape = (len(quantities) * len(curves), 1) if is_narrow_figure() else (len(curves), len(quantities))
        figure = new_figure(0.8 + 3.2 * len(quantities), 0.9 + 1.35 * shape[0])
        # A narrow figure has one column: all panels of the first quantity, then of the next.
        grid = figure.subplots(*shape, sharex=True, squeeze=False).reshape(len(curves), -1, order="F")
        for column, quantity in enumerate(quantities):
            factor, unit, limit = quantity_axis_scale(quantity, everything)
            for row, (curve, group) in enumerate(zip(curves, groups, strict=True)):
                axes: Axes = grid[row, column]
                low, high = _spread_of_histories(quantity, [curve, *group], times)
                axes.fill_between(times, low / factor, high / factor, color=SHADE, edgecolor=GRAY, linewidth=0.4)
                drawn = curve.before_fall
                values = quantity.of(curve.history)[drawn] / factor
                axes.plot(curve.history.time[drawn], values, color=BLACK, linewidth=0.8, label=curve.label)
                axes.set(ylim=(-limit, limit), xlim=(0.0, float(times[-1])), ylabel=f"{quantity.symbol} [{unit}]")
                axes.set_title(curve.label, fontsize=scaled_font_size(8.0), loc="left", pad=3.0)
            if column + 1 == len(quantities) or not is_narrow_figure():
                grid[-1, column].set_xlabel("time [s]")
        figure.align_ylabels()
        handles = [grid[0, 0].get_lines()[0], Patch(facecolor=SHADE, edgecolor=GRAY, linewidth=0.4)]
        names = ["nominal", "from the least to the largest of what was varied"]
        add_legend_above(figure, handles, names, title=response_figure_title(curves, title))
    return figure


def _single_response_curve(response: Response) -> ResponseCurve:
    return response_curves(response)[0]


def _spread_of_histories(quantity: PanelQuantity, curves: list[ResponseCurve], times: Array) -> tuple[Array, Array]:
    """Smallest and largest value at each time, among the runs that have not ended."""
    rows = np.full((len(curves), times.size), np.nan)
    for row, curve in zip(rows, curves, strict=True):
        drawn = curve.before_fall
        time = curve.history.time[drawn]
        inside = times <= time[-1]
        row[inside] = np.interp(times[inside], time, quantity.of(curve.history)[drawn])
    known = ~np.isnan(rows).all(axis=0)
    low, high = np.full(times.size, np.nan), np.full(times.size, np.nan)
    low[known], high[known] = np.nanmin(rows[:, known], axis=0), np.nanmax(rows[:, known], axis=0)
    return low, high
