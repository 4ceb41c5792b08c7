"""Peaks of the nonlinear ("curved") rows of a complete model while it rocks: whether one can occur, and where.

These rows are evaluated from the motion and its rates, which a step has at both ends. At two stages between them the
rates are known, too; the rows that are close to their peaks are evaluated there as well.
"""

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex.engine.tableau import C
from rockflex.models import LINEAR, SWAY, VERTICAL, field_rates, observe, posture_of
from rockflex.solve.adaptive.layout import (
    AT_EARLY,
    AT_ENDS,
    AT_LATE,
    AT_STARTS,
    END,
    END_RATES,
    PLACE,
    PLACE_RATES,
    TOLD,
    Flow,
    Stages,
)
from rockflex.solve.adaptive.step import choose_branch, place_at
from rockflex.solve.adaptive.sums import place_stage
from rockflex.solve.exact.probe import cubic_range
from rockflex.solve.layout import Log, Span, System, part_of
from rockflex.solve.peaks import NEAR, raise_row, row_at, size_of

STRAY = 0.2
LIGHT = 0.05  # of the vertical reaction at rest: smallest scale for the loss of support
EARLY, LATE = 7, 8  # the stages in between
WHOLE = -1.0  # instead of a part of a step: all of it, before its extension is computed
LOOKS = 4  # evaluations across a stretch that may contain a peak
CLOSER = 3  # times that the interval around a peak is reduced to an eighth


def _slopes(at: float) -> tuple[float, ...]:
    """Return the slope at a place of the cubics that are 1 at the start, early, late or at the end, 0 at the others."""
    nodes = np.array([0.0, C[EARLY], C[LATE], 1.0])
    cubics = np.linalg.inv(np.vander(nodes, increasing=True))  # coefficients in the columns
    return tuple((np.array([0.0, 1.0, 2.0 * at, 3.0 * at * at]) @ cubics).tolist())


AT_START, AT_END = _slopes(0.0), _slopes(1.0)


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
    stop: float,
    log: Log,
    room: Stages,
) -> bool:
    """Return whether a curved row may have a new peak between the motion and `end`, over a span.

    The span is the fraction `stop` of a step with a continuous extension, or the step itself if it is `WHOLE`. Peaks at
    the start are recorded, because forces jump at events. The values at the end are stored in `room.rows[AT_ENDS]`, and
    `room.doubt` marks the rows in question.
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
    tell_between(system, flow, phase, EARLY, span, stop, room.rows[AT_EARLY], room)
    tell_between(system, flow, phase, LATE, span, stop, room.rows[AT_LATE], room)
    hidden = False
    for f in range(1, log.peaks.size):
        if room.doubt[f]:
            first, last = room.rows[AT_STARTS, f], room.rows[AT_ENDS, f]
            early, late = room.rows[AT_EARLY, f], room.rows[AT_LATE, f]
            before = AT_START[0] * first + AT_START[1] * early + AT_START[2] * late + AT_START[3] * last
            after = AT_END[0] * first + AT_END[1] * early + AT_END[2] * late + AT_END[3] * last
            low, high = stretch(first, last, before, after)
            known = max(log.peaks[f], size_of(last, f, log))
            room.doubt[f] = max(size_of(low, f, log), size_of(high, f, log)) > known
            hidden = hidden or room.doubt[f]
    return hidden


@kernel
def tell_between(
    system: System, flow: Flow, phase: int, stage: int, span: Span, stop: float, values: Array, room: Stages
) -> None:
    """Compute the values of the curved rows at one of the two places inside a span."""
    length = C[stage] * span.length
    ground, rise = span.ground + span.slope * length, span.rise + span.rise_slope * length
    place = room.vectors[PLACE]
    if stop == WHOLE:
        place_stage(stage, span.length, room.motion, room.rates, place, flow.moving)
        for i in range(flow.moving, room.motion.size):
            place[i] = room.motion[i]
        tell(system, flow, phase, ground, rise, place, room.rates[stage], values)
        return
    place_at(C[stage] * stop, room, place)
    rates = room.vectors[PLACE_RATES]
    field_rates(flow.field, system.phases[phase].side, room.at.branch, ground, rise, place, rates)
    tell(system, flow, phase, ground, rise, place, rates, values)


@kernel
def raise_curves(system: System, flow: Flow, phase: int, span: Span, stop: float, log: Log, room: Stages) -> None:
    """Raise the peaks of all curved rows over [0, stop] of the step whose extension is in `room.bends`."""
    side, length = system.phases[phase].side, span.length * stop
    place_at(stop, room, room.vectors[END])
    ground, rise = span.ground + span.slope * length, span.rise + span.rise_slope * length
    end, rates = room.vectors[END], room.vectors[END_RATES]
    field_rates(flow.field, side, room.at.branch, ground, rise, end, rates)
    hidden = curves_hide(system, flow, phase, part_of(span, span.time, 0.0, length), end, rates, stop, log, room)
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
    width = stop / LOOKS
    left = centre = right = size = -np.inf  # around the best place, where they are known
    for k in range(LOOKS + 1):
        before, size = size, size_of(curve_at(system, flow, phase, f, width * k, span, room), f, log)
        if size > best:
            best, where, left, centre, right = size, width * k, before, size, -np.inf
        elif where == width * (k - 1):
            right = size
    for _ in range(CLOSER):
        middle = min(max(where, width), stop - width)
        if left == -np.inf or middle != where:
            left = size_of(curve_at(system, flow, phase, f, middle - width, span, room), f, log)
        if middle != where:
            centre = size_of(curve_at(system, flow, phase, f, middle, span, room), f, log)
        if right == -np.inf or middle != where:
            right = size_of(curve_at(system, flow, phase, f, middle + width, span, room), f, log)
        bend = left - 2.0 * centre + right
        if bend >= 0.0:
            break
        u = middle + width * min(max(0.5 * (left - right) / bend, -1.0), 1.0)
        size = size_of(curve_at(system, flow, phase, f, u, span, room), f, log)
        if size > best:
            best, where = size, u
        left, centre, right = -np.inf, best, -np.inf
        width *= 0.125
    raise_row(f, best, span.time + span.length * where, log)


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
