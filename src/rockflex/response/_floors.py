"""Floor histories: drifts, shears, accelerations and displacements."""

import numpy as np

from rockflex._arrays import Array
from rockflex.modal import FloorModes
from rockflex.models import RockingModel, floor_accelerations, floor_quantities, values_of

NAMES = ("story_drift", "story_shear", "total_floor_displacement")


def floor_histories(model: RockingModel, floors: FloorModes, states: Array) -> tuple[Array, Array, Array, Array]:
    """Return story drifts (m), story shears (N), total horizontal accelerations (m/s²) and displacements (m).

    Each has the shape (n, N_floors).
    """
    values = values_of(model, floor_quantities(model, floors, NAMES), states)
    drift, shear, displacement = np.split(values, len(NAMES), axis=1)
    return drift, shear, floor_accelerations(model, floors, states), displacement
