"""The vector field of the nonlinear models (Silva & Stojadinović 2024, Eqs. 13-15, 23 and 37-38).

The motion is ``[D_1..D_N, D'_1..D'_N, θ, θ', z, E_damped, E_input, E_hysteretic]``. The last three are the damped
energy, the work of the ground and the energy absorbed by the hysteretic spring; integrating them with the motion gives
them the same accuracy. With viscous dampers ∫ (δ'/r)² dt follows, which times c r² is the energy that one dissipates.
Memories of elements come last; they are constant.
"""

import math
from typing import NamedTuple

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex.models._pulls import DAMPING, HOLD, MOMENT, STIFFNESS
from rockflex.models._sines import sine_and_cosine

EXTRA = 4  # components in addition to those of the simplified models

# Indices in `Field.modes`, and for each pivot in `Field.pivots`: its distance B from the axis of the masses, I_θ about
# it, and the sums over the elements of `pulls_of`, with their memories, from the index `PULLS` on.
OMEGA2, DRAG, HEIGHT, MASS = 0, 1, 2, 3
ARM, INERTIA, PULLS = 0, 1, 2
PULLED, STIFFENED, DAMPED, HELD = PULLS + MOMENT, PULLS + STIFFNESS, PULLS + DAMPING, PULLS + HOLD


class Field(NamedTuple):
    """Coefficients of one nonlinear model, N modes."""

    complete: bool  # Eqs. 13 and 14; otherwise Eq. 23
    hysteretic: bool
    viscous: bool  # with dampers at the base
    ledger: bool  # whether the rates of the energies, and of what the dampers sweep, are computed
    modes: Array  # (4, N): ω², 2ζω, h* and m*
    pivots: Array  # (2, 9), for the right and the left pivot: see the indices above; elements change their sums
    weight_arm: float  # L_0^r
    total_mass: float
    gravity: float  # g
    yield_displacement: float
    post_yield_ratio: float
    gamma: float
    beta: float
    exponent: float
    whole: int  # the exponent if it is a whole number, for a fast power; otherwise 0


@kernel
def pivot_at(side: float) -> int:
    """Return the index of the pivot of a side in `Field.pivots`."""
    return 1 if side < 0.0 else 0


@kernel
def take_pulls(pivots: Array, side: float, pulls: Array) -> None:
    """Set the sums over the elements about the pivot of a side, in `Field.pivots`."""
    for k in range(pulls.size):
        pivots[pivot_at(side), PULLS + k] = pulls[k]


@kernel
def inertia_left(field: Field, side: float, motion: Array) -> float:
    """Return the factor of θ'' after eliminating D'': I_θ - Σ m* h*², in complete models plus the terms of D."""
    n = field.modes.shape[1]
    pivot = pivot_at(side)
    inertia = field.pivots[pivot, INERTIA]
    for i in range(n):
        inertia -= field.modes[MASS, i] * field.modes[HEIGHT, i] * field.modes[HEIGHT, i]
        if field.complete:
            inertia += field.modes[MASS, i] * motion[i] * (motion[i] - 2.0 * side * field.pivots[pivot, ARM])
    return inertia


@kernel
def field_rates(
    field: Field, side: float, branch: float, acceleration: float, rise: float, motion: Array, rates: Array
) -> None:
    """Compute the rates of the motion on one side (0: in contact) for a ground acceleration, horizontal and upwards.

    The latter, `rise`, acts like more gravity. `branch` is the sign of D'_1 used in the hysteresis law, which is
    therefore smooth up to the reversal.
    """
    stage_rates(field, side, branch, acceleration, rise, motion, rates)


@inlined_kernel
def stage_rates(
    field: Field, side: float, branch: float, acceleration: float, rise: float, motion: Array, rates: Array
) -> None:
    """Compute the same as `field_rates`, as a part of the loop over the stages of a step."""
    if side == 0.0:
        rates_in_contact(field, branch, acceleration, motion, rates)
    elif field.complete:
        rates_of_large_rotation(field, side, branch, acceleration, rise, motion, rates)
    else:
        rates_of_small_rotation(field, side, branch, acceleration, rise, motion, rates)


@inlined_kernel
def rates_in_contact(field: Field, branch: float, acceleration: float, motion: Array, rates: Array) -> None:
    """Compute the rates while the base stands still (Eq. 13 or 23 without rotation)."""
    n = field.modes.shape[1]
    damped = carried = 0.0
    for i in range(n):
        v = motion[n + i]
        rates[i] = v
        rates[n + i] = -acceleration - restoring_force(field, branch, i, motion, rates) - field.modes[DRAG, i] * v
        damped += field.modes[MASS, i] * field.modes[DRAG, i] * v * v
        carried += field.modes[MASS, i] * v
    rates[2 * n], rates[2 * n + 1] = motion[2 * n + 1], 0.0
    if field.ledger:
        enter(field, damped, -acceleration * carried, 0.0, rates)


