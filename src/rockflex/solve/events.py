"""Advancing the motion from event to event: the first root of a guard, a jump, and the next phase."""

import numpy as np

from rockflex._kernel import inlined_kernel, kernel
from rockflex.models import (
    CHANGES,
    CLOSES,
    LANDS,
    OPENS,
    OVERTURNS,
    RELEASES,
    SLIPS,
    TURNS,
    Impact,
    kinetic_energy,
    stick,
    strike,
)
from rockflex.solve.adaptive.check import nothing_hides
from rockflex.solve.adaptive.layout import Integrator
from rockflex.solve.adaptive.step import FAILED, forget, step_over
from rockflex.solve.adaptive.turning import turning
from rockflex.solve.carrier import begin, first_exit, first_fence, free_inertia, move, turning_exit, turning_rate
from rockflex.solve.exits import INSIDE, LIFTED, PASSING, TOUCHED
from rockflex.solve.history import drop_passing, keep, room_left
from rockflex.solve.layout import (
    BESIDE,
    CHANGED,
    EVENT,
    EVENTS,
    GUARD,
    IMPACTS,
    KIND,
    LEFT,
    SERIES,
    TURNED,
    UPLIFTS,
    Log,
    Motion,
    Progress,
    Span,
    System,
    part_of,
    unit_of,
)
from rockflex.solve.memory import remember
from rockflex.solve.passages import beside, enter, lacks, pass_fence, set_off
from rockflex.solve.status import Status

CROSSED = int(Status.ENDED)
OVERTURNED, PAUSED, LACKS_PHASE = int(Status.OVERTURNED), int(Status.PAUSED), int(Status.LACKS_PHASE)
BROKEN, CHATTER, GAINED, STALLED = (
    int(each) for each in (Status.BROKEN, Status.CHATTER, Status.GAINED, Status.STALLED)
)

MOST_EVENTS = 20_000  # in one sample
GAIN = 1e-9  # relative gain of energy in an impact that is attributed to rounding
SNAP = 1e-10  # of a unit: an event this close to the end is handled at the start of the next unit
RESUME = 1e-7  # where the search in contact resumes after a guard that was touched but not passed


