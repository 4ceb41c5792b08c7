"""Responses over time: prepared for figures, their histories and spread, their energy, and a base on springs."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from string import ascii_uppercase
from typing import Any, Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number
from rockflex.foundation.shown import shown
from rockflex.foundation.units import Unit
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLACK, BLUE, GRAY, GREEN, ORANGE, PURPLE, RED, SHADE, SKY, Lines, LineStyle, Size
from rockflex.response._history import History
from rockflex.response._outputs import HISTORY
from rockflex.response._response import Response, history_of
from rockflex.structure._ground import Springs
from rockflex.structure._rocking import RockingProperties

_MARGIN = 1.12
_BAR = 0.025  # height of an uplift bar as a share of the panel
_POINTS = 2000  # across the panel, more than it has dots
_OPTIONAL = (
    "horizontal_reaction",
    "joint_rotation",
    "slip",
    "edge_uplift",
    "ground_acceleration",
)  # or shown where the ground makes them matter
BROWN, SAND, CLAY = "#7d5a30", "#d8c9a3", "#b8926a"  # of the ground
MAX_LINES = 4  # springs whose forces are drawn as lines; more springs as a map
_SPRING_COLORS = (BLUE, RED, BLACK, GRAY)


@dataclass(frozen=True, eq=False)
class ResponseCurve:
    """One response with its history, label and line style."""

    response: Response
    history: History
    label: str
    style: LineStyle

    @property
    def overturned(self) -> bool:
        """Whether |θ| reached π/2."""
        return self.response.status == "overturned"

    @property
    def lifts(self) -> bool:
        """Whether the base of the model can lift."""
        return self.history.model.lifts

    @property
    def order(self) -> float:
        """Drawing order: models with fewer modes on top, and dashes over solid lines, which show through the gaps."""
        modes = 2.0 + 1.0 / (1.0 + self.history.model.properties.n_modes) if self.lifts else 1.9
        return modes - 0.01 * (self.style.dashes == "-")

    @property
    def balance_rotation(self) -> float:
        """Rotation α in rad at which the static resisting moment vanishes, on the side where it is larger.

        Infinite if tendons prevent it.
        """
        return max(pivot.balance_rotation for pivot in self.history.model.properties.pivots)

    @property
    def balance(self) -> Array:
        """The same, on the side of the rotation at each state."""
        p = self.history.model.properties
        return np.where(self.history.rotation < 0.0, p.pivot(-1).balance_rotation, p.pivot(1).balance_rotation)

    @property
    def uplifts(self) -> Array:
        """Start and end of every uplift in s, shape (n_phases, 2), on either side."""
        h = self.history
        lifted = np.concatenate(([0], h.uplifted, [0]))
        starts, ends = np.flatnonzero(np.diff(lifted) > 0), np.flatnonzero(np.diff(lifted) < 0) - 1
        return np.column_stack((h.time[starts], h.time[ends]))

    @property
    def falls(self) -> bool:
        """Whether it overturned, or was beyond the rotation of balance when the run ended."""
        beyond = np.abs(self.history.rotation) > self.balance
        return bool(beyond[-1] and not beyond.all())

    @property
    def before_fall(self) -> slice:
        """Nodes until θ last passes the rotation of balance; all of them if it does not fall."""
        if not self.falls:
            return slice(None)
        inside = np.flatnonzero(np.abs(self.history.rotation) <= self.balance)
        return slice(int(inside[-1]) + 1)

    @property
    def finished_rotation(self) -> float:
        """Largest |θ| in rad, without the last phase of a structure that falls."""
        if not self.falls:
            return self.response.max_rotation
        contact = np.flatnonzero(~self.history.uplifted)
        return float(np.max(np.abs(self.history.rotation[: contact[-1] + 1]))) if contact.size else 0.0


def rotation_axis_limit(curves: list[ResponseCurve]) -> float:
    """Largest |θ| in rad on an axis, including the rotation of balance if all that rock fall."""
    finished = max(curve.finished_rotation for curve in curves)
    fallen = [curve.balance_rotation for curve in curves if curve.falls]
    standing = any(curve.finished_rotation > 0.0 for curve in curves if not curve.falls)
    return finished if standing else max(finished, *fallen, 0.0)


def time_axis_limits(curves: Sequence[ResponseCurve]) -> tuple[float, float]:
    """First and last time of all curves in s."""
    times = [curve.history.time for curve in curves]
    return min(float(time[0]) for time in times), max(float(time[-1]) for time in times)


def response_figure_title(curves: list[ResponseCurve], title: str | None) -> str:
    """The title given, or the name of the motion if there is only one."""
    if title is not None:
        return title
    motions = {curve.response.motion for curve in curves}
    return figures.literal_text(motions.pop()) if len(motions) == 1 else ""


def response_curves(
    responses: Response | Iterable[Response], labels: Sequence[str] | None = None, lines: Lines | None = None
) -> list[ResponseCurve]:
    """Check the responses, and give each a label and a line style, if it has none."""
    everything: list[Response] = [responses] if hasattr(responses, "history") else list(responses)  # pyright: ignore
    if not everything:
        raise InputError('There is no response to plot. Give at least one from simulate(..., output="history").')
    histories: list[History] = []
    for place, response in enumerate(everything):
        if not hasattr(response, "history"):
            raise InputError(
                f"responses[{place}] must be a Response, but {type(response).__name__} was given. "
                'Give what simulate returned, or the column "response" of simulate_many(..., output="history").'
            )
        histories.append(history_of(response, place))
    names = _response_labels(everything, labels)
    styles = _response_line_styles(histories) if lines is None else figures.given_line_styles(lines, len(histories))
    return [ResponseCurve(*parts) for parts in zip(everything, histories, names, styles, strict=True)]


def _response_labels(responses: list[Response], labels: Sequence[str] | None) -> list[str]:
    if labels is None:
        models = [response.model for response in responses]
        if len(set(models)) == len(models):
            return [figures.literal_text(model) for model in models]
        return [figures.literal_text(f"{response.model}, {response.motion}") for response in responses]
    if isinstance(labels, str) or len(labels) != len(responses):
        given = f"the string {shown(labels)}" if isinstance(labels, str) else f"{len(labels)}"
        raise InputError(
            f"labels must be a sequence of {len(responses)} strings, one per response, but {given} was given."
        )
    return list(labels)


def _response_line_styles(histories: list[History]) -> list[LineStyle]:
    """Line styles of Silva & Stojadinović 2024, Fig. 15, for fixed base, most modes, one and two, and others.

    Where a model occurs twice, as in a comparison of alternatives, all differ in their dashes, too.
    """
    max_modes = max((h.model.properties.n_modes for h in histories if h.model.lifts), default=0)
    labels = [history.model.label for history in histories]
    if len(set(labels)) < len(labels) <= len(figures.ALTERNATIVE_STYLES):
        return figures.recoloured_line_styles(figures.ALTERNATIVE_STYLES[: len(histories)])
    wanted = [_usual_line_style(history, max_modes) for history in histories]
    spare, styles = [style for style in figures.LINE_STYLES if style not in wanted], list[LineStyle]()
    for own in wanted:
        if own is None or own in styles:
            if not spare:
                raise InputError(
                    f"{len(histories)} responses are too many to distinguish in one figure. Plot fewer at a time."
                )
            own = spare.pop(0)
        styles.append(own)
    return figures.recoloured_line_styles(styles)


def _usual_line_style(history: History, max_modes: int) -> LineStyle | None:
    model = history.model
    n = model.properties.n_modes
    if not model.lifts:
        return LineStyle(GRAY, "-", 1.4)
    if np.any(history.yielding != 0.0):
        return LineStyle(SKY, "-")
    if "-C" in model.label:
        closed = model.label.removesuffix("-R").endswith(("-SI", "-E"))
        return LineStyle(ORANGE, (0, (4, 1.5))) if closed else LineStyle(PURPLE, "-")
    if model.label.startswith("M") or n == max_modes > 2:
        return LineStyle(BLACK, "-")
    return {1: LineStyle(RED, "-."), 2: LineStyle(GREEN, "--")}.get(n)


@dataclass(frozen=True)
class PanelQuantity:
    """The quantity of a panel, by its name in a `History`."""

    name: str

    @property
    def kind(self) -> str:
        """Its kind among `QUANTITIES`."""
        return HISTORY[self.name].quantity

    @property
    def label(self) -> str:
        """Label of an axis, without the unit."""
        return figures.symbol_in_mathematics(HISTORY[self.name].symbol)

    def of(self, history: History) -> Array:
        """Values over time; zero of joints that a structure has not."""
        found = getattr(history, self.name)
        return found if found.size else np.zeros(history.time.size)

    def peak(self, curve: "ResponseCurve") -> float:
        """Largest magnitude of a response, also between the nodes of its history."""
        if self.name == "ground_acceleration":
            return float(np.abs(curve.history.ground_acceleration).max())
        return float(getattr(curve.response, f"max_{self.name}"))


PANELS = (
    "rotation", "top_displacement", "total_top_displacement", "base_moment", "base_shear", "horizontal_reaction",
    "joint_rotation", "slip", "edge_uplift", "ground_acceleration",
)  # fmt: skip


def default_panels(curves: list[ResponseCurve]) -> list[str]:
    """All but ΣF_x; total displacement if the height of the top is known, and what joints, slip and edges add."""
    known = all(curve.history.model.properties.top_height is not None for curve in curves)
    usual = [name for name in PANELS if name not in _OPTIONAL and (known or name != "total_top_displacement")]
    layouts = [curve.history.model.layout for curve in curves]
    moves = {
        "joint_rotation": any(layout.n_joints for layout in layouts),
        "slip": any(layout.slip >= 0 for layout in layouts),
        "edge_uplift": any(layout.heave >= 0 for layout in layouts),
    }
    return usual + [name for name, happens in moves.items() if happens]


def panel_quantities(panels: Sequence[str]) -> list[PanelQuantity]:
    """Quantities by name; an `InputError` if there are none, or one is unknown or repeated."""
    names = [panels] if isinstance(panels, str) else list(panels)
    if not names or len(set(names)) < len(names) or not set(names) <= set(PANELS):
        raise InputError(
            f"panels must be one or more of {', '.join(PANELS)}, each once, but {shown(panels)} was given."
        )
    return [PanelQuantity(name) for name in names]


def quantity_axis_scale(quantity: PanelQuantity, curves: list[ResponseCurve]) -> tuple[Unit, float]:
    """Unit and largest magnitude of an axis, with some room."""
    if quantity.name == "rotation":
        largest = rotation_axis_limit(curves)
    else:
        largest = max(
            float(np.max(np.abs(quantity.of(curve.history)[curve.before_fall])))
            if curve.falls
            else quantity.peak(curve)
            for curve in curves
        )
    unit = figures.axis_unit(quantity.kind, largest)
    return unit, _MARGIN * largest / unit.size if largest > 0.0 else 1e-3 / unit.size


def draw_panel(
    axes: Axes, quantity: PanelQuantity, curves: list[ResponseCurve], mark: str, *, notes: bool = True
) -> list[Artist]:
    """Fill one panel over time and list the peaks beside it, if notes are wanted; return a line for each curve."""
    lines, peaks = draw_curves(axes, quantity, curves)
    figures.label_panel(axes, mark)
    if not notes:
        return lines
    texts = [(text, curve.style.color) for text, curve in zip(peaks, curves, strict=True)]
    figures.write_notes_beside(axes, [(translated("peaks"), "#404040"), *texts], 10.0)
    return lines


def draw_curves(axes: Axes, quantity: PanelQuantity, curves: list[ResponseCurve]) -> tuple[list[Artist], list[str]]:
    """Fill one panel over time; return a line for each curve, and its peak in words."""
    unit, limit = quantity_axis_scale(quantity, curves)
    factor, low = unit.size, -limit
    if quantity.name == "edge_uplift":  # how far they sink is less than how far they rise
        low = -_MARGIN * max(*(curve.response.max_edge_settlement / factor for curve in curves), 0.05 * limit)
    axes.set(ylim=(low, limit), ylabel=unit.heading(quantity.label))
    lines: list[Artist] = []
    peaks: list[str] = []
    for curve in curves:
        style = curve.style
        first, *others = axes.plot(
            curve.history.time, quantity.of(curve.history) / factor, **style.look, linewidth=style.width,
            label=curve.label, zorder=curve.order,
        )  # fmt: skip
        lines.append(first)
        for other in others:  # the right edge is thinner than the left one, a joint than that below
            other.set(linewidth=0.5 * style.width, label="_other")
        if curve.overturned:
            axes.axvline(curve.response.end_time, color=style.color, linestyle=":", linewidth=0.8, zorder=1.5)
        if curve.falls and quantity.name == "rotation":
            _mark_overturning(axes, curve, limit, factor)
        peaks.append(_mark_peak(axes, quantity, curve, factor))
    return lines, peaks


def add_legend(
    figure: Figure,
    curves: list[ResponseCurve],
    lines: list[Artist],
    uplifts: dict[str, Artist],
    title: str | None,
    **options: Any,
) -> None:
    """Add the legend of responses above a figure, under its title; `uplifts` is what `shade_uplifts` returned."""
    handles, names = [*lines, *uplifts.values()], [*(curve.label for curve in curves), *uplifts]
    options |= {"title": response_figure_title(curves, title), "handlelength": 2.6, "columnspacing": 1.4}
    figures.add_legend_above(figure, handles, names, **options)


def _mark_peak(axes: Axes, quantity: PanelQuantity, curve: ResponseCurve, factor: float) -> str:
    """Circle the true peak, which may be between two nodes of the curve; return its text."""
    if curve.overturned and quantity.name == "rotation":
        return translated("overturned, {time} s", time=f"{curve.response.end_time:.2f}")
    peak = quantity.peak(curve) / factor
    if peak == 0.0:
        return "0"
    time, values = curve.history.time, quantity.of(curve.history)
    if quantity.name == "edge_uplift":
        when, side = float(time[values.max(axis=1).argmax()]), 1.0
    elif quantity.name == "joint_rotation":
        place = int(np.abs(values).argmax())
        when, side = float(time[place // values.shape[1]]), float(np.sign(values.flat[place]))
    elif quantity.name in ("slip", "ground_acceleration"):
        node = int(np.abs(values).argmax())
        when, side = float(time[node]), float(np.sign(values[node]))
    else:
        when = float(getattr(curve.response, f"time_of_max_{quantity.name}"))
        side = float(np.sign(np.interp(when, time, values)))
    axes.plot(
        [when], [side * peak], "o", color=curve.style.color, markersize=3.5, markerfacecolor="white",
        markeredgewidth=0.9, zorder=3.0,
    )  # fmt: skip
    return translated("{peak} at {time} s", peak=short_number(peak), time=f"{when:.2f}")


def _mark_overturning(axes: Axes, curve: ResponseCurve, limit: float, factor: float) -> None:
    """Draw a triangle where the rotation finally leaves the panel."""
    rotation, time = curve.history.rotation / factor, curve.history.time
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
    detail: tuple[float, float] | None = None,
    lines: Lines | None = None,
    title: str | None = None,
    size: Size | None = None,
) -> Figure:
    """Plot rotation θ, displacements of the top, base moment M_b and base shear V_b over time, one panel each.

    With ``panels=("rotation", "top_displacement", "base_moment", "base_shear")`` the figure is that of Silva &
    Stojadinović 2024, Fig. 15; with the first two, that of Fig. 3, and with a detail of Fig. 4. Their u_top is relative
    to the rotating base; the total displacement is relative to the ground, and comparable with a fixed base. The times
    during which the base of the most detailed model is uplifted are shaded; if several models rock, bars at the bottom
    of the first panel show the uplifts of each. Circles mark the true peaks, which are listed with their times beside
    each panel.
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
        ``"base_shear"``, ``"horizontal_reaction"``, ``"joint_rotation"`` (thinner of higher joints), ``"slip"``,
        ``"edge_uplift"`` (of the left edge, and thinner of the right one) and ``"ground_acceleration"``, from the top.
        Default: all but the last five; without the total displacement if the height of the top is not known, and with
        the rotations of joints above the base, the slip if a base can slide and the edges if one is on springs.
    detail
        First and last time in s of a second column of panels, which shows this part alone. Default: none.
    lines
        Colour and line style of each response, such as ``[("black", "-"), ("red", "--")]``, with the styles ``-``,
        ``--``, ``-.`` and ``:`` of matplotlib. Default: by model.
    title
        Default: the name of the motion, if there is only one.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes per panel over a common time axis in s; θ in rad, displacements in m, M_b and V_b in units that suit
        their size.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, the number of labels or lines differs, or a panel is
        unknown; the detail is not within the responses; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> figure = rf.plot_history(response, panels=["rotation", "base_moment"])
    >>> len(figure.axes), figure.axes[1].get_xlabel()
    (2, 'time [s]')
    """
    curves = response_curves(responses, labels, lines)
    quantities = panel_quantities(default_panels(curves) if panels is None else panels)
    intervals = [time_axis_limits(curves)] if detail is None else _intervals_with_detail(curves, detail)
    handles: list[Artist] = []
    with figures.applied_figure_style(size=size):
        height = max(1.45, 0.155 * (len(curves) + 2))
        # A narrow figure has one column: the panels of the whole, then those of the detail.
        shape = (len(quantities) * len(intervals), 1) if figures.is_narrow() else (len(quantities), len(intervals))
        figure = figures.new_figure(6.3 + 1.7 * (shape[1] > 1), shape[0] * height + 0.8)
        alike: Literal["col", "none"] = "col" if shape[1] == len(intervals) else "none"
        cells = figure.subplots(*shape, sharex=alike, squeeze=False)
        grid: list[Axes] = list(cells.reshape(len(quantities), -1, order="F").flat)
        shown_in = [(quantity, interval) for quantity in quantities for interval in intervals]
        for axes, (quantity, interval), mark in zip(grid, shown_in, ascii_uppercase, strict=False):
            handles = draw_panel(axes, quantity, curves, mark, notes=interval == intervals[-1])
        uplifts = shade_uplifts(grid, curves)
        for axes, (quantity, interval) in zip(grid, shown_in, strict=True):
            axes.set_xlim(interval)
            if quantity == quantities[-1]:
                axes.set_xlabel(translated("time [s]"))
        figure.align_ylabels()
        add_legend(figure, curves, handles, uplifts, title)
    return figure


def _intervals_with_detail(curves: list[ResponseCurve], detail: tuple[float, float]) -> list[tuple[float, float]]:
    """Return the whole time of the responses, and a part of it."""
    first, last = time_axis_limits(curves)
    if len(detail) != 2 or not first <= detail[0] < detail[1] <= last:
        raise InputError(
            f"detail must be two times in s, in order and within the responses, from {first:g} to {last:g}, but "
            f"{shown(detail)} was given."
        )
    return [(first, last), (float(detail[0]), float(detail[1]))]


def shade_uplifts(panels: list[Axes], curves: list[ResponseCurve]) -> dict[str, Artist]:
    """Shade the uplifts of the most detailed model; return the entry of the legend that names it, if there are any."""
    rocking = [curve for curve in curves if curve.uplifts.size]
    if not rocking:
        text = translated("no uplift" if any(curve.lifts for curve in curves) else "fixed base")
        panels[0].text(0.5, 0.75, text, transform=panels[0].transAxes, ha="center", va="center", color="#404040")
        return {}
    main = max(rocking, key=lambda curve: curve.history.model.properties.n_modes)
    for axes in panels:
        _draw_uplift_spans(axes, main, 0.0, 1.0, SHADE, 0.5)
    name = translated("uplifted: {model}", model=main.label) if len(curves) > 1 else translated("uplifted")
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
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> others = [rf.simulate(frame, rf.ricker_pulse(a, 0.6), "2DOF-S")
    ...     for a in (3.9, 4.1)]
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
    groups = [[response_curves(response)[0] for response in group] for group in varied]
    quantities = panel_quantities(panels)
    everything = [*curves, *(curve for group in groups for curve in group)]
    times = np.linspace(0.0, time_axis_limits(curves)[1], _POINTS)
    with figures.applied_figure_style(size=size):
        shape = (len(quantities) * len(curves), 1) if figures.is_narrow() else (len(curves), len(quantities))
        figure = figures.new_figure(0.8 + 3.2 * len(quantities), 0.9 + 1.35 * shape[0])
        # A narrow figure has one column: all panels of the first quantity, then of the next.
        grid = figure.subplots(*shape, sharex=True, squeeze=False).reshape(len(curves), -1, order="F")
        for column, quantity in enumerate(quantities):
            unit, limit = quantity_axis_scale(quantity, everything)
            factor = unit.size
            for row, (curve, group) in enumerate(zip(curves, groups, strict=True)):
                axes: Axes = grid[row, column]
                low, high = _spread_of_histories(quantity, [curve, *group], times)
                axes.fill_between(times, low / factor, high / factor, color=SHADE, edgecolor=GRAY, linewidth=0.4)
                drawn = curve.before_fall
                values = quantity.of(curve.history)[drawn] / factor
                axes.plot(curve.history.time[drawn], values, color=BLACK, linewidth=0.8, label=curve.label)
                axes.set(ylim=(-limit, limit), xlim=(0.0, float(times[-1])), ylabel=unit.heading(quantity.label))
                axes.set_title(curve.label, fontsize=figures.scaled_font_size(8.0), loc="left", pad=3.0)
            if column + 1 == len(quantities) or not figures.is_narrow():
                grid[-1, column].set_xlabel(translated("time [s]"))
        figure.align_ylabels()
        handles = [grid[0, 0].get_lines()[0], Patch(facecolor=SHADE, edgecolor=GRAY, linewidth=0.4)]
        names = [translated("nominal"), translated("from the least to the largest of what was varied")]
        figures.add_legend_above(figure, handles, names, title=response_figure_title(curves, title))
    return figure


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


def plot_energy(response: Response, *, size: Size | None = None) -> Figure:
    """Plot the stored and dissipated energies, stacked, and the input energy.

    The layers are those of `EnergyLedger`, with the energies of the simplified models (Silva & Stojadinović 2024,
    Eqs. 15, 23 and 25). Their sum equals the input, which starts from the energy at t = 0; the title
    gives the difference. Tendons that lose prestress give back energy that they held before, which counts as part of
    the energy at t = 0. On springs, the raised weight counts from the deepest position of the base. A run that
    overturns is plotted until θ last passes the rotation at which the static resisting moment vanishes, beyond which
    the weight overturns it.

    Parameters
    ----------
    response
        One response with its history.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

    Returns
    -------
    matplotlib.figure.Figure
        One axes; time in s, energy in a unit that suits its size. Empty layers are left out.

    Raises
    ------
    InputError
        If the response has no history; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> figure = rf.plot_energy(response)
    >>> figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    ('time [s]', 'energy [kJ]')
    """
    (curve,) = response_curves([response])
    history = curve.history
    ledger, drawn = history.energy, curve.before_fall
    released = -min(float(ledger.element_strain[drawn].min()), 0.0)  # at t = 0, and given back later
    settled = -min(float(ledger.gravity[drawn].min()), 0.0)  # below the level of the unloaded springs
    layers = [(*words, values[drawn]) for *words, values in _energy_layers(history, released, settled)]
    layers = [layer for layer in layers if np.any(layer[2] != 0.0)]
    start = float(ledger.stored[0]) + released + settled
    supply = ledger.input[drawn] + start
    factor, unit = figures.axis_unit("energy", float(np.max(np.abs(supply))))
    time = history.time[drawn]
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 3.4)
        axes = figure.subplots()
        if layers:
            axes.stackplot(
                time, *(values / factor for _, _, values in layers), linewidth=0.0,
                labels=[label for label, _, _ in layers], colors=[color for _, color, _ in layers],
            )  # fmt: skip
        axes.plot(
            time,
            supply / factor,
            color=BLACK,
            linewidth=0.9,
            label=translated("input" if start == 0.0 else "start + input"),
        )
        if curve.falls:
            axes.axvline(time[-1], color=BLUE, linestyle=":", label=translated("overturning"))
        axes.set_xlim(float(history.time[0]), float(history.time[-1]))
        axes.set(
            ylim=(0.0, 1.06 * float(np.max(supply)) / factor or 1.0),
            xlabel=translated("time [s]"),
            ylabel=f"{translated('energy')} [{unit}]",
        )
        motion = figures.literal_text(curve.response.motion)
        title = translated(
            "{model} under {record}, closing error {error}",
            model=curve.label,
            record=motion,
            error=f"{ledger.closing_error:.1e}",
        )
        axes.set_title(title)
        handles, _ = axes.get_legend_handles_labels()
        figures.add_legend_beside(figure, handles[::-1])
    return figure


def _energy_layers(history: History, released: float, settled: float) -> list[tuple[str, str, Array]]:
    """Return label, colour and values from the bottom: dissipated energy, which never falls, below stored energy."""
    ledger, elements = history.energy, history.model.properties.elements
    only_tendons = all(each.prestressed for each in elements)
    taken = translated("yield of tendons" if only_tendons else "taken by elements")
    stored = translated("tendons" if only_tendons else "stored in elements")
    return [
        (translated("damped"), GRAY, ledger.damped),
        (translated("lost in impacts"), RED, ledger.lost),
        (taken, figures.YELLOW, ledger.elements.sum(axis=1)),
        (translated("friction of the base"), BROWN, ledger.friction),
        (translated("damped by the ground"), SAND, ledger.soil.sum(axis=1)),
        (translated("raised weight"), GREEN, ledger.gravity + settled),
        (translated("compressed ground"), CLAY, ledger.soil_strain),
        (stored, PURPLE, ledger.element_strain + released),
        (translated("strain"), SKY, ledger.strain),
        (translated("kinetic"), ORANGE, ledger.kinetic),
    ]


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
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Default: what suits the panels.

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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> bed = rf.winkler_bed(frame.half_width, breadth=3.0,
    ...     subgrade_modulus=2e8).damped(0.3, 160e3)
    >>> ground = rf.Ground(springs=bed, base_inertia=1e4)
    >>> figure = rf.plot_footing(rf.simulate(frame, rf.ricker_pulse(4.0, 0.6),
    ...     "2DOF-S", ground=ground))
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['edges [mm]', 'x [m]', 'in contact [%]', 'pressure [MPa]']
    """
    (curve,) = curves = response_curves(response)
    history = curve.history
    springs = history.model.springs
    if springs is None:
        raise InputError(
            "The base of this response is not on springs. Simulate it with "
            "ground=Ground(springs=..., base_inertia=...), or use plot_history."
        )
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 5.4)
        edges, soil, contact = figure.subplots(3, 1, sharex=True, height_ratios=(1.0, 1.3, 0.7))
        _draw_base_edges(edges, history)
        _draw_soil_pressure(figure, soil, history, springs)
        _draw_base_contact(contact, history, springs)
        for axes, mark in zip((edges, soil, contact), "ABC", strict=True):
            figures.label_panel(axes, mark)
        contact.set_xlabel(translated("time [s]"))
        contact.set_xlim(float(history.time[0]), float(history.time[-1]))
        figure.align_ylabels([edges, soil, contact])
        edges.set_title(
            translated("{structure} under {record}", structure=curve.label, record=given)
            if (given := response_figure_title(curves, title))
            else curve.label
        )
    return figure


