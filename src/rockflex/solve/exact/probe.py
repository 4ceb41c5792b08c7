"""The question asked of every step: can an event or a new peak hide inside it?"""

import math

from rockflex._kernel import kernel
from rockflex.solve.exact.layout import Array, Log, Phase, Scratch

__all__ = ["HALF_TURN", "amplitudes", "carry", "probe", "raise_peaks", "read_rows", "set_limits"]

HALF_TURN = 0.5 * math.pi


@kernel
def carry(phase: Phase, level: int, w: Array, out: Array) -> None:
    """Carry the coordinates over a step of dt / 2^level."""
    size = w.size
    if phase.dense.shape[0] > 0:
        for i in range(size):
            total = 0.0
            for j in range(size):
                total += phase.dense[level, i, j] * w[j]
            out[i] = total
        return
    count = size // 2
    block = phase.blocks[level]
    for k in range(count):
        out[k] = block[0, k] * w[k] + block[1, k] * w[count + k]
        out[count + k] = block[2, k] * w[k] + block[3, k] * w[count + k]


@kernel
def amplitudes(w: Array, out: Array) -> None:
    """Norm of every pair of coordinates."""
    count = w.size // 2
    for k in range(count):
        out[k] = math.sqrt(w[k] * w[k] + w[count + k] * w[count + k])


@kernel
def read_rows(phase: Phase, w: Array, acceleration: float, slope: float, side: float, out: Array) -> None:
    """Values of all rows."""
    for f in range(out.size):
        total = phase.row_forcing[f, 0] * acceleration + phase.row_forcing[f, 1] * slope
        total += phase.row_forcing[f, 2] * side
        for k in range(w.size):
            total += phase.rows[f, k] * w[k]
        out[f] = total


@kernel
def set_limits(side: float, resistance: float, log: Log, room: Scratch) -> None:
    """Limits beyond which a row calls for an event (row 0) or a new peak (all others, and row 0 while rocking)."""
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


@kernel
def probe(phase: Phase, level: int, side: float, slope: float, w: Array, w_end: Array, room: Scratch) -> bool:
    """True where no event and no peak can hide in the step from `w` to `w_end`.

    A row within `sag` of its chord is settled at once; else a slope that outweighs `swing` at either end proves
    that the row has its extremes at the ends, where `raise_peaks` picks them up.
    """
    start, end, norms = room.start, room.end, room.norms
    for f in range(start.size):
        sag = 0.0
        for k in range(w.size // 2):
            sag += phase.sag[level, f, k] * norms[k]
        low, high = min(start[f], end[f]), max(start[f], end[f])
        if low - sag >= room.lower[f] and high + sag <= room.upper[f]:
            continue
        swing = 0.0
        for k in range(w.size // 2):
            swing += phase.swing[level, f, k] * norms[k]
        before = after = phase.slope_forcing[f] * slope
        for k in range(w.size):
            before += phase.slope_rows[f, k] * w[k]
            after += phase.slope_rows[f, k] * w_end[k]
        if abs(before) <= swing and abs(after) <= swing:
            return False
        if f > 0:
            continue
        if side == 0.0:
            if low < room.lower[0] or high > room.upper[0]:
                return False
        elif side * end[0] <= 0.0 or side * start[0] < 0.0 or abs(end[0]) >= HALF_TURN:
            return False
    return True


@kernel
def raise_peaks(values: Array, side: float, time: float, log: Log) -> None:
    """Note the values at the end of a step in which nothing hid."""
    for f in range(0 if side != 0.0 else 1, values.size):
        if abs(values[f]) > log.peaks[f]:
            log.peaks[f] = abs(values[f])
            log.times[f] = time
