"""The work of ``rockflex reproduce``: pieces and targets on all cores, each kept and told as soon as it is done."""

import multiprocessing
import os
import signal
import warnings
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass, replace
from threading import Thread
from time import perf_counter
from typing import Any

from rockflex.cli._kept_work import KeptWork
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.papers.silva_stojadinovic_2024._inputs import PaperRecords, Piece
from rockflex.papers.silva_stojadinovic_2024._targets import finish_target, target_cost, target_pieces
from rockflex.report._document import FinishedResult
from rockflex.studies.running import core_count

ENOUGH_FOR_PROCESSES = 10.0  # s of work, below which starting other processes takes longer than it saves
TICK = 0.5  # s between two pictures of the progress while nothing ends


@dataclass(frozen=True)
class Job:
    """A piece, or a target when its pieces are there."""

    target: str  # for a piece the first one that needs it
    cost: float
    piece: Piece | None = None
    whole: bool = True  # of a target: with remarks and figures

    @property
    def title(self) -> str:
        """The computed part in words."""
        return self.target if self.piece is None else self.piece.name


def planned_jobs(targets: Sequence[str], records: PaperRecords, *, whole: bool = True) -> list[Job]:
    """Return the jobs of some targets, quick targets first and pieces before the first target that needs them."""
    jobs, planned = list[Job](), set[str]()

    def missing(target: str) -> list[Piece]:
        known = planned | records.tables.keys()
        return [piece for piece in target_pieces(target, records, whole=whole) if piece.name not in known]

    waiting = list(targets)
    while waiting:
        # Anew for each, because targets share pieces.
        costs = {name: target_cost(name, whole=whole) for name in waiting}
        quickest = min(waiting, key=lambda name: costs[name] + sum(piece.cost for piece in missing(name)))
        jobs += [Job(quickest, piece.cost, piece) for piece in missing(quickest)]
        planned |= {job.piece.name for job in jobs if job.piece is not None}
        jobs.append(Job(quickest, costs[quickest], whole=whole))
        waiting.remove(quickest)
    return jobs


@dataclass(frozen=True)
class Done:
    """A job that is done, in how many s, with the result if it was a target."""

    job: Job
    seconds: float
    result: FinishedResult | None = None


def finished_jobs(
    jobs: Sequence[Job], records: PaperRecords, kept: KeptWork, told: Callable[[Sequence[Job]], object]
) -> Generator[Done]:
    """Compute jobs, keep what they give, and yield each; `told` is called now and then with those that run.

    Closing the generator stops the jobs that run.
    """
    waiting, running = list(jobs), dict[Future[Any], Job]()
    processes = core_count() if sum(job.cost for job in jobs) > ENOUGH_FOR_PROCESSES else 1
    with _executor(processes) as executor:
        while waiting or running:
            for job in _ready_jobs(waiting, records, processes - len(running)):
                waiting.remove(job)
                running[executor.submit(_timed_job, job, _records_for(job, records, processes))] = job
            told(list(running.values()))
            for future in wait(running, TICK, FIRST_COMPLETED).done:
                yield _kept_job(running.pop(future), future, records, kept)


def _ready_jobs(waiting: Sequence[Job], records: PaperRecords, count: int) -> list[Job]:
    """Return the first few jobs whose pieces are there."""

    def ready(job: Job) -> bool:
        return all(piece.name in records.tables for piece in _pieces_of(job, records))

    return [job for job in waiting if ready(job)][:count]


def _records_for(job: Job, records: PaperRecords, processes: int) -> PaperRecords:
    """Return the records with the tables that a job needs, and with one thread where there are several processes."""
    if processes == 1:
        return records
    return replace(
        records, workers=1, tables={piece.name: records.tables[piece.name] for piece in _pieces_of(job, records)}
    )


def _pieces_of(job: Job, records: PaperRecords) -> list[Piece]:
    """Return the pieces that a job needs; a piece needs none."""
    return [] if job.piece is not None else target_pieces(job.target, records, whole=job.whole)


def _timed_job(job: Job, records: PaperRecords) -> tuple[float, Any]:
    start = perf_counter()
    piece = job.piece
    found = finish_target(job.target, records, whole=job.whole) if piece is None else piece.make(records, piece.number)
    return perf_counter() - start, found


def _kept_job(job: Job, future: "Future[tuple[float, Any]]", records: PaperRecords, kept: KeptWork) -> Done:
    try:
        seconds, found = future.result()
    except BrokenProcessPool as error:
        raise InputError(
            f"A process that computed {job.title} was ended from outside, perhaps for lack of memory. What is done is "
            "kept with --out; give the same line again."
        ) from error
    except InputError as error:
        raise (error if job.piece is None else InputError(f"{job.target}: {error}")) from error
    if job.piece is None:
        kept.add_result(found)
        return Done(job, seconds, found)
    kept.add_table(job.piece, found)
    records.tables[job.piece.name] = found
    return Done(job, seconds)


class _Here(Executor):
    """Jobs in this process, one after the other."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        future = Future[Any]()
        try:
            future.set_result(fn(*args, **kwargs))
        except InputError as error:
            future.set_exception(error)
        return future


@contextmanager
def _executor(processes: int) -> Generator[Executor]:
    if processes == 1:
        yield _Here()
        return
    how = multiprocessing.get_context("spawn")  # a fork would copy locks that threads of libraries hold
    with _one_thread_each():
        pool = ProcessPoolExecutor(processes, how, initializer=_begin_process)
        done = False
        try:
            yield pool
            done = True
        finally:
            if not done:  # they would finish their jobs first
                for process in multiprocessing.active_children():
                    process.kill()
            pool.shutdown(cancel_futures=True)


@contextmanager
def _one_thread_each() -> Generator[None]:
    """Let processes that begin here run their linear algebra on one thread, because they occupy all cores."""
    names = "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"
    before = {name: os.environ.get(name) for name in names}
    os.environ.update(dict.fromkeys(names, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _begin_process() -> None:
    """Leave Ctrl-C and warnings about records to the first process, and end with it, even if it is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore", RecordWarning)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def follow() -> None:
        parent.join()
        os._exit(1)

    Thread(target=follow, daemon=True).start()
