"""What runs begin with; arrays that are the same for many runs are made once."""

import math
from functools import lru_cache

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.models import RockingModel
from rockflex.solve._pace import Pace
from rockflex.solve.layout import Course

LEVEL = np.zeros(0)  # no acceleration
QUIET = np.zeros(65)  # free vibration is run in stretches of 64 samples
MOST_SAMPLES = 2.0**62  # of free vibration: more than can ever be computed


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


def course_of(model: RockingModel, dt: float, free_vibration: float | None) -> Course:
    """Return the course of runs, without their records."""
    after = _patience(model) if free_vibration is None else free_vibration
    return Course(LEVEL, LEVEL, QUIET, dt, samples_in(after, dt), free_vibration is None)


def samples_in(time: float, dt: float) -> int:
    """Return the number of samples in some seconds of free vibration."""
    return math.ceil(min(time / dt, MOST_SAMPLES) - 1e-9)


def _patience(model: RockingModel) -> float:
    """Return the longest free vibration until settled, s."""
    p = model.properties
    slowest = float(p.omega.min(initial=math.inf))
    return 2000.0 * 2.0 * math.pi / slowest + 200.0 * math.sqrt(p.i_theta / (p.l0r * GRAVITY))


def writable(values: Array) -> Array:
    """Return an array of the compiled type, which is that of a writable array."""
    if values.flags.carray and values.dtype == np.float64:
        return values
    return np.require(values, dtype=np.float64, requirements=("C", "W"))
