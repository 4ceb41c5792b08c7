"""How many chunks make one task of a cluster."""

AHEAD = 2  # tasks in flight for each thread of the cluster
TASK = 1.0  # s of computing in a task, at least, where there is so much left
RATE = 50.0  # tasks a second that a scheduler is given, at most; it manages several times as many


def batch_size(left: int, threads: int, pace: float | None) -> int:
    """Return how many of the chunks that are left go into the next task.

    A task takes as long as it must for the scheduler to keep up, by the measured time of a chunk, `pace` in s (None
    before any has come back). Near the end tasks become smaller, so that all threads finish together.
    """
    if pace is None:
        return 1
    wanted = max(TASK, threads / RATE) / max(pace, 1e-9)
    fair = left / (2 * AHEAD * threads)
    return max(1, int(min(wanted, fair)))
