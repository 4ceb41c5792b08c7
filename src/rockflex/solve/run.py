"""One run: the record, then free vibration for the specified time, or until no further event or peak is possible.

This is the event loop. In each phase the motion is advanced over whole samples while no event or peak can occur inside
them. A sample in which one may occur is traversed on a grid, and a step of the grid in which a guard may be passed is
advanced event by event. The kernel returns when its slice of work is used up, and continues there, bit for bit.
"""

import math

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex._vectors import BLOCK
from rockflex.models import Impact, field_rates
from rockflex.solve.adaptive.curves import values_of_rows
from rockflex.solve.adaptive.layout import TOLD, Flow, Integrator, Stages
from rockflex.solve.adaptive.step import choose_branch, forget
from rockflex.solve.adaptive.steps import step_through
from rockflex.solve.events import CROSSED, LACKS_PHASE, PAUSED
from rockflex.solve.exact.coordinates import to_coordinates, to_state
from rockflex.solve.exact.deferred import search_deferred
from rockflex.solve.exact.march import march
from rockflex.solve.exact.probe import NOTHING
from rockflex.solve.history import keep, room_left
from rockflex.solve.layout import (
    CARRY,
    EVENTS,
    GUARD,
    HIGH,
    LEFT,
    LOW,
    NOW,
    VALUES,
    Course,
    Log,
    Motion,
    Progress,
    Span,
    System,
    rows_in,
)
from rockflex.solve.memory import recollect
from rockflex.solve.peaks import raise_row, raise_to_state
from rockflex.solve.sample import cross_sample
from rockflex.solve.status import Status

ENDED, SETTLED, UNSETTLED = int(Status.ENDED), int(Status.SETTLED), int(Status.UNSETTLED)

BEGINNING, CARRYING, LOOKING = 0, 1, 2  # stages: start of a stretch; whole samples; closer look at one sample
STILL = 1e-13  # relative deviation of a row from its constant that is rounding
CALM = 1e-8  # 1/s: of the largest value so far, the rate of one that is at rest
STRETCH = 4096  # largest number of samples between two checks of the work


@inlined_kernel
def run(
    system: System, steps: Integrator | None, impact: Impact, course: Course, at: Progress, log: Log, motion: Motion
) -> int:
    """Continue the motion; return how the run ended, or why it is interrupted."""
    if at.deferred >= 0 and not search_deferred(system, course, at, log, motion):
        return PAUSED
    if at.status == PAUSED:
        status = follow(system, steps, impact, course, at, log, motion)
        if status < 0 or status in (PAUSED, LACKS_PHASE):
            return status
        at.status = status
    return int(at.status) if search_deferred(system, course, at, log, motion) else PAUSED


@inlined_kernel
def follow(
    system: System, steps: Integrator | None, impact: Impact, course: Course, at: Progress, log: Log, motion: Motion
) -> int:
    """Continue the motion to its end; peaks may still be to be searched in some blocks."""
    rate = 1.0 / course.dt
    if not at.entered:
        recollect(system, at.phase, motion)
        at.entered = True
    while True:
        remaining = course.free + course.record.size - 1 - at.offset
        piece, vertical = course.record, course.vertical[: course.vertical.size if at.offset == 0 else 0]
        if at.offset > 0:
            if remaining == 0:
                return UNSETTLED if course.settle else ENDED
            piece = course.quiet[: min(course.quiet.size - 1, remaining) + 1]
        if at.stage == BEGINNING:
            if course.settle and at.offset > 0 and not search_deferred(system, course, at, log, motion):
                return PAUSED
            if begin_piece(system, steps, course, piece[0], rise_at(vertical, 0), at, log, motion):
                return SETTLED
            at.stage = CARRYING
        last = piece.size - 1
        while at.index < last:
            if at.stage == CARRYING:
                if log.work[LEFT] < 0.0 or room_left(log) < 0:
                    return PAUSED
                if not carry(system, steps, piece, vertical, course.dt, at, log, motion):
                    continue
                at.stage, at.place, at.level, at.probed = LOOKING, 0, 0, False
                at.slope = (piece[at.index + 1] - piece[at.index]) * rate
                log.tally[EVENTS] = 0
            i = at.index
            time, until = (at.offset + i) * course.dt, (at.offset + i + 1) * course.dt
            rise, risen = rise_at(vertical, i), rise_at(vertical, i + 1)
            sample = Span(
                time, until, piece[i], (piece[i + 1] - piece[i]) * rate, course.dt, rise, (risen - rise) * rate
            )
            status = cross_sample(system, steps, impact, sample, piece[i + 1], at, log, motion)
            if status != CROSSED:
                return status
            log.work[LEFT] -= log.work[CARRY]
            at.index, at.stage, at.begun = i + 1, CARRYING, 0.0
        if system.phases[at.phase].marches and not at.stated:
            to_state(system, at, piece[piece.size - 1], motion)
            at.stated = True
        at.last = piece[piece.size - 1]
        at.offset += piece.size - 1
        at.index, at.stage = 0, BEGINNING


