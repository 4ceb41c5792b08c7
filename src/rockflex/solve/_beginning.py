"""What runs begin with; arrays that are the same for many runs are made once."""

import math
from functools import lru_cache

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.models import RockingModel
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


def patience_with(model: RockingModel) -> float:
    """Return the longest free vibration until settled, s."""
    p = model.properties
    slowest = float(p.omega.min(initial=math.inf))
    return 2000.0 * 2.0 * math.pi / slowest + 200.0 * math.sqrt(p.i_theta / (p.l0r * GRAVITY))


def writable(values: Array) -> Array:
    """Return an array of the compiled type, which is that of a writable array."""
    if values.flags.carray and values.dtype == np.float64:
        return values
    return np.require(values, dtype=np.float64, requirements=("C", "W"))
