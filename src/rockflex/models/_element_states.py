"""The elements at the states of a history: tensions, plastic stretches and energies."""

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array
from rockflex.models._elements import friction_damper_shares, is_held_by_dampers
from rockflex.models._rocking_model import RockingModel
from rockflex.models._values_at_states import acting_side, held_moment, states_by_phase


def element_forces(model: RockingModel, states: Array) -> Array:
    """Return the tension of every element at the states of a history in N, shape (n, E)."""
    found = np.zeros((states.shape[0], len(model.elements)))
    if not model.elements:
        return found
    for chosen, key, given in states_by_phase(model, states, acting_side(states)):
        found[chosen] = model.stretched(given) @ model.tensions(key).T
        if (
            model.complete
            and model.springs is None
            and is_held_by_dampers(model.properties, model.elements, model.element_key(key))
        ):
            shares = friction_damper_shares(model.properties, model.elements, key[0])
            found[chosen] += np.outer(held_moment(model, states[chosen]), shares)
    for place, each in enumerate(model.elements):
        if each.friction:  # where it turns back without a stop, it would take more than F_0 to hold the base
            np.clip(found[:, place], -each.friction, each.friction, out=found[:, place])
    return found


def plastic_stretches(model: RockingModel, states: Array) -> Array:
    """Return the plastic stretch of every element at the states of a history in m, shape (n, E).

    Unlike the internal variables, which are constant during a phase, it follows the elongation of an element that
    yields. It is NaN once an element is broken, and zero for elements that have none.
    """
    layout, delta = model.layout, model.elongations_at(states)
    found = np.zeros(delta.shape)
    if not layout.n_internal:
        return found
    for chosen, key, vector in states_by_phase(model, states, acting_side(states)):
        memory = layout.memory
        for place, (each, branch) in enumerate(zip(model.elements, model.element_key(key)[1:], strict=True)):
            if each.stretches is not None:
                offset = each.reversal_offset(branch)
                kept = np.nan if each.broken(branch) else vector[:, memory]
                found[chosen, place] = kept if offset is None else delta[chosen, place] - offset
            memory += each.n_internal
    return found


def element_states(model: RockingModel, states: Array) -> NDArray[np.int8]:
    """Return the state of every element at the states of a history, shape (n, E).

    1 as it yields or slides, 2 if it is broken, otherwise 0. Stories that yield follow the elements.
    """
    found = np.zeros((states.shape[0], len(model.elements)), np.int8)
    if not model.elements:
        return found
    for chosen, key, _ in states_by_phase(model, states, acting_side(states)):
        for place, (each, branch) in enumerate(zip(model.elements, model.element_key(key)[1:], strict=True)):
            found[chosen, place] = 2 if each.broken(branch) else each.direction(branch) != 0
    return found


def element_energies(model: RockingModel, states: Array, sweeps: Array) -> tuple[Array, Array]:
    """Return the energy that elements store at the states of a history, and that they lose in between, in J.

    Parameters
    ----------
    model, states
        The model, and the states of a history, (n, columns).
    sweeps : ndarray, shape (n - 1, E)
        ∫ δ'² dt of each element between adjacent states in m²/s.

    Returns
    -------
    stored : ndarray, shape (n, E)
    lost : ndarray, shape (n - 1, E)
        Between adjacent states an element yields or slides in one direction only.
    """
    stored, lost = np.zeros((len(states), len(model.elements))), np.zeros((len(states) - 1, len(model.elements)))
    if not model.elements:
        return stored, lost
    parts = model.elongations_at(states), element_forces(model, states), plastic_stretches(model, states)
    for place, each in enumerate(model.elements):
        delta, force, plastic = (values[:, place] for values in parts)
        stored[:, place] = each.stored_energy(delta, force, plastic)
        lost[:, place] = each.lost_energy(delta, force, plastic, stored[:, place], sweeps[:, place])
    return stored, lost
