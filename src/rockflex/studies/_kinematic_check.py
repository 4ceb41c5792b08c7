"""Kinematic check of a wall that overturns as one body, as the Italian code has it for local mechanisms."""

from dataclasses import dataclass
from math import pi, sqrt
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_instance, checked_positive, is_one_of
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.motion._spectra import TargetSpectrum
from rockflex.motion._targets import damping_correction
from rockflex.response._quasi_static import element_at_start_of_path, slow_turn, static_tension
from rockflex.structure._base_element import BaseElement
from rockflex.structure._pivot import Pivot
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import RockingStructure, rocking_properties_of
from rockflex.studies._moment_rotation import QUARTER_TURN

if TYPE_CHECKING:
    import pandas as pd

LimitState = Literal["SLV", "SLC"]


class _Rule(NamedTuple):
    """What C8.7.1.2.1.6 and C8.7.1.2.1.8 say of a limit state."""

    share: float  # of d_0 that may be reached
    secant: float  # T = secant · π √(d/a)
    damping_ratio: float


_RULES = {"SLV": _Rule(0.4, 1.68, 0.08), "SLC": _Rule(0.6, 1.56, 0.10)}
_LC1 = 1.35  # confidence factor of the lowest level of knowledge


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class KinematicCheck(HtmlTable, Value):
    """The linear and the nonlinear kinematic check of a wall; see `kinematic_check`.

    Attributes
    ----------
    limit_state : {"SLV", "SLC"}
        Life safety or prevention of collapse.
    side : int
        1 if the wall overturns about its right edge, -1 about its left one.
    multiplier : float
        α_0, the largest horizontal forces over the weights that the wall resists.
    activation_acceleration : float
        a_0 in m/s², the largest of `acceleration`: as the wall opens, or as ties yield that are stretched first.
    displacement, acceleration : ndarray, shape (n,)
        The capacity curve a(d) in m and m/s² up to a = 0, of the centre of all masses; linear between its points.
    displacement_capacity : float
        The displacement in m that the limit state admits.
    secant_period : float
        Period in s with which the demand is read from the spectrum.
    displacement_demand : float
        In m, from the spectrum.
    ground_acceleration : float
        The spectrum at a period of zero, a_g S, in m/s².
    behaviour_factor : float
        q of the linear check.

    Examples
    --------
    >>> import rockflex as rf
    >>> facade = rf.OneSided(rf.rigid_block(width=0.6, height=8.0, mass=9e3))
    >>> found = rf.kinematic_check(facade, rf.ec8_spectrum(1.5, "B"))
    >>> found
    KinematicCheck(SLV, α_0 = 0.075, acceleration 1.65, displacement 0.833)
    >>> round(found.secant_period, 2), round(found.displacement_capacity, 3)
    (3.2, 0.12)
    """

    limit_state: LimitState
    side: int
    multiplier: float
    activation_acceleration: float
    displacement: Array
    acceleration: Array
    displacement_capacity: float
    secant_period: float
    displacement_demand: float
    ground_acceleration: float
    behaviour_factor: float

    @property
    def acceleration_ratio(self) -> float:
        """Demand over capacity of the linear check, a_g S/(q a_0)."""
        return self.ground_acceleration / (self.behaviour_factor * self.activation_acceleration)

    @property
    def displacement_ratio(self) -> float:
        """Demand over capacity of the nonlinear check; a_g S/a(0) if that is less, since the wall then stays closed."""
        return min(
            self.displacement_demand / self.displacement_capacity,
            self.ground_acceleration / float(self.acceleration[0]),
        )

    def to_frame(self) -> "pd.DataFrame":
        """Return the capacity curve as a table with the columns displacement and acceleration."""
        import pandas as pd

        return pd.DataFrame({"displacement": self.displacement, "acceleration": self.acceleration})

    def __repr__(self) -> str:
        return (
            f"KinematicCheck({self.limit_state}, α_0 = {self.multiplier:.3g}, acceleration "
            f"{self.acceleration_ratio:.3g}, displacement {self.displacement_ratio:.3g})"
        )


