"""Floors: peaks, histories, and the acceleration of a floor as a motion."""

import math
from dataclasses import dataclass
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite_vector, checked_positive, checked_whole_number
from rockflex.foundation.errors import InputError, MissingQuantityError
from rockflex.foundation.values import Value
from rockflex.models._named_quantities import floor_quantities, levers_of_joints
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import TIME
from rockflex.models._stored_energies import floor_accelerations
from rockflex.models._values_at_states import quantities_at_states
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._interpolation import even_instants, interpolated_states
from rockflex.structure._analysis import FloorModes


@dataclass(frozen=True, eq=False, init=False)
class FloorPeaks(Value):
    """Largest magnitudes at the floors during a run, including peaks between samples; read-only arrays.

    Attributes
    ----------
    story_drift : ndarray, shape (N_floors,)
        Displacement of each floor minus that of the floor below, relative to the rotated base, in m.
    story_shear : ndarray, shape (N_floors,)
        Sum of the elastic forces at and above each floor, in N.
    floor_acceleration : ndarray, shape (N_floors,)
        Total horizontal acceleration of each floor, in m/s²; for nonlinear models only at samples and events.
    total_floor_displacement : ndarray, shape (N_floors,)
        Horizontal displacement of each floor relative to the ground in m, including the rotation of the base (Eq. 3).

    Raises
    ------
    InputError
        If the lengths differ, or a value is not finite.
    """

    story_drift: Array
    story_shear: Array
    floor_acceleration: Array
    total_floor_displacement: Array

    def __init__(
        self,
        story_drift: ArrayLike,
        story_shear: ArrayLike,
        floor_acceleration: ArrayLike,
        total_floor_displacement: ArrayLike,
    ) -> None:
        peaks = {
            "story_drift": checked_finite_vector("story_drift", story_drift, "m"),
            "story_shear": checked_finite_vector("story_shear", story_shear, "N"),
            "floor_acceleration": checked_finite_vector("floor_acceleration", floor_acceleration, "m/s²"),
            "total_floor_displacement": checked_finite_vector(
                "total_floor_displacement", total_floor_displacement, "m"
            ),
        }
        sizes = [values.size for values in peaks.values()]
        if len(set(sizes)) > 1:
            raise InputError(
                f"There must be one peak of each kind per floor, but {', '.join(peaks)} have the sizes {sizes}."
            )
        vars(self).update(peaks)


HISTORY_NAMES = ("story_drift", "story_shear", "total_floor_displacement")


def floor_histories(model: RockingModel, states: Array) -> tuple[Array, Array, Array, Array]:
    """Return story drifts (m), story shears (N), total horizontal accelerations (m/s²) and displacements (m).

    Each has the shape (n, N_floors), and is read-only.

    Raises
    ------
    MissingQuantityError
        If the structure has no floors.
    """
    floors = model.properties.floors
    if floors is None:
        raise MissingQuantityError(
            "The properties of the structure include no floors, so there are no story drifts, story shears, floor "
            "accelerations or floor displacements. Simulate a Frame or a LumpedStructure, or give RockingProperties "
            "their floors."
        )
    values = quantities_at_states(model, floor_quantities(model, floors, HISTORY_NAMES), states)
    drift, shear, displacement = np.split(values, len(HISTORY_NAMES), axis=1)
    histories = drift, shear, floor_accelerations(model, floors, states), displacement
    for each in histories:
        each.setflags(write=False)
    return histories


MAX_FLOOR_STEP = 0.005  # s: the longest step of a floor's motion unless another is given
STEPS_PER_PERIOD = 20  # steps in the shortest period of the modes


def floor_motion(
    model: RockingModel, states: Array, floor: SupportsIndex, dt: float | None, *, impulses: bool
) -> GroundMotion:
    """Return the total horizontal acceleration of a floor as a motion; see `History.floor_motion`."""
    floors = model.properties.floors
    if floors is None:
        raise MissingQuantityError(
            "The properties of the structure include no floors, so there is no floor motion. Simulate a Frame or a "
            "LumpedStructure, or give RockingProperties their floors."
        )
    number = checked_whole_number("floor", floor, 1, floors.heights.size)
    omega, known = model.properties.omega, states[:, TIME]
    shortest = 2.0 * math.pi / float(omega.max()) if omega.size else math.inf
    step = min(MAX_FLOOR_STEP, shortest / STEPS_PER_PERIOD) if dt is None else checked_positive("dt", dt, "s")
    span = float(known[-1] - known[0])
    times = even_instants(span / max(math.ceil(span / step - 1e-9), 2), known)
    samples = floor_accelerations(model, floors, interpolated_states(model, states, times))[:, number - 1]
    step = span / (times.size - 1)
    if impulses:
        place = np.minimum((known[1:] - known[0]) / step, times.size - 1.0)
        before = np.minimum(place.astype(np.intp), times.size - 2)
        later = place - before
        gained, risen = (each[:, number - 1] for each in _jumps(model, floors, states))
        gained = gained + (0.5 - later) * step * risen  # what a straight line through a step leaves out
        samples = samples.copy()
        np.add.at(samples, before, (1.0 - later) * gained / step)
        np.add.at(samples, before + 1, later * gained / step)
    return GroundMotion(samples, step, f"floor {number}")


def _jumps(model: RockingModel, floors: FloorModes, states: Array) -> tuple[Array, Array]:
    """Return the sudden changes of the velocity and acceleration of the floors, in m/s and m/s², (n_states - 1, N).

    Velocities change at impacts, where θ = 0, so the sum is that of small rotations for all models.
    """
    layout = model.layout
    heights = model.properties.turning_heights(floors.heights)
    speed = layout.of(states, layout.spin)[:, None] * heights + layout.velocities(states) @ floors.displacement.T
    if layout.n_joints:
        spins = np.column_stack([layout.of(states, place + 1) for place in layout.rotations[1:]])
        speed = speed + spins @ levers_of_joints(model.properties, floors.heights).T
    if layout.slip >= 0:
        speed = speed + layout.of(states, layout.slip + 1)[:, None]
    sudden = np.diff(states[:, TIME])[:, None] == 0.0
    changes = speed, floor_accelerations(model, floors, states)
    return tuple(np.where(sudden, np.diff(each, axis=0), 0.0) for each in changes)  # pyright: ignore[reportReturnType]