def tributary_shares(springs: Springs, p: RockingProperties) -> Array:
    """Return the share of the width of the base that is nearest to each spring, shape (n_springs,)."""
    places = springs.positions
    middles = 0.5 * (places[1:] + places[:-1])
    ends = np.clip(np.concatenate(([-p.pivot(-1).arm], middles, [p.pivot(1).arm])), -p.pivot(-1).arm, p.pivot(1).arm)
    return np.diff(ends) / (2.0 * p.half_width)


def _draw_base_edges(axes: Axes, history: History) -> None:
    unit = figures.axis_unit("displacement", usual="mm")
    names = (translated("left edge"), translated("right edge"))
    for values, name, color in zip(history.edge_uplift.T / unit.size, names, (BLUE, RED), strict=True):
        axes.plot(history.time, values, color=color, linewidth=0.9, label=name)
    axes.axhline(0.0, color=GRAY, linewidth=0.7)
    axes.set_ylabel(unit.heading(figures.symbol_in_mathematics(HISTORY["edge_uplift"].symbol)))
    axes.legend(loc="upper right", ncols=2)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.25 * (high - low))  # room for the legend


def _draw_soil_pressure(figure: Figure, axes: Axes, history: History, springs: Springs) -> None:
    area = springs.area
    pushes = history.spring_force if area is None else history.soil_pressure
    name = translated("force" if area is None else "pressure")
    factor, unit = figures.axis_unit("force" if area is None else "stress", float(pushes.max()))
    across, length = figures.axis_unit("length")
    places = springs.positions / across
    if places.size <= MAX_LINES:
        for place, force, color in zip(places, pushes.T / factor, _SPRING_COLORS, strict=False):
            axes.plot(history.time, force, color=color, linewidth=0.9, label=f"x = {short_number(place)} {length}")
        axes.set_ylabel(f"{name} [{unit}]")
        axes.legend(loc="upper right", ncols=places.size)
        axes.set_ylim(0.0, 1.25 * float(pushes.max()) / factor)
        return
    distinct = np.concatenate(([True], np.diff(history.time) > 0.0))
    shown = np.ma.masked_less_equal(pushes[distinct].T / factor, 0.0)
    mesh = axes.pcolormesh(history.time[distinct], places, shown, cmap="YlOrBr", shading="nearest", rasterized=True)
    mesh.set_clim(0.0)
    axes.set_ylabel(f"x [{length}]")
    axes.grid(visible=False)
    figure.colorbar(mesh, ax=axes, label=f"{name} [{unit}]", pad=0.01)


def _draw_base_contact(axes: Axes, history: History, springs: Springs) -> None:
    contact_share = (history.spring_force > 0.0) @ tributary_shares(springs, history.model.properties)
    axes.fill_between(history.time, 100.0 * contact_share, color=GRAY, alpha=0.5, linewidth=0.0)
    axes.plot(history.time, 100.0 * contact_share, color=BLACK, linewidth=0.7)
    axes.set(ylim=(0.0, 104.0), ylabel=translated("in contact [%]"))
