"""The progress of a run."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.solve.records import record_of
from rockflex.solve.status import Status

# The progress of a run: everything that a kernel needs to continue, bit for bit, after an interruption.
_PROGRESS = record_of(
    [
        ("stage", np.int64),  # of `solve.run.follow`
        ("phase", np.int64),
        ("offset", np.int64),  # samples before the present stretch of acceleration
        ("index", np.int64),  # sample within it
        ("entered", np.bool_),  # whether the limits and constants of the present phase are known
        ("last", np.float64),  # acceleration at the end of the previous stretch; NaN at first
        ("slope", np.float64),  # of the acceleration, to which w refers
        ("stated", np.bool_),  # whether the state is up to date, and at least as accurate as w
        ("deferred", np.int64),  # the block kept for later that is being searched for peaks; -1 for none
        ("status", np.int64),  # how the motion ended, if only peaks are still to be searched
        ("tuned", np.bool_),  # whether w is up to date
        ("blocked", np.bool_),  # whether the rows over the samples ahead are known
        ("count", np.int64),  # of the samples of this block that no event ends
        ("marks", np.int64),  # those in which peaks are still to be searched, as bits
        ("walk", np.int64),  # the one to which w refers; -1 for none
        ("begun", np.float64),  # completed part of the present sample in s
        ("place", np.int64),  # on the grid of the present sample
        ("level", np.int64),  # of the next step
        ("probed", np.bool_),  # whether that step has been examined
        ("finding", np.int64),  # what the examination found
        ("searching", np.bool_),  # for peaks inside that step
        ("search_place", np.int64),
        ("search_level", np.int64),
        ("search_probed", np.bool_),
        ("crossing", np.bool_),  # advancing event by event, up to the next point of the grid
        ("onset", np.int64),  # how the rotation leaves zero
        ("lift", np.float64),  # θ'' at the instant of uplift, if known
        ("slip_onset", np.int64),  # how the slip leaves zero
        ("slide", np.float64),  # acceleration of the slip at its onset, if known
        ("resume", np.float64),  # where the search in contact resumes after a guard that was touched but not passed
        ("fresh_rows", np.bool_),  # whether `DOUBT` does not apply to the motion ahead
        ("step", np.float64),  # length proposed by the error control
        ("branch", np.float64),  # sign of the hysteretic spring's velocity
        ("known", np.bool_),  # whether the first stage is known from the previous step
        ("tried", np.bool_),  # whether the next step has been taken, and found to need a closer look
        ("length", np.float64),  # of that step
        ("told", np.bool_),  # whether the curved rows at the start of a step are known
        ("lacking", np.int64),  # offset from `BESIDE` or `FOLLOWS` of the phase needed; -1 for none
    ]
)


def progress_at_start(phase: int) -> NDArray[Any]:
    """Return two records of the progress of a run that starts in a phase: the second stays as it is."""
    both = np.frombuffer(bytearray(_AT_START), dtype=_PROGRESS)  # faster than a copy field by field
    both["phase"], both["stated"] = phase, True
    return both


def _at_start() -> bytes:
    at = np.zeros(2, dtype=_PROGRESS)
    at["last"] = at["lift"] = at["slide"] = np.nan
    at["lacking"], at["deferred"], at["status"], at["step"], at["branch"] = -1, -1, int(Status.PAUSED), np.inf, 1.0
    return at.tobytes()


_AT_START = _at_start()
