"""What shakes a run, how it ends, and the results of one run or of a batch."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array, Bools, Integers
from rockflex.foundation.errors import InputError, SolverError


class Status(IntEnum):
    """The status of a run; negative values are failures, with a message and a remedy.

    The placeholders in the texts are the `label` of the model, the impact `law`, and the `time` in s.
    """

    what: str
    mend: str

    def __new__(cls, value: int, what: str = "", mend: str = "") -> "Status":
        """Create a member that is a number."""
        member = int.__new__(cls, value)
        member._value_ = value
        member.what, member.mend = what, mend
        return member

    ENDED = 0
    OVERTURNED = 1
    SETTLED = 2
    CHATTER = (
        -2,
        "The events of {label}, such as impacts, accumulate without end in the sample before {time:.6g} s.",
        "Check the model's parameters, and refine the record.",
    )
    GAINED = (
        -3,
        "The impact law {law} returns energy in the sample before {time:.6g} s.",
        "A law can only lose energy: correct its `after`, or lower its restitution.",
    )
    STALLED = (
        -4,
        "The motion of {label} cannot be integrated in the sample before {time:.6g} s: no step is short enough.",
        "Check the parameters.",
    )
    UNSETTLED = (
        -5,
        "The free vibration of {label} has not settled {time:.6g} s after the start.",
        "Give free_vibration in seconds, or more damping.",
    )
    INFINITE = -6, "The motion of {label} is not finite at {time:.6g} s.", "Check the parameters."


OVERTURNED, SETTLED = int(Status.OVERTURNED), int(Status.SETTLED)


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
    n_uplifts, n_impacts, n_guarded
        Number of uplifts, of impacts, and of those at which the guard of the impact law acted.
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
    n_guarded: int
    final_state: Array
    states: Array | None


class Ends(NamedTuple):
    """How R runs ended."""

    status: Integers  # (R,): of `Status`
    samples: Integers  # (R,): completed
    uplifts: Integers  # (R,)
    impacts: Integers  # (R,)
    guarded: Integers  # (R,)
    peaks: Array  # (R, F)
    times: Array  # (R, F)
    states: Array  # (R, S): the last ones


@dataclass(frozen=True, slots=True, eq=False)
class Solutions:
    """The results of R runs of a model, as in `Solution`, with a first axis for the runs.

    Parameters
    ----------
    ends
        How the runs ended.
    dt
        Time step, s.
    n_peaks
        Number of rows whose peaks were asked for, the first ones.
    signed
        Of the rows from this one on only the largest value matters; the last one is the loss of support.
    failures
        Errors of the runs that could not be solved, by their index; their other results mean nothing.
    states
        Of a single run with a history.
    """

    ends: Ends
    dt: float
    n_peaks: int
    signed: int
    failures: Mapping[int, InputError | SolverError]
    states: Array | None

    def __len__(self) -> int:
        return len(self.ends.status)

    @property
    def overturned(self) -> Bools:
        """Whether each run ended at a rotation of π/2, shape (R,)."""
        return np.asarray(self.ends.status == OVERTURNED)

    @property
    def settled(self) -> Bools:
        """Whether each run ended at rest, shape (R,)."""
        return np.asarray(self.ends.status == SETTLED)

    @property
    def end_time(self) -> Array:
        """Time of the last state in s, shape (R,)."""
        return np.where(self.overturned, self.ends.times[:, 0], self.ends.samples * self.dt)

    @property
    def peaks(self) -> Array:
        """Largest magnitude of each row, shape (R, F)."""
        return self.ends.peaks[:, : self.n_peaks]

    @property
    def peak_times(self) -> Array:
        """Its time in s, shape (R, F)."""
        return self.ends.times[:, : self.n_peaks]

    @property
    def lost_support(self) -> Array:
        """Largest decrease of the vertical reaction below its value at rest in N, shape (R,)."""
        return self.ends.peaks[:, -1]

    @property
    def time_of_lost_support(self) -> Array:
        """Its time in s, shape (R,)."""
        return self.ends.times[:, -1]

    @property
    def n_uplifts(self) -> Integers:
        """Number of uplifts, shape (R,)."""
        return self.ends.uplifts

    @property
    def n_impacts(self) -> Integers:
        """Number of impacts, shape (R,)."""
        return self.ends.impacts

    @property
    def guarded_impacts(self) -> Array:
        """Share of the impacts at which the guard of the impact law acted, shape (R,); zero without impacts."""
        return self.ends.guarded / np.maximum(self.ends.impacts, 1)

    @property
    def final_state(self) -> Array:
        """The last states, shape (R, S')."""
        return self.ends.states

    def one(self, index: int) -> Solution:
        """Return the result of one run; raises its error if it could not be solved."""
        if index in self.failures:
            raise self.failures[index]
        status, samples, uplifts, impacts, guarded = (int(each[index]) for each in self.ends[:5])
        peaks, times = self.ends.peaks[index], self.ends.times[index]
        overturned = status == OVERTURNED
        return Solution(
            overturned=overturned,
            settled=status == SETTLED,
            end_time=float(times[0]) if overturned else samples * self.dt,
            peaks=peaks[: self.n_peaks],
            peak_times=times[: self.n_peaks],
            extremes=peaks[self.signed : -1],
            extreme_times=times[self.signed : -1],
            lost_support=float(peaks[-1]),
            time_of_lost_support=float(times[-1]),
            n_uplifts=uplifts,
            n_impacts=impacts,
            n_guarded=guarded,
            final_state=self.ends.states[index],
            states=self.states,
        )
