"""Progress of a study: reported to a function, or shown as a bar, a table in a notebook or lines of a log."""

import sys
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from time import perf_counter
from typing import TYPE_CHECKING, Any, Literal

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

if TYPE_CHECKING:
    from rich.progress import Progress as RichProgress


def duration_text(seconds: float) -> str:
    """Write a time as 0.8 s, 45 s, 12 min or 3.4 h."""
    if seconds < 90.0:
        return f"{seconds:.1f} s" if seconds < 10.0 else f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def check_progress(progress: object, arguments: str) -> None:
    """Raise an InputError unless `progress` is None, "bar" or a function, which is called with `arguments`."""
    if progress is None or progress == "bar" or callable(progress):
        return
    raise InputError(
        f'progress must be None, "bar" or a function of {arguments}, but {shown(progress)} was given. Use "bar" for a '
        "bar in a terminal or a notebook.",
        field="progress",
    )


MIN_INTERVAL, MAX_INTERVAL = 30.0, 600.0  # s after the last line: the next one if a tenth more is done, and in any case
MIN_SHARE = 0.1


class ProgressLogLines:
    """Lines of a log on stderr, each with what is done, the time since the start, and the time that it may still take.

    A study of less than half a minute writes none, unless `last`, which asks for one at the end.
    """

    def __init__(self, title: str, *, last: bool, clock: Callable[[], float] = perf_counter) -> None:
        self.title, self.last, self.clock = title, last, clock
        self.start = self.written_at = clock()
        self.first: float | None = None  # done before the start, by an earlier call
        self.written = 0.0

    def show(self, done: float, total: float, remark: str = "") -> None:
        """Write a line if it is time for one."""
        now = self.clock()
        if self.first is None:
            self.first = self.written = done
        waited, end = now - self.written_at, done >= total
        due = waited >= MAX_INTERVAL or (waited >= MIN_INTERVAL and done - self.written >= MIN_SHARE * total)
        if due or (end and self.last):
            self.written_at, self.written = now, done
            print(self._line(done, total, remark, now - self.start), file=sys.stderr, flush=True)

    def _line(self, done: float, total: float, remark: str, elapsed: float) -> str:
        made = done - (self.first or 0)
        text = f"{self.title}: {done:.0f} of {total:.0f} ({100 * done // max(total, 1):.0f} %)"
        text += f", {duration_text(elapsed)} elapsed"
        if made and done < total:
            text += f", about {duration_text(elapsed / made * (total - done))} left"
        return f"{text}, {remark}" if remark else text


Show = Callable[[float, float, str], None]

REFRESH_INTERVAL = {"terminal": 0.1, "notebook": 0.3}  # s between two pictures of the bar


@contextmanager
def progress_bar(title: str, *, transient: bool = False) -> Generator[Show]:
    """Show a bar on stderr; the yielded function takes what is done, the total, and a remark.

    A terminal or a notebook shows the bar with its count and the remaining time, and keeps it unless `transient`; any
    other stderr gets lines.
    """
    from rich.console import Console

    console = Console(stderr=True)
    if console.is_jupyter:
        with _notebook_progress_bar(title) as show:
            yield show
    elif console.is_terminal:
        with _progress_bar_columns(
            console=console, transient=transient, auto_refresh=False, redirect_stdout=sys.stdout.isatty()
        ) as drawn:
            yield _throttled_progress_display(drawn, title, drawn.refresh, REFRESH_INTERVAL["terminal"])
    else:
        yield ProgressLogLines(title, last=not transient).show


@contextmanager
def _notebook_progress_bar(title: str) -> Generator[Show]:
    """Show the bar as the output of a notebook's cell."""
    from IPython.display import display

    drawn = _progress_bar_columns(auto_refresh=False)  # never started: only its table is used

    def table() -> Any:
        return drawn.make_tasks_table(drawn.tasks)

    show = _throttled_progress_display(drawn, title, lambda: handle.update(table()), REFRESH_INTERVAL["notebook"])
    handle: Any = display(table(), display_id=True)
    try:
        yield show
    finally:
        handle.update(table())


