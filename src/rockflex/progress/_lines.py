"""Progress as lines of a log: few enough to be read, often enough to see that it goes on."""

import sys
from collections.abc import Callable
from time import perf_counter

from rockflex.progress._duration import duration

SOON, LATE = 30.0, 600.0  # s after the last line: the next one if a tenth more is done, and in any case
SHARE = 0.1


class Lines:
    """Lines on stderr, each with what is done, the time since the start, and the time that it may still take.

    A study of less than half a minute writes none, unless `last`, which asks for one at the end.
    """

    def __init__(self, title: str, *, last: bool, clock: Callable[[], float] = perf_counter) -> None:
        self.title, self.last, self.clock = title, last, clock
        self.start = self.told_at = clock()
        self.first: int | None = None  # done before the start, by an earlier call
        self.told = 0

    def show(self, done: int, total: int, remark: str = "") -> None:
        """Write a line if it is time for one."""
        now = self.clock()
        if self.first is None:
            self.first = self.told = done
        waited, end = now - self.told_at, done >= total
        due = waited >= LATE or (waited >= SOON and done - self.told >= SHARE * total)
        if due or (end and self.last):
            self.told_at, self.told = now, done
            print(self._line(done, total, remark, now - self.start), file=sys.stderr, flush=True)

    def _line(self, done: int, total: int, remark: str, elapsed: float) -> str:
        made = done - (self.first or 0)
        text = f"{self.title}: {done} of {total} ({100 * done // max(total, 1)} %), {duration(elapsed)} elapsed"
        if made and done < total:
            text += f", about {duration(elapsed / made * (total - done))} left"
        return f"{text}, {remark}" if remark else text
