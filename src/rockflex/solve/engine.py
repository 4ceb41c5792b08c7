"""A model prepared for runs, and the loop that executes a run slice by slice."""

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._errors import InputError, SolverError
from rockflex._kernel import Entry
from rockflex._shown import shown
from rockflex.models import HEADER, Key, NonlinearModel, Quantities, RockingModel, impact_of
from rockflex.solve._beginning import first_peaks, prices_of, writable
from rockflex.solve._desk import desks_of
from rockflex.solve._flow import flow_in, flow_of
from rockflex.solve._pace import Pace, pace_of
from rockflex.solve._preparing import phases_of, preparing
from rockflex.solve._solution import Solution
from rockflex.solve._task import Task
from rockflex.solve.adaptive.layout import Integrator, stages_of
from rockflex.solve.bare import BarePhases
from rockflex.solve.history import MARGIN
from rockflex.solve.interruption import check_interruption
from rockflex.solve.layout import (
    IMPACTS,
    KEPT,
    LEFT,
    UPLIFTS,
    Course,
    Log,
    Motion,
    Progress,
    System,
)
from rockflex.solve.phases import CompiledPhases
from rockflex.solve.progress import progress_at_start
from rockflex.solve.run import run
from rockflex.solve.status import Status

LEVEL = np.zeros(0)  # no vertical acceleration
QUIET = np.zeros(65)  # free vibration is run in stretches of 64 samples
MOST_SAMPLES = 2.0**62  # of free vibration: more than can ever be computed
EVENTS = 512  # initial room in a history for states between samples
SLICE = 0.1  # of work in s, between checks whether to stop the run
TOLERANCE = 1e-10  # relative, of a step
SIZES = 64  # largest number of sizes of tasks remembered

