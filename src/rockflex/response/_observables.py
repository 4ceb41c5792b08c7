"""Responses as linear functionals of the motion, whose peaks the solver tracks."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockflex.modal import FloorModes
from rockflex.models import LinearModel

__all__ = ["GLOBAL", "Observables", "floor_observables", "global_observables"]

Array = NDArray[np.float64]

GLOBAL = ("top_displacement", "base_moment", "base_shear")


@dataclass(frozen=True, eq=False)
class Observables:
    """Rows over [D.., D'.., θ, θ', a, s] in contact and while rocking, (F, 2N + 4) each."""

    contact: Array
    rocking: Array

    def __add__(self, other: "Observables") -> "Observables":
        return Observables(np.vstack((self.contact, other.contact)), np.vstack((self.rocking, other.rocking)))

    def evaluate(self, nodes: Array) -> Array:
        """Values at the nodes of a history (time, side, a, state), shape (n_nodes, F)."""
        vector = np.column_stack((nodes[:, 3:], nodes[:, 2], nodes[:, 1]))
        return np.where(nodes[:, 1:2] != 0.0, vector @ self.rocking.T, vector @ self.contact.T)


def global_observables(model: LinearModel) -> Observables:
    """u_top = Σ Γ φ_top D, M_b = Σ m* h* ω² D and V_b = Σ m* ω² D, the elastic forces alone, in this order."""
    p = model.properties
    shear = p.effective_mass * p.omega**2
    rows = np.zeros((3, 2 * p.n_modes + 4))
    rows[:, : p.n_modes] = (p.top_ordinate, shear * p.effective_height, shear)
    return Observables(rows, rows)


def floor_observables(model: LinearModel, floors: FloorModes) -> Observables:
    """Story drifts (m), story shears (N) and total floor accelerations (m/s²), N_floors rows of each.

    A drift is the displacement of a floor less that of the one below, relative to the rotated base; a story shear is
    the sum of the elastic forces from its floor up; a total acceleration is a + h θ'' + Σ Γ φ D'', horizontal.
    """
    n = model.properties.n_modes
    drift = np.diff(floors.displacement, axis=0, prepend=0.0)
    shear = np.cumsum(floors.force[::-1], axis=0)[::-1]
    elastic = np.zeros((2 * floors.heights.size, 2 * n + 4))
    elastic[:, :n] = np.vstack((drift, shear))
    contact = floors.displacement @ model.modal_accelerations(rocking=False)
    rocking = floors.displacement @ model.modal_accelerations(rocking=True)
    rocking += np.outer(floors.heights, model.angular_acceleration())
    contact[:, -2] += 1.0
    rocking[:, -2] += 1.0
    return Observables(np.vstack((elastic, contact)), np.vstack((elastic, rocking)))
