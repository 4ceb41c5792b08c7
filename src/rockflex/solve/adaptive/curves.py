"""Rows of a complete model that are no linear functionals while it rocks: whether they hide a peak, and where it is.

They are told at any instant from the motion and its rates, and have their own rates from a second look a little later,
which only those that come near their peaks are given.
"""

import numpy as np

from rockflex._kernel import kernel
from rockflex.models import LINEAR, SWAY, VERTICAL, field_rates, observe, posture_of
from rockflex.solve.adaptive.layout import Flow, Stages
from rockflex.solve.adaptive.step import place_at
from rockflex.solve.exact.layout import ROCKING, Array, Log
from rockflex.solve.exact.peaks import raise_row, size_of
from rockflex.solve.exact.probe import cubic_range

__all__ = ["curves_hide", "is_curved", "raise_curves", "stretch", "tell"]

STRAY = 0.2
NEAR = 0.7  # of its peak: what a row must come near to be looked at twice
LIGHT = 0.05  # of the vertical reaction at rest: a smaller loss of support is no measure of what is near
AHEAD = 1e-4  # of a step, to the second look
LOOKS = 8  # across a stretch that may hide a peak
CLOSER = 4  # times that the look at a peak is narrowed to an eighth


@kernel
def is_curved(flow: Flow, f: int, side: float) -> bool:
    """Whether a row is no linear functional now."""
    return side != 0.0 and flow.kinds[f] != LINEAR


@kernel
def tell(flow: Flow, side: float, acceleration: float, motion: Array, rates: Array, values: Array) -> None:
    """Fill in the values of the curved rows; of the last one, as in `Log`, the loss of support times the side."""
    n, last = flow.field.omega2.size, flow.rows.shape[2] - 2
    posture = posture_of(flow.field, side, acceleration, motion, rates)
    for f in range(1, values.size):
        kind = flow.kinds[f]
        if kind == LINEAR:
            continue
        value = 0.0
        if kind < VERTICAL:
            for i in range(n if kind == SWAY else last):
                value += flow.rows[ROCKING, f, i] * motion[i]
        value = observe(kind, value, flow.levers[f, 0], flow.levers[f, 1], posture)
        values[f] = side * (flow.rest - value) if kind == VERTICAL else value


@kernel
def stretch(first: float, last: float, before: float, after: float) -> tuple[float, float]:
    """Least and largest value that a smooth function may have over [0, 1], from its values and slopes at the ends."""
    slack = STRAY * (abs(last - first - before) + abs(last - first - after))
    if before * after > 0.0 and min(abs(before), abs(after)) > 8.0 * slack:  # it rises or falls all along
        return min(first, last), max(first, last)
    low, high = cubic_range(first, last, before, after)
    return low - slack, high + slack


@kernel
def curves_hide(
    flow: Flow,
    side: float,
    here: float,
    slope: float,
    step: float,
    time: float,
    end: Array,
    end_rates: Array,
    log: Log,
    room: Stages,
) -> bool:
    """Whether a curved row may hide a new peak between the motion and `end`, `step` seconds later.

    The peaks at the start are noted, for forces jump at events; the values at the end are left in `room.ends`, and
    `room.doubt` marks the rows in question.
    """
    there = here + slope * step
    if not room.told[0]:
        tell(flow, side, here, room.motion, room.rates[0], room.starts)
    room.told[0] = True
    tell(flow, side, there, end, end_rates, room.ends)
    near = False
    for f in range(1, log.peaks.size):
        room.doubt[f] = False
        if flow.kinds[f] == LINEAR:
            continue
        size = max(size_of(room.starts[f], f, side, log), size_of(room.ends[f], f, side, log))
        scale = abs(log.peaks[f])
        if flow.kinds[f] == VERTICAL:
            scale = max(scale, LIGHT * flow.rest)
        room.doubt[f] = size > log.peaks[f] - (1.0 - NEAR) * scale
        near = near or room.doubt[f]
        raise_row(f, room.starts[f], side, time, log)
    if not near:
        return False
    look_ahead(flow, side, here, slope, step, room.motion, room.rates[0], room.starts_ahead, room)
    look_ahead(flow, side, there, slope, step, end, end_rates, room.ends_ahead, room)
    hidden = False
    for f in range(1, log.peaks.size):
        if room.doubt[f]:
            first, last = room.starts[f], room.ends[f]
            before, after = (room.starts_ahead[f] - first) / AHEAD, (room.ends_ahead[f] - last) / AHEAD
            low, high = stretch(first, last, before, after)
            known = max(log.peaks[f], size_of(last, f, side, log))
            room.doubt[f] = max(size_of(low, f, side, log), size_of(high, f, side, log)) > known
            hidden = hidden or room.doubt[f]
    return hidden


