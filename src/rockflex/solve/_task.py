"""The specification of a run, the check of its work against a limit, and the messages if it is exceeded."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError, SolverError
from rockflex.models import HEADER, RockingModel
from rockflex.solve._pace import Pace, Work, pace_of

HISTORY = 4e9  # bytes
SWIFT = 10.0  # rad per time step, beyond which overdamped fast motions are excluded
UNITS = (("years", 3.2e7), ("days", 86_400.0), ("h", 3600.0), ("min", 60.0), ("s", 0.0))
SIZES = 64  # largest number of sizes of tasks remembered
LIFT = 'Or raise work_limit, or lift it: work_limit=None ("none" in a file and on the command line).'


class WorkLimitError(InputError):
    """A run that would exceed the work limit, or whose history would not fit in memory."""


@dataclass(frozen=True)
class Task:
    """The parts of a run that determine its work.

    Attributes
    ----------
    model
        The model.
    pace
        The properties of the model that determine the work.
    record
        Samples of the ground acceleration in m/s², shape (n,).
    dt
        Sampling step in s.
    free_vibration
        Seconds after the record; None until settled.
    history
        Whether every state is stored.
    scale
        Factor on the samples.
    """

    model: RockingModel
    pace: Pace
    record: Array
    dt: float
    free_vibration: float | None = 0.0
    history: bool = False
    scale: float = 1.0

    @property
    def size(self) -> tuple[float | None, ...] | None:
        """What the work depends on beside the model; None if it depends on every sample."""
        return None if self.pace.flow else (self.record.size, self.dt, self.free_vibration, self.history)

    def work(self) -> Work:
        """Estimate the work of the run; the time to settle is taken as the longest period."""
        speed = float(np.abs(np.cumsum(self.record)).mean()) * abs(self.scale) * self.dt if self.pace.flow else 0.0
        samples = self.record.size + self._free / self.dt
        return self.pace.work(samples, self.dt, speed, history=self.history, fastest=self.fastest)

    @property
    def fastest(self) -> float:
        """Circular frequency in rad/s of the fastest vibration that is not overdamped.

        On a very narrow base the fastest root belongs to a strongly overdamped motion, which needs no work.
        """
        known = self.pace.fastest
        if self.pace.integrated or known * self.dt < SWIFT:
            return known
        return min(known, pace_of(self.model, self.pace.rows).fastest)

    def check(self, limit: float | None) -> None:
        """Raise `WorkLimitError` if the work exceeds `limit` s (None: no limit), or the history is too large."""
        if limit is not None:
            work = self.work()
            if work.total > limit:
                raise WorkLimitError(
                    f"{self.model.label} would take about {_lasting(work.total)} of computing, but work_limit is "
                    f"{limit:g} s: {self.reason(work)} {LIFT}"
                )
        if self.history:
            self.check_room(self.record.size + (0.0 if self.free_vibration is None else self.free_vibration / self.dt))

    def check_room(self, states: float) -> None:
        """Raise `WorkLimitError` if a history with this number of states takes too much memory."""
        size = 8.0 * states * (HEADER + self.model.layout.core)
        if size > HISTORY:
            raise WorkLimitError(
                f"The history of {self.model.label} would have {states:.3g} states and take {size / 1e9:.3g} GB, but "
                f'the limit is {HISTORY / 1e9:g} GB. Use output="peaks", less free_vibration, or a longer time step.'
            )

    def stopped(self, time: float, limit: float | None) -> tuple[str, str]:
        """Return the message for a run that reached its work limit at `time`, and the remedy."""
        end = self.record.size * self.dt + (self.free_vibration or 0.0)
        aim = "until it settles" if self.free_vibration is None else f"to {end:.6g} s"
        what = (
            f"{self.model.label} was stopped at {time:.6g} s of a run {aim}: work_limit = {limit:g} s of computing is "
            "used up."
        )
        return what, f"The reason: {self.reason(self.work())} {LIFT}"

    def reason(self, work: Work) -> str:
        """Return why the run is long, and how to shorten it."""
        spring = self.model.bouc_wen
        if spring is not None and work.yielding > max(work.vibration, work.samples):
            return (
                f"its spring, with yield_displacement = {spring.yield_displacement:g} m, yields repeatedly in every "
                "time step under such a strong motion. Give a weaker motion (scale), or a larger yield_displacement."
            )
        if work.vibration > work.samples:
            fastest = self.fastest
            return (
                f"its fastest vibration, {fastest:.3g} rad/s, advances by {fastest * self.dt:.3g} rad in every time "
                f"step of {self.dt:g} s. Give fewer modes, a longer period, or a wider base (half_width, or "
                "aspect_ratio): the narrower the base, the faster it vibrates while it rocks."
            )
        if self._free > self.record.size * self.dt:
            asked = f"free_vibration = {self.free_vibration:g} s" if self.free_vibration is not None else (
                f'free_vibration="settle", with a slowest period of {self._free:.3g} s,'
            )  # fmt: skip
            return (
                f"{asked} is {self._free / self.dt:.3g} time steps of {self.dt:g} s. Give less free_vibration, or a "
                "motion with a longer time step."
            )
        return (
            f"the motion has {self.record.size} samples. Give a shorter motion, or one with a longer time step, or a "
            "model with fewer modes."
        )

    @property
    def _free(self) -> float:
        """Estimated duration of the free vibration in s."""
        if self.free_vibration is not None:
            return self.free_vibration
        slowest = float(self.model.properties.omega.min(initial=math.inf))
        return 2.0 * math.pi / slowest


class Gate:
    """The tasks of a model that have passed the check of their work, so that others of the same size need none."""

    def __init__(self) -> None:
        self._accepted = set[tuple[object, ...]]()

    def refused(self, tasks: Sequence[Task], limit: float | None) -> dict[int, InputError | SolverError]:
        """Check tasks against the work limit, and return the errors by their places."""
        found: dict[int, InputError | SolverError] = {}
        for place, task in enumerate(tasks):
            size = task.size
            if size is not None and (size, limit) in self._accepted:
                continue
            try:
                task.check(limit)
            except WorkLimitError as error:
                found[place] = error
                continue
            if len(self._accepted) >= SIZES:
                self._accepted.clear()
            self._accepted.add((size, limit))
        return found


def _lasting(seconds: float) -> str:
    """Return a duration with a suitable unit."""
    if not math.isfinite(seconds):
        return "endless time"
    unit, size = next(each for each in UNITS if seconds >= 2.0 * each[1])
    return f"{seconds / (size or 1.0):.2g} {unit}"
