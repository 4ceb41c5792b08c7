"""The end of a phase within a stretch of time: the first root of the polynomial of its guard over [0, 1]."""

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex.models import STICKS
from rockflex.solve.layout import (
    FLEXIBILITY,
    GUARD,
    HIGH,
    KIND,
    LOW,
    Motion,
    Progress,
    Span,
    System,
    heavier_limits,
    is_shaken,
    slip_in,
)
from rockflex.solve.polynomials import evaluate, first_descent

BEFORE = -1.0  # the phase ended before it started
NOUGHT = 1e-12  # of the terms of a fence: this close to zero at the start, it is zero

# How a rotation leaves zero at the start of the stretch: the order of its first nonzero term.
INSIDE, PASSING, LIFTED, TOUCHED = 0, 1, 2, 3


@kernel
def phase_exit(system: System, at: Progress, span: Span, motion: Motion, polys: Array) -> tuple[float, int, float]:
    """Return where the guard first passes a limit, which limit, and by how much it then exceeds it.

    The place is inf if no limit is passed. It is `BEFORE` if the moment on a base at rest exceeds a limit from the
    start, or if a rotation never left zero.
    """
    side, low, high = system.phases[at.phase].side, motion.limits[LOW], motion.limits[HIGH]
    if system.phases[at.phase].free and side != 0.0:
        inner = LOW if side > 0.0 else HIGH
        if motion.owners[inner] < 0:
            lands = landing(polys, side, at.onset if motion.state[system.layout.rotation] == 0.0 else INSIDE)
            if lands < 0.0:
                return BEFORE, inner, 0.0
        else:
            lands = approach(polys, side, side * motion.limits[inner])
        tips = overturning(polys, side, high if side > 0.0 else -low)
        if tips < lands and tips < 1.0:
            return tips, 1 - inner, 0.0
        return lands, inner, 0.0
    low_rate = high_rate = 0.0
    if is_shaken(span):
        below, above = heavier_limits(system, at.phase, motion.state)
        low, high = low + span.rise * below, high + span.rise * above
        low_rate, high_rate = span.rise_slope * span.length * below, span.rise_slope * span.length * above
    slip = slip_in(system)
    if slip >= 0 and system.base[at.phase, FLEXIBILITY, slip, slip] != 0.0:
        # The moment of a block that slides is constant, and may equal the limit to the last digits.
        play = NOUGHT * max(abs(low), abs(high))
        low, high = low - play, high + play
    if at.resume == 0.0:
        # Where the ground falls faster than gravity both limits are exceeded: the base lifts where it is pulled more.
        over, under = polys[GUARD, 0] - high, low - polys[GUARD, 0]
        if max(over, under) > 0.0:
            return BEFORE, (HIGH if over > under else LOW), max(over, under)
    stop, bound = band_exit(polys, low, low_rate, high, high_rate, at.resume)
    excess = 0.0
    if at.resume > 0.0 and stop == at.resume:
        value = evaluate(polys, GUARD, stop)[0]
        beyond = value - (high + high_rate * stop) if bound == HIGH else low + low_rate * stop - value
        excess = max(beyond, 0.0)
    return stop, bound, excess


@kernel
def band_exit(
    polys: Array, low: float, low_rate: float, high: float, high_rate: float, start: float
) -> tuple[float, int]:
    """Return where the guard reaches one of two limits (Eq. 24), and which one; they may change at constant rates."""
    work = polys.shape[0] - 1
    exit_at, exit_bound = np.inf, LOW
    play = max(abs(low_rate), abs(high_rate))
    for k in range(1, polys.shape[1]):
        play += abs(polys[GUARD, k])
    for bound in range(2):
        sign = 1.0 if bound == LOW else -1.0
        limit = low if bound == LOW else high
        if sign * (polys[GUARD, 0] - limit) > play:
            continue
        for k in range(polys.shape[1]):
            polys[work, k] = sign * polys[GUARD, k]
        polys[work, 0] -= sign * limit
        polys[work, 1] -= sign * (low_rate if bound == LOW else high_rate)
        u = first_descent(polys, work, start, 1.0)
        if u < exit_at:
            exit_at, exit_bound = u, bound
    return exit_at, exit_bound


@kernel
def landing(polys: Array, side: float, zeros: int) -> float:
    """Return where the rotation returns to zero; `BEFORE` if it never left. Its `zeros` at 0 are divided out."""
    work, terms = polys.shape[0] - 1, polys.shape[1]
    for k in range(terms):
        polys[work, k] = side * polys[GUARD, k + zeros] if k + zeros < terms else 0.0
    if zeros > 0 and polys[work, 0] <= 0.0:
        return BEFORE
    if polys[work, 0] < 0.0:
        polys[work, 0] = 0.0
    return first_descent(polys, work, 0.0, 1.0)


