"""The check of every step whether an event or a new peak can occur inside it."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex._vectors import set_norms, set_products, step_pairs
from rockflex.solve.layout import (
    AFTER,
    ASKED,
    BEFORE,
    DOUBT,
    ENDS,
    FINAL,
    FIRST,
    GUARD,
    LOWER,
    NOW,
    RIPPLE,
    RIPPLES,
    SAG,
    SAGS,
    SLOPES,
    SWING,
    SWINGS,
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
    now, ends = motion.w[NOW], motion.w[ENDS]
    if system.phases[phase].dense:
        for i in range(2 * pairs):
            ends[i] = 0.0
            for k in range(2 * pairs):
                ends[i] += system.propagator[phase, level, i, k] * now[k]
        return
    step_pairs(ends, system.blocks[phase, level], now, system.phases[phase].active)
    for k in range(system.phases[phase].active, pairs):
        ends[k], ends[pairs + k] = now[k], now[pairs + k]


@inlined_kernel
def set_over_pairs(sums: Array, table: Array, w: Array, active: int) -> None:
    """Set sums, one for each row, to the products of a table with the first `active` pairs of coordinates."""
    set_products(sums, table, w, active, 2)


@kernel
def examine(system: System, phase: int, level: int, here: float, there: float, slope: float, motion: Motion) -> None:
    """Advance `motion.w` over a step, and compute the rows at both ends and the norms of the pairs."""
    count, forcing, rows = system.phases[phase].active, system.row_forcing[phase], system.rows[phase, VALUES]
    first, final = motion.values[FIRST], motion.values[FINAL]
    set_norms(motion.norms, motion.w[NOW], count)
    step(system, phase, level, motion)
    set_over_pairs(first, rows, motion.w[NOW], count)
    set_over_pairs(final, rows, motion.w[ENDS], count)
    for f in range(rows_in(system, phase)):
        common = forcing[f, 1] * slope + motion.offset[f]
        first[f] += common + forcing[f, 0] * here
        final[f] += common + forcing[f, 0] * there


@inlined_kernel
def probe(system: System, phase: int, level: int, slope: float, log: Log, motion: Motion) -> int:
    """Return what can occur in the examined step: nothing, a peak, or an event; `DOUBT` marks the rows in question.

    A row whose chord, widened by `sag`, is within the limits is settled at once. Otherwise, if its slope is within
    `swing` of a chord that does not change sign, the row has its extremes at the ends, where `raise_peaks` finds them.
    Otherwise the row is settled if the cubic through both ends, widened by `ripple`, is within the limits.
    """
    bounds, count = system.bounds[phase], system.phases[phase].active
    sags = motion.values[SAGS]
    set_products(sags, bounds[SAG, level], motion.norms, count, 1)
    finding, sloped = NOTHING, False
    for f in range(rows_in(system, phase)):
        motion.flags[DOUBT, f] = False
        if not motion.flags[ASKED, f]:
            continue
        sag = sags[f]
        first, last = motion.values[FIRST, f], motion.values[FINAL, f]
        lower, upper = motion.values[LOWER, f], motion.values[UPPER, f]
        highest = log.peaks[f] if f < log.peaks.size and (f != GUARD or system.phases[phase].free) else np.inf
        lowest = -np.inf if f >= log.signed else -highest
        low, high = min(first, last), max(first, last)
        if low - sag >= max(lower, lowest) and high + sag <= min(upper, highest):
            continue
        if not sloped:
            look_at_slopes(system, phase, level, slope, motion)
            sloped = True
        swing, ripple = motion.values[SWINGS, f], motion.values[RIPPLES, f]
        before, after = motion.values[BEFORE, f], motion.values[AFTER, f]
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
def look_at_slopes(system: System, phase: int, level: int, slope: float, motion: Motion) -> None:
    """Compute the slopes of the rows at both ends of the examined step, and their swing and ripple."""
    count, bounds, rows = system.phases[phase].active, system.bounds[phase], system.rows[phase, SLOPES]
    before, after = motion.values[BEFORE], motion.values[AFTER]
    swings, ripples = motion.values[SWINGS], motion.values[RIPPLES]
    set_products(swings, bounds[SWING, level], motion.norms, count, 1)
    set_products(ripples, bounds[RIPPLE, level], motion.norms, count, 1)
    set_over_pairs(before, rows, motion.w[NOW], count)
    set_over_pairs(after, rows, motion.w[ENDS], count)
    for f in range(rows_in(system, phase)):
        before[f] += system.row_forcing[phase, f, 0] * slope
        after[f] += system.row_forcing[phase, f, 0] * slope


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