@inlined_kernel
def cross(
    system: System, steps: Integrator | None, impact: Impact, sample: Span, at: Progress, log: Log, motion: Motion
) -> int:
    """Advance the state from `at.begun`, event by event, to a point of the grid or to the end of the sample.

    It ends on the grid if the phase is linear and no further event occurs before that point. If it pauses, `at`
    contains everything needed to continue.
    """
    while at.begun < sample.length:
        if log.work[LEFT] < 0.0 or room_left(log) < 0:
            return PAUSED
        log.work[LEFT] -= log.work[SERIES]
        p = at.phase
        side, linear = system.phases[p].side, system.phases[p].linear
        here = sample.ground + sample.slope * at.begun
        now = min(sample.time + at.begun, sample.until)
        longest, unit = sample.length - at.begun, sample.length
        if linear:
            unit = float(unit_of(system, system.phases[p].levels))
            longest = unit if at.begun == unit * at.place else unit * (at.place + 1) - at.begun
        doubted = at.tried
        length = begin(system, steps, at, part_of(sample, now, at.begun, longest))
        if length == FAILED:
            return STALLED
        span = part_of(sample, now, at.begun, length)
        whole = length == longest
        if (
            steps is not None
            and not linear
            and at.onset == INSIDE
            and not doubted
            and nothing_hides(system, steps.flow, p, span, motion.limits, log, steps.room)
        ):
            step_over(steps.room)
            at.begun = sample.length if whole else at.begun + length
            continue
        stop, bound, excess = first_exit(system, steps, at, span, motion)
        owner = motion.owners[bound]
        event = CHANGES if owner >= 0 else system.links[p, EVENT + bound]
        back = turning_exit(system, steps, at, span, motion)
        if back < stop:
            stop, event = back, TURNS
        fence = -1
        if stop >= 0.0:
            stop, fence = first_fence(system, steps, at, span, motion, stop)
            if fence >= 0:
                event = system.fence_kinds[p, fence, KIND]
        if stop < 0.0:
            at.lacking = lacks(system, at, event, bound, owner, fence, impact)
            if at.lacking >= 0:
                return LACKS_PHASE
            if system.phases[p].free:
                log.tally[EVENTS] += 1
                enter(system, at, system.links[p, TURNED if event == TURNS else BESIDE + 0], motion)
                at.onset, at.lift, at.resume = INSIDE, np.nan, RESUME
                if system.phases[p].fences > 0:  # the base may have begun to slip, which was not recorded either
                    drop_passing(log, now)
                    keep(log, now, system.phases[at.phase].side, here, span.rise, motion.state)
            else:
                set_off(system, steps, at, bound, excess, motion)
                at.onset = LIFTED
                if event == RELEASES:
                    drop_passing(log, now)
                    keep(log, now, side, here, span.rise, motion.state)
            at.slip_onset, at.slide = INSIDE, np.nan
            at.fresh_rows = True
            if steps is not None:
                forget(steps.room)
            continue
        tipped = event == OVERTURNS and stop < 1.0
        ends = not tipped and stop > 1.0 - SNAP * (unit / length if linear else 1.0)
        if ends:
            stop = 1.0
        turns = False
        if steps is not None and steps.flow.field.hysteretic:
            turn = turning(steps.flow, steps.room)
            turns = turn < stop
            if turns:
                stop, ends, tipped = turn, True, False
        if not ends:
            at.lacking = lacks(system, at, event, bound, owner, fence, impact)
            if at.lacking >= 0:
                return LACKS_PHASE
        lifted = at.onset >= LIFTED and motion.state[system.layout.rotation] == 0.0
        at_once = stop == 0.0 and (event == CHANGES or fence >= 0)
        if lifted and not at_once:
            log.tally[UPLIFTS] += 1
            log.tally[EVENTS] += 1
            drop_passing(log, now)
            keep(log, now, 0.0, here, span.rise, motion.state)
            keep(log, now, side, here, span.rise, motion.state)
        move(system, steps, at, span, stop, turns, log, motion)
        at.begun = sample.length if whole and stop == 1.0 and not linear else at.begun + stop * length
        if not at_once:
            at.onset, at.lift = INSIDE, np.nan
            at.slip_onset, at.slide = INSIDE, np.nan
        if ends:
            at.resume = 0.0
            if linear:
                at.place += 1
                grid = 1 << system.phases[p].levels
                at.begun = sample.length if at.place == grid else unit * at.place
                break
            continue
        here = sample.ground + sample.slope * at.begun
        now = min(sample.time + at.begun, sample.until)
        rise = sample.rise + sample.rise_slope * at.begun
        if fence >= 0:
            if at.onset < LIFTED:  # otherwise an uplift is yet to be recorded
                keep(log, now, side, here, rise, motion.state)
            log.tally[EVENTS] += 1
            log.tally[UPLIFTS] += event == OPENS
            log.tally[IMPACTS] += event == CLOSES
            pass_fence(system, at, fence, stop, motion)
            if at.onset < LIFTED:
                if event == SLIPS and at_once:
                    drop_passing(log, now)
                keep(log, now, side, here, rise, motion.state)
        elif event in (CHANGES, TURNS):
            if at.onset < LIFTED:  # otherwise an uplift is yet to be recorded
                keep(log, now, side, here, rise, motion.state)
            log.tally[EVENTS] += 1
            remember(system, p, motion)
            if event == TURNS:
                motion.state[system.layout.spin] = 0.0
            enter(system, at, system.links[p, TURNED if event == TURNS else CHANGED + owner], motion)
            if at.onset < LIFTED:
                keep(log, now, side, here, rise, motion.state)
        elif tipped:
            limit = motion.limits[bound]
            log.peaks[GUARD], log.times[GUARD] = abs(limit), now
            motion.state[system.layout.rotation] = limit
            keep(log, now, side, here, rise, motion.state)
            return OVERTURNED
        elif event == LANDS:
            motion.state[system.layout.rotation] = 0.0
            keep(log, now, side, here, rise, motion.state)
            remember(system, p, motion)
            status, next_side = land(system, steps, impact, p, here, rise, motion)
            if status != CROSSED:
                return status
            log.tally[EVENTS] += 1
            log.tally[IMPACTS] += 1
            enter(system, at, system.links[p, BESIDE + beside(next_side)], motion)
            keep(log, now, next_side, here, rise, motion.state)
            at.onset = PASSING if next_side != 0.0 else INSIDE
        else:
            motion.state[system.layout.spin] = 0.0
            set_off(system, steps, at, bound, excess, motion)
            at.onset = LIFTED if excess > 0.0 else TOUCHED
            if event == RELEASES:
                keep(log, now, side, here, rise, motion.state)
        at.resume = 0.0
        at.fresh_rows = True
        if steps is not None:
            forget(steps.room)
        if log.tally[EVENTS] > MOST_EVENTS:
            return CHATTER
    at.crossing = False
    return CROSSED


@kernel
def land(
    system: System, steps: Integrator | None, impact: Impact, phase: int, ground: float, rise: float, motion: Motion
) -> tuple[int, float]:
    """Apply the impact law; return the status and the side on which the rotation continues, 0 for contact.

    The base stays in contact if the next excursion would be too short to count.
    """
    state, spin_place = motion.state, system.layout.spin
    before = kinetic_energy(impact, free_inertia(system, steps, phase, state), state)
    if not strike(impact, state):
        return BROKEN, 0.0
    spin = state[spin_place]
    if spin == 0.0:
        after = kinetic_energy(impact, 0.0, state)
        return (GAINED if after > before * (1.0 + GAIN) else CROSSED), 0.0
    next_side = 1.0 if spin > 0.0 else -1.0
    following = system.links[phase, BESIDE + beside(next_side)]
    after = kinetic_energy(impact, free_inertia(system, steps, following, state), state)
    if after > before * (1.0 + GAIN):
        return GAINED, next_side
    back = -next_side * turning_rate(system, steps, following, ground, rise, motion)
    if 2.0 * abs(spin) < back * impact.shortest:
        stick(impact, state)
        if kinetic_energy(impact, 0.0, state) > before * (1.0 + GAIN):
            return GAINED, 0.0
        return CROSSED, 0.0
    return CROSSED, next_side
