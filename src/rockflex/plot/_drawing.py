"""Drawings of structures to scale, with their dimensions: at rest, or at an instant of a response."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from rockflex.foundation.checks import checked_finite, checked_instance, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import rounded_number, short_number
from rockflex.foundation.shown import shown
from rockflex.foundation.units import QUANTITIES
from rockflex.plot import _figures as figures
from rockflex.plot._figures import BLACK, GRAY, ORANGE, RED, Size
from rockflex.plot._history import ResponseCurve, response_curves
from rockflex.plot.animation._poses import (
    StructurePoses,
    default_amplification,
    outline_of_response,
    resting_poses,
    structure_poses,
)
from rockflex.plot.animation._scene import (
    DARK_RED,
    EDGE,
    MIN_SPRING,
    SPRING_FREE,
    MetresToStagePoints,
    StructureArtists,
    animation_scales_text,
    draw_stage_ground,
    structure_extent,
    structure_state_text,
)
from rockflex.response._response import Response
from rockflex.structure._attachment import element_parameters
from rockflex.structure._base_element import BaseElement
from rockflex.structure._ground import Ground, Springs
from rockflex.structure._outline import (
    BODY,
    ELEMENT_COLORS,
    GROUND,
    UPRIGHT,
    StructureOutline,
    structure_outline,
)
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import ModifiedStructure, is_structure

_INK = "#404040"
_LETTERS = 8.0  # points, in a figure with letters of 9
_SMALLEST = 7.0
_GAP = 3.0  # points between two texts
_LEADER = 14.0  # points from the drawing to the texts beside it
_TICK = 2.5
_COLUMN = 0.4  # of the width, at most, for the texts beside the drawing
_FOOT = 54.0  # points below the ground, for the dimensions of the base and the scale bar
_MIN_HEIGHT = 130.0
_MAX_RUNS = 6  # of stories or masses alike, that are named one by one
_ASIDE = 7.0  # points between elements at the same place
_OF_UNIT = {QUANTITIES[name][2]: name for name in ("displacement", "force", "stiffness", "damping", "mass")}


class _Note(NamedTuple):
    """A text beside the drawing, the point that it is about as in a stroke, (x, z, how), and the colour of its dot."""

    text: str
    point: tuple[float, float, float]
    color: str = GRAY


class _Condition(NamedTuple):
    """An element at an instant: what a text says of it, and its colour."""

    words: str
    color: str


def plot_structure(
    structure: Any,
    ground: Ground | None = None,
    response: Response | None = None,
    at: float | None = None,
    *,
    amplification: float | None = None,
    size: Size | None = None,
) -> Figure:
    """Draw what stands there to scale, with its dimensions, masses, elements and ground.

    Beside the drawing are the masses, the elements with their first two parameters and their places, the springs and
    the friction of the ground; to the left the heights, below the base its width and a scale bar.

    With a response it is drawn as it stood at an instant, over its shape at rest. Elements that yield or slide at that
    instant are red, those that have yielded before orange, broken ones dark red, and those without force gray; the
    texts give their forces.

    Parameters
    ----------
    structure
        Any structure, such as a `Frame`, or its `RockingProperties`.
    ground
        What it stands on. Default: rigid ground, or the springs of the response.
    response
        A response of it with its history.
    at
        Time of the response in s. Default: that of the largest rotation, or of the largest displacement of the top if
        the base does not lift.
    amplification
        Factor on the displacements and rotations that are drawn, as in `animate`. Default: a round number that suits.
    size
        ``"column"`` or ``"page"`` (3.5 or 7.2 in wide), or width and height in inches. Texts for which there is no
        room are left out, and counted.

    Returns
    -------
    matplotlib.figure.Figure
        One axes without ticks, whose coordinates are points of 1/72 in.

    Raises
    ------
    InputError
        If there is no structure, the response is of another one or keeps peaks only, the instant is outside it, or
        `at` or `amplification` are given without a response; or the size is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> figure = rf.plot_structure(rf.Restrained(frame,
    ...     rf.Tendon(initial_force=200e3, stiffness=5e6)))
    >>> [text.get_text() for text in figure.axes[0].texts][:2]
    ['Frame of equal stories, $T_1$ = 0.6 s', 'Tendon, 200 kN, 5 MN/m, x = 0 m']
    """
    if not isinstance(structure, RockingProperties) and not is_structure(structure):
        raise InputError(
            f"structure must be a structure, such as a Frame, or RockingProperties, but {shown(structure)} was given.",
            field="structure",
        )
    if ground is not None:
        checked_instance("ground", ground, Ground)
    if response is None:
        for name, given in (("at", at), ("amplification", amplification)):
            if given is not None:
                raise InputError(
                    f"{name} belongs to a response, but {shown(given)} was given without one. Give response=, or "
                    f"leave {name} out.",
                    field=name,
                )
        p = structure if isinstance(structure, RockingProperties) else structure.rocking()
        bed = None if ground is None else ground.springs
        springs = np.empty(0) if bed is None else bed.positions
        poses, by, curve, time = resting_poses(structure_outline(p, structure), springs), 1.0, None, 0.0
    else:
        (curve,) = response_curves(response)
        time = _instant(curve, at)
        outline = outline_of_response(curve.history, structure, 0)
        poses, bed = structure_poses(curve, outline, np.array([time]), 1.0), curve.history.model.springs
        by = default_amplification([curve], [poses]) if amplification is None else amplification
        p, by = curve.history.model.properties, checked_positive("amplification", by, "")
    with figures.applied_figure_style(size=size):
        figure = figures.new_figure(6.3, 4.8)
        figure.set_layout_engine("none")
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set(xlim=(0.0, 72.0 * figure.get_figwidth()), ylim=(0.0, 72.0 * figure.get_figheight()))
        axes.set_axis_off()
        title, conditions = _title(structure, p), list[_Condition]()
        if curve is not None:
            model = figures.literal_text(curve.response.model)
            title += f"\n{model}, t = {time:.2f} s: {structure_state_text(curve, poses, 0, time)[0]}, "
            title += animation_scales_text(by, 1.0)
            conditions = _conditions(curve, time)
        o = poses.outline
        notes = [*_element_notes(p.elements, o, conditions), *_notes(p, o, ground, bed)]
        _Layout(axes, poses, by).draw(title, notes, _story_runs(p, o), [each.color for each in conditions])
    return figure


def _instant(curve: ResponseCurve, at: float | None) -> float:
    response, known = curve.response, curve.history.time
    if at is None:
        return response.time_of_max_rotation if response.max_rotation > 0.0 else response.time_of_max_top_displacement
    time = checked_finite("at", at, "s")
    if not known[0] <= time <= known[-1]:
        raise InputError(
            f"at must be a time of the response, from {known[0]:g} to {known[-1]:g} s, but {time:g} s was given.",
            field="at",
        )
    return time


def _title(structure: Any, p: RockingProperties) -> str:
    inner = structure
    while isinstance(inner, ModifiedStructure):
        inner = inner.structure
    name = translated(getattr(inner, "title", "") or type(inner).__name__) if p.n_modes else translated("Rigid block")
    return f"{name}, $T_1$ = {short_number(2.0 * np.pi / float(p.omega[0]))} s" if p.n_modes else name


def _amount(value: float, unit: str) -> str:
    """Write a number that was given in an SI unit in the unit of the figures."""
    quantity = _OF_UNIT.get(unit)
    if quantity is None:
        return f"{short_number(value)} {unit}"
    size, name = figures.axis_unit(quantity, value)
    number = value / size
    return f"{short_number(number) if abs(number) < 1e3 else rounded_number(number)} {name}"


def _length(value: float) -> str:
    size, name = figures.axis_unit("length")
    return f"{short_number(value / size)} {name}"


def _conditions(curve: ResponseCurve, time: float) -> list[_Condition]:
    """Return what each element does at an instant."""
    history, elements = curve.history, curve.history.model.properties.elements
    now = history.at(time)
    before = history.element_state[history.time <= time]
    found: list[_Condition] = []
    for place, each in enumerate(elements):
        force, state = float(now.element_force[0, place]), int(now.element_state[0, place])
        color, word = ELEMENT_COLORS[each.symbol], translated(each.states[state])
        if state:
            color = RED if state == 1 else DARK_RED
        elif force == 0.0:
            color, word = SPRING_FREE, translated("no force")
        elif (before[:, place] == 1).any() and each.states[1] == "yielding":
            color, word = ORANGE, translated("has yielded")
        found.append(_Condition(", ".join(filter(None, (_amount(force, "N"), word))), color))
    return found


def _element_notes(
    elements: Sequence[BaseElement], outline: StructureOutline, conditions: Sequence[_Condition]
) -> list[_Note]:
    """Return a note for each element with its condition, or at rest for those that differ only in their places."""
    named = [translated(each.title or type(each).__name__) for each in elements]
    middles = [(*np.mean(ends[:, :2], axis=0), float(ends[1, 2])) for _, ends in outline.elements]
    if conditions:
        return [
            _Note(f"{name}, {each.where_in(figures.axis_unit('length'))}: {condition.words}", middle, condition.color)
            for each, name, middle, condition in zip(elements, named, middles, conditions, strict=True)
        ]
    alike: dict[str, list[int]] = {}
    for place, each in enumerate(elements):
        rest = {name: value for name, value in element_parameters(each).items() if name != "position"}
        alike.setdefault(f"{type(each).__name__} {rest}", []).append(place)
    found: list[_Note] = []
    for places in alike.values():
        first, count = elements[places[0]], len(places)
        numbers = [_amount(*each) for each in first.main_numbers]
        name = named[places[0]] if count == 1 else f"{count} × {named[places[0]]}"
        words = ", ".join([name, *numbers, _where([elements[place] for place in places])])
        found.append(_Note(words, middles[max(places, key=lambda place: middles[place][0])],
                           ELEMENT_COLORS[first.symbol]))  # fmt: skip
    return found


def _where(elements: Sequence[BaseElement]) -> str:
    size, name = unit = figures.axis_unit("length")
    if len(elements) == 1 or elements[0].attached:
        return elements[0].where_in(unit)
    places = sorted(each.position / size for each in elements)
    if len(places) == 2 and places[0] == -places[1]:
        return f"x = ±{short_number(places[1])} {name}"
    if len(places) > 3:
        return f"x = {short_number(places[0])} … {short_number(places[-1])} {name}"
    return f"x = {', '.join(map(short_number, places))} {name}"


def _runs(values: Iterable[float]) -> list[tuple[int, int, float]]:
    """Return the first place, the number and the value of each run of equal values, to six digits."""
    found: list[tuple[int, int, float]] = []
    for _, group in groupby(enumerate(values), key=lambda pair: f"{pair[1]:.5e}"):
        pairs = list(group)
        found.append((pairs[0][0], len(pairs), pairs[0][1]))
    return found


def _notes(p: RockingProperties, o: StructureOutline, ground: Ground | None, bed: Springs | None) -> list[_Note]:
    """Return the notes on base, ground, masses, columns that lean and stories that yield, the most important first."""
    side = max((float(each.points[:, 0].max()) for each in o.strokes[:-1]), default=0.0)
    body = min(side, min(-o.left, o.right))
    found: list[_Note] = []
    how, foot = (BODY, 0.0) if p.columns is None else (UPRIGHT, p.columns.height)
    if p.base_mass:
        base = translated("base") if p.columns is None else translated("slab and columns")
        found.append(_Note(f"{base}, {_amount(p.base_mass, 'kg')}", (0.9 * o.right, foot, how)))
    if bed is not None:
        words = f"{translated('{n} springs', n=bed.n)}, Σ k = {_amount(bed.total_stiffness, 'N/m')}"
        found.append(_Note(words, (float(bed.positions[-1]), 0.0, GROUND)))
    else:
        found.append(_Note(translated("pivot"), (o.right, 0.0, BODY), "none"))
    if ground is not None and ground.slides:
        ends = dict.fromkeys(short_number(float(end)) for end in (np.min(ground.friction), np.max(ground.friction)))  # pyright: ignore
        found.append(_Note(f"μ = {' … '.join(ends)}", (0.5 * o.right, 0.0, GROUND)))
    runs = _runs(mass for _, mass in o.masses)
    if len(runs) <= _MAX_RUNS:
        for first, count, mass in runs:
            number = f"{count} × " if count > 1 else "m = "
            height = o.masses[first + count - 1][0]
            found.append(_Note(f"{number}{_amount(mass, 'kg')}", (body, height, how)))
    elif runs:
        masses = [mass for _, mass in o.masses]
        words = f"{len(masses)} × {_amount(min(masses), 'kg')} … {_amount(max(masses), 'kg')}"
        found.append(_Note(words, (body, o.top, how)))
    if not o.masses:
        above = p.horizontal_mass - (p.base_mass or 0.0)
        found.append(_Note(f"Σ m = {_amount(above, 'kg')}", (body, 0.6 * o.top, how)))
    if p.leaning_mass:
        words = translated("leaning columns")
        found.append(_Note(f"{words}, {_amount(p.leaning_mass, 'kg')}", (side, 0.5 * o.top, how)))
    if p.stories and p.floors is not None:
        low, high = (limit(each.yield_force for each in p.stories) for limit in (min, max))
        forces = " … ".join(dict.fromkeys(_amount(each, "N") for each in (low, high)))
        middles = np.append(0.0, p.floors.heights)
        floor = p.stories[0].floor
        words = translated("{n} story yields at" if len(p.stories) == 1 else "{n} stories yield at", n=len(p.stories))
        found.append(_Note(f"{words} {forces}", (body, foot + 0.5 * float(middles[floor - 1] + middles[floor]), how)))
    return found


def _story_runs(p: RockingProperties, o: StructureOutline) -> list[tuple[float, float, str]]:
    """Return the lower and the upper end of stories of one height, with the text of their dimension."""
    if o.kind != "frame" or p.floors is None or p.floors.heights.size < 2 or (p.floors.story_heights <= 0.0).any():
        return []
    levels = np.append(0.0, p.floors.heights) + (0.0 if p.columns is None else p.columns.height)
    runs = _runs(p.floors.story_heights)
    if len(runs) > _MAX_RUNS:
        low, high = float(p.floors.story_heights.min()), float(p.floors.story_heights.max())
        count = p.floors.heights.size
        return [(float(levels[0]), float(levels[-1]), f"{count} × {short_number(low)} … {_length(high)}")]
    return [
        (
            float(levels[first]),
            float(levels[first + count]),
            f"{count} × {_length(height)}" if count > 1 else _length(height),
        )
        for first, count, height in runs
    ]


class _Layout:
    """Where everything is: heights to the left of the drawing, notes to the right, the width of the base below."""

    def __init__(self, axes: Axes, poses: StructurePoses, amplification: float) -> None:
        self._axes, self._poses, self._by = axes, poses, amplification
        self._width, self._height = axes.get_xlim()[1], axes.get_ylim()[1]
        self._letters = max(figures.scaled_font_size(_LETTERS), _SMALLEST)

    def draw(
        self, title: str, notes: Sequence[_Note], stories: Sequence[tuple[float, float, str]], colors: Sequence[str]
    ) -> None:
        """Draw everything; `colors` are those of the elements, or none for the colours of their kinds."""
        o = self._poses.outline
        head = self._write(
            title, 0.5 * self._width, self._height - EDGE, ha="center", va="top", room=self._width - 2.0 * EDGE
        )
        texts = [self._write(note.text, 0.0, 0.0, room=_COLUMN * self._width) for note in notes]
        heights = [self._write(text, 0.0, 0.0, ha="right", room=0.3 * self._width) for *_, text in stories]
        column = max((self._size(each)[0] for each in texts), default=0.0) + _LEADER
        total = self._write(_length(o.top), 0.0, 0.0, ha="center", rotation=90.0)
        inner = max((self._size(each)[0] for each in heights), default=-4.0 * _TICK)
        gutter = self._size(total)[0] + inner + 8.0 * _TICK + 2.0 * _GAP
        extent = structure_extent(self._poses, self._by)
        ceiling = self._height - EDGE - self._size(head)[1] - 2.0 * _GAP
        foot = _FOOT * max(self._letters / _LETTERS, 1.0)
        depth = MIN_SPRING + 10.0 if self._poses.sprung else 0.0
        level = foot + depth
        left = min(-extent.left, o.left)
        right = max(extent.right, o.right)
        room = max(self._width - column - gutter - 2.0 * EDGE, 20.0)
        if not figures.is_height_given():  # wide structures need less of it, and many notes more
            beside = sum(self._size(each)[1] + _GAP for each in texts) + foot - self._letters
            self._grow(max(level + min(room / (right - left) * extent.up, ceiling - level), beside) - ceiling, head)
            ceiling = self._height - EDGE - self._size(head)[1] - 2.0 * _GAP
        zoom = min(room / (right - left), max(ceiling - level, 20.0) / extent.up)
        aside = 0.5 * (room - zoom * (right - left))  # everything together in the middle
        start = EDGE + gutter + aside
        here = MetresToStagePoints(start - zoom * left, level, foot, zoom)
        end = start + zoom * (right - left)
        draw_stage_ground(self._axes, foot, start, end)
        poses = replace(self._poses, outline=_side_by_side(o, _ASIDE / zoom))
        artists = StructureArtists(self._axes, poses, BLACK, here, self._by, colors)
        artists.show(0)
        for each in artists.moving:
            each.set_animated(False)
        self._draw_pivots(here)
        self._draw_heights(here, start - _TICK, stories, heights, total)
        self._draw_base(here)
        self._draw_scale(here)
        points = [self._spot(here, note.point) for note in notes]
        self._draw_notes(notes, texts, points, end, (foot - self._letters, ceiling))

    def _write(self, text: str, x: float, y: float, *, room: float = 0.0, **style: Any) -> Text:
        options: dict[str, Any] = {"fontsize": self._letters, "color": _INK, "va": "center"}
        found = self._axes.text(x, y, text, **(options | style))
        if room:
            figures.break_text(found, room * self._dots)
        return found

    def _grow(self, by: float, head: Text) -> None:
        """Make the figure higher or lower, in points, and keep the title at its top."""
        self._height = max(self._height + by, _MIN_HEIGHT)
        self._axes.get_figure(root=True).set_figheight(self._height / 72.0)  # pyright: ignore
        self._axes.set_ylim(0.0, self._height)
        head.set_y(self._height - EDGE)

    @property
    def _dots(self) -> float:
        """Dots of a point."""
        return self._axes.get_figure(root=True).dpi / 72.0  # pyright: ignore[reportOptionalMemberAccess]

    def _size(self, text: Text) -> tuple[float, float]:
        box = text.get_window_extent()
        return float(box.width) / self._dots, float(box.height) / self._dots

    def _line(
        self, x: Sequence[float], y: Sequence[float], color: str = _INK, width: float = 0.7, **style: Any
    ) -> None:
        self._axes.plot(x, y, color=color, linewidth=width, **style)

    def _spot(self, here: MetresToStagePoints, point: tuple[float, float, float]) -> tuple[float, float]:
        x, y = here(self._poses.moved(0, np.array([point]), self._by))
        return float(x[0]), float(y[0])

    def _draw_pivots(self, here: MetresToStagePoints) -> None:
        if not self._poses.sprung:
            x, y = here(self._poses.base(0, self._by))
            self._line([*x], [*y], BLACK, linestyle="none", marker="o", markersize=4.0, markerfacecolor="white")

    def _draw_dimension(self, x: float, low: float, high: float) -> None:
        self._line([x, x], [low, high])
        for y in (low, high):
            self._line([x - _TICK, x + _TICK], [y - _TICK, y + _TICK])

    def _draw_heights(
        self,
        here: MetresToStagePoints,
        x: float,
        stories: Sequence[tuple[float, float, str]],
        texts: Sequence[Text],
        total: Text,
    ) -> None:
        """Draw the heights of the stories, and outside them that of the top."""
        (low, high) = (float(here.level + here.zoom * z) for z in (0.0, self._poses.outline.top))
        if stories:
            for lower, upper, _ in stories:
                self._draw_dimension(x, here.level + here.zoom * lower, here.level + here.zoom * upper)
            wanted = [here.level + 0.5 * here.zoom * (lower + upper) for lower, upper, _ in stories]
            kept = self._kept(texts, high - low + self._letters)
            for text, y in zip(
                texts, spread(wanted, [self._size(each)[1] for each in texts], low - 1.0, high, kept), strict=False
            ):
                text.set_position((x - _TICK - _GAP, y))
            x -= max(self._size(each)[0] for each in texts[:kept]) + 3.0 * _TICK + _GAP
        self._draw_dimension(x, low, high)
        length = 0.5 * self._size(total)[1]
        total.set_position((x - _GAP - 0.5 * self._size(total)[0], max(0.5 * (low + high), here.ground + length)))

    def _kept(self, texts: Sequence[Text], room: float) -> int:
        """Return for how many of the texts there is room above each other; the others are taken away, and counted."""
        kept, heights = len(texts), [self._size(each)[1] + _GAP for each in texts]
        while kept > 1 and sum(heights[:kept]) > room:
            kept -= 1
        if kept < len(texts):
            texts[kept - 1].set_text(f"+ {len(texts) - kept + 1} …")
            for each in texts[kept:]:
                each.remove()
        return kept

    def _draw_base(self, here: MetresToStagePoints) -> None:
        """Draw the distances from the axis of the masses to both edges, or half the width."""
        o = self._poses.outline
        if o.turning < math.inf:  # columns stand side by side, each on an edge of its own
            return
        y = here.ground - 15.0
        alike = abs(o.left + o.right) < 1e-9 * o.right
        for side, edge in (("B − e", o.right),) if not alike else ():
            self._write(f"{side} = {_length(edge)}", here.middle + _GAP, y - 2.0 * _GAP, va="top", ha="left")
        if alike:
            self._write(f"B = {_length(o.right)}", here.middle, y - 2.0 * _GAP, va="top", ha="center")
        else:
            self._write(f"B + e = {_length(-o.left)}", here.middle - _GAP, y - 2.0 * _GAP, va="top", ha="right")
        for edge in (o.right,) if alike else (o.left, o.right):
            across = [here.middle, here.middle + here.zoom * edge]
            self._line(across, [y, y])
            for x in across:
                self._line([x - _TICK, x + _TICK], [y - _TICK, y + _TICK])
        top = here.level + here.zoom * o.top
        self._line([here.middle] * 2, [y, top], GRAY, 0.5, linestyle=(0, (8, 2, 1, 2)), zorder=0.5)

    def _draw_scale(self, here: MetresToStagePoints) -> None:
        """Draw a bar of a round length at the lower left corner."""
        size, name = figures.axis_unit("length")
        longest = 0.3 * self._width / here.zoom / size
        power = 10.0 ** np.floor(np.log10(longest))
        length = float(max(factor * power for factor in (1.0, 2.0, 5.0) if factor * power <= longest))
        end = EDGE + length * size * here.zoom
        self._line([EDGE, end], [EDGE] * 2, width=2.0, solid_capstyle="butt")
        self._write(f"{length:g} {name}", EDGE, EDGE + 2.0, va="bottom")

    def _draw_notes(
        self,
        notes: Sequence[_Note],
        texts: Sequence[Text],
        points: Sequence[tuple[float, float]],
        end: float,
        room: tuple[float, float],
    ) -> None:
        """Write the notes beside the drawing, each as near to its point as the others let it, with a line to it."""
        kept = self._kept(texts, room[1] - room[0])
        wanted = [y for _, y in points]
        places = spread(wanted, [self._size(each)[1] for each in texts[:kept]], *room, kept)
        for note, text, (x, y), place in zip(notes, texts, points, places, strict=False):
            text.set_position((end + _LEADER, place))
            self._line([x, end + 2.0, end + _LEADER - 2.0], [y, place, place], GRAY, 0.5, zorder=1.0)
            self._line([x], [y], note.color, linestyle="none", marker="o", markersize=2.5, zorder=4.0)


def spread(
    wanted: Sequence[float], heights: Sequence[float], low: float, high: float, count: int | None = None
) -> list[float]:
    """Return the middles of texts above each other between two levels, each as near to where it is wanted as can be."""
    count = len(wanted) if count is None else count
    order = sorted(range(count), key=lambda k: wanted[k])
    found = [0.0] * count
    below = low
    for k in order:
        found[k] = max(wanted[k], below + 0.5 * heights[k])
        below = found[k] + 0.5 * heights[k] + _GAP
    above = high
    for k in reversed(order):
        found[k] = min(found[k], above - 0.5 * heights[k])
        above = found[k] - 0.5 * heights[k] - _GAP
    return found


def _side_by_side(outline: StructureOutline, step: float) -> StructureOutline:
    """Move elements that are at the same place apart, by `step` m from each to the next."""
    seen: dict[bytes, list[int]] = {}
    for place, (_, ends) in enumerate(outline.elements):
        seen.setdefault(ends[:, [0]].round(9).tobytes(), []).append(place)
    moved = list(outline.elements)
    for places in seen.values():
        for number, place in enumerate(places):
            symbol, ends = moved[place]
            shift = step * (number - 0.5 * (len(places) - 1))
            moved[place] = symbol, ends + np.array([shift, 0.0, 0.0])
    return replace(outline, elements=tuple(moved))
