"""Eqs. 15 and 23-25 of Silva & Stojadinović 2024 as vector fields, guard and jump on ``[θ, θ', D, D']``."""

from typing import NamedTuple

import numpy as np

from twins.result import Vector

GRAVITY = 9.81
SAME_INSTANT = 1e-10  # of a sample: an event this close to a kink belongs to the kink


class Segment(NamedTuple):
    """Record values every ``dt`` from ``start`` on, linear in between; τ counts from ``start``."""

    start: float
    dt: float
    values: Vector

    @property
    def length(self) -> float:
        return self.dt * (self.values.size - 1)

    def interval(self, tau: float) -> int:
        return min(int(tau / self.dt), self.values.size - 2)

    def excitation(self, tau: float) -> float:
        i = self.interval(tau)
        return self.values[i] + (tau / self.dt - i) * (self.values[i + 1] - self.values[i])

    def excitations(self, times: Vector) -> Vector:
        return np.interp(times, self.dt * np.arange(self.values.size), self.values)

    def slope(self, tau: float) -> float:
        i = self.interval(tau + SAME_INSTANT * self.dt)
        return (self.values[i + 1] - self.values[i]) / self.dt

    def room(self, tau: float) -> float:
        """Time to the next kink."""
        i = self.interval(tau + SAME_INSTANT * self.dt)
        return self.dt * (i + 1) - tau


class Model:
    """Vector fields, guard, jump and outputs of the simplified model as rows acting on the state."""

    def __init__(self, omega, m_eff, h_eff, top_ordinate, i_theta, l0r, m_tot, half_width, zeta) -> None:
        w, m, h, top = (np.atleast_1d(np.asarray(v, float)) for v in (omega, m_eff, h_eff, top_ordinate))
        damping = 2.0 * np.broadcast_to(np.asarray(zeta, float), w.shape) * w
        n = self.n = w.size
        self.omega, self.slenderness = w, m_tot * half_width / l0r
        self.h, self.resisting = h, m_tot * GRAVITY * half_width
        self.inertia = i_theta - m @ h**2
        if not self.inertia > 0.0:
            msg = "I_θ must exceed Σ m* h*²"
            raise ValueError(msg)
        self.fastest = w[-1] * np.sqrt(i_theta / self.inertia)
        d, v = slice(2, 2 + n), slice(2 + n, 2 + 2 * n)
        size = 2 + 2 * n

        # Overturning moment of Eq. 24 with Eq. 15 put in: C = guard·y + guard_a·a.
        self.guard = np.zeros(size)
        self.guard[d], self.guard[v] = -m * h * w**2, -m * h * damping
        self.guard_a = l0r - m @ h

        contact = np.zeros((size, size))
        contact[d, v] = np.eye(n)
        contact[v, d], contact[v, v] = -np.diag(w**2), -np.diag(damping)
        contact_a = np.zeros(size)
        contact_a[v] = -1.0

        # First row of Eq. 23 minus Σ m* h* times the others: (I_θ - Σ m* h*²) θ'' = L g θ ∓ M_r - C.
        turn = -self.guard / self.inertia
        turn[0] = l0r * GRAVITY / self.inertia
        rocking = contact.copy()
        rocking[0, 1] = 1.0
        rocking[1] = turn
        rocking[v] -= np.outer(h, turn)
        rocking_a, rocking_s = contact_a.copy(), np.zeros(size)
        rocking_a[1] = -self.guard_a / self.inertia
        rocking_a[v] -= h * rocking_a[1]
        rocking_s[1] = -self.resisting / self.inertia
        rocking_s[v] = -h * rocking_s[1]
        zero = np.zeros(size)
        self.field = {
            0: (contact, contact_a, zero),
            1: (rocking, rocking_a, rocking_s),
            -1: (rocking, rocking_a, -rocking_s),
        }

        self.outputs = np.zeros((4, size))
        self.outputs[0, 0] = 1.0
        self.outputs[1, d], self.outputs[2, d], self.outputs[3, d] = top, m * h * w**2, m * w**2

    def overturning(self, y: Vector, a: float) -> float:
        return self.guard @ y + self.guard_a * a

    def side_wanted(self, y: Vector, a: float) -> int:
        """Side to which the base lifts at once (Eq. 24, strict), else 0."""
        moment = self.overturning(y, a)
        return 0 if abs(moment) <= self.resisting else -1 if moment > 0.0 else 1

    def landed(self, y: Vector) -> Vector:
        """Eq. 25: the impact keeps each mass's horizontal velocity."""
        after = y.copy()
        after[2 + self.n :] += self.h * y[1]
        after[:2] = 0.0
        return after

    def scale(self, pga: float) -> Vector:
        """A size for each component of the state: θ as where the resisting moment ends, D_n as a/ω_n²."""
        d = max(pga, GRAVITY * self.slenderness) / self.omega**2
        return np.concatenate([self.slenderness * np.array([1.0, self.omega[0]]), d, d * self.omega])
