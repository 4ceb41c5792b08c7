"""The quasi-static path of a base whose rotation is prescribed, on rigid ground or on springs, with its elements."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array, Bools
from rockflex.models._elements import CLOSED, LEFT, RIGHT, arm_of_element, elements_of
from rockflex.models._rocking_model import LEVEL, Pose
from rockflex.response._moment_rotation import MomentRotation, MomentRotationOnSprings
from rockflex.structure._branches import Element
from rockflex.structure._ground import Springs
from rockflex.structure._rocking import RockingProperties

TOLERANCE = 1e-12  # relative: changes this close to each other happen at once, and at an end in the next part


def static_path(
    properties: RockingProperties, rotations: Array, springs: Springs | None = None, rest: Pose = LEVEL
) -> MomentRotation | MomentRotationOnSprings:
    """Return the quasi-static moment along a path from rest through rotations.

    Parameters
    ----------
    properties
        The structure, with its elements.
    rotations : ndarray, shape (m,)
        Rotations in rad, at least one.
    springs, rest
        The springs under the base, and its position on them under its weight; None on rigid ground.
    """
    elements = elements_of(properties)
    if springs is None:
        points = list(_static_path_about_pivots(properties, elements, rotations))
        side = np.array([point[0] for point in points])
        return MomentRotation(
            properties=properties,
            rotation=side * np.array([point[1] for point in points]) + 0.0,  # no -0.0
            given=np.array([point[2] for point in points]),
            **_elements_along_static_path(elements, [places for *_, places in points]),
            side=side,
        )
    found = list(_static_path_on_springs(SprungBase(elements, springs, rest), rotations))
    states = [state for state, _ in found]
    rotation, heave = np.array([(state.rotation, state.heave) for state in states]).T
    loaded = np.array([state.pressed & ~state.empty for state in states])
    depth = heave[:, None] - springs.positions * rotation[:, None]
    crushed, strength = np.array([state.crushed for state in states]), spring_strength(springs)
    return MomentRotationOnSprings(
        properties=properties,
        rotation=rotation + 0.0,  # no -0.0
        given=np.array([given for _, given in found]),
        **_elements_along_static_path(
            elements, [state.places for state in states], np.array([state.carried for state in states])
        ),
        springs=springs,
        heave=heave,
        spring_force=np.where(loaded, np.clip(-springs.stiffness * (depth + crushed), 0.0, strength), 0.0),
    )


def _elements_along_static_path(
    elements: tuple[Element, ...], path: "Sequence[tuple[StaticElementState, ...]]", carried: Array | None = None
) -> dict[str, Array]:
    """Return force, elongation, plastic stretch and losses of the elements along a path by name, each (n, E).

    `carried` is the force in N that an element still carries while it breaks, shape (n, E).
    """
    values = np.array(
        [
            (static_tension(each, place), place.elongation, plastic_stretch(each, place))
            for places in path
            for each, place in zip(elements, places, strict=True)
        ]
    )
    shape = len(path), len(elements)
    force, elongation, plastic = values.reshape(*shape, 3).transpose(2, 0, 1)
    force = force if carried is None else force + carried
    losses = np.zeros(shape)
    losses[1:] = np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(elongation, axis=0), axis=0)
    for k, each in enumerate(elements):
        losses[:, k] -= each.stored_energy(elongation[:, k], force[:, k], plastic[:, k])
    return {
        "element_force": force,
        "element_elongation": elongation,
        "plastic_stretch": plastic,
        "element_losses": losses,
    }


class StaticElementState(NamedTuple):
    """The branch of an element, its internal variable at the start of the branch, and its elongation δ in m."""

    branch: int
    memory: float
    elongation: float


def element_at_start_of_path(element: Element) -> StaticElementState:
    """Return the place at which every path starts."""
    return StaticElementState(element.branches[0], 0.0, 0.0)


def static_tension(element: Element, place: StaticElementState) -> float:
    """Return the force in N while the elongation changes slowly."""
    pull = element.tension(place.branch)
    return pull.stiffness * place.elongation + pull.force + pull.internal_factor * place.memory


def static_internal_variable(element: Element, place: StaticElementState) -> float:
    """Return the internal variable if the branch ended here: on a branch that yields it follows the elongation."""
    offset = element.reversal_offset(place.branch)
    return place.memory if offset is None else place.elongation - offset


def start_moving(element: Element, place: StaticElementState, direction: int) -> StaticElementState:
    """Return the place as the elongation begins to change, with the sign of δ'; 0 if it does not change."""
    if element.direction(place.branch) == direction:
        return place
    branch = element.moving(element.branch_at_rest(place.branch), direction)
    return StaticElementState(branch, static_internal_variable(element, place), place.elongation)


