"""Local power series: the state about one instant, and the first root of a polynomial on an interval.

Between events the motion is analytic, so about any instant it is a power series whose coefficients follow from
the equations of motion one by one (Eqs. 15 and 23). No modal sum is formed, so nothing cancels: a rotation that
grows like t² or t³ from zero keeps its full relative precision.
"""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.layout import Array, Physics

__all__ = ["ORDER", "advance", "evaluate", "expand", "first_descent", "row_series"]

ORDER = 20  # 1/20! = 4e-19: enough for an interval over which no mode turns by more than one radian


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
    """Fill `series` (ORDER + 1, N + 1) with the Taylor coefficients of D_1..D_N and θ in the unit `step`.

    `lift` is θ'' at the instant of uplift, where it is known better than the equation of motion gives it (zero
    from a condition that is met continuously); NaN elsewhere.
    """
    n = physics.omega2.size
    for i in range(n):
        series[0, i] = state[i]
        series[1, i] = state[n + i] * step
    series[0, n] = state[2 * n] if rocking else 0.0
    series[1, n] = state[2 * n + 1] * step if rocking else 0.0
    square = step * step
    for k in range(ORDER - 1):
        drive = 0.0
        if k == 0:
            drive = square * acceleration
        elif k == 1:
            drive = square * step * slope
        pair = (k + 2.0) * (k + 1.0)
        moment = 0.0
        for i in range(n):
            restoring = physics.damping[i] * step * (k + 1.0) * series[k + 1, i]
            restoring += physics.omega2[i] * square * series[k, i]
            moment += physics.moment_arm[i] * restoring
            series[k + 2, i] = -(restoring + drive) / pair
        if not rocking:
            series[k + 2, n] = 0.0
            continue
        moment += physics.gravity * square * series[k, n] + physics.drive_arm * drive
        if k == 0:
            moment -= side * physics.resistance * square
        angular = moment / physics.inertia
        if k == 0 and not math.isnan(lift):
            angular = square * lift
        series[k + 2, n] = angular / pair
        for i in range(n):
            series[k + 2, i] -= physics.height[i] * angular / pair


@kernel
def row_series(
    row: Array,
    series: Array,
    acceleration: float,
    slope: float,
    side: float,
    step: float,
    out: Array,
) -> None:
    """Taylor coefficients of one linear functional of state, ground acceleration and side."""
    n = series.shape[1] - 1
    for k in range(ORDER + 1):
        total = row[2 * n] * series[k, n]
        for i in range(n):
            total += row[i] * series[k, i]
        out[k] = total
    for k in range(ORDER):
        total = row[2 * n + 1] * series[k + 1, n]
        for i in range(n):
            total += row[n + i] * series[k + 1, i]
        out[k] += total * (k + 1.0) / step
    out[0] += row[2 * n + 2] * acceleration + row[2 * n + 3] * side
    out[1] += row[2 * n + 2] * slope * step


@kernel
def advance(series: Array, u: float, step: float, state: Array) -> None:
    """State at the fraction `u` of `step` from the series."""
    n = series.shape[1] - 1
    for i in range(n + 1):
        value = series[ORDER, i]
        rate = 0.0
        for k in range(ORDER - 1, -1, -1):
            rate = rate * u + value
            value = value * u + series[k, i]
        place = i if i < n else 2 * n
        speed = n + i if i < n else 2 * n + 1
        state[place] = value
        state[speed] = rate / step


@kernel
def evaluate(poly: Array, u: float) -> tuple[float, float]:
    """Value and derivative of a polynomial at `u` (Horner)."""
    value = poly[-1]
    slope = 0.0
    for k in range(poly.size - 2, -1, -1):
        slope = slope * u + value
        value = value * u + poly[k]
    return value, slope


@kernel
def bend(poly: Array, u: float) -> float:
    """Bound of the second derivative's magnitude over [0, u]."""
    total = 0.0
    for k in range(poly.size - 1, 1, -1):
        total = total * u + k * (k - 1.0) * abs(poly[k])
    return total


@kernel
def first_descent(poly: Array, start: float, stop: float) -> float:
    """First point of [start, stop] at which a polynomial, not negative at `start`, falls to zero; inf if none.

    Each step is the longest over which the bound of the second derivative forbids a root. Near a simple root
    that is Newton's step, always from the safe side, so no root can be passed over.
    """
    curvature = bend(poly, stop)
    u = start
    while True:
        value, slope = evaluate(poly, u)
        if value <= 0.0 and slope <= 0.0:
            return u
        root = math.sqrt(max(slope * slope + 2.0 * curvature * value, 0.0))
        if slope < 0.0:
            step = 2.0 * value / (root - slope)
        elif curvature > 0.0:
            step = (slope + root) / curvature
        else:
            return np.inf
        if u + step >= stop:
            return np.inf
        if step <= 2e-16:
            return u
        u += step
