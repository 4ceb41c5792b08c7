"""Local power series: the motion about one instant, and the first root of a polynomial on an interval.

Between events the motion is analytic, so about any instant it is a power series whose coefficients follow from
the equations of motion one by one (Eqs. 15 and 23). No modal sum is formed, so nothing cancels: a rotation that
grows like t² or t³ from zero keeps its full relative precision.
"""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.layout import Array, Physics

__all__ = ["advance", "bend", "evaluate", "expand", "first_descent", "row_series"]

SHIFT = 40  # steps after which a polynomial is developed anew
MOST_STEPS = 10_000  # a few do; only a root touched to a high order takes more, and then this close is close enough


@kernel
def expand(
    physics: Physics,
    rocking: bool,
    state: Array,
    acceleration: float,
    slope: float,
    side: float,
    lift: float,
    step: float,
    series: Array,
) -> None:
    """Fill `series` (N + 1, order + 1) with the Taylor coefficients of D_1..D_N and θ, time in units of `step`.

    `lift` is θ'' at the instant of uplift, where it is known better than the equation of motion gives it (zero
    from a condition that is met continuously); NaN elsewhere.
    """
    n = physics.omega2.size
    for i in range(n):
        series[i, 0] = state[i]
        series[i, 1] = state[n + i] * step
    series[n, 0] = state[2 * n]
    series[n, 1] = state[2 * n + 1] * step
    square = step * step
    share = 1.0 / physics.inertia
    for k in range(series.shape[1] - 2):
        drive = 0.0
        if k == 0:
            drive = square * acceleration
        elif k == 1:
            drive = square * step * slope
        pair = 1.0 / ((k + 2.0) * (k + 1.0))
        moment = 0.0
        for i in range(n):
            restoring = physics.damping[i] * step * (k + 1.0) * series[i, k + 1]
            restoring += physics.omega2[i] * square * series[i, k]
            moment += physics.mass[i] * physics.height[i] * restoring
            series[i, k + 2] = -(restoring + drive) * pair
        series[n, k + 2] = 0.0
        if not rocking:
            continue
        moment += physics.gravity * square * series[n, k] + physics.drive_arm * drive
        if k == 0:
            moment -= side * physics.resistance * square
        angular = moment * share
        if k == 0 and not math.isnan(lift):
            angular = square * lift
        series[n, k + 2] = angular * pair
        for i in range(n):
            series[i, k + 2] -= physics.height[i] * angular * pair


@kernel
def row_series(
    rows: Array,
    phase: int,
    row: int,
    series: Array,
    acceleration: float,
    slope: float,
    side: float,
    step: float,
    polys: Array,
) -> None:
    """Taylor coefficients, in `polys[row]`, of one linear functional of state, ground acceleration and side."""
    n, terms = series.shape[0] - 1, series.shape[1]
    for k in range(terms):
        polys[row, k] = 0.0
    for i in range(n + 1):
        weight = rows[phase, row, i if i < n else 2 * n]
        if weight != 0.0:
            for k in range(terms):
                polys[row, k] += weight * series[i, k]
        weight = rows[phase, row, n + i if i < n else 2 * n + 1] / step
        if weight != 0.0:
            for k in range(terms - 1):
                polys[row, k] += weight * (k + 1.0) * series[i, k + 1]
    polys[row, 0] += rows[phase, row, 2 * n + 2] * acceleration + rows[phase, row, 2 * n + 3] * side
    polys[row, 1] += rows[phase, row, 2 * n + 2] * slope * step


@kernel
def advance(series: Array, u: float, step: float, state: Array) -> None:
    """State at the fraction `u` of `step` from the series."""
    n = series.shape[0] - 1
    for i in range(n + 1):
        value, rate = evaluate(series, i, u)
        state[i if i < n else 2 * n] = value
        state[n + i if i < n else 2 * n + 1] = rate / step


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
