"""The quantities whose peaks a run tracks, and the peaks of edges and elements that follow from them."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._arrays import Array, Bools
from rockflex.modal import BaseElement, FrictionDamper, Tendon, ViscousDamper, YieldingDissipator
from rockflex.models import (
    HEADER,
    SIDE,
    Quantities,
    RockingModel,
    element_moves,
    element_speeds,
    floor_quantities,
    plastic_stretches,
    quantities,
    rotation_by_side,
    swing_by_side,
    values_of,
)
from rockflex.solve import Solution


class Edges(NamedTuple):
    """Largest uplift and settlement of the right and of the left edge in m, neither below zero."""

    uplift: tuple[float, float]
    settlement: tuple[float, float]


def edges_of(model: RockingModel, rotation: tuple[float, float], solution: Solution) -> Edges:
    """Return the extremes of the edges of a run, with its largest |θ| to the right and to the left in rad.

    On rigid ground an edge rises by the width of the base times the rotation about the other edge; on springs the peaks
    of `tracked_extremes` tell, measured from the level at which the springs are unloaded.
    """
    if model.springs is not None:
        right_up, right_down, left_up, left_down = (max(value, 0.0) for value in solution.extremes[:4].tolist())
        return Edges((right_up, left_up), (right_down, left_down))
    width = 2.0 * model.properties.half_width
    right, left = rotation
    if model.complete:
        right, left = float(np.sin(right)), float(np.sin(left))
    return Edges((width * left, width * right), (0.0, 0.0))


def balance_ratio(model: RockingModel, right: Any, left: Any) -> Any:
    """Return the largest |θ|/α of runs with these largest rotations in rad to the right and to the left."""
    of = model.properties.pivot
    return np.maximum(right / of(1).balance_rotation, left / of(-1).balance_rotation)


GLOBAL = ("top_displacement", "base_moment", "base_shear", "total_top_displacement", "horizontal_reaction")
EDGES = ("right_uplift", "right_settlement", "left_uplift", "left_settlement", "right_rotation", "left_rotation")
FLOORS = ("story_drift", "story_shear", "total_floor_displacement", "floor_acceleration")


def tracked_quantities(model: RockingModel, *, floors: bool = False) -> Quantities:
    """Return the quantities for a run of a model: `GLOBAL`, those of the elements, and optionally `FLOORS`.

    The elements need the rotations to each side if the sides differ, and viscous dampers the velocities. Floor
    accelerations are not linear functionals of the state for large rotations, so for an integrated model they are
    computed from its history.
    """
    total = quantities(model, GLOBAL)
    if tracks_both_sides(model):
        total = total + rotation_by_side(model)
    if tracks_elongation_rate(model):
        total = total + swing_by_side(model)
    if model.layout.slip >= 0:
        total = total + quantities(model, ("slip",))
    if model.springs is not None:
        total = total + element_speeds(model)
    if floors and model.properties.floors is not None:
        total = total + floor_quantities(model, model.properties.floors, tracked_floor_quantities(model))
    return total


def tracked_extremes(model: RockingModel) -> Quantities | None:
    """Return the quantities of which only the largest value matters: `EDGES` of a base on springs, and its elements.

    Those are the elongation of each element and its negative.
    """
    if model.springs is None:
        return None
    p = model.properties
    edges = p.pivot(1).arm, -p.pivot(-1).arm
    signs = np.array([1.0, -1.0, 1.0, -1.0, 0.0, 0.0])
    turns = [-edges[0], edges[0], -edges[1], edges[1], 1.0, -1.0]
    of_edges = Quantities.of(len(EDGES), p.n_modes, heave=signs, rotation=turns)
    return of_edges + element_moves(model)


def global_histories(model: RockingModel, states: Array) -> Array:
    """Return the values of `GLOBAL` at the states of a history: read-only, shape (n_states, 5)."""
    values = values_of(model, quantities(model, GLOBAL), states)
    values.setflags(write=False)
    return values


def tracks_both_sides(model: RockingModel) -> bool:
    """Return whether the largest rotation to each side matters on rigid ground, rather than the larger of both."""
    p = model.properties
    return model.springs is None and (not p.symmetric or any(each.position != 0.0 for each in p.elements))


def tracks_elongation_rate(model: RockingModel) -> bool:
    """Return whether viscous dampers act on a base that can lift."""
    return (
        model.springs is None
        and model.lifts
        and any(isinstance(each, ViscousDamper) for each in model.properties.elements)
    )


def tracked_floor_quantities(model: RockingModel) -> tuple[str, ...]:
    """Return the names of the floor quantities whose peaks are tracked during a run."""
    return FLOORS[:-1] if model.integrated else FLOORS


class RotationExtremes(NamedTuple):
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


class ElementExtremes(NamedTuple):
    """Extremes of the elongation δ of one element in m, zero included, and the largest |δ'| in m/s."""

    low: float
    high: float
    speed: float


def element_peaks(model: RockingModel, moves: Sequence[ElementExtremes], final_state: Array) -> ElementPeaks:
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


def elongations_about_pivots(model: RockingModel, reach: RotationExtremes) -> list[ElementExtremes]:
    """Return the extremes of the elements of a base that rotates about its edges."""
    if not model.properties.elements:
        return []
    stretch = model.stretch_per_arm(np.array(reach.rotation)).tolist()
    return [_elongations(model, each, stretch, reach.swing) for each in model.properties.elements]


def elongations_on_springs(model: RockingModel, extremes: Array, speeds: Array) -> list[ElementExtremes]:
    """Return the extremes of the elements of a base on springs, from the peaks of `element_moves` and their speeds."""
    found = list[ElementExtremes]()
    for place, each in enumerate(model.elements):
        rest = model.rest.heave - each.position * model.rest.rotation
        high, low = extremes[2 * place] - rest, extremes[2 * place + 1] + rest
        found.append(ElementExtremes(min(0.0, -float(low)), max(0.0, float(high)), float(speeds[place])))
    return found


def _elongations(
    model: RockingModel, element: BaseElement, stretch: list[float], swing: tuple[float, float]
) -> ElementExtremes:
    arms = [model.properties.pivot(side).arm - side * element.position for side in (1, -1)]
    ends = [r * each for r, each in zip(arms, stretch, strict=True)]
    return ElementExtremes(
        min(0.0, *ends), max(0.0, *ends), max(abs(r) * each for r, each in zip(arms, swing, strict=True))
    )


def _largest_force(element: BaseElement, move: ElementExtremes) -> float:
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


def _yields(element: BaseElement, move: ElementExtremes) -> bool:
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
    row[SIDE] = np.sign(final_state[model.layout.rotation])  # on springs it means nothing
    plastic = plastic_stretches(model, row[None])[0]
    found: list[float] = []
    for each, lost in zip(model.properties.elements, plastic.tolist(), strict=True):
        if isinstance(each, Tendon):  # the plastic stretch of an elastic one is zero
            share = (1.0 - (each.post_yield_ratio or 0.0)) * each.stiffness * lost
            found.append(0.0 if math.isnan(lost) else max(each.initial_force - share, 0.0))
    return found