def _progress_bar_columns(**how: Any) -> "RichProgress":
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as RichProgress

    look = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[remark]}"))
    return RichProgress(*look, TimeElapsedColumn(), TextColumn("{task.fields[left]}", style="cyan"), **how)


def _throttled_progress_display(drawn: "RichProgress", title: str, refresh: Callable[[], object], every: float) -> Show:
    """Return a function that draws the bar, but not more often than a person can see."""
    task = drawn.add_task(title, total=None, remark="", left="")
    start, last = perf_counter(), -every
    first: float | None = None  # done before the start, by an earlier call

    def show(done: float, total: float, remark: str) -> None:
        nonlocal first, last
        first, now = done if first is None else first, perf_counter()
        # From the whole time: parts may end in bursts, or further apart than any window.
        left = (now - start) / (done - first) * (total - done) if first < done < total else 0.0
        drawn.update(
            task, completed=done, total=total, remark=remark, left=f"{duration_text(left)} left" if left else ""
        )
        if now - last >= every or done >= total:
            last = now
            refresh()

    return show


ProgressChoice = Literal["bar"] | Callable[[int, int], object] | None


@contextmanager
def reporting_progress(progress: ProgressChoice, total: int, units: str) -> Generator[Callable[[int], None]]:
    """Tell the progress of `total` units; the yielded function takes how many more of them are done.

    A function is called in the thread of the caller, first with ``(0, total)``. What it raises goes through.
    """
    check_progress(progress, "(done, total)")
    if progress is None:
        yield lambda _: None
    elif isinstance(progress, str):
        with progress_bar(units.capitalize()) as show:
            yield progress_counter(lambda done, total: show(done, total, ""), total)
    else:
        yield progress_counter(progress, total)


def progress_counter(tell: Callable[[int, int], object], total: int) -> Callable[[int], None]:
    """Return a function that counts what is done, and tells it; it tells the start at once."""
    done = 0
    tell(done, total)

    def advance(more: int) -> None:
        nonlocal done
        done += more
        tell(done, total)

    return advance


@dataclass(frozen=True)
class Progress:
    """Progress of a study, in parts; `kept` of them were stored by an earlier call.

    Examples
    --------
    >>> import rockflex as rf
    >>> study = rf.PopulationStudy(pairs=3, seed=1, runs_per_chunk=2,
    ...     records={"suites": ["el-centro-1940"]})
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


Begin = Callable[[Sequence[int]], Callable[[int, int], object]]
"""It takes the numbers of the parts to compute, and returns what takes the number and the rows of each when done."""


@contextmanager
def reporting_part_progress(progress: PartProgress, total: int) -> Generator[Begin]:
    """Yield what tells the progress of a study of `total` parts."""
    check_progress(progress, "one Progress")
    if isinstance(progress, str):
        with progress_bar("Parts") as show:
            start = perf_counter()
            yield _part_counter(
                lambda now: show(now.done, now.parts, row_rate_text(now, perf_counter() - start)), total
            )
    else:
        yield _part_counter(progress or (lambda _: None), total)


def _part_counter(tell: Callable[[Progress], object], total: int) -> Begin:
    def begin(missing: Sequence[int]) -> Callable[[int, int], object]:
        now = Progress(total, total - len(missing), total - len(missing), 0)
        tell(now)

        def told(_: int, rows: int) -> None:
            nonlocal now
            now = replace(now, done=now.done + 1, runs=now.runs + rows)
            tell(now)

        return told

    return begin


def row_rate_text(now: Progress, seconds: float) -> str:
    """Write how many rows a second were computed; empty before the first."""
    rate = now.runs / max(seconds, 1e-9)
    return f"{rate:.{0 if rate >= 10.0 else 2}f} rows/s" if now.runs else ""
