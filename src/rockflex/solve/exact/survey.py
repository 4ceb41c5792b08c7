"""The search for peaks inside a step without events. It does not change the motion."""

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.coordinates import to_state
from rockflex.solve.exact.grid import largest_step
from rockflex.solve.exact.probe import examine, probe
from rockflex.solve.exact.series import expand, row_series
from rockflex.solve.layout import (
    ASKED,
    DOUBT,
    ENDS,
    FINAL,
    HELD,
    LEFT,
    LOOK,
    NOW,
    SERIES,
    Log,
    Motion,
    Progress,
    Span,
    System,
    rows_in,
    unit_of,
)
from rockflex.solve.peaks import raise_peak, raise_row


@kernel
def survey(system: System, at: Progress, span: Span, log: Log, motion: Motion) -> bool:
    """Update the peaks of the rows in doubt over the step `span`, of level `at.level`, that has just been probed.

    The step is traversed on the dyadic grid in the largest steps in which no peak can occur, down to units that are
    treated by power series. A row that cannot have a peak in a step is not examined in its parts. The end of the step
    remains available in `motion.w`. Returns False if the work is used up before the end; `at` then contains the
    progress of the search.
    """
    p, level = at.phase, at.level
    levels = system.phases[p].levels
    grid = 1 << (levels - level)
    unit = unit_of(system, levels)
    if not at.searching:
        for k in range(motion.w.shape[1]):
            motion.w[HELD, k] = motion.w[ENDS, k]
        for f in range(motion.clear.size):
            motion.clear[f] = 0 if motion.flags[DOUBT, f] else grid
        at.searching, at.search_place, at.search_level, at.search_probed = True, 0, level, True
    place, depth, probed = at.search_place, at.search_level, at.search_probed
    while place < grid:
        if log.work[LEFT] < 0.0:
            at.search_place, at.search_level, at.search_probed = place, depth, probed
            return False
        log.work[LEFT] -= log.work[LOOK]
        stride = 1 << (levels - depth)
        start = span.ground + span.slope * unit * place
        clear = False
        if not probed:
            for f in range(rows_in(system, p)):
                motion.flags[ASKED, f] = motion.clear[f] <= place
            examine(system, p, depth, start, start + span.slope * unit * stride, span.slope, motion)
            probe(system, p, depth, span.slope, log, motion)
            clear = True
            for f in range(rows_in(system, p)):
                if motion.flags[DOUBT, f]:
                    clear = False
                elif motion.flags[ASKED, f]:
                    motion.clear[f] = place + stride
                    raise_row(f, motion.values[FINAL, f], span.time + unit * (place + stride), log)
        if not clear and depth < levels:
            depth += 1
            probed = False
            continue
        if not clear:
            log.work[LEFT] -= log.work[SERIES]
            if not at.stated or place > 0:
                to_state(system, at, start, motion)
            time = span.time + unit * place
            survey_unit(system, p, Span(time, span.until, start, span.slope, unit, 0.0, 0.0), log, motion)
        for k in range(motion.w.shape[1]):
            motion.w[NOW, k] = motion.w[ENDS, k]
        place += stride
        depth = max(level, largest_step(place, levels))
        probed = False
    for k in range(motion.w.shape[1]):
        motion.w[ENDS, k] = motion.w[HELD, k]
    for f in range(motion.flags.shape[1]):
        motion.flags[ASKED, f] = True
    at.searching = False
    return True


@kernel
def survey_unit(system: System, phase: int, span: Span, log: Log, motion: Motion) -> None:
    """Update the peaks of the rows in doubt over a unit without events."""
    expand(system, phase, motion, span, np.nan, np.nan)
    for f in range(0 if system.phases[phase].free else 1, log.peaks.size):
        if motion.flags[DOUBT, f]:
            row_series(system, phase, f, motion, span)
            raise_peak(motion.polys, f, 1.0, span, log)
            raise_row(f, motion.values[FINAL, f], span.time + span.length, log)
