"""The progress of a function that runs many things: how many of them are done."""

from collections.abc import Callable, Generator
from contextlib import contextmanager
from typing import Literal

from rockflex.progress._bar import bar
from rockflex.progress._choice import check_progress

ProgressChoice = Literal["bar"] | Callable[[int, int], object] | None


@contextmanager
def telling(progress: ProgressChoice, total: int, units: str) -> Generator[Callable[[int], None]]:
    """Tell the progress of `total` units; the yielded function takes how many more of them are done.

    A function is called in the thread of the caller, first with ``(0, total)``. What it raises goes through.

    Raises
    ------
    InputError
        If `progress` is neither None nor "bar" nor a function.
    """
    check_progress(progress, "(done, total)")
    if progress is None:
        yield lambda _: None
    elif isinstance(progress, str):
        with bar(units.capitalize()) as show:
            yield counter(lambda done, total: show(done, total, ""), total)
    else:
        yield counter(progress, total)


def counter(tell: Callable[[int, int], object], total: int) -> Callable[[int], None]:
    """Return a function that counts what is done, and tells it; it tells the start at once."""
    done = 0
    tell(done, total)

    def advance(more: int) -> None:
        nonlocal done
        done += more
        tell(done, total)

    return advance
