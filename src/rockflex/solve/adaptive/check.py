"""Checks whether an event or a new peak can occur inside a step, before its continuous extension is computed.

Every row is compared with the cubic through its values and slopes at both ends. In a step accepted by the error control
the phase of no mode advances by more than about a radian. Over this range a row deviates from the cubic by a few
hundredths of the curvature of the cubic (for a harmonic of ω: (ωh)²/48); a fifth of the curvature is allowed for.
"""

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex.engine.tableau import LAST
from rockflex.solve.adaptive.curves import WHOLE, curves_hide, is_curved, stretch
from rockflex.solve.adaptive.layout import AT_ENDS, TRIAL, Flow, Stages
from rockflex.solve.layout import GUARD, HIGH, LOW, Log, Span, System, heavier_limits, is_shaken
from rockflex.solve.peaks import NEAR, is_far, raise_peaks, size_of


@kernel
def turn_hides(system: System, phase: int, step: float, room: Stages) -> bool:
    """Return whether the rotation may turn back inside the step, which ends the yielding of elements."""
    spin, sign = system.layout.spin, system.phases[phase].turns * system.phases[phase].side
    first, last = sign * room.motion[spin], sign * room.vectors[TRIAL, spin]
    before, after = sign * room.rates[0, spin], sign * room.rates[LAST, spin]
    return stretch(first, last, step * before, step * after)[0] <= 0.0


@kernel
def heavier_ends(system: System, phase: int, row: int, span: Span, room: Stages) -> tuple[float, float, float, float]:
    """Return what 1 m/s² of vertical acceleration adds to a row at both ends of a step, and the rates of that."""
    rows = system.heavier_rows
    n = rows.shape[2] - 2
    first, before = rows[phase, row, n] * span.ground + rows[phase, row, n + 1], rows[phase, row, n] * span.slope
    last, after = first + before * span.length, before
    for i in range(n):
        weight = rows[phase, row, i]
        if weight != 0.0:
            first += weight * room.motion[i]
            last += weight * room.vectors[TRIAL, i]
            before += weight * room.rates[0, i]
            after += weight * room.rates[LAST, i]
    return first, last, before, after


@inlined_kernel
def nothing_hides(system: System, flow: Flow, phase: int, span: Span, limits: Array, log: Log, room: Stages) -> bool:
    """Return True if the step contains no event and no new peak except at its end; the latter is recorded."""
    rows, side, step = system.plain_rows, system.phases[phase].side, span.length
    n, modes = rows.shape[2] - 2, flow.field.modes.shape[1]
    if flow.field.hysteretic:
        first, last = room.at.branch * room.motion[modes], room.at.branch * room.vectors[TRIAL, modes]
        before, after = room.at.branch * room.rates[0, modes], room.at.branch * room.rates[LAST, modes]
        if stretch(first, last, step * before, step * after)[0] < 0.0:
            return False
    if (
        side != 0.0
        and flow.field.complete
        and curves_hide(system, flow, phase, span, room.vectors[TRIAL], room.rates[LAST], WHOLE, log, room)
    ):
        return False
    if system.phases[phase].turns != 0 and turn_hides(system, phase, step, room):
        return False
    low_limit, high_limit, shaken = limits[LOW], limits[HIGH], is_shaken(span)
    rise, risen = span.rise, span.rise + span.rise_slope * step
    if shaken:
        below, above = heavier_limits(system, phase, room.motion)
        low_limit += max(below * rise, below * risen)
        high_limit += min(above * rise, above * risen)
    for f in range(log.peaks.size):
        if is_curved(flow, f, side):
            continue
        first = rows[phase, f, n] * span.ground + rows[phase, f, n + 1]
        last = first + rows[phase, f, n] * span.slope * step
        for i in range(n):
            weight = rows[phase, f, i]
            if weight != 0.0:
                first += weight * room.motion[i]
                last += weight * room.vectors[TRIAL, i]
        start = end = start_rate = end_rate = 0.0
        if shaken:
            start, end, start_rate, end_rate = heavier_ends(system, phase, f, span, room)
            first, last = first + rise * start, last + risen * end
        room.rows[AT_ENDS, f] = last
        if f != GUARD:
            if is_far(first, last, f, log):
                continue
        elif side == 0.0 and max(abs(first), abs(last)) < NEAR * min(-low_limit, high_limit):
            continue  # in contact the moment varies about zero; of a base that is held at a rotation it does not
        before = rows[phase, f, n] * span.slope
        after = before
        for i in range(n):
            weight = rows[phase, f, i]
            if weight != 0.0:
                before += weight * room.rates[0, i]
                after += weight * room.rates[LAST, i]
        before += rise * start_rate + span.rise_slope * start
        after += risen * end_rate + span.rise_slope * end
        low, high = stretch(first, last, step * before, step * after)
        if f != GUARD:
            # Peaks at the ends are known; they are recorded below.
            known = max(log.peaks[f], max(size_of(first, f, log), size_of(last, f, log)))
            hidden = max(size_of(high, f, log), size_of(low, f, log)) > known
        elif not system.phases[phase].free:
            hidden = low < low_limit or high > high_limit
        else:
            hidden = min(low, first) <= low_limit or max(high, first) >= high_limit
            hidden = hidden or max(high, -low) > max(log.peaks[GUARD], abs(first), abs(last))
        if hidden:
            return False
    raise_peaks(room.rows[AT_ENDS], system.phases[phase].free, span.time + step, log)
    return True
