"""The parameters of a flexible rocking structure."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._checks import damping_ratios, finite_vector, instance, positive, whole_number
from rockflex._computable import computable
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.modal._floors import FloorModes
from rockflex.modal._tendons import Tendon, tendon_set

__all__ = ["RockingProperties"]

Float = NDArray[np.float64]

# Room for the rounding of sums that are equal when all modes are kept.
_SLACK = 1e-9
_PRINTED = 1e-5  # of I_θ: room for values that were printed to six digits
_OVERTURNING_SHARE = 0.7


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
        `translational_inertia` + m_tot B².
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
        What holds the base down beside its weight; within the base, and symmetric about its centre.

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
        _check_modes(modes)
        n_modes = modes["omega"].size
        inertia = _translational_inertia(modes, scalars, translational_inertia)
        if floors is not None and instance("floors", floors, FloorModes).n_modes != n_modes:
            message = f"floors must hold the same {n_modes} modes as omega, but it holds {floors.n_modes}."
            raise InputError(message)
        damping = damping_ratios("zeta", zeta, n_modes)
        held = _tendons_within(tendon_set(tendons), scalars["half_width"])
        vars(self).update(
            modes,
            **scalars,
            zeta=damping,
            translational_inertia=inertia,
            floors=floors,
            tendons=held,
            top_height=_top_height(floors, top_height),
            base_mass=_base_mass(modes, scalars["m_tot"], inertia, base_mass),
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
        left[np.abs(left) <= _SLACK * np.abs(moments)] = 0.0
        return left

    @property
    def weight_moment(self) -> float:
        """Part m_tot g B of the resisting moment that the weight gives, in N m."""
        return self.m_tot * GRAVITY * self.half_width

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
        """M_r = (m_tot g + prestress) B in N m: the base lifts when the overturning moment exceeds it (Eq. 24)."""
        return self.weight_moment + self.prestress * self.half_width

    @property
    def axial_stiffness(self) -> float:
        """Sum of the tendons' stiffnesses in N/m: what a base that is lifted without turning would feel."""
        return sum((each.stiffness for each in self.tendons), 0.0)

    @property
    def tendon_stiffness(self) -> float:
        """Sum of k (B - x)² in N m/rad: rotational stiffness that the tendons add while the base rocks."""
        return sum((each.stiffness * (self.half_width - each.position) ** 2 for each in self.tendons), 0.0)

    @property
    def rocking_stiffness(self) -> float:
        """Slope of the static moment over the rotation while rocking, in N m/rad: `tendon_stiffness` - L_0^r g."""
        return self.tendon_stiffness - self.l0r * GRAVITY

    @property
    def nominal_overturning_rotation(self) -> float:
        """Nominal limit 0.7 atan(B/h*_1) of the rotation in rad (Section 3.3); of a rigid block with L_0^r/m_tot."""
        height = float(self.effective_height[0]) if self.n_modes else self.l0r / self.m_tot
        return _OVERTURNING_SHARE * math.atan2(self.half_width, height)

    @computable("The inertia of the structure on this base")
    def with_half_width(self, half_width: float) -> "RockingProperties":
        """Return the same structure on a base of another half width B in m, of the same mass.

        I_θ changes by m_tot B² and M_r with B; the modes, L_0^r and what rotary inertia the bodies have stay as they
        are, and so do the tendons.

        Raises
        ------
        InputError
            If the half width is not positive, or a tendon does not stand within the base.
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


def _check_modes(modes: dict[str, Float]) -> None:
    omega, effective_mass = modes["omega"], modes["effective_mass"]
    for name, values in modes.items():
        if values.size != omega.size:
            message = f"{name} must hold one value a mode, as omega does ({omega.size}), but {values.size} were given."
            raise InputError(message)
    for name, values, unit in (("omega", omega, "rad/s"), ("effective_mass", effective_mass, "kg")):
        if values.min(initial=np.inf) <= 0.0:
            i = int(np.argmin(values))
            message = (
                f"{name} must be positive, but {name}[{i}] = {values[i]:g} {unit} was given. "
                "Leave out modes that do not take part."
            )
            raise InputError(message)
    falls = np.flatnonzero(omega[1:] < omega[:-1])
    if falls.size:
        i = int(falls[0])
        message = (
            f"omega must rise from mode to mode, but omega[{i + 1}] = {omega[i + 1]:g} rad/s is below "
            f"omega[{i}] = {omega[i]:g} rad/s. Sort the modes by frequency."
        )
        raise InputError(message)


def _tendons_within(tendons: tuple[Tendon, ...], half_width: float) -> tuple[Tendon, ...]:
    for tendon in tendons:
        if abs(tendon.position) > half_width * (1.0 + _SLACK):
            message = (
                f"Tendons must pass through the base, {half_width:g} m to each side of its centre, but one stands at "
                f"{tendon.position:g} m. Positions are measured from the centre."
            )
            raise InputError(message)
    return tendons


def _top_height(floors: FloorModes | None, given: float | None) -> float | None:
    if given is not None:
        return positive("top_height", given, "m")
    return None if floors is None else float(floors.heights.max())


def _base_mass(modes: dict[str, Float], m_tot: float, inertia: float, given: float | None) -> float | None:
    mass = modes["effective_mass"]
    modal_mass = float(mass.sum())
    if given is not None:
        base = positive("base_mass", given, "kg", zero=True)
        if m_tot - base < modal_mass - _SLACK * m_tot:
            message = (
                f"base_mass must leave the {modal_mass:.9g} kg that the modes move, but {base:.9g} kg of m_tot = "
                f"{m_tot:.9g} kg was given."
            )
            raise InputError(message)
        return base
    complete = mass.size > 0 and float(mass @ modes["effective_height"] ** 2) >= (1.0 - _SLACK) * inertia
    return max(m_tot - modal_mass, 0.0) if complete else None


@computable("The inertia of the modes, from effective_mass and effective_height,")
def _translational_inertia(modes: dict[str, Float], scalars: dict[str, float], given: float | None) -> float:
    mass = modes["effective_mass"]
    modal_mass = float(mass.sum())
    modal_inertia = float(mass @ modes["effective_height"] ** 2)
    i_theta, m_tot = scalars["i_theta"], scalars["m_tot"]
    if m_tot < modal_mass * (1.0 - _SLACK):
        message = (
            f"m_tot must be at least the sum of effective_mass, {modal_mass:.9g} kg, but {m_tot:.9g} kg was "
            "given. It is the mass of the whole structure with its base; check the units too."
        )
        raise InputError(message)
    if i_theta <= modal_inertia:
        message = (
            "i_theta must exceed the sum of effective_mass * effective_height**2, "
            f"{modal_inertia:.9g} kg m², but {i_theta:.9g} kg m² was given: no inertia is left to rotate. "
            "It is taken about a pivot, with the base; check the units too."
        )
        raise InputError(message)
    source = "i_theta - m_tot * half_width**2, its default," if given is None else "what was given"
    if given is None:
        inertia = i_theta - m_tot * scalars["half_width"] ** 2
    else:
        inertia = positive("translational_inertia", given, "kg m²")
    if not modal_inertia * (1.0 - _SLACK) <= inertia < i_theta:
        message = (
            "translational_inertia must be at least the sum of effective_mass * effective_height**2, "
            f"{modal_inertia:.9g} kg m², and below i_theta, {i_theta:.9g} kg m², but {source} is "
            f"{inertia:.9g} kg m². Give the sum of m_i h_i² over the masses above the base."
        )
        raise InputError(message)
    least = inertia + m_tot * scalars["half_width"] ** 2
    if i_theta < least * (1.0 - _PRINTED):
        message = (
            "i_theta must be at least translational_inertia + m_tot * half_width**2, "
            f"{least:.9g} kg m², but {i_theta:.9g} kg m² was given. It is taken about a pivot, so it changes with the "
            "base: properties.with_half_width(B) is the same structure on another one."
        )
        raise InputError(message)
    return max(inertia, modal_inertia)
