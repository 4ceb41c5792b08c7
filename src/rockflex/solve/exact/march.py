"""The fast path: a linear phase advanced over whole samples, while no event can occur inside them.

The rows are computed for a block of samples at once. Only a sample in which some row may leave its limits is looked at
by itself: the samples before an event are kept, the others are computed again from the next phase. Peaks are searched
in the samples next to the largest values. They do not change the motion, which depends on the guard and fences only.
"""

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex.solve.exact.blocks import leaving, look_ahead, pass_block, walk_on, walk_to
from rockflex.solve.exact.coordinates import to_state
from rockflex.solve.exact.deferred import defer
from rockflex.solve.exact.probe import EVENT, NOTHING, step
from rockflex.solve.exact.search import look_into, raise_to_samples, search_next
from rockflex.solve.history import keep
from rockflex.solve.layout import (
    ASKED,
    ENDS,
    INCLINES,
    LOWER,
    NOW,
    UPPER,
    ZERO,
    Log,
    Motion,
    Progress,
    System,
    may_end_phase,
    rows_in,
)


@inlined_kernel
def march(system: System, piece: Array, most: int, at: Progress, log: Log, motion: Motion) -> None:
    """Advance `motion.w` over at most `most` samples of a piece; stop before one in which an event may occur.

    `at.finding` says whether it stopped there. If the search for peaks is interrupted, `at.searching` is true.
    """
    last = min(at.index + most, piece.size - 1)
    while at.index < last:
        if not at.blocked:
            look_ahead(system, piece, last, at, motion)
            at.finding = watch(system, piece, at, log, motion)
            at.marks = raise_to_samples(system, at, log, motion)
            if at.marks != 0:
                defer(system, at, log, motion)
            at.blocked = True
        while at.marks != 0:
            if not search_next(system, piece, at, log, motion):
                return
        stops = at.finding == EVENT
        if log.history.shape[0] > 0:
            keep_samples(system, piece, at.count if stops else at.count - 1, at, log, motion)
        pass_block(system, at, stops, motion)
        at.blocked = False
        at.stated = at.stated and at.count == 0
        at.index += at.count
        if stops:
            return
        if log.history.shape[0] > 0:
            keep_now(system, piece, at.index, at, log, motion)


@inlined_kernel
def watch(system: System, piece: Array, at: Progress, log: Log, motion: Motion) -> int:
    """Return whether an event may occur in the block; if so, reduce `at.count` to the samples before it."""
    p, doubtful = at.phase, ZERO
    for f in range(rows_in(system, p)):
        if may_end_phase(system, f):
            lower, upper = motion.values[LOWER, f], motion.values[UPPER, f]
            doubtful |= leaving(f, lower + motion.slack[f], upper - motion.slack[f], at, motion)
    if doubtful == 0:
        return NOTHING
    for f in range(rows_in(system, p)):
        motion.flags[ASKED, f] = may_end_phase(system, f)
    finding, m = NOTHING, 0
    while doubtful != 0 and finding != EVENT:
        if doubtful & 1:
            finding = look_into(system, piece, m, at, log, motion)
            if finding == EVENT:
                at.count = m
        doubtful >>= 1
        m += 1
    for f in range(rows_in(system, p)):
        motion.flags[ASKED, f] = True
    return EVENT if finding == EVENT else NOTHING


@kernel
def keep_samples(system: System, piece: Array, count: int, at: Progress, log: Log, motion: Motion) -> None:
    """Add the states at the ends of the first samples of the block to the history."""
    for m in range(count):
        walk_to(system, m, at, motion)
        step(system, at.phase, 0, motion)
        for k in range(motion.w.shape[1]):
            motion.w[NOW, k] = motion.w[ENDS, k]
        at.slope = motion.block[INCLINES, m]
        keep_now(system, piece, at.index + m + 1, at, log, motion)
        walk_on(system, at, motion)


@kernel
def keep_now(system: System, piece: Array, i: int, at: Progress, log: Log, motion: Motion) -> None:
    """Add the state that belongs to `motion.w[NOW]`, at a sample of the piece, to the history."""
    ground = float(piece[i])
    to_state(system, at, ground, motion)
    keep(log, (at.offset + i) * system.dt, system.phases[at.phase].side, ground, 0.0, motion.state)
