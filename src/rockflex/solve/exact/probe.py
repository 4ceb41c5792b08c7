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
    may_end_phase,
    rows_in,
    unit_of,
)

NOTHING, PEAK, EVENT = 0, 1, 2  # what may occur in a step


@kernel
def step(system: System, phase: int, level: int, motion: Motion) -> None:
    """Advance `motion.w` over a step, from now to its end."""
    pairs = motion.norms.size
    now, ends, blocks = motion.w[NOW], motion.w[ENDS], system.blocks[phase, level]
    if system.phases[phase].dense:
        for i in range(2 * pairs):
            ends[i] = 0.0
            for k in range(2 * pairs):
                ends[i] += system.propagator[phase, level, i, k] * now[k]
        return
    for k in range(system.phases[phase].active):
        x, y = now[k], now[pairs + k]
        ends[k] = blocks[0, k] * x + blocks[1, k] * y
        ends[pairs + k] = blocks[2, k] * x + blocks[3, k] * y
    for k in range(system.phases[phase].active, pairs):
        ends[k], ends[pairs + k] = now[k], now[pairs + k]


@kernel
def examine(system: System, phase: int, level: int, here: float, there: float, slope: float, motion: Motion) -> None:
    """Advance `motion.w` over a step, and compute the requested rows at both ends and the norms of the pairs."""
    pairs = motion.norms.size
    count = system.phases[phase].active
    for k in range(count):
        x, y = motion.w[NOW, k], motion.w[NOW, pairs + k]
        motion.norms[k] = math.sqrt(x * x + y * y)
    step(system, phase, level, motion)
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
def probe(system: System, phase: int, level: int, slope: float, log: Log, motion: Motion) -> int:
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
        lower, upper = motion.values[LOWER, f], motion.values[UPPER, f]
        highest = log.peaks[f] if f < log.peaks.size and (f != GUARD or system.phases[phase].free) else np.inf
        lowest = -np.inf if f >= log.signed else -highest
        low, high = min(first, last), max(first, last)
        if low - sag >= max(lower, lowest) and high + sag <= min(upper, highest):
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
            length = unit_of(system, level)
            low, high = cubic_range(first, last, before * length, after * length)
            low, high = low - ripple, high + ripple
        event = False
        if may_end_phase(system, f):
            event = hidden and (low < lower or high > upper)
            if not hidden:
                event = last <= lower or last >= upper
                # A rotation may start on its limit, where it has just left the ground, but not end there.
                event |= f == GUARD and (first < lower or first > upper)
        motion.flags[DOUBT, f] = event or (hidden and (low < lowest or high > highest))
        if motion.flags[DOUBT, f]:
            finding = max(finding, EVENT if event else PEAK)
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
