"""The simplified models: linear in contact, linear while rocking, joined by guards and jumps (Eqs. 15, 23-25)."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rockflex._constants import GRAVITY
from rockflex._values import Value
from rockflex.modal import RockingProperties
from rockflex.models._impact import ImpactLaw, VVELSimplified

__all__ = ["LinearModel"]

Array = NDArray[np.float64]

NEUTRAL = 0.01  # of L_0^r g: nearer to balance the steady rotation, ∝ 1/`rocking_stiffness`, drowns the motion


@dataclass(frozen=True, eq=False)
class LinearModel(Value):
    """N modes on a base that may uplift: Eqs. 15, 23, 24 and 25 as linear functionals.

    Every functional, or *row*, runs over ``[D_1..D_N, D'_1..D'_N, θ, θ', a, s]``: the state, the ground
    acceleration and the side of rocking (s = +1 about the right pivot, -1 about the left one, 0 in contact).

    Parameters
    ----------
    label
        The model's name, such as ``"2DOF-S"``.
    properties
        The structure's parameters, with the modes of this model alone.
    lifts
        Whether the base can lift; if not, this is the structure on a fixed base.
    law
        What happens at an impact.
    missing_mass
        Whether base shear and base moment count the mass that the modes leave out, as if it moved with the base.
    """

    label: str
    properties: RockingProperties
    lifts: bool = True
    law: ImpactLaw = field(default_factory=VVELSimplified)
    missing_mass: bool = False
    free_inertia: float = field(init=False)
    """I_θ - Σ m* h*², the inertia that is left to the rotation while the modes move freely (kg m²)."""

    def __post_init__(self) -> None:
        p = self.properties
        object.__setattr__(self, "free_inertia", p.i_theta - float(np.sum(p.effective_mass * p.effective_height**2)))

    @property
    def resistance(self) -> float:
        """Overturning moment at which the base lifts, M_r (Eq. 24), in N m; infinite where it cannot."""
        return self.properties.resisting_moment if self.lifts else np.inf

    @property
    def neutral(self) -> bool:
        """Whether tendons balance the weight so closely that a rocking base has no steady rotation to speak of."""
        p = self.properties
        return self.lifts and abs(p.rocking_stiffness) < NEUTRAL * p.l0r * GRAVITY

    def contact_moment(self) -> Array:
        """Overturning moment in contact, the left-hand side of Eq. 24, in N m: a row, shape (2N + 4,)."""
        p = self.properties
        arm = p.effective_mass * p.effective_height
        restoring = np.concatenate((arm * p.omega**2, arm * 2.0 * p.zeta * p.omega))
        return np.concatenate((-restoring, [0.0, 0.0, p.l0r - arm.sum(), 0.0]))

    def angular_acceleration(self) -> Array:
        """θ'' while rocking, Eq. 23 with D'' eliminated, in rad/s²: a row, shape (2N + 4,)."""
        row = -self.contact_moment()
        row[-4] = -self.properties.rocking_stiffness
        row[-1] = -self.properties.resisting_moment
        return row / self.free_inertia

    def modal_accelerations(self, *, rocking: bool) -> Array:
        """D'' of every mode, Eq. 15 or (rocking) Eq. 23, in m/s²: rows, shape (N, 2N + 4)."""
        p = self.properties
        n = p.n_modes
        rows = np.zeros((n, 2 * n + 4))
        rows[:, :n] = -np.diag(p.omega**2)
        rows[:, n : 2 * n] = -np.diag(2.0 * p.zeta * p.omega)
        rows[:, -2] = -1.0
        return rows - np.outer(p.effective_height, self.angular_acceleration()) if rocking else rows
