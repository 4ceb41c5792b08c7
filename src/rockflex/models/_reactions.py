"""The ground reactions (Silva & Stojadinović 2024, Eqs. 21 and 22).

With u_i from the modes kept, Σ m_i u_i = Σ m*_n D_n, so the sums over the masses reduce to m_tot, L_0^r and this sum.
"""

from typing import NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.constants import GRAVITY
from rockflex.models._element_states import element_forces
from rockflex.models._elements import CLOSED
from rockflex.models._field_numbers import field_numbers
from rockflex.models._quantities import HORIZONTAL, VERTICAL
from rockflex.models._rocking_model import RockingModel
from rockflex.models._spring_model import LOADED, YIELDING, SpringModel
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE
from rockflex.models._values_at_states import acting_side, observed, rates_at_states


class Reactions(NamedTuple):
    """Ground reactions in N, each of shape (n,)."""

    horizontal: Array
    vertical: Array


def reactions(model: RockingModel, states: Array, rates: Array) -> Reactions:
    """Return Σ m_i (a + x''_i), Eq. 21, and Σ m_i (g + z''_i), Eq. 22 with the sign corrected, plus the elements' pull.

    z'' contains the vertical acceleration a_v of the ground. In the simplified models, consistent with Eq. 23 for small
    rotations: m_tot a + L_0^r θ'' + Σ m* D'', and m_tot (g + a_v + s B θ'') plus the tensions of the elements. `states`
    as in `History`; `rates` contains D''_n and θ'' at each state, shape (n, N + 1).
    """
    if model.complete:
        return _reactions_at_large_rotations(model, states, rates)
    p, layout = model.properties, model.layout
    n = p.n_modes
    turns, push = rates[:, layout.turns], rates[:, :n] @ p.effective_mass
    horizontal = p.horizontal_mass * states[:, GROUND] + turns @ model.levers + push
    if layout.slip >= 0:
        horizontal += p.horizontal_mass * rates[:, n + 1]
    pulls = element_forces(model, states)
    for place, each in enumerate(p.elements):
        if each.height is not None:
            horizontal += each.cosine * pulls[:, place]
    if model.springs is not None:
        return Reactions(horizontal, spring_forces(model, states).sum(axis=1))
    under = [place for place, each in enumerate(model.elements) if each.position is not None]
    vertical = p.m_tot * (model.gravity + states[:, RISE]) + pulls[:, under].sum(axis=1)
    sides = np.column_stack((acting_side(states), model.sides_at(states)[:, 1:]))
    return Reactions(horizontal, vertical + model.lift_rates(sides, turns) @ model.weights)


def spring_forces(model: RockingModel, states: Array) -> Array:
    """Return the force of every spring under the base at the states of a history in N, upwards, (n, n_springs)."""
    if model.springs is None:
        return np.zeros((states.shape[0], 0))
    layout, side = model.layout, states[:, SIDE]
    moving = states[:, HEADER : HEADER + layout.moving]
    vector = model.stretched(np.column_stack((moving, states[:, GROUND], np.ones(side.size))))
    branches = model.branches_at(side, layout.of(states, layout.rotation), states)[:, 1 : model.springs.n + 1]
    found = np.where(branches == LOADED, vector @ model.spring_forces(model.start(CLOSED)).T, 0.0)
    if isinstance(model, SpringModel) and model.soft:
        found = np.where(branches == YIELDING, vector @ model.holds.T, found)
    return found


def printed_reactions(model: RockingModel, states: Array, rates: Array) -> Reactions:
    """Return Eqs. 21 and 22 as printed, with Σ m_i (-g + z''_i), for every model, plus tendon forces."""
    given = reactions if model.springs is not None else _reactions_at_large_rotations
    x, z = given(model, states, rates)
    return Reactions(x, z - 2.0 * model.properties.m_tot * GRAVITY)


def _reactions_at_large_rotations(model: RockingModel, states: Array, rates: Array) -> Reactions:
    numbers, moving = field_numbers(model, [HORIZONTAL, VERTICAL]), rates_at_states(model, states, rates)
    x, lost = observed(model, numbers, states, acting_side(states), moving, np.zeros((states.shape[0], 2))).T
    x = x + model.properties.leaning_mass * states[:, GROUND]
    if model.layout.slip >= 0 and not model.integrated:
        x = x + model.properties.horizontal_mass * rates[:, -1]
    return Reactions(x, model.properties.resting_reaction - lost)
