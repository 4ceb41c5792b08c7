"""The closer look: one sample walked on a dyadic grid, in the largest steps in which nothing can hide."""

from rockflex._kernel import kernel
from rockflex.models import Impact
from rockflex.solve.exact.grid import largest_step
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import CONTACT, LEFT, LOOK, ROCKING, Array, Log, Scratch, System
from rockflex.solve.exact.march import to_coordinates, to_state
from rockflex.solve.exact.peaks import raise_peaks
from rockflex.solve.exact.probe import EVENT, PEAK, examine, probe, set_limits
from rockflex.solve.exact.survey import survey
from rockflex.solve.exact.unit import CROSSED, EVENTS, SPENT, cross_unit

__all__ = ["cross_sample"]


@kernel
def cross_sample(
    system: System,
    impact: Impact,
    side: float,
    fresh: bool,
    finding: int,
    acceleration: float,
    last: float,
    slope: float,
    time: float,
    until: float,
    log: Log,
    room: Scratch,
    nodes: Array,
    count: int,
) -> tuple[int, float, bool, int]:
    """Carry the motion over the sample from `time` to `until`, where the ground's acceleration becomes `last`.

    Returns status, side, whether the state is fresh and the count of nodes.

    `room.w` holds the motion at the start and then at the end. A *fresh* state is as true as `w` or truer: it is
    kept across units, since a rotation that has just left zero is far below the rounding of a modal sum. The walk
    depends on the guard alone, not on which peaks are asked for, so neither does the motion.
    """
    levels = system.sag.shape[1] - 1
    grid = 1 << levels
    unit = float(system.steps[levels])
    log.tally[EVENTS] = 0
    place, level, tuned = 0, 0, True  # tuned: w is up to date
    probed = True  # by the fast path, which has left the whole sample examined
    while place < grid:
        stride = grid >> level
        phase = ROCKING if side != 0.0 else CONTACT
        here = acceleration + slope * unit * place
        now = time + unit * place
        log.work[LEFT] -= log.work[LOOK]
        if log.work[LEFT] < 0.0:
            if not fresh:
                to_state(system, phase, here, slope, side, room)
            return SPENT, side, True, count
        if not probed:
            if not tuned:
                to_coordinates(system, phase, here, slope, side, room)
                tuned = True
            set_limits(side, system.physics.resistance, log, room)
            examine(system, phase, level, side, here, here + slope * unit * stride, slope, room)
            finding = probe(system, phase, level, side, slope, room)
        probed = False
        if finding == EVENT and level < levels:
            level += 1
            continue
        if finding == EVENT:
            if not fresh:
                to_state(system, phase, here, slope, side, room)
            ending = until if place + 1 == grid else time + unit * (place + 1)
            status, side, count = cross_unit(
                system, impact, side, here, slope, unit, now, ending, log, room, nodes, count
            )
            if status != CROSSED:
                return status, side, True, count
            fresh, tuned = True, False
        else:
            raise_peaks(room.end, side, now + unit * stride, log)
            if finding == PEAK:
                survey(system, level, side, here, slope, now, log, room)
            for k in range(room.w.size):
                room.w[k] = room.w_end[k]
            fresh = False
        place += stride
        level = largest_step(place, levels)
    phase = ROCKING if side != 0.0 else CONTACT
    if not tuned:
        to_coordinates(system, phase, last, slope, side, room)
    if nodes.shape[0] > 0:
        if not fresh:
            to_state(system, phase, last, slope, side, room)
        count = append(nodes, count, until, side, last, room.state)
    return CROSSED, side, fresh, count
