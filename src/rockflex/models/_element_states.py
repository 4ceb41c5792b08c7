"""The elements between the base and the ground at the states of a history: elongations, tensions, stored energies."""

import numpy as np

from rockflex._arrays import Array
from rockflex.models._element import BROKEN, Bar, Element, Slider, Spring
from rockflex.models._kept import acting_side, by_phase
from rockflex.models._label import RockingModel


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
        found[chosen] = vector @ model.tensions(key).T
    for place, each in enumerate(model.elements):
        if isinstance(each, Slider):  # where it turns back without a stop, it would take more than F_0 to hold the base
            np.clip(found[:, place], -each.force, each.force, out=found[:, place])
    return found


def plastic_stretches(model: RockingModel, states: Array) -> Array:
    """Return the plastic stretch of every element at the states of a history in m, shape (n, E).

    Unlike the memories, which are constant during a phase, it follows the elongation of an element that yields. It is
    NaN once an element is broken, and zero for elements that have none.
    """
    layout, delta = model.layout, model.elongations_at(states)
    found = np.zeros(delta.shape)
    if not layout.remembered:
        return found
    for chosen, key, vector in by_phase(model, states, acting_side(states)):
        memory = layout.memory
        for place, (each, branch) in enumerate(zip(model.elements, model.element_key(key)[1:], strict=True)):
            if isinstance(each, Bar):
                offset = each.turning(branch)
                kept = np.nan if branch == BROKEN else vector[:, memory]
                found[chosen, place] = kept if offset is None else delta[chosen, place] - offset
            memory += each.remembers
    return found


def element_energies(model: RockingModel, states: Array) -> Array:
    """Return the energy stored in every element at the states of a history in J, (n, E): see `stored_energy`."""
    delta, forces = model.elongations_at(states), element_forces(model, states)
    plastic = plastic_stretches(model, states)
    found = [
        stored_energy(each, delta[:, place], forces[:, place], plastic[:, place])
        for place, each in enumerate(model.elements)
    ]
    return np.stack(found, axis=1) if found else np.zeros(delta.shape)


def stored_energy(element: Element, elongation: Array, force: Array, plastic: Array) -> Array:
    """Return the energy stored in an element, relative to the base in contact before it yields, in J.

    A bar with the plastic stretch m stores F²/2k + α (1 - α) k m²/2: two springs in parallel, of which one slides. The
    second term stays locked in while the bar is slack. A broken bar, whose m is NaN, stores nothing.
    """
    if isinstance(element, Spring):
        slack = -element.initial_force / element.stiffness if element.stiffness > 0.0 else -np.inf
        taut = np.maximum(elongation, slack)
        return (element.initial_force + 0.5 * element.stiffness * taut) * taut
    if not isinstance(element, Bar):
        return np.zeros(elongation.shape)
    k, first = element.stiffness, element.stiffness * element.stretched
    locked = 0.5 * element.ratio * (1.0 - element.ratio) * k * plastic**2
    stored = (force - first) * (force + first) / (2.0 * k) + locked
    return np.where(np.isnan(plastic), -(first**2) / (2.0 * k), stored)
