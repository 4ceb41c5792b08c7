"""Responses as functionals of the motion, whose peaks the solver tracks."""

import numpy as np
from numpy.typing import NDArray

from rockflex.modal import FloorModes
from rockflex.models import (
    HORIZONTAL,
    LEFT_OUT,
    LINEAR,
    SWAY,
    LinearModel,
    NonlinearModel,
    RockingModel,
    horizontal_row,
    missing_mass_rows,
    observe_all,
    row_size,
)
from rockflex.response._accelerations import acting_side, motion_rates
from rockflex.solve import Observables

__all__ = ["GLOBAL", "elastic_observables", "evaluate", "floor_observables", "global_observables"]

Array = NDArray[np.float64]

GLOBAL = ("top_displacement", "base_moment", "base_shear", "total_top_displacement", "horizontal_reaction")


def evaluate(observables: Observables, model: RockingModel, nodes: Array) -> Array:
    """Values at the nodes of a history (time, side, a, motion), shape (n_nodes, F)."""
    side = acting_side(nodes)
    vector = np.column_stack((nodes[:, 3 : row_size(model) + 1], nodes[:, 2], side))
    values = np.where(side[:, None] != 0.0, vector @ observables.rocking.T, vector @ observables.contact.T)
    curved = np.flatnonzero(observables.kinds != LINEAR)
    rocking = side != 0.0
    if curved.size and rocking.any() and isinstance(model, NonlinearModel):
        rates = motion_rates(model, nodes)[rocking]
        known = side[rocking], nodes[rocking, 2], np.ascontiguousarray(nodes[rocking, 3:]), rates
        for f in curved:
            found, (near, far) = values[rocking, f], observables.levers[f].tolist()
            observe_all(model.field(), int(observables.kinds[f]), found, near, far, *known)
            values[rocking, f] = found
    return values


def global_observables(model: RockingModel) -> Observables:
    """u_top, M_b, V_b, the total displacement of the top and ΣF_x, in the order of `GLOBAL`.

    M_b = Σ m* h* ω² D and V_b = Σ m* ω² D are those of the elastic forces alone, of a superstructure that yields those
    of Eq. 37; with the missing mass, of what moves with the base too. Where the height of the top is not known, the row
    of its total displacement is zero.
    """
    p = model.properties
    force = p.effective_mass[:, None] * _restoring(model)
    top = np.zeros((1, force.shape[1]))
    top[0, : p.n_modes] = p.top_ordinate
    elastic = np.vstack((p.effective_height @ force, force.sum(axis=0)))
    return (
        Observables(top, top)
        + (_with_missing_mass(model, elastic) if model.missing_mass else Observables(elastic, elastic))
        + (_swaying(model, top, np.array([p.top_height])) if p.top_height else Observables(0.0 * top, 0.0 * top))
        + _horizontal(model)
    )


def elastic_observables(model: RockingModel, floors: FloorModes) -> Observables:
    """Story drifts (m), story shears (N) and total displacements of the floors (m), N_floors rows of each.

    A drift is the displacement of a floor less that of the one below, relative to the rotated base; a story shear is
    the sum of the elastic forces from its floor up; a total displacement is horizontal and relative to the ground.
    """
    n = model.properties.n_modes
    restoring = _restoring(model)
    sway = np.zeros((floors.heights.size, restoring.shape[1]))
    sway[:, :n] = floors.displacement
    drift = np.diff(sway, axis=0, prepend=0.0)
    shear = np.cumsum((floors.force / model.properties.omega**2)[::-1], axis=0)[::-1] @ restoring
    rows = np.vstack((drift, shear))
    return Observables(rows, rows) + _swaying(model, sway, floors.heights)


def floor_observables(model: LinearModel, floors: FloorModes) -> Observables:
    """Those of `elastic_observables`, and total floor accelerations a + h θ'' + Σ Γ φ D'' (m/s²), N_floors rows."""
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


def _swaying(model: RockingModel, rows: Array, heights: Array) -> Observables:
    """Horizontal displacements relative to the ground of points at some heights whose u are the rows (Eq. 3)."""
    rotation = 2 * model.properties.n_modes
    if _complete(model):
        levers = np.column_stack((heights, np.zeros(heights.size)))
        return Observables(rows, rows, np.full(heights.size, SWAY, dtype=np.int64), levers)
    total = rows.copy()
    total[:, rotation] = heights
    return Observables(rows, total)


def _horizontal(model: RockingModel) -> Observables:
    contact = horizontal_row(model, rocking=False)[None]
    if _complete(model):
        return Observables(contact, np.zeros_like(contact), np.array([HORIZONTAL]))
    rocking = horizontal_row(model, rocking=True)[None] if model.lifts else contact
    return Observables(contact, rocking)


def _with_missing_mass(model: RockingModel, elastic: Array) -> Observables:
    """M_b and V_b with the masses left out."""
    contact = elastic + missing_mass_rows(model, rocking=False)
    if _complete(model):
        left = model.properties.mass_left_out
        levers = np.array([[left[1], left[2]], [left[0], left[1]]])
        return Observables(contact, elastic, np.full(2, LEFT_OUT, dtype=np.int64), levers)
    rocking = elastic + missing_mass_rows(model, rocking=True) if model.lifts else contact
    return Observables(contact, rocking)


def _complete(model: RockingModel) -> bool:
    return isinstance(model, NonlinearModel) and model.complete