# Separate entries, because their argument types differ: the first has no vector field and is compiled without
# integrator.
_closed_form, _integrated = Entry(run), Entry(run)


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
    many
        Whether engines of many structures are needed: a kernel then prepares them, which must itself be compiled first.
    """

    def __init__(
        self,
        model: RockingModel,
        quantities: Quantities,
        extremes: Quantities | None = None,
        tolerance: float = TOLERANCE,
        *,
        many: bool = False,
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
        self._accepted = set[tuple[object, ...]]()
        self._phases = phases_of(model, quantities, extremes, many=many)
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

    def task(
        self, acceleration: Array, dt: float, free_vibration: float | None = 0.0, *, history: bool = False
    ) -> Task:
        """Return the task of a run with these arguments, which estimates its work."""
        return Task(self.model, self.pace, acceleration, dt, free_vibration, history)

    def run(
        self,
        acceleration: Array,
        dt: float,
        *,
        free_vibration: float | None = 0.0,
        state: Array | None = None,
        history: bool = False,
        work_limit: float | None = None,
        slice_of_work: float = SLICE,
        vertical: Array | None = None,
    ) -> Solution:
        """Run one record, then `free_vibration` seconds (None: until settled), from a state [D.., D'.., θ, θ'].

        `vertical` is the vertical acceleration of the ground, as long as the record; None if there is none.
        `work_limit` is the limit of the estimated and the actual work in s, see `Pace`; None means no limit. After
        every `slice_of_work`, in s, the run can be interrupted by Ctrl-C or `stopping_when`.

        Raises
        ------
        WorkLimitError
            If the estimated work exceeds the limit.
        InputError
            If the time step is too long, or a user-defined impact law fails.
        SolverError
            If impacts accumulate without end, the motion does not settle, an impact would gain energy, or the run
            reached its work limit.
        RunStoppedError
            If the run was stopped from outside.
        """
        task = self.task(acceleration, dt, free_vibration, history=history)
        self._check(task, work_limit)
        key, start = self._at_rest if state is None else self.model.initial(state)
        shaken = vertical is not None
        phases = self._phases.at(dt, self.pace.fastest, shaken=shaken)
        at = progress_at_start(self._place(phases, key), stated=True)
        course = self._course(acceleration, vertical, dt, free_vibration)
        log = self._log(course, history=history)
        left = math.inf if work_limit is None else work_limit
        steps = None
        desk = self._desks.taken(start)
        while True:
            system = phases.known_system(dt, shaken=shaken)
            if system is None:
                with preparing(self.model):
                    system = phases.system(dt, self.pace.fastest, shaken=shaken)
            motion = desk.motion(phases.terms)
            steps = steps or self._integrator(motion, log, at)
            given = min(slice_of_work, left)
            log.work[LEFT] = given
            status = self._carry(system, steps, course, at, log, motion)
            left -= given - float(log.work[LEFT])
            if status == Status.LACKS_PHASE:
                with preparing(self.model):
                    phases.meet(int(at.phase), int(at.lacking))
                if phases.dense:
                    fastest = max(self.pace.fastest, phases.fastest)
                    replace(task, pace=replace(self.pace, fastest=fastest, dense=True)).check(work_limit)
            elif status != Status.PAUSED:
                break
            elif left < 0.0:
                self._spent(at, dt, motion.state, task, work_limit)
            elif history and log.tally[KEPT] > log.history.shape[0] - MARGIN:
                task.check_room(2 * log.history.shape[0])
                log = log._replace(history=np.concatenate((log.history, np.zeros_like(log.history))))
            check_interruption()
        self._complain(status, at, dt, motion.state)
        self._desks.returned(desk)
        return self._solution(status, at, dt, log, motion.state.copy(), history=history)

    @cached_property
    def _at_rest(self) -> tuple[Key, Array]:
        return self.model.initial(None)

    def _check(self, task: Task, limit: float | None) -> None:
        """Check a task against the work limit, unless one of the same size was accepted before."""
        size = task.size
        if size is None or (size, limit) not in self._accepted:
            task.check(limit)
            if len(self._accepted) >= SIZES:
                self._accepted.clear()
            self._accepted.add((size, limit))

    def _log(self, course: Course, *, history: bool) -> Log:
        rows = self._n_rows
        room_for = course.record.size + EVENTS + (0 if course.settle else course.free) + MARGIN if history else 0
        peaks = first_peaks(rows, self._signed, self._n_peaks if self.model.turning else rows).copy()
        work = prices_of(self.model.layout.modes, rows, history).copy()
        kept = np.zeros((room_for, HEADER + self.model.layout.size))
        return Log(peaks, np.zeros(rows), np.zeros(4, dtype=np.int64), work, kept, self._signed)

    def _place(self, phases: CompiledPhases | BarePhases, key: Key) -> int:
        """Return the index of the phase in which a run starts."""
        if phases.knows(key):
            return phases.place(key)
        with preparing(self.model):
            return phases.place(key)

    def _course(self, acceleration: Array, vertical: Array | None, dt: float, free_vibration: float | None) -> Course:
        after = self._patience() if free_vibration is None else free_vibration
        return Course(
            record=writable(acceleration),
            vertical=LEVEL if vertical is None else writable(vertical),
            quiet=QUIET,
            dt=dt,
            free=math.ceil(min(after / dt, MOST_SAMPLES) - 1e-9),
            settle=free_vibration is None,
        )

    def _integrator(self, motion: Motion, log: Log, at: Progress) -> Integrator | None:
        if self._flow is None:
            return None
        motion.pivots[:] = self._flow.field.pivots
        flow = flow_in(self._flow, motion.pivots, ledger=log.history.shape[0] > 0)
        return Integrator(flow, stages_of(motion.state, self.model.layout.core + 1, self._n_rows, log.work, at))

    def _carry(
        self, system: System, steps: Integrator | None, course: Course, at: Progress, log: Log, motion: Motion
    ) -> int:
        carry = _closed_form if steps is None else _integrated
        return carry(system, steps, self._impact, course, at, log, motion)

    def _patience(self) -> float:
        """Return the longest free vibration until settled, s."""
        p = self.model.properties
        slowest = float(p.omega.min(initial=math.inf))
        return 2000.0 * 2.0 * math.pi / slowest + 200.0 * math.sqrt(p.i_theta / (p.l0r * GRAVITY))

    def _solution(self, status: int, at: Progress, dt: float, log: Log, state: Array, *, history: bool) -> Solution:
        overturned = status == Status.OVERTURNED
        return Solution(
            overturned=overturned,
            settled=status == Status.SETTLED,
            end_time=float(log.times[0]) if overturned else _samples(at) * dt,
            peaks=log.peaks[: self._n_peaks],
            peak_times=log.times[: self._n_peaks],
            extremes=log.peaks[self._signed : -1],
            extreme_times=log.times[self._signed : -1],
            lost_support=float(log.peaks[-1]),
            time_of_lost_support=float(log.times[-1]),
            n_uplifts=int(log.tally[UPLIFTS]),
            n_impacts=int(log.tally[IMPACTS]),
            final_state=state,
            states=log.history[: log.tally[KEPT]] if history else None,
        )

    def _spent(self, at: Progress, dt: float, state: Array, task: Task, work_limit: float | None) -> None:
        """Raise the error of a run that reached its work limit."""
        what, mend = task.stopped(_samples(at) * dt, work_limit)
        self._raise(what, mend, state)

    def _complain(self, status: int, at: Progress, dt: float, state: Array) -> None:
        """Raise if the run could not be solved."""
        if status >= 0 and np.isfinite(state[: self.model.layout.core]).all():
            return
        law = shown(self.model.law)
        if Status(status) is Status.BROKEN:
            failure = self._failures.pop()
            raise InputError(f"{Status.BROKEN.what.format(law=law)}: {failure}") from failure
        ended = Status.INFINITE if status >= 0 else Status(status)
        # A failure inside a sample is reported with the time at the end of the sample.
        time = (_samples(at) + (ended not in (Status.UNSETTLED, Status.INFINITE))) * dt
        self._raise(ended.what.format(label=self.model.label, law=law, time=time), ended.mend, state)

    def _raise(self, what: str, mend: str, state: Array) -> None:
        values = ", ".join(f"{value:.6g}" for value in state[: self.model.layout.core])
        raise SolverError(f"{what} The state [D, D', θ, θ'] there is [{values}]. {mend}")


def _samples(at: Progress) -> int:
    """Return the number of completed samples."""
    return int(at["offset"]) + int(at["index"])
