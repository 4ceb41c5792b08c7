"""What a solver returns, whichever engine found it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """One run: the peaks of every row, the events' count and, where kept, the nodes of its history.

    Parameters
    ----------
    overturned, settled
        How the run ended: at a quarter turn, or at rest (neither: at the end of the time asked for).
    end_time
        Time of the last state, s.
    peaks, peak_times
        Largest magnitude of each row and its time (s), shape (F,); row 0 is the rotation.
    lost_support, time_of_lost_support
        Largest fall of the vertical reaction below its value at rest, N; negative where it never rested. And when, s.
    n_uplifts, n_impacts
        Number of uplifts and of impacts.
    nodes
        One row a node: time, side, ground acceleration, D (N), D' (N), θ, θ'. Both sides of every jump are nodes.
        None where only peaks were asked for.
    """

    overturned: bool
    settled: bool
    end_time: float
    peaks: Array
    peak_times: Array
    lost_support: float
    time_of_lost_support: float
    n_uplifts: int
    n_impacts: int
    nodes: Array | None
