"""Peaks of the elements between the base and the ground, and what a run leaves of them.

The force of a bar depends on its whole history, but its largest force does not: wherever the elongation reaches a new
extreme, every smaller loop is closed, and the force is that of a bar stretched for the first time. So the peaks of
bars follow from the largest rotation to each side, and those of viscous dampers from the largest velocity.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._arrays import Array, Bools
from rockflex.modal import BaseElement, FrictionDamper, Tendon, ViscousDamper, YieldingDissipator
from rockflex.models import HEADER, SIDE, RockingModel, SpringModel, plastic_stretches


class Reach(NamedTuple):
    """How far the base moved: the largest |θ| in rad and the largest |δ'/r| in rad/s, to the right and to the left."""

    rotation: tuple[float, float]
    swing: tuple[float, float]


class ElementPeaks(NamedTuple):
    """The fields of a `Response` that describe its elements; read-only arrays."""

    max_element_force: Array
    max_element_elongation: Array
    element_yielded: Bools
    remaining_prestress: Array
    max_tendon_force: float
    tendon_utilisation: float
    tendon_yield: bool
    tendon_overload: bool


def _fixed(values: ArrayLike) -> NDArray[Any]:
    array = np.array(values)
    array.setflags(write=False)
    return array


ELEMENT_PEAKS = ("max_element_force", "max_element_elongation", "element_yielded", "remaining_prestress")
EMPTY: Array = _fixed(np.zeros(0))
NONE = ElementPeaks(EMPTY, EMPTY, _fixed(np.zeros(0, dtype=np.bool_)), EMPTY, 0.0, 0.0, False, False)


class Moves(NamedTuple):
    """Extremes of the elongation δ of one element in m, zero included, and the largest |δ'| in m/s."""

    low: float
    high: float
    speed: float


def element_peaks(model: RockingModel, moves: Sequence[Moves], final_state: Array) -> ElementPeaks:
    """Return the peaks of the elements of a run, and what is left of them in its last state."""
    given = model.properties.elements
    if not given:
        return NONE
    forces = [_largest_force(each, move) for each, move in zip(given, moves, strict=True)]
    yielded = [_yields(each, move) for each, move in zip(given, moves, strict=True)]
    tendons = [
        (each, force, beyond)
        for each, force, beyond in zip(given, forces, yielded, strict=True)
        if isinstance(each, Tendon)
    ]
    shares = [force / each.yield_force for each, force, _ in tendons if each.yield_force]
    return ElementPeaks(
        max_element_force=_fixed(forces),
        max_element_elongation=_fixed([max(-move.low, move.high) for move in moves]),
        element_yielded=_fixed(yielded),
        remaining_prestress=_fixed(_remaining_prestress(model, final_state)),
        max_tendon_force=max((force for _, force, _ in tendons), default=0.0),
        tendon_utilisation=max(shares, default=math.nan) if tendons else 0.0,
        tendon_yield=any(beyond for _, _, beyond in tendons),
        tendon_overload=any(beyond and each.post_yield_ratio is None for each, _, beyond in tendons),
    )


def moves_about_pivots(model: RockingModel, reach: Reach) -> list[Moves]:
    """Return the extremes of the elements of a base that rotates about its edges."""
    if not model.properties.elements:
        return []
    stretch = model.stretch_per_arm(np.array(reach.rotation)).tolist()
    return [_moves(model, each, stretch, reach.swing) for each in model.properties.elements]


def moves_on_springs(model: SpringModel, extremes: Array, speeds: Array) -> list[Moves]:
    """Return the extremes of the elements of a base on springs, from the peaks of `element_moves` and their speeds."""
    rotation, heave = model.rest
    found = list[Moves]()
    for place, each in enumerate(model.elements):
        rest = heave - each.position * rotation
        high, low = extremes[2 * place] - rest, extremes[2 * place + 1] + rest
        found.append(Moves(min(0.0, -float(low)), max(0.0, float(high)), float(speeds[place])))
    return found


def _moves(model: RockingModel, element: BaseElement, stretch: list[float], swing: tuple[float, float]) -> Moves:
    arms = [model.properties.pivot(side).arm - side * element.position for side in (1, -1)]
    ends = [r * each for r, each in zip(arms, stretch, strict=True)]
    return Moves(min(0.0, *ends), max(0.0, *ends), max(abs(r) * each for r, each in zip(arms, swing, strict=True)))


def _largest_force(element: BaseElement, move: Moves) -> float:
    if isinstance(element, ViscousDamper):
        return element.coefficient * move.speed
    if isinstance(element, FrictionDamper):
        return element.force if _yields(element, move) else 0.0
    if isinstance(element, Tendon) and element.post_yield_ratio is None:
        return element.initial_force + element.stiffness * move.high
    first = element.initial_force / element.stiffness if isinstance(element, Tendon) else 0.0
    high = first + min(move.high, math.inf if element.rupture_elongation is None else element.rupture_elongation)
    low = 0.0 if _pulls_only(element) else first + move.low
    return max(_first_loading(element, high), _first_loading(element, -low))


def _first_loading(element: Tendon | YieldingDissipator, stretch: float) -> float:
    """Return the force of a bar that has never yielded at a stretch in m, counted from zero force."""
    k, ratio, limit = element.stiffness, element.post_yield_ratio or 0.0, element.yield_force or 0.0
    elastic = k * stretch
    return elastic if elastic <= limit else max(ratio * elastic + (1.0 - ratio) * limit, limit)


def _yields(element: BaseElement, move: Moves) -> bool:
    """Return whether an element yields or slides; of an elastic tendon, whether it exceeds its yield force."""
    if isinstance(element, ViscousDamper):
        return False
    if isinstance(element, FrictionDamper):
        return move.low != 0.0 or move.high != 0.0
    if isinstance(element, Tendon):
        limit = math.inf if element.yield_force is None else element.yield_force
        return element.initial_force + element.stiffness * move.high > limit
    low = 0.0 if element.tension_only else move.low
    return element.stiffness * max(move.high, -low) > element.yield_force


def _pulls_only(element: Tendon | YieldingDissipator) -> bool:
    return element.tension_only if isinstance(element, YieldingDissipator) else True


def _remaining_prestress(model: RockingModel, final_state: Array) -> list[float]:
    """Return the force of each tendon in contact after the end of a run, in N; zero if it is slack or broken."""
    row = np.concatenate((np.zeros(HEADER), final_state))
    if not isinstance(model, SpringModel):
        row[SIDE] = np.sign(final_state[model.layout.rotation])
    plastic = plastic_stretches(model, row[None])[0]
    found: list[float] = []
    for each, lost in zip(model.properties.elements, plastic.tolist(), strict=True):
        if isinstance(each, Tendon):  # the plastic stretch of an elastic one is zero
            share = (1.0 - (each.post_yield_ratio or 0.0)) * each.stiffness * lost
            found.append(0.0 if math.isnan(lost) else max(each.initial_force - share, 0.0))
    return found
