"""Maps over tasks on threads, and how many chunks go into a task of a cluster."""

import heapq
import threading
import time
from itertools import count, islice

import numpy as np
import pytest

from rockflex import InputError
from rockflex.engine.stops import asked_to_stop
from rockflex.studies.parallel import (
    MAX_TASK_RATE,
    MIN_TASK_TIME,
    TASKS_PER_THREAD,
    chunks_per_task,
    map_runs,
    map_threads,
)

WORKERS = pytest.mark.parametrize("workers", [1, 2, 7, None])


@WORKERS
def test_every_task_is_done_once(workers):
    assert sorted(map_threads(lambda k: k * k, range(100), workers)) == [k * k for k in range(100)]
    assert list(map_threads(str, [], workers)) == []


def test_results_come_as_they_are_done():
    gate = threading.Event()

    def work(first):
        if first:
            assert gate.wait(10.0)
        return first

    results = map_threads(work, [True, False], 2)
    assert next(results) is False
    gate.set()
    assert list(results) == [True]


def test_one_worker_is_the_calling_thread_in_order():
    names = list(map_threads(lambda k: (k, threading.current_thread()), range(5), 1))
    assert names == [(k, threading.current_thread()) for k in range(5)]


def test_several_workers_are_threads_that_run_at_once():
    meeting = threading.Barrier(3, timeout=10.0)
    assert len(list(map_threads(lambda _: meeting.wait(), range(3), 3))) == 3


@WORKERS
def test_tasks_are_read_as_they_are_needed(workers):
    """An endless stream of tasks does, and it is not read far ahead."""
    taken = []

    def tasks():
        for k in count():
            taken.append(k)
            yield k

    assert len(list(islice(map_threads(abs, tasks(), workers), 50))) == 50
    assert len(taken) < 50 + 100


@WORKERS
def test_an_exception_ends_the_map(workers):
    done = []

    def work(k):
        if k == 20:
            message = "the twentieth"
            raise KeyError(message)
        time.sleep(0.001)
        done.append(k)
        return k

    with pytest.raises(KeyError, match="the twentieth"):
        list(map_threads(work, range(10_000), workers))
    assert len(done) < 1000


@pytest.mark.parametrize("first", [0, 3, 7])
@pytest.mark.parametrize("workers", [1, 2, 3, 7])
def test_the_error_is_that_of_the_first_task_that_fails(workers, first):
    """It is held back until another one has failed; what was done before it is yielded, what runs after it stops."""
    failed, stopped, came = threading.Event(), [], []

    def work(k):
        if k < first:
            return k
        if k == first:
            failed.wait(10.0 * (workers > 1))
        elif k == first + 2:  # runs until it is told to stop
            stopped.append(wait_until(asked_to_stop()))
        failed.set()
        raise KeyError(k)

    with pytest.raises(KeyError) as caught:
        came.extend(map_runs(work, range(1000), workers))
    assert caught.value.args == (first,)
    assert stopped in ([], [True])


def wait_until(condition):
    end = time.monotonic() + 10.0
    while not condition() and time.monotonic() < end:
        time.sleep(0.001)
    return condition()


@WORKERS
def test_an_exception_of_the_tasks_ends_the_map(workers):
    def tasks():
        yield 1
        message = "no more"
        raise ValueError(message)

    with pytest.raises(ValueError, match="no more"):
        list(map_threads(abs, tasks(), workers))


def test_a_map_that_is_given_up_leaves_no_thread():
    before = threading.active_count()
    results = map_threads(abs, count(), 3)
    next(results)
    results.close()
    assert threading.active_count() == before


@pytest.mark.parametrize("workers", [0, -1, 1.5, 2.0, "2", True, False, [2]])
def test_impossible_workers(workers):
    with pytest.raises(InputError) as caught:
        list(map_threads(abs, [1], workers))
    assert str(caught.value) == f"workers must be a whole number of at least 1, but {workers!r} was given."


@pytest.mark.parametrize("workers", [np.int64(2), np.uint8(1)])
def test_whole_numbers_of_numpy_do(workers):
    assert sorted(map_threads(abs, range(10), workers)) == list(range(10))


def schedule(chunks: int, threads: int, seconds: float) -> tuple[float, int]:
    """Time until all threads are done, and the number of tasks, if every chunk takes these seconds."""
    busy, tasks, place = [0.0] * threads, 0, 0
    while place < chunks:
        size = chunks_per_task(chunks - place, threads, seconds)
        assert 1 <= size <= chunks - place
        heapq.heapreplace(busy, busy[0] + size * seconds)
        place, tasks = place + size, tasks + 1
    return max(busy), tasks


def test_the_first_tasks_are_short() -> None:
    assert chunks_per_task(1_000_000, 1000, None) == 1


def test_long_chunks_are_tasks_of_their_own() -> None:
    assert chunks_per_task(1000, 2, 5.0) == 1
    assert chunks_per_task(1000, 2, MIN_TASK_TIME) == 1


def test_a_chunk_that_takes_no_time_is_no_division_by_zero() -> None:
    assert chunks_per_task(100, 1, 0.0) == 100 // (2 * TASKS_PER_THREAD)


@pytest.mark.parametrize(
    ("chunks", "threads", "seconds"), [(10_000, 2, 0.05), (100_000, 1000, 0.5), (100_000, 1000, 0.05), (50, 16, 0.01)]
)
def test_threads_finish_together_and_the_scheduler_keeps_up(chunks: int, threads: int, seconds: float) -> None:
    time, tasks = schedule(chunks, threads, seconds)
    even = chunks * seconds / threads
    assert even <= time <= 1.02 * even + 2.0 * seconds
    # Beside the tasks of full length there are those at the end, whose number grows as the logarithm.
    assert tasks <= MAX_TASK_RATE * time + 2 * TASKS_PER_THREAD * threads * 12