@kernel
def begin_piece(
    system: System,
    steps: Integrator | None,
    course: Course,
    ground: float,
    rise: float,
    at: Progress,
    log: Log,
    motion: Motion,
) -> bool:
    """Prepare for a stretch of acceleration; return True if a run until settled has settled."""
    time, side = at.offset * course.dt, system.phases[at.phase].side
    if system.phases[at.phase].marches:
        at.slope = 0.0
        to_coordinates(system, at, ground, motion)
        at.tuned = True
        if at.offset > 0 and course.settle and settled(system, at, log, motion):
            if system.phases[at.phase].free:
                motion.state[system.layout.rotation] = motion.offset[GUARD]
            return True
    elif (
        steps is not None
        and not system.phases[at.phase].linear
        and at.offset > 0
        and course.settle
        and still(system, steps.flow, at, steps.room)
    ):
        return True
    falls = at.offset == course.record.size - 1 and rise_at(course.vertical, at.offset) != 0.0
    if ground != at.last or falls:  # the start, or a jump of the acceleration at the end of the record
        keep(log, time, side, ground, rise, motion.state)
        raise_row(GUARD, motion.state[system.layout.rotation], time, log)
        if steps is None:
            raise_to_state(system, at.phase, ground, rise, time, log, motion)
        else:
            forget(steps.room)
            values_of_rows(system, steps.flow, at.phase, ground, rise, steps.room)
            for f in range(GUARD if system.phases[at.phase].free else 1, log.peaks.size):
                raise_row(f, steps.room.rows[TOLD, f], time, log)
    return False


