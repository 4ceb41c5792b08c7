"""A model prepared for runs, and the loop that executes them slice by slice."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError, SolverError
from rockflex._kernel import Entry
from rockflex.models import HEADER, Key, NonlinearModel, Quantities, RockingModel, impact_of
from rockflex.solve._beginning import course_of, first_peaks, prices_of, samples_in
from rockflex.solve._desk import desks_of
from rockflex.solve._failures import failure_of, failure_of_law, failure_of_limit
from rockflex.solve._flow import flow_in, flow_of
from rockflex.solve._pace import Pace, pace_of
from rockflex.solve._preparing import phases_of, preparing
from rockflex.solve._solution import Solution
from rockflex.solve._solutions import Solutions
from rockflex.solve._task import Gate, Task
from rockflex.solve.adaptive.layout import Integrator, stages_of
from rockflex.solve.batch import (
    BEGUN,
    BROKEN,
    ENDED,
    FAILED,
    PRESENT,
    RUN,
    SLICE,
    Batch,
    Excitation,
    batch_of,
    run_all,
)
from rockflex.solve.history import MARGIN
from rockflex.solve.interruption import check_interruption
from rockflex.solve.layout import KEPT, Course, Log, Motion, Progress, System
from rockflex.solve.phases import CompiledPhases
from rockflex.solve.progress import progress_at_start
from rockflex.solve.status import Status

EVENTS = 512  # initial room in a history for states between samples
SLICE_OF_WORK = 0.1  # s
TOLERANCE = 1e-10  # relative, of a step

# Separate entries, because their argument types differ: the first has no vector field and is compiled without
# integrator.
_closed_form, _integrated = Entry(run_all), Entry(run_all)


class Engine:
    """A model with its phases, compiled as needed, for every time step used so far.

    Parameters
    ----------
    model
        The model.
    quantities
        Quantities whose peaks are computed.
    extremes
        Quantities of which only the largest value matters, not the magnitude.
    tolerance
        Relative error tolerance per step of integrated phases.
    """

    def __init__(
        self,
        model: RockingModel,
        quantities: Quantities,
        extremes: Quantities | None = None,
        tolerance: float = TOLERANCE,
    ) -> None:
        self.model = model
        most = 0 if extremes is None else len(extremes)
        # The guard, which is the rotation, the quantities, those of which only the largest value matters, and the loss
        # of support.
        self._n_rows = 2 + len(quantities) + model.turning + most
        self._n_peaks = 1 + len(quantities)
        self._signed = self._n_peaks + model.turning
        self._impact, self._failures = impact_of(model.law, model.properties)
        self._desks = desks_of(model.layout, self._n_rows + model.most_fences)
        self._gate = Gate()
        self._phases = phases_of(model, quantities, extremes)
        self._flow = None
        if isinstance(model, NonlinearModel):
            with preparing(model):
                self._flow = flow_of(model, quantities, tolerance)

    @property
    def dense(self) -> bool:
        """Whether some phase so far cannot be uncoupled."""
        return self._phases.dense

    @property
    def size(self) -> int:
        """Memory of all tables so far in bytes."""
        return self._phases.size

    @cached_property
    def pace(self) -> Pace:
        """The properties that determine the work of runs."""
        return pace_of(self.model, self._n_rows)

    def task(self, run: Excitation, dt: float, free_vibration: float | None = 0.0, *, history: bool = False) -> Task:
        """Return the task of a run, which estimates its work."""
        return Task(self.model, self.pace, run.acceleration, dt, free_vibration, history, run.scale)

    def run(
        self,
        acceleration: Array,
        dt: float,
        *,
        free_vibration: float | None = 0.0,
        state: Array | tuple[Key, Array] | None = None,
        history: bool = False,
        work_limit: float | None = None,
        slice_of_work: float = SLICE_OF_WORK,
        vertical: Array | None = None,
    ) -> Solution:
        """Run one record as `run_all` does, and return its solution or raise its error."""
        found = self.run_all(
            [Excitation(acceleration, vertical)],
            dt,
            free_vibration=free_vibration,
            state=state,
            history=history,
            work_limit=work_limit,
            slice_of_work=slice_of_work,
        )
        return found.one(0)

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
        """Run records, each followed by `free_vibration` s (None: until settled), from a state [D.., D'.., θ, θ'].

        The state may also be that of a run that goes on: its branches, and all that the layout holds.

        The ground moves vertically in all runs, or in none. `work_limit` is the limit of the estimated and of the
        actual work of each run in s, see `Pace`; None means no limit. After every `slice_of_work`, in s, the runs can
        be interrupted by Ctrl-C or `stopping_when`. Only a single run can have a `history`, which keeps every state.

        The failures of the result are the errors of single runs: a run that exceeds its work limit (`WorkLimitError`
        before it begins), a user-defined impact law that fails or a time step that is too long (`InputError`), events
        that accumulate without end, a motion that does not settle, or impacts that would gain energy (`SolverError`).

        Raises
        ------
        InputError
            If the initial state does not fit, or the numbers of the model overflow.
        RunStoppedError
            If the runs were stopped from outside.
        """
        tasks = [self.task(run, dt, free_vibration, history=history) for run in runs]
        failures = self._gate.refused(tasks, work_limit)
        if len(failures) == len(tasks):
            start, log = np.zeros(self.model.layout.size), self._log(tasks[0], history=False)
            return self._solutions(batch_of([None] * len(tasks), progress_at_start(0), start, log), dt, failures)
        begun = self._at_rest if state is None else state
        key, start = begun if isinstance(begun, tuple) else self.model.initial(begun)
        shaken = runs[0].vertical is not None
        phases = self._phases.at(dt, self.pace.fastest, shaken=shaken)
        progress = progress_at_start(self._place(phases, key))
        accepted = [None if place in failures else run for place, run in enumerate(runs)]
        log = self._log(tasks[0], history=history)
        batch = batch_of(accepted, progress, start, log, work_limit)
        course = course_of(self.model, dt, free_vibration)
        steps, desk = None, self._desks.taken()
        while batch.place[RUN] < len(tasks):
            try:
                system = phases.known_system(dt, shaken=shaken)
                if system is None:
                    self._check_tables(phases, tasks[batch.place[RUN]], work_limit)
                    with preparing(self.model):
                        system = phases.system(dt, self.pace.fastest, shaken=shaken)
                motion = desk.motion(phases.terms)
                steps = steps or self._integrator(motion, log, progress[PRESENT])
                batch.work[SLICE] = slice_of_work
                status = self._carry(system, steps, course, progress[PRESENT], log, motion, batch)
                if status != ENDED:
                    log = self._resumed(status, phases, tasks[batch.place[RUN]], work_limit, log, batch, motion)
            except (InputError, SolverError) as error:
                failures[int(batch.place[RUN])] = error
                batch.place[RUN] += 1
                batch.place[BEGUN] = False
            check_interruption()
        self._desks.returned(desk)
        return self._solutions(batch, dt, failures, log.history[: log.tally[KEPT]] if history else None)

    def _resumed(
        self,
        status: int,
        phases: CompiledPhases,
        task: Task,
        work_limit: float | None,
        log: Log,
        batch: Batch,
        motion: Motion,
    ) -> Log:
        """Provide what an interrupted run needs to continue, and return its log; raise if it must not continue."""
        at = batch.progress[PRESENT]
        if status == BROKEN:
            raise failure_of_law(self.model, self._failures.pop())
        if status == Status.LACKS_PHASE:
            with preparing(self.model):
                phases.meet(int(at.phase), int(at.lacking))
        elif batch.place[BEGUN] and batch.ends[batch.place[RUN]].left < 0.0:
            raise failure_of_limit(task, int(at.offset) + int(at.index), work_limit, motion.state)
        elif task.history and log.tally[KEPT] > log.history.shape[0] - MARGIN:
            task.check_room(2 * log.history.shape[0])
            return log._replace(history=np.concatenate((log.history, np.zeros_like(log.history))))
        return log

    def _check_tables(self, phases: CompiledPhases, task: Task, work_limit: float | None) -> None:
        """Check the work of a run before the tables of a dense phase are computed, which may take longest of all."""
        if phases.dense:
            fastest = max(self.pace.fastest, phases.fastest)
            replace(task, pace=replace(self.pace, fastest=fastest, dense=True)).check(work_limit)

    @cached_property
    def _at_rest(self) -> tuple[Key, Array]:
        return self.model.initial(None)

    def _log(self, task: Task, *, history: bool) -> Log:
        rows, free = self._n_rows, task.free_vibration
        room_for = 0
        if history:
            room_for = task.record.size + EVENTS + MARGIN + (0 if free is None else samples_in(free, task.dt))
        return Log(
            peaks=first_peaks(rows, self._signed, self._n_peaks if self.model.turning else rows).copy(),
            times=np.zeros(rows),
            tally=np.zeros(4, dtype=np.int64),
            work=prices_of(self.model.layout.modes, rows, history).copy(),
            history=np.zeros((room_for, HEADER + self.model.layout.size)),
            signed=self._signed,
        )

    def _place(self, phases: CompiledPhases, key: Key) -> int:
        """Return the index of the phase in which a run starts."""
        if phases.knows(key):
            return phases.place(key)
        with preparing(self.model):
            return phases.place(key)

    def _integrator(self, motion: Motion, log: Log, at: Progress) -> Integrator | None:
        if self._flow is None:
            return None
        motion.pivots[:] = self._flow.field.pivots
        flow = flow_in(self._flow, motion.pivots, ledger=log.history.shape[0] > 0)
        return Integrator(flow, stages_of(motion.state, self.model.layout.core + 1, self._n_rows, log.work, at))

    def _carry(
        self,
        system: System,
        steps: Integrator | None,
        course: Course,
        at: Progress,
        log: Log,
        motion: Motion,
        batch: Batch,
    ) -> int:
        carry = _closed_form if steps is None else _integrated
        return carry(system, steps, self._impact, course, at, log, motion, batch)

    def _solutions(
        self, batch: Batch, dt: float, failures: dict[int, InputError | SolverError], states: Array | None = None
    ) -> Solutions:
        if batch.place[FAILED]:
            for place, end in enumerate(batch.ends):
                if end.status < 0 and place not in failures:
                    status, samples = Status(int(end.status)), int(end.samples)
                    failures[place] = failure_of(self.model, status, samples, dt, batch.states[place])
        return Solutions(batch, dt, self._n_peaks, self._signed, failures, states)
