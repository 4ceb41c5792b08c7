"""The simplified models: linear in contact, linear while rocking, joined by guards and jumps (Eqs. 15, 23-25)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["LinearModel"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class LinearModel:
    """N oscillators on a base that may uplift: the parameters of Eqs. 15, 23, 24 and 25.

    Parameters
    ----------
    label
        The model's name, such as ``"2DOF-S"``.
    omega, zeta
        Circular frequencies (rad/s) and damping ratios, shape (N,).
    mass, height
        Effective modal masses m* (kg) and heights h* (m), shape (N,).
    i_theta
        Rotational inertia about a pivot, kg m².
    gravity_stiffness
        L_0^r g, N m.
    first_moment
        L_0^r, kg m.
    resisting_moment
        m_tot g B, N m; infinite on a base that cannot lift.
    """

    label: str
    omega: Array
    zeta: Array
    mass: Array
    height: Array
    i_theta: float
    first_moment: float
    gravity_stiffness: float
    resisting_moment: float

    @property
    def free_inertia(self) -> float:
        """I_θ - Σ m* h*², the inertia that is left to rotation when the modes do not hold it (kg m²)."""
        return self.i_theta - float(np.sum(self.mass * self.height**2))

    def contact_moment(self) -> Array:
        """Overturning moment in contact (Eq. 24) as a row over [D.., D'.., θ, θ', a, s], shape (2N + 4,)."""
        arm = self.mass * self.height
        return np.concatenate(
            (-arm * self.omega**2, -arm * 2.0 * self.zeta * self.omega, [0.0, 0.0, self.first_moment - arm.sum(), 0.0])
        )

    def angular_acceleration(self) -> Array:
        """θ'' while rocking (Eq. 23 with D'' eliminated) as a row over [D.., D'.., θ, θ', a, s], shape (2N + 4,)."""
        row = -self.contact_moment()
        n = self.omega.size
        row[2 * n] = self.gravity_stiffness
        row[2 * n + 3] = -self.resisting_moment
        return row / self.free_inertia

    def modal_accelerations(self, *, rocking: bool) -> Array:
        """D'' of each mode (Eq. 15, or Eq. 23 while rocking) as rows over [D.., D'.., θ, θ', a, s], (N, 2N + 4)."""
        n = self.omega.size
        rows = np.zeros((n, 2 * n + 4))
        k = np.arange(n)
        rows[k, k] = -(self.omega**2)
        rows[k, n + k] = -2.0 * self.zeta * self.omega
        rows[:, 2 * n + 2] = -1.0
        return rows - np.outer(self.height, self.angular_acceleration()) if rocking else rows
