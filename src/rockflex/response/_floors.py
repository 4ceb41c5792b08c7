"""Floor histories: drifts, shears, accelerations and displacements."""

import numpy as np

from rockflex._arrays import Array
from rockflex.models import RockingModel, floor_accelerations, floor_quantities, values_of
from rockflex.response._missing import MissingQuantityError

NAMES = ("story_drift", "story_shear", "total_floor_displacement")


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
    values = values_of(model, floor_quantities(model, floors, NAMES), states)
    drift, shear, displacement = np.split(values, len(NAMES), axis=1)
    histories = drift, shear, floor_accelerations(model, floors, states), displacement
    for each in histories:
        each.setflags(write=False)
    return histories
