"""What the floors do: drifts, shears and accelerations along a history."""

import numpy as np
from numpy.typing import NDArray

from rockflex.modal import FloorModes
from rockflex.models import NonlinearModel, RockingModel
from rockflex.response._accelerations import accelerations, acting_side
from rockflex.response._observables import elastic_observables, evaluate

__all__ = ["floor_accelerations", "floor_histories"]

Array = NDArray[np.float64]


def floor_histories(model: RockingModel, floors: FloorModes, nodes: Array) -> tuple[Array, Array, Array, Array]:
    """Story drifts (m), story shears (N), total horizontal accelerations (m/s²) and displacements (m).

    Shape (n_nodes, N_floors) each.
    """
    drift, shear, displacement = np.split(evaluate(elastic_observables(model, floors), model, nodes), 3, axis=1)
    return drift, shear, floor_accelerations(model, floors, nodes), displacement


def floor_accelerations(model: RockingModel, floors: FloorModes, nodes: Array) -> Array:
    """Total horizontal acceleration of each floor in m/s², shape (n_nodes, N_floors).

    a + h θ'' + Σ Γ φ D''; in the complete models the second derivative of Eq. 3's horizontal coordinate.
    """
    n = model.properties.n_modes
    rates = accelerations(model, nodes)
    bend = rates[:, :-1] @ floors.displacement.T  # u''
    angular = rates[:, -1:]
    total = nodes[:, 2:3] + bend + floors.heights * angular
    if not (isinstance(model, NonlinearModel) and model.complete):
        return total
    sine, cosine = np.sin(nodes[:, 3 + 2 * n, None]), np.cos(nodes[:, 3 + 2 * n, None])
    spin = nodes[:, 4 + 2 * n, None]
    offset = acting_side(nodes)[:, None] * model.properties.half_width
    u = nodes[:, 3 : 3 + n] @ floors.displacement.T
    v = nodes[:, 3 + n : 3 + 2 * n] @ floors.displacement.T
    turning = angular * (offset * sine + floors.heights * cosine - u * sine) - 2.0 * spin * v * sine
    centrifugal = spin**2 * (offset * cosine - floors.heights * sine - u * cosine)
    return nodes[:, 2:3] + bend * cosine + turning + centrifugal
