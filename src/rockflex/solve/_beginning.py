"""The arrays with which runs begin; those that are the same for many runs are made once."""

from functools import lru_cache

import numpy as np

from rockflex._arrays import Array
from rockflex.solve._pace import Pace


@lru_cache(maxsize=64)
def first_peaks(rows: int, signed: int, turning: int) -> Array:
    """Return the peaks at the start of a run; `turning` is the row of θ', if any, whose peak nobody asks for."""
    peaks = np.zeros(rows)
    peaks[signed:] = -np.inf
    peaks[turning : turning + 1] = np.inf
    return peaks


@lru_cache(maxsize=64)
def prices_of(modes: int, rows: int, history: bool) -> Array:
    """Return what the kinds of work cost in s, after the work left."""
    return np.array((0.0, *Pace(modes, rows, 0.0).prices(history=history)))


def writable(values: Array) -> Array:
    """Return an array of the compiled type, which is that of a writable array."""
    if values.flags.carray and values.dtype == np.float64:
        return values
    return np.require(values, dtype=np.float64, requirements=("C", "W"))
