"""One unit of the grid, crossed by its power series: events to machine precision, peaks, jumps.

A unit is short enough for the series about any of its points to converge at once. Its first event is the first
root of the guard's polynomial; after the jump the series starts anew, until the unit is crossed.
"""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import Array, Log, Scratch, System
from rockflex.solve.exact.probe import HALF_TURN
from rockflex.solve.exact.series import (
    ORDER,
    advance,
    bend,
    evaluate,
    expand,
    first_descent,
    row_series,
)

__all__ = ["CHATTER", "CROSSED", "IMPACTS", "OVERTURNED", "UPLIFTS", "cross_unit"]

CROSSED, OVERTURNED, CHATTER = 0, 1, -1
UPLIFTS, IMPACTS, EVENTS = 0, 1, 2  # places in the tally; EVENTS counts those of the present sample
MOST_EVENTS = 20_000  # in one sample

SNAP = 1e-10  # an event this close to a unit's end is left to the next unit, which starts on it
RESUME = 1e-7  # where contact is searched again after a guard that was touched but not passed


@kernel
def raise_peak(poly: Array, stop: float, time: float, step: float, row: int, log: Log, work: Array) -> None:
    """Raise a row's peak to the largest magnitude of its polynomial over [0, stop]."""
    peaks, highest = log.peaks, 0.0
    for u in (0.0, stop):
        value = abs(evaluate(poly, u)[0])
        highest = max(highest, value)
        if value > peaks[row]:
            peaks[row] = value
            log.times[row] = time + step * u
    if highest + bend(poly, stop) * stop * stop / 8.0 <= peaks[row]:
        return
    direction = 1.0 if poly[1] >= 0.0 else -1.0
    u = 0.0
    while True:
        for k in range(ORDER):
            work[k] = direction * (k + 1.0) * poly[k + 1]
        u = first_descent(work[:ORDER], u, stop)
        if u >= stop:
            return
        value = abs(evaluate(poly, u)[0])
        if value > peaks[row]:
            peaks[row] = value
            log.times[row] = time + step * u
        direction = -direction
        u += 1e-9


@kernel
def rocking_exit(rotation: Array, side: float, lift: float, onset: bool, span: float, work: Array) -> float:
    """Where the rotation returns to zero; -1 where it never left. At an onset its zeros at 0 are divided out."""
    zeros = 0
    if onset:
        zeros = 2 if lift != 0.0 else 3
    work[:] = 0.0
    for k in range(zeros, ORDER + 1):
        work[k - zeros] = side * rotation[k]
    if onset and work[0] <= 0.0:
        return -1.0
    if not onset and work[0] < 0.0:
        work[0] = 0.0
    return first_descent(work, 0.0, span)


@kernel
def overturning(rotation: Array, side: float, span: float, work: Array) -> float:
    """Where the rotation reaches a quarter turn; inf where it does not."""
    reach = 0.0
    for k in range(ORDER + 1):
        reach += abs(rotation[k])
        work[k] = -side * rotation[k]
    if reach < HALF_TURN:
        return np.inf
    work[0] += HALF_TURN
    return first_descent(work, 0.0, span)


@kernel
def contact_exit(
    moment: Array, resistance: float, start: float, span: float, work: Array
) -> tuple[float, float]:
    """Where the overturning moment reaches the resistance (Eq. 24), and the side it names."""
    exit_at, exit_side = np.inf, 0.0
    if math.isinf(resistance):
        return exit_at, exit_side
    for side in (1.0, -1.0):
        for k in range(ORDER + 1):
            work[k] = side * moment[k]
        work[0] += resistance
        u = first_descent(work, start, span)
        if u < exit_at:
            exit_at, exit_side = u, side
    return exit_at, exit_side


@kernel
def cross_unit(
    system: System,
    side: float,
    acceleration: float,
    slope: float,
    step: float,
    time: float,
    log: Log,
    room: Scratch,
    nodes: Array,
    count: int,
) -> tuple[int, float, Array, int]:
    """Carry `room.state` over `step` through all events; return status, side, nodes and their count."""
    physics, state, polys, work = system.physics, room.state, room.polys, room.work
    n = physics.omega2.size
    u, resume, lift, onset = 0.0, 0.0, np.nan, False
    while True:
        span = 1.0 - u
        here = acceleration + slope * step * u
        now = time + step * u
        rows = system.rocking_rows if side != 0.0 else system.contact_rows
        expand(physics, side != 0.0, state, here, slope, side, lift, step, room.series)
        for f in range(rows.shape[0]):
            row_series(rows[f], room.series, here, slope, side, step, polys[f])
        tips = np.inf
        if side != 0.0:
            stop = rocking_exit(polys[0], side, lift, onset, span, work)
            if stop < 0.0:
                side, lift, onset, resume = 0.0, np.nan, False, RESUME
                continue
            if onset:
                log.tally[UPLIFTS] += 1
                log.tally[EVENTS] += 1
                nodes, count = append(nodes, count, now, 0.0, here, state)
                nodes, count = append(nodes, count, now, side, here, state)
            tips = overturning(polys[0], side, span, work)
            next_side = 0.0
        else:
            excess = abs(polys[0, 0]) - physics.resistance
            if resume == 0.0 and excess > 0.0:
                side = -1.0 if polys[0, 0] > 0.0 else 1.0
                lift, onset = side * excess / physics.inertia, True
                continue
            stop, next_side = contact_exit(polys[0], physics.resistance, resume, span, work)
        tipped = tips < stop and tips < span
        if tipped:
            stop = tips
        ends = not tipped and stop > span - SNAP
        if ends:
            stop = span
        for f in range(0 if side != 0.0 else 1, polys.shape[0]):
            raise_peak(polys[f], stop, now, step, f, log, work)
        advance(room.series, stop, step, state)
        if ends:
            return CROSSED, side, nodes, count
        u += stop
        here = acceleration + slope * step * u
        now = time + step * u
        if tipped:
            log.peaks[0] = HALF_TURN
            log.times[0] = now
            state[2 * n] = side * HALF_TURN
            nodes, count = append(nodes, count, now, side, here, state)
            return OVERTURNED, side, nodes, count
        if side != 0.0:
            state[2 * n] = 0.0
            nodes, count = append(nodes, count, now, side, here, state)
            for i in range(n):
                state[n + i] += physics.height[i] * state[2 * n + 1]
            state[2 * n + 1] = 0.0
            nodes, count = append(nodes, count, now, 0.0, here, state)
            log.tally[IMPACTS] += 1
            lift, onset, resume = np.nan, False, 0.0
        else:
            excess = 0.0
            if resume > 0.0 and stop == resume:
                excess = max(abs(evaluate(polys[0], stop)[0]) - physics.resistance, 0.0)
            lift, onset, resume = next_side * excess / physics.inertia, True, 0.0
        side = next_side
        if log.tally[EVENTS] > MOST_EVENTS:
            return CHATTER, side, nodes, count
