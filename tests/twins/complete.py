"""Rocking with events by SciPy's DOP853: complete or simplified models, Bouc-Wen, any impact law.

The integration starts afresh at every sample and every event, so that its field is smooth throughout.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

from twins.complete_model import GRAVITY, BoucWen, CompleteModel, Ground, Shaking, Structure
from twins.frame import frame_properties
from twins.impact_laws import CompleteVVEL, Law
from twins.result import Vector

RTOL = 1e-11  # peaks are known to about 1e-12
ATOL = 1e-15  # of a size for each component
SUBDIVISIONS = 6  # of a solver step, for events and peaks
SAME_INSTANT = 1e-10  # of a sample: an event this close to its end belongs to the next one
ROOT = {"xtol": 1e-300, "rtol": 8.9e-16, "maxiter": 500}


class Sample(NamedTuple):
    """A stretch of linear ground acceleration; τ counts from its start."""

    start: float
    length: float
    first: float
    slope: float
    rise: float = 0.0
    rise_slope: float = 0.0

    def excitation(self, tau) -> Ground:
        right = self.first + self.slope * tau
        if self.rise == self.rise_slope == 0.0:
            return right
        return Shaking(right, self.rise + self.rise_slope * tau)


@dataclass(frozen=True)
class CompleteResult:
    """Peaks (those between samples too), events, and the states at samples and on both sides of events."""

    max_rotation: float
    max_top_displacement: float
    max_base_moment: float
    max_base_shear: float
    uplift_times: Vector
    impact_times: Vector
    impact_states: Vector
    after_impact_states: Vector
    overturned: bool
    times: Vector
    states: Vector
    sides: Vector

    @property
    def n_uplifts(self) -> int:
        """From contact; rocking that goes over to the other side counts as an impact alone."""
        return self.uplift_times.size

    @property
    def n_impacts(self) -> int:
        return self.impact_times.size


@dataclass
class Run:
    model: CompleteModel
    law: Law
    lifts: bool
    atol: Vector
    y: Vector
    side: int
    best: Vector = field(default_factory=lambda: np.zeros(4))
    uplifts: list[float] = field(default_factory=list)
    impacts: list[tuple[float, Vector, Vector]] = field(default_factory=list)
    nodes: list[tuple[float, Vector, int]] = field(default_factory=list)
    overturned: bool = False
    step: float = np.inf  # of the solver, with which the next piece begins

    def note(self, time: float) -> None:
        self.nodes.append((time, self.y.copy(), self.side))

    def advance(self, sample: Sample) -> None:
        """Carry the state through a sample, or to the instant of overturning."""
        tau, near = 0.0, SAME_INSTANT * sample.length
        while sample.length - tau > near:
            a = sample.excitation(tau)
            if self.side == 0 and self.lifts:
                wanted = self.model.side_wanted(self.y, a)
                if wanted:
                    self._lift(wanted, sample.start + tau)
            tau, kind = self._phase(sample, tau)
            time, a = sample.start + tau, sample.excitation(tau)
            self.note(time)
            if kind == "uplift" and sample.length - tau > near:
                self._lift(-int(np.sign(self.model.overturning(self.y, a))), time)
            elif kind == "impact":
                self.y[0], before = 0.0, self.y
                self.y, self.side = self.law.after(self.model, before, a, self.side)
                self.impacts.append((time, before, self.y.copy()))
                self.note(time)
            elif kind == "turn":
                self.y[3] = 0.0
            elif kind == "overturned":
                self.y[0], self.best[0], self.overturned = 0.5 * np.pi * self.side, 0.5 * np.pi, True
                return

    def result(self) -> CompleteResult:
        times, before, after = zip(*self.impacts, strict=True) if self.impacts else ((), (), ())
        clock, states, sides = zip(*self.nodes, strict=True)
        return CompleteResult(
            *(float(b) for b in self.best),
            uplift_times=np.array(self.uplifts),
            impact_times=np.array(times),
            impact_states=np.array(before).reshape(-1, self.model.size),
            after_impact_states=np.array(after).reshape(-1, self.model.size),
            overturned=self.overturned,
            times=np.array(clock),
            states=np.array(states),
            sides=np.array(sides),
        )

    def _lift(self, side: int, time: float) -> None:
        self.side = side
        self.uplifts.append(time)
        self.note(time)

    def _solve(self, sample: Sample, tau: float, end: float):
        sol = solve_ivp(
            lambda t, y: self.model.field(y, sample.excitation(t), self.side),
            (tau, end),
            self.y,
            method="DOP853",
            rtol=RTOL,
            atol=self.atol,
            max_step=sample.length,
            first_step=min(self.step, end - tau),
            dense_output=True,
        )
        if not sol.success:
            raise RuntimeError(sol.message)
        self.step = float(np.diff(sol.t).max())
        grid = np.linspace(sol.t[:-1], sol.t[1:], SUBDIVISIONS, endpoint=False, axis=1).ravel()
        return sol, np.append(grid, end)

    def _phase(self, sample: Sample, tau: float) -> tuple[float, str]:
        """Integrate in the present phase to its end or to the sample's."""
        sol, grid = self._solve(sample, tau, sample.length)
        event = self._first_event(sample, sol.sol, grid)
        end, kind = event or (sample.length, "none")
        if end == tau:
            return end, kind
        if event is not None:  # to the event itself: interpolated states are a little less accurate
            sol, grid = self._solve(sample, tau, end)
        self._peaks(sol.sol, grid)
        self.y = sol.y[:, -1].copy()
        return end, kind

    def _guards(self, sample: Sample):
        """What stays positive while the phase lasts."""
        model, s = self.model, self.side
        guards = {}
        if s:
            guards["impact"] = lambda t, y: s * y[0]
            guards["overturned"] = lambda t, y: 0.5 * np.pi - s * y[0]
        elif self.lifts:
            guards["uplift"] = lambda t, y: model.room(y, sample.excitation(t))
        return guards

    def _first_event(self, sample: Sample, dense, grid: Vector) -> tuple[float, str] | None:
        states = dense(grid)
        found = []
        for kind, guard in self._guards(sample).items():
            fresh = kind == "impact" and self.y[0] == 0.0

            def value(t, guard=guard):
                return float(guard(t, dense(t)))

            at = first_root(value, grid, guard(grid, states), fresh=fresh)
            if at is not None:
                found.append((at, kind))
        if self.model.bouc_wen is not None:  # Eq. 38 has a kink where D' changes sign
            speed = states[3]
            change = np.flatnonzero(speed[:-1] * speed[1:] < 0.0)
            if change.size:
                k = int(change[0])
                found.append((brentq(lambda t: float(dense(t)[3]), grid[k], grid[k + 1], **ROOT), "turn"))
        return min(found) if found else None

    def _peaks(self, dense, grid: Vector) -> None:
        """Offer the values on the grid, and the summits between that could beat the best so far."""
        states = dense(grid)
        values, rates = self.model.responses(states), self.model.response_rates(states)
        self.best = np.maximum(self.best, abs(values).max(axis=1))
        size = np.maximum(abs(values[:, :-1]), abs(values[:, 1:]))
        reach = size + np.diff(grid) * np.maximum(abs(rates[:, :-1]), abs(rates[:, 1:]))
        for q, k in np.argwhere((rates[:, :-1] * rates[:, 1:] < 0.0) & (reach > self.best[:, None])):

            def rate(t, q=q):
                return float(self.model.response_rates(dense(t))[q])

            if rate(grid[k]) * rate(grid[k + 1]) < 0.0:
                top = brentq(rate, grid[k], grid[k + 1], **ROOT)
                self.best[q] = max(self.best[q], abs(float(self.model.responses(dense(top))[q])))


