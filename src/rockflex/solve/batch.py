"""Runs of one model, one after the other in one call of a kernel, each from the same state.

What a call costs in Python is then shared by all of them. A single run is a batch of one.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, python_kernel
from rockflex.models import Impact
from rockflex.solve._beginning import LEVEL, writable
from rockflex.solve.adaptive.layout import Integrator
from rockflex.solve.events import LACKS_PHASE, PAUSED
from rockflex.solve.layout import (
    ASKED,
    DOUBT,
    IMPACTS,
    LEFT,
    UPLIFTS,
    Course,
    Log,
    Motion,
    Progress,
    System,
)
from rockflex.solve.records import END
from rockflex.solve.run import run
from rockflex.solve.status import Status

ENDED, INFINITE, BROKEN = int(Status.ENDED), int(Status.INFINITE), int(Status.BROKEN)

# Indices in `Batch.place`, `Batch.work` and `Batch.progress`
RUN, BEGUN, FAILED = 0, 1, 2
SLICE, EACH = 0, 1
PRESENT, AT_START = 0, 1


class Excitation(NamedTuple):
    """What shakes the ground in a run."""

    acceleration: Array  # (n,): horizontal, m/s²
    vertical: Array | None = None  # (n,): vertical, m/s²
    scale: float = 1.0  # factor on both


class Batch(NamedTuple):
    """R runs and their results; rows and state as in `rockflex.solve.layout`."""

    samples: Array  # horizontal accelerations of all records, one record after another
    rises: Array  # vertical accelerations; (0,) if there are none
    firsts: NDArray[np.int64]  # (R, 2): where the record of each run begins and ends in them; the same for none
    scales: Array  # (R,)
    record: Array  # (n,): room for the longest record, scaled
    vertical: Array  # (n,); (0,) if there are none
    start: Array  # (S',): the state in which each run begins
    lowest: Array  # (F,): the peaks with which it begins
    progress: Any  # (2,): records of `rockflex.solve.progress`, of the present run and of one that begins
    place: NDArray[np.int64]  # (3,): the present run, whether it has begun, and how many could not be solved
    work: Array  # (2,): left in this slice of work, and the limit of each run
    ends: Any  # (R,): records of `END`
    peaks: Array  # (R, F)
    times: Array  # (R, F)
    states: Array  # (R, S'): the last ones


def batch_of(
    runs: Sequence[Excitation | None], progress: Any, start: Array, log: Log, limit: float | None = None
) -> Batch:
    """Return a batch that has not begun, with the log of its first run; no run is done where there is none.

    `limit` is that of the work of a run in s. A record of several runs is kept once.
    """
    count, rows = len(runs), log.peaks.size
    records = dict[tuple[int, int], Excitation]()
    ends = dict[tuple[int, int], int]()
    firsts, scales = np.zeros((count, 2), dtype=np.int64), np.zeros(count)
    total = longest = 0
    for place, each in enumerate(runs):
        if each is None:
            continue
        size, identity = each.acceleration.size, (id(each.acceleration), id(each.vertical))
        if identity not in records:
            total += size
            longest = max(longest, size)
            records[identity], ends[identity] = each, total
        firsts[place] = ends[identity] - size, ends[identity]
        scales[place] = each.scale
    rises = [each.vertical for each in records.values() if each.vertical is not None]
    return Batch(
        samples=_joined([each.acceleration for each in records.values()]),
        rises=_joined(rises),
        firsts=firsts,
        scales=scales,
        record=np.empty(longest),
        vertical=np.empty(longest if rises else 0),
        start=start,
        lowest=log.peaks.copy(),
        progress=progress,
        place=np.zeros(3, dtype=np.int64),
        work=np.array((0.0, math.inf if limit is None else limit)),
        ends=np.zeros(count, dtype=END),
        peaks=np.zeros((count, rows)),
        times=np.zeros((count, rows)),
        states=np.zeros((count, start.size)),
    )


def _joined(parts: list[Array]) -> Array:
    """Return all parts in one array of the compiled type."""
    return writable(parts[0]) if len(parts) == 1 else np.concatenate(parts or [LEVEL])


@python_kernel
def run_all(
    system: System,
    steps: Integrator | None,
    impact: Impact,
    course: Course,
    at: Progress,
    log: Log,
    motion: Motion,
    batch: Batch,
) -> int:
    """Continue the runs; return why they are interrupted, or how the last one ended.

    `course` has everything but the record. A failure of a user's impact law is reported before the next run begins.
    """
    while batch.place[RUN] < batch.ends.size:
        r = batch.place[RUN]
        end, samples = batch.ends[r], batch.firsts[r, 1] - batch.firsts[r, 0]
        if samples == 0:
            batch.place[RUN] += 1
            continue
        if batch.place[BEGUN] == 0:
            begin(steps, log, motion, batch)
            end.left = batch.work[EACH]
            batch.place[BEGUN] = 1
        given = min(batch.work[SLICE], end.left)
        log.work[LEFT] = given
        record, vertical = batch.record[:samples], batch.vertical[:samples]
        whole = Course(record, vertical, course.quiet, course.dt, course.free, course.settle)
        status = run(system, steps, impact, whole, at, log, motion)
        used = given - log.work[LEFT]
        batch.work[SLICE] -= used
        end.left -= used
        if status in (PAUSED, LACKS_PHASE):
            return status
        for i in range(motion.w.shape[1]):
            if status >= 0 and not math.isfinite(motion.state[i]):
                status = INFINITE
        if status < 0:
            batch.place[FAILED] += 1
        end.status, end.samples = status, at.offset + at.index
        end.uplifts, end.impacts = log.tally[UPLIFTS], log.tally[IMPACTS]
        for f in range(log.peaks.size):
            batch.peaks[r, f], batch.times[r, f] = log.peaks[f], log.times[f]
        for i in range(motion.state.size):
            batch.states[r, i] = motion.state[i]
        if status == BROKEN:
            return status
        batch.place[RUN] += 1
        batch.place[BEGUN] = 0
        if batch.work[SLICE] < 0.0 and batch.place[RUN] < batch.ends.size:
            return PAUSED
    return ENDED


@inlined_kernel
def begin(steps: Integrator | None, log: Log, motion: Motion, batch: Batch) -> None:
    """Clear what a run may read before it has written it."""
    batch.progress[PRESENT] = batch.progress[AT_START]
    first, last, scale = (
        batch.firsts[batch.place[RUN], 0],
        batch.firsts[batch.place[RUN], 1],
        batch.scales[batch.place[RUN]],
    )
    for i in range(first, last):
        batch.record[i - first] = batch.samples[i] * scale
    if batch.vertical.size > 0:
        for i in range(first, last):
            batch.vertical[i - first] = batch.rises[i] * scale
    for f in range(log.peaks.size):
        log.peaks[f], log.times[f] = batch.lowest[f], 0.0
    for i in range(log.tally.size):
        log.tally[i] = 0
    for i in range(motion.state.size):
        motion.state[i] = batch.start[i]
    for f in range(motion.clear.size):
        motion.flags[DOUBT, f], motion.flags[ASKED, f], motion.clear[f] = False, True, 0
    for place in range(motion.deferred.size):
        motion.deferred[place].waits = False
    for k in range(motion.series.shape[1]):  # sums run over the entries beyond the last coordinate, too
        for i in range(motion.series.shape[0]):
            motion.series[i, k] = 0.0
        for i in range(motion.reach.shape[0]):
            motion.reach[i, k] = 0.0
    if steps is not None:
        for i in range(steps.room.size.size):
            steps.room.size[i] = 0.0
        for f in range(steps.room.doubt.size):
            steps.room.doubt[f] = False
