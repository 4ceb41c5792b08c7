"""A bar of rich on stderr, where a person reads it; elsewhere lines of a log.

rich draws it because the command line has it anyway. Its own display in notebooks needs ipywidgets, and leaves nothing
in the saved file; here the same table is shown as HTML, which every notebook can update.
"""

from collections.abc import Callable, Generator
from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING, Any

from rockflex.progress._duration import duration
from rockflex.progress._lines import Lines

if TYPE_CHECKING:
    from rich.progress import Progress

Show = Callable[[int, int, str], None]

EVERY = {"terminal": 0.1, "notebook": 0.3}  # s between two pictures of the bar


@contextmanager
def bar(title: str, *, transient: bool = False) -> Generator[Show]:
    """Show a bar on stderr; the yielded function takes what is done, the total, and a remark.

    A terminal or a notebook shows the bar with its count and the remaining time, and keeps it unless `transient`; any
    other stderr gets lines.
    """
    from rich.console import Console

    console = Console(stderr=True)
    if console.is_jupyter:
        with _picture(title) as show:
            yield show
    elif console.is_terminal:
        with _columns(console=console, transient=transient, auto_refresh=False) as drawn:
            yield _throttled(drawn, title, drawn.refresh, EVERY["terminal"])
    else:
        yield Lines(title, last=not transient).show


@contextmanager
def _picture(title: str) -> Generator[Show]:
    """Show the bar as the output of a notebook's cell."""
    from IPython.display import display

    drawn = _columns(auto_refresh=False)  # never started: only its table is used

    def table() -> Any:
        return drawn.make_tasks_table(drawn.tasks)

    show = _throttled(drawn, title, lambda: handle.update(table()), EVERY["notebook"])
    handle: Any = display(table(), display_id=True)
    try:
        yield show
    finally:
        handle.update(table())


def _columns(**how: Any) -> "Progress":
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
    )

    look = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[remark]}"))
    return Progress(*look, TimeElapsedColumn(), TextColumn("{task.fields[left]}", style="cyan"), **how)


def _throttled(drawn: "Progress", title: str, refresh: Callable[[], object], every: float) -> Show:
    """Return a function that draws the bar, but not more often than a person can see."""
    task = drawn.add_task(title, total=None, remark="", left="")
    start, last = perf_counter(), -every
    first: int | None = None  # done before the start, by an earlier call

    def show(done: int, total: int, remark: str) -> None:
        nonlocal first, last
        first, now = done if first is None else first, perf_counter()
        # From the whole time: parts may end in bursts, or further apart than any window.
        left = (now - start) / (done - first) * (total - done) if first < done < total else 0.0
        drawn.update(task, completed=done, total=total, remark=remark, left=f"{duration(left)} left" if left else "")
        if now - last >= every or done >= total:
            last = now
            refresh()

    return show