@inlined_kernel
def rates_of_small_rotation(
    field: Field, side: float, branch: float, acceleration: float, rise: float, motion: Array, rates: Array
) -> None:
    """Compute the rates of the simplified models while rocking (Eq. 23)."""
    n, pivot = field.modes.shape[1], pivot_at(side)
    theta, spin = motion[2 * n], motion[2 * n + 1]
    weight = field.total_mass * side * field.pivots[pivot, ARM]
    across = weight - field.weight_arm * theta
    moment = (field.gravity + rise) * across + acceleration * field.weight_arm
    moment += side * field.pivots[pivot, PULLED] + field.pivots[pivot, STIFFENED] * theta
    if field.viscous:
        moment += field.pivots[pivot, DAMPED] * spin
    damped = carried = 0.0
    for i in range(n):
        v = motion[n + i]
        rest = -acceleration - restoring_force(field, branch, i, motion, rates) - field.modes[DRAG, i] * v
        rates[i] = v
        rates[n + i] = rest
        moment += field.modes[MASS, i] * field.modes[HEIGHT, i] * rest
        damped += field.modes[MASS, i] * field.modes[DRAG, i] * v * v
        carried += field.modes[MASS, i] * v
    turn(field, side, moment, motion, rates)
    if field.ledger:
        work = -acceleration * (field.weight_arm * spin + carried) - rise * across * spin
        enter(field, damped, work, float(spin), rates)


@inlined_kernel
def rates_of_large_rotation(
    field: Field, side: float, branch: float, acceleration: float, rise: float, motion: Array, rates: Array
) -> None:
    """Compute the rates of the complete models while rocking (Eqs. 13 and 14).

    Terms of the velocities are added last: in a step the velocities are known last, and every stage waits for them.
    """
    n, pivot = field.modes.shape[1], pivot_at(side)
    gravity, spin = field.gravity + rise, motion[2 * n + 1]
    sine, cosine = sine_and_cosine(float(motion[2 * n]))
    offset = side * field.pivots[pivot, ARM]
    displaced = 0.0
    for i in range(n):
        displaced += field.modes[MASS, i] * motion[i]
    beside = field.total_mass * offset - displaced
    arm = beside * sine + field.weight_arm * cosine
    across = beside * cosine - field.weight_arm * sine
    moment = gravity * across + acceleration * arm + field.pivots[pivot, STIFFENED] * sine
    # An element is stretched by 2 r sin(|θ|/2) and pulls with the lever arm r cos(θ/2).
    lever = 1.0
    if field.viscous or field.pivots[pivot, PULLED] != 0.0:
        lever = math.sqrt(0.5 + 0.5 * cosine)
        moment += side * field.pivots[pivot, PULLED] * lever
        if field.viscous:
            moment += field.pivots[pivot, DAMPED] * lever * lever * spin
    drive, square = gravity * sine - acceleration * cosine, spin * spin
    damped = carried = 0.0
    for i in range(n):
        v, mass, behind = motion[n + i], field.modes[MASS, i], motion[i] - offset
        rest = drive - restoring_force(field, branch, i, motion, rates) + square * behind - field.modes[DRAG, i] * v
        rates[i] = v
        rates[n + i] = rest
        moment += 2.0 * mass * behind * (spin * v)
        moment += mass * field.modes[HEIGHT, i] * rest
        damped += mass * field.modes[DRAG, i] * v * v
        carried += mass * v
    turn(field, side, moment, motion, rates)
    if field.ledger:
        work = -acceleration * (arm * spin + cosine * carried) - rise * (across * spin - carried * sine)
        enter(field, damped, work, float(lever * spin), rates)


@inlined_kernel
def restoring_force(field: Field, branch: float, mode: int, motion: Array, rates: Array) -> float:
    """Return the restoring force of a mode per unit of modal mass, and compute the rates of a hysteretic spring."""
    elastic = field.modes[OMEGA2, mode] * motion[mode]
    if not field.hysteretic:
        return float(elastic)
    n = field.modes.shape[1]
    v, z = motion[n + mode], motion[2 * n + 2]
    slip = field.modes[OMEGA2, mode] * field.yield_displacement * (1.0 - field.post_yield_ratio) * z
    rates[2 * n + 2] = hysteresis(field, branch, float(v), float(z))
    if field.ledger:
        rates[2 * n + 5] = field.modes[MASS, mode] * slip * v
    return float(field.post_yield_ratio * elastic + slip)


@inlined_kernel
def turn(field: Field, side: float, moment: float, motion: Array, rates: Array) -> None:
    """Compute θ'' from the moment with θ'' = 0, and what it adds to D''."""
    n = field.modes.shape[1]
    angular = 0.0
    if field.pivots[pivot_at(side), HELD] == 0.0:
        angular = moment * (-1.0 / inertia_left(field, side, motion))  # divided before the moment is known
    for i in range(n):
        rates[n + i] -= field.modes[HEIGHT, i] * angular
    rates[2 * n], rates[2 * n + 1] = motion[2 * n + 1], angular


@inlined_kernel
def enter(field: Field, damped: float, work: float, swing: float, rates: Array) -> None:
    """Compute the rates of the damped energy, of the work of the ground, and of what the viscous dampers sweep."""
    n = field.modes.shape[1]
    rates[2 * n + 3], rates[2 * n + 4] = damped, work
    if not field.hysteretic:
        rates[2 * n + 2] = rates[2 * n + 5] = 0.0
    if field.viscous:
        rates[2 * n + 6] = swing * swing


@kernel
def hysteresis(field: Field, branch: float, velocity: float, z: float) -> float:
    """Return the rate of z (Eq. 38), with `branch` D' in place of |D'|."""
    if field.whole > 0:
        power, left = abs(z), field.whole
        while left & 1 == 0:
            power *= power
            left >>= 1
        factor = power
        left >>= 1
        while left > 0:
            factor *= factor
            if left & 1:
                power *= factor
            left >>= 1
    else:
        power = math.pow(abs(z), field.exponent)
    # z |z|^(n-1) |D'| is |z|^n |D'| with the sign of z. The power comes last, as z is known last.
    lean = field.beta + (branch * field.gamma if z >= 0.0 else -branch * field.gamma)
    return velocity / field.yield_displacement * (1.0 - lean * power)
