"""The properties of a rocking structure about one edge of its base."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from rockflex.foundation.checks import real_or_nan
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._base_element import BaseElement

PIVOT_VALUES = ("half_width", "eccentricity", "i_theta", "translational_inertia", "m_tot", "l0r")
"""Names of the `RockingProperties` that `build_pivot` needs."""

_OVERTURNING_SHARE = 0.7


@dataclass(frozen=True)
class OnColumns:
    """The columns on which a structure stands, which rock together; see `Podium`.

    Attributes
    ----------
    height : float
        Height in m of a column: a rotation moves all floors by this times θ.
    pull_moment : float
        Base moment in N m of what stands on them that first pulls an outer column; infinite if it is not known.
    """

    height: float
    pull_moment: float = math.inf


@dataclass(frozen=True)
class Pivot:
    """The properties of a rocking structure about one edge of its base; see `RockingProperties.pivot`.

    A tendon at x from the axis of the masses is at the distance r = `arm` - `side` x from the pivot.

    Attributes
    ----------
    side : int
        1 for the right edge, about which the structure rotates while θ > 0, and -1 for the left edge.
    arm : float
        Distance of the pivot from the axis of the masses in m: B - e to the right, B + e to the left.
    i_theta : float
        Moment of inertia about the pivot in kg m².
    weight_moment : float
        Moment of the weight, m_tot g times `arm`, in N m.
    prestress_moment : float
        Sum of F_0 r over the elements with an initial force, in N m.
    tendon_stiffness : float
        Sum of k r² over the tendons, in N m/rad.
    axial_stiffness_moment : float
        Sum of k r over the tendons, in N/rad: increase of their total force with the rotation.
    dissipator_moment : float
        Largest moment in N m with which dissipators can keep the base from closing: Σ (1 - α) F_y |r| over the fuses
        that can push, plus Σ F_0 |r| over the friction dampers.
    rocking_stiffness : float
        Slope of the static moment-rotation curve in N m/rad: `tendon_stiffness` - L_0^r g.
    nominal_overturning_rotation : float
        Nominal limit 0.7 atan(`arm`/h*_1) of the rotation in rad (Silva & Stojadinović 2024, Section 3.3); for a rigid
        block with L_0^r/m_tot in place of h*_1.
    uplift_acceleration : float
        Slow ground acceleration in m/s² that lifts the base about the pivot: `resisting_moment`/L_0^r.

    Examples
    --------
    >>> import rockflex as rf
    >>> pivot = rf.rigid_block(slenderness=0.25, half_diagonal=3.0).pivot(1)
    >>> round(pivot.arm, 3), round(pivot.balance_rotation, 3)
    (0.742, 0.255)
    """

    side: int
    arm: float
    i_theta: float
    weight_moment: float
    prestress_moment: float
    tendon_stiffness: float
    axial_stiffness_moment: float
    dissipator_moment: float
    rocking_stiffness: float
    nominal_overturning_rotation: float
    uplift_acceleration: float

    @property
    def resisting_moment(self) -> float:
        """M_r in N m: the base lifts about this pivot when the overturning moment exceeds it (Eq. 24)."""
        return self.weight_moment + self.prestress_moment

    @property
    def balance_rotation(self) -> float:
        """Rotation |θ| in rad at which the static moment vanishes; infinite if tendons prevent that."""
        return -self.resisting_moment / self.rocking_stiffness if self.rocking_stiffness < 0.0 else math.inf

    @property
    def self_centring(self) -> bool:
        """Whether weight and prestress close the base against its dissipators.

        This is `resisting_moment` > `dissipator_moment`, a condition at |θ| → 0 with the initial prestress: a tendon
        that yields loses some of it. If
        `rocking_stiffness` is negative, the base returns by itself from
        |θ| < (`resisting_moment` - `dissipator_moment`)/|`rocking_stiffness`|.
        """
        return self.dissipator_moment < self.resisting_moment

    @property
    def recentring_ratio(self) -> float:
        """λ = `resisting_moment`/`dissipator_moment`, infinite without dissipators; self-centring above 1.

        The ratio of Palermo, Pampanin & Marriott (2007, doi 10.1061/(ASCE)0733-9445(2007)133:11(1648)), with the
        dissipators' moment that can be locked in, at |θ| → 0. `RockingProperties.recentring_ratio_at` gives it at a
        design rotation. The flag-shaped loop of fuses without hardening has the parameter
        β = 2/(1 + λ) of Christopoulos, Filiatrault & Folz (2002).
        """
        locked = self.dissipator_moment
        return self.resisting_moment / locked if locked > 0.0 else math.inf


def checked_pivot_side(side: int) -> int:
    """Return 1 or -1.

    Raises
    ------
    InputError
        If `side` is neither.
    """
    if real_or_nan(side) not in (1.0, -1.0):
        raise InputError(
            f"side must be 1 (right edge of the base) or -1 (left edge), but {shown(side)} was given.",
            field="side",
        )
    return int(side)


def build_pivot(
    side: int,
    elements: Sequence[BaseElement],
    *,
    alike: bool,
    half_width: float,
    eccentricity: float,
    i_theta: float,
    translational_inertia: float,
    m_tot: float,
    l0r: float,
    height: float,
) -> Pivot:
    """Return one pivot of a structure from its `RockingProperties` and a height that defines the slenderness."""
    arm = half_width - side * eccentricity
    inertia = pivot_inertia(side * eccentricity, half_width, i_theta, translational_inertia, m_tot)
    weight, limit = m_tot * GRAVITY * arm, _OVERTURNING_SHARE * math.atan2(arm, height)
    if not elements:
        return Pivot(side, arm, inertia, weight, 0.0, 0.0, 0.0, 0.0, -l0r * GRAVITY, limit, weight / l0r)
    # Both pivots of a symmetric base must give identical numbers, to the last digit and in any order of the tendons.
    towards = 1 if alike else side
    elements = [each for each in elements if not each.attached]
    arms = [(each, each.arm(arm, towards)) for each in elements]
    if alike:
        prestress = sum((each.force_at_rest for each in elements), 0.0) * arm
        pull = sum((each.restoring_stiffness for each in elements), 0.0) * arm
    else:
        prestress = sum((each.force_at_rest * r for each, r in arms), 0.0)
        pull = sum((each.restoring_stiffness * r for each, r in arms), 0.0)
    stiffness = sum((each.restoring_stiffness * r**2 for each, r in arms), 0.0)
    return Pivot(
        side=side,
        arm=arm,
        i_theta=inertia,
        weight_moment=weight,
        prestress_moment=prestress,
        tendon_stiffness=stiffness,
        axial_stiffness_moment=pull,
        dissipator_moment=sum((each.locked_force * abs(r) for each, r in arms), 0.0),
        rocking_stiffness=stiffness - l0r * GRAVITY,
        nominal_overturning_rotation=limit,
        uplift_acceleration=(weight + prestress) / l0r,
    )


def build_both_pivots(elements: Sequence[BaseElement], *, alike: bool, **values: float) -> dict[int, Pivot]:
    """Return both pivots by their sides; if they are alike, they differ only in these. Values as of `build_pivot`."""
    right = build_pivot(1, elements, alike=alike, **values)
    if not alike:
        return {1: right, -1: build_pivot(-1, elements, alike=alike, **values)}
    left = object.__new__(Pivot)
    vars(left).update(vars(right), side=-1)
    return {1: right, -1: left}


def pivot_inertia(
    nearer: float, half_width: float, i_theta: float, translational_inertia: float, m_tot: float
) -> float:
    """Return I_θ in kg m² about a pivot whose distance to the axis is `half_width` - `nearer` (m)."""
    if nearer == 0.0:
        return i_theta
    # I_θ may have few printed digits; close to the axis the difference would be wrong, even negative.
    least = translational_inertia + m_tot * (half_width - nearer) ** 2
    return max(i_theta - m_tot * nearer * (2.0 * half_width - nearer), least)
