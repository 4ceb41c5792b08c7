"""The equations of motion of modes on a base with several degrees of freedom."""

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex._errors import InputError
from rockflex.models._modal_model import ModalModel
from rockflex.models._phase import Arrow, Border

JAMMED = 1e-12  # relative: determinant below which the base has no inertia against a motion


def blank_border(freedoms: int, memories: int) -> Border:
    """Return a border without any entry."""
    b = freedoms
    return Border(
        np.zeros((b, b)), np.zeros((b, b)), np.zeros((b, b)), np.zeros(b), np.zeros(b), np.zeros((b, memories))
    )


def arrow_of(model: ModalModel, border: Border, freed: Bools) -> Arrow:
    """Return the equations of motion with the border of the base, of which some degrees of freedom are free.

    The couplings are c = h* for the rotation, 1 for the slip and 0 for the heave.

    Raises
    ------
    InputError
        If friction leaves a free base without inertia: it jams.
    """
    p, layout = model.properties, model.layout
    coupling = np.zeros((layout.freedoms, p.n_modes))
    coupling[0] = p.effective_height
    if layout.slip >= 0:
        coupling[1] = 1.0
    leverage = p.effective_mass * coupling
    inertia = border.inertia - leverage @ coupling.T
    free = np.flatnonzero(freed)
    flexibility = np.zeros_like(inertia)
    if free.size:
        kept = inertia[np.ix_(free, free)]
        if not np.linalg.det(kept) > JAMMED * np.prod(np.diag(kept)):
            raise InputError(_jammed(model))
        flexibility[np.ix_(free, free)] = np.linalg.inv(kept)
    return Arrow(
        coupling=coupling,
        leverage=leverage,
        flexibility=flexibility,
        damping=border.damping,
        stiffness=border.stiffness,
        constant=border.constant,
        drive=border.ground + leverage.sum(axis=1),
        recall=border.recall,
        freed=freed,
    )


def _jammed(model: ModalModel) -> str:
    p = model.properties
    if p.m_tot - p.effective_mass.sum() <= JAMMED * p.m_tot:
        return (
            f"{model.label} with {p.n_modes} modes leaves no mass in the base that slides: Σ m* = m_tot = "
            f"{p.m_tot:.6g} kg. Give the structure a base_mass, or keep fewer modes."
        )
    return (
        f"The base of {model.label} jams: with so large a friction coefficient, no acceleration of a sliding and "
        "rocking base satisfies Coulomb's law. Give a smaller friction, or None for a base that cannot slide."
    )


def accelerations_of(model: ModalModel, arrow: Arrow) -> Array:
    """Return D'' of every mode and q'' of the base as rows, shape (N + b, C)."""
    p, layout = model.properties, model.layout
    n, b, modes = p.n_modes, layout.freedoms, np.arange(p.n_modes)
    rows = np.zeros((n + b, layout.columns))
    rows[:n] -= model.restoring
    rows[modes, n + modes] -= 2.0 * p.zeta * p.omega
    forces = -arrow.leverage @ rows[:n]
    rows[:n, -2] = -1.0
    places = layout.rotation + 2 * np.arange(b)
    forces[:, places] -= arrow.stiffness
    forces[:, places + 1] -= arrow.damping
    forces[:, layout.memory : layout.memory + layout.remembered] += arrow.recall
    forces[:, -2] += arrow.drive
    forces[:, -1] += arrow.constant
    rows[n:] = arrow.flexibility @ forces
    rows[:n] -= arrow.coupling.T @ rows[n:]
    return rows


def horizontal_reaction(model: ModalModel, accelerations: Array) -> Array:
    """Return the horizontal force of the ground on the base, m_tot (a + x'') + L_0^r θ'' + Σ m* D'': a row, (C,)."""
    p, n = model.properties, model.properties.n_modes
    row = p.effective_mass @ accelerations[:n] + p.l0r * accelerations[n] + p.m_tot * accelerations[n + 1]
    row[-2] += p.m_tot
    return row
