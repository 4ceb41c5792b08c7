"""Maps over independent tasks, on threads, or over the chunks of a plan on a Dask cluster that the user has started."""

import gc
import math
import pickle
import time
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import closing, contextmanager, suppress
from queue import Empty, SimpleQueue
from typing import Any, Generic, Protocol, SupportsIndex, TypeAlias, TypeVar
from uuid import uuid4

from rockflex.engine.stops import asked_to_stop, stopping_when
from rockflex.foundation.checks import checked_positive, checked_whole_number
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.studies.running import worker_count

Task = TypeVar("Task")
Result = TypeVar("Result")


def map_threads(
    function: Callable[[Task], Result],
    tasks: Iterable[Task],
    workers: SupportsIndex | None = None,
    leaving: Callable[[int], object] = lambda _: None,
) -> Generator[Result]:
    """Yield `function(task)` of every task, in order of completion; few tasks wait at a time.

    The error that is raised is that of the first task that fails in the order of the tasks, on any number of threads:
    after an error no further task starts, those before it are completed, and the results of those after it are
    dropped. A consumer that may fail should close the map by `contextlib.closing`; it then waits for the tasks that
    run, at most one per thread.

    Parameters
    ----------
    function
        Called on one task; an exception ends the map.
    tasks
        Read as workers become free, so it may be endless.
    workers
        Number of threads; None for one per core, 1 for no threads (to debug).
    leaving
        Called with the place of a task, counted from 0, when the tasks after it are no longer needed, in order to stop
        those that run; with -1 when the map ends.

    Raises
    ------
    InputError
        If `workers` is neither None nor a whole number of at least 1.
    """
    count = worker_count(workers)
    if count == 1:
        yield from map(function, tasks)
        return
    queue = enumerate(tasks)
    running = dict[Future[Result], int]()
    place, failure = -1, None  # of the last task that was read, then of the first one known to fail
    with ThreadPoolExecutor(count) as pool:
        try:
            while True:
                while failure is None and len(running) < 2 * count:
                    try:
                        place, task = next(queue)
                    except StopIteration:
                        break
                    except Exception as error:  # the tasks before are to end first, as on one thread
                        place, failure = place + 1, error
                        break
                    running[pool.submit(function, task)] = place
                if not running:
                    break
                done, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in sorted(done, key=running.__getitem__):
                    number = running.pop(future, None)
                    if number is None:
                        continue  # a task after the one that failed
                    error = future.exception()
                    if error is None:
                        yield future.result()
                        continue
                    place, failure = number, error
                    leaving(number)
                    for other in [each for each, after in running.items() if after > number]:
                        other.cancel()
                        del running[other]
            if failure is not None:
                raise failure
        finally:
            leaving(-1)
            for future in running:
                future.cancel()


def map_runs(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: SupportsIndex | None = None
) -> Generator[Result]:
    """Map over tasks as `map_threads` does. Leaving the map, by Ctrl-C for instance, stops the runs in progress."""
    last, asked = [math.inf], asked_to_stop()  # the place of the last task that is still needed

    def guarded(numbered: tuple[int, Task]) -> Result:
        place, task = numbered
        with stopping_when(lambda: place > last[0] or asked()):
            return function(task)

    def leave(place: int) -> None:
        last[0] = place

    return map_threads(guarded, enumerate(tasks), workers, leave)


