"""The nonlinear models: complete (Eqs. 13-16 and 26-29), yielding (Eqs. 37-38), or both."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rockflex._constants import GRAVITY
from rockflex._values import Value
from rockflex.modal import RockingProperties
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._field import Field
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._linear import LinearModel

__all__ = ["NonlinearModel"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class NonlinearModel(Value):
    """N modes on a base that may uplift, with large rotations, a superstructure that yields, or both.

    Rows run over ``[D_1..D_N, D'_1..D'_N, θ, θ', z, a, s]``.

    Parameters
    ----------
    label
        The model's name, such as ``"2DOF-C"``.
    properties
        The structure's parameters, with the modes of this model alone.
    lifts
        Whether the base can lift; if not, this is the structure on a fixed base.
    law
        What happens at an impact.
    complete
        Eqs. 13, 14 and 16 with all trigonometric, centrifugal and P-Δ terms; else Eqs. 23 and 24.
    bouc_wen
        Hysteresis of the one mode, or None for an elastic superstructure.
    missing_mass
        As in `LinearModel`.
    """

    label: str
    properties: RockingProperties
    lifts: bool = True
    law: ImpactLaw = field(default_factory=VVELSimplified)
    complete: bool = True
    bouc_wen: BoucWen | None = None
    missing_mass: bool = False

    @property
    def linear(self) -> LinearModel:
        """The simplified, elastic model of the same modes."""
        return LinearModel(self.label, self.properties, self.lifts, self.law, self.missing_mass)

    def stiffness(self) -> Array:
        """The restoring accelerations over (D_1..D_N, z), shape (N, N + 1): ω² D, or Eq. 37."""
        omega2 = self.properties.omega**2
        rows = np.column_stack((np.diag(omega2), np.zeros(omega2.size)))
        if self.bouc_wen is not None:
            share = self.bouc_wen.post_yield_ratio
            rows[:, :-1] *= share
            rows[:, -1] = omega2 * self.bouc_wen.yield_displacement * (1.0 - share)
        return rows

    def guards(self) -> Array:
        """Overturning moment in contact (Eqs. 16 and 24), and the rotation: rows, shape (2, 2N + 5)."""
        p = self.properties
        n = p.n_modes
        arm = p.effective_mass * p.effective_height
        restoring = arm @ self.stiffness()
        guards = np.zeros((2, 2 * n + 5))
        guards[0, :n] = -restoring[:-1]
        if self.complete:
            guards[0, :n] -= p.effective_mass * GRAVITY
        guards[0, n : 2 * n] = -arm * 2.0 * p.zeta * p.omega
        guards[0, 2 * n + 2] = -restoring[-1]
        guards[0, -2] = p.l0r - arm.sum()
        guards[1, 2 * n] = 1.0
        return guards

    def angular_acceleration(self) -> Array:
        """θ'' while a simplified model rocks, Eq. 23 with D'' eliminated, in rad/s²: a row, shape (2N + 5,)."""
        linear = self.linear
        row = -self.guards()[0]
        row[-5] = -self.properties.rocking_stiffness
        row[-1] = -self.properties.resisting_moment
        return row / linear.free_inertia

    def modal_accelerations(self, *, rocking: bool) -> Array:
        """D'' of every mode in contact, or while a simplified model rocks, in m/s²: rows, shape (N, 2N + 5)."""
        p = self.properties
        n = p.n_modes
        rows = np.zeros((n, 2 * n + 5))
        stiffness = self.stiffness()
        rows[:, :n] = -stiffness[:, :-1]
        rows[:, n : 2 * n] = -np.diag(2.0 * p.zeta * p.omega)
        rows[:, 2 * n + 2] = -stiffness[:, -1]
        rows[:, -2] = -1.0
        return rows - np.outer(p.effective_height, self.angular_acceleration()) if rocking else rows

    def field(self) -> Field:
        """Coefficients of the vector field."""
        p = self.properties
        b = self.bouc_wen or BoucWen(1.0)
        return Field(
            complete=self.complete,
            hysteretic=self.bouc_wen is not None,
            omega2=p.omega**2,
            damping=2.0 * p.zeta * p.omega,
            height=p.effective_height.copy(),  # writable, as the kernels are compiled for
            mass=p.effective_mass.copy(),
            inertia=p.i_theta,
            weight_arm=p.l0r,
            total_mass=p.m_tot,
            half_width=p.half_width,
            prestress_moment=p.prestress * p.half_width,
            tendon_stiffness=p.tendon_stiffness,
            prestress=p.prestress,
            axial_stiffness=p.axial_stiffness,
            gravity=GRAVITY,
            yield_displacement=b.yield_displacement,
            post_yield_ratio=b.post_yield_ratio,
            gamma=b.gamma,
            beta=b.beta,
            exponent=b.exponent,
            whole=int(b.exponent) if b.exponent.is_integer() else 0,
        )
