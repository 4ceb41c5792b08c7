"""The equations of motion of bases with several degrees of freedom: rotation, slip and heave."""

import numpy as np

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.errors import InputError
from rockflex.models._phase import BaseEquations, BorderedSystem, Key
from rockflex.models._rocking_model import RockingModel

JAMMED = 1e-12  # relative: determinant below which the base has no inertia against a motion


def bordered_system_of(model: RockingModel, equations: BaseEquations, freed: Bools) -> BorderedSystem:
    """Return the equations of motion with the equations of the base, of which some degrees of freedom are free.

    The couplings are c = h* for the rotations, 1 for the slip and 0 for the heave.

    Raises
    ------
    InputError
        If friction leaves a free base without inertia: it jams.
    """
    p, coupling = model.properties, model.couplings
    leverage = p.effective_mass * coupling
    inertia = equations.inertia - leverage @ coupling.T
    free = np.flatnonzero(freed)
    flexibility = np.zeros_like(inertia)
    if free.size:
        kept = inertia[np.ix_(free, free)]
        if not np.linalg.det(kept) > JAMMED * np.prod(np.diag(kept)):
            raise InputError(_no_sliding_solution(model))
        flexibility[np.ix_(free, free)] = np.linalg.inv(kept)
    return BorderedSystem(
        coupling=coupling.copy(),
        leverage=leverage,
        flexibility=flexibility,
        damping=equations.damping,
        stiffness=equations.stiffness,
        constant=equations.constant,
        drive=equations.ground + leverage.sum(axis=1),
        internal_factor=equations.internal_factor,
        freed=freed,
    )


def _no_sliding_solution(model: RockingModel) -> str:
    p = model.properties
    if p.horizontal_mass - p.effective_mass.sum() <= JAMMED * p.m_tot:
        return (
            f"{model.label} with {p.n_modes} modes leaves no mass in the base that slides: Σ m* = m_tot = "
            f"{p.m_tot:.6g} kg. Give the structure a base_mass, or keep fewer modes."
        )
    return (
        f"The base of {model.label} jams: with so large a friction coefficient, no acceleration of a sliding and "
        "rocking base satisfies Coulomb's law. Give a smaller friction, or None for a base that cannot slide."
    )


def accelerations_of(model: RockingModel, key: Key) -> Array:
    """Return D'' of every mode and q'' of the base in a phase as rows, shape (N + b, C)."""
    bordered_system = model.bordered_system(key)
    p, layout = model.properties, model.layout
    n, b, modes = p.n_modes, layout.freedoms, np.arange(p.n_modes)
    rows = np.zeros((n + b, layout.columns))
    rows[:n] -= model.restoring
    rows[modes, n + modes] -= 2.0 * p.zeta * p.omega
    attached, pulls = model.attached_forces(key)
    rows[:n] += attached
    forces = pulls - bordered_system.leverage @ rows[:n]
    rows[:n, -2] = -1.0
    of_base = forces[:, layout.rotation : layout.rotation + 2 * b]
    of_base[:, ::2] -= bordered_system.stiffness
    of_base[:, 1::2] -= bordered_system.damping
    forces[:, layout.memory : layout.memory + layout.n_internal] += bordered_system.internal_factor
    forces[:, -2] += bordered_system.drive
    forces[:, -1] += bordered_system.constant
    rows[n:] = bordered_system.flexibility @ forces
    rows[:n] -= bordered_system.coupling.T @ rows[n:]
    return rows


def horizontal_reaction(model: RockingModel, key: Key) -> Array:
    """Return the horizontal force of the ground on the base in a phase: a row, (C,).

    (m_tot + Σ l) (a + x'') + L_0^r θ'' + Σ m* D'', and what ties from a height pull.
    """
    p, n, accelerations = model.properties, model.properties.n_modes, model.accelerations(key)
    row = (
        model.ties(key)
        + p.effective_mass @ accelerations[:n]
        + p.l0r * accelerations[n]
        + p.horizontal_mass * accelerations[n + 1]
    )
    row[-2] += p.horizontal_mass
    return row
