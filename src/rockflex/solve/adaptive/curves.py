"""Peaks of the nonlinear ("curved") rows of a complete model while it rocks: whether one can occur, and where.

These rows are evaluated from the motion and its rates. Their own rates come from a second evaluation shortly
afterwards, which is done only for rows that are close to their peaks.
"""

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex.models import LINEAR, SWAY, VERTICAL, field_rates, observe, posture_of
from rockflex.solve.adaptive.layout import (
    AT_ENDS,
    AT_ENDS_AHEAD,
    AT_STARTS,
    AT_STARTS_AHEAD,
    END,
    END_RATES,
    PLACE,
    PLACE_RATES,
    TOLD,
    Flow,
    Stages,
)
from rockflex.solve.adaptive.step import choose_branch, place_at
from rockflex.solve.exact.probe import cubic_range
from rockflex.solve.layout import Log, Span, System, part_of
from rockflex.solve.peaks import raise_row, row_at, size_of

STRAY = 0.2
NEAR = 0.7  # fraction of its peak that a row must reach for the second evaluation
LIGHT = 0.05  # of the vertical reaction at rest: smallest scale for the loss of support
AHEAD = 1e-4  # of a step, between the two evaluations
LOOKS = 8  # evaluations across a stretch that may contain a peak
CLOSER = 4  # times that the interval around a peak is reduced to an eighth


@kernel
def is_curved(flow: Flow, f: int, side: float) -> bool:
    """Return whether a row is nonlinear at present."""
    return side != 0.0 and flow.kinds[f] != LINEAR


@inlined_kernel
def tell(
    system: System, flow: Flow, phase: int, acceleration: float, rise: float, motion: Array, rates: Array, values: Array
) -> None:
    """Compute the values of the curved rows; the last one is the loss of support, as in `Log`."""
    n, last, side = flow.field.modes.shape[1], system.plain_rows.shape[2] - 2, system.phases[phase].side
    posture = posture_of(flow.field, side, acceleration, rise, motion, rates)
    for f in range(1, values.size):
        kind = flow.kinds[f]
        if kind == LINEAR:
            continue
        value = 0.0
        if kind < VERTICAL:
            for i in range(n if kind == SWAY else last):
                value += system.plain_rows[phase, f, i] * motion[i]
        value = observe(kind, value, flow.levers[f, 0], flow.levers[f, 1], posture)
        values[f] = flow.rest - value if kind == VERTICAL else value


@kernel
def stretch(first: float, last: float, before: float, after: float) -> tuple[float, float]:
    """Return bounds of a smooth function over [0, 1] from its values and slopes at the ends."""
    slack = STRAY * (abs(last - first - before) + abs(last - first - after))
    if before * after > 0.0 and min(abs(before), abs(after)) > 8.0 * slack:  # it is monotonic
        return min(first, last), max(first, last)
    low, high = cubic_range(first, last, before, after)
    return low - slack, high + slack


@inlined_kernel
def curves_hide(
    system: System,
    flow: Flow,
    phase: int,
    span: Span,
    end: Array,
    end_rates: Array,
    log: Log,
    room: Stages,
) -> bool:
    """Return whether a curved row may have a new peak between the motion and `end`, over a span.

    Peaks at the start are recorded, because forces jump at events. The values at the end are stored in
    `room.rows[AT_ENDS]`, and `room.doubt` marks the rows in question.
    """
    there, risen = span.ground + span.slope * span.length, span.rise + span.rise_slope * span.length
    if not room.at.told:
        tell(system, flow, phase, span.ground, span.rise, room.motion, room.rates[0], room.rows[AT_STARTS])
    room.at.told = True
    tell(system, flow, phase, there, risen, end, end_rates, room.rows[AT_ENDS])
    near = False
    for f in range(1, log.peaks.size):
        room.doubt[f] = False
        if flow.kinds[f] == LINEAR:
            continue
        size = max(size_of(room.rows[AT_STARTS, f], f, log), size_of(room.rows[AT_ENDS, f], f, log))
        scale = abs(log.peaks[f])
        if flow.kinds[f] == VERTICAL:
            scale = max(scale, LIGHT * flow.rest)
        room.doubt[f] = size > log.peaks[f] - (1.0 - NEAR) * scale
        near = near or room.doubt[f]
        raise_row(f, room.rows[AT_STARTS, f], span.time, log)
    if not near:
        return False
    last = part_of(span, span.time, span.length, span.length)
    look_ahead(system, flow, phase, span, room.motion, room.rates[0], room.rows[AT_STARTS_AHEAD], room)
    look_ahead(system, flow, phase, last, end, end_rates, room.rows[AT_ENDS_AHEAD], room)
    hidden = False
    for f in range(1, log.peaks.size):
        if room.doubt[f]:
            first, last = room.rows[AT_STARTS, f], room.rows[AT_ENDS, f]
            before, after = (
                (room.rows[AT_STARTS_AHEAD, f] - first) / AHEAD,
                (room.rows[AT_ENDS_AHEAD, f] - last) / AHEAD,
            )
            low, high = stretch(first, last, before, after)
            known = max(log.peaks[f], size_of(last, f, log))
            room.doubt[f] = max(size_of(low, f, log), size_of(high, f, log)) > known
            hidden = hidden or room.doubt[f]
    return hidden


