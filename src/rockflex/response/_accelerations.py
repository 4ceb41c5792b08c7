"""The accelerations at the nodes of a history, which no state holds."""

import numpy as np
from numpy.typing import NDArray

from rockflex._kernel import kernel
from rockflex.models import EXTRA, Field, LinearModel, RockingModel, field_rates

__all__ = ["accelerations", "acting_side", "motion_rates", "rates_of"]

Array = NDArray[np.float64]


def acting_side(nodes: Array) -> Array:
    """Side of each node, shape (n_nodes,); a contact of no length never acts, so there it is what follows."""
    side = nodes[:, 1].copy()
    following = np.append(nodes[1:, 0] == nodes[:-1, 0], False)
    for node in np.flatnonzero((side[1:] == 0.0) & (side[:-1] != 0.0)) + 1:
        end = int(node)
        while following[end] and side[end] == 0.0:
            end += 1
        if nodes[end, 0] == nodes[node - 1, 0]:
            side[node:end] = side[end]
    return side


def accelerations(model: RockingModel, nodes: Array) -> Array:
    """D''_1..D''_N in m/s² and θ'' in rad/s² at every node, shape (n_nodes, N + 1)."""
    side = acting_side(nodes)
    n = model.properties.n_modes
    if isinstance(model, LinearModel):
        vector = np.column_stack((nodes[:, 3:], nodes[:, 2], side))
        contact = np.vstack((model.modal_accelerations(rocking=False), np.zeros(2 * n + 4)))
        rocking = np.vstack((model.modal_accelerations(rocking=True), model.angular_acceleration()))
        return np.where(side[:, None] != 0.0, vector @ rocking.T, vector @ contact.T)
    rates = np.zeros((nodes.shape[0], 2 * n + 2 + EXTRA))
    motion = np.ascontiguousarray(nodes[:, 3:])
    _rates_at(model.field(), side, nodes[:, 2].copy(), motion, rates)
    return np.column_stack((rates[:, n : 2 * n], rates[:, 2 * n + 1]))


def motion_rates(model: RockingModel, nodes: Array) -> Array:
    """D', D'', θ' and θ'' at every node in the order of the state, shape (n_nodes, 2N + 2)."""
    return rates_of(model, nodes, accelerations(model, nodes))


def rates_of(model: RockingModel, nodes: Array, found: Array) -> Array:
    """As `motion_rates`, from the accelerations D'' and θ''."""
    n = model.properties.n_modes
    return np.column_stack((nodes[:, 3 + n : 3 + 2 * n], found[:, :-1], nodes[:, 4 + 2 * n], found[:, -1]))


@kernel
def _rates_at(field: Field, side: Array, acceleration: Array, motion: Array, rates: Array) -> None:
    n = field.omega2.size
    for k in range(side.size):
        branch = 1.0 if n == 0 or motion[k, n] >= 0.0 else -1.0
        field_rates(field, side[k], branch, acceleration[k], motion[k], rates[k])
