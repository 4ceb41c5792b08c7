"""How runs are computed: on how many threads, and with how much work for each; for a call, or for a whole block."""

import math
import os
from collections.abc import Generator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Literal, SupportsIndex, TypeAlias

from rockflex.foundation.checks import checked_whole_number, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

WORK_LIMIT = 30.0
"""Limit of the work of one run in s of computing on one core, unless `running` or a call has another."""

WorkLimit: TypeAlias = float | Literal["default", "none"] | None
"""s of computing that one run may take; None or "none": no limit; "default": that of `running`, or else 30 s."""

_CHOSEN: ContextVar[tuple[int | None, float | None]] = ContextVar("running", default=(None, WORK_LIMIT))


@contextmanager
def running(workers: SupportsIndex | None = None, work_limit: WorkLimit = "default") -> Generator[None, None, None]:
    """Run everything in a block on a number of threads, and with a limit of the work of each run.

    It serves every function that takes `workers` or `work_limit`; what is given to a function itself comes first. In
    threads that the block itself starts it has no effect.

    Parameters
    ----------
    workers
        Number of threads; None for that of a block around this one, or else one a core.
    work_limit
        Limit of the work of each run, in s of computing on one core; None for no limit. ``"default"`` is that of a
        block around this one, or else 30 s.

    Raises
    ------
    InputError
        If `workers` is not a whole number of at least 1, or `work_limit` not a positive number of seconds.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> with rf.running(workers=2, work_limit=5.0):
    ...     table = rf.simulate_many(frame, pulse, ["2DOF-S", "MDOF-S"])
    >>> len(table)
    2
    """
    around, _ = _CHOSEN.get()
    threads = around if workers is None else checked_whole_number("workers", workers, 1)
    token = _CHOSEN.set((threads, checked_work_limit(work_limit)))
    try:
        yield
    finally:
        _CHOSEN.reset(token)


def worker_count(workers: SupportsIndex | None) -> int:
    """Return the number of threads; None means that of `running`, or else one per core."""
    if workers is not None:
        return checked_whole_number("workers", workers, 1)
    chosen, _ = _CHOSEN.get()
    return core_count() if chosen is None else chosen


def core_count() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def checked_work_limit(value: WorkLimit) -> float | None:
    """Return the seconds of computing that one run may take; None means no limit, which files call "none"."""
    if isinstance(value, str) and value == "default":
        return _CHOSEN.get()[1]
    if value is None or (isinstance(value, str) and value == "none"):
        return None
    seconds = real_or_nan(value)
    if not seconds > 0.0:
        raise InputError(
            f"work_limit must be a positive number of seconds of computing for one run, or None for no limit ("
            f'"none" in a file and on the command line), but {shown(value)} was given.',
            field="work_limit",
        )
    return seconds if math.isfinite(seconds) else None
