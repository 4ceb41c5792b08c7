"""The base along a prescribed path of its rotation: all of its elements, leg by leg."""

from collections.abc import Iterator

import numpy as np

from rockflex._arrays import Array
from rockflex.modal import RockingProperties
from rockflex.models import CLOSED, LEFT, RIGHT, Element, arm_of, elements_of, stored_energy
from rockflex.response._element_path import (
    Place,
    at_rest,
    jumps,
    next_stop,
    passed,
    plastic_stretch,
    set_off,
    tension,
)
from rockflex.response._moment_rotation import MomentRotation

NEAR = 1e-12  # relative: a change of branch this close to the end of a leg belongs to the next leg

Point = tuple[int, float, bool, tuple[Place, ...]]  # side, |θ|, whether it was prescribed, and the elements


def base_path(properties: RockingProperties, rotations: Array) -> MomentRotation:
    """Return the quasi-static moment along a path from rest through the rotations in rad, shape (m,), m > 0."""
    elements = elements_of(properties)
    points = list(_points(properties, elements, rotations))
    side = np.array([point[0] for point in points])
    shape = len(points), len(elements)
    values = np.array(
        [
            (tension(each, place), place.elongation, plastic_stretch(each, place))
            for *_, places in points
            for each, place in zip(elements, places, strict=True)
        ]
    )
    force, elongation, plastic = values.reshape(*shape, 3).transpose(2, 0, 1)
    stored = np.zeros(shape)
    for k, each in enumerate(elements):
        stored[:, k] = stored_energy(each, elongation[:, k], force[:, k], plastic[:, k])
    work = np.zeros(shape)
    np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(elongation, axis=0), axis=0, out=work[1:])
    return MomentRotation(
        properties=properties,
        rotation=side * np.array([point[1] for point in points]) + 0.0,  # no -0.0
        side=side,
        given=np.array([point[2] for point in points]),
        element_force=force,
        element_elongation=elongation,
        plastic_stretch=plastic,
        element_losses=work - stored,
    )


def _points(properties: RockingProperties, elements: tuple[Element, ...], rotations: Array) -> Iterator[Point]:
    """Yield the points of the path, from rest."""
    places = tuple(at_rest(each) for each in elements)
    arms = {side: tuple(arm_of(properties, each, side) for each in elements) for side in (RIGHT, LEFT)}
    yield CLOSED, 0.0, bool(rotations[0] == 0.0), places
    before = CLOSED
    for side, start, end, given in _legs(rotations):
        leg = _leg(elements, arms[side], places, start, end, lifts=side != before) if side != CLOSED else []
        for reached, places in leg[:-1]:
            yield side, reached, False, places
        places = leg[-1][1] if leg else places
        yield side, end, given, places
        before = side


def _legs(rotations: Array) -> Iterator[tuple[int, float, float, bool]]:
    """Yield side, first and last |θ| of every part of the path on one side, and whether its end was prescribed."""
    side, known = CLOSED, 0.0
    for rotation in rotations[int(rotations[0] == 0.0) :].tolist():
        if known * rotation < 0.0:
            yield side, abs(known), 0.0, False
            known = 0.0
        side = RIGHT if rotation > 0.0 else LEFT if rotation < 0.0 else side
        yield side, abs(known), abs(rotation), True
        known = rotation


def _leg(
    elements: tuple[Element, ...],
    arms: tuple[float, ...],
    places: tuple[Place, ...],
    start: float,
    end: float,
    *,
    lifts: bool,
) -> list[tuple[float, tuple[Place, ...]]]:
    """Return the points from one |θ| to another about one pivot; the first only if forces jump or the base lifts."""
    turn, near = int(np.sign(end - start)), NEAR * max(start, end)
    if turn == 0:
        return [(end, places)]
    ways = [turn * int(np.sign(arm)) for arm in arms]
    parts = list(zip(elements, arms, ways, strict=True))
    before, places = (
        places,
        tuple(set_off(each, place, way) for (each, _, way), place in zip(parts, places, strict=True)),
    )
    found = [(start, places)] if lifts or _jumped(elements, before, places) else []
    at = start
    while True:
        stops = [next_stop(each, place, way) for (each, _, way), place in zip(parts, places, strict=True)]
        ends = [end if stop is None else stop[0] / arm for stop, arm in zip(stops, arms, strict=True)]
        nearest = min(ends, key=lambda q: turn * q, default=end)
        if turn * (end - nearest) <= near:
            break
        if turn * (nearest - at) > near:
            at = nearest
            places = _moved(places, arms, at)
            found.append((at, places))
        before, places = (
            places,
            tuple(
                place if stop is None or turn * (q - at) > near else passed(each, place, stop[1])
                for each, place, stop, q in zip(elements, places, stops, ends, strict=True)
            ),
        )
        if _jumped(elements, before, places):
            found.append((at, places))
    found.append((end, _moved(places, arms, end)))
    return found


def _moved(places: tuple[Place, ...], arms: tuple[float, ...], rotation: float) -> tuple[Place, ...]:
    return tuple(place._replace(elongation=arm * rotation) for place, arm in zip(places, arms, strict=True))


def _jumped(elements: tuple[Element, ...], before: tuple[Place, ...], after: tuple[Place, ...]) -> bool:
    return any(map(jumps, elements, before, after))
