"""The fast path: one phase carried over whole samples, as long as nothing can hide in them."""

from rockflex._kernel import kernel
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import Array, Log, Phase, Scratch
from rockflex.solve.exact.probe import amplitudes, carry, probe, raise_peaks, read_rows, set_limits

__all__ = ["march", "to_coordinates", "to_state"]


@kernel
def to_state(phase: Phase, w: Array, acceleration: float, slope: float, side: float, state: Array) -> None:
    """State from the coordinates of a phase."""
    for i in range(state.size):
        total = 0.0
        for k in range(w.size):
            forced = phase.particular[0, k] * acceleration + phase.particular[1, k] * slope
            total += phase.basis[i, k] * (w[k] + forced + phase.particular[2, k] * side)
        state[i] = total


@kernel
def to_coordinates(phase: Phase, state: Array, acceleration: float, slope: float, side: float, w: Array) -> None:
    """Coordinates of a phase from the state."""
    for k in range(w.size):
        total = -phase.particular[0, k] * acceleration - phase.particular[1, k] * slope
        total -= phase.particular[2, k] * side
        for i in range(state.size):
            total += phase.inverse[k, i] * state[i]
        w[k] = total


@kernel
def march(
    phase: Phase,
    resistance: float,
    record: Array,
    dt: float,
    first: int,
    offset: int,
    side: float,
    slope: float,
    log: Log,
    room: Scratch,
    nodes: Array,
    count: int,
) -> tuple[int, float, Array, int]:
    """Carry `room.w` over samples from `first` on; stop before one that needs a closer look, or at the end.

    `offset` is the number of samples before this record. Returns the sample reached, the slope of the acceleration
    that `w` refers to, the nodes and their count.
    """
    size, rows = phase.rows.shape[1], log.peaks.size
    pairs = size // 2
    w, w_end, norms = room.w[:size], room.w_end[:size], room.norms
    lower, upper, start, end = room.lower, room.upper, room.start, room.end
    set_limits(side, resistance, log, room)
    read_rows(phase, w, record[first], slope, side, start)
    for i in range(first, record.size - 1):
        incline = (record[i + 1] - record[i]) / dt
        for k in range(size):
            w[k] -= phase.particular[1, k] * (incline - slope)
        slope = incline
        amplitudes(w, norms)
        carry(phase, 0, w, w_end)
        read_rows(phase, w_end, record[i + 1], slope, side, end)
        safe = True
        for f in range(rows):
            sag = 0.0
            for k in range(pairs):
                sag += phase.sag[0, f, k] * norms[k]
            if min(start[f], end[f]) - sag < lower[f] or max(start[f], end[f]) + sag > upper[f]:
                safe = False
        if not safe:
            if not probe(phase, 0, side, slope, w, w_end, room):
                return i, slope, nodes, count
            raise_peaks(end, side, (offset + i + 1) * dt, log)
            set_limits(side, resistance, log, room)
        w[:] = w_end
        start[:] = end
        if nodes.shape[0] > 0:
            to_state(phase, w, record[i + 1], slope, side, room.state)
            nodes, count = append(nodes, count, (offset + i + 1) * dt, side, record[i + 1], room.state)
    return record.size - 1, slope, nodes, count
