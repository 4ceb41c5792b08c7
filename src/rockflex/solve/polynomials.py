"""Polynomials, one per row: their values, and their first root in an interval."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import kernel

SHIFT = 40  # steps after which a polynomial is expanded about a new point
PRECISE = 1e-16  # of the interval
MOST_STEPS = 10_000  # usually a few suffice; only a multiple root takes more, and this is then close enough


@kernel
def evaluate(polys: Array, row: int, u: float) -> tuple[float, float]:
    """Return value and derivative of the polynomial `polys[row]` at `u` (Horner)."""
    value = polys[row, polys.shape[1] - 1]
    slope = 0.0
    for k in range(polys.shape[1] - 2, -1, -1):
        slope = slope * u + value
        value = value * u + polys[row, k]
    return value, slope


@kernel
def bend(polys: Array, row: int, u: float) -> float:
    """Return a bound of the magnitude of the second derivative over [0, u]."""
    total = 0.0
    for k in range(polys.shape[1] - 1, 1, -1):
        total = total * u + k * (k - 1.0) * abs(polys[row, k])
    return total


@kernel
def rootless(value: float, slope: float, curvature: float) -> float:
    """Return the length over which a function that is not negative at a point cannot fall below zero."""
    root = math.sqrt(max(slope * slope + 2.0 * curvature * value, 0.0))
    if slope < 0.0:
        return 2.0 * value / (root - slope)
    return (slope + root) / curvature if curvature > 0.0 else np.inf


@kernel
def first_descent(polys: Array, row: int, start: float, stop: float) -> float:
    """Return the first point in [start, stop] where a polynomial, not negative at `start`, falls to zero, or inf.

    Each step is the longest over which the bound of the second derivative excludes a root. Near a simple root this is
    Newton's step, always from the safe side, so no root can be missed. If convergence is slow, roots or extremes are
    close together and the bound is too pessimistic: `polys[row]` is then expanded about the current point.
    """
    curvature = bend(polys, row, stop)
    value, slope = evaluate(polys, row, start)
    if value > 0.0 and slope + curvature * (stop - start) < 0.0:
        return only_root(polys, row, start, stop, value, slope)
    base, u = 0.0, start
    for count in range(1, MOST_STEPS + 1):
        value, slope = evaluate(polys, row, u)
        if value <= 0.0 and slope <= 0.0:
            return base + u
        step = rootless(value, slope, curvature)
        if u + step >= stop:
            return np.inf
        # If the polynomial is flat at first, a bound over a short range ahead is much smaller.
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
def only_root(polys: Array, row: int, start: float, stop: float, value: float, slope: float) -> float:
    """Return where a polynomial that falls throughout [start, stop] reaches zero, from its value and slope at `start`.

    Newton's steps are kept between the points known to lie before and behind the root.
    """
    last, _ = evaluate(polys, row, stop)
    if last >= 0.0:
        return np.inf
    before, behind = start, stop
    u = start - value / slope
    for _ in range(MOST_STEPS):
        if not before < u < behind:
            u = 0.5 * (before + behind)
            if not before < u < behind:
                return behind
        value, slope = evaluate(polys, row, u)
        if value > 0.0:
            before = u
        else:
            behind = u
        step = value / slope
        if abs(step) <= PRECISE:
            return u - step
        u -= step
    return behind


@kernel
def develop_about(polys: Array, row: int, u: float) -> None:
    """Shift the polynomial's origin to `u`, in place."""
    last = polys.shape[1] - 1
    for k in range(last):
        for j in range(last - 1, k - 1, -1):
            polys[row, j] += u * polys[row, j + 1]
