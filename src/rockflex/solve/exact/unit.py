"""One unit of the grid, crossed by its power series: events to machine precision, peaks, jumps.

A unit is short enough for the series about any of its points to converge at once. Its first event is the first
root of the guard's polynomial; after the jump the series starts anew, until the unit is crossed.
"""

import numpy as np

from rockflex._kernel import kernel
from rockflex.models import Impact, kinetic_energy, stick, strike
from rockflex.solve.exact.exits import contact_exit, overturning, rocking_exit
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import CONTACT, LEFT, ROCKING, SERIES, ZERO, Array, Log, Physics, Scratch, System
from rockflex.solve.exact.peaks import raise_peak, raise_to
from rockflex.solve.exact.probe import QUARTER_TURN
from rockflex.solve.exact.series import advance, evaluate, expand, row_series

__all__ = [
    "BROKEN",
    "CHATTER",
    "CROSSED",
    "EVENTS",
    "GAINED",
    "IMPACTS",
    "OVERTURNED",
    "SPENT",
    "UPLIFTS",
    "cross_unit",
]

CROSSED, OVERTURNED, CHATTER, GAINED, BROKEN, SPENT = 0, 1, -1, -3, -4, -6
UPLIFTS, IMPACTS, EVENTS = 0, 1, 2  # places in the tally; EVENTS counts those of the present sample
MOST_EVENTS = 20_000  # in one sample

# How a rotation that starts within the unit leaves zero: the order of its first term there.
INSIDE, PASSING, LIFTED, TOUCHED = 0, 1, 2, 3

GUARD = ZERO  # the row of the guard
GAIN = 1e-9  # of the energy before an impact, that rounding may add
SNAP = 1e-10  # an event this close to a unit's end is left to the next unit, which starts on it
RESUME = 1e-7  # where contact is searched again after a guard that was touched but not passed


@kernel
def cross_unit(
    system: System,
    impact: Impact,
    side: float,
    acceleration: float,
    slope: float,
    step: float,
    time: float,
    until: float,
    log: Log,
    room: Scratch,
    nodes: Array,
    count: int,
) -> tuple[int, float, int]:
    """Carry `room.state` over `step`, from `time` to `until`, through all events.

    Returns status, side and the count of nodes.
    """
    n = system.physics.omega2.size
    resistance, inertia = system.physics.resistance, system.physics.inertia
    u, resume, lift, start = 0.0, 0.0, np.nan, INSIDE
    probed = True  # `room.doubt` speaks of the motion up to the first event only
    while True:
        log.work[LEFT] -= log.work[SERIES]
        phase = ROCKING if side != 0.0 else CONTACT
        span = 1.0 - u
        here = acceleration + slope * step * u
        now = min(time + step * u, until)  # rounding must not put an event behind the sample
        expand(system.physics, side != 0.0, room.state, here, slope, side, lift, step, room.series)
        row_series(system.plain_rows, phase, GUARD, room.series, here, slope, side, step, room.polys)
        tips, next_side = np.inf, 0.0
        if side != 0.0:
            stop = rocking_exit(room.polys, side, start, span)
            if stop < 0.0:
                log.tally[EVENTS] += 1
                side, lift, start, resume, probed = 0.0, np.nan, INSIDE, RESUME, False
                continue
            if start >= LIFTED:
                log.tally[UPLIFTS] += 1
                log.tally[EVENTS] += 1
                count = append(nodes, count, now, 0.0, here, room.state)
                count = append(nodes, count, now, side, here, room.state)
            tips = overturning(room.polys, side, span)
        else:
            excess = abs(room.polys[0, 0]) - resistance
            if resume == 0.0 and excess > 0.0:
                side = -1.0 if room.polys[0, 0] > 0.0 else 1.0
                lift, start, probed = side * excess / inertia, LIFTED, False
                continue
            stop, next_side = contact_exit(room.polys, resistance, resume, span)
        tipped = tips < stop and tips < span
        if tipped:
            stop = tips
        ends = not tipped and stop > span - SNAP
        if ends:
            stop = span
        if side != 0.0:
            raise_peak(room.polys, GUARD, side, stop, now, step, log)
        advance(room.series, stop, step, room.state)
        for f in range(1, log.peaks.size):
            if not probed or room.doubt[f]:
                row_series(system.plain_rows, phase, f, room.series, here, slope, side, step, room.polys)
                raise_peak(room.polys, f, side, stop, now, step, log)
            else:
                there = here + slope * step * stop
                raise_to(system.plain_rows, phase, f, there, side, now + step * stop, log, room)
        if ends:
            return CROSSED, side, count
        u += stop
        here = acceleration + slope * step * u
        now = min(time + step * u, until)
        if tipped:
            log.peaks[0] = QUARTER_TURN
            log.times[0] = now
            room.state[2 * n] = side * QUARTER_TURN
            count = append(nodes, count, now, side, here, room.state)
            return OVERTURNED, side, count
        room.state[2 * n] = 0.0
        if side != 0.0:
            count = append(nodes, count, now, side, here, room.state)
            energy = kinetic_energy(impact, inertia, room.state)
            if not strike(impact, room.state):
                return BROKEN, side, count
            if kinetic_energy(impact, inertia, room.state) > energy * (1.0 + GAIN):
                return GAINED, side, count
            log.tally[EVENTS] += 1
            next_side = outward(system.physics, impact, here, room.state)
            count = append(nodes, count, now, next_side, here, room.state)
            log.tally[IMPACTS] += 1
            lift, start, resume = np.nan, PASSING if next_side != 0.0 else INSIDE, 0.0
        else:
            room.state[2 * n + 1] = 0.0
            excess = 0.0
            if resume > 0.0 and stop == resume:
                excess = max(abs(evaluate(room.polys, GUARD, stop)[0]) - resistance, 0.0)
            lift, start, resume = next_side * excess / inertia, LIFTED if excess > 0.0 else TOUCHED, 0.0
        side, probed = next_side, False
        if log.tally[EVENTS] > MOST_EVENTS:
            return CHATTER, side, count


@kernel
def outward(physics: Physics, impact: Impact, acceleration: float, state: Array) -> float:
    """Side to which the rotation goes on after an impact; 0 once its next excursion would be too short to count."""
    n = physics.omega2.size
    spin = state[2 * n + 1]
    if spin == 0.0:
        return 0.0
    side = 1.0 if spin > 0.0 else -1.0
    moment = physics.drive_arm * acceleration - side * physics.resistance
    for i in range(n):
        restoring = physics.damping[i] * state[n + i] + physics.omega2[i] * state[i]
        moment += physics.mass[i] * physics.height[i] * restoring
    back = -side * moment / physics.inertia
    if 2.0 * abs(spin) < back * impact.shortest:
        stick(impact, state)
        return 0.0
    return side
