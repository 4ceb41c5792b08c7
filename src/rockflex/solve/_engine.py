"""What the engines share: how a run is set up, how its history finds room, and how it ends."""

import math
from abc import ABC, abstractmethod
from contextlib import AbstractContextManager
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rockflex._computable import computable
from rockflex._constants import GRAVITY
from rockflex._errors import InputError, SolverError
from rockflex._shown import shown
from rockflex.models import LinearModel, NonlinearModel
from rockflex.solve._pace import Pace, pace_of
from rockflex.solve._solution import Solution
from rockflex.solve._task import Task
from rockflex.solve.adaptive.cross import STALLED
from rockflex.solve.exact.history import HEADER
from rockflex.solve.exact.layout import LEFT, Array, Log
from rockflex.solve.exact.run import SETTLED, UNSETTLED
from rockflex.solve.exact.unit import BROKEN, CHATTER, GAINED, IMPACTS, OVERTURNED, SPENT, UPLIFTS

__all__ = ["QUIET", "Engine", "preparing"]

QUIET = np.zeros(65)  # free vibration is run in stretches of 64 samples
MOST_SAMPLES = 2.0**62  # of free vibration: more than any machine will live to see
EVENTS = 512  # nodes of a history between samples; if there are more, the run is done once more


def preparing(model: LinearModel | NonlinearModel) -> AbstractContextManager[None]:
    """Tell failures of arithmetic, met while an engine is made ready, in terms of the model's parameters."""
    p = model.properties
    modes = f"omega from {p.omega.min():.3g} to {p.omega.max():.3g} rad/s, " if p.n_modes else ""
    return computable(
        f"The motion of {model.label} with {modes}i_theta = {p.i_theta:.3g} kg m², l0r = {p.l0r:.3g} kg m, "
        f"m_tot = {p.m_tot:.3g} kg and half_width = {p.half_width:.3g} m"
    )


class Engine(ABC):
    """A model made ready for records.

    Parameters
    ----------
    model
        The model's parameters.
    n_rows
        Number of rows whose peaks are kept: the rotation, the responses wanted, and the loss of support.
    failures
        Where exceptions of the user's impact law gather.
    """

    def __init__(self, model: LinearModel | NonlinearModel, n_rows: int, failures: list[Exception]) -> None:
        self.model = model
        self._n_rows = n_rows
        self._failures = failures

    @cached_property
    def pace(self) -> Pace:
        """What the work of its runs grows with."""
        return pace_of(self.model, self._n_rows)

    def task(
        self, acceleration: NDArray[np.float64], dt: float, free_vibration: float | None = 0.0, *, history: bool = False
    ) -> Task:
        """What `run` is asked with these arguments, to estimate its work by."""
        return Task(self.model, self.pace, acceleration, dt, free_vibration, history)

    @abstractmethod
    def _motion(self, start: Array) -> Array:
        """What the kernels carry, from the state [D.., D'.., θ, θ']."""

    @abstractmethod
    def _carry(
        self,
        motion: Array,
        record: Array,
        dt: float,
        free: int,
        settle: bool,
        side: float,
        log: Log,
        nodes: Array,
    ) -> tuple[int, int, int]:
        """Run the kernels on `motion`, in place; return status, samples and the count of nodes."""

    def run(
        self,
        acceleration: NDArray[np.float64],
        dt: float,
        *,
        free_vibration: float | None = 0.0,
        state: Array | None = None,
        history: bool = False,
        work_limit: float | None = None,
    ) -> Solution:
        """Run one record, then `free_vibration` seconds (None: until settled), from a state [D.., D'.., θ, θ'].

        `work_limit` is the most work in s, see `Pace`, that the run may be and do; None sets no limit.

        Raises
        ------
        WorkLimitError
            If the run is estimated to be more work than that.
        InputError
            If the time step is absurd, or the user's impact law fails.
        SolverError
            If impacts accumulate without end, the motion does not settle, an impact would gain energy, or the run has
            done all the work that it may.
        """
        task = self.task(acceleration, dt, free_vibration, history=history)
        task.check(work_limit)
        start = np.zeros(2 * self.model.properties.n_modes + 2) if state is None else state
        side = float(np.sign(start[-2]) or np.sign(start[-1]))
        settle = free_vibration is None
        after = self._patience() if free_vibration is None else free_vibration
        free = math.ceil(min(after / dt, MOST_SAMPLES) - 1e-9)
        record = np.require(acceleration, dtype=np.float64, requirements=("C", "W"))  # the type compiled for
        room_for = record.size + EVENTS + (0 if settle else free) if history else 0
        work = np.concatenate(([math.inf if work_limit is None else work_limit], self.pace.prices(history=history)))
        while True:
            log = Log(np.zeros(self._n_rows), np.zeros(self._n_rows), np.zeros(3, dtype=np.int64), work.copy())
            log.peaks[-1] = -np.inf
            motion = self._motion(start)
            nodes = np.zeros((room_for, HEADER + motion.size))
            status, samples, count = self._carry(motion, record, dt, free, settle, side, log, nodes)
            if not history or count <= room_for:
                break
            task.check_room(count)
            room_for = count
        if log.work[LEFT] < 0.0 and status != BROKEN:
            status = SPENT
        self._complain(status, samples * dt, motion[: start.size], task, work_limit)
        end = samples * dt if status != OVERTURNED else float(log.times[0])
        return Solution(
            overturned=status == OVERTURNED,
            settled=status == SETTLED,
            end_time=end,
            peaks=log.peaks[:-1],
            peak_times=log.times[:-1],
            lost_support=float(log.peaks[-1]),
            time_of_lost_support=float(log.times[-1]),
            n_uplifts=int(log.tally[UPLIFTS]),
            n_impacts=int(log.tally[IMPACTS]),
            nodes=nodes[:count] if history else None,
        )

    def _patience(self) -> float:
        """Longest free vibration that is waited for, s."""
        p = self.model.properties
        slowest = float(p.omega.min(initial=math.inf))
        return 2000.0 * 2.0 * math.pi / slowest + 200.0 * math.sqrt(p.i_theta / (p.l0r * GRAVITY))

    def _complain(self, status: int, time: float, state: Array, task: Task, work_limit: float | None) -> None:
        """Raise if the run could not be solved."""
        if status == BROKEN:
            failure = self._failures.pop()
            message = f"The impact law {shown(self.model.law)} failed: {failure}"
            raise InputError(message) from failure
        label = self.model.label
        if status == CHATTER:
            what = f"The impacts of {label} accumulate without end in the sample before {time:.6g} s."
            mend = "Check the model's parameters, and refine the record."
        elif status == GAINED:
            what = f"The impact law {shown(self.model.law)} returns energy in the sample before {time:.6g} s."
            mend = "A law can only lose energy: mend its `after`, or lower its restitution."
        elif status == STALLED:
            what = (
                f"The motion of {label} cannot be followed in the sample before {time:.6g} s: no step is short enough."
            )
            mend = "Check the parameters."
        elif status == SPENT:
            what, mend = task.stopped(time, work_limit)
        elif status == UNSETTLED:
            what = f"The free vibration of {label} has not settled {time:.6g} s after the start."
            mend = "Give free_vibration in seconds, or more damping."
        elif not np.all(np.isfinite(state)):
            what, mend = f"The motion of {label} is not finite at {time:.6g} s.", "Check the parameters."
        else:
            return
        values = ", ".join(f"{value:.6g}" for value in state)
        message = f"{what} The state [D, D', θ, θ'] there is [{values}]. {mend}"
        raise SolverError(message)
