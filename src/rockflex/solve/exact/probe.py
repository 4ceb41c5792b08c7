"""The question that is asked of every step, whether an event or a new peak can hide inside it."""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.layout import ROCKING, Log, Scratch, System

__all__ = ["EVENT", "NOTHING", "PEAK", "QUARTER_TURN", "cubic_range", "examine", "probe", "set_limits"]

QUARTER_TURN = 0.5 * math.pi
NOTHING, PEAK, EVENT = 0, 1, 2  # what a step may hide; the first row hides events, and the peak of the rotation


@kernel
def set_limits(side: float, resistance: float, log: Log, room: Scratch) -> None:
    """Limits beyond which a row calls for an event (row 0) or a new peak (all others, and row 0 while rocking)."""
    support = log.peaks.size - 1
    for f in range(log.peaks.size):
        room.lower[f] = -log.peaks[f]
        room.upper[f] = log.peaks[f]
    if side == 0.0:
        room.lower[0] = -resistance
        room.upper[0] = resistance
    elif side > 0.0:
        room.lower[0] = 0.0
    else:
        room.upper[0] = 0.0
    if side <= 0.0:
        room.upper[support] = np.inf
    if side >= 0.0:
        room.lower[support] = -np.inf


@kernel
def examine(
    system: System,
    phase: int,
    level: int,
    side: float,
    here: float,
    there: float,
    slope: float,
    room: Scratch,
) -> None:
    """Carry `room.w` over a step into `room.w_end`, with the rows asked for at both ends and the pairs' norms."""
    pairs = room.norms.size
    count = pairs if phase == ROCKING else pairs - 1
    for k in range(count):
        x, y = room.w[k], room.w[pairs + k]
        room.norms[k] = math.sqrt(x * x + y * y)
        room.w_end[k] = system.blocks[phase, level, 0, k] * x + system.blocks[phase, level, 1, k] * y
        room.w_end[pairs + k] = system.blocks[phase, level, 2, k] * x + system.blocks[phase, level, 3, k] * y
    if phase == ROCKING and system.dense.shape[0] > 0:
        for i in range(room.w.size):
            room.w_end[i] = 0.0
            for k in range(room.w.size):
                room.w_end[i] += system.dense[level, i, k] * room.w[k]
    for f in range(room.start.size):
        if not room.asked[f]:
            continue
        common = system.row_forcing[phase, f, 1] * slope + system.row_forcing[phase, f, 2] * side
        before = common + system.row_forcing[phase, f, 0] * here
        after = common + system.row_forcing[phase, f, 0] * there
        for k in range(count):
            before += system.rows[phase, f, k] * room.w[k]
            before += system.rows[phase, f, pairs + k] * room.w[pairs + k]
            after += system.rows[phase, f, k] * room.w_end[k]
            after += system.rows[phase, f, pairs + k] * room.w_end[pairs + k]
        room.start[f] = before
        room.end[f] = after


@kernel
def probe(system: System, phase: int, level: int, side: float, slope: float, room: Scratch) -> int:
    """What can hide in the step examined: nothing, a peak, or an event; `room.doubt` marks the rows in question.

    A row within `sag` of its chord is settled at once. Else a slope that keeps its sign, within `swing` of
    its chord, proves that the row has its extremes at the ends, where `raise_peaks` picks them up; and a row that turns
    is settled where it stays within `ripple` of the cubic through both ends.
    """
    pairs = room.norms.size
    count = pairs if phase == ROCKING else pairs - 1
    finding = NOTHING
    for f in range(room.start.size):
        room.doubt[f] = False
        if not room.asked[f]:
            continue
        sag = 0.0
        for k in range(count):
            sag += system.sag[phase, level, f, k] * room.norms[k]
        first, last = room.start[f], room.end[f]
        low, high = min(first, last), max(first, last)
        if low - sag >= room.lower[f] and high + sag <= room.upper[f]:
            continue
        swing = ripple = 0.0
        before = after = system.row_forcing[phase, f, 0] * slope
        for k in range(count):
            swing += system.swing[phase, level, f, k] * room.norms[k]
            ripple += system.ripple[phase, level, f, k] * room.norms[k]
            before += system.slope_rows[phase, f, k] * room.w[k]
            before += system.slope_rows[phase, f, pairs + k] * room.w[pairs + k]
            after += system.slope_rows[phase, f, k] * room.w_end[k]
            after += system.slope_rows[phase, f, pairs + k] * room.w_end[pairs + k]
        hidden = min(before, after) <= swing and max(before, after) >= -swing
        if hidden:
            step = float(system.steps[level])
            low, high = cubic_range(first, last, before * step, after * step)
            hidden = low - ripple < room.lower[f] or high + ripple > room.upper[f]
        elif f == 0:
            if side == 0.0:
                hidden = low < room.lower[0] or high > room.upper[0]
            else:
                hidden = side * last <= 0.0 or side * first < 0.0 or abs(last) >= QUARTER_TURN
        room.doubt[f] = hidden
        if hidden:
            finding = max(finding, EVENT if f == 0 else PEAK)
    return finding


@kernel
def cubic_range(first: float, last: float, before: float, after: float) -> tuple[float, float]:
    """Least and largest value over [0, 1] of the cubic with the given end values and end slopes."""
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
