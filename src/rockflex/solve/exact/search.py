"""The search for peaks in a block of samples. It does not change the motion."""

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex.solve.exact.blocks import leaving, walk_on, walk_to
from rockflex.solve.exact.probe import NOTHING, examine, probe
from rockflex.solve.exact.survey import survey
from rockflex.solve.layout import ASKED, GUARD, INCLINES, ZERO, Log, Motion, Progress, Span, System, rows_in
from rockflex.solve.peaks import raise_row, size_of


@inlined_kernel
def look_into(system: System, piece: Array, m: int, at: Progress, log: Log, motion: Motion) -> int:
    """Return what may occur in sample `m` of the block, according to the rows that are asked for."""
    slope = motion.block[INCLINES, m]
    here, there = float(piece[at.index + m]), float(piece[at.index + m + 1])
    walk_to(system, m, at, motion)
    examine(system, at.phase, 0, here, there, slope, motion)
    return probe(system, at.phase, 0, slope, log, motion)


@kernel
def raise_to_samples(system: System, at: Progress, log: Log, motion: Motion) -> int:
    """Update the peaks with the values at the samples; return the samples, as bits, that may contain higher peaks."""
    marks = ZERO
    for f in range(GUARD if system.phases[at.phase].free else 1, log.peaks.size):
        if rising(f, at, log, motion) == 0:
            continue
        top, place = log.peaks[f], -1
        for m in range(at.count):
            size = size_of(motion.told[f, m], f, log)
            if size > top:
                top, place = size, m
        if place >= 0:
            raise_row(f, motion.told[f, place], system.dt * (at.offset + at.index + place + 1), log)
        marks |= rising(f, at, log, motion)
    return marks


@kernel
def rising(row: int, at: Progress, log: Log, motion: Motion) -> int:
    """Return the samples of the block, as bits, in which the peak of a row may lie."""
    limit = log.peaks[row] - motion.slack[row]
    return leaving(row, -np.inf if row >= log.signed else -limit, limit, at, motion)


@kernel
def search_next(system: System, piece: Array, at: Progress, log: Log, motion: Motion) -> bool:
    """Search for peaks in the first marked sample; return False if the search is interrupted."""
    m = 0
    while not (at.marks >> m) & 1:
        m += 1
    finding = NOTHING
    if not at.searching:
        for f in range(rows_in(system, at.phase)):
            motion.flags[ASKED, f] = f < log.peaks.size and (rising(f, at, log, motion) >> m) & 1 == 1
        motion.flags[ASKED, GUARD] &= system.phases[at.phase].free
        finding = look_into(system, piece, m, at, log, motion)
        for f in range(rows_in(system, at.phase)):
            motion.flags[ASKED, f] = True
        at.level = 0
        at.slope = motion.block[INCLINES, m]
        at.stated = at.stated and m == 0
    if at.searching or finding != NOTHING:
        i = at.offset + at.index + m
        time, until = i * system.dt, (i + 1) * system.dt
        sample = Span(time, until, float(piece[at.index + m]), motion.block[INCLINES, m], system.dt, 0.0, 0.0)
        if not survey(system, at, sample, log, motion):
            return False
    walk_on(system, at, motion)
    at.marks &= ~(1 << m)
    return True
