"""The jump at an impact whose law is not linear, or a user's own: a function of the state, for `rockflex.engine`."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from rockflex._arrays import Array
from rockflex._checks import finite, finite_vector
from rockflex._errors import InputError, SolverError
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.models._elements import CLOSED, LEFT, RIGHT
from rockflex.models._impact import ImpactLaw, Restitution, SidedRestitution
from rockflex.models._modal_model import ModalModel
from rockflex.models._phase import Key

GAIN = 1e-9  # relative gain of energy in an impact that is attributed to rounding
WITHOUT = Restitution(0.0)  # of a law that says nothing of the shortest excursion


class GainsEnergyError(SolverError):
    """An impact law returns more energy than there was."""


def landing_of(
    model: ModalModel, keys: Mapping[int, Key], turns: Mapping[int, tuple[Array, Array]]
) -> Callable[[Array, float, float], tuple[Array, Key]]:
    """Return the jump at an impact, from the states [D, D', θ, θ', ..] and both accelerations.

    Parameters
    ----------
    model
        The model, with its law.
    keys
        The phases that may follow, by side.
    turns
        θ'' in those of a base that rocks: a row over the states, the acceleration and 1, and what each m/s² of vertical
        acceleration adds to it.

    Returns
    -------
    callable
        It raises `GainsEnergyError` if the law returns energy, and `InputError` if the law fails.
    """
    p = model.properties
    N, height, mass = p.n_modes, p.effective_height, p.effective_mass
    modes, rotation, spin = slice(N, 2 * N), 2 * N, 2 * N + 1

    def energy(state: Array, inertia: float) -> float:
        velocity = state[modes] + height * state[spin]
        return 0.5 * inertia * state[spin] ** 2 + 0.5 * float(mass @ velocity**2)

    def land(state: Array, acceleration: float, vertical: float) -> tuple[Array, Key]:
        before = energy(state, model.free_inertia(RIGHT if state[spin] < 0.0 else LEFT))
        law = sided(model.law, state[spin])
        velocity, passed = velocities_after(model.law, p, state[modes], float(state[spin]))
        after, side = state.copy(), int(np.sign(passed))
        after[modes], after[rotation], after[spin] = velocity, 0.0, passed
        gained = energy(after, model.free_inertia(side) if side != CLOSED else 0.0) - before
        if side != CLOSED:
            shortest = law.shortest_excursion if isinstance(law, Restitution) else WITHOUT.shortest_excursion
            row = turns[side][0] + vertical * turns[side][1]
            back = -side * float(row[:-2] @ after + row[-2] * acceleration + row[-1])
            if 2.0 * abs(passed) < back * shortest:
                after[modes] += height * passed
                after[spin], side = 0.0, CLOSED
        if gained > GAIN * before:
            raise GainsEnergyError(f"The impact law {shown(model.law)} returns energy.")
        return after, keys[side]

    return land


def sided(law: ImpactLaw, spin: float) -> ImpactLaw:
    """Return the law of the edge about which the base rotated before an impact, by the sign of θ'."""
    if isinstance(law, SidedRestitution):
        return law.right if spin < 0.0 else law.left
    return law


def velocities_after(
    law: ImpactLaw, properties: RockingProperties, velocity: Array, spin: float
) -> tuple[Array, float]:
    """Return the velocities after an impact that a law gives, checked; raises `InputError` if it fails."""
    try:
        found, turn = _pair(law.after(properties, velocity.copy(), spin))
        checked = finite_vector("the modal velocity after an impact", found, "m/s")
        if checked.size != velocity.size:
            raise InputError(
                f"The modal velocity after an impact must have {velocity.size} values, but {checked.size} were "
                "returned."
            )
        return checked, finite("the rotation velocity after an impact", turn, "rad/s")
    except Exception as error:
        raise InputError(f"The impact law {shown(law)} failed: {error}") from error


def _pair(returned: Any) -> tuple[Any, Any]:
    """Return the two things that a law returned."""
    try:
        velocity, spin = returned
    except (TypeError, ValueError):
        raise InputError(
            "after must return the modal velocities in m/s and the rotation velocity in rad/s, but it returned "
            f"{shown(returned)}."
        ) from None
    return velocity, spin
