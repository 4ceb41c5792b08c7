"""What shakes a run, and its result."""

from dataclasses import dataclass
from typing import NamedTuple

from rockflex._arrays import Array


class Excitation(NamedTuple):
    """What shakes the ground in a run."""

    acceleration: Array  # (n,): horizontal, m/s²
    vertical: Array | None = None  # (n,): vertical, m/s²
    scale: float = 1.0  # factor on both


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """The result of one run: the peaks of all rows, event counts and, optionally, the states of the history.

    Parameters
    ----------
    overturned, settled
        How the run ended: at a rotation of π/2, or at rest; neither means at the end of the given time.
    end_time
        Time of the last state, s.
    peaks, peak_times
        Largest magnitude of each row and its time (s), shape (F,); row 0 is the rotation.
    extremes, extreme_times
        Largest values of the quantities of which only these matter, and their times (s).
    lost_support, time_of_lost_support
        Largest decrease of the vertical reaction below its value at rest in N (negative if it was always above), and
        its time in s.
    n_uplifts, n_impacts
        Number of uplifts and of impacts.
    final_state
        The last state: [D.., D'.., θ, θ', ..] as in `rockflex.models.StateLayout`. If the run has settled with the base
        open, θ is the rotation that remains. Energies of integrated models are known only with a history.
    states
        One row per state: time, side, ground acceleration, D (N), D' (N), θ, θ'. There are states before and after
        every jump. None if only peaks were requested.
    """

    overturned: bool
    settled: bool
    end_time: float
    peaks: Array
    peak_times: Array
    extremes: Array
    extreme_times: Array
    lost_support: float
    time_of_lost_support: float
    n_uplifts: int
    n_impacts: int
    final_state: Array
    states: Array | None