@kernel
def approach(polys: Array, side: float, limit: float) -> float:
    """Return the place where the magnitude of the rotation falls to a limit; inf if it does not."""
    work = polys.shape[0] - 1
    for k in range(polys.shape[1]):
        polys[work, k] = side * polys[GUARD, k]
    polys[work, 0] -= limit
    return first_descent(polys, work, 0.0, 1.0)


@kernel
def turn_back(polys: Array, row: int, sign: float, zeros: int) -> float:
    """Return the place where a velocity of a sign falls to zero; inf if it does not, `BEFORE` if it never had the sign.

    Its `zeros` at 0 are divided out.
    """
    work, terms = polys.shape[0] - 1, polys.shape[1]
    for k in range(terms):
        polys[work, k] = sign * polys[row, k + zeros] if k + zeros < terms else 0.0
    if zeros > 0 and polys[work, 0] <= 0.0:
        return BEFORE
    return first_descent(polys, work, 0.0, 1.0)


@kernel
def overturning(polys: Array, side: float, limit: float) -> float:
    """Return where the rotation reaches its limit of π/2; inf if it does not."""
    work, reach = polys.shape[0] - 1, 0.0
    for k in range(polys.shape[1]):
        reach += abs(polys[GUARD, k])
        polys[work, k] = -side * polys[GUARD, k]
    if reach < limit:
        return np.inf
    polys[work, 0] += limit
    return first_descent(polys, work, 0.0, 1.0)


@kernel
def fence_exit(
    system: System, at: Progress, span: Span, motion: Motion, polys: Array, stop: float
) -> tuple[float, int]:
    """Return where a fence first falls to zero before `stop`, and which one; `stop` and -1 if none does.

    A fence may be zero at the start, since the previous phase ended there: then the sign of its first derivative that
    is not zero decides, and if none is, as in a tendon on the border of slack in a base at rest, the phase goes on. Its
    place is 0 if it is negative from the start.
    """
    found = -1
    for e in range(system.phases[at.phase].fences):
        row, work = system.fences + e, polys.shape[0] - 1
        reach = 0.0
        for k in range(1, polys.shape[1]):
            reach += abs(polys[row, k])
        if polys[row, 0] > reach:
            continue
        zeros = 0
        if system.fence_kinds[at.phase, e, KIND] == STICKS:
            zeros = max(at.slip_onset - 1, 0)  # a slip that has just begun grows like t² or t³
        else:
            size, slope = sizes_at(system, at.phase, row, span, motion)
            rounding = NOUGHT * (size + slope * system.dt)
            if polys[row, 0] < -rounding:
                return 0.0, e
            while zeros < polys.shape[1] and abs(polys[row, zeros]) <= rounding:
                zeros += 1
            if zeros == polys.shape[1]:
                continue
        for k in range(polys.shape[1]):
            polys[work, k] = polys[row, k + zeros] if k + zeros < polys.shape[1] else 0.0
        if polys[work, 0] < 0.0 or (zeros > 0 and polys[work, 0] == 0.0 and polys[work, 1] < 0.0):
            return 0.0, e
        u = first_descent(polys, work, 0.0, 1.0)
        if u < stop:
            stop, found = u, e
    return stop, found


@kernel
def sizes_at(system: System, phase: int, row: int, span: Span, motion: Motion) -> tuple[float, float]:
    """Return the sizes of a row and of its rate at the start of a stretch: the sums of the magnitudes of their terms.

    Velocities count with what they change in a time step, since one that passes zero is far below its usual size.
    """
    rows, moving, n = system.plain_rows, system.plain_rows.shape[2] - 2, system.layout.modes
    size, slope = abs(rows[phase, row, moving] * span.ground) + abs(rows[phase, row, moving + 1]), 0.0
    for i in range(moving):
        size += abs(rows[phase, row, i] * motion.state[i])
    for i in range(motion.w.shape[1] // 2):
        place, speed = (i, n + i) if i < n else (2 * i, 2 * i + 1)
        change = 0.0
        if system.phases[phase].linear:
            change = 2.0 * abs(motion.series[2, i]) / (span.length * span.length) * system.dt
        size += abs(rows[phase, row, speed]) * change
        slope += abs(rows[phase, row, place]) * (abs(motion.state[speed]) + change)
    return size, slope