def next_branch_change(element: Element, place: StaticElementState, direction: int) -> tuple[float, int] | None:
    """Return the elongation at which the branch ends if it keeps its direction, and the next branch; None if never."""
    ahead = [
        (max(direction * (stop.place + stop.internal_factor * place.memory), direction * place.elongation), stop.branch)
        for stop in element.limits(place.branch)
        if stop.upper == (direction > 0)
    ]
    if direction == 0 or not ahead:
        return None
    reached, branch = min(ahead)
    return direction * reached, branch


def next_branch(element: Element, place: StaticElementState, branch: int) -> StaticElementState:
    """Return the same place on the branch that follows."""
    return StaticElementState(branch, static_internal_variable(element, place), place.elongation)


def does_static_force_jump(element: Element, before: StaticElementState, after: StaticElementState) -> bool:
    """Return whether the force jumps between two branches."""
    return before.branch != after.branch and (element.broken(after.branch) or element.friction > 0.0)


def plastic_stretch(element: Element, place: StaticElementState) -> float:
    """Return the plastic part of the elongation in m; NaN once the element is broken."""
    if element.stretches is None:
        return 0.0
    return math.nan if element.broken(place.branch) else static_internal_variable(element, place)


Point = tuple[
    int, float, bool, tuple[StaticElementState, ...]
]  # side, |θ|, whether it was prescribed, and the elements


def _static_path_about_pivots(
    properties: RockingProperties, elements: tuple[Element, ...], rotations: Array
) -> Iterator[Point]:
    """Yield the points of the path, from rest."""
    places = tuple(element_at_start_of_path(each) for each in elements)
    arms = {side: tuple(arm_of_element(properties, each, side) for each in elements) for side in (RIGHT, LEFT)}
    yield CLOSED, 0.0, bool(rotations[0] == 0.0), places
    before = CLOSED
    for side, start, end, given in _monotonic_segments(rotations):
        leg = slow_turn(elements, arms[side], places, start, end, lifts=side != before) if side != CLOSED else []
        for reached, places in leg[:-1]:
            yield side, reached, False, places
        places = leg[-1][1] if leg else places
        yield side, end, given, places
        before = side


def _monotonic_segments(rotations: Array) -> Iterator[tuple[int, float, float, bool]]:
    """Yield side, first and last |θ| of every part of the path on one side, and whether its end was prescribed."""
    side, known = CLOSED, 0.0
    for rotation in rotations[int(rotations[0] == 0.0) :].tolist():
        if known * rotation < 0.0:
            yield side, abs(known), 0.0, False
            known = 0.0
        side = RIGHT if rotation > 0.0 else LEFT if rotation < 0.0 else side
        yield side, abs(known), abs(rotation), True
        known = rotation


def slow_turn(
    elements: tuple[Element, ...],
    arms: tuple[float, ...],
    places: tuple[StaticElementState, ...],
    start: float,
    end: float,
    *,
    lifts: bool,
) -> list[tuple[float, tuple[StaticElementState, ...]]]:
    """Return the points from one |θ| to another about one pivot; the first only if forces jump or the base lifts.

    `arms` are the elongations of the elements for a unit of |θ|, in m, and `places` where they are at the start.
    """
    turn, near = int(np.sign(end - start)), TOLERANCE * max(start, end)
    if turn == 0:
        return [(end, places)]
    ways = [turn * int(np.sign(arm)) for arm in arms]
    parts = list(zip(elements, arms, ways, strict=True))
    before, places = (
        places,
        tuple(start_moving(each, place, way) for (each, _, way), place in zip(parts, places, strict=True)),
    )
    found = [(start, places)] if lifts or _jumped(elements, before, places) else []
    at = start
    while True:
        stops = [next_branch_change(each, place, way) for (each, _, way), place in zip(parts, places, strict=True)]
        ends = [end if stop is None else stop[0] / arm for stop, arm in zip(stops, arms, strict=True)]
        nearest = min(ends, key=lambda q: turn * q, default=end)
        if turn * (end - nearest) <= near:
            break
        if turn * (nearest - at) > near:
            at = nearest
            places = _stretched(places, arms, at)
            found.append((at, places))
        before, places = (
            places,
            tuple(
                place if stop is None or turn * (q - at) > near else next_branch(each, place, stop[1])
                for each, place, stop, q in zip(elements, places, stops, ends, strict=True)
            ),
        )
        if _jumped(elements, before, places):
            found.append((at, places))
    found.append((end, _stretched(places, arms, end)))
    return found


