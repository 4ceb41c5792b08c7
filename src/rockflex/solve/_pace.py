"""The work of a run, estimated in advance and counted during the run.

Work is expressed in seconds of one core. It is counted rather than timed: samples, looks into a sample, power series
and attempted steps, each at a fixed price. The same run is therefore rejected or stopped on every machine and under
every load. The prices were measured; on a typical processor of 2024 a run takes between a third and three times its
work.
"""

import math
from dataclasses import dataclass, replace

from rockflex.models import RockingModel, stiffness_of_fuses

LOOKS = 0.8  # into a sample, per radian beyond the first by which the phase of the fastest vibration advances
SEARCH = 0.1  # looks into a sample in any case
TURN = 1.0  # rad of the fastest vibration per attempted step
RELAXING = 6.0  # e-folds of the relaxing hysteresis per attempted step
MICRO = 1e-6


@dataclass(frozen=True)
class Work:
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
class Pace:
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
    dense
        Whether the rocking phase cannot be uncoupled, so that its bounds are computed point by point.
    """

    modes: int
    rows: int
    fastest: float
    integrated: bool = False
    flow: float = 0.0
    dense: bool = False

    def prices(self, *, history: bool) -> tuple[float, float, float, float]:
        """Return the work in s of a sample, a look, a power series and an attempted step, as in `Log.work`."""
        pairs, rows = self.modes + 1, self.rows
        both = rows * pairs
        sample = 0.04 + 0.01 * pairs + 0.0005 * both
        if history:
            sample += 0.02 + 0.002 * pairs**2
        look = 0.05 + 0.08 * rows + 0.0015 * both
        series = 0.5 + 0.15 * rows + 0.003 * both
        step = 1.1 + 0.12 * self.modes + 0.02 * rows
        return MICRO * sample, MICRO * look, MICRO * series, MICRO * step

    def work(
        self, samples: float, dt: float, velocity: float = 0.0, *, history: bool, fastest: float | None = None
    ) -> Work:
        """Estimate the work of a run over `samples` steps of `dt` s with continuous rocking.

        `velocity` is the mean ground speed in m/s, which matters for a yielding spring, and `fastest` the frequency in
        rad/s of the fastest vibration that takes work, if that is not the fastest of all.
        """
        sample, look, _, step = self.prices(history=history)
        turned = (self.fastest if fastest is None else fastest) * dt
        if self.integrated:
            flowing = step * velocity * self.flow * dt / RELAXING if self.flow else 0.0
            return Work(samples * (sample + step), samples * step * turned / TURN, samples * flowing)
        looks = look * LOOKS * max(turned - 1.0, 0.0)
        return Work(samples * (sample + look * SEARCH), samples * looks + self._tables(dt))

    def energy(self, samples: float, dt: float) -> float:
        """Estimate the work in s of computing the energies after the run."""
        turned = self.fastest * dt
        each = 1.5 + 0.5 * self.modes + turned * (3.5 + 0.4 * turned) * (1.0 + self.modes / 10.0)
        return MICRO * samples * each

    def _tables(self, dt: float) -> float:
        """Return the work for the bounds of a dense phase: one matrix product per point of the finest grid."""
        pairs, turned = self.modes + 1, self.fastest * dt
        return MICRO * 2.0 * max(turned, 1.0) * (8.0 + 0.01 * self.rows * pairs**2) if self.dense else 0.0


def pace_of(model: RockingModel, rows: int) -> Pace:
    """Return the pace of a model for the given number of rows, including the rotation.

    The highest frequency is a bound that needs no eigenvalues and is at most one per cent too high.
    """
    p = model.properties
    squares = [omega * omega for omega in p.omega.tolist()]
    heights = p.effective_height.tolist()
    moments = [mass * height * height for mass, height in zip(p.effective_mass.tolist(), heights, strict=True)]
    bounds = (
        _highest_square(squares, moments, pivot.i_theta, pivot.rocking_stiffness + stiffness_of_fuses(p, pivot.side))
        for pivot in (p.pivots if model.lifts else ())
    )
    return _pace(model, rows, math.sqrt(max(bounds, default=0.0)))


def _highest_square(squares: list[float], moments: list[float], inertia: float, stiffness: float) -> float:
    """Return a bound of the highest ω² of oscillators with ω_n² and a_n = m*_n h*_n² on a rocking base.

    The frequencies obey λ (I - Σ a_n) = k + Σ a_n ω_n² + Σ a_n ω_n⁴/(λ - ω_n²). Setting all ω_n in the last sum to
    the highest is exact for one mode and gives a quadratic equation for λ - ω_N².
    """
    free = inertia - sum(moments)  # the inertia that belongs to no mode
    highest = max(squares, default=0.0)
    if not free > 0.0:
        return math.inf
    twice, more = 0.0, 0.0  # Σ a_n ω_n² and Σ a_n ω_n⁴
    for square, moment in zip(squares, moments, strict=True):
        twice += moment * square
        more += moment * square * square
    half = 0.5 * ((stiffness + twice) / free - highest)
    beyond = half + math.sqrt(half * half + more / free)
    found = highest + max(beyond, 0.0)
    return math.inf if math.isnan(found) else found


def _pace(model: RockingModel, rows: int, fastest: float) -> Pace:
    highest = max(fastest, max(model.properties.omega.tolist(), default=0.0))
    known = Pace(model.properties.n_modes, rows, highest, model.integrated)
    if model.bouc_wen is None:
        return known
    b = model.bouc_wen
    # z' = (1 - (γ + β) |z|^n) D'/D_y relaxes at this rate about its limit (γ + β)^(-1/n).
    flow = b.exponent * (b.gamma + b.beta) ** (1.0 / b.exponent) / b.yield_displacement
    return replace(known, flow=flow)
