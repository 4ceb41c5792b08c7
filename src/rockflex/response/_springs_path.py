"""A base on springs along a prescribed path of its rotation, which heaves as vertical equilibrium demands."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex.models import BROKEN, Element, SpringModel, stored_energy
from rockflex.response._element_path import Place, at_rest, next_stop, passed, plastic_stretch, set_off, tension
from rockflex.response._moment_rotation_on_springs import MomentRotationOnSprings

NEAR = 1e-12  # relative: changes this close to each other happen at once


@dataclass(frozen=True, eq=False)
class Pose:
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
    """

    rotation: float
    heave: float
    pressed: Bools
    empty: Bools
    places: tuple[Place, ...]
    carried: Array


def springs_path(model: SpringModel, rotations: Array) -> MomentRotationOnSprings:
    """Return the quasi-static moment along a path from rest through the rotations in rad, shape (m,), m > 0."""
    elements, springs = model.elements, model.springs
    found = list(_points(model, rotations))
    poses = [pose for pose, _ in found]
    rotation, heave = np.array([(pose.rotation, pose.heave) for pose in poses]).T
    loaded = np.array([pose.pressed & ~pose.empty for pose in poses])
    depth = heave[:, None] - springs.positions * rotation[:, None]
    values = np.array(
        [
            (tension(each, place) + carried, place.elongation, plastic_stretch(each, place))
            for pose in poses
            for each, place, carried in zip(elements, pose.places, pose.carried, strict=True)
        ]
    )
    shape = len(poses), len(elements)
    force, elongation, plastic = values.reshape(*shape, 3).transpose(2, 0, 1)
    losses = np.zeros(shape)
    losses[1:] = np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(elongation, axis=0), axis=0)
    for k, each in enumerate(elements):
        losses[:, k] -= stored_energy(each, elongation[:, k], force[:, k], plastic[:, k])
    return MomentRotationOnSprings(
        properties=model.properties,
        springs=springs,
        rotation=rotation + 0.0,  # no -0.0
        heave=heave,
        spring_force=np.where(loaded, np.maximum(-springs.stiffness * depth, 0.0), 0.0),
        given=np.array([given for _, given in found]),
        element_force=force,
        element_elongation=elongation,
        plastic_stretch=plastic,
        element_losses=losses,
    )


def _points(model: SpringModel, rotations: Array) -> Iterator[tuple[Pose, bool]]:
    """Yield the points of the path, from rest, and whether their rotation was prescribed."""
    rotation, heave = model.rest
    pressed = heave - model.springs.positions * rotation < 0.0
    places = tuple(at_rest(each) for each in model.elements)
    pose = Pose(rotation, heave, pressed, np.zeros_like(pressed), places, np.zeros(len(places)))
    starts = bool(rotations[0] == rotation)
    yield pose, starts
    for target in rotations[int(starts) :].tolist():
        while pose.rotation != target or pose.carried.any():
            before = pose
            pose = _settled(model, pose) if pose.carried.any() else _turned(model, pose, target)
            if pose.rotation != target and (pose.rotation != before.rotation or before.carried.any()):
                yield pose, False
        yield pose, True


def _turned(model: SpringModel, pose: Pose, target: float) -> Pose:
    """Return the pose where something changes next, or at the target."""
    length = abs(target - pose.rotation)
    moved, path = _moved(model, pose, math.copysign(1.0, target - pose.rotation), 0.0, length)
    return replace(moved, rotation=target) if path == length else moved


def _settled(model: SpringModel, pose: Pose) -> Pose:
    """Return the pose where something changes next while an element that breaks lets its force go, or without it."""
    place = int(np.flatnonzero(pose.carried)[0])
    force = float(pose.carried[place])
    moved, path = _moved(model, pose, 0.0, math.copysign(1.0, force), abs(force))
    carried = moved.carried.copy()
    carried[place] = 0.0 if path == abs(force) else force - math.copysign(path, force)
    return replace(moved, carried=carried)


def _moved(model: SpringModel, pose: Pose, turn: float, lift: float, length: float) -> tuple[Pose, float]:
    """Return the next pose on the way with θ' = `turn`, and `lift` more upward force per unit, and the way to it.

    The way ends after `length`, or where a spring becomes empty or is met, or an element ends its branch.
    """
    springs, elements = model.springs, model.elements
    positions = np.array([*springs.positions, *(each.position for each in elements)])
    onward = [
        {way: _onward(each, place, way) for way in (1, -1)} for each, place in zip(elements, pose.places, strict=True)
    ]
    up, down = (
        np.array([each.pull(ways[way].branch).stiffness for each, ways in zip(elements, onward, strict=True)])
        for way in (1, -1)
    )
    taken = np.where(pose.pressed & ~pose.empty, springs.stiffness, 0.0)
    met = np.where(pose.pressed | pose.empty, springs.stiffness, 0.0)
    rise = _rise(positions * turn, np.append(taken, up), np.append(met, down), lift)
    rates = rise - positions * turn
    pressed = np.where(pose.empty, rates[: springs.n] < 0.0, pose.pressed)
    places = [ways[-1 if rate < 0.0 else 1] for ways, rate in zip(onward, rates[springs.n :], strict=True)]
    stops = [
        next_stop(each, place, int(np.sign(rate)))
        for each, place, rate in zip(elements, places, rates[springs.n :], strict=True)
    ]
    depth = pose.heave - springs.positions * pose.rotation
    left = [at[0] - place.elongation if at else 0.0 for at, place in zip(stops, places, strict=True)]
    ends = np.array([*(pressed == (rates[: springs.n] > 0.0)), *(at is not None for at in stops)])
    ahead = np.full(positions.size, np.inf)
    np.divide(np.append(-depth, left), rates, out=ahead, where=ends & (rates != 0.0))
    np.maximum(ahead, 0.0, out=ahead)
    near = NEAR * length
    ahead[ahead >= length - near] = np.inf  # it belongs to the next part of the path
    path = min(length, float(ahead.min()))
    happens = ahead <= path + near
    rotation, heave = pose.rotation + turn * path, pose.heave + rise * path
    carried = pose.carried.copy()
    for k, (each, at) in enumerate(zip(elements, stops, strict=True)):
        stretch = heave - model.rest[1] - each.position * (rotation - model.rest[0])
        places[k] = places[k]._replace(elongation=stretch)
        if at is not None and happens[springs.n + k]:
            force = tension(each, places[k])
            places[k] = passed(each, places[k]._replace(elongation=at[0]), at[1])
            carried[k] = force if at[1] == BROKEN else 0.0
    empty = happens[: springs.n] | (pose.empty & (path <= near))
    return Pose(rotation, heave, pressed, empty, tuple(places), carried), path


def _onward(element: Element, place: Place, way: int) -> Place:
    """Return the place of an element that begins to be stretched (1) or shortened (-1)."""
    place = set_off(element, place, way)
    while (at := next_stop(element, place, way)) and at[0] == place.elongation and at[1] != BROKEN:
        place = passed(element, place, at[1])
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