def _stretched(
    places: tuple[StaticElementState, ...], arms: tuple[float, ...], rotation: float
) -> tuple[StaticElementState, ...]:
    return tuple(place._replace(elongation=arm * rotation) for place, arm in zip(places, arms, strict=True))


def _jumped(
    elements: tuple[Element, ...], before: tuple[StaticElementState, ...], after: tuple[StaticElementState, ...]
) -> bool:
    return any(map(does_static_force_jump, elements, before, after))


class SprungBase(NamedTuple):
    """A base on springs: its elements, the springs, and its position at rest."""

    elements: tuple[Element, ...]
    springs: Springs
    rest: Pose


@dataclass(frozen=True, eq=False)
class StaticEquilibrium:
    """A position in equilibrium.

    Attributes
    ----------
    rotation, heave
        θ in rad and z in m.
    pressed, empty
        Which springs are compressed, and which are just at their length, shape (S,).
    places
        Where the elements are.
    carried
        Force in N that each element still carries while it breaks, shape (E,).
    full, crushed
        Which springs carry their capacity, and the permanent settlement of each in m, shape (S,).
    """

    rotation: float
    heave: float
    pressed: Bools
    empty: Bools
    places: tuple[StaticElementState, ...]
    carried: Array
    full: Bools
    crushed: Array


def spring_strength(springs: Springs) -> Array:
    """Return the largest force of each spring in N, infinite where it does not yield."""
    return np.full(springs.n, np.inf) if springs.capacity is None else springs.capacity


def _static_path_on_springs(base: SprungBase, rotations: Array) -> Iterator[tuple[StaticEquilibrium, bool]]:
    """Yield the points of the path, from rest, and whether their rotation was prescribed."""
    rotation, heave = base.rest
    pressed = heave - base.springs.positions * rotation < 0.0
    places = tuple(element_at_start_of_path(each) for each in base.elements)
    none, still = np.zeros_like(pressed), np.zeros(base.springs.n)
    state = StaticEquilibrium(rotation, heave, pressed, none, places, np.zeros(len(places)), none, still)
    starts = bool(rotations[0] == rotation)
    yield state, starts
    for target in rotations[int(starts) :].tolist():
        while state.rotation != target or state.carried.any():
            before = state
            state = (
                _equilibrium_after_break(base, state)
                if state.carried.any()
                else _equilibrium_after_turn(base, state, target)
            )
            if state.rotation != target and (state.rotation != before.rotation or before.carried.any()):
                yield state, False
        yield state, True


def _equilibrium_after_turn(base: SprungBase, state: StaticEquilibrium, target: float) -> StaticEquilibrium:
    """Return the state where something changes next, or at the target."""
    length = abs(target - state.rotation)
    moved, path = _next_equilibrium(base, state, math.copysign(1.0, target - state.rotation), 0.0, length)
    return replace(moved, rotation=target) if path == length else moved


def _equilibrium_after_break(base: SprungBase, state: StaticEquilibrium) -> StaticEquilibrium:
    """Return the state where something changes next while an element that breaks lets its force go, or without it."""
    place = int(np.flatnonzero(state.carried)[0])
    force = float(state.carried[place])
    moved, path = _next_equilibrium(base, state, 0.0, math.copysign(1.0, force), abs(force))
    carried = moved.carried.copy()
    carried[place] = 0.0 if path == abs(force) else force - math.copysign(path, force)
    return replace(moved, carried=carried)


