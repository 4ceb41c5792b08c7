"""The parameters of a flexible rocking structure."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._checks import damping_ratios, finite_vector, instance, positive, whole_number
from rockflex._computable import computable
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.modal._floors import FloorModes
from rockflex.modal._pivot import PIVOT_VALUES, Pivot, checked_side, pivot_of
from rockflex.modal._rocking_checks import (
    SLACK,
    check_modes,
    checked_base_mass,
    checked_eccentricity,
    checked_inertia,
    checked_top_height,
    tendons_within,
)
from rockflex.modal._tendons import Tendon, balanced, tendon_set

Float = NDArray[np.float64]


@dataclass(frozen=True, eq=False, init=False)
class RockingProperties(Value):
    """The parameters of a rocking structure with n modes (Silva & Stojadinović 2024, Table 2).

    They hold for any structure, and can be filled by hand from the output of any finite element program. With no modes
    at all they are those of a rigid block.
    Sequences become read-only arrays.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        Circular frequencies ω_n on a fixed base in rad/s, not falling.
    effective_mass : ndarray, shape (n,)
        m*_n in kg, positive.
    effective_height : ndarray, shape (n,)
        h*_n in m, of either sign.
    top_ordinate : ndarray, shape (n,)
        Γ_n φ_top,n: displacement of the top for a unit of D_n, no unit; u_top = Σ_n Γ_n φ_top,n D_n.
    i_theta : float
        I_θ in kg m²: moment of inertia about a pivot, base mass included; above Σ_n m*_n h*_n², and at least
        `translational_inertia` + m_tot B². Of an eccentric base it is that about a pivot at the distance B from the
        axis of the masses all the same; `pivot` has those about its own two.
    l0r : float
        L_0^r = Σ_i m_i h_i in kg m.
    m_tot : float
        Total mass in kg, base included; at least Σ_n m*_n.
    half_width : float
        B in m, positive and finite. A base that cannot lift is a matter of the model, not of B.
    zeta : ndarray, shape (n,)
        Modal damping ratios in [0, 1); one number stands for all modes.
    translational_inertia : float
        Σ_i m_i h_i² in kg m², as Eqs. 19 and 29 need it; from Σ_n m*_n h*_n² to I_θ - m_tot B², which is the default
        and exact for lumped masses without rotary inertia.
    floors : FloorModes or None
        Floor displacements and forces of the same n modes, for quantities above the base.
    top_height : float or None
        Height of the top above the base in m, where `top_ordinate` is taken. Default: the highest floor; None where it
        is not known, and the total displacement of the top with it.
    base_mass : float or None
        Mass m_0 of the base in kg, a part of `m_tot`. Default: what all modes together leave of `m_tot`; None where
        modes are missing, and the mass that they would move is not known.
    tendons : tuple of Tendon
        What holds the base down beside its weight; within the base, from -(B + e) to B - e.
    eccentricity : float
        e in m, smaller than B: how far the vertical axis on which the masses lie stands to the right of the middle of
        the base, so that the pivots are B - e to its right and B + e to its left.

    Raises
    ------
    InputError
        If a value is not finite or outside the range named above, or the lengths differ.
    """

    omega: Float
    effective_mass: Float
    effective_height: Float
    top_ordinate: Float
    i_theta: float
    l0r: float
    m_tot: float
    half_width: float
    zeta: Float
    translational_inertia: float
    floors: FloorModes | None = field(repr=False)
    tendons: tuple[Tendon, ...]
    top_height: float | None
    base_mass: float | None
    eccentricity: float

    def __init__(
        self,
        omega: ArrayLike,
        effective_mass: ArrayLike,
        effective_height: ArrayLike,
        top_ordinate: ArrayLike,
        i_theta: float,
        l0r: float,
        m_tot: float,
        half_width: float,
        zeta: ArrayLike,
        translational_inertia: float | None = None,
        floors: FloorModes | None = None,
        tendons: Tendon | Iterable[Tendon] = (),
        top_height: float | None = None,
        base_mass: float | None = None,
        eccentricity: float = 0.0,
    ) -> None:
        modes = {
            "omega": finite_vector("omega", omega, "rad/s"),
            "effective_mass": finite_vector("effective_mass", effective_mass, "kg"),
            "effective_height": finite_vector("effective_height", effective_height, "m"),
            "top_ordinate": finite_vector("top_ordinate", top_ordinate, "m/m"),
        }
        scalars = {
            "i_theta": positive("i_theta", i_theta, "kg m²"),
            "l0r": positive("l0r", l0r, "kg m"),
            "m_tot": positive("m_tot", m_tot, "kg"),
            "half_width": positive("half_width", half_width, "m"),
        }
        check_modes(modes)
        n_modes = modes["omega"].size
        inertia = checked_inertia(modes, scalars, translational_inertia)
        if floors is not None and instance("floors", floors, FloorModes).n_modes != n_modes:
            raise InputError(
                f"floors must hold the same {n_modes} modes as omega, but it holds {floors.n_modes}.", field="floors"
            )
        damping = damping_ratios("zeta", zeta, n_modes)
        e = checked_eccentricity(modes, scalars, inertia, eccentricity)
        held = tendons_within(tendon_set(tendons), scalars["half_width"], e)
        vars(self).update(
            modes,
            **scalars,
            zeta=damping,
            translational_inertia=inertia,
            floors=floors,
            tendons=held,
            top_height=checked_top_height(floors, top_height),
            base_mass=checked_base_mass(modes, scalars["m_tot"], inertia, base_mass),
            eccentricity=e,
        )

    @property
    def n_modes(self) -> int:
        """Number of modes n."""
        return self.omega.size

    @property
    def mass_left_out(self) -> Float:
        """Σ m_i, Σ m_i h_i and Σ m_i h_i² above the base that the n modes leave out, in kg, kg m and kg m², shape (3,).

        Modes that are left out because they are stiff move with the base, and so does this mass. The first is NaN where
        `base_mass` is not known.
        """
        above = math.nan if self.base_mass is None else self.m_tot - self.base_mass
        moments = np.array([above, self.l0r, self.translational_inertia])
        shares = np.array([self.effective_mass * self.effective_height**k for k in range(3)]).sum(axis=1)
        left = moments - shares
        left[np.abs(left) <= SLACK * np.abs(moments)] = 0.0
        return left

    def pivot(self, side: int) -> Pivot:
        """Return what belongs to one edge of the base: 1 is the right one, where θ > 0, and -1 the left one.

        But for their `side` the two are alike if the structure is `symmetric`.

        Raises
        ------
        InputError
            If `side` is neither.
        """
        return self._by_side[checked_side(side)]

    @cached_property
    def _by_side(self) -> dict[int, Pivot]:
        values: dict[str, float] = {name: getattr(self, name) for name in PIVOT_VALUES}
        height = float(self.effective_height[0]) if self.n_modes else self.l0r / self.m_tot
        return {side: pivot_of(side, self.tendons, height=height, **values) for side in (1, -1)}

    @property
    def pivots(self) -> tuple[Pivot, ...]:
        """The pivots that there are to tell apart: one of a `symmetric` structure, else the right and the left one."""
        return (self.pivot(1),) if self.symmetric else (self.pivot(1), self.pivot(-1))

    @cached_property
    def weaker_pivot(self) -> Pivot:
        """The pivot with the lesser resisting moment, about which the base lifts first; the right one of two alike."""
        return min(self.pivots, key=lambda pivot: pivot.resisting_moment)

    @property
    def symmetric(self) -> bool:
        """Whether the base is not eccentric, and every tendon off its middle has a mirror image: both pivots alike."""
        return self.eccentricity == 0.0 and balanced(self.tendons)

    @property
    def weight_moment(self) -> float:
        """Part m_tot g B of the resisting moment that the weight gives, in N m; of the `weaker_pivot`."""
        return self.weaker_pivot.weight_moment

    @property
    def prestress(self) -> float:
        """Sum of the tendons' initial forces in N."""
        return sum((tendon.initial_force for tendon in self.tendons), 0.0)

    @property
    def resting_reaction(self) -> float:
        """Vertical reaction m_tot g + prestress of a base at rest, in N."""
        return self.m_tot * GRAVITY + self.prestress

    @property
    def resisting_moment(self) -> float:
        """M_r = (m_tot g + prestress) B in N m: the base lifts when the overturning moment exceeds it (Eq. 24).

        Where the pivots differ it is the lesser of the two, that of the `weaker_pivot`.
        """
        return self.weaker_pivot.resisting_moment

    @property
    def axial_stiffness(self) -> float:
        """Sum of the tendons' stiffnesses in N/m: what a base that is lifted without turning would feel."""
        return sum((each.stiffness for each in self.tendons), 0.0)

    @property
    def tendon_stiffness(self) -> float:
        """Sum of k (B - x)² in N m/rad: rotational stiffness that the tendons add about the `weaker_pivot`."""
        return self.weaker_pivot.tendon_stiffness

    @property
    def rocking_stiffness(self) -> float:
        """Slope of the static moment over the rotation while rocking, in N m/rad: `tendon_stiffness` - L_0^r g."""
        return self.tendon_stiffness - self.l0r * GRAVITY

    @property
    def nominal_overturning_rotation(self) -> float:
        """Nominal limit 0.7 atan(B/h*_1) of the rotation in rad (Section 3.3); of a rigid block with L_0^r/m_tot.

        Of an eccentric base it is the lesser of the two, with the nearer pivot's distance for B.
        """
        return min(pivot.nominal_overturning_rotation for pivot in self.pivots)

    @computable("The inertia of the structure on this base")
    def with_half_width(self, half_width: float) -> "RockingProperties":
        """Return the same structure on a base of another half width B in m, of the same mass.

        I_θ changes by m_tot B² and M_r with B; the modes, L_0^r and what rotary inertia the bodies have stay as they
        are, and so do the tendons and the eccentricity.

        Raises
        ------
        InputError
            If the half width is not positive or not above the eccentricity, or a tendon does not stand within the
            base.
        """
        b = positive("half_width", half_width, "m")
        rotary = self.i_theta - self.translational_inertia - self.m_tot * self.half_width**2
        # The rest is rounding where it is negative, and would weigh more about a closer pivot.
        about_pivot = self.translational_inertia + max(rotary, 0.0) + self.m_tot * b**2
        return self if b == self.half_width else replace(self, half_width=b, i_theta=about_pivot)

    def truncated(self, n_modes: SupportsIndex) -> "RockingProperties":
        """Return the same structure with its first `n_modes` modes alone, as a surrogate model has it; 0: rigid.

        I_θ, L_0^r, m_tot and Σ m_i h_i² belong to the structure and stay as they are (Section 2.3).

        Raises
        ------
        InputError
            If there are not as many modes.
        """
        k = whole_number("n_modes", n_modes, 0, self.n_modes)
        if k == self.n_modes:
            return self
        return replace(
            self,
            omega=self.omega[:k],
            effective_mass=self.effective_mass[:k],
            effective_height=self.effective_height[:k],
            top_ordinate=self.top_ordinate[:k],
            zeta=self.zeta[:k],
            floors=None if self.floors is None or k == 0 else self.floors.truncated(k),
            top_height=self.top_height,
            base_mass=self.base_mass,
        )
