"""One step of the Runge-Kutta pair, and the polynomial over it."""

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex._weighted import weigh
from rockflex.engine.tableau import DENSE, ERROR_3, ERROR_5, LAST, STAGES, C
from rockflex.models import field_rates, stage_rates
from rockflex.solve.adaptive.layout import (
    AT_ENDS,
    AT_STARTS,
    PLACE,
    PLACE_RATES,
    ROW_TERMS,
    TERMS,
    TRIAL,
    Flow,
    Stages,
)
from rockflex.solve.adaptive.sums import place_others, place_stage
from rockflex.solve.layout import LEFT, STEP, Span, System, is_shaken

SHORTEST = 1e-13  # s: if a shorter step is needed, the motion cannot be integrated
FAILED = -1.0
COARSE, FINE = 0, 1
ERRORS = np.stack((ERROR_3, ERROR_5))
SAFETY, LEAST, MOST = 0.9, 0.2, 4.0  # of the error control


@inlined_kernel
def take_step(flow: Flow, side: float, rest: Span, room: Stages) -> float:
    """Try steps of at most `rest` until one is accurate; return its length, or `FAILED`.

    `room.vectors[TRIAL]` contains the end of the step, `room.rates` the stages up to it. The work limit is checked only
    between steps, because interrupting the attempts at a step would lose their information. A step that has been tried
    is not repeated.
    """
    if room.at.tried:
        room.at.tried = False
        return float(room.at.length)
    longest = rest.length
    step = min(room.at.step, longest)
    if not room.at.known:
        room.at.told = False
        if flow.field.hysteretic:
            choose_branch(flow, side, rest.ground, rest.rise, room)
        field_rates(flow.field, side, room.at.branch, rest.ground, rest.rise, room.motion, room.rates[0])
    room.at.known = True
    most = MOST
    while True:
        room.work[LEFT] -= room.work[STEP]
        for stage in range(1, LAST + 1):
            place_stage(stage, step, room.motion, room.rates, room.vectors[TRIAL], flow.moving)
            stage_rates(
                flow.field,
                side,
                room.at.branch,
                rest.ground + rest.slope * step * C[stage],
                rest.rise + rest.rise_slope * step * C[stage],
                room.vectors[TRIAL],
                room.rates[stage],
            )
        error = error_of(flow, step, room)
        if error <= 1.0:
            place_others(step, room.motion, room.rates, room.vectors[TRIAL], flow.moving, flow.counted)
            # A step shortened by a sample or an event gives little information about the next one.
            if step < longest:
                room.at.step = grown(step, most, error)
            elif room.at.step < step * most:
                room.at.step = max(grown(step, most, error), room.at.step)
            return step
        most = 1.0
        shrunk = max(LEAST, SAFETY * error**-0.125) if error < np.inf else LEAST
        step *= shrunk
        room.at.step = step
        if not step > SHORTEST:
            return FAILED


@kernel
def grown(step: float, most: float, error: float) -> float:
    """Return the length of the next step, at most `most` times this one."""
    if error == 0.0:
        return step * most
    return step * min(most, SAFETY / np.sqrt(np.sqrt(np.sqrt(error))))  # faster than a power


@inlined_kernel
def choose_branch(flow: Flow, side: float, acceleration: float, rise: float, room: Stages) -> None:
    """Set the branch of the hysteresis to the sign of the velocity or, if that is zero, of its rate."""
    n = flow.field.modes.shape[1]
    velocity = room.motion[n]
    if velocity == 0.0:
        field_rates(flow.field, side, 1.0, acceleration, rise, room.motion, room.rates[0])
        velocity = room.rates[0, n]
    room.at.branch = 1.0 if velocity >= 0.0 else -1.0


@inlined_kernel
def error_of(flow: Flow, step: float, room: Stages) -> float:
    """Return the error norm of the step relative to the tolerance; infinite if the step overflowed."""
    fifth = third = 0.0
    weigh(room.vectors[PLACE], 1.0, ERRORS, COARSE, room.rates, 5, LAST, flow.moving)
    weigh(room.vectors[PLACE_RATES], 1.0, ERRORS, FINE, room.rates, 5, LAST, flow.moving)
    for i in range(flow.moving):
        size = 1.0 / max(room.size[i], abs(room.motion[i]), abs(room.vectors[TRIAL, i]), flow.scale[i])
        coarse, fine = room.vectors[PLACE, i] * size, room.vectors[PLACE_RATES, i] * size
        fifth += fine * fine  # as a power it would be a loop
        third += coarse * coarse
    if fifth == 0.0:
        return 0.0
    error = abs(step) * fifth / np.sqrt((fifth + 0.01 * third) * flow.scale.size) / flow.tolerance
    return error if np.isfinite(error) else np.inf