def first_root(value, grid: Vector, values: Vector, *, fresh: bool) -> float | None:
    """First fall of a guard to zero; ``fresh`` if it starts at zero and rises, as a rotation does.

    A fall and rise between two grid points is found where the lowest point is within its neighbours' reach.
    """
    first = 0
    if fresh:
        first, right = 1, grid[1]
        if values[1] <= 0.0:
            for _ in range(60):
                left = 0.5 * (grid[0] + right)
                if value(left) > 0.0:
                    return brentq(value, left, right, **ROOT)
                right = left
            msg = "a rocking phase too short to be resolved"
            raise RuntimeError(msg)
    elif values[0] <= 0.0:
        return grid[0]
    for k in range(first, grid.size):
        if values[k] <= 0.0:
            return brentq(value, grid[k - 1], grid[k], **ROOT)
        low, high = max(k - 1, first), min(k + 1, grid.size - 1)
        around = values[[low, high]] - values[k]
        if around.min() >= 0.0 and values[k] < around.max() and low < high:
            dip = minimize_scalar(value, bounds=(grid[low], grid[high]), method="bounded", options={"xatol": 1e-13})
            if dip.fun < 0.0:
                return brentq(value, grid[low], dip.x, **ROOT)
    return None


def simulate_complete(
    *,
    acceleration: ArrayLike,
    dt: float,
    vertical: ArrayLike | None = None,
    complete: bool = True,
    lifts: bool = True,
    bouc_wen: BoucWen | None = None,
    law: Law | None = None,
    rotation: float = 0.0,
    rotation_velocity: float = 0.0,
    modal_displacement: ArrayLike | None = None,
    modal_velocity: ArrayLike | None = None,
    free: float = 0.0,
    **structure: object,
) -> CompleteResult:
    """Run one `Structure`, given by its fields; ``law`` defaults to ``CompleteVVEL``.

    The first sample acts at once, and the ground comes to rest after the last, for ``free`` seconds. Without
    them the run ends with the last sample still acting.
    """
    model = CompleteModel(Structure(**structure), complete=complete, bouc_wen=bouc_wen)
    n, record = model.n, np.asarray(acceleration, float)
    y = np.zeros(model.size)
    y[0], y[1] = rotation, rotation_velocity
    y[2 : 2 + n] = 0.0 if modal_displacement is None else modal_displacement
    y[2 + n : 2 + 2 * n] = 0.0 if modal_velocity is None else modal_velocity
    run = Run(model, law or CompleteVVEL(), lifts, sizes(model, record) * ATOL, y, int(np.sign(rotation or y[1])))

    run.note(0.0)
    parts = int(np.ceil(free / dt - 1e-9))
    rest = [(dt * (record.size - 1) + k * free / parts, free / parts, 0.0, 0.0) for k in range(parts)]
    rise = np.zeros(record.size) if vertical is None else np.asarray(vertical, float)
    slopes, rise_slopes = np.diff(record) / dt, np.diff(rise) / dt
    shaken = [(k * dt, dt, record[k], slopes[k], rise[k], rise_slopes[k]) for k in range(record.size - 1)]
    for sample in shaken + rest:
        run.advance(Sample(*sample))
        if run.overturned:
            break
    return run.result()


def sizes(model: CompleteModel, record: Vector) -> Vector:
    """A size for each component: θ as where the resisting moment ends, D_n as a/ω_n², z as 1."""
    p = model.structure
    slenderness = p.m_tot * p.half_width / p.l0r
    d = max(float(abs(record).max()), GRAVITY * slenderness) / p.omega**2
    rate = np.sqrt(p.l0r * GRAVITY / p.i_theta)
    return np.concatenate([slenderness * np.array([1.0, rate]), d, d * p.omega, np.ones(model.size - 2 - 2 * model.n)])


def complete_frame(**frame: object) -> dict[str, object]:
    """The benchmark frame as keyword arguments of ``simulate_complete``."""
    given = frame_properties(**frame)
    return {**given, "translational_inertia": given["i_theta"] - given["m_tot"] * given["half_width"] ** 2}
