"""The closer look: one sample walked on a dyadic grid, in the largest steps in which nothing can hide."""

from rockflex._kernel import kernel
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import Array, Log, Scratch, System
from rockflex.solve.exact.march import to_coordinates, to_state
from rockflex.solve.exact.probe import amplitudes, carry, probe, raise_peaks, read_rows, set_limits
from rockflex.solve.exact.unit import CROSSED, EVENTS, cross_unit

__all__ = ["cross_sample"]


@kernel
def cross_sample(
    system: System,
    side: float,
    fresh: bool,
    acceleration: float,
    slope: float,
    dt: float,
    time: float,
    log: Log,
    room: Scratch,
    nodes: Array,
    count: int,
) -> tuple[int, float, bool, Array, int]:
    """Carry the motion over one sample; return status, side, whether the state is fresh, nodes and their count.

    `room.w` holds the motion at the start and then at the end. A *fresh* state is as true as `w` or truer: it is
    kept across units, since a rotation that has just left zero is far below the rounding of a modal sum.
    """
    levels = system.contact.sag.shape[0] - 1
    grid = 1 << levels
    log.tally[EVENTS] = 0
    place, tuned = 0, True  # tuned: w is up to date
    level = min(1, levels)  # the fast path has just tried the whole sample
    while place < grid:
        stride = grid >> level
        phase = system.rocking if side != 0.0 else system.contact
        size = phase.rows.shape[1]
        w, w_end = room.w[:size], room.w_end[:size]
        here = acceleration + slope * dt * (place / grid)
        if grid > 1:
            if not tuned:
                to_coordinates(phase, room.state, here, slope, side, w)
                tuned = True
            set_limits(side, system.physics.resistance, log, room)
            amplitudes(w, room.norms)
            carry(phase, level, w, w_end)
            read_rows(phase, w, here, slope, side, room.start)
            there = acceleration + slope * dt * ((place + stride) / grid)
            read_rows(phase, w_end, there, slope, side, room.end)
            if probe(phase, level, side, slope, w, w_end, room):
                place += stride
                raise_peaks(room.end, side, time + dt * (place / grid), log)
                w[:] = w_end
                fresh = False
                level = largest_step(place, levels)
                continue
            if level < levels:
                level += 1
                continue
        if not fresh:
            to_state(phase, w, here, slope, side, room.state)
        now = time + dt * (place / grid)
        status, side, nodes, count = cross_unit(
            system, side, here, slope, dt / grid, now, log, room, nodes, count
        )
        fresh, tuned = True, False
        if status != CROSSED:
            return status, side, fresh, nodes, count
        place += 1
        level = largest_step(place, levels)
    phase = system.rocking if side != 0.0 else system.contact
    w = room.w[: phase.rows.shape[1]]
    there = acceleration + slope * dt
    if not tuned:
        to_coordinates(phase, room.state, there, slope, side, w)
    if nodes.shape[0] > 0:
        if not fresh:
            to_state(phase, w, there, slope, side, room.state)
        nodes, count = append(nodes, count, time + dt, side, there, room.state)
    return CROSSED, side, fresh, nodes, count


@kernel
def largest_step(place: int, levels: int) -> int:
    """Level of the largest step of the dyadic grid that starts at `place`."""
    level = levels
    while level > 0 and place % (1 << (levels - level + 1)) == 0:
        level -= 1
    return level
