"""The complete model with one mode by Taylor series of the whole vector field (heyoka), with its events.

Eqs. 13-16 and 19 of Silva & Stojadinović 2024, written as Newton's law for a mass that flexes on a base that rotates
about one edge. State ``[D, D', θ, θ']``; parameters: the acceleration at the start of a sample, its slope, the side.
"""

from dataclasses import dataclass

import heyoka as hy
import numpy as np

GRAVITY = 9.81
NEAR = 1e-13  # of a sample
LEAVING = 1e-4  # of a sample


@dataclass(frozen=True)
class TaylorResult:
    """The largest |θ| and |D|, and the times of uplifts and impacts."""

    max_rotation: float
    max_displacement: float
    uplift_times: tuple[float, ...]
    impact_times: tuple[float, ...]


class TaylorRocking:
    """One mode on a symmetric base; integrators are compiled once, for any record."""

    def __init__(self, omega, mass, height, zeta, i_theta, l0r, m_tot, half_width, translational_inertia):
        self.mass, self.height, self.width = mass, height, half_width
        self.resisting = m_tot * GRAVITY * half_width
        self.kept = translational_inertia - mass * height**2  # Σ m h² of the other modes
        d, v, theta, spin = hy.make_vars("d", "v", "theta", "spin")
        a, s = hy.par[0] + hy.par[1] * hy.time, hy.par[2]
        spring = omega**2 * d + 2.0 * zeta * omega * v
        sine, cosine = hy.sin(theta), hy.cos(theta)
        offset = s * half_width - d  # of the mass from the pivot, along the base
        mode = -spring - a * cosine + GRAVITY * sine - spin**2 * offset
        weight = GRAVITY * (l0r * sine - (s * m_tot * half_width - mass * d) * cosine)
        ground = -a * (l0r * cosine + (s * m_tot * half_width - mass * d) * sine)
        turning = weight + ground + 2.0 * mass * spin * v * offset - mass * height * mode
        angular = turning / (i_theta + mass * (d**2 - 2.0 * s * half_width * d) - mass * height**2)
        self.highest = highest = np.zeros(2)

        def note_peak(integrator, time, _sign) -> None:  # a function: methods are copied with their object
            integrator.update_d_output(time)
            np.maximum(highest, np.abs(integrator.d_output[[2, 0]]), out=highest)

        self.moment = lambda y, accel: (
            mass * height * (-(omega**2) * y[0] - 2.0 * zeta * omega * y[1] - accel)
            + l0r * accel
            - mass * GRAVITY * y[0]
        )
        at_contact = mass * height * (-spring - a) + l0r * a - mass * GRAVITY * d
        self.contact = hy.taylor_adaptive(
            [(d, v), (v, -spring - a), (theta, 0.0 * theta), (spin, 0.0 * spin)],
            np.zeros(4),
            pars=np.zeros(2),
            t_events=[hy.t_event(at_contact + sign * self.resisting) for sign in (1.0, -1.0)],
            nt_events=[hy.nt_event(v, note_peak)],
        )
        rates = [(d, v), (v, mode - height * angular), (theta, spin), (spin, angular)]
        # An event that is zero at the start of a step may hide another one in it: the base leaves the ground without.
        self.leaving = hy.taylor_adaptive(rates, np.zeros(4), pars=np.zeros(3))
        self.rocking = hy.taylor_adaptive(
            rates,
            np.zeros(4),
            pars=np.zeros(3),
            t_events=[hy.t_event(s * theta, direction=hy.event_direction.negative)],
            nt_events=[hy.nt_event(v, note_peak), hy.nt_event(spin, note_peak)],
        )

    @staticmethod
    def _set(integrator, time, state, *values):
        integrator.time, integrator.state[:] = time, state
        integrator.pars[:] = values[: integrator.pars.size]

    def run(self, record, dt: float) -> TaylorResult:
        """Run a record that is linear between its samples."""
        self.highest[:], y, side = 0.0, np.zeros(4), 0
        uplifts, impacts = [], []
        for k in range(len(record) - 1):
            slope, tau = (record[k + 1] - record[k]) / dt, 0.0
            while dt - tau > NEAR * dt:
                moment = self.moment(y, record[k] + slope * tau)
                if side == 0 and abs(moment) > self.resisting * (1.0 + 1e-14):
                    side = -int(np.sign(moment))
                    uplifts.append(k * dt + tau)
                if side and y[2] == 0.0:
                    start = tau + min(LEAVING * dt, 0.5 * (dt - tau))
                    self._set(self.leaving, tau, y, record[k], slope, side)
                    self.leaving.propagate_until(start)
                    y, tau = self.leaving.state.copy(), start
                integrator = self.rocking if side else self.contact
                self._set(integrator, tau, y, record[k], slope, side)
                integrator.reset_cooldowns()
                outcome = integrator.propagate_until(dt)[0]
                y, tau = integrator.state.copy(), integrator.time
                np.maximum(self.highest, np.abs(y[[2, 0]]), out=self.highest)
                closed = bool(side) and side * y[2] <= 0.0 and side * y[3] < 0.0  # at the very end of a sample
                if outcome == hy.taylor_outcome.time_limit and not closed:
                    break
                if side:
                    impacts.append(k * dt + tau)
                    velocity = y[1] + self.height * y[3]
                    energy = self.mass * velocity**2 + self.kept * y[3] ** 2
                    y[1:] = np.sign(velocity) * np.sqrt(energy / self.mass), 0.0, 0.0
                    side = 0
                else:  # the limit is reached continuously
                    side = 1 if self.moment(y, record[k] + slope * tau) < 0.0 else -1
                    uplifts.append(k * dt + tau)
        return TaylorResult(*self.highest.tolist(), tuple(uplifts), tuple(impacts))


def of_properties(p) -> TaylorRocking:
    """The model of a structure with its first mode."""
    numbers = p.omega[0], p.effective_mass[0], p.effective_height[0], p.zeta[0]
    return TaylorRocking(*map(float, numbers), p.i_theta, p.l0r, p.m_tot, p.half_width, p.translational_inertia)
