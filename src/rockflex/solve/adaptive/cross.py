"""One sample crossed in stretches: linear contact by its power series, all else by Runge-Kutta steps.

A stretch ends at the sample's end, at the first root of its guard, where a hysteretic spring turns, or where the error
control ends it. Guards, jumps and peaks are those of the exact engine, on the polynomial across the stretch.
"""

import numpy as np

from rockflex._kernel import kernel
from rockflex.models import Impact, field_rates, inertia_left, kinetic_energy, stick, strike
from rockflex.solve.adaptive.curves import is_curved, raise_curves
from rockflex.solve.adaptive.glance import nothing_hides
from rockflex.solve.adaptive.layout import TERMS, Flow, Stages
from rockflex.solve.adaptive.step import FAILED, expand_nested, extend, row_poly, settle_on, step_over, take_step
from rockflex.solve.exact.exits import contact_exit, overturning, rocking_exit
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import CONTACT, LEFT, ROCKING, SERIES, Array, Log, Scratch, System
from rockflex.solve.exact.peaks import raise_peak
from rockflex.solve.exact.probe import QUARTER_TURN
from rockflex.solve.exact.series import advance, evaluate, expand, first_descent, row_series
from rockflex.solve.exact.unit import (
    BROKEN,
    CHATTER,
    CROSSED,
    EVENTS,
    GAIN,
    GAINED,
    GUARD,
    IMPACTS,
    INSIDE,
    LIFTED,
    MOST_EVENTS,
    OVERTURNED,
    PASSING,
    RESUME,
    SNAP,
    SPENT,
    TOUCHED,
    UPLIFTS,
)

__all__ = ["STALLED", "cross"]

BARELY = 1e-300  # m/s: what a velocity is set to where it turns, for its sign
STALLED = -5  # the error control found no step short enough


@kernel
def cross(
    system: System,
    flow: Flow,
    impact: Impact,
    side: float,
    acceleration: float,
    last: float,
    slope: float,
    begun: float,
    dt: float,
    time: float,
    until: float,
    log: Log,
    room: Scratch,
    stages: Stages,
    nodes: Array,
    count: int,
) -> tuple[int, float, int]:
    """Carry `stages.motion` over the rest of the sample from `time` to `until`, of which `begun` s are done.

    Returns status, side and the count of nodes.
    """
    n = flow.field.omega2.size
    unit = float(system.steps[system.steps.size - 1])
    resistance = flow.resistance
    done, resume, lift, start = begun, 0.0, 0.0, INSIDE
    log.tally[EVENTS] = 0
    while done < dt:
        log.work[LEFT] -= log.work[SERIES]
        if log.work[LEFT] < 0.0:
            return SPENT, side, count
        phase = ROCKING if side != 0.0 else CONTACT
        here = acceleration + slope * done
        now = min(time + done, until)
        longest = dt - done
        linear = side == 0.0 and not flow.field.hysteretic
        if linear:
            # Up to one unit and a half, or what is left over might be a stretch of no length.
            step = longest if longest <= 1.5 * unit else unit
            polys = room.polys
            expand(system.physics, side != 0.0, room.state, here, slope, side, np.nan, step, room.series)
            row_series(system.plain_rows, phase, GUARD, room.series, here, slope, side, step, polys)
        else:
            step = take_step(flow, side, here, slope, longest, stages)
            if step == FAILED:
                return (SPENT if log.work[LEFT] < 0.0 else STALLED), side, count
            plain = start == INSIDE and resume == 0.0
            if plain and nothing_hides(flow, side, here, slope, step, now, log, stages):
                step_over(stages)
                done = dt if step == longest else done + step
                continue
            polys = stages.polys
            extend(flow, side, here, slope, step, stages)
            row_poly(GUARD, flow.rows[phase, GUARD], here, slope, side, step, stages)
        stages.known[0] = False  # unless the step is taken whole, below
        tips, next_side = np.inf, 0.0
        if side != 0.0:
            if start >= LIFTED:
                # θ and θ' start from zero and θ'' from what the guard says, all of them exactly.
                polys[GUARD, 0] = polys[GUARD, 1] = 0.0
                polys[GUARD, 2] = 0.5 * lift * step * step
            stop = rocking_exit(polys, side, start, 1.0)
            if stop < 0.0:
                log.tally[EVENTS] += 1
                side, start, resume = 0.0, INSIDE, RESUME
                continue
            if start >= LIFTED:
                log.tally[UPLIFTS] += 1
                log.tally[EVENTS] += 1
                count = append(nodes, count, now, 0.0, here, stages.motion)
                count = append(nodes, count, now, side, here, stages.motion)
            tips = overturning(polys, side, 1.0)
        else:
            excess = abs(polys[GUARD, 0]) - resistance
            if resume == 0.0 and excess > 0.0:
                side = -1.0 if polys[GUARD, 0] > 0.0 else 1.0
                lift, start = side * excess / inertia_left(flow.field, side, stages.motion), LIFTED
                continue
            stop, next_side = contact_exit(polys, resistance, resume, 1.0)
        tipped = tips < stop and tips < 1.0
        if tipped:
            stop = tips
        ends = not tipped and stop > 1.0 - SNAP
        if ends:
            stop = 1.0
        turns = False
        if flow.field.hysteretic:
            turn = turning(flow, stages)
            turns = turn < stop
            if turns:
                stop, ends, tipped = turn, True, False
        if side != 0.0:
            raise_peak(polys, GUARD, side, stop, now, step, log)
        if side != 0.0 and flow.field.complete:
            raise_curves(flow, side, here, slope, step, stop, now, log, stages)
        for f in range(1, log.peaks.size):
            if is_curved(flow, f, side):
                continue
            if linear:
                row_series(system.plain_rows, phase, f, room.series, here, slope, side, step, polys)
            else:
                row_poly(f, flow.rows[phase, f], here, slope, side, step, stages)
            raise_peak(polys, f, side, stop, now, step, log)
        excess = 0.0
        if not ends and side == 0.0 and resume > 0.0 and stop == resume:
            excess = max(abs(evaluate(polys, GUARD, stop)[0]) - resistance, 0.0)
        if linear:
            advance(room.series, stop, step, room.state)
        elif stop == 1.0:
            step_over(stages)
            stages.known[0] = True
        else:
            settle_on(stop, stages)
            if turns:
                stages.motion[n] = -stages.branch[0] * BARELY
        done = dt if stop == 1.0 and step == longest else done + stop * step
        start = INSIDE
        if ends:
            resume = 0.0
            continue
        here = acceleration + slope * done
        now = min(time + done, until)
        if tipped:
            log.peaks[0] = QUARTER_TURN
            log.times[0] = now
            stages.motion[2 * n] = side * QUARTER_TURN
            count = append(nodes, count, now, side, here, stages.motion)
            return OVERTURNED, side, count
        stages.motion[2 * n] = 0.0
        if side != 0.0:
            count = append(nodes, count, now, side, here, stages.motion)
            status, next_side = land(flow, impact, side, here, stages)
            if status != CROSSED:
                return status, side, count
            count = append(nodes, count, now, next_side, here, stages.motion)
            log.tally[EVENTS] += 1
            log.tally[IMPACTS] += 1
            start, resume = PASSING if next_side != 0.0 else INSIDE, 0.0
        else:
            stages.motion[2 * n + 1] = 0.0
            lift = next_side * excess / inertia_left(flow.field, next_side, stages.motion)
            start, resume = LIFTED if excess > 0.0 else TOUCHED, 0.0
        side = next_side
        if log.tally[EVENTS] > MOST_EVENTS:
            return CHATTER, side, count
    if nodes.shape[0] > 0:
        count = append(nodes, count, until, side, last, stages.motion)
    return CROSSED, side, count


