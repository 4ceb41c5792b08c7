"""The simplified rocking model by adaptive integration with events (scipy), written from the paper alone.

Source: Silva & Stojadinović 2024, Eqs. 15 and 23-25 (30-32 for one mode). State ``[θ, θ', D, D']``.

Two ways of stepping. The default hands the piecewise-linear record to the solver whole, as a user would,
with steps no longer than a sample. ``restart_every_sample=True`` starts afresh at each kink of the
excitation, which lets a high-order method keep its order.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from twins.ode_model import SAME_INSTANT, Model, Segment
from twins.result import InitialState, Ledger, TwinResult, Vector

SERIES_ORDER = 12
ROOT = {"xtol": 1e-300, "rtol": 8.9e-16, "maxiter": 500}


@dataclass
class _Run:
    model: Model
    fixed: bool
    method: str
    rtol: float
    atol: Vector | float
    max_step: float
    refine: bool
    y: Vector
    side: int
    ledger: Ledger
    overturned: bool = False

    def advance(self, seg: Segment) -> float:
        """Carry the state through a segment; return the time reached."""
        tau, end = 0.0, seg.length
        near = SAME_INSTANT * seg.dt
        while end - tau > near:
            if self.side == 0 and not self.fixed:
                side = self.model.side_wanted(self.y, seg.excitation(tau))
                if side:
                    tau = self._lift(seg, tau, side, jumped=True)
            tau, kind = self._integrate(seg, tau, end)
            if kind == "uplift" and end - tau > near:
                side = -1 if self.model.overturning(self.y, seg.excitation(tau)) > 0.0 else 1
                tau = self._lift(seg, tau, side, jumped=False)
            elif kind == "impact":
                self.ledger.impacts.append(seg.start + tau)
                self.ledger.states.append(self.y)
                self.y, self.side = self.model.landed(self.y), 0
            elif kind == "overturned":
                self.overturned = True
                return seg.start + tau
        return seg.start + end

    def _lift(self, seg: Segment, tau: float, side: int, *, jumped: bool) -> float:
        """Leave the ground by a short step of the Taylor series.

        At uplift θ = θ' = 0, so the event "θ is back at zero" holds already. The series starts with τ² when
        the condition was met by a jump, with τ³ when it was met continuously (θ'' is then zero but for
        rounding, and is set to zero). The step is a small part of the fastest period, shorter than the way to
        the next kink, and short enough for θ to be still growing at its end; there sθ > 0 and sθ' > 0.
        """
        A, b_a, b_s = self.model.field[side]
        a, slope = seg.excitation(tau), seg.slope(tau)
        terms = [self.y, A @ self.y + b_a * a + b_s]
        if not jumped:
            terms[1][1] = 0.0
        terms.append((A @ terms[1] + b_a * slope) / 2.0)
        for k in range(3, SERIES_ORDER + 1):
            terms.append(A @ terms[-1] / k)
        rate = np.array([side * k * terms[k][0] for k in range(2, SERIES_ORDER + 1)])
        step = min(0.05 / self.model.fastest, 0.5 * seg.room(tau))
        grid = np.linspace(0.0, 1.0, 33)[1:]
        for _ in range(200):
            if np.polynomial.polynomial.polyval(step * grid, rate).min() > 0.0:
                break
            step *= 0.5
        else:
            msg = f"uplift at t = {seg.start + tau} s cannot be resolved"
            raise RuntimeError(msg)

        def series(h: float) -> Vector:
            return np.polynomial.polynomial.polyval(h, np.array(terms))

        self.ledger.uplifts.append(seg.start + tau)
        self.side = side
        times = np.array([0.0, step])
        shifted = Segment(seg.start + tau, seg.room(tau), np.array([a, a + slope * seg.room(tau)]))
        self._peaks(shifted, times, np.array([self.y, series(step)]).T, series)
        self.y = series(step)
        return tau + step

    def _events(self, seg: Segment) -> list[Callable[[float, Vector], float]]:
        model, s = self.model, self.side
        if s:

            def impact(t, y):
                return s * y[0]

            def overturned(t, y):
                return s * y[0] - 0.5 * np.pi

            impact.direction, overturned.direction = -1.0, 1.0
            events = [impact, overturned]
        elif self.fixed:
            return []
        else:

            def uplift_right(t, y):
                return -model.overturning(y, seg.excitation(t)) - model.resisting

            def uplift_left(t, y):
                return model.overturning(y, seg.excitation(t)) - model.resisting

            uplift_right.direction = uplift_left.direction = 1.0
            events = [uplift_right, uplift_left]
        for event in events:
            event.terminal = True
        return events

    def _integrate(self, seg: Segment, tau: float, end: float) -> tuple[float, str]:
        """Integrate in the present phase to its end or to the segment's; update state and peaks."""
        A, b_a, b_s = self.model.field[self.side]
        at = seg.excitation

        def rhs(t, y):
            return A @ y + (b_a * at(t) + b_s)

        sol = solve_ivp(
            rhs,
            (tau, end),
            self.y,
            method=self.method,
            rtol=self.rtol,
            atol=self.atol,
            max_step=self.max_step,
            events=self._events(seg) or None,
            dense_output=self.refine,
        )
        if not sol.success:
            raise RuntimeError(sol.message)
        if self.refine and not self.fixed:
            hidden = self._hidden_event(seg, sol)
            if hidden is not None:
                return self._integrate(seg, tau, hidden)
        self._peaks(seg, sol.t, sol.y, sol.sol)
        self.y = sol.y[:, -1].copy()
        if sol.status != 1:
            return end, "none"
        which = next(i for i, times in enumerate(sol.t_events) if times.size)
        self.y = sol.y_events[which][0].copy()
        if self.side == 0:
            return float(sol.t_events[which][0]), "uplift"
        if which == 0:
            self.y[0] = 0.0
            return float(sol.t_events[0][0]), "impact"
        self.y[0] = self.side * 0.5 * np.pi
        self.ledger.best[0] = 0.5 * np.pi
        return float(sol.t_events[1][0]), "overturned"

    def _hidden_event(self, seg: Segment, sol) -> float | None:
        """Time of the first summit of a guard that passes zero and comes back between two solver steps."""
        model, s, times = self.model, self.side, sol.t
        if s:  # a guard row·y + by_a·a - limit is negative while the phase lasts
            guards = [(-s * np.eye(1, self.y.size)[0], 0.0, 0.0)]
        else:
            guards = [(q * model.guard, q * model.guard_a, model.resisting) for q in (-1.0, 1.0)]
        slopes = np.array([seg.slope(t) for t in times])
        for row, by_a, limit in guards:
            value = row @ sol.y + by_a * seg.excitations(times) - limit
            rate = row @ self._rates(seg, times, sol.y) + by_a * slopes
            reach = np.maximum(value[:-1], value[1:]) + np.diff(times) * np.maximum(abs(rate[:-1]), abs(rate[1:]))
            rise_and_fall = (rate[:-1] > 0.0) & (rate[1:] < 0.0)
            for k in np.flatnonzero(rise_and_fall & (value[:-1] < 0.0) & (value[1:] < 0.0) & (reach > 0.0)):

                def slope_of_guard(t, row=row, by_a=by_a):
                    return row @ self._field(sol.sol(t), seg.excitation(t)) + by_a * seg.slope(t)

                summit = brentq(slope_of_guard, times[k], times[k + 1], **ROOT)
                if row @ sol.sol(summit) + by_a * seg.excitation(summit) > limit:
                    return summit
        return None

    def _field(self, y: Vector, a: float) -> Vector:
        A, b_a, b_s = self.model.field[self.side]
        return A @ y + b_a * a + b_s

    def _rates(self, seg: Segment, times: Vector, states: Vector) -> Vector:
        A, b_a, b_s = self.model.field[self.side]
        return A @ states + np.outer(b_a, seg.excitations(times)) + b_s[:, None]

    def _peaks(self, seg: Segment, times: Vector, states: Vector, dense) -> None:
        """Offer step values, and the summits between steps that could beat the largest value so far."""
        values = self.model.outputs @ states
        for q in range(4):
            k = int(np.argmax(abs(values[q])))
            self.ledger.offer(q, values[q, k], seg.start + times[k])
        if not self.refine:
            return
        rates = self.model.outputs @ self._rates(seg, times, states)
        for q in range(4):
            turning = rates[q, :-1] * rates[q, 1:] < 0.0
            size = np.maximum(abs(values[q, :-1]), abs(values[q, 1:]))
            reach = size + np.diff(times) * np.maximum(abs(rates[q, :-1]), abs(rates[q, 1:]))
            for k in np.flatnonzero(turning & (reach > self.ledger.best[q])):
                if reach[k] <= self.ledger.best[q]:
                    continue
                row = self.model.outputs[q]

                def rate(t, row=row):
                    return row @ self._field(dense(t), seg.excitation(t))

                if rate(times[k]) * rate(times[k + 1]) < 0.0:
                    top = brentq(rate, times[k], times[k + 1], **ROOT)
                    self.ledger.offer(q, float(row @ dense(top)), seg.start + top)


