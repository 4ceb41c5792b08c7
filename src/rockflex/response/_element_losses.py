"""The energy that the elements between the base and the ground dissipate."""

import numpy as np

from rockflex._arrays import Array
from rockflex.models import (
    Bar,
    Dashpot,
    RockingModel,
    Slider,
    element_energies,
    elongations,
    plastic_stretches,
)


def element_losses(model: RockingModel, states: Array, sweeps: Array) -> Array:
    """Return the energy that each element dissipates between adjacent states, in J, shape (n_states - 1, E).

    A bar loses (1 - α) F_y for every metre that it yields, and whatever it stores when it breaks; a viscous damper
    loses c ∫ δ'² dt, with the integrals `sweeps`, shape (n_states - 1, E); a friction damper loses F_0 for every
    metre that it slides. Between adjacent states an element yields or slides in one direction only.
    """
    found = np.zeros((states.shape[0] - 1, len(model.elements)))
    if not model.elements:
        return found
    moved = np.abs(np.diff(elongations(model, states), axis=0))
    plastic, stored = plastic_stretches(model, states), element_energies(model, states)
    broken = np.isnan(plastic)
    breaks = broken[1:] & ~broken[:-1]
    yielded = np.where(broken[1:], 0.0, np.abs(np.diff(plastic, axis=0)))
    for place, each in enumerate(model.elements):
        if isinstance(each, Bar):
            found[:, place] = (1.0 - each.ratio) * each.yield_force * yielded[:, place]
            released = stored[:-1, place] - stored[1:, place]
            found[breaks[:, place], place] = released[breaks[:, place]]
        elif isinstance(each, Dashpot):
            found[:, place] = each.coefficient * sweeps[:, place]
        elif isinstance(each, Slider):
            found[:, place] = each.force * moved[:, place]
    return found