def map_runs_in_order(
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


TASKS_PER_THREAD = 2  # tasks in flight for each thread of the cluster
MIN_TASK_TIME = 1.0  # s of computing in a task, at least, where there is so much left
MAX_TASK_RATE = 50.0  # tasks a second that a scheduler is given, at most; it manages several times as many


def chunks_per_task(left: int, threads: int, chunk_time: float | None) -> int:
    """Return how many of the chunks that are left go into the next task.

    A task takes as long as it must for the scheduler to keep up, by the measured time of a chunk, `chunk_time` in s
    (None before any has come back). Near the end tasks become smaller, so that all threads finish together.
    """
    if chunk_time is None:
        return 1
    wanted = max(MIN_TASK_TIME, threads / MAX_TASK_RATE) / max(chunk_time, 1e-9)
    fair = left / (2 * TASKS_PER_THREAD * threads)
    return max(1, int(min(wanted, fair)))


CONNECT_TIMEOUT = 10.0  # s
POLL_INTERVAL = 5.0  # s between looks at the cluster while nothing comes
RECOUNT_INTERVAL = 0.5  # s for which the number of threads is taken as known

Result_co = TypeVar("Result_co", covariant=True)
Batch: TypeAlias = tuple[int, ...]  # numbers of chunks


class ClusterError(RuntimeError):
    """A cluster failed during the map; earlier chunks are valid, and the rest can be requested again."""


class NumberedChunks(Protocol, Generic[Result_co]):
    """Work in numbered chunks; pure, deterministic and picklable."""

    def chunk(self, number: int, /) -> Result_co:
        """Compute a chunk."""
        ...


def map_chunks_on_dask(
    plan: NumberedChunks[Result_co],
    numbers: Iterable[int],
    address: str,
    *,
    retries: SupportsIndex = 2,
    patience: float = 600.0,
) -> Generator[tuple[int, Result_co]]:
    """Yield each number and ``plan.chunk(number)``, in order of completion, computed on a Dask cluster.

    The plan is sent to every worker once, including workers that join later. A task computes as many chunks as take
    about a second, or longer on many threads, so that the scheduler keeps up; the results of one task at a time are
    held here. If a worker dies, its chunks are computed on another; each number is yielded once. The cluster is not
    contacted before the first value is requested.

    Parameters
    ----------
    plan
        An object with a method `chunk`, which the workers can import.
    numbers
        Numbers of the chunks.
    address
        Address of the scheduler, such as ``"tcp://10.0.0.1:8786"``.
    retries
        How often a task with a chunk that raises an error is tried again.
    patience
        Time in s for which the cluster may be without any worker; may be infinite.

    Raises
    ------
    InputError
        If Dask is not installed, nothing answers at `address`, the plan cannot be sent, or a worker has other versions
        of the packages.
    ClusterError
        If the scheduler is lost, no worker is left for longer than `patience`, or a chunk kills one worker after
        another.
    Exception
        The error of a chunk, with a note that names the chunk.
    """
    again, limit = (
        checked_whole_number("retries", retries, 0),
        checked_positive("patience", patience, "s", infinite=True),
    )
    if not isinstance(address, str) or not address:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f'address must be that of a Dask scheduler, such as "tcp://10.0.0.1:8786", but {shown(address)} was given.'
        )
    asked = list(numbers)
    if not asked:
        return
    content, client = _pickled_plan(plan), _connected_dask_client(address)
    name, done = f"rockflex-{uuid4().hex}", 0
    try:
        from rockflex.studies._dask_worker import DaskPlanPlugin, compute_chunks_on_worker, worker_package_versions

        versions = worker_package_versions()
        with _explaining_lost_scheduler(address, done, len(asked)):
            _refuse_dask_workers(client, versions)
            client.register_plugin(DaskPlanPlugin(content), name=name)
        tasks = _DaskTasks(
            lambda batch: client.submit(
                compute_chunks_on_worker, name, batch, versions, key=f"{name}-{batch[0]}", retries=again
            )
        )
        looked, threads, alive = -RECOUNT_INTERVAL, 0, time.monotonic()
        left, failed = asked, None
        while done < len(asked):
            with _explaining_lost_scheduler(address, done, len(asked)):
                if time.monotonic() - looked > RECOUNT_INTERVAL or not threads:
                    threads, looked = sum(client.nthreads().values()), time.monotonic()
                left = tasks.send(left, threads)
                batch, results, error = tasks.next_done()
            now = time.monotonic()
            alive = now if threads else alive
            if now - alive > limit:
                raise ClusterError(
                    f"The Dask scheduler at {address} has had no worker for {limit:g} s; "
                    f"{_chunk_count_text(done, len(asked))}. "
                    "Start workers and run it again."
                )
            if error is not None:  # that of the first batch that fails, whatever the order of completion
                failed, left, batch = (batch, error), [], ()
            if failed is not None and not tasks.running:
                raise _explained_dask_error(failed[1], failed[0], _chunk_count_text(done, len(asked)))
            results.reverse()
            for number in batch:  # each result is let go once it has been used
                done += 1
                yield number, results.pop()
    finally:
        _disconnect_from_dask(client, name)


def _refuse_dask_workers(client: Any, versions: dict[str, str]) -> None:
    from rockflex.studies._dask_worker import refuse_other_worker_versions, worker_package_versions

    for worker, found in client.run(worker_package_versions, on_error="return").items():
        if isinstance(found, dict):
            refuse_other_worker_versions(worker, found, versions)
        elif not isinstance(found, OSError):  # which is that of a worker that has died in the meantime
            raise InputError(
                f"The worker {worker} cannot use rockflex: {found}. Start the workers in an environment that has it."
            )


