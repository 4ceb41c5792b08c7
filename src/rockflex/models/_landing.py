"""The jump at an impact whose law is not linear, or a user's own: a function of the state, for `rockflex.engine`."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite, checked_finite_vector
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import shown
from rockflex.models._elements import CLOSED, RIGHT
from rockflex.models._impact import ImpactLaw, Rebound, Restitution, SidedRestitution, VVELSimplified
from rockflex.models._phase import Key
from rockflex.models._rocking_model import RockingModel
from rockflex.structure._rocking import RockingProperties

GAIN = 1e-9  # relative gain of energy in an impact that is attributed to rounding


class GainsEnergyError(SolverError):
    """An impact law returns more energy than there was."""


def landing_gains_energy_error(model: RockingModel) -> GainsEnergyError:
    """Return the error of a model whose impact law returns energy."""
    return GainsEnergyError(f"The impact law {shown(model.law)} returns energy.")


def landing_jump(
    model: RockingModel,
    side: int,
    keys: Mapping[int, Key],
    inertia: Callable[[int, Array], float],
    turn: Callable[[int, Array, float, float], float],
) -> Callable[[Array, float, float], tuple[Array, Key]]:
    """Return the jump at an impact, from the states [D, D', θ, θ', ..] and both accelerations.

    Parameters
    ----------
    model
        The model, with its law.
    side
        The side to which the base was rotated.
    keys
        The phases that may follow, by side.
    inertia
        The inertia of the rotation with free modes about the pivot of a side, in a state.
    turn
        θ'' about the pivot of a side, in a state and under both accelerations.

    Returns
    -------
    callable
        It raises `GainsEnergyError` if the law returns energy, and `InputError` if the law fails.
    """
    p, shortest = model.properties, shortest_excursion(impact_law_of_side(model.law, side))
    N, height, mass = p.n_modes, p.effective_height, p.effective_mass
    modes, rotation, spin = slice(N, 2 * N), 2 * N, 2 * N + 1

    def energy(state: Array, inertia: float) -> float:
        velocity = state[modes] + height * state[spin]
        return 0.5 * inertia * state[spin] ** 2 + 0.5 * float(mass @ velocity**2)

    def land(state: Array, acceleration: float, vertical: float) -> tuple[Array, Key]:
        before = energy(state, inertia(side, state))
        velocity, passed = velocities_after(model.law, p, state[modes], float(state[spin]))
        after, onto = state.copy(), int(np.sign(passed))
        after[modes], after[rotation], after[spin] = velocity, 0.0, passed
        gained = energy(after, inertia(onto, after) if onto != CLOSED else 0.0) - before
        if onto != CLOSED:
            back = -onto * turn(onto, after, acceleration, vertical)
            if 2.0 * abs(passed) < back * shortest:
                after[modes] += height * passed
                after[spin], onto = 0.0, CLOSED
        if gained > GAIN * before:
            raise landing_gains_energy_error(model)
        return after, keys[onto]

    return land


def rotation_acceleration_by_rows(
    rows: Mapping[int, tuple[Array, Array]],
) -> Callable[[int, Array, float, float], float]:
    """Return θ'' as `landing_jump` needs it, from a row of each side over the states, the acceleration and 1.

    The second row of a side is what each m/s² of vertical acceleration adds to the first.
    """

    def turn(side: int, state: Array, acceleration: float, vertical: float) -> float:
        row = rows[side][0] + vertical * rows[side][1]
        return float(row[:-2] @ state + row[-2] * acceleration + row[-1])

    return turn


def impact_law_of_side(law: ImpactLaw, side: int) -> ImpactLaw:
    """Return the law of the edge about which the base rotates on a side."""
    if isinstance(law, SidedRestitution):
        return law.right if side == RIGHT else law.left
    return law


def shortest_excursion(law: ImpactLaw) -> float:
    """Return the duration in s below which an excursion after an impact does not count."""
    return law.shortest_excursion if isinstance(law, Restitution | Rebound) else Restitution(0.0).shortest_excursion


def share_passed(law: ImpactLaw) -> float | None:
    """Return the share of the rotation's velocity that goes on, negative if it turns back; None if a law says more."""
    if isinstance(law, VVELSimplified):
        return 0.0
    return law.e if isinstance(law, Restitution) else -law.e if isinstance(law, Rebound) else None


def velocities_after(
    law: ImpactLaw, properties: RockingProperties, velocity: Array, spin: float
) -> tuple[Array, float]:
    """Return the velocities after an impact that a law gives, checked; raises `InputError` if it fails."""
    try:
        found, turn = _pair(law.after(properties, velocity.copy(), spin))
        checked = checked_finite_vector("the modal velocity after an impact", found, "m/s")
        if checked.size != velocity.size:
            raise InputError(
                f"The modal velocity after an impact must have {velocity.size} values, but {checked.size} were "
                "returned."
            )
        return checked, checked_finite("the rotation velocity after an impact", turn, "rad/s")
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
