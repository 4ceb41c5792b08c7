"""The elements between the base and the ground at the states of a history: elongations, tensions, stored energies."""

import numpy as np

from rockflex._arrays import Array
from rockflex.models._bar import Bar
from rockflex.models._element import BROKEN, DOWN, UP, Spring
from rockflex.models._elements import LEFT, RIGHT, arm_of
from rockflex.models._kept import acting_side, by_phase
from rockflex.models._label import RockingModel
from rockflex.models._quantities import tensions
from rockflex.models._slider import Slider


def stretch_per_arm(model: RockingModel, turn: Array) -> Array:
    """Return the elongation of an element per unit distance from the pivot at |θ| in rad: 2 sin(|θ|/2), or |θ|."""
    return 2.0 * np.sin(0.5 * turn) if model.complete else turn


def arms(model: RockingModel, side: Array) -> Array:
    """Return the distance of every element from the pivot of a side, or of a sign of θ, in m, shape (n, E)."""
    right, left = (
        np.array([arm_of(model.properties, each, which) for each in model.elements]) for which in (RIGHT, LEFT)
    )
    return np.where(side[:, None] < 0.0, left, right)


def elongations(model: RockingModel, states: Array) -> Array:
    """Return δ = r |θ|, in complete models 2 r sin(|θ|/2), of every element at the states of a history, (n, E) in m."""
    rotation = model.layout.of(states, model.layout.rotation)
    return arms(model, rotation) * stretch_per_arm(model, np.abs(rotation))[:, None]


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
        for place, (each, branch) in enumerate(zip(model.elements, key[1:], strict=True)):
            if isinstance(each, Bar):
                reach, e = each.yield_force / each.stiffness, delta[chosen, place] + each.stretched
                if branch in (UP, DOWN):
                    found[chosen, place] = e - reach if branch == UP else e + reach
                else:
                    found[chosen, place] = np.nan if branch == BROKEN else vector[:, memory]
            memory += each.remembers
    return found


def element_energies(model: RockingModel, states: Array) -> Array:
    """Return the energy stored in every element, relative to the base in contact before it yields, in J, (n, E).

    A bar with the plastic stretch m stores F²/2k + α (1 - α) k m²/2: two springs in parallel, of which one slides. The
    second term stays locked in while the bar is slack. A broken bar stores nothing.
    """
    delta, forces = elongations(model, states), element_forces(model, states)
    plastic = plastic_stretches(model, states)
    found = np.zeros(delta.shape)
    for place, each in enumerate(model.elements):
        if isinstance(each, Spring):
            found[:, place] = (each.initial_force + 0.5 * each.stiffness * delta[:, place]) * delta[:, place]
        elif isinstance(each, Bar):
            k, first = each.stiffness, each.stiffness * each.stretched
            locked = 0.5 * each.ratio * (1.0 - each.ratio) * k * plastic[:, place] ** 2
            stored = (forces[:, place] - first) * (forces[:, place] + first) / (2.0 * k) + locked
            found[:, place] = np.where(np.isnan(plastic[:, place]), -(first**2) / (2.0 * k), stored)
    return found