@kernel
def look_ahead(
    flow: Flow,
    side: float,
    acceleration: float,
    slope: float,
    step: float,
    motion: Array,
    rates: Array,
    values: Array,
    room: Stages,
) -> None:
    """Values of the curved rows a little later."""
    later = acceleration + slope * AHEAD * step
    for i in range(motion.size):
        room.place[i] = motion[i] + AHEAD * step * rates[i]
    field_rates(flow.field, side, room.branch[0], later, room.place, room.place_rates)
    tell(flow, side, later, room.place, room.place_rates, values)


@kernel
def raise_curves(
    flow: Flow,
    side: float,
    here: float,
    slope: float,
    step: float,
    stop: float,
    time: float,
    log: Log,
    room: Stages,
) -> None:
    """Raise the peaks of all curved rows over [0, stop] of the step whose extension is in `room.bends`."""
    place_at(stop, room, room.end)
    field_rates(flow.field, side, room.branch[0], here + slope * step * stop, room.end, room.end_rates)
    hidden = curves_hide(flow, side, here, slope, step * stop, time, room.end, room.end_rates, log, room)
    for f in range(1, log.peaks.size):
        if is_curved(flow, f, side):
            raise_row(f, room.ends[f], side, time + step * stop, log)
            if hidden and room.doubt[f]:
                raise_curve(flow, f, side, here, slope, step, stop, time, log, room)


@kernel
def raise_curve(
    flow: Flow,
    f: int,
    side: float,
    here: float,
    slope: float,
    step: float,
    stop: float,
    time: float,
    log: Log,
    room: Stages,
) -> None:
    """Raise one curved row's peak to its largest size over [0, stop]."""
    best, where = -np.inf, 0.0
    for k in range(LOOKS + 1):
        u = stop * k / LOOKS
        size = size_of(curve_at(flow, f, u, side, here, slope, step, room), f, side, log)
        if size > best:
            best, where = size, u
    width = stop / LOOKS
    for _ in range(CLOSER):
        middle = min(max(where, width), stop - width)
        left = size_of(curve_at(flow, f, middle - width, side, here, slope, step, room), f, side, log)
        centre = size_of(curve_at(flow, f, middle, side, here, slope, step, room), f, side, log)
        right = size_of(curve_at(flow, f, middle + width, side, here, slope, step, room), f, side, log)
        bend = left - 2.0 * centre + right
        if bend >= 0.0:
            break
        u = middle + width * min(max(0.5 * (left - right) / bend, -1.0), 1.0)
        size = size_of(curve_at(flow, f, u, side, here, slope, step, room), f, side, log)
        if size > best:
            best, where = size, u
        width *= 0.125
    raise_row(f, curve_at(flow, f, where, side, here, slope, step, room), side, time + step * where, log)


@kernel
def curve_at(flow: Flow, f: int, u: float, side: float, here: float, slope: float, step: float, room: Stages) -> float:
    """Value of a curved row at the fraction `u` of a step."""
    acceleration = here + slope * step * u
    place_at(u, room, room.place)
    field_rates(flow.field, side, room.branch[0], acceleration, room.place, room.place_rates)
    tell(flow, side, acceleration, room.place, room.place_rates, room.values)
    return room.values[f]
