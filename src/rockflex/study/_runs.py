"""Runs on threads or processes, which stop soon after nobody waits for them any more."""

from collections.abc import Callable, Generator, Iterable
from contextlib import closing
from threading import Event
from typing import SupportsIndex, TypeVar

from rockflex.parallel import left, map_processes, map_threads, may_fork, worker_count
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


def map_runs_apart(
    function: Callable[[Task], Result],
    tasks: Iterable[Task],
    workers: SupportsIndex | None = None,
) -> Generator[Result]:
    """Map in the same way, by processes where this one can be copied.

    What the function changes in memory is lost, and tasks and results must be picklable.
    """
    count = worker_count(workers)
    if count == 1 or not may_fork():
        return map_runs(function, tasks, count)

    def guarded(task: Task) -> Result:
        with stopping_when(left):
            return function(task)

    return map_processes(guarded, tasks, count, asked_to_stop())


def in_order(
    function: Callable[[Task], Result],
    tasks: Iterable[Task],
    workers: SupportsIndex | None = None,
    tell: Callable[[Result], object] = lambda _: None,
) -> list[Result]:
    """Return the results of `map_runs` in the order of the tasks; each is told here when it is there."""
    return _sorted(map_runs(_numbered(function), enumerate(tasks), workers), tell)


def in_order_apart(
    function: Callable[[Task], Result],
    tasks: Iterable[Task],
    workers: SupportsIndex | None = None,
    tell: Callable[[Result], object] = lambda _: None,
) -> list[Result]:
    """Return the same as `in_order`, computed by processes where this one can be copied; see `map_runs_apart`."""
    numbered, queue = _numbered(function), enumerate(tasks)
    if worker_count(workers) == 1 or not may_fork():
        return _sorted(map_runs(numbered, queue, workers), tell)
    return _sorted(map_runs_apart(numbered, queue, workers), tell)


def _numbered(function: Callable[[Task], Result]) -> Callable[[tuple[int, Task]], tuple[int, Result]]:
    return lambda task: (task[0], function(task[1]))


def _sorted(results: Generator[tuple[int, Result]], tell: Callable[[Result], object]) -> list[Result]:
    found = dict[int, Result]()
    with closing(results) as coming:  # or the runs in progress would go on after an error in `tell`
        for place, result in coming:
            found[place] = result
            tell(result)
    return [found[place] for place in sorted(found)]