def _next_equilibrium(
    base: SprungBase, state: StaticEquilibrium, turn: float, lift: float, length: float
) -> tuple[StaticEquilibrium, float]:
    """Return the next state on the way with θ' = `turn`, and `lift` more upward force per unit, and the way to it.

    The way ends after `length`, or where a spring becomes empty or is met, or an element ends its branch.
    """
    springs, elements = base.springs, base.elements
    at = [each.position or 0.0 for each in elements]
    positions = np.array([*springs.positions, *at])
    onward = [
        {way: _onward(each, place, way) for way in (1, -1)} for each, place in zip(elements, state.places, strict=True)
    ]
    up, down = (
        np.array([each.tension(ways[way].branch).stiffness for each, ways in zip(elements, onward, strict=True)])
        for way in (1, -1)
    )
    taken = np.where(state.pressed & ~state.empty, springs.stiffness, 0.0)
    met = np.where((state.pressed | state.empty) & ~state.full, springs.stiffness, 0.0)
    rise = _rise(positions * turn, np.append(taken, up), np.append(met, down), lift)
    rates = rise - positions * turn
    pressed = np.where(state.empty, rates[: springs.n] < 0.0, state.pressed)
    falls = rates[: springs.n] < 0.0
    yields, presses = state.full & falls, pressed & falls
    places = [ways[-1 if rate < 0.0 else 1] for ways, rate in zip(onward, rates[springs.n :], strict=True)]
    stops = [
        next_branch_change(each, place, int(np.sign(rate)))
        for each, place, rate in zip(elements, places, rates[springs.n :], strict=True)
    ]
    depth = state.heave - springs.positions * state.rotation
    left = [stop[0] - place.elongation if stop else 0.0 for stop, place in zip(stops, places, strict=True)]
    strength = spring_strength(springs)
    reaches = presses & ~yields & np.isfinite(strength)
    level = -state.crushed - np.where(reaches, strength / springs.stiffness, 0.0)
    ends = np.array([*((pressed == (rates[: springs.n] > 0.0)) | reaches), *(stop is not None for stop in stops)])
    ahead = np.full(positions.size, np.inf)
    np.divide(np.append(level - depth, left), rates, out=ahead, where=ends & (rates != 0.0))
    np.maximum(ahead, 0.0, out=ahead)
    near = TOLERANCE * length
    ahead[ahead >= length - near] = np.inf  # it belongs to the next part of the path
    path = min(length, float(ahead.min()))
    happens = ahead <= path + near
    rotation, heave = state.rotation + turn * path, state.heave + rise * path
    carried = state.carried.copy()
    for k, (each, stop) in enumerate(zip(elements, stops, strict=True)):
        stretch = heave - base.rest.heave - at[k] * (rotation - base.rest.rotation)
        places[k] = places[k]._replace(elongation=stretch)
        if stop is not None and happens[springs.n + k]:
            force = static_tension(each, places[k])
            places[k] = next_branch(each, places[k]._replace(elongation=stop[0]), stop[1])
            carried[k] = force if each.broken(stop[1]) else 0.0
    met_end, at_once = happens[: springs.n], path <= near
    empty = (met_end & ~reaches) | (state.empty & at_once)
    full = yields | (met_end & reaches) | (state.full & at_once)
    crushed = state.crushed - np.where(yields, rates[: springs.n] * path, 0.0)
    return StaticEquilibrium(rotation, heave, pressed, empty, tuple(places), carried, full, crushed), path


def _onward(element: Element, place: StaticElementState, way: int) -> StaticElementState:
    """Return the place of an element that begins to be stretched (1) or shortened (-1)."""
    place = start_moving(element, place, way)
    while (at := next_branch_change(element, place, way)) and at[0] == place.elongation and not element.broken(at[1]):
        place = next_branch(element, place, at[1])
    return place


def _rise(meets: Array, up: Array, down: Array, lift: float) -> float:
    """Return the rate v of the heave at which Σ k (v - m) = `lift`, with k = `up` where v > m, else `down`."""
    order = np.argsort(meets, kind="stable")
    meets, up, down = meets[order], up[order], down[order]
    stiffness, force = (
        np.append(0.0, np.cumsum(above)) + np.append(np.cumsum(below[::-1])[::-1], 0.0)
        for above, below in ((up, down), (up * meets, down * meets))
    )
    ends = np.append(meets, np.inf)
    rates = ends.copy()
    np.divide(force + lift, stiffness, out=rates, where=stiffness > 0.0)
    return float(rates[np.argmax(rates <= ends)])