def kinematic_check(
    structure: RockingStructure | RockingProperties,
    spectrum: TargetSpectrum,
    *,
    limit_state: LimitState = "SLV",
    confidence_factor: float = _LC1,
    behaviour_factor: float = 2.0,
) -> KinematicCheck:
    """Check a wall that overturns as one body, such as a façade, as Circolare 7/2019 to NTC 2018 does (C8.7.1.2.1).

    The wall is one rigid block about its edge, with the elements under its base and from heights to the ground. With
    its weight P, the mass Q/g of what leans on it, the height h of their centre and the moment M(θ) that holds it,

    - α = M/((P + Q) h), a = α g/(e* FC) and d = h θ (C8.7.1.3 and C8.7.1.4); one block has e* = 1 (C8.7.1.5);
    - linear: q a_0 is compared with the acceleration of the ground, S_e(0) (C8.7.1.8 and C8.7.1.2.1.7);
    - nonlinear: d_SLV = 0.4 d_0 or d_SLC = 0.6 d_0, where a(d_0) = 0, is compared with the spectral displacement at
      T = 1.68 π √(d/a) or 1.56 π √(d/a) (C8.7.1.10 to C8.7.1.12) for a damping ratio of 8 or 10 %.

    The displacement spectrum counts as one that does not fall with the period. A structure that opens to both sides is
    checked on that with the larger `displacement_ratio`.

    Parameters
    ----------
    structure
        A `OneSided` wall, one with ties (`Restrained`), a `rigid_block` .. or their `RockingProperties`. Flexure, and
        elements between floors, do not matter.
    spectrum
        Elastic spectrum of the limit state at the foot of the wall, from a period of zero, such as `ec8_spectrum`; of a
        wall at a height the spectrum of that floor. It is brought to the damping of the check by √(10/(5 + ξ)) >= 0.55.
    limit_state
        "SLV" for life safety, "SLC" for prevention of collapse.
    confidence_factor
        FC, which divides the capacity; 1.35 wherever M disregards that masonry crushes, as a pivot at the edge does.
    behaviour_factor
        q of the linear check.

    Raises
    ------
    InputError
        If a factor is not positive, the structure has joints above its base or columns under it, does not stand, never
        overturns because elements hold it at any rotation, or the spectrum ends before the period that it needs.

    References
    ----------
    Circolare C.S.LL.PP. 21 January 2019, n. 7, C8.7.1.2.1. Of the shares of the displacement only that of d_0 is used:
    what else may end, such as the support of a floor, is yours to check, and so is the damage limit state.

    Examples
    --------
    >>> import rockflex as rf
    >>> wall = rf.OneSided(rf.rigid_block(width=0.6, height=8.0, mass=9e3))
    >>> tie = rf.YieldingDissipator(stiffness=2e6, yield_force=5e3, height=7.0,
    ...     tension_only=True)
    >>> target = rf.ec8_spectrum(2.5, "B")
    >>> for each in (wall, rf.Restrained(wall, tie)):
    ...     found = rf.kinematic_check(each, target)
    ...     print(round(found.acceleration_ratio, 2),
    ...         round(found.displacement_ratio, 2))
    2.75 1.39
    1.19 0.6
    """
    properties = rocking_properties_of(structure)
    checked_instance("spectrum", spectrum, TargetSpectrum)
    if not is_one_of(limit_state, _RULES):
        raise InputError(
            f'limit_state must be "SLV" or "SLC", but {shown(limit_state)} was given.', field="limit_state"
        )
    factor = checked_positive("confidence_factor", confidence_factor, "")
    q = checked_positive("behaviour_factor", behaviour_factor, "")
    if properties.joints or properties.columns is not None:
        raise InputError(
            "kinematic_check is for a wall that overturns as one body about its base, but this structure has joints "
            "above its base or columns under it. Give the structure without them, or run its time history.",
            field="structure",
        )
    found = list[KinematicCheck]()
    for side in properties.sides:
        displacement, acceleration = _capacity_curve(properties, side, factor)
        rule = _RULES[limit_state]
        capacity = rule.share * float(displacement[-1])
        period = rule.secant * pi * sqrt(capacity / float(np.interp(capacity, displacement, acceleration)))
        found.append(
            KinematicCheck(
                limit_state=limit_state,
                side=side,
                multiplier=float(acceleration.max()) * factor / GRAVITY,
                activation_acceleration=float(acceleration.max()),
                displacement=displacement,
                acceleration=acceleration,
                displacement_capacity=capacity,
                secant_period=period,
                displacement_demand=_displacement_demand(spectrum, period, rule.damping_ratio),
                ground_acceleration=float(spectrum.at([0.0])[0]),
                behaviour_factor=q,
            )
        )
    return max(found, key=lambda each: each.displacement_ratio)


