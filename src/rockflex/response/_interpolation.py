"""The motion between the states of a history, and beyond its end."""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite_vector, checked_positive
from rockflex.foundation.errors import InputError, MissingQuantityError
from rockflex.foundation.shown import shown
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._motion_between_states import MotionBetween
from rockflex.models._prepared_model import PreparedModel
from rockflex.models._quantities import Quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME, StateLayout
from rockflex.models._values_at_states import accelerations_at_states

Motion = tuple[Array, Array, Array]


def quintic(value: Array, slope: Array, bend: Array, step: Array, place: float) -> Motion:
    """Return value, slope and second derivative between adjacent rows, from those of the rows, (n, K) each."""
    return quintic_between((value[:-1], slope[:-1], bend[:-1]), (value[1:], slope[1:], bend[1:]), step, place)


def quintic_between(before: Motion, after: Motion, step: Array, place: float | Array) -> Motion:
    """Return value, slope and second derivative between two states, from those of both, (n, K) each.

    `step` (n,) is the time between them, and `place` the part of it that has next_branch, for all or of shape (n, 1).
    """
    h = step[:, None]
    safe = np.where(h > 0.0, h, 1.0)
    (value, slope, bend), (next_value, next_slope, next_bend) = before, after
    start, end = slope * h, next_slope * h
    first, last = bend * h**2, next_bend * h**2
    rise = next_value - value - start - 0.5 * first
    tilt = end - start - first
    curl = last - first
    c3, c4, c5 = 10 * rise - 4 * tilt + 0.5 * curl, -15 * rise + 7 * tilt - curl, 6 * rise - 3 * tilt + 0.5 * curl
    f = place
    return (
        value + f * (start + f * (0.5 * first + f * (c3 + f * (c4 + f * c5)))),
        (start + f * (first + f * (3 * c3 + f * (4 * c4 + f * 5 * c5)))) / safe,
        (first + f * (6 * c3 + f * (12 * c4 + f * 20 * c5))) / safe**2,
    )


MAX_INSTANTS = 10_000_000  # instants
STEPS_PER_INTERVAL = 16  # of an interval in which z is integrated


def only_of_run() -> Any:
    """Return a quantity that states at other instants than those of the run cannot tell."""
    return OnlyOfRun()


class OnlyOfRun:
    """A quantity of the continuous motion, which states at other instants than those of the run cannot tell."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name
        self.__doc__ = f"Not available: ask the history of the run for `{name}`."

    def __get__(self, history: object, owner: type) -> object:
        if history is None:
            return self
        raise MissingQuantityError(
            f"A sampled history has no {self.name}, since it lacks the events between its instants. Take it from the "
            "history of the run, before `at` or `resample`."
        )


def instants(times: ArrayLike, known: Array) -> Array:
    """Return instants in s within a history, from one or many.

    Raises
    ------
    InputError
        If there is none, or one is not finite or outside the history.
    """
    given = np.atleast_1d(np.asarray(times)) if np.isscalar(times) else times
    wanted = checked_finite_vector("times", given, "s")
    outside = np.flatnonzero((wanted < known[0]) | (wanted > known[-1]))
    if outside.size or not wanted.size:
        what = f"times[{outside[0]}] = {wanted[outside[0]]:g} s" if outside.size else "no time"
        raise InputError(
            f"times must lie within the history, from {known[0]:g} to {known[-1]:g} s, but {what} was given. Simulate "
            "with a longer free_vibration, or leave out what is beyond the end.",
            field="times",
        )
    return wanted


def even_instants(dt: float, known: Array) -> Array:
    """Return instants at equal steps from the first state to the last one, which ends a shorter step.

    Raises
    ------
    InputError
        If `dt` is not a positive number, or gives more than 10 million instants.
    """
    step, begin, end = checked_positive("dt", dt, "s"), float(known[0]), float(known[-1])
    if (end - begin) / step > MAX_INSTANTS:
        raise InputError(
            f"dt = {shown(dt)} s gives {(end - begin) / step:.3g} instants over {end - begin:g} s, above the limit of "
            f"{MAX_INSTANTS}. Give a dt of at least {(end - begin) / MAX_INSTANTS:.3g} s.",
            field="dt",
        )
    steps = round((end - begin) / step)
    if abs(steps * step - (end - begin)) > 1e-9 * step * max(steps, 1):
        steps = int((end - begin) / step)
        return np.append(begin + step * np.arange(steps + 1), end)
    return np.append(begin + step * np.arange(steps), end)


def interpolated_states(model: RockingModel, states: Array, times: Array) -> Array:
    """Return the states of a history at instants within it, shape (m, n_columns); at an event those after it.

    Linear phases are exact. In others the motion is a polynomial of fifth degree through position, velocity and
    acceleration of both states, the hysteretic variable z is integrated along it, and the energies are linear.
    """
    place = np.searchsorted(states[:, TIME], times, side="right") - 1
    found = states[place]
    between = np.flatnonzero(found[:, TIME] < times)
    if not between.size:
        return found
    which = place[between]
    before, after = states[which], states[which + 1]
    span, elapsed = after[:, TIME] - before[:, TIME], times[between] - before[:, TIME]
    part = elapsed / span
    inside = before.copy()
    inside[:, TIME] = times[between]
    for column in (GROUND, RISE):
        inside[:, column] += part * (after[:, column] - before[:, column])
    if not model.integrated:
        inside[:, HEADER:] = MotionBetween(model).intervals(states).after(which, elapsed)
    else:
        _curve(model, states, which, part, inside)
        chosen, core = ~model.integrates(before[:, SIDE]), HEADER + model.layout.core
        if chosen.any():
            moved = MotionBetween(model).intervals(states).after(which[chosen], elapsed[chosen])
            inside[chosen, HEADER:core] = moved[:, : model.layout.core]
    found[between] = inside
    return found


def interpolated_columns(layout: StateLayout) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the columns of a history with D_n, θ, the slip and the heave, and those with their velocities."""
    n, base = layout.modes, layout.rotation + 2 * np.arange(layout.freedoms)
    places = np.concatenate((np.arange(n), base))
    return HEADER + places, HEADER + places + np.where(places < n, n, 1)


