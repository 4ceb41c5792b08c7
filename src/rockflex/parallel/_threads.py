"""A map over tasks on threads: the engine releases the interpreter lock."""

import os
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import SupportsIndex, TypeVar

from rockflex._checks import whole_number

Task = TypeVar("Task")
Result = TypeVar("Result")


def core_count() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def worker_count(workers: SupportsIndex | None) -> int:
    """Return the number of workers; None means one per core.

    Raises
    ------
    InputError
        If `workers` is neither None nor a whole number of at least 1.
    """
    return core_count() if workers is None else whole_number("workers", workers, 1)


def map_threads(
    function: Callable[[Task], Result],
    tasks: Iterable[Task],
    workers: SupportsIndex | None = None,
    leaving: Callable[[], object] = lambda: None,
) -> Generator[Result]:
    """Yield `function(task)` of every task, in order of completion; few tasks wait at a time.

    When the map ends early, by an error, an interrupt or `close`, no further task starts, and the map waits for those
    that run, at most one per thread. A consumer that may fail should close it by `contextlib.closing`.

    Parameters
    ----------
    function
        Called on one task; an exception ends the map.
    tasks
        Read as workers become free, so it may be endless.
    workers
        Number of threads; None for one per core, 1 for no threads (to debug).
    leaving
        Called when the map ends, before it waits for the tasks that still run, in order to stop them.

    Raises
    ------
    InputError
        If `workers` is neither None nor a whole number of at least 1.
    """
    count = worker_count(workers)
    if count == 1:
        yield from map(function, tasks)
        return
    queue = iter(tasks)
    with ThreadPoolExecutor(count) as pool:
        running: set[Future[Result]] = set()
        try:
            while True:
                for task in queue:
                    running.add(pool.submit(function, task))
                    if len(running) >= 2 * count:
                        break
                if not running:
                    return
                done, running = wait(running, return_when=FIRST_COMPLETED)
                for future in done:
                    yield future.result()
        finally:
            leaving()
            for future in running:
                future.cancel()
