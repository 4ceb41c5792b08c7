"""Runs on the engine for hybrid systems, behind a switch: the environment variable ROCKFLEX_ENGINE is "hybrid".

It takes the simplified models without elements on rigid ground, with the interface of `Engine`.
"""

import os
from collections import defaultdict
from collections.abc import Sequence
from typing import TypeGuard, cast

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError, SolverError
from rockflex.engine import Run
from rockflex.models import GROUND, HEADER, SIDE, TIME, Key, LinearModel, Quantities, RockingModel, system_of
from rockflex.solve._beginning import QUIET, course_of
from rockflex.solve._failures import failure_of, failure_of_law
from rockflex.solve._solutions import Ends, Solutions
from rockflex.solve.batch import Excitation
from rockflex.solve.engine import SLICE_OF_WORK, Engine
from rockflex.solve.interruption import check_interruption
from rockflex.solve.records import END
from rockflex.solve.status import Status


def takes(model: RockingModel) -> TypeGuard[LinearModel]:
    """Return whether the switch is on, and the model one of those that the engine can run so far."""
    return os.environ.get("ROCKFLEX_ENGINE") == "hybrid" and type(model) is LinearModel and not model.elements


class HybridEngine(Engine):
    """A model on the engine for hybrid systems."""

    def __init__(
        self, model: LinearModel, quantities: Quantities, extremes: Quantities | None = None, *, many: bool = False
    ) -> None:
        super().__init__(model, quantities, extremes, many=many)
        self._system = system_of(model, quantities, extremes)
        self._free = defaultdict[float, list[Run]](list)

    def run_all(
        self,
        runs: Sequence[Excitation],
        dt: float,
        *,
        free_vibration: float | None = 0.0,
        state: Array | tuple[Key, Array] | None = None,
        history: bool = False,
        work_limit: float | None = None,
        slice_of_work: float = SLICE_OF_WORK,
    ) -> Solutions:
        """As in `Engine`."""
        if any(run.vertical is not None for run in runs):
            return super().run_all(
                runs,
                dt,
                free_vibration=free_vibration,
                state=state,
                history=history,
                work_limit=work_limit,
                slice_of_work=slice_of_work,
            )
        tasks = [self.task(run, dt, free_vibration, history=history) for run in runs]
        failures = self._refused(tasks, work_limit)
        key, start = state if isinstance(state, tuple) else self.model.initial(state)
        free = self._free[dt]
        solver = free.pop() if free else Run(self._system, dt)
        rows, states = len(self._system.outputs), None
        found = Ends(
            ends=np.zeros(len(runs), dtype=END),
            peaks=np.zeros((len(runs), rows)),
            times=np.zeros((len(runs), rows)),
            states=np.zeros((len(runs), start.size)),
        )
        for place, run in enumerate(runs):
            check_interruption()
            if place in failures:
                continue
            solver.restart(start, key)
            end = found.ends[place]
            try:
                end.status = self._follow(solver, run, dt, free_vibration, history=history)
                end.samples = round(solver.time / dt)
                if end.status < 0:
                    failures[place] = failure_of(self.model, Status(end.status), int(end.samples), dt, solver.state)
            except (InputError, SolverError) as error:
                failures[place] = error
                continue
            names = [name for _, _, name in solver.events]
            end.uplifts, end.impacts = names.count("uplift"), names.count("impact")
            found.peaks[place], found.times[place] = np.array(list(solver.peaks.values())).T
            found.states[place] = solver.state
            if history:
                states = self._states(solver)
        free.append(solver)
        return Solutions(found, dt, self._n_peaks, self._signed, failures, states)

    def _follow(self, solver: Run, run: Excitation, dt: float, free: float | None, *, history: bool) -> int:
        """Run the record and the free vibration; the status at the end."""
        try:
            solver.advance(run.acceleration * run.scale, history)
            samples = course_of(self.model, dt, free).free
            if free is None:
                if solver.settle(samples, history=history):
                    return Status.SETTLED
                return Status.OVERTURNED if solver.ended else Status.UNSETTLED
            while samples > 0 and not solver.ended:
                check_interruption()
                piece = min(samples, QUIET.size - 1)
                solver.advance(QUIET[: piece + 1], history)
                samples -= piece
        except (InputError, SolverError):
            raise
        except Exception as error:
            raise failure_of_law(self.model, error) from error
        return Status.OVERTURNED if solver.ended else Status.ENDED

    def _states(self, solver: Run) -> Array:
        times, keys, ground, states = solver.history
        rows = np.zeros((times.size, HEADER + self.model.layout.size))
        rows[:, TIME], rows[:, GROUND], rows[:, HEADER:] = times, ground, states
        rows[:, SIDE] = [key[0] for key in cast("list[Key]", keys)]
        return rows