def _curve(model: RockingModel, states: Array, which: NDArray[np.intp], part: Array, inside: Array) -> None:
    """Fill in the motion at a part of some intervals by polynomials between the states at their ends."""
    layout = model.layout
    where, speeds = interpolated_columns(layout)
    rates, step = accelerations_at_states(model, states), np.diff(states[:, TIME])[which]
    first, last = ((states[ends][:, where], states[ends][:, speeds], rates[ends]) for ends in (which, which + 1))
    inside[:, where], inside[:, speeds], _ = quintic_between(first, last, step, part[:, None])
    energies = slice(HEADER + layout.core, HEADER + layout.memory)
    before, after = states[which], states[which + 1]
    inside[:, energies] += part[:, None] * (after[:, energies] - before[:, energies])
    if model.bouc_wen is not None:
        z = HEADER + layout.hysteresis
        inside[:, z] = _hysteresis(model.bouc_wen, before[:, z], first, last, step, part)


def _hysteresis(law: BoucWen, z: Array, first: Motion, last: Motion, step: Array, part: Array) -> Array:
    """Return z (Eq. 38) at a part of some intervals, from z at their starts and the motion, D_1 first, at both ends.

    The rate of z is integrated by the classical method of Runge and Kutta, with the velocity of the polynomial.
    """

    def velocity(place: Array) -> Array:
        return quintic_between(first, last, step, place[:, None])[1][:, 0]

    def rate(v: Array, z: Array) -> Array:
        lean = law.beta + law.gamma * np.where((z >= 0.0) == (v >= 0.0), 1.0, -1.0)
        return v / law.yield_displacement * (1.0 - lean * np.abs(z) ** law.exponent)

    h, v = part * step / STEPS_PER_INTERVAL, velocity(np.zeros_like(part))
    for k in range(STEPS_PER_INTERVAL):
        middle, end = (velocity(part * (k + more) / STEPS_PER_INTERVAL) for more in (0.5, 1.0))
        k1 = rate(v, z)
        k2 = rate(middle, z + 0.5 * h * k1)
        k3 = rate(middle, z + 0.5 * h * k2)
        k4 = rate(end, z + h * k3)
        z, v = z + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4), end
    return z


def settled_rotation(model: RockingModel, states: Array, work_limit: float | None) -> float:
    """Continue a run from its last state until it settles; see `History.settled_rotation`."""
    layout, last = model.layout, states[-1:]
    if model.bouc_wen is not None:
        raise InputError(f"The hysteretic spring of {model.label} never comes to rest, so no rotation remains.")
    if abs(layout.of(last, layout.rotation)[0]) >= 0.5 * math.pi:
        return math.nan
    (key,) = model.branches_at(last[:, SIDE], layout.of(last, layout.rotation), last).astype(np.int64).tolist()
    step = float(np.median(np.diff(np.unique(states[:, 0])))) if states.shape[0] > 1 else 0.01
    found = PreparedModel(model, Quantities.none(layout.modes)).run(
        np.zeros(2), step, free_vibration=None, state=(tuple(key), last[0, HEADER:].copy()), work_limit=work_limit
    )
    return math.nan if found.overturned else float(found.final_state[layout.rotation]) - model.rest.rotation
