"""How many chunks go into a task."""

import heapq

import pytest

from rockflex.parallel._batches import AHEAD, RATE, TASK, batch_size


def schedule(chunks: int, threads: int, seconds: float) -> tuple[float, int]:
    """Time until all threads are done, and the number of tasks, if every chunk takes these seconds."""
    busy, tasks, place = [0.0] * threads, 0, 0
    while place < chunks:
        size = batch_size(chunks - place, threads, seconds)
        assert 1 <= size <= chunks - place
        heapq.heapreplace(busy, busy[0] + size * seconds)
        place, tasks = place + size, tasks + 1
    return max(busy), tasks


def test_the_first_tasks_are_short() -> None:
    assert batch_size(1_000_000, 1000, None) == 1


def test_long_chunks_are_tasks_of_their_own() -> None:
    assert batch_size(1000, 2, 5.0) == 1
    assert batch_size(1000, 2, TASK) == 1


def test_a_chunk_that_takes_no_time_is_no_division_by_zero() -> None:
    assert batch_size(100, 1, 0.0) == 100 // (2 * AHEAD)


@pytest.mark.parametrize(
    ("chunks", "threads", "seconds"), [(10_000, 2, 0.05), (100_000, 1000, 0.5), (100_000, 1000, 0.05), (50, 16, 0.01)]
)
def test_threads_finish_together_and_the_scheduler_keeps_up(chunks: int, threads: int, seconds: float) -> None:
    time, tasks = schedule(chunks, threads, seconds)
    even = chunks * seconds / threads
    assert even <= time <= 1.02 * even + 2.0 * seconds
    # Beside the tasks of full length there are those at the end, whose number grows as the logarithm.
    assert tasks <= RATE * time + 2 * AHEAD * threads * 12
