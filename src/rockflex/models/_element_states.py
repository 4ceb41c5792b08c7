"""The elements between the base and the ground at the states of a history: elongations, tensions, stored energies."""

import numpy as np

from rockflex._arrays import Array
from rockflex.models._element import Slider
from rockflex.models._elements import LEFT, RIGHT, arm_of
from rockflex.models._kept import acting_side, by_phase
from rockflex.models._label import RockingModel
from rockflex.models._quantities import tensions
from rockflex.models._spring_model import SpringModel


def arms(model: RockingModel, side: Array) -> Array:
    """Return the distance of every element from the pivot of a side, or of a sign of θ, in m, shape (n, E)."""
    right, left = (
        np.array([arm_of(model.properties, each, which) for each in model.elements]) for which in (RIGHT, LEFT)
    )
    return np.where(side[:, None] < 0.0, left, right)


def elongations(model: RockingModel, states: Array) -> Array:
    """Return δ of every element at the states of a history in m, (n, E): r |θ|, in complete models 2 r sin(|θ|/2).

    On springs it is how far the base has risen there since it was at rest.
    """
    rotation = model.layout.of(states, model.layout.rotation)
    if isinstance(model, SpringModel):
        heave = model.layout.of(states, model.layout.heave)
        moved = [(heave - model.rest[1]) - each.position * (rotation - model.rest[0]) for each in model.elements]
        return np.stack(moved, axis=1) if moved else np.zeros((rotation.size, 0))
    return arms(model, rotation) * model.stretch_per_arm(np.abs(rotation))[:, None]


def element_forces(model: RockingModel, states: Array) -> Array:
    """Return the tension of every element at the states of a history in N, shape (n, E)."""
    layout = model.layout
    found = np.zeros((states.shape[0], len(model.elements)))
    if not model.elements:
        return found
    for chosen, key, given in by_phase(model, states, acting_side(states)):
        vector = given
        if model.complete:
            half = 0.5 * given[:, layout.rotation]
            vector = given.copy()
            vector[:, layout.rotation] = 2.0 * np.sin(half)
            vector[:, layout.spin] *= np.cos(half)
        found[chosen] = vector @ tensions(model, key).T
    for place, each in enumerate(model.elements):
        if isinstance(each, Slider):  # where it turns back without a stop, it would take more than F_0 to hold the base
            np.clip(found[:, place], -each.force, each.force, out=found[:, place])
    return found


def plastic_stretches(model: RockingModel, states: Array) -> Array:
    """Return the plastic stretch of every element at the states of a history in m, shape (n, E).

    Unlike the memories, which are constant during a phase, it follows the elongation of an element that yields. It is
    NaN once an element is broken, and zero for elements that have none.
    """
    layout, delta = model.layout, elongations(model, states)
    found = np.zeros(delta.shape)
    if not layout.remembered:
        return found
    for chosen, key, vector in by_phase(model, states, acting_side(states)):
        memory = layout.memory
        for place, (each, branch) in enumerate(zip(model.elements, model.element_key(key)[1:], strict=True)):
            if each.stretches is not None:
                offset = each.turning(branch)
                kept = np.nan if each.broken(branch) else vector[:, memory]
                found[chosen, place] = kept if offset is None else delta[chosen, place] - offset
            memory += each.memories
    return found


def element_energies(model: RockingModel, states: Array) -> Array:
    """Return the energy stored in every element at the states of a history in J, shape (n, E)."""
    delta, forces = elongations(model, states), element_forces(model, states)
    plastic = plastic_stretches(model, states)
    found = [
        each.stored_energy(delta[:, place], forces[:, place], plastic[:, place])
        for place, each in enumerate(model.elements)
    ]
    return np.stack(found, axis=1) if found else np.zeros(delta.shape)
