"""Local power series: the motion about one instant, and the first root of a polynomial on an interval.

Between events the motion is analytic, so about any instant it is a power series whose coefficients follow from
the equations of motion one by one (Eqs. 15 and 23). No modal sum is formed, so nothing cancels: a rotation that
grows like t² or t³ from zero keeps its full relative precision.
"""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.layout import (
    CONSTANT,
    COUPLING,
    DAMPING,
    DRAG,
    DRIVE,
    FLEXIBILITY,
    LEVERAGE,
    OMEGA2,
    STIFFNESS,
    Array,
    Motion,
    Span,
    System,
)

__all__ = ["advance", "bend", "evaluate", "expand", "first_descent", "row_series"]

SHIFT = 40  # steps after which a polynomial is developed anew
MOST_STEPS = 10_000  # a few do; only a root touched to a high order takes more, and then this close is close enough


@kernel
def expand(system: System, phase: int, motion: Motion, span: Span, lift: float) -> None:
    """Fill `motion.series` (N + b, order + 1) with the Taylor coefficients of D and q, time in units of the span.

    `lift` is θ'' at the instant of uplift, where it is known better than the equation of motion gives it (zero
    from a condition that is met continuously); NaN elsewhere.
    """
    n, freedoms, step, series = system.layout.modes, motion.push.size, span.length, motion.series
    free = system.phases[phase].side != 0.0
    for i in range(n):
        series[i, 0] = motion.state[i]
        series[i, 1] = motion.state[n + i] * step
    for j in range(freedoms):
        series[n + j, 0] = motion.state[2 * n + 2 * j]
        series[n + j, 1] = motion.state[2 * n + 2 * j + 1] * step
    square, terms = step * step, system.phases[phase].terms
    for k in range(terms, series.shape[1]):
        for i in range(series.shape[0]):
            series[i, k] = 0.0
    for k in range(terms - 2):
        drive = 0.0
        if k == 0:
            drive = square * span.ground
        elif k == 1:
            drive = square * step * span.slope
        pair = 1.0 / ((k + 2.0) * (k + 1.0))
        # The first freedom's sum is kept in a register, and the others' in memory.
        pushed = 0.0
        for j in range(1, freedoms):
            motion.push[j] = 0.0
        for i in range(n):
            restoring = system.modes[DRAG, i] * step * (k + 1.0) * series[i, k + 1]
            restoring += system.modes[OMEGA2, i] * square * series[i, k]
            series[i, k + 2] = -(restoring + drive) * pair
            pushed += system.border[phase, 0, LEVERAGE, i] * restoring
            for j in range(1, freedoms):
                motion.push[j] += system.border[phase, j, LEVERAGE, i] * restoring
        for j in range(freedoms):
            series[n + j, k + 2] = 0.0
        if not free:
            continue
        motion.push[0] = pushed
        for j in range(freedoms):
            force = system.push[phase, DRIVE, j] * drive
            for m in range(freedoms):
                force -= system.base[phase, STIFFNESS, j, m] * square * series[n + m, k]
                force -= system.base[phase, DAMPING, j, m] * step * (k + 1.0) * series[n + m, k + 1]
            if k == 0:
                force += system.push[phase, CONSTANT, j] * square
            motion.push[j] += force
        for j in range(freedoms):
            turn = 0.0
            for m in range(freedoms):
                turn += system.base[phase, FLEXIBILITY, j, m] * motion.push[m]
            if k == 0 and not math.isnan(lift):
                turn = square * lift
            series[n + j, k + 2] = turn * pair
            for i in range(n):
                series[i, k + 2] -= system.border[phase, j, COUPLING, i] * turn * pair