def _disconnect_from_dask(client: Any, name: str) -> None:
    """Remove the plan from the workers if the cluster still answers, and disconnect."""
    with suppress(OSError, ValueError, KeyError, CancelledError):  # the plan may not have reached every worker
        if client.status == "running":
            client.unregister_worker_plugin(name)
    with suppress(OSError):
        client.close(timeout=2)


def _pickled_plan(plan: object) -> bytes:
    try:
        return pickle.dumps(plan, protocol=5)
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        raise InputError(
            f"The plan cannot be sent to workers: {error}. Define its class at the top of a module, without lambdas."
        ) from error


def _connected_dask_client(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError(
            f"A Dask cluster needs the package {error.name!r}. Install it by pip install 'rockflex[cluster]'."
        ) from error
    # A client that could not connect closes when it is collected. Collected while another one starts, it would wait
    # for ever for a lock that this thread holds. It is therefore collected before, and none while a client starts.
    gc.collect()
    collects = gc.isenabled()
    gc.disable()
    try:
        return Client(address, timeout=CONNECT_TIMEOUT, set_as_default=False, name="rockflex")
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f"No Dask scheduler answers at {shown(address)} ({type(error).__name__}). Start one by `dask scheduler`, "
            'workers by `dask worker ADDRESS`, and give the address that it prints, such as "tcp://10.0.0.1:8786".'
        ) from error
    finally:
        if collects:
            gc.enable()


class _DaskTasks:
    """The tasks that are in flight, each a batch of chunks, and the time that a chunk takes."""

    def __init__(self, submit: Callable[[Batch], Any]) -> None:
        self.submit = submit
        self.running = dict[Any, Batch]()
        self.ready = SimpleQueue[Any]()  # asking for all futures each time would take as long as there are many
        self.chunk_time: float | None = None

    def send(self, numbers: list[int], threads: int) -> list[int]:
        """Send so many of these chunks that every thread has work, and return the others."""
        place = 0
        while place < len(numbers) and len(self.running) < TASKS_PER_THREAD * threads:
            batch = tuple(numbers[place : place + chunks_per_task(len(numbers) - place, threads, self.chunk_time)])
            place += len(batch)
            future = self.submit(batch)
            self.running[future] = batch
            future.add_done_callback(self.ready.put)
        return numbers[place:] if place else numbers

    def next_done(self) -> tuple[Batch, list[Any], BaseException | None]:
        """Return the next batch that is done, with its results or its error; an empty one if none comes in time.

        After an error the batches that were sent later are given up.
        """
        try:
            future = self.ready.get(timeout=POLL_INTERVAL if self.running else 0.1)
        except Empty:
            return (), [], None
        if future not in self.running:  # given up
            return (), [], None
        if future.status == "error":
            sent = list(self.running)
            for later in sent[sent.index(future) + 1 :]:
                del self.running[later]
                later.cancel()
            return self.running.pop(future), [], future.exception()
        batch = self.running.pop(future)
        results, seconds = future.result()
        chunk_time = seconds / len(batch)
        self.chunk_time = chunk_time if self.chunk_time is None else 0.5 * (self.chunk_time + chunk_time)
        return batch, results, None


def _explained_dask_error(error: BaseException, batch: Batch, count: str) -> BaseException:
    from distributed import KilledWorker

    if isinstance(error, KilledWorker):
        which = f"Chunk {batch[0]}" if len(batch) == 1 else f"One of the chunks {batch[0]} to {batch[-1]}"
        message = (
            f"{which} was on one worker after another when it died; {count}. Look for the reason in the workers' logs, "
            "which most often is too little memory, and run it again."
        )
        return ClusterError(message)
    return error


@contextmanager
def _explaining_lost_scheduler(address: str, done: int, total: int) -> Generator[None]:
    from distributed.client import ClosedClientError

    try:
        yield
    except (CancelledError, ClosedClientError, OSError) as error:
        raise ClusterError(
            f"The Dask scheduler at {address} was lost ({type(error).__name__}); {_chunk_count_text(done, total)}. "
            "What was "
            "stored is kept. Restart the cluster and run it again."
        ) from error


def _chunk_count_text(done: int, total: int) -> str:
    return f"{done} of the {total} chunks requested had come back"
