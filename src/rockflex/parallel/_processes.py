"""A map over tasks on processes, one a core, for tasks that mostly hold the interpreter lock."""

import ctypes
import gc
import multiprocessing
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.synchronize import Event
from typing import Any, TypeVar

from rockflex._errors import SolverError

Task = TypeVar("Task")
Result = TypeVar("Result")

LOOK = 0.1  # s between looks whether to stop
DEATH_OF_PARENT = 1  # PR_SET_PDEATHSIG of prctl(2): send a signal when the parent ends

_function: Callable[[Any], Any] | None = None  # of a child: what it was forked to do
_left: Event | None = None  # of a child: set when nobody waits for it any more


def may_fork() -> bool:
    """Return whether this process can be copied: on Linux, while no other thread may hold a lock."""
    return (
        sys.platform == "linux"
        and threading.current_thread() is threading.main_thread()
        and threading.active_count() == 1
    )


def map_processes(
    function: Callable[[Task], Result], tasks: Iterable[Task], count: int, asked: Callable[[], bool]
) -> Generator[Result]:
    """Yield `function(task)` of every task, in order of completion, computed by copies of this process.

    The copies have everything that this process has; only tasks and results are sent.
    When the map ends early, by an error, an interrupt or `close`, no further task starts, and `left` is true in those
    that run, which should then end.

    Parameters
    ----------
    function
        Called on one task, in a copy; an exception ends the map. What it changes in memory is lost.
    tasks
        Tasks that can be pickled.
    count
        Number of processes.
    asked
        Called some ten times a second; once it returns True, `left` is true too.

    Raises
    ------
    SolverError
        If a copy was ended from outside.
    """
    global _function, _left
    context = multiprocessing.get_context("fork")
    _function, _left = function, context.Event()
    leave, queue = _left, iter(tasks)
    with warnings.catch_warnings():
        # Other threads than Python's own, which sleep between products of matrices, are no reason to worry.
        warnings.filterwarnings("ignore", message=".*fork", category=DeprecationWarning)
        pool = ProcessPoolExecutor(count, mp_context=context, initializer=_settle, initargs=(os.getpid(),))
        running: set[Future[Any]] = set()
        try:
            while True:
                for task in queue:
                    running.add(pool.submit(_call, task))
                    if len(running) >= 2 * count:
                        break
                if not running:
                    return
                done, running = wait(running, timeout=LOOK, return_when=FIRST_COMPLETED)
                if asked():
                    leave.set()
                for future in done:
                    yield future.result()
        except BrokenProcessPool as error:
            raise SolverError(
                "One of the processes that compute the runs was ended from outside, most often because memory ran out. "
                "Run it again with fewer workers: workers=1 needs no other process."
            ) from error
        finally:
            leave.set()
            pool.shutdown(cancel_futures=True)
            _function = _left = None


def left() -> bool:
    """Return whether nobody waits any more for the tasks of this copy."""
    return _left is not None and _left.is_set()


def _call(task: Any) -> Any:
    assert _function is not None
    return _function(task)


def _settle(parent: int) -> None:
    """Prepare a copy for its tasks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that waits is interrupted, and tells its copies
    ctypes.CDLL(None).prctl(DEATH_OF_PARENT, signal.SIGKILL)  # or a copy would wait for ever for one that was killed
    if os.getppid() != parent:
        os._exit(1)
    gc.freeze()  # a collection would write to, and so copy, all memory that the processes share
