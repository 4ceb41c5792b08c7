"""The check of every step whether an event or a new peak can occur inside it."""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.layout import (
    ASKED,
    DOUBT,
    ENDS,
    FINAL,
    FIRST,
    GUARD,
    HIGH,
    LOW,
    LOWER,
    NOW,
    RIPPLE,
    SAG,
    SLOPES,
    SWING,
    UPPER,
    VALUES,
    Log,
    Motion,
    System,
    rows_in,
    unit_of,
)

NOTHING, PEAK, EVENT = 0, 1, 2  # what may occur in a step


@kernel
def set_limits(system: System, phase: int, log: Log, motion: Motion) -> None:
    """Set the limits beyond which a row means an event (the guard and the fences) or a new peak (all others)."""
    for f in range(log.peaks.size):
        motion.values[LOWER, f] = -log.peaks[f]
        motion.values[UPPER, f] = log.peaks[f]
    if not system.phases[phase].free:
        motion.values[LOWER, GUARD] = motion.limits[LOW]
        motion.values[UPPER, GUARD] = motion.limits[HIGH]
    else:
        motion.values[LOWER, GUARD] = max(motion.limits[LOW], -log.peaks[GUARD])
        motion.values[UPPER, GUARD] = min(motion.limits[HIGH], log.peaks[GUARD])
    for f in range(log.signed, log.peaks.size):
        motion.values[LOWER, f] = -np.inf
    for f in range(log.peaks.size, rows_in(system, phase)):
        motion.values[LOWER, f] = 0.0
        motion.values[UPPER, f] = np.inf
    turning = system.turning_row
    if turning >= 0:
        sign = system.phases[phase].turns * system.phases[phase].side
        motion.values[LOWER, turning] = 0.0 if sign > 0.0 else -np.inf
        motion.values[UPPER, turning] = 0.0 if sign < 0.0 else np.inf


@kernel
def examine(system: System, phase: int, level: int, here: float, there: float, slope: float, motion: Motion) -> None:
    """Advance `motion.w` over a step, and compute the requested rows at both ends and the norms of the pairs."""
    pairs = motion.norms.size
    count = system.phases[phase].active
    for k in range(count):
        x, y = motion.w[NOW, k], motion.w[NOW, pairs + k]
        motion.norms[k] = math.sqrt(x * x + y * y)
        motion.w[ENDS, k] = system.blocks[phase, level, 0, k] * x + system.blocks[phase, level, 1, k] * y
        motion.w[ENDS, pairs + k] = system.blocks[phase, level, 2, k] * x + system.blocks[phase, level, 3, k] * y
    if system.phases[phase].dense:
        for i in range(motion.w.shape[1]):
            motion.w[ENDS, i] = 0.0
            for k in range(motion.w.shape[1]):
                motion.w[ENDS, i] += system.propagator[phase, level, i, k] * motion.w[NOW, k]
    for f in range(rows_in(system, phase)):
        if not motion.flags[ASKED, f]:
            continue
        common = system.row_forcing[phase, f, 1] * slope + motion.offset[f]
        before = common + system.row_forcing[phase, f, 0] * here
        after = common + system.row_forcing[phase, f, 0] * there
        for k in range(count):
            before += system.rows[phase, VALUES, f, k] * motion.w[NOW, k]
            before += system.rows[phase, VALUES, f, pairs + k] * motion.w[NOW, pairs + k]
            after += system.rows[phase, VALUES, f, k] * motion.w[ENDS, k]
            after += system.rows[phase, VALUES, f, pairs + k] * motion.w[ENDS, pairs + k]
        motion.values[FIRST, f] = before
        motion.values[FINAL, f] = after


@kernel
def probe(system: System, phase: int, level: int, slope: float, motion: Motion) -> int:
    """Return what can occur in the examined step: nothing, a peak, or an event; `DOUBT` marks the rows in question.

    A row whose chord, widened by `sag`, is within the limits is settled at once. Otherwise, if its slope is within
    `swing` of a chord that does not change sign, the row has its extremes at the ends, where `raise_peaks` finds them.
    Otherwise the row is settled if the cubic through both ends, widened by `ripple`, is within the limits.
    """
    pairs = motion.norms.size
    count = system.phases[phase].active
    finding = NOTHING
    for f in range(rows_in(system, phase)):
        motion.flags[DOUBT, f] = False
        if not motion.flags[ASKED, f]:
            continue
        sag = 0.0
        for k in range(count):
            sag += system.bounds[phase, SAG, level, f, k] * motion.norms[k]
        first, last = motion.values[FIRST, f], motion.values[FINAL, f]
        low, high = min(first, last), max(first, last)
        if low - sag >= motion.values[LOWER, f] and high + sag <= motion.values[UPPER, f]:
            continue
        swing = ripple = 0.0
        before = after = system.row_forcing[phase, f, 0] * slope
        for k in range(count):
            swing += system.bounds[phase, SWING, level, f, k] * motion.norms[k]
            ripple += system.bounds[phase, RIPPLE, level, f, k] * motion.norms[k]
            before += system.rows[phase, SLOPES, f, k] * motion.w[NOW, k]
            before += system.rows[phase, SLOPES, f, pairs + k] * motion.w[NOW, pairs + k]
            after += system.rows[phase, SLOPES, f, k] * motion.w[ENDS, k]
            after += system.rows[phase, SLOPES, f, pairs + k] * motion.w[ENDS, pairs + k]
        hidden = min(before, after) <= swing and max(before, after) >= -swing
        if hidden:
            step = unit_of(system, level)
            low, high = cubic_range(first, last, before * step, after * step)
            hidden = low - ripple < motion.values[LOWER, f] or high + ripple > motion.values[UPPER, f]
        elif f == GUARD:
            # A rotation may start on its limit, where it has just left the ground, but not end there.
            hidden = first < motion.limits[LOW] or first > motion.limits[HIGH]
            hidden = hidden or last <= motion.limits[LOW] or last >= motion.limits[HIGH]
        elif f == system.turning_row or f >= system.fences:
            hidden = last <= motion.values[LOWER, f] or last >= motion.values[UPPER, f]
        motion.flags[DOUBT, f] = hidden
        if hidden:
            finding = max(finding, EVENT if f in (GUARD, system.turning_row) or f >= system.fences else PEAK)
    return finding


@kernel
def cubic_range(first: float, last: float, before: float, after: float) -> tuple[float, float]:
    """Return the smallest and largest value over [0, 1] of the cubic with the given end values and slopes."""
    low, high = min(first, last), max(first, last)
    square = 3.0 * (last - first) - 2.0 * before - after
    cube = before + after - 2.0 * (last - first)
    discriminant = square * square - 3.0 * cube * before
    if discriminant <= 0.0:
        return low, high
    pivot = -square - math.copysign(math.sqrt(discriminant), square)  # both roots without cancellation
    for top, bottom in ((before, pivot), (pivot, 3.0 * cube)):
        if bottom != 0.0 and 0.0 < top / bottom < 1.0:
            u = top / bottom
            value = first + u * (before + u * (square + u * cube))
            low, high = min(low, value), max(high, value)
    return low, high
