"""Maps over independent tasks."""

from rockflex.parallel._threads import map_threads

__all__ = ["map_threads"]
