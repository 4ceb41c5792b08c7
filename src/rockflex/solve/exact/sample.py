"""The closer look: one sample walked on a dyadic grid, in the largest steps in which nothing can hide."""

from rockflex._kernel import kernel
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import CONTACT, ROCKING, Array, Log, Scratch, System
from rockflex.solve.exact.march import to_coordinates, to_state
from rockflex.solve.exact.peaks import raise_peaks
from rockflex.solve.exact.probe import examine, probe, set_limits
from rockflex.solve.exact.unit import CROSSED, EVENTS, cross_unit, survey_unit

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
) -> tuple[int, float, bool, int]:
    """Carry the motion over one sample; return status, side, whether the state is fresh and the count of nodes.

    `room.w` holds the motion at the start and then at the end. A *fresh* state is as true as `w` or truer: it is
    kept across units, since a rotation that has just left zero is far below the rounding of a modal sum.
    """
    levels = system.sag.shape[1] - 1
    grid = 1 << levels
    log.tally[EVENTS] = 0
    place, level, tuned = 0, 0, True  # tuned: w is up to date
    status = CROSSED
    while place < grid:
        stride = grid >> level
        phase = ROCKING if side != 0.0 else CONTACT
        here = acceleration + slope * dt * (place / grid)
        now = time + dt * (place / grid)
        safe = False
        if stride < grid:  # else the fast path has just examined the sample
            if not tuned:
                to_coordinates(system, phase, here, slope, side, room)
                tuned = True
            there = acceleration + slope * dt * ((place + stride) / grid)
            set_limits(side, system.physics.resistance, log, room)
            examine(system, phase, level, side, here, there, slope, room)
            safe = probe(system, phase, level, side, slope, room)
        if not safe and level < levels:
            level += 1
            continue
        step = dt / grid
        if not safe and not fresh:
            to_state(system, phase, here, slope, side, room)
        if not safe and room.doubt[0]:
            status, side, count = cross_unit(system, side, here, slope, step, now, log, room, nodes, count)
            fresh, tuned = True, False
            if status != CROSSED:
                return status, side, fresh, count
        else:
            if safe:
                raise_peaks(room.end, side, time + dt * ((place + stride) / grid), log)
            else:
                survey_unit(system, side, here, slope, step, now, log, room)
            for k in range(room.w.size):
                room.w[k] = room.w_end[k]
            fresh = False
        place += stride
        level = largest_step(place, levels)
    phase = ROCKING if side != 0.0 else CONTACT
    there = acceleration + slope * dt
    if not tuned:
        to_coordinates(system, phase, there, slope, side, room)
    if nodes.shape[0] > 0:
        if not fresh:
            to_state(system, phase, there, slope, side, room)
        count = append(nodes, count, time + dt, side, there, room.state)
    return CROSSED, side, fresh, count


@kernel
def largest_step(place: int, levels: int) -> int:
    """Level of the largest step of the dyadic grid that starts at `place`."""
    level = levels
    while level > 0 and place % (1 << (levels - level + 1)) == 0:
        level -= 1
    return level
