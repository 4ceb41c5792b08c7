"""The peaks of several runs of a case, as columns."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex._errors import InputError, SolverError
from rockflex.motion import GroundMotion
from rockflex.response import STATUSES, Response, columns_among, columns_of
from rockflex.study._case import Case, is_shaken

Scaled = tuple[GroundMotion, float]  # a motion, and the factor on its acceleration


@dataclass(frozen=True, eq=False)
class Peaks:
    """Results of some runs.

    Attributes
    ----------
    count
        Number of runs.
    columns
        The status, as a place in `rockflex.response.STATUSES`, and every scalar of the responses, each of shape
        (count,); empty if all runs failed. The values of runs that failed mean nothing.
    failures
        Errors of the runs that failed, by index.
    """

    count: int
    columns: Mapping[str, NDArray[Any]]
    failures: Mapping[int, InputError | SolverError]

    def rows(self) -> list[dict[str, Any]]:
        """Return the results of each run by name, or its `error`."""
        names = tuple(self.columns)
        values = zip(*(column.tolist() for column in self.columns.values()), strict=True)
        rows = [dict(zip(names, row, strict=True)) for row in values] or [{} for _ in range(self.count)]
        for place, row in enumerate(rows):
            if place in self.failures:
                rows[place] = {"error": str(self.failures[place])}
            else:
                row["status"] = STATUSES[row["status"]]
        return rows


def peaks_among(results: Sequence[Response | InputError | SolverError]) -> Peaks:
    """Return the peaks of runs, each of which has a response or failed."""
    failures = {place: each for place, each in enumerate(results) if not isinstance(each, Response)}
    found = [each if isinstance(each, Response) else None for each in results]
    return Peaks(len(results), columns_among(found), failures)


def peaks_of(case: Case, runs: Sequence[Scaled]) -> Peaks:
    """Run motions, each at a scale, on a case without a history."""
    columns, failures = dict[str, NDArray[Any]](), dict[int, InputError | SolverError]()
    parts = _alike(runs)
    for dt, shaken, places in parts:
        some = [runs[place] for place in places]
        try:
            solutions = case.solve_all(some, dt, shaken=shaken)
        except (InputError, SolverError) as error:  # none of them can begin
            failures |= dict.fromkeys(places, error)
            continue
        failures |= {places[place]: error for place, error in solutions.failures.items()}
        found = columns_of(case.model, solutions)
        if len(parts) == 1:
            return Peaks(len(runs), found, failures)
        for name, values in found.items():
            columns.setdefault(name, np.zeros(len(runs), values.dtype))[places] = values
    return Peaks(len(runs), columns, failures)


def _alike(runs: Sequence[Scaled]) -> list[tuple[float, bool, list[int]]]:
    """Return the places of the runs with the same time step, and with or without vertical motion."""
    found = dict[tuple[float, bool], list[int]]()
    for place, (motion, _) in enumerate(runs):
        found.setdefault((motion.dt, is_shaken(motion)), []).append(place)
    return [(dt, shaken, places) for (dt, shaken), places in found.items()]
