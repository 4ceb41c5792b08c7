"""The complete model with one mode by Taylor series of the whole vector field (heyoka), with its events.

Eqs. 13-16 and 19 of Silva & Stojadinović 2024, written as Newton's law for a mass that flexes on a base that rotates
about one edge. State ``[D, D', θ, θ']``; parameters: the acceleration at the start of a sample, its slope, the side.
"""

from dataclasses import dataclass
from typing import Any

import heyoka as hy
import numpy as np

GRAVITY = 9.81
LEAVING = 1e-4  # of a sample


@dataclass(frozen=True)
class TaylorResult:
    """The largest |θ| and |D|, and the times of uplifts and impacts."""

    max_rotation: Any
    max_displacement: Any
    uplift_times: tuple[float, ...]
    impact_times: tuple[float, ...]


class TaylorRocking:
    """One mode on a symmetric base; integrators are compiled once, for any record.

    `kind` is the type of all numbers: `float`, or heyoka's `real128` of 34 digits.
    """

    def __init__(self, omega, mass, height, zeta, i_theta, l0r, m_tot, half_width, translational_inertia, kind=float):
        self.kind = kind
        omega, mass, height, zeta, i_theta, l0r, m_tot, half_width, inertia, gravity, two = (
            kind(float(each))
            for each in (
                omega,
                mass,
                height,
                zeta,
                i_theta,
                l0r,
                m_tot,
                half_width,
                translational_inertia,
                GRAVITY,
                2.0,
            )
        )
        self.mass, self.height, self.width = mass, height, half_width
        self.resisting = m_tot * gravity * half_width
        self.excess = kind(1.0) + kind(1e-14 if kind is float else 1e-30)
        self.near = kind(1e-13 if kind is float else 1e-28)  # of a sample
        self.kept = inertia - mass * height**2  # Σ m h² of the other modes
        d, v, theta, spin = hy.make_vars("d", "v", "theta", "spin")
        a, s = hy.par[0] + hy.par[1] * hy.time, hy.par[2]
        spring = omega**2 * d + two * zeta * omega * v
        sine, cosine = hy.sin(theta), hy.cos(theta)
        offset = s * half_width - d  # of the mass from the pivot, along the base
        beside = s * (m_tot * half_width) - mass * d
        mode = -spring - a * cosine + gravity * sine - spin**2 * offset
        weight = gravity * (l0r * sine - beside * cosine)
        ground = -a * (l0r * cosine + beside * sine)
        turning = weight + ground + two * mass * spin * v * offset - mass * height * mode
        angular = turning / (i_theta - mass * height**2 + mass * (d**2 - two * half_width * s * d))
        self.highest = highest = self.numbers(2)

        def note_peak(integrator, time, _sign) -> None:  # a function: methods are copied with their object
            integrator.update_d_output(time)
            np.maximum(highest, np.abs(integrator.d_output[[2, 0]]), out=highest)

        self.moment = lambda y, accel: (
            mass * height * (-(omega**2) * y[0] - two * zeta * omega * y[1] - accel)
            + l0r * accel
            - mass * gravity * y[0]
        )
        at_contact = mass * height * (-spring - a) + l0r * a - mass * gravity * d

        def integrator(rates, stops=(), peaks=(), parameters=3):
            return hy.taylor_adaptive(
                rates,
                self.numbers(4),
                pars=self.numbers(parameters),
                t_events=list(stops),
                nt_events=[hy.nt_event(each, note_peak, fp_type=kind) for each in peaks],
                fp_type=kind,
            )

        self.contact = integrator(
            [(d, v), (v, -spring - a), (theta, 0.0 * theta), (spin, 0.0 * spin)],
            [hy.t_event(at_contact + each, fp_type=kind) for each in (self.resisting, -self.resisting)],
            [v],
            parameters=2,
        )
        rates = [(d, v), (v, mode - height * angular), (theta, spin), (spin, angular)]
        # An event that is zero at the start of a step may hide another one in it: the base leaves the ground without.
        self.leaving = integrator(rates)
        self.rocking = integrator(
            rates, [hy.t_event(s * theta, direction=hy.event_direction.negative, fp_type=kind)], [v, spin]
        )

    def numbers(self, count):
        """Zeros of the type of all numbers."""
        return np.array([self.kind(0.0)] * count, dtype=self.kind)

    def _set(self, integrator, time, state, *values):
        integrator.time, integrator.state[:] = time, state
        integrator.pars[:] = np.array(values[: integrator.pars.size], dtype=self.kind)

    def run(self, record, dt: float) -> TaylorResult:
        """Run a record that is linear between its samples."""
        record, dt = [self.kind(float(each)) for each in record], self.kind(float(dt))
        leaving, half = self.kind(LEAVING), self.kind(0.5)
        self.highest[:], y, side = self.numbers(2), self.numbers(4), 0
        uplifts, impacts = [], []
        for k in range(len(record) - 1):
            slope, tau = (record[k + 1] - record[k]) / dt, self.kind(0.0)
            while dt - tau > self.near * dt:
                moment = self.moment(y, record[k] + slope * tau)
                if side == 0 and abs(moment) > self.resisting * self.excess:
                    side = -1 if moment > 0.0 else 1
                    uplifts.append(float(k * dt + tau))
                if side and y[2] == 0.0:
                    start = tau + min(leaving * dt, half * (dt - tau))
                    self._set(self.leaving, tau, y, record[k], slope, self.kind(side))
                    self.leaving.propagate_until(start)
                    y, tau = self.leaving.state.copy(), start
                integrator = self.rocking if side else self.contact
                self._set(integrator, tau, y, record[k], slope, self.kind(side))
                integrator.reset_cooldowns()
                outcome = integrator.propagate_until(dt)[0]
                y, tau = integrator.state.copy(), integrator.time
                np.maximum(self.highest, np.abs(y[[2, 0]]), out=self.highest)
                closed = bool(side) and side * y[2] <= 0.0 and side * y[3] < 0.0  # at the very end of a sample
                if outcome == hy.taylor_outcome.time_limit and not closed:
                    break
                if side:
                    impacts.append(float(k * dt + tau))
                    velocity = y[1] + self.height * y[3]
                    energy = self.mass * velocity**2 + self.kept * y[3] ** 2
                    y[1:] = self.numbers(3)
                    y[1:2] = np.sqrt(np.array([energy / self.mass], dtype=self.kind)) * (1 if velocity > 0.0 else -1)
                    side = 0
                else:  # the limit is reached continuously
                    side = 1 if self.moment(y, record[k] + slope * tau) < 0.0 else -1
                    uplifts.append(float(k * dt + tau))
        return TaylorResult(*self.highest, tuple(uplifts), tuple(impacts))


def of_properties(p, kind=float) -> TaylorRocking:
    """The model of a structure with its first mode."""
    numbers = p.omega[0], p.effective_mass[0], p.effective_height[0], p.zeta[0]
    return TaylorRocking(*numbers, p.i_theta, p.l0r, p.m_tot, p.half_width, p.translational_inertia, kind)
