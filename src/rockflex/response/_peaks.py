"""The quantities whose peaks a run tracks, and the peaks of edges and elements that follow from them."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import compress
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.engine.solution import Solution
from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.constants import GRAVITY
from rockflex.models._element_states import plastic_stretches
from rockflex.models._elements import CLOSED
from rockflex.models._named_quantities import (
    element_moves,
    element_speeds,
    floor_quantities,
    joint_rotations,
    quantities,
    rotation_by_side,
    rotation_rate_by_side,
    tracked_elements,
)
from rockflex.models._quantities import LIFT, LINEAR, Quantities, joined_quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.models._spring_model import SpringModel
from rockflex.models._state_layout import HEADER, SIDE, StateLayout
from rockflex.models._values_at_states import quantities_at_states
from rockflex.structure._rocking import RockingProperties

LAST = 1e-9  # relative: a rotation as close to the largest one is it


def leaning_push(properties: RockingProperties, rotation: Any, shear: Any) -> Any:
    """Return the push Σ l_i g |θ| of leaning columns over the base shear, for largest values of one run or of many."""
    push = properties.leaning_mass * GRAVITY * np.asarray(rotation)
    return np.divide(push, shear, out=np.zeros_like(push), where=np.asarray(shear) > 0.0)


def max_permanent_settlement(model: RockingModel, final: Array) -> float:
    """Return the largest permanent settlement of a spring in m in the last state of a run; zero on rigid ground."""
    if not isinstance(model, SpringModel):
        return 0.0
    return float(model.permanent_settlements(np.concatenate((np.zeros(HEADER), final))[None]).max())


def column_pull(properties: RockingProperties, moment: float) -> float:
    """Return the base moment of a run in N m over that which first pulls a column up; zero if that is not known."""
    return 0.0 if properties.columns is None else moment / properties.columns.pull_moment


def may_fall(
    properties: Sequence[RockingProperties], layout: StateLayout, final: Array, turned: Array, rocking: Bools
) -> Bools:
    """Return whether the bases of R runs may still overturn after their last states, shape (R,).

    A run that ends rocking may if θ is at its largest there and still grows, or if its energy, as of a rigid body with
    the angular momentum of the last instant, suffices to pass the rotation at which the static moment vanishes.

    Parameters
    ----------
    properties
        Of each run.
    layout, final
        Of the states, and the last ones, shape (R, S).
    turned
        Largest |θ| of each run in rad, shape (R,).
    rocking
        Whether each run rocked, and neither overturned nor came to rest, shape (R,).
    """
    found, spins = np.zeros(len(properties), dtype=np.bool_), final[:, layout.rotation + 1]
    angles, velocities = final[:, layout.rotation], final[:, layout.modes : 2 * layout.modes]
    for k in np.flatnonzero(rocking & (angles != 0.0)).tolist():
        p = properties[k]
        pivot = p.pivot(1 if angles[k] > 0.0 else -1)
        momentum = pivot.i_theta * spins[k] + float((p.effective_mass * p.effective_height) @ velocities[k])
        ahead = pivot.balance_rotation - abs(angles[k])
        falls = pivot.rocking_stiffness < 0.0 and (
            ahead <= 0.0 or momentum**2 > -pivot.rocking_stiffness * pivot.i_theta * ahead**2
        )
        found[k] = falls or (angles[k] * spins[k] > 0.0 and abs(angles[k]) >= turned[k] * (1.0 - LAST))
    return found


def balance_ratio(model: RockingModel, right: Any, left: Any) -> Any:
    """Return the largest |θ|/α of runs with these largest rotations in rad to the right and to the left."""
    of = model.properties.pivot
    return np.maximum(right / of(1).balance_rotation, left / of(-1).balance_rotation)


GLOBAL = ("top_displacement", "base_moment", "base_shear", "total_top_displacement", "horizontal_reaction")
ROTATIONS = ("right_rotation", "left_rotation")
EDGES = ("right_uplift", "right_settlement", "left_uplift", "left_settlement", *ROTATIONS)
FLOORS = ("story_drift", "story_shear", "total_floor_displacement", "floor_acceleration")


@dataclass(frozen=True, eq=False)
class NamedPeakRows:
    """Quantities whose peaks a run keeps, and the places of these peaks in its solution.

    Parameters
    ----------
    quantities
        The quantities.
    places
        Place by name; a slice for a name with several values.
    """

    quantities: Quantities
    places: Mapping[str, int | slice]

    @classmethod
    def of(
        cls, parts: Sequence[tuple[tuple[str, ...] | str, Quantities]], before: tuple[str, ...] = ()
    ) -> "NamedPeakRows":
        """Return the rows of parts in their order, after other names.

        A part has a tuple with the name of each row, or one name for all its rows.
        """
        places = _places_of_rows(tuple([(name, len(part)) for name, part in parts]), before)
        return cls(joined_quantities([part for _, part in parts]), places)

    def named(self, peaks: Array) -> dict[str, Array]:
        """Return peaks, or their times, by name: from the shape (..., F), of one name (...), or (k, ...) of a slice."""
        return {name: peaks.T[place] for name, place in self.places.items()}


@lru_cache(maxsize=256)
def _places_of_rows(
    parts: tuple[tuple[tuple[str, ...] | str, int], ...], before: tuple[str, ...]
) -> Mapping[str, int | slice]:
    """Return the places of the rows of parts by name, of which each has a number of rows."""
    places: dict[str, int | slice] = {name: place for place, name in enumerate(before)}
    first = len(before)
    for name, count in parts:
        end = first + count
        if isinstance(name, str):
            places[name] = slice(first, end)
        else:
            places |= zip(name, range(first, end), strict=True)
        first = end
    return places


class TrackedPeaks(NamedTuple):
    """The peaks that a run tracks: largest magnitudes, and, on springs, largest values."""

    peaks: NamedPeakRows
    extremes: NamedPeakRows | None

    def of(self, solution: Solution) -> dict[str, Array]:
        """Return the peaks and extremes of a run by name, each of shape () or (k,)."""
        found = self.peaks.named(solution.peaks)
        return found if self.extremes is None else found | self.extremes.named(solution.extremes)


def tracked_quantities(
    model: RockingModel, *, floors: bool = False, more: Mapping[str, Quantities] | None = None
) -> TrackedPeaks:
    """Return the quantities for a run of a model: `GLOBAL`, those of its base, optionally `FLOORS`, and `more` by name.

    Elements need the largest rotation to each side if the sides differ, and viscous dampers the velocities. Those of
    `tracked_elements` need the largest values of `element_moves`, and on springs `EDGES` are tracked, too. Floor
    accelerations are not linear functionals of the state for large rotations, so for an integrated model they are
    computed from its history.
    """
    p = model.properties
    parts: list[tuple[tuple[str, ...] | str, Quantities]] = [(GLOBAL, quantities(model, GLOBAL))]
    most: list[tuple[tuple[str, ...] | str, Quantities]] = []
    under = [each for each in p.elements if not each.attached]
    if model.springs is not None:
        most = [(EDGES, _edges(model))]
    elif not p.symmetric or any(each.position != 0.0 for each in under):
        parts.append((ROTATIONS, rotation_by_side(model)))
    if tracked_elements(model):
        most.append(("element_moves", element_moves(model)))
        parts.append(("element_speeds", element_speeds(model)))
    if model.layout.n_joints:
        parts.append(("joint_rotation", joint_rotations(model)))
        most.append(("joint_relief", _relief_of_joints(model)))
    if model.springs is None and model.lifts and any(each.rate_dependent for each in under):
        parts.append(("rotation_rate_by_side", rotation_rate_by_side(model)))
    if model.layout.slip >= 0:
        parts.append((("slip",), quantities(model, ("slip",))))
    if floors and p.floors is not None:
        names = FLOORS[:-1] if model.integrated else FLOORS
        parts += [(name, floor_quantities(model, p.floors, (name,))) for name in names]
    peaks = NamedPeakRows.of([*parts, *(more or {}).items()], ("rotation",))  # the engine puts the rotation first
    return TrackedPeaks(peaks, NamedPeakRows.of(most) if most else None)


def _relief_of_joints(model: RockingModel) -> Quantities:
    """Return the axial force of each joint above the base with the other sign: the largest value is the least force."""
    count = len(model.joints)
    return Quantities.of(count, model.properties.n_modes, joint_force=-np.eye(count))


def _edges(model: RockingModel) -> Quantities:
    """Return `EDGES` of a base on springs, of which only the largest value matters."""
    p = model.properties
    right, left = p.pivot(1).arm, -p.pivot(-1).arm
    signs = np.array([1.0, -1.0, 1.0, -1.0, 0.0, 0.0])
    found = Quantities.of(len(EDGES), p.n_modes, LIFT, heave=signs, rotation=[-right, right, -left, left, 1.0, -1.0])
    found.kinds[4:] = LINEAR  # the rotations themselves
    return found


def largest_rotations(peaks: Mapping[str, Array]) -> tuple[float, float]:
    """Return the largest |θ| of a run to the right and to the left in rad; if they are not tracked, that of both."""
    right, left = (float(peaks.get(name, peaks["rotation"])) for name in ROTATIONS)
    return max(right, 0.0), max(left, 0.0)


def largest_edge_moves(model: RockingModel, peaks: Mapping[str, Array]) -> tuple[float, float]:
    """Return the largest uplift and the largest settlement of an edge in a run in m, neither below zero.

    On rigid ground an edge rises by the width of the base times the rotation about the other edge; on springs moves
    count from the level at which these are unloaded.
    """
    if model.springs is not None:
        up, down = ([float(peaks[f"{side}_{move}"]) for side in ("right", "left")] for move in ("uplift", "settlement"))
        return max(0.0, *up), max(0.0, *down)
    largest = max(largest_rotations(peaks))
    return 2.0 * model.properties.half_width * (float(np.sin(largest)) if model.complete else largest), 0.0


def global_histories(model: RockingModel, states: Array) -> dict[str, Array]:
    """Return the values of `GLOBAL` at the states of a history by name: read-only, each of shape (n_states,)."""
    values = quantities_at_states(model, quantities(model, GLOBAL), states)
    values.setflags(write=False)
    return dict(zip(GLOBAL, values.T, strict=True))


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
    ductility: Array
    residual_drift: Array
    residual_drift_ratio: Array


def peak_numbers(model: RockingModel, solution: Solution, tracked: TrackedPeaks) -> dict[str, Any]:
    """Return the fields of a `Response` that follow from the peaks and the last state of a run, by name."""
    p, final, peaks = model.properties, solution.final_state, tracked.of(solution)
    rotation, (right, left) = float(peaks["rotation"]), largest_rotations(peaks)
    uplift, settlement = largest_edge_moves(model, peaks)
    found = {f"max_{name}": float(peaks[name]) for name in ("rotation", *GLOBAL)}
    if p.top_height is None:
        found["max_total_top_displacement"] = math.nan
    least = p.resting_reaction - solution.lost_support  # springs cannot pull: in flight only rounding would say so
    return {
        **found,
        "min_vertical_reaction": least if model.springs is None else max(least, 0.0),
        **element_peaks(model, element_extremes(model, peaks), final)._asdict(),
        "residual_rotation": math.nan
        if solution.overturned
        else float(final[model.layout.rotation]) - model.rest.rotation,
        "balance_ratio": float(balance_ratio(model, right, left)),
        "max_joint_rotation": float(np.max(peaks.get("joint_rotation", 0.0))),
        "min_joint_force": 0.0 - float(np.max(peaks.get("joint_relief", 0.0))),  # no -0.0
        "settlement": 0.0 if model.springs is None else -float(final[model.layout.heave]),
        "max_permanent_settlement": max_permanent_settlement(model, final),
        "max_slip": float(peaks.get("slip", 0.0)),
        "residual_slip": float(final[model.layout.slip]) if model.layout.slip >= 0 else 0.0,
        "max_edge_uplift": uplift,
        "max_edge_settlement": settlement,
        "leaning_push": float(leaning_push(p, rotation, found["max_base_shear"])),
        "column_pull": column_pull(p, found["max_base_moment"]),
    }


def _fixed(values: ArrayLike) -> NDArray[Any]:
    array = np.array(values)
    array.setflags(write=False)
    return array


OF_STORIES = ("ductility", "residual_drift", "residual_drift_ratio")
ELEMENT_PEAKS = (
    *("max_element_force", "max_element_elongation", "element_yielded", "remaining_prestress"),
    *OF_STORIES,
)
EMPTY: Array = _fixed(np.zeros(0))
NONE = ElementPeaks(
    EMPTY, EMPTY, _fixed(np.zeros(0, dtype=np.bool_)), EMPTY, 0.0, 0.0, False, False, EMPTY, EMPTY, EMPTY
)


class ElementExtremes(NamedTuple):
    """Extremes of the elongation δ of one element in m, zero included, and the largest |δ'| in m/s."""

    low: float
    high: float
    speed: float


