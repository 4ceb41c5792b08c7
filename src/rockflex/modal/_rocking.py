"""The parameters of a flexible rocking structure."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import damping_ratios, positive, whole_number, within
from rockflex._computable import computable
from rockflex._constants import GRAVITY
from rockflex._html import HtmlTable
from rockflex._values import Value, changed
from rockflex.modal._devices import BaseElement, element_set, mirrored, pushed_force
from rockflex.modal._floors import FloorModes
from rockflex.modal._pivot import PIVOT_VALUES, Pivot, checked_side, pivots_of
from rockflex.modal._rocking_checks import (
    SLACK,
    checked_base_mass,
    checked_eccentricity,
    checked_floors,
    checked_inertia,
    checked_modes,
    checked_scalars,
    checked_top_height,
    elements_within,
)
from rockflex.modal._tendons import Tendon


@dataclass(frozen=True, eq=False, init=False)
class RockingProperties(HtmlTable, Value):
    """The parameters of a rocking structure with n modes (Silva & Stojadinović 2024, Table 2).

    They describe any structure, and can be entered by hand from the output of any finite element program. Without modes
    they describe a rigid block. Sequences become read-only arrays.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        Circular frequencies ω_n on a fixed base in rad/s, in ascending order.
    effective_mass : ndarray, shape (n,)
        m*_n in kg, positive.
    effective_height : ndarray, shape (n,)
        h*_n in m, of either sign.
    top_ordinate : ndarray, shape (n,)
        Γ_n φ_top,n: displacement of the top per unit of D_n, dimensionless; u_top = Σ_n Γ_n φ_top,n D_n.
    i_theta : float
        I_θ in kg m²: moment of inertia about a pivot, including the base mass; above Σ_n m*_n h*_n², and at least
        `translational_inertia` + m_tot B². For an eccentric base, too, it refers to a pivot at the distance B from the
        axis of the masses; `pivot` gives the inertia about the actual pivots.
    l0r : float
        L_0^r = Σ_i m_i h_i in kg m.
    m_tot : float
        Total mass in kg, including the base; at least Σ_n m*_n.
    half_width : float
        B in m, positive and finite. For a base that cannot lift, choose a fixed-base model instead of a large B.
    zeta : ndarray, shape (n,)
        Modal damping ratios in [0, 1); a single number applies to all modes.
    translational_inertia : float
        Σ_i m_i h_i² in kg m², needed by Eqs. 19 and 29; from Σ_n m*_n h*_n² to I_θ - m_tot B². The latter is the
        default and exact for lumped masses without rotary inertia.
    floors : FloorModes or None
        Floor displacements and forces of the same n modes, for floor quantities.
    top_height : float or None
        Height in m of the top above the base. Default: the highest floor. If None, there is no total top displacement.
    base_mass : float or None
        Mass m_0 of the base in kg. Default: `m_tot` minus the effective mass of all modes; None if modes are missing.
    elements : tuple of Tendon, YieldingDissipator, ViscousDamper or FrictionDamper
        What acts between the base and the ground, at most B + |e| from the axis of the masses.
    eccentricity : float
        e in m, smaller than B in magnitude: distance of the vertical axis of the masses to the right of the middle of
        the base. The pivots are B - e to the right and B + e to the left of this axis.

    Raises
    ------
    InputError
        If a value is not finite or outside the range given above, or the lengths differ.

    Examples
    --------
    >>> import rockflex as rf
    >>> props = rf.RockingProperties(
    ...     omega=[6.28], effective_mass=[160e3], effective_height=[10.5], top_ordinate=[1.3],
    ...     i_theta=22e6, l0r=1.8e6, m_tot=240e3, half_width=1.3, zeta=0.02,
    ... )
    >>> round(props.resisting_moment)
    3060720
    """

    omega: Array
    effective_mass: Array
    effective_height: Array
    top_ordinate: Array
    i_theta: float
    l0r: float
    m_tot: float
    half_width: float
    zeta: Array
    translational_inertia: float
    floors: FloorModes | None = field(repr=False)
    elements: tuple[BaseElement, ...]
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
        elements: BaseElement | Iterable[BaseElement] = (),
        top_height: float | None = None,
        base_mass: float | None = None,
        eccentricity: float = 0.0,
    ) -> None:
        modes = checked_modes(omega, effective_mass, effective_height, top_ordinate)
        scalars = checked_scalars(i_theta, l0r, m_tot, half_width)
        inertia = checked_inertia(modes, scalars, translational_inertia)
        e = checked_eccentricity(modes, scalars, inertia, eccentricity)
        vars(self).update(
            modes,
            **scalars,
            zeta=damping_ratios("zeta", zeta, modes["omega"].size),
            translational_inertia=inertia,
            floors=checked_floors(floors, modes["omega"].size),
            elements=elements_within(element_set(elements), scalars["half_width"], e),
            top_height=checked_top_height(floors, top_height),
            base_mass=checked_base_mass(modes, scalars["m_tot"], inertia, base_mass),
            eccentricity=e,
        )

    @property
    def n_modes(self) -> int:
        """Number of modes n."""
        return self.omega.size

    @property
    def mass_left_out(self) -> Array:
        """Parts of Σ m_i, Σ m_i h_i and Σ m_i h_i² that the n modes leave out, in kg, kg m and kg m², shape (3,).

        The sums exclude the base. Stiff modes that are left out move with the base, and so does this mass. The first
        entry is NaN if `base_mass` is not known.
        """
        above = math.nan if self.base_mass is None else self.m_tot - self.base_mass
        moments = np.array([above, self.l0r, self.translational_inertia])
        left = moments - np.array([self.effective_mass * self.effective_height**k for k in range(3)]).sum(axis=1)
        left[np.abs(left) <= SLACK * np.abs(moments)] = 0.0
        return left

    def pivot(self, side: int) -> Pivot:
        """Return the properties about one edge of the base: 1 is the right edge, where θ > 0, and -1 the left edge.

        If the structure is `symmetric` the two differ only in their `side`.

        Raises
        ------
        InputError
            If `side` is neither.
        """
        return self._by_side[side if type(side) is int and side in (1, -1) else checked_side(side)]

    @cached_property
    def _by_side(self) -> dict[int, Pivot]:
        values: dict[str, float] = {name: getattr(self, name) for name in PIVOT_VALUES}
        height = float(self.effective_height[0]) if self.n_modes else self.l0r / self.m_tot
        return pivots_of(self.elements, alike=self.symmetric, height=height, **values)

    @property
    def pivots(self) -> tuple[Pivot, ...]:
        """The distinct pivots: one for a `symmetric` structure, otherwise the right and the left one."""
        return (self.pivot(1),) if self.symmetric else (self.pivot(1), self.pivot(-1))

    @cached_property
    def weaker_pivot(self) -> Pivot:
        """The pivot with the smaller resisting moment, about which the base lifts first; the right one if equal."""
        return min(self.pivots, key=lambda pivot: pivot.resisting_moment)

    @cached_property
    def symmetric(self) -> bool:
        """Whether both pivots are alike: no eccentricity, and every off-centre element has a mirror image."""
        return self.eccentricity == 0.0 and (not self.elements or mirrored(self.elements))

    @property
    def weight_moment(self) -> float:
        """Contribution m_tot g B of the weight to the resisting moment in N m, for the `weaker_pivot`."""
        return self.weaker_pivot.weight_moment

    @property
    def tendons(self) -> tuple[Tendon, ...]:
        """The tendons among the elements."""
        return tuple(each for each in self.elements if isinstance(each, Tendon))

    @property
    def prestress(self) -> float:
        """Sum of the tendons' initial forces in N."""
        return sum((tendon.initial_force for tendon in self.tendons), 0.0) if self.elements else 0.0

    @cached_property
    def resting_reaction(self) -> float:
        """Vertical reaction m_tot g + prestress of a base at rest, in N."""
        return self.m_tot * GRAVITY + self.prestress

    @property
    def resisting_moment(self) -> float:
        """M_r = (m_tot g + prestress) B in N m: the base lifts when the overturning moment exceeds it (Eq. 24).

        If the pivots differ, it is the smaller value, that of the `weaker_pivot`.
        """
        return self.weaker_pivot.resisting_moment

    @property
    def uplift_acceleration(self) -> float:
        """M_r/L_0^r in m/s²: the slow ground acceleration that lifts the base, about the `weaker_pivot`."""
        return self.weaker_pivot.uplift_acceleration

    @property
    def axial_stiffness(self) -> float:
        """Sum of the tendon stiffnesses in N/m: stiffness against lifting the base without rotation."""
        return sum((each.stiffness for each in self.tendons), 0.0)

    @property
    def tendon_stiffness(self) -> float:
        """Sum of k (B - x)² in N m/rad: rotational stiffness that the tendons add about the `weaker_pivot`."""
        return self.weaker_pivot.tendon_stiffness

    @property
    def rocking_stiffness(self) -> float:
        """Slope of the static moment-rotation curve while rocking, in N m/rad: `tendon_stiffness` - L_0^r g."""
        return self.tendon_stiffness - self.l0r * GRAVITY

    @property
    def self_centring(self) -> bool:
        """Whether the base closes against its dissipators about both pivots; see `Pivot.self_centring`."""
        return all(pivot.self_centring for pivot in self.pivots)

    @property
    def recentring_ratio(self) -> float:
        """λ of weight and prestress over dissipators, the smaller of both pivots; see `Pivot.recentring_ratio`."""
        return min(pivot.recentring_ratio for pivot in self.pivots)

    def recentring_ratio_at(self, rotation: float) -> float:
        """Return λ at a design rotation |θ| in rad, the smaller of both pivots; infinite where no dissipator acts.

        That of NZS 3101:2006, Appendix B: the moments of the weight and of the tendons over those of the dissipators,
        all pushed slowly from zero to the rotation, so that tendons pull more and fuses harden. The standard asks for
        their overstrength factor, 1.15 at least. The moment L_0^r g θ, by which the weight's falls, is not in it.

        Raises
        ------
        InputError
            If the rotation is not positive and below π/2.

        Examples
        --------
        >>> import rockflex as rf
        >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
        >>> held = rf.Restrained(frame, [rf.Tendon(100e3, 5e6), rf.YieldingDissipator(2e7, 400e3)]).rocking()
        >>> round(held.recentring_ratio, 2), round(held.recentring_ratio_at(0.03), 2)
        (3.19, 3.69)
        """
        turn = positive("rotation", within("rotation", rotation, 0.5 * math.pi, "rad"), "rad")
        found: list[float] = []
        for pivot in self.pivots:
            arms = [(each, pivot.arm - pivot.side * each.position) for each in self.elements]
            moments = [(isinstance(each, Tendon), pushed_force(each, r * turn) * r) for each, r in arms]
            locked = sum((abs(moment) for tendon, moment in moments if not tendon), 0.0)
            closing = pivot.weight_moment + sum((moment for tendon, moment in moments if tendon), 0.0)
            found.append(closing / locked if locked > 0.0 else math.inf)
        return min(found)

    @property
    def nominal_overturning_rotation(self) -> float:
        """Nominal limit 0.7 atan(B/h*_1) of the rotation in rad (Section 3.3); for a rigid block with L_0^r/m_tot.

        For an eccentric base it is the smaller of the two, with the distance of the nearer pivot in place of B.
        """
        return min(pivot.nominal_overturning_rotation for pivot in self.pivots)

    @computable("The inertia of the structure on this base")
    def with_half_width(self, half_width: float) -> "RockingProperties":
        """Return the same structure on a base of the same mass and another half-width B in m.

        The part m_tot B² of I_θ and M_r change with B; modes, L_0^r, rotary inertia, tendons and eccentricity do not.

        Raises
        ------
        InputError
            If the half-width is not positive or not above the eccentricity, or a tendon is outside the base.
        """
        b = positive("half_width", half_width, "m")
        rotary = self.i_theta - self.translational_inertia - self.m_tot * self.half_width**2
        # A negative rest is rounding error, which would matter more about a closer pivot.
        about_pivot = self.translational_inertia + max(rotary, 0.0) + self.m_tot * b**2
        return self if b == self.half_width else replace(self, half_width=b, i_theta=about_pivot)

    def truncated(self, n_modes: SupportsIndex) -> "RockingProperties":
        """Return the same structure with only its first `n_modes` modes, as in a surrogate model; 0 means rigid.

        I_θ, L_0^r, m_tot and Σ m_i h_i² belong to the structure and do not change (Section 2.3).

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`.
        """
        k = whole_number("n_modes", n_modes, 0, self.n_modes)
        if k == self.n_modes:
            return self
        return changed(
            self,
            omega=self.omega[:k],
            effective_mass=self.effective_mass[:k],
            effective_height=self.effective_height[:k],
            top_ordinate=self.top_ordinate[:k],
            zeta=self.zeta[:k],
            floors=None if self.floors is None or k == 0 else self.floors.truncated(k),
        )
