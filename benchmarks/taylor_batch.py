"""The complete model with one mode by heyoka's batch mode: several runs at once, a lane of a vector register each.

Lanes of a batch share their field, so that contact and rocking are one field with a switch for each lane, and jumps
are callbacks of events. Eqs. 13-16 and 19 of Silva & Stojadinović 2024, as in tests/twins/taylor_rocking.py.
"""

import heyoka as hy
import numpy as np

GRAVITY = 9.81
LIFTED = 1e-17  # rad: at an uplift; below rounding, so that the landing is a root of its own


class TaylorBatch:
    """Runs of one structure with its first mode, centred on its base, under multiples of a record."""

    def __init__(self, p, lanes: int) -> None:
        omega, mass, height, zeta = (float(x[0]) for x in (p.omega, p.effective_mass, p.effective_height, p.zeta))
        width, resisting = p.half_width, p.m_tot * GRAVITY * p.half_width
        kept = p.translational_inertia - mass * height**2  # Σ m h² of the other modes
        d, v, theta, spin = hy.make_vars("d", "v", "theta", "spin")
        rise, slope, s = hy.par[0], hy.par[1], hy.par[2]  # a = rise + slope t; s = 0 in contact
        a, rocks = rise + slope * hy.time, s * s
        spring = omega**2 * d + 2.0 * zeta * omega * v
        sine, cosine = hy.sin(theta), hy.cos(theta)
        offset, beside = s * width - d, s * (p.m_tot * width) - mass * d
        mode = -spring - a * cosine + GRAVITY * sine - spin**2 * offset
        turning = GRAVITY * (p.l0r * sine - beside * cosine) - a * (p.l0r * cosine + beside * sine)
        turning += 2.0 * mass * spin * v * offset - mass * height * mode
        angular = rocks * turning / (p.i_theta - mass * height**2 + mass * (d**2 - 2.0 * s * width * d))
        moment = mass * height * (-spring - a) + p.l0r * a - mass * GRAVITY * d
        bending = rocks * (mode - height * angular) + (1.0 - rocks) * (-spring - a)
        self.highest = highest = np.zeros((2, lanes))

        def moment_of(integrator, lane: int) -> float:
            y, par = integrator.state[:, lane], integrator.pars[:, lane]
            accel = par[0] + par[1] * integrator.time[lane]
            force = mass * height * (-(omega**2) * y[0] - 2.0 * zeta * omega * y[1] - accel)
            return force + p.l0r * accel - mass * GRAVITY * y[0]

        def lift(integrator, lane: int) -> None:
            side = -np.sign(moment_of(integrator, lane))
            integrator.pars[2, lane], integrator.state[2, lane] = side, side * LIFTED

        def uplift(integrator, _sign, lane: int) -> bool:
            lift(integrator, lane)
            return True

        def land(integrator, _sign, lane: int) -> bool:
            y = integrator.state
            velocity = y[1, lane] + height * y[3, lane]
            energy = mass * velocity**2 + kept * y[3, lane] ** 2
            y[1:, lane] = np.sign(velocity) * np.sqrt(energy / mass), 0.0, 0.0
            integrator.pars[2, lane] = 0.0
            if abs(moment_of(integrator, lane)) > resisting:
                lift(integrator, lane)
            return True

        def note_peak(integrator, time, _sign, lane: int) -> None:
            integrator.update_d_output(np.full(lanes, time))
            highest[:, lane] = np.maximum(highest[:, lane], np.abs(integrator.d_output[[2, 0], lane]))

        self.lanes, self.lift, self.moment_of, self.resisting = lanes, lift, moment_of, resisting
        limits = [(1.0 - rocks) * (moment + sign * resisting) + rocks * resisting for sign in (1.0, -1.0)]
        landing = rocks * (s * theta) + (1.0 - rocks)
        falls = hy.event_direction.negative
        self.integrator = hy.taylor_adaptive_batch(
            [(d, v), (v, bending), (theta, spin), (spin, angular)],
            np.zeros((4, lanes)),
            pars=np.zeros((3, lanes)),
            t_events=[
                *(hy.t_event_batch(each, callback=uplift) for each in limits),
                hy.t_event_batch(landing, callback=land, direction=falls),
            ],
            nt_events=[hy.nt_event_batch(each, note_peak) for each in (v, spin)],
        )

    def run(self, record, dt: float, scales) -> np.ndarray:
        """The largest |θ| under each multiple of a record that is linear between its samples."""
        ta, scales = self.integrator, np.asarray(scales, dtype=float)
        ta.state[:], ta.pars[:], self.highest[:] = 0.0, 0.0, 0.0
        ta.reset_cooldowns()
        slopes = np.diff(record) / dt
        for k, slope in enumerate(slopes):
            ta.set_time(0.0)
            ta.pars[0], ta.pars[1] = record[k] * scales, slope * scales
            if k == 0:
                for lane in range(self.lanes):
                    if abs(self.moment_of(ta, lane)) > self.resisting:
                        self.lift(ta, lane)
            ta.propagate_until(dt)
            np.maximum(self.highest[0], np.abs(ta.state[2]), out=self.highest[0])
        return self.highest[0].copy()
