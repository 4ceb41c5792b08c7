"""Stored energies and floor accelerations, for small and for large rotations."""

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.models._named_quantities import levers_of_joints
from rockflex.models._rocking_model import RockingModel
from rockflex.models._spring_model import SpringModel
from rockflex.models._state_layout import GROUND, SIDE
from rockflex.models._values_at_states import accelerations_at_states, acting_side
from rockflex.structure._analysis import FloorModes


def stored_energies(model: RockingModel, states: Array) -> tuple[Array, Array, Array]:
    """Return kinetic, strain and gravity energy at the states of a history in J, each of shape (n,).

    Of simplified models those relative to the moving ground: `RockingModel.kinetic_energy`, ½ Σ m* ω² D², and on rigid
    ground s m_tot g B θ - ½ L_0^r g θ²; on springs m_tot g z takes the place of s m_tot g B θ. For complete models
    those of Eqs. 6-8, with the momentum of the motion relative to the base times the velocities of the base.
    """
    p, layout = model.properties, model.layout
    d = layout.displacements(states)
    share = model.bouc_wen.post_yield_ratio if model.bouc_wen else 1.0
    strain = 0.5 * share * d**2 @ (p.effective_mass * p.omega**2)
    if model.complete:
        side, v = states[:, SIDE], layout.velocities(states)
        rotation, spin = layout.of(states, layout.rotation), layout.of(states, layout.spin)
        kinetic = 0.5 * model.rotary_inertia(side) * spin**2 + spin * (v @ (p.effective_mass * p.effective_height))
        kinetic += 0.5 * v**2 @ p.effective_mass
        offset = side * _arm(model, side)
        displaced = d @ p.effective_mass
        kinetic += spin**2 * (0.5 * d**2 @ p.effective_mass - offset * displaced)
        first = displaced - p.m_tot * offset  # Σ m_i u_i from the pivot
        raised = -first * np.sin(rotation) - 2.0 * p.l0r * np.sin(0.5 * rotation) ** 2
        # Momentum along and across the base, but for that of its own motion.
        along, across = v @ p.effective_mass + p.l0r * spin, -first * spin
        if layout.slip >= 0:
            slide = layout.of(states, layout.slip + 1)
            kinetic += slide * (0.5 * p.m_tot * slide + along * np.cos(rotation) + across * np.sin(rotation))
        if layout.heave >= 0:
            climb = layout.of(states, layout.heave + 1)
            kinetic += climb * (0.5 * p.m_tot * climb + across * np.cos(rotation) - along * np.sin(rotation))
            raised = raised + p.m_tot * layout.of(states, layout.heave)
        return kinetic, strain, model.gravity * raised
    return model.kinetic_energy(states), strain, model.gravity * model.raised_weight(states)


def soil_strain(model: RockingModel, states: Array) -> Array:
    """Return the energy stored in each spring under the base in J, shape (n_states, n_springs)."""
    if model.springs is None:
        return np.zeros((states.shape[0], 0))
    layout = model.layout
    depth = layout.of(states, layout.heave)[:, None]
    depth = depth - model.springs.positions * model.turned(layout.of(states, layout.rotation))[:, None]
    if isinstance(model, SpringModel):
        depth = depth + model.permanent_settlements(states)
    return 0.5 * model.springs.stiffness * np.minimum(depth, 0.0) ** 2


def floor_accelerations(model: RockingModel, floors: FloorModes, states: Array) -> Array:
    """Return the total horizontal acceleration of each floor in m/s², shape (n, N_floors).

    a + h θ'' + Σ Γ φ D''; in the complete models the second derivative of the horizontal coordinate of Eq. 3.
    """
    layout = model.layout
    rates, n = accelerations_at_states(model, states), layout.modes
    ground = states[:, GROUND, None] + (rates[:, n + 1, None] if layout.slip >= 0 else 0.0)
    bend = rates[:, :n] @ floors.displacement.T  # u''
    angular = rates[:, n : n + 1]
    if not model.complete:
        upper = rates[:, n + 1 :] @ levers_of_joints(model.properties, floors.heights).T if layout.n_joints else 0.0
        return ground + bend + model.properties.turning_heights(floors.heights) * angular + upper
    rotation, spin = layout.of(states, layout.rotation)[:, None], layout.of(states, layout.spin)[:, None]
    sine, cosine = np.sin(rotation), np.cos(rotation)
    side = acting_side(states)
    offset = (side * _arm(model, side))[:, None]
    u = layout.displacements(states) @ floors.displacement.T
    v = layout.velocities(states) @ floors.displacement.T
    turning = angular * (offset * sine + floors.heights * cosine - u * sine) - 2.0 * spin * v * sine
    centrifugal = spin**2 * (offset * cosine - floors.heights * sine - u * cosine)
    return ground + bend * cosine + turning + centrifugal


def _arm(model: RockingModel, side: Array) -> Array:
    """Return the distance of the pivot of a side from the axis of the masses in m, shape (n,)."""
    p = model.properties
    return np.where(side < 0.0, p.pivot(-1).arm, p.pivot(1).arm)