def simulate_ode(
    omega: Vector,
    m_eff: Vector,
    h_eff: Vector,
    top_ordinate: Vector,
    i_theta: float,
    l0r: float,
    m_tot: float,
    half_width: float,
    zeta: float | Vector,
    acceleration: Vector,
    dt: float,
    *,
    free_vibration: float = 0.0,
    method: Literal["DOP853", "LSODA"] = "DOP853",
    rtol: float = 1e-10,
    atol: Vector | float | None = None,
    max_step: float | None = None,
    restart_every_sample: bool = False,
    refine: bool = True,
    fixed: bool = False,
    initial: InitialState | None = None,
) -> TwinResult:
    """Peaks, events and last state by adaptive integration.

    ``atol`` defaults to rtol/1000 of a size for each component (``Model.scale``). ``refine=False`` looks for
    events and peaks at the solver's steps only, the cheapest thing one could write; otherwise dense output
    gives the true ones between them.
    """
    model = Model(omega, m_eff, h_eff, top_ordinate, i_theta, l0r, m_tot, half_width, zeta)
    record = np.asarray(acceleration, float)
    if atol is None:
        atol = 1e-3 * rtol * model.scale(float(abs(record).max()))
    initial = initial or InitialState()
    y = np.zeros(2 + 2 * model.n)
    y[0] = initial.rotation
    if initial.modal_displacement is not None:
        y[2 : 2 + model.n] = initial.modal_displacement
    if initial.modal_velocity is not None:
        y[2 + model.n :] = initial.modal_velocity
    if abs(initial.rotation) >= 0.5 * np.pi or (fixed and initial.rotation != 0.0):
        msg = "the initial rotation must lie within ±π/2, and be zero on a fixed base"
        raise ValueError(msg)
    longest = dt if max_step is None else max_step
    side = int(np.sign(initial.rotation))
    run = _Run(model, fixed, method, rtol, atol, longest, refine, y, side, Ledger())

    end = dt * (record.size - 1)
    history: list[Vector] | None = None
    if restart_every_sample:
        segments = [Segment(k * dt, dt, record[k : k + 2]) for k in range(record.size - 1)]
        chunks = int(np.ceil(free_vibration / dt - 1e-9))
        part = free_vibration / max(chunks, 1)
        segments += [Segment(end + k * part, part, np.zeros(2)) for k in range(chunks)]
        history = [run.y.copy()]
    else:
        segments = [Segment(0.0, dt, record)]
        if free_vibration > 0.0:
            segments.append(Segment(end, free_vibration, np.zeros(2)))
    time = 0.0
    for segment in segments:
        time = run.advance(segment)
        if history is not None and not run.overturned:
            history.append(run.y.copy())
        if run.overturned:
            break
    return run.ledger.close(time=time, side=run.side, state=run.y, overturned=run.overturned, history=history)
