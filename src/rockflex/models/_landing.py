"""The jump at an impact for `rockflex.engine`: compiled for laws of the package, a function for a user's own."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from rockflex.engine.field import Field
from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite, checked_finite_vector
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.schema import SHORTEST_EXCURSION
from rockflex.foundation.shown import shown
from rockflex.models._elements import CLOSED
from rockflex.models._fields import Landing
from rockflex.models._impact import (
    ImpactLaw,
    LandingRule,
    Rebound,
    RuledLaw,
    takes_displacement,
)
from rockflex.models._phase import Key
from rockflex.models._rocking_model import RockingModel
from rockflex.structure._rocking import RockingProperties

GUARDED = "guarded impact"  # counts the impacts at which the guard of a law acts
GAIN = 1e-9  # relative gain of energy in an impact that is attributed to rounding


class GainsEnergyError(SolverError):
    """An impact law returns more energy than there was."""


def rule_of_law(law: ImpactLaw, side: int) -> LandingRule | None:
    """Return the rule of a law of the package for the landing that ends rocking on a side; None of a user's own."""
    if isinstance(law, RuledLaw) and type(law).after is RuledLaw.after:
        return law.rule_of(side)
    return None


def landing_of_rule(
    model: RockingModel,
    side: int,
    rule: LandingRule,
    beyond: Field,
    size: int,
    turnings: Sequence[tuple[int, float, float]] = (),
) -> Landing:
    """Return the compiled jump of a rule, with what `Landing` needs of θ'' beyond, of the states and of elements."""
    error, slip = partial(landing_gains_energy_error, model), model.layout.slip
    slip += slip >= 0
    return Landing(error, model.properties, side, model.complete, rule, beyond, size, slip, turnings)


def landing_gains_energy_error(model: RockingModel) -> GainsEnergyError:
    """Return the error of a model whose impact law returns energy."""
    return GainsEnergyError(f"The impact law {shown(model.law)} returns energy.")


def landing_jump(
    model: RockingModel,
    keys: Mapping[int, Key],
    inertia: Callable[[int, Array], float],
    turn: Callable[[int, Array, float, float], float],
) -> Callable[[Array, float, float], tuple[Array, Key]]:
    """Return the jump of a user's own law, from the states [D, D', θ, θ', ..] and both accelerations.

    Parameters
    ----------
    model
        The model, with its law.
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
    p, displaced, straight = model.properties, takes_displacement(model.law), np.zeros(model.properties.n_modes)
    N, height, mass = p.n_modes, p.effective_height, p.effective_mass
    modes, rotation, spin = slice(N, 2 * N), 2 * N, 2 * N + 1

    def kinetic_energy(state: Array, inertia: float) -> float:
        velocity = state[modes] + height * state[spin]
        return 0.5 * inertia * state[spin] ** 2 + 0.5 * float(mass @ velocity**2)

    def land(state: Array, acceleration: float, vertical: float) -> tuple[Array, Key]:
        before = kinetic_energy(state, inertia(-1 if state[spin] > 0.0 else 1, state))
        leaning = (state[:N] if model.complete else straight,) if displaced else ()
        velocity, passed = velocities_after(model.law, p, state[modes], float(state[spin]), *leaning)
        after, onto = state.copy(), int(np.sign(passed))
        after[modes], after[rotation], after[spin] = velocity, 0.0, passed
        gained = kinetic_energy(after, inertia(onto, after) if onto != CLOSED else 0.0) - before
        if onto != CLOSED:
            back = -onto * turn(onto, after, acceleration, vertical)
            if 2.0 * abs(passed) < back * SHORTEST_EXCURSION:
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


def fixed_share(model: RockingModel, side: int) -> tuple[float | None, float]:
    """Return θ'_a/θ'_b if each landing on a side has the same, and the shortest excursion in s.

    It is negative where the base turns back, and None where a landing depends on the state.
    """
    if isinstance(model.law, Rebound):
        return -model.law.e, model.law.shortest_excursion
    rule = rule_of_law(model.law, side)
    if rule is None:
        return None, SHORTEST_EXCURSION
    return rule.fixed_share(model.properties, side), rule.shortest_excursion


def velocities_after(
    law: Any, properties: RockingProperties, velocity: Array, spin: float, *displacement: Array
) -> tuple[Array, float]:
    """Return the velocities after an impact that a law gives, checked; raises `InputError` if it fails."""
    try:
        found, turn = _pair(law.after(properties, velocity.copy(), spin, *(each.copy() for each in displacement)))
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