@kernel
def land(flow: Flow, impact: Impact, side: float, acceleration: float, stages: Stages) -> tuple[int, float]:
    """Apply the impact law; return status and the side to which the rotation goes on, 0 for contact."""
    n = flow.field.omega2.size
    motion = stages.motion
    before = energy_of_motion(flow, impact, side, motion)
    if not strike(impact, motion):
        return BROKEN, side
    spin = motion[2 * n + 1]
    next_side = 0.0
    if spin != 0.0:
        next_side = 1.0 if spin > 0.0 else -1.0
        if energy_of_motion(flow, impact, next_side, motion) > before * (1.0 + GAIN):
            return GAINED, side
        field_rates(flow.field, next_side, 1.0, acceleration, motion, stages.rates[0])
        back = -next_side * stages.rates[0, 2 * n + 1]
        if 2.0 * abs(spin) < back * impact.shortest:
            stick(impact, motion)
            next_side = 0.0
    if energy_of_motion(flow, impact, next_side, motion) > before * (1.0 + GAIN):
        return GAINED, side
    return CROSSED, next_side


@kernel
def energy_of_motion(flow: Flow, impact: Impact, side: float, motion: Array) -> float:
    """Kinetic energy at θ = 0, with what D adds to the inertia about the pivot of this side."""
    free = flow.free_inertia if side == 0.0 else inertia_left(flow.field, side, motion)
    return kinetic_energy(impact, free, motion)


@kernel
def turning(flow: Flow, stages: Stages) -> float:
    """Where the velocity of the hysteretic spring changes its sign, and its law its branch; inf where it does not."""
    n = flow.field.omega2.size  # the place of D'_1
    work = stages.polys.shape[0] - 1
    for j in range(TERMS - 1):
        stages.polys[work, j] = stages.branch[0] * stages.bends[j, n]
    expand_nested(stages.polys, work)
    size = 0.0
    for k in range(TERMS):
        size += abs(stages.polys[work, k])
    if size == 0.0:
        return np.inf  # at rest
    stages.polys[work, 0] = abs(stages.motion[n])
    if abs(stages.motion[n]) <= BARELY:  # it has just turned; that zero is divided out
        for k in range(TERMS - 1):
            stages.polys[work, k] = stages.polys[work, k + 1]
        stages.polys[work, TERMS - 1] = 0.0
    return first_descent(stages.polys, work, 0.0, 1.0)
