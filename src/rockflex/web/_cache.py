"""A cache in memory of the latest values of all visitors."""

from collections import OrderedDict
from collections.abc import Callable
from threading import Lock
from typing import Generic, TypeVar

Cached = TypeVar("Cached")


class LatestValuesCache(Generic[Cached]):
    """The values last stored or read, by their keys, as many as fit; safe for threads.

    Parameters
    ----------
    capacity
        Returns the largest sum of the sizes of all values; the last one stays even if it alone is larger.
    size
        Returns the size of a value.
    """

    def __init__(self, capacity: Callable[[], int], size: Callable[[Cached], int] = lambda _: 1) -> None:
        self._values: OrderedDict[str, Cached] = OrderedDict()
        self._lock, self._capacity, self._size = Lock(), capacity, size

    def put(self, key: str, value: Cached) -> None:
        """Store a value, and forget those that have not been used for the longest time."""
        with self._lock:
            self._values[key] = value
            self._values.move_to_end(key)
            while len(self._values) > 1 and sum(map(self._size, self._values.values())) > self._capacity():
                self._values.popitem(last=False)

    def get(self, key: str) -> Cached | None:
        """Return a value; None if it is not, or no longer, stored."""
        with self._lock:
            value = self._values.get(key)
            if value is not None:
                self._values.move_to_end(key)
        return value