@inlined_kernel
def extend(flow: Flow, side: float, span: Span, room: Stages) -> None:
    """Compute `room.bends`, the continuous extension of the accepted step."""
    step = span.length
    for stage in range(LAST + 1, STAGES):
        place_stage(stage, step, room.motion, room.rates, room.bends[0], flow.moving)
        field_rates(
            flow.field,
            side,
            room.at.branch,
            span.ground + span.slope * step * C[stage],
            span.rise + span.rise_slope * step * C[stage],
            room.bends[0],
            room.rates[stage],
        )
    for i in range(flow.counted):
        rise = room.vectors[TRIAL, i] - room.motion[i]
        room.bends[0, i] = rise
        room.bends[1, i] = step * room.rates[0, i] - rise
        room.bends[2, i] = 2.0 * rise - step * (room.rates[0, i] + room.rates[LAST, i])
    # All entries, with or without energies: another number of them could be summed, and so rounded, in another way.
    for j in range(4):
        weigh(room.bends[3 + j], step, DENSE, j, room.rates, 5, STAGES, room.motion.size)


@kernel
def forget(room: Stages) -> None:
    """Record that the motion changed after the last step, so that its rates are not known."""
    room.at.known = room.at.tried = False


@inlined_kernel
def step_over(room: Stages) -> None:
    """Replace the motion at the start of the step by that at its end."""
    for i in range(room.motion.size):
        room.motion[i] = room.vectors[TRIAL, i]
        room.rates[0, i] = room.rates[LAST, i]
    for i in range(room.size.size):
        room.size[i] = max(room.size[i], abs(room.motion[i]))
    for f in range(room.rows.shape[1]):
        room.rows[AT_STARTS, f] = room.rows[AT_ENDS, f]


@kernel
def settle_on(u: float, room: Stages) -> None:
    """Replace the motion at the start of the step by that at the fraction `u`."""
    place_at(u, room, room.motion)
    forget(room)


@kernel
def place_at(u: float, room: Stages, place: Array) -> None:
    """Compute the motion at the fraction `u` of the step."""
    v = 1.0 - u
    for i in range(room.motion.size):
        value = room.bends[5, i] + u * room.bends[6, i]
        value = room.bends[3, i] + u * (room.bends[4, i] + v * value)
        value = room.bends[0, i] + v * (room.bends[1, i] + u * (room.bends[2, i] + v * value))
        place[i] = room.motion[i] + u * value


@inlined_kernel
def row_poly(system: System, phase: int, row: int, span: Span, room: Stages) -> None:
    """Compute the coefficients of one row over the step, with time in units of the step, in `room.polys[row]`."""
    combine(system.plain_rows, phase, row, row, span, room)
    if not is_shaken(span):
        return
    polys, work = room.polys, room.polys.shape[0] - 1
    combine(system.heavier_rows, phase, row, work, span, room)
    for k in range(TERMS, 0, -1):
        polys[row, k] += span.rise * polys[work, k] + span.rise_slope * span.length * polys[work, k - 1]
    polys[row, 0] += span.rise * polys[work, 0]


@kernel
def combine(rows: Array, phase: int, row: int, place: int, span: Span, room: Stages) -> None:
    """Compute the coefficients of one of `rows` in `room.polys[place]`, without vertical acceleration."""
    polys = room.polys
    n = rows.shape[2] - 2
    start = rows[phase, row, n] * span.ground + rows[phase, row, n + 1]
    for k in range(ROW_TERMS):
        polys[place, k] = 0.0
    for i in range(n):
        weight = rows[phase, row, i]
        if weight != 0.0:
            start += weight * room.motion[i]
            for j in range(TERMS - 1):
                polys[place, j] += weight * room.bends[j, i]
    expand_nested(polys, place)
    polys[place, 0] = start
    polys[place, 1] += rows[phase, row, n] * span.slope * span.length


@kernel
def expand_nested(polys: Array, row: int) -> None:
    """Expand u (F_0 + v (F_1 + u (F_2 + v (F_3 + u (F_4 + v (F_5 + u F_6)))))), v = 1 - u, into powers of u."""
    f0, f1, f2, f3 = polys[row, 0], polys[row, 1], polys[row, 2], polys[row, 3]
    f4, f5, f6 = polys[row, 4], polys[row, 5], polys[row, 6]
    # From the inside outwards: a + v (b + u c + ...) one after the other.
    a0, a1, a2 = f5, f6, 0.0
    b0, b1, b2 = f4 + a0, a1 - a0, a2 - a1  # F_4 + v (F_5 + u F_6)
    c0, c1, c2, c3 = f3, b0, b1, b2  # F_3 + u (...)
    d0, d1, d2, d3, d4 = f2 + c0, c1 - c0, c2 - c1, c3 - c2, -c3  # F_2 + v (...)
    e0, e1, e2, e3, e4, e5 = f1, d0, d1, d2, d3, d4  # F_1 + u (...)
    polys[row, 0] = 0.0
    polys[row, 1] = f0 + e0
    polys[row, 2] = e1 - e0
    polys[row, 3] = e2 - e1
    polys[row, 4] = e3 - e2
    polys[row, 5] = e4 - e3
    polys[row, 6] = e5 - e4
    polys[row, 7] = -e5
