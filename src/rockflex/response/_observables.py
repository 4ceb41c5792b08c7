"""Responses as linear functionals of the motion, whose peaks the solver tracks."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockflex.modal import FloorModes
from rockflex.models import LinearModel, RockingModel
from rockflex.response._accelerations import acting_side

__all__ = ["GLOBAL", "Observables", "elastic_observables", "floor_observables", "global_observables"]

Array = NDArray[np.float64]

GLOBAL = ("top_displacement", "base_moment", "base_shear")


@dataclass(frozen=True, eq=False)
class Observables:
    """Rows over [D.., D'.., θ, θ', a, s] in contact and while rocking, (F, 2N + 4) each; nonlinear: z after θ'."""

    contact: Array
    rocking: Array

    def __add__(self, other: "Observables") -> "Observables":
        return Observables(np.vstack((self.contact, other.contact)), np.vstack((self.rocking, other.rocking)))

    def evaluate(self, nodes: Array) -> Array:
        """Values at the nodes of a history (time, side, a, motion), shape (n_nodes, F)."""
        side = acting_side(nodes)
        vector = np.column_stack((nodes[:, 3 : self.contact.shape[1] + 1], nodes[:, 2], side))
        return np.where(side[:, None] != 0.0, vector @ self.rocking.T, vector @ self.contact.T)


def global_observables(model: RockingModel) -> Observables:
    """u_top = Σ Γ φ_top D, M_b = Σ m* h* ω² D and V_b = Σ m* ω² D, the elastic forces alone, in this order.

    Of a superstructure that yields, the forces are those of Eq. 37.
    """
    p = model.properties
    n = p.n_modes
    force = p.effective_mass[:, None] * _restoring(model)
    rows = np.zeros((3, force.shape[1]))
    rows[0, :n] = p.top_ordinate
    rows[1] = p.effective_height @ force
    rows[2] = force.sum(axis=0)
    return Observables(rows, rows)


def elastic_observables(model: RockingModel, floors: FloorModes) -> Observables:
    """Story drifts (m) and story shears (N), N_floors rows of each.

    A drift is the displacement of a floor less that of the one below, relative to the rotated base; a story shear is
    the sum of the elastic forces from its floor up.
    """
    n = model.properties.n_modes
    restoring = _restoring(model)
    drift = np.zeros((floors.heights.size, restoring.shape[1]))
    drift[:, :n] = np.diff(floors.displacement, axis=0, prepend=0.0)
    shear = np.cumsum((floors.force / model.properties.omega**2)[::-1], axis=0)[::-1] @ restoring
    rows = np.vstack((drift, shear))
    return Observables(rows, rows)


def floor_observables(model: LinearModel, floors: FloorModes) -> Observables:
    """Story drifts, story shears and total floor accelerations a + h θ'' + Σ Γ φ D'' (m/s²), N_floors rows of each."""
    contact = floors.displacement @ model.modal_accelerations(rocking=False)
    rocking = floors.displacement @ model.modal_accelerations(rocking=True)
    rocking += np.outer(floors.heights, model.angular_acceleration())
    contact[:, -2] += 1.0
    rocking[:, -2] += 1.0
    return elastic_observables(model, floors) + Observables(contact, rocking)


def _restoring(model: RockingModel) -> Array:
    """The restoring accelerations of the modes, ω² D or those of Eq. 37: rows, one a mode."""
    n = model.properties.n_modes
    if isinstance(model, LinearModel):
        rows = np.zeros((n, 2 * n + 4))
        rows[:, :n] = np.diag(model.properties.omega**2)
        return rows
    rows = np.zeros((n, 2 * n + 5))
    stiffness = model.stiffness()
    rows[:, :n] = stiffness[:, :-1]
    rows[:, 2 * n + 2] = stiffness[:, -1]
    return rows
