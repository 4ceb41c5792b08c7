"""The work of a run: estimated in advance, counted during the run, and limited.

Work is expressed in seconds of one core. It is counted rather than timed: samples, looks into a sample, power series
and attempted steps, each at a fixed price. The same run is therefore rejected or stopped on every machine and under
every load. The prices were measured; on a typical processor of 2024 a run takes between a third and three times its
work.
"""

import math
from dataclasses import dataclass

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.models._elements import stiffness_of_fuses
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import HEADER

LOOKS = 0.8  # into a sample, per radian beyond the first by which the phase of the fastest vibration advances
SEARCH = 0.1  # looks into a sample in any case
FAST = 3.0  # rad that a mode turns in a step, beyond which the engine splits it from the others
TURN = 1.0  # rad of the fastest vibration per attempted step
RELAXING = 6.0  # e-folds of the relaxing hysteresis per attempted step
MICRO = 1e-6
HISTORY = 4e9  # bytes
SWIFT = 10.0  # rad per time step, beyond which overdamped fast motions are excluded
OVERDAMPED = 20.0  # times the fastest vibration: a motion that fades faster is one of its own
UNITS = (("years", 3.2e7), ("days", 86_400.0), ("h", 3600.0), ("min", 60.0), ("s", 0.0))
LIFT = 'Or raise work_limit, or lift it: work_limit=None ("none" in a file and on the command line).'


@dataclass(frozen=True)
class EstimatedWork:
    """Estimated work of a run, in s of one core, by cause.

    Attributes
    ----------
    samples
        Work for every sample, apart from fast vibrations.
    vibration
        Work for the fastest vibration.
    yielding
        Work for a rapidly yielding spring.
    """

    samples: float
    vibration: float
    yielding: float = 0.0

    @property
    def total(self) -> float:
        """Total work of the run in s; infinite if it overflows."""
        found = self.samples + self.vibration + self.yielding
        return math.inf if math.isnan(found) else found


@dataclass(frozen=True)
class CostModel:
    """The properties that determine the work of a model.

    Attributes
    ----------
    modes
        Number of modes.
    rows
        Number of rows whose peaks are computed.
    fastest
        Highest circular frequency in rad/s, in contact or uplifted; on a very narrow base far above ω_N.
    integrated
        Whether rocking is integrated step by step.
    flow
        Relaxation rate in 1/s of the flowing hysteresis per m/s of spring velocity.
    fading
        Rate in 1/s of a strongly overdamped motion of a very narrow base while it rocks; zero if there is none. Such a
        phase cannot be uncoupled, so that its bounds are computed point by point.
    """

    modes: int
    rows: int
    fastest: float
    integrated: bool = False
    flow: float = 0.0
    fading: float = 0.0

    @property
    def rate(self) -> float:
        """The largest rate in 1/s, of a vibration or of what fades."""
        return max(self.fastest, self.fading)

    def prices(self, *, history: bool) -> tuple[float, float, float]:
        """Return the work in s of a sample, a look with its power series, and an attempted step."""
        pairs, rows = self.modes + 1, self.rows
        both = rows * pairs
        sample = 0.04 + 0.01 * pairs + 0.0005 * both
        if history:
            sample += 0.02 + 0.002 * pairs**2
        look = 0.05 + 0.08 * rows + 0.0015 * both + 0.00075 * pairs**2  # every term of a series is a matrix product
        step = 1.1 + 0.12 * self.modes + 0.02 * rows
        return MICRO * sample, MICRO * look, MICRO * step

    def work(
        self, samples: float, dt: float, velocity: float = 0.0, *, history: bool, fastest: float | None = None
    ) -> EstimatedWork:
        """Estimate the work of a run over `samples` steps of `dt` s with continuous rocking.

        `velocity` is the mean ground speed in m/s, which matters for a yielding spring, and `fastest` the frequency in
        rad/s of the fastest vibration that takes work, if that is not the fastest of all.
        """
        sample, look, step = self.prices(history=history)
        turned = (self.rate if fastest is None else fastest) * dt
        if self.integrated:
            flowing = step * velocity * self.flow * dt / RELAXING if self.flow else 0.0
            return EstimatedWork(samples * (sample + step), samples * step * turned / TURN, samples * flowing)
        looks = look * LOOKS * max(turned - 1.0, 0.0)
        return EstimatedWork(samples * (sample + look * SEARCH), samples * looks + self._tables(dt))

    def energy(self, samples: float, dt: float) -> float:
        """Estimate the work in s of computing the energies after the run."""
        turned = self.fastest * dt
        each = 1.5 + 0.5 * self.modes + turned * (3.5 + 0.4 * turned) * (1.0 + self.modes / 10.0)
        return MICRO * samples * each

    def _tables(self, dt: float) -> float:
        """Return the work for the tables of all phases: eigenvalues if modes are fast, and products of matrices.

        The bounds of a dense phase take one product per point of the finest grid.
        """
        pairs, turned = self.modes + 1, self.rate * dt
        tables = (0.06 if turned > FAST else 0.02) * pairs**3
        if self.fading:
            tables += 2.0 * max(turned, 1.0) * (8.0 + 0.01 * self.rows * pairs**2)
        return MICRO * tables