def _capacity_curve(properties: RockingProperties, side: int, factor: float) -> tuple[Array, Array]:
    """Return d in m and a in m/s² up to a = 0, each (n,)."""
    elements, pivot = tuple(each.branched() for each in properties.elements), properties.pivot(side)
    arms = tuple(_arm(each, pivot) for each in properties.elements)
    rest = tuple(element_at_start_of_path(each) for each in elements)
    points = slow_turn(elements, arms, rest, 0.0, QUARTER_TURN, lifts=True)
    rotation = np.array([reached for reached, _ in points])
    tension = np.array([[static_tension(*each) for each in zip(elements, at, strict=True)] for _, at in points])
    held = tension.reshape(rotation.size, len(arms)) @ np.array(arms)
    moment = pivot.weight_moment + held - properties.l0r * GRAVITY * rotation
    fallen = int(np.argmax(moment <= 0.0))
    if moment[0] <= 0.0:
        raise InputError(
            f"The structure does not stand: its elements pull it over its edge with {-moment[0]:.4g} N m. Let them "
            "pull less, or from the other side.",
            field="structure",
        )
    if not fallen:
        raise InputError(
            "The elements hold the structure at any rotation, so that no displacement ends its resistance. Give them a "
            "yield force or a rupture elongation.",
            field="elements",
        )
    before = fallen - 1
    share = moment[before] / (moment[before] - moment[fallen])
    last = rotation[before] + share * (rotation[fallen] - rotation[before])
    way = np.append(rotation[:fallen], last) * properties.l0r / (properties.m_tot + properties.leaning_mass)
    return way, np.append(moment[:fallen], 0.0) / (properties.l0r * factor)


def _arm(element: BaseElement, pivot: Pivot) -> float:
    """Return the elongation of an element for a unit of |θ|, in m: zero between floors of a rigid wall."""
    if element.height is not None:
        return pivot.side * element.cosine * element.height
    return element.arm(pivot.arm, pivot.side)


def _displacement_demand(spectrum: TargetSpectrum, period: float, damping_ratio: float) -> float:
    """Return the largest spectral displacement in m up to a period, for a damping ratio.

    Between the periods of the table it is a power of the period, so that it is largest at one of them, or at the end.
    """
    table = spectrum.periods
    displacement = spectrum.sa * (table / (2.0 * pi)) ** 2
    if period > table[-1] and displacement[-1] > displacement[-2] * (1.0 + 1e-9):
        raise InputError(
            f"The spectrum ends at {table[-1]:g} s, where its displacement still grows, but the wall needs it up to "
            f"{period:.3g} s. Extend it.",
            field="spectrum",
        )
    largest = float(np.max(displacement, initial=0.0, where=table <= period))
    if period <= table[-1]:
        largest = max(largest, float(spectrum.at([period])[0]) * (period / (2.0 * pi)) ** 2)
    return largest * damping_correction(damping_ratio) / damping_correction(spectrum.damping_ratio)