@kernel
def row_series(system: System, phase: int, row: int, motion: Motion, span: Span) -> None:
    """Taylor coefficients, in `motion.polys[row]`, of one row of a phase."""
    n, pairs, terms = system.layout.modes, motion.series.shape[0], system.phases[phase].terms
    rows, polys, series, step = system.plain_rows, motion.polys, motion.series, span.length
    ground = rows.shape[2] - 2
    for k in range(polys.shape[1]):
        polys[row, k] = 0.0
    for i in range(pairs):
        weight = rows[phase, row, i if i < n else 2 * i]
        if weight != 0.0:
            for k in range(terms):
                polys[row, k] += weight * series[i, k]
        weight = rows[phase, row, n + i if i < n else 2 * i + 1] / step
        if weight != 0.0:
            for k in range(terms - 1):
                polys[row, k] += weight * (k + 1.0) * series[i, k + 1]
    polys[row, 0] += rows[phase, row, ground] * span.ground + rows[phase, row, ground + 1]
    polys[row, 1] += rows[phase, row, ground] * span.slope * step


@kernel
def advance(system: System, motion: Motion, u: float, step: float) -> None:
    """Put the state at the fraction `u` of `step`, from the series, in place of that at its start."""
    n = system.layout.modes
    for i in range(motion.series.shape[0]):
        value, rate = evaluate(motion.series, i, u)
        motion.state[i if i < n else 2 * i] = value
        motion.state[n + i if i < n else 2 * i + 1] = rate / step


@kernel
def evaluate(polys: Array, row: int, u: float) -> tuple[float, float]:
    """Value and derivative of the polynomial `polys[row]` at `u` (Horner)."""
    value = polys[row, polys.shape[1] - 1]
    slope = 0.0
    for k in range(polys.shape[1] - 2, -1, -1):
        slope = slope * u + value
        value = value * u + polys[row, k]
    return value, slope


@kernel
def bend(polys: Array, row: int, u: float) -> float:
    """Bound of the second derivative's magnitude over [0, u]."""
    total = 0.0
    for k in range(polys.shape[1] - 1, 1, -1):
        total = total * u + k * (k - 1.0) * abs(polys[row, k])
    return total


@kernel
def rootless(value: float, slope: float, curvature: float) -> float:
    """Length from a point on over which a function, not negative there, cannot fall below zero."""
    root = math.sqrt(max(slope * slope + 2.0 * curvature * value, 0.0))
    if slope < 0.0:
        return 2.0 * value / (root - slope)
    return (slope + root) / curvature if curvature > 0.0 else np.inf


@kernel
def first_descent(polys: Array, row: int, start: float, stop: float) -> float:
    """First point of [start, stop] where a polynomial, not negative at `start`, falls to zero; inf if none.

    Each step is the longest over which the bound of the second derivative forbids a root. Near a simple root
    that is Newton's step, always from the safe side, so no root can be passed over. Where that is slow, roots or turns
    crowd ahead, and the bound has lost touch with the polynomial: `polys[row]` is then developed anew about the point
    reached.
    """
    curvature = bend(polys, row, stop)
    base, u = 0.0, start
    for count in range(1, MOST_STEPS + 1):
        value, slope = evaluate(polys, row, u)
        if value <= 0.0 and slope <= 0.0:
            return base + u
        step = rootless(value, slope, curvature)
        if u + step >= stop:
            return np.inf
        # Where a polynomial is flat at first, the bound over what lies just ahead is much the lesser one.
        ahead = min(max(2.0 * u, u + 8.0 * step), stop)
        near = rootless(value, slope, bend(polys, row, ahead))
        if u + near >= stop and ahead == stop:
            return np.inf
        step = max(step, min(near, ahead - u))
        if step <= 2e-16:
            return base + u
        u += step
        if count % SHIFT == 0:
            develop_about(polys, row, u)
            base += u
            stop -= u
            u = 0.0
            curvature = bend(polys, row, stop)
    return base + u


@kernel
def develop_about(polys: Array, row: int, u: float) -> None:
    """Shift the polynomial's origin to `u`, in place."""
    last = polys.shape[1] - 1
    for k in range(last):
        for j in range(last - 1, k - 1, -1):
            polys[row, j] += u * polys[row, j + 1]
