"""Runs on threads, which stop soon after nobody waits for them any more."""

from collections.abc import Callable, Generator, Iterable
from contextlib import closing
from threading import Event
from typing import SupportsIndex, TypeVar

from rockflex.parallel import map_threads
from rockflex.solve import asked_to_stop, stopping_when

Task = TypeVar("Task")
Result = TypeVar("Result")


def map_runs(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: SupportsIndex | None = None
) -> Generator[Result]:
    """Map over tasks as `map_threads` does. Leaving the map, by Ctrl-C for instance, stops the runs in progress."""
    leave, asked = Event(), asked_to_stop()

    def guarded(task: Task) -> Result:
        with stopping_when(lambda: leave.is_set() or asked()):
            return function(task)

    return map_threads(guarded, tasks, workers, leave.set)


def in_order(
    function: Callable[[Task], Result],
    tasks: Iterable[Task],
    workers: SupportsIndex | None = None,
    tell: Callable[[Result], object] = lambda _: None,
) -> list[Result]:
    """Return the results of `map_runs` in the order of the tasks; each is told here when it is there."""
    found = dict[int, Result]()
    numbered = map_runs(lambda task: (task[0], function(task[1])), enumerate(tasks), workers)
    with closing(numbered) as coming:  # or the runs in progress would go on after an error in `tell`
        for place, result in coming:
            found[place] = result
            tell(result)
    return [found[place] for place in sorted(found)]
