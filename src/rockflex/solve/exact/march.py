"""The fast path: one phase carried over whole samples, as long as nothing can hide in them."""

import math

from rockflex._kernel import kernel
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import CONTACT, ROCKING, ZERO, Array, Log, Scratch, System
from rockflex.solve.exact.peaks import raise_peaks
from rockflex.solve.exact.probe import NOTHING, examine, probe, set_limits

__all__ = ["march", "to_coordinates", "to_state"]

WHOLE = ZERO  # the level of a whole sample


@kernel
def to_state(system: System, phase: int, acceleration: float, slope: float, side: float, room: Scratch) -> None:
    """State from the coordinates of a phase."""
    for i in range(room.w.size):
        room.state[i] = 0.0
    for k in range(room.w.size):
        forced = system.forced[phase, 0, k] * acceleration + system.forced[phase, 1, k] * slope
        value = room.w[k] + forced + system.forced[phase, 2, k] * side
        for i in range(room.w.size):
            room.state[i] += system.basis[phase, k, i] * value


@kernel
def to_coordinates(system: System, phase: int, acceleration: float, slope: float, side: float, room: Scratch) -> None:
    """Coordinates of a phase from the state."""
    for k in range(room.w.size):
        forced = system.forced[phase, 0, k] * acceleration + system.forced[phase, 1, k] * slope
        room.w[k] = -forced - system.forced[phase, 2, k] * side
    for i in range(room.w.size):
        for k in range(room.w.size):
            room.w[k] += system.inverse[phase, i, k] * room.state[i]


@kernel
def march(
    system: System,
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
) -> tuple[int, float, int, int]:
    """Carry `room.w` over samples from `first` on; stop before one that needs a closer look, or at the end.

    `offset` is the number of samples before this record. Returns the sample reached, the slope of the acceleration
    that `w` refers to and the count of nodes. The sample that needs a closer look is left examined in `room`.
    """
    phase = ROCKING if side != 0.0 else CONTACT
    pairs = room.norms.size
    active = pairs if phase == ROCKING else pairs - 1
    uncoupled = phase == CONTACT or system.dense.shape[0] == 0
    rate = 1.0 / dt
    started = False
    set_limits(side, system.physics.resistance, log, room)
    for i in range(first, record.size - 1):
        here, there = record[i], record[i + 1]
        incline = (there - here) * rate
        for k in range(2 * pairs):
            room.w[k] -= system.forced[phase, 1, k] * (incline - slope)
        slope = incline
        if started and uncoupled:
            for k in range(active):
                x, y = room.w[k], room.w[pairs + k]
                room.norms[k] = math.sqrt(x * x + y * y)
                room.w_end[k] = system.blocks[phase, 0, 0, k] * x + system.blocks[phase, 0, 1, k] * y
                room.w_end[pairs + k] = system.blocks[phase, 0, 2, k] * x + system.blocks[phase, 0, 3, k] * y
            for f in range(room.start.size):
                value = system.row_forcing[phase, f, 0] * there + system.row_forcing[phase, f, 1] * slope
                value += system.row_forcing[phase, f, 2] * side
                for k in range(active):
                    value += system.rows[phase, f, k] * room.w_end[k]
                    value += system.rows[phase, f, pairs + k] * room.w_end[pairs + k]
                room.start[f] = room.end[f]
                room.end[f] = value
        else:
            examine(system, phase, WHOLE, side, here, there, slope, room)
            started = True
        safe = True
        for f in range(room.start.size):
            sag = 0.0
            for k in range(active):
                sag += system.sag[phase, 0, f, k] * room.norms[k]
            low, high = min(room.start[f], room.end[f]), max(room.start[f], room.end[f])
            safe = safe and low - sag >= room.lower[f] and high + sag <= room.upper[f]
        if not safe:
            finding = probe(system, phase, WHOLE, side, slope, room)
            if finding != NOTHING:
                return i, slope, finding, count
            raise_peaks(room.end, side, (offset + i + 1) * dt, log)
            set_limits(side, system.physics.resistance, log, room)
        for k in range(2 * pairs):
            room.w[k] = room.w_end[k]
        if nodes.shape[0] > 0:
            to_state(system, phase, there, slope, side, room)
            count = append(nodes, count, (offset + i + 1) * dt, side, there, room.state)
    return record.size - 1, slope, NOTHING, count
