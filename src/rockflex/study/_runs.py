"""Runs on threads, which stop soon after nobody waits for them any more."""

from collections.abc import Callable, Iterable, Iterator
from threading import Event
from typing import SupportsIndex, TypeVar

from rockflex.parallel import map_threads
from rockflex.solve import asked_to_stop, stopping_when

Task = TypeVar("Task")
Result = TypeVar("Result")


def map_runs(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: SupportsIndex | None = None
) -> Iterator[Result]:
    """Map over tasks as `map_threads` does. Leaving the map, by Ctrl-C for instance, stops the runs in progress."""
    left, asked = Event(), asked_to_stop()

    def guarded(task: Task) -> Result:
        with stopping_when(lambda: left.is_set() or asked()):
            return function(task)

    return map_threads(guarded, tasks, workers, left.set)


def in_order(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: SupportsIndex | None = None
) -> list[Result]:
    """Return the results of `map_runs` in the order of the tasks."""

    def numbered(task: tuple[int, Task]) -> tuple[int, Result]:
        return task[0], function(task[1])

    found = dict(map_runs(numbered, enumerate(tasks), workers))
    return [found[place] for place in range(len(found))]
