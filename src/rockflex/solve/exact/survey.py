"""The search for peaks inside a step that holds no event. It leaves the motion as it is."""

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.grid import largest_step
from rockflex.solve.exact.layout import CONTACT, LEFT, LOOK, ROCKING, SERIES, Log, Scratch, System
from rockflex.solve.exact.march import to_state
from rockflex.solve.exact.peaks import raise_peak, raise_row
from rockflex.solve.exact.probe import examine, probe, set_limits
from rockflex.solve.exact.series import expand, row_series

__all__ = ["survey"]


@kernel
def survey(
    system: System, level: int, side: float, here: float, slope: float, time: float, log: Log, room: Scratch
) -> None:
    """Raise the peaks of the rows in doubt over the step of `level` that has just been probed.

    The step is walked on the dyadic grid in the largest steps in which no peak can hide, down to units that are
    crossed by their power series. A row that cannot hide a peak in a step is not looked at in its parts.
    `room.w_end` still holds the end of the step afterwards.
    """
    phase = ROCKING if side != 0.0 else CONTACT
    levels = system.sag.shape[1] - 1
    grid = 1 << (levels - level)
    unit = float(system.steps[levels])
    for k in range(room.w.size):
        room.held[k] = room.w_end[k]
    for f in range(room.clear.size):
        room.clear[f] = 0 if room.doubt[f] else grid
    place, depth, probed = 0, level, True
    while place < grid and log.work[LEFT] >= 0.0:
        log.work[LEFT] -= log.work[LOOK]
        stride = 1 << (levels - depth)
        start = here + slope * unit * place
        clear = False
        if not probed:
            for f in range(room.clear.size):
                room.asked[f] = room.clear[f] <= place
            set_limits(side, system.physics.resistance, log, room)
            examine(system, phase, depth, side, start, start + slope * unit * stride, slope, room)
            probe(system, phase, depth, side, slope, room)
            clear = True
            for f in range(room.clear.size):
                if room.doubt[f]:
                    clear = False
                elif room.asked[f]:
                    room.clear[f] = place + stride
                    raise_row(f, room.end[f], side, time + unit * (place + stride), log)
        if not clear and depth < levels:
            depth += 1
            probed = False
            continue
        if not clear:
            log.work[LEFT] -= log.work[SERIES]
            to_state(system, phase, start, slope, side, room)
            survey_unit(system, side, start, slope, unit, time + unit * place, log, room)
        for k in range(room.w.size):
            room.w[k] = room.w_end[k]
        place += stride
        depth = max(level, largest_step(place, levels))
        probed = False
    for k in range(room.w.size):
        room.w_end[k] = room.held[k]
    for f in range(room.asked.size):
        room.asked[f] = True


@kernel
def survey_unit(
    system: System,
    side: float,
    acceleration: float,
    slope: float,
    step: float,
    time: float,
    log: Log,
    room: Scratch,
) -> None:
    """Raise the peaks of the rows in doubt over a unit without events."""
    phase = ROCKING if side != 0.0 else CONTACT
    expand(system.physics, side != 0.0, room.state, acceleration, slope, side, np.nan, step, room.series)
    for f in range(1, log.peaks.size):
        if room.doubt[f]:
            row_series(system.plain_rows, phase, f, room.series, acceleration, slope, side, step, room.polys)
            raise_peak(room.polys, f, side, 1.0, time, step, log)
            raise_row(f, room.end[f], side, time + step, log)