@inlined_kernel
def look_ahead(
    system: System,
    flow: Flow,
    phase: int,
    span: Span,
    motion: Array,
    rates: Array,
    values: Array,
    room: Stages,
) -> None:
    """Compute the values of the curved rows shortly after the start of a stretch."""
    later = span.ground + span.slope * AHEAD * span.length
    rise = span.rise + span.rise_slope * AHEAD * span.length
    for i in range(motion.size):
        room.vectors[PLACE, i] = motion[i] + AHEAD * span.length * rates[i]
    place, rates = room.vectors[PLACE], room.vectors[PLACE_RATES]
    field_rates(flow.field, system.phases[phase].side, room.at.branch, later, rise, place, rates)
    tell(system, flow, phase, later, rise, place, rates, values)


@kernel
def raise_curves(system: System, flow: Flow, phase: int, span: Span, stop: float, log: Log, room: Stages) -> None:
    """Raise the peaks of all curved rows over [0, stop] of the step whose extension is in `room.bends`."""
    side, length = system.phases[phase].side, span.length * stop
    place_at(stop, room, room.vectors[END])
    ground, rise = span.ground + span.slope * length, span.rise + span.rise_slope * length
    end, rates = room.vectors[END], room.vectors[END_RATES]
    field_rates(flow.field, side, room.at.branch, ground, rise, end, rates)
    hidden = curves_hide(system, flow, phase, part_of(span, span.time, 0.0, length), end, rates, log, room)
    for f in range(1, log.peaks.size):
        if is_curved(flow, f, side):
            raise_row(f, room.rows[AT_ENDS, f], span.time + length, log)
            if hidden and room.doubt[f]:
                raise_curve(system, flow, phase, f, span, stop, log, room)


@kernel
def raise_curve(
    system: System, flow: Flow, phase: int, f: int, span: Span, stop: float, log: Log, room: Stages
) -> None:
    """Raise one curved row's peak to its largest size over [0, stop]."""
    best, where = -np.inf, 0.0
    for k in range(LOOKS + 1):
        u = stop * k / LOOKS
        size = size_of(curve_at(system, flow, phase, f, u, span, room), f, log)
        if size > best:
            best, where = size, u
    width = stop / LOOKS
    for _ in range(CLOSER):
        middle = min(max(where, width), stop - width)
        left = size_of(curve_at(system, flow, phase, f, middle - width, span, room), f, log)
        centre = size_of(curve_at(system, flow, phase, f, middle, span, room), f, log)
        right = size_of(curve_at(system, flow, phase, f, middle + width, span, room), f, log)
        bend = left - 2.0 * centre + right
        if bend >= 0.0:
            break
        u = middle + width * min(max(0.5 * (left - right) / bend, -1.0), 1.0)
        size = size_of(curve_at(system, flow, phase, f, u, span, room), f, log)
        if size > best:
            best, where = size, u
        width *= 0.125
    raise_row(f, curve_at(system, flow, phase, f, where, span, room), span.time + span.length * where, log)


@kernel
def curve_at(system: System, flow: Flow, phase: int, f: int, u: float, span: Span, room: Stages) -> float:
    """Return the value of a curved row at the fraction `u` of a step."""
    ground, rise = span.ground + span.slope * span.length * u, span.rise + span.rise_slope * span.length * u
    place, rates = room.vectors[PLACE], room.vectors[PLACE_RATES]
    place_at(u, room, place)
    field_rates(flow.field, system.phases[phase].side, room.at.branch, ground, rise, place, rates)
    tell(system, flow, phase, ground, rise, place, rates, room.rows[TOLD])
    return room.rows[TOLD, f]


@kernel
def values_of_rows(system: System, flow: Flow, phase: int, ground: float, rise: float, room: Stages) -> None:
    """Compute all rows for the present motion, at the start of a stretch of acceleration, in `room.rows[TOLD]`."""
    side, rows = system.phases[phase].side, system.plain_rows
    if flow.field.hysteretic:
        choose_branch(flow, side, ground, rise, room)
    field_rates(flow.field, side, room.at.branch, ground, rise, room.motion, room.rates[0])
    if side != 0.0 and flow.field.complete:
        tell(system, flow, phase, ground, rise, room.motion, room.rates[0], room.rows[TOLD])
    for f in range(room.rows.shape[1]):
        if not is_curved(flow, f, side):
            room.rows[TOLD, f] = row_at(rows, phase, f, ground, room.motion)
            if rise != 0.0:
                room.rows[TOLD, f] += rise * row_at(system.heavier_rows, phase, f, ground, room.motion)