def element_peaks(model: RockingModel, moves: Sequence[ElementExtremes], final_state: Array) -> ElementPeaks:
    """Return the peaks of the elements of a run, and what is left of them in its last state."""
    given = model.properties.elements
    of_stories = _of_stories(model, moves[len(given) :], final_state)
    if not given:
        return NONE._replace(**of_stories)
    extremes = [each.extremes(*move) for each, move in zip(given, moves, strict=False)]  # stories follow
    forces, yielded = [force for force, _ in extremes], [beyond for _, beyond in extremes]
    of_tendons = compress(extremes, [each.prestressed for each in given])
    tendons = [(each, *both) for each, both in zip(model.properties.tendons, of_tendons, strict=True)]
    shares = [force / each.yield_force for each, force, _ in tendons if each.yield_force]
    return ElementPeaks(
        max_element_force=_fixed(forces),
        max_element_elongation=_fixed([max(-move.low, move.high) for move in moves[: len(given)]]),
        element_yielded=_fixed(yielded),
        remaining_prestress=_fixed(_remaining_prestress(model, final_state)),
        max_tendon_force=max((force for _, force, _ in tendons), default=0.0),
        tendon_utilisation=max(shares, default=math.nan) if tendons else 0.0,
        tendon_yield=any(beyond for _, _, beyond in tendons),
        tendon_overload=any(beyond and each.post_yield_ratio is None for each, _, beyond in tendons),
        **of_stories,
    )


