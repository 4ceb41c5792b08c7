"""The progress of a study that is stored in parts, some of which an earlier call may have stored."""

from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter
from typing import Literal

from rockflex.progress._bar import bar
from rockflex.progress._choice import check_progress


@dataclass(frozen=True)
class Progress:
    """Progress of a study, in parts; `kept` of them were stored by an earlier call.

    Examples
    --------
    >>> import rockflex as rf
    >>> study = rf.PopulationStudy(pairs=3, seed=1, runs_per_chunk=2, records={"suites": ["el-centro-1940"]})
    >>> seen = []
    >>> table = rf.run_study(study, progress=seen.append)
    >>> seen[-1]
    Progress(parts=3, done=3, kept=0, runs=3)
    """

    parts: int
    done: int
    kept: int
    runs: int
    """Rows of the table that this call has computed."""


PartProgress = Literal["bar"] | Callable[[Progress], object] | None


def check_part_progress(progress: PartProgress) -> None:
    """Raise an InputError unless `progress` is None, "bar" or a function."""
    check_progress(progress, "one Progress")


@contextmanager
def telling_parts(progress: PartProgress) -> Generator[Callable[[Progress], object]]:
    """Yield a function that tells the progress of a study.

    Raises
    ------
    InputError
        If `progress` is neither None nor "bar" nor a function.
    """
    check_part_progress(progress)
    if progress is None:
        yield lambda _: None
    elif isinstance(progress, str):
        with bar("Parts") as show:
            start = perf_counter()
            yield lambda now: show(now.done, now.parts, pace(now, perf_counter() - start))
    else:
        yield progress


def pace(now: Progress, seconds: float) -> str:
    """Write how many rows a second were computed; empty before the first."""
    rate = now.runs / max(seconds, 1e-9)
    return f"{rate:.{0 if rate >= 10.0 else 2}f} rows/s" if now.runs else ""