@kernel
def settled(system: System, at: Progress, log: Log, motion: Motion) -> bool:
    """Return True if free vibration can neither end the phase nor increase a peak: every row stays near a constant.

    The base then stays in contact, or open by a rotation that remains. A row whose deviation from its constant is below
    rounding has settled, too: a base that creeps back has no later peak. So has a motion that is rounding next to the
    displacements at rest, such as those of a base on springs.
    """
    p, pairs = at.phase, motion.norms.size
    if not system.phases[p].decays:
        return False
    held = system.phases[p].side != 0.0 and not system.phases[p].free
    moving = system.phases[p].active if system.phases[p].free else system.layout.modes
    place = size_at_rest = size_of_motion = 0.0
    for k in range(moving):
        size_at_rest = max(size_at_rest, math.hypot(motion.still[k], motion.still[pairs + k]))
        size_of_motion = max(size_of_motion, math.hypot(motion.w[NOW, k], motion.w[NOW, pairs + k]))
    calm = size_of_motion <= STILL * size_at_rest
    for f in range(log.peaks.size):
        rest, stray = motion.offset[f], 0.0
        terms = abs(rest)  # of which the constant is the sum: 0 for the loss of support, yet rounded like the weight
        for k in range(moving):
            size = math.hypot(system.rows[p, VALUES, k, f], system.rows[p, VALUES, pairs + k, f])
            stray += size * math.hypot(motion.w[NOW, k], motion.w[NOW, pairs + k])
            terms += size * math.hypot(motion.still[k], motion.still[pairs + k])
        for k in range(moving, pairs if held else moving):
            rest += system.rows[p, VALUES, k, f] * motion.w[NOW, k]
        if f == GUARD:
            place = abs(rest)
            if rest - stray < motion.limits[LOW] or rest + stray > motion.limits[HIGH]:
                return False
        if calm or (f == GUARD and not system.phases[p].free):
            continue
        if f == system.turning_row:
            if system.phases[p].turns != 0 and stray > STILL * place:
                return False
        elif (rest if f >= log.signed else abs(rest)) + stray > log.peaks[f] and stray > STILL * max(terms, abs(rest)):
            return False
    for f in range(log.peaks.size, rows_in(system, p)):
        stray = 0.0
        for k in range(moving):
            size = math.hypot(system.rows[p, VALUES, k, f], system.rows[p, VALUES, pairs + k, f])
            stray += size * math.hypot(motion.w[NOW, k], motion.w[NOW, pairs + k])
        if motion.offset[f] < stray and not calm:
            return False
    return True


@kernel
def still(system: System, flow: Flow, at: Progress, room: Stages) -> bool:
    """Return True if free vibration of an integrated phase has come to rest: its rates are tiny next to its largest."""
    if flow.field.hysteretic:
        choose_branch(flow, system.phases[at.phase].side, 0.0, 0.0, room)
    field_rates(flow.field, system.phases[at.phase].side, room.at.branch, 0.0, 0.0, room.motion, room.rates[0])
    forget(room)
    worst = 0.0
    for i in range(room.size.size):
        worst = max(worst, abs(room.rates[0, i]) - CALM * room.size[i])
    return worst <= 0.0


@kernel
def rise_at(vertical: Array, index: int) -> float:
    """Return the vertical acceleration of the ground at a sample."""
    return vertical[index] if vertical.size > 0 else 0.0


@kernel
def level_samples(vertical: Array, index: int) -> int:
    """Return over how many samples from one on the ground does not move vertically, at most `STRETCH`."""
    if vertical.size == 0:
        return STRETCH
    count = 0
    while count < STRETCH and index + count + 1 < vertical.size:
        if vertical[index + count] != 0.0 or vertical[index + count + 1] != 0.0:
            return count
        count += 1
    return count


@inlined_kernel
def carry(
    system: System,
    steps: Integrator | None,
    piece: Array,
    vertical: Array,
    dt: float,
    at: Progress,
    log: Log,
    motion: Motion,
) -> bool:
    """Advance the motion over whole samples; return True if the next one needs a closer look."""
    p = at.phase
    if steps is not None and not system.phases[p].linear:
        return step_through(system, steps.flow, piece, vertical, dt, motion.limits, at, log, steps.room)
    level = level_samples(vertical, at.index)
    if not system.phases[p].marches or level == 0:
        if at.tuned and not at.stated:
            to_state(system, at, float(piece[at.index]), motion)
            at.stated = True
        at.tuned = False
        return True
    if not at.tuned:
        to_coordinates(system, at, float(piece[at.index]), motion)
        at.tuned = True
    first = at.index
    most = min(STRETCH, level)
    if log.history.shape[0] > 0:
        # Whole blocks, so that a history leaves the motion as it is.
        most = min(most, max(room_left(log) // BLOCK, 1) * BLOCK)
    march(system, piece, most, at, log, motion)
    log.work[LEFT] -= (at.index - first) * log.work[CARRY]
    return at.finding != NOTHING and not at.blocked  # otherwise the search for peaks is interrupted
