"""Blocks of samples in which peaks may lie, searched at the end of the run if no later sample is higher.

Most peaks of a run are exceeded soon after. A block is kept by the coordinates at its start and by a bound of each row
in it. Once the peaks so far exceed the bounds, the block is forgotten; few remain to be searched.
"""

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.blocks import look_ahead
from rockflex.solve.exact.search import raise_to_samples, rising, search_next
from rockflex.solve.layout import BEGUN, INCLINES, MOST_DEFERRED, NOW, Course, Log, Motion, Progress, System
from rockflex.solve.memory import recollect


@kernel
def defer(system: System, at: Progress, log: Log, motion: Motion) -> None:
    """Keep the present block for a later search for peaks, if there is room; otherwise it is searched now."""
    place = 0
    while place < MOST_DEFERRED and waits(place, log, motion):
        place += 1
    if place == MOST_DEFERRED:
        return
    put_aside(place, BEGUN, at, motion)
    each = motion.deferred[place]
    each.waits, each.slope = True, motion.block[INCLINES, 0]
    # The peaks so far are at least the values at the samples of the block.
    for f in range(log.peaks.size):
        rises = (f > 0 or system.phases[at.phase].free) and rising(f, at, log, motion) != 0
        motion.highest[place, f] = log.peaks[f] + motion.slack[f] if rises else -np.inf
    at.marks = 0


@kernel
def put_aside(place: int, which: int, at: Progress, motion: Motion) -> None:
    """Keep the present state, and the coordinates `motion.w[which]`."""
    each = motion.deferred[place]
    each.phase, each.offset, each.index, each.slope = at.phase, at.offset, at.index, at.slope
    each.count, each.stated = at.count, at.stated
    for i in range(motion.state.size):
        motion.states[place, i] = motion.state[i]
    for k in range(motion.w.shape[1]):
        motion.coordinates[place, k] = motion.w[which, k]


@kernel
def resume(system: System, place: int, at: Progress, motion: Motion) -> None:
    """Return to a state that was kept."""
    each = motion.deferred[place]
    at.phase, at.offset, at.index, at.slope = each.phase, each.offset, each.index, each.slope
    at.count, at.stated = each.count, each.stated
    for i in range(motion.state.size):
        motion.state[i] = motion.states[place, i]
    for k in range(motion.w.shape[1]):
        motion.w[NOW, k] = motion.coordinates[place, k]
    recollect(system, at.phase, motion)


@kernel
def waits(place: int, log: Log, motion: Motion) -> bool:
    """Return whether a block that was kept may still contain a peak."""
    if motion.deferred[place].waits:
        for f in range(log.peaks.size):
            if motion.highest[place, f] > log.peaks[f]:
                return True
        motion.deferred[place].waits = False
    return False


@kernel
def search_deferred(system: System, course: Course, at: Progress, log: Log, motion: Motion) -> bool:
    """Search the blocks that wait for peaks; return False if the search is interrupted."""
    present = motion.deferred[MOST_DEFERRED]
    for place in range(max(at.deferred, 0), MOST_DEFERRED):
        if at.deferred < 0 and not waits(place, log, motion):
            continue
        piece = course.record if motion.deferred[place].offset == 0 else course.quiet
        if at.deferred < 0:
            if not present.waits:
                put_aside(MOST_DEFERRED, NOW, at, motion)
                present.waits = True
            resume(system, place, at, motion)
            look_ahead(system, piece, at.index + at.count, at, motion)
            at.marks = raise_to_samples(system, at, log, motion)
            at.deferred = place
        while at.marks != 0:
            if not search_next(system, piece, at, log, motion):
                return False
        at.deferred = -1
        motion.deferred[place].waits = False
    if present.waits:
        resume(system, MOST_DEFERRED, at, motion)
        present.waits = False
    return True
