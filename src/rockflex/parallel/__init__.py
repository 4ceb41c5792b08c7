"""Maps over independent tasks."""

from rockflex.parallel._dask import Chunks, ClusterError, map_dask
from rockflex.parallel._threads import core_count, map_threads, worker_count

__all__ = [
    "Chunks",
    "ClusterError",
    "core_count",
    "map_dask",
    "map_threads",
    "worker_count",
]
