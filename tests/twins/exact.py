"""The simplified rocking model as constant matrices, and their exponentials.

Source: Silva & Stojadinović 2024, Eqs. 15 and 23-25. The state is augmented by what drives it,
``z = [θ, D, θ', D', s, a, a']`` with s the side (0 in contact), so that z' = Z z has constant coefficients
within a sample and z(t + τ) = expm(Z τ) z(t).
"""

import numpy as np
from scipy.linalg import expm

from twins.result import Vector

GRAVITY = 9.81
SERIES_TERMS = 80


class Exact:
    """Generators, propagators and output rows, assembled from the mass matrix of Eq. 23."""

    def __init__(
        self,
        omega,
        effective_mass,
        effective_height,
        top_ordinate,
        i_theta,
        l0r,
        m_tot,
        half_width,
        zeta,
        dt: float,
        substeps: int,
    ) -> None:
        w, m, h, top = (
            np.atleast_1d(np.asarray(v, float)) for v in (omega, effective_mass, effective_height, top_ordinate)
        )
        n = self.n = w.size
        q = n + 1
        self.h, self.resisting = h, m_tot * GRAVITY * half_width
        self.side, self.a, self.slope = 2 * q, 2 * q + 1, 2 * q + 2
        size = 2 * q + 3

        mass = np.eye(q)
        mass[0, 0], mass[0, 1:], mass[1:, 0] = i_theta, m * h, h
        damping = np.diag(np.concatenate([[0.0], 2.0 * np.broadcast_to(zeta, n) * w]))
        stiffness = np.diag(np.concatenate([[-l0r * GRAVITY], w**2]))
        push = np.concatenate([[l0r], np.ones(n)])
        hold = np.concatenate([[self.resisting], np.zeros(n)])

        rocking, contact = np.zeros((size, size)), np.zeros((size, size))
        rocking[:q, q : 2 * q] = np.eye(q)
        rocking[q : 2 * q, :q] = -np.linalg.solve(mass, stiffness)
        rocking[q : 2 * q, q : 2 * q] = -np.linalg.solve(mass, damping)
        rocking[q : 2 * q, self.side] = -np.linalg.solve(mass, hold)
        rocking[q : 2 * q, self.a] = -np.linalg.solve(mass, push)
        rocking[self.a, self.slope] = 1.0
        contact[1:q, q + 1 : 2 * q] = np.eye(n)
        contact[q + 1 : 2 * q, 1:q] = -stiffness[1:, 1:]
        contact[q + 1 : 2 * q, q + 1 : 2 * q] = -damping[1:, 1:]
        contact[q + 1 : 2 * q, self.a] = -1.0
        contact[self.a, self.slope] = 1.0
        self.generator = {False: contact, True: rocking}

        # Balanced coordinates (square roots of energies), or expm would lose θ among the stiff modes.
        self.fastest = float(np.abs(np.linalg.eigvals(rocking[: 2 * q, : 2 * q])).max())
        drive = self.fastest / np.sqrt(m.max())
        unit = np.concatenate(
            [
                [1.0 / (self.fastest * np.sqrt(i_theta))],
                1.0 / (w * np.sqrt(m)),
                [1.0 / np.sqrt(i_theta)],
                1.0 / np.sqrt(m),
                [self.fastest / (np.sqrt(i_theta) * abs(rocking[q, self.side])), drive, drive / dt],
            ]
        )
        self.step = dt / substeps
        grid = self.step * np.arange(1, substeps + 1)
        self.stack = {}
        for phase, z in self.generator.items():
            balanced = z * unit / unit[:, None]
            self.stack[phase] = np.array([unit[:, None] * expm(balanced * t) / unit for t in grid])
            still = [self.side, self.slope] if phase else [0, q, self.side, self.slope]
            self.stack[phase][:, still] = np.eye(size)[still]  # constants are carried without rounding
            self.stack[phase][:, self.a] = np.eye(size)[self.a]
            self.stack[phase][:, self.a, self.slope] = grid

        rows = np.zeros((5, size))
        rows[0, 0] = 1.0
        rows[1, 1:q], rows[2, 1:q], rows[3, 1:q] = top, m * h * w**2, m * w**2
        rows[4] = (m * h) @ contact[q + 1 : 2 * q]  # Eq. 24: Σ m* h* D'' + L a, with D'' of Eq. 15
        rows[4, self.a] += l0r
        self.rows = rows
        self.rates = {phase: rows @ z for phase, z in self.generator.items()}
        self.angular_velocity = q

    def inside(self, z: Vector, tau: float) -> Vector:
        """The exact solution τ after z, τ within a sub-step, by the exponential's own series applied to z.

        Term by term no digit is lost in θ just after uplift, where a dense expm(Z τ) would round it away.
        """
        generator = self.generator[z[self.side] != 0.0]
        total, term = z.copy(), z
        for k in range(1, SERIES_TERMS):
            term = generator @ term * (tau / k)
            total += term
            if k > 8 and np.all(abs(term) <= 1e-18 * abs(total)):
                break
        return total

    def overturning(self, z: Vector) -> float:
        return float(self.rows[4] @ z)

    def landed(self, z: Vector) -> Vector:
        """Eq. 25."""
        q = self.n + 1
        after = z.copy()
        after[q + 1 : 2 * q] += self.h * z[q]
        after[[0, q, self.side]] = 0.0
        return after

    def plain(self, z: Vector) -> Vector:
        """``[θ, θ', D, D']``."""
        q = self.n + 1
        return np.concatenate([z[[0, q]], z[1:q], z[q + 1 : 2 * q]])
