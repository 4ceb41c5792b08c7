"""The results of a batch of runs."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array, Bools, Integers
from rockflex._errors import InputError, SolverError
from rockflex.solve._solution import Solution
from rockflex.solve.batch import Batch
from rockflex.solve.status import Status


@dataclass(frozen=True, slots=True, eq=False)
class Solutions:
    """The results of R runs of a model, as in `Solution`, with a first axis for the runs.

    Parameters
    ----------
    overturned, settled, end_time, n_uplifts, n_impacts, lost_support, time_of_lost_support
        Shape (R,).
    peaks, peak_times
        Shape (R, F).
    extremes, extreme_times
        Shape (R, E).
    final_state
        Shape (R, S').
    states
        Of a single run with a history.
    failures
        Errors of the runs that could not be solved, by their index; their other results mean nothing.
    """

    overturned: Bools
    settled: Bools
    end_time: Array
    peaks: Array
    peak_times: Array
    extremes: Array
    extreme_times: Array
    lost_support: Array
    time_of_lost_support: Array
    n_uplifts: Integers
    n_impacts: Integers
    final_state: Array
    states: Array | None
    failures: Mapping[int, InputError | SolverError]

    def __len__(self) -> int:
        return len(self.end_time)

    @property
    def solved(self) -> list[int]:
        """Indices of the runs that did not fail."""
        return [place for place in range(len(self)) if place not in self.failures]

    def one(self, index: int) -> Solution:
        """Return the result of one run; raises its error if it could not be solved."""
        if index in self.failures:
            raise self.failures[index]
        return Solution(
            overturned=bool(self.overturned[index]),
            settled=bool(self.settled[index]),
            end_time=float(self.end_time[index]),
            peaks=self.peaks[index],
            peak_times=self.peak_times[index],
            extremes=self.extremes[index],
            extreme_times=self.extreme_times[index],
            lost_support=float(self.lost_support[index]),
            time_of_lost_support=float(self.time_of_lost_support[index]),
            n_uplifts=int(self.n_uplifts[index]),
            n_impacts=int(self.n_impacts[index]),
            final_state=self.final_state[index],
            states=self.states,
        )


def solutions_of(
    batch: Batch,
    dt: float,
    n_peaks: int,
    failures: Mapping[int, InputError | SolverError],
    states: Array | None,
    signed: int,
) -> Solutions:
    """Return the results of a batch that has ended.

    The first `n_peaks` rows are those whose peaks were asked for; of those from `signed` on only the largest value
    matters, and the last one is the loss of support.
    """
    ends, peaks, times = batch.ends, batch.peaks, batch.times
    overturned = ends["status"] == Status.OVERTURNED
    return Solutions(
        overturned=overturned,
        settled=ends["status"] == Status.SETTLED,
        end_time=np.where(overturned, times[:, 0], ends["samples"] * dt),
        peaks=peaks[:, :n_peaks],
        peak_times=times[:, :n_peaks],
        extremes=peaks[:, signed:-1],
        extreme_times=times[:, signed:-1],
        lost_support=peaks[:, -1],
        time_of_lost_support=times[:, -1],
        n_uplifts=ends["uplifts"],
        n_impacts=ends["impacts"],
        final_state=batch.states,
        states=states,
        failures=failures,
    )