def _of_stories(model: RockingModel, moves: Sequence[ElementExtremes], final_state: Array) -> dict[str, Array]:
    """Return the ductility of each story and its drift at rest after the run; nothing if no story yields."""
    p = model.properties
    if not p.stories or p.floors is None:
        return dict.fromkeys(OF_STORIES, EMPTY)
    ductility = np.zeros(p.floors.heights.size)
    for story, move in zip(p.stories, moves, strict=True):
        ductility[story.floor - 1] = max(-move.low, move.high) * story.stiffness / story.yield_force
    left = model.bent_at_rest(plastic_stretches(model, _as_history(model, final_state)[None])[0])
    drift = np.diff(p.floors.displacement @ left, prepend=0.0)
    return {
        "ductility": _fixed(ductility),
        "residual_drift": _fixed(drift),
        "residual_drift_ratio": _fixed(drift / p.floors.story_heights),
    }


def _as_history(model: RockingModel, final_state: Array) -> Array:
    """Return the last state of a run as one of a history."""
    row = np.concatenate((np.zeros(HEADER), final_state))
    row[SIDE] = np.sign(final_state[model.layout.rotation])  # on springs it means nothing
    return row


def element_extremes(model: RockingModel, peaks: Mapping[str, Array]) -> list[ElementExtremes]:
    """Return the extremes of the elements of a run, and then those of the stories that yield."""
    tracked = tracked_elements(model)
    known = dict(zip(tracked, _extremes_of(model, peaks), strict=True)) if tracked else {}
    if len(known) == len(model.elements):
        return [known[place] for place in range(len(model.elements))]
    swing = peaks.get("rotation_rate_by_side", np.zeros(1))  # one value if the sides do not differ
    under = extremes_about_pivots(model, largest_rotations(peaks), (float(swing[0]), float(swing[-1])))
    return [known.get(place) or under[place] for place in range(len(model.elements))]


