"""The question before a step's continuous extension: whether an event or a new peak can hide inside the step.

Every row is compared with the cubic through its values and slopes at both ends. A step that the error control accepts
turns no mode by more than about a radian, over which a row strays from that cubic by a few hundredths of the cubic's
own bend (for a harmonic of ω: (ωh)²/48); a fifth of the bend is allowed for.
"""

from rockflex._kernel import kernel
from rockflex.solve.adaptive.curves import curves_hide, is_curved, stretch
from rockflex.solve.adaptive.layout import Flow, Stages
from rockflex.solve.adaptive.tableau import LAST
from rockflex.solve.exact.layout import CONTACT, ROCKING, Log
from rockflex.solve.exact.peaks import raise_peaks, size_of
from rockflex.solve.exact.probe import QUARTER_TURN

__all__ = ["nothing_hides"]


@kernel
def nothing_hides(
    flow: Flow, side: float, acceleration: float, slope: float, step: float, time: float, log: Log, room: Stages
) -> bool:
    """True where the step just taken holds no event and no new peak but at its end, which is then noted."""
    phase = ROCKING if side != 0.0 else CONTACT
    n = flow.rows.shape[2] - 2
    modes = flow.field.omega2.size
    if flow.field.hysteretic:
        first, last = room.branch[0] * room.motion[modes], room.branch[0] * room.trial[modes]
        before, after = room.branch[0] * room.rates[0, modes], room.branch[0] * room.rates[LAST, modes]
        if stretch(first, last, step * before, step * after)[0] < 0.0:
            return False
    if (
        side != 0.0
        and flow.field.complete
        and curves_hide(flow, side, acceleration, slope, step, time, room.trial, room.rates[LAST], log, room)
    ):
        return False
    for f in range(log.peaks.size):
        if is_curved(flow, f, side):
            continue
        first = flow.rows[phase, f, n] * acceleration + flow.rows[phase, f, n + 1] * side
        before = flow.rows[phase, f, n] * slope
        last, after = first + before * step, before
        for i in range(n):
            weight = flow.rows[phase, f, i]
            if weight != 0.0:
                first += weight * room.motion[i]
                last += weight * room.trial[i]
                before += weight * room.rates[0, i]
                after += weight * room.rates[LAST, i]
        low, high = stretch(first, last, step * before, step * after)
        if f > 0:
            # At the ends a peak is no secret: it is noted below.
            known = max(log.peaks[f], max(size_of(first, f, side, log), size_of(last, f, side, log)))
            hidden = max(size_of(high, f, side, log), size_of(low, f, side, log)) > known
        elif side == 0.0:
            hidden = high > flow.resistance or -low > flow.resistance
        else:
            hidden = min(side * first, side * last) <= 0.0 or (low if side > 0.0 else -high) <= 0.0
            hidden = hidden or max(high, -low) > max(log.peaks[0], abs(first), abs(last)) or abs(last) > QUARTER_TURN
        if hidden:
            return False
        room.ends[f] = last
    raise_peaks(room.ends, side, time + step, log)
    return True
