"""Runs on threads or processes, which stop soon after nobody waits for them any more."""

from collections.abc import Callable, Iterable, Iterator
from itertools import chain, islice
from threading import Event
from typing import SupportsIndex, TypeVar

from rockflex.parallel import left, map_processes, map_threads, may_fork, worker_count
from rockflex.solve import asked_to_stop, stopping_when

Task = TypeVar("Task")
Result = TypeVar("Result")


def map_runs(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: SupportsIndex | None = None
) -> Iterator[Result]:
    """Map over tasks as `map_threads` does. Leaving the map, by Ctrl-C for instance, stops the runs in progress."""
    leave, asked = Event(), asked_to_stop()

    def guarded(task: Task) -> Result:
        with stopping_when(lambda: leave.is_set() or asked()):
            return function(task)

    return map_threads(guarded, tasks, workers, leave.set)


def in_order(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: SupportsIndex | None = None
) -> list[Result]:
    """Return the results of `map_runs` in the order of the tasks."""
    return _sorted(map_runs(_numbered(function), enumerate(tasks), workers))


def in_order_apart(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: SupportsIndex | None = None
) -> list[Result]:
    """Return the same, computed by processes where this one can be copied.

    It pays if the kernels do little between what holds the interpreter lock. What the function changes is lost, and
    tasks and results must be picklable.
    """
    count = worker_count(workers)
    if count == 1 or not may_fork():
        return in_order(function, tasks, workers)
    numbered, queue = _numbered(function), enumerate(tasks)
    # The first one here, so that the kernels are compiled before this process is copied.
    first = list(map_runs(numbered, islice(queue, 1), 1))

    def guarded(task: tuple[int, Task]) -> tuple[int, Result]:
        with stopping_when(left):
            return numbered(task)

    return _sorted(chain(first, map_processes(guarded, queue, count, asked_to_stop())))


def _numbered(function: Callable[[Task], Result]) -> Callable[[tuple[int, Task]], tuple[int, Result]]:
    return lambda task: (task[0], function(task[1]))


def _sorted(results: Iterable[tuple[int, Result]]) -> list[Result]:
    found = dict(results)
    return [found[place] for place in range(len(found))]