def cost_model_of(model: RockingModel, rows: int) -> CostModel:
    """Return the cost model of a model for the given number of rows, including the rotation.

    The highest frequency is a bound that needs no eigenvalues and is at most one per cent too high.
    """
    p = model.properties
    omegas, heights = p.omega.tolist(), p.effective_height.tolist()
    squares = [omega * omega for omega in omegas]
    moments = [mass * height * height for mass, height in zip(p.effective_mass.tolist(), heights, strict=True)]
    highest, inertia = max(omegas, default=0.0), sum(moments)
    free = math.inf  # the inertia about a pivot that belongs to no mode
    for pivot in p.pivots if model.lifts else ():
        stiffness = pivot.rocking_stiffness + stiffness_of_fuses(p, pivot.side)
        free = min(free, pivot.i_theta - inertia)
        highest = max(highest, _highest_rate(squares, moments, pivot.i_theta - inertia, stiffness))
    flow, fading = 0.0, 0.0
    if model.bouc_wen is not None:
        b = model.bouc_wen
        # z' = (1 - (γ + β) |z|^n) D'/D_y relaxes at this rate about its limit (γ + β)^(-1/n).
        flow = b.exponent * (b.gamma + b.beta) ** (1.0 / b.exponent) / b.yield_displacement
    elif not model.integrated and free > 0.0:
        # The sum of the rates at which the motion fades while the base rocks; on a very narrow base one root has it all
        rates = zip(p.zeta.tolist(), omegas, moments, strict=True)
        fading = sum([2.0 * zeta * omega * (1.0 + moment / free) for zeta, omega, moment in rates])
    return CostModel(p.n_modes, rows, highest, model.integrated, flow, fading if fading > OVERDAMPED * highest else 0.0)


def _highest_rate(squares: list[float], moments: list[float], free: float, stiffness: float) -> float:
    """Return a bound of the highest ω of oscillators with ω_n² and a_n = m*_n h*_n² on a rocking base.

    The frequencies obey λ (I - Σ a_n) = k + Σ a_n ω_n² + Σ a_n ω_n⁴/(λ - ω_n²). Setting all ω_n in the last sum to
    the highest is exact for one mode and gives a quadratic equation for λ - ω_N². `free` is I - Σ a_n.
    """
    if not free > 0.0:
        return math.inf
    highest, twice, more = max(squares, default=0.0), 0.0, 0.0  # twice, more: Σ a_n ω_n² and Σ a_n ω_n⁴
    for square, moment in zip(squares, moments, strict=True):
        twice += moment * square
        more += moment * square * square
    half = 0.5 * ((stiffness + twice) / free - highest)
    beyond = half + math.sqrt(half * half + more / free)
    found = highest + max(beyond, 0.0)
    return math.inf if math.isnan(found) else math.sqrt(found)


class WorkLimitError(InputError):
    """A run that would exceed the work limit, or whose history would not fit in memory."""


@dataclass(frozen=True)
class Task:
    """The parts of a run that determine its work.

    Attributes
    ----------
    model
        The model.
    cost_model
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
    cost_model: CostModel
    record: Array
    dt: float
    free_vibration: float | None = 0.0
    history: bool = False
    scale: float = 1.0

    def work(self) -> EstimatedWork:
        """Estimate the work of the run; the time to settle is taken as the longest period."""
        speed = 0.0
        if self.cost_model.flow:
            with np.errstate(over="ignore", invalid="ignore"):  # it is endless work then
                speed = float(np.abs(np.cumsum(self.record)).mean()) * abs(self.scale) * self.dt
        samples = self.record.size + self._free / self.dt
        return self.cost_model.work(samples, self.dt, speed, history=self.history, fastest=self.fastest)

    @property
    def fastest(self) -> float:
        """Circular frequency in rad/s of the fastest vibration that is not overdamped.

        On a very narrow base the fastest root belongs to a strongly overdamped motion, which needs no work.
        """
        known = self.cost_model
        return known.rate if known.rate * self.dt < SWIFT else known.fastest

    def check(self, limit: float | None) -> None:
        """Raise `WorkLimitError` if the work exceeds `limit` s (None: no limit), or the history is too large."""
        if limit is not None:
            work = self.work()
            if work.total > limit:
                raise WorkLimitError(
                    f"{self.model.label} would take about {_duration_text(work.total)} of computing, but work_limit is "
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

    def reason(self, work: EstimatedWork) -> str:
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


def _duration_text(seconds: float) -> str:
    """Return a duration with a suitable unit."""
    if not math.isfinite(seconds):
        return "endless time"
    unit, size = next(each for each in UNITS if seconds >= 2.0 * each[1])
    return f"{seconds / (size or 1.0):.2g} {unit}"