def extremes_about_pivots(
    model: RockingModel, rotation: tuple[float, float], swing: tuple[float, float] = (0.0, 0.0)
) -> list[ElementExtremes]:
    """Return the extremes of the elements of a base that rotates about its edges.

    Parameters
    ----------
    model
        The model.
    rotation, swing
        The largest |θ| in rad and the largest |δ'/r| in rad/s, to the right and to the left.
    """
    found = list[ElementExtremes]()
    stretch = model.stretch_per_arm(np.array(rotation)).tolist()
    for each in model.properties.elements:
        arms = [each.arm(model.properties.pivot(side).arm, side) for side in (1, -1)]
        ends = [r * delta for r, delta in zip(arms, stretch, strict=True)]
        speeds = [abs(r) * rate for r, rate in zip(arms, swing, strict=True)]
        found.append(ElementExtremes(min(0.0, *ends), max(0.0, *ends), max(speeds)))
    return found


def _extremes_of(model: RockingModel, peaks: Mapping[str, Array]) -> list[ElementExtremes]:
    """Return the extremes of `tracked_elements`, from the peaks of `element_moves` and of their speeds."""
    found = list[ElementExtremes]()
    moves, speeds = peaks["element_moves"].reshape(-1, 2).tolist(), peaks["element_speeds"].tolist()
    for place, (high, low), speed in zip(tracked_elements(model), moves, speeds, strict=True):
        first = float(model.stretch(place, model.stance_on(CLOSED))[-1])
        found.append(ElementExtremes(min(0.0, first - low), max(0.0, first + high), speed))
    return found


def _remaining_prestress(model: RockingModel, final_state: Array) -> list[float]:
    """Return the force of each tendon in contact after the end of a run, in N; zero if it is slack or broken."""
    elements = model.properties.elements  # stories follow
    plastic = plastic_stretches(model, _as_history(model, final_state)[None])[0, : len(elements)].tolist()
    left = compress(plastic, [each.prestressed for each in elements])  # zero of an elastic one
    return [each.remaining_prestress(lost) for each, lost in zip(model.properties.tendons, left, strict=True)]
