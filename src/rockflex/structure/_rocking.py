"""The parameters of a flexible rocking structure, and checks that they are physically possible."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    check_all_positive,
    checked_damping_ratios,
    checked_finite,
    checked_finite_vector,
    checked_instance,
    checked_magnitude,
    checked_positive,
    checked_whole_number,
)
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.values import Value, with_changed_fields
from rockflex.structure._analysis import FloorModes
from rockflex.structure._attachment import Attachment, YieldingStory
from rockflex.structure._elements import (
    BaseElement,
    Tendon,
    are_elements_symmetric,
    base_element_tuple,
    closes,
    element_pushover_force,
    initial_force,
)
from rockflex.structure._pivot import PIVOT_VALUES, Pivot, build_both_pivots, checked_pivot_side, pivot_inertia

SUM_TOLERANCE = 1e-9  # relative tolerance for rounding of sums that are equal if all modes are kept
PRINTED_TOLERANCE = 1e-5  # of I_θ: tolerance for values printed to six digits


def checked_modal_values(
    omega: ArrayLike, effective_mass: ArrayLike, effective_height: ArrayLike, top_ordinate: ArrayLike
) -> dict[str, Array]:
    modes = {
        "omega": checked_finite_vector("omega", omega, "rad/s"),
        "effective_mass": checked_finite_vector("effective_mass", effective_mass, "kg"),
        "effective_height": checked_finite_vector("effective_height", effective_height, "m"),
        "top_ordinate": checked_finite_vector("top_ordinate", top_ordinate, "m/m"),
    }
    omega, effective_mass = modes["omega"], modes["effective_mass"]
    for name, values in modes.items():
        if values.size != omega.size:
            raise InputError(
                f"{name} must contain one value per mode, as omega does ({omega.size}), but {values.size} were given.",
                field=name,
            )
    for name, values, unit in (("omega", omega, "rad/s"), ("effective_mass", effective_mass, "kg")):
        check_all_positive(name, values, unit, "Leave out modes that do not participate.")
    falls = np.flatnonzero(omega[1:] < omega[:-1])
    if falls.size:
        i = int(falls[0])
        raise InputError(
            f"omega must be in ascending order, but omega[{i + 1}] = {omega[i + 1]:g} rad/s is below "
            f"omega[{i}] = {omega[i]:g} rad/s. Sort the modes by frequency.",
            field="omega",
        )
    return modes


def checked_rocking_scalars(i_theta: float, l0r: float, m_tot: float, half_width: float) -> dict[str, float]:
    return {
        "i_theta": checked_positive("i_theta", i_theta, "kg m²"),
        "l0r": checked_positive("l0r", l0r, "kg m"),
        "m_tot": checked_positive("m_tot", m_tot, "kg"),
        "half_width": checked_positive("half_width", half_width, "m"),
    }


def checked_floor_modes(floors: FloorModes | None, n_modes: int) -> FloorModes | None:
    if floors is not None and checked_instance("floors", floors, FloorModes).n_modes != n_modes:
        raise InputError(
            f"floors must hold the same {n_modes} modes as omega, but it holds {floors.n_modes}.", field="floors"
        )
    return floors


@explaining_overflow("The inertia of the structure on this eccentric base")
def checked_eccentricity(modes: dict[str, Array], scalars: dict[str, float], inertia: float, given: float) -> float:
    e, b = checked_finite("eccentricity", given, "m") + 0.0, scalars["half_width"]  # + 0.0 takes the sign from -0.0
    if not abs(e) < b:
        raise InputError(
            f"eccentricity must be smaller than half_width, {b:g} m, to either side, but {e:g} m was given. It is the "
            "distance of the axis of the masses to the right of the middle of the base; check the units too.",
            field="eccentricity",
        )
    modal_inertia = float(modes["effective_mass"] @ modes["effective_height"] ** 2)
    nearer = pivot_inertia(abs(e), b, scalars["i_theta"], inertia, scalars["m_tot"])
    if nearer <= modal_inertia:
        raise InputError(
            f"eccentricity must leave rotational inertia about the nearer pivot, but with {e:.9g} m and half_width = "
            f"{b:.9g} m only the {modal_inertia:.9g} kg m² of the modes are left. Move the axis of the masses further "
            "from the edge of the base.",
            field="eccentricity",
        )
    return e


def elements_in_place(
    elements: tuple[BaseElement, ...], half_width: float, eccentricity: float, floors: FloorModes | None, n_modes: int
) -> tuple[BaseElement, ...]:
    limit = half_width + abs(eccentricity)  # on an eccentric base, outriggers may reach as far on the shorter side
    for element in elements:
        if element.attached:
            check_floors_of(element, floors, n_modes)
        if abs(element.position) > limit * (1.0 + SUM_TOLERANCE):
            what = "half_width" if eccentricity == 0.0 else "half_width + |eccentricity|"
            raise InputError(
                f"Elements must act within {what} = {limit:g} m to each side of the axis of the masses, but a "
                f"{type(element).__name__} is at {element.position:g} m.",
                field="elements",
            )
    return elements


def check_floors_of(element: Attachment, floors: FloorModes | None, n_modes: int) -> None:
    """Check that a structure has the floors to which an element is attached; a rigid block has any."""
    name, field_ = type(element).__name__, "between" if element.between else "height"
    if n_modes == 0:
        return
    if floors is None:
        raise InputError(
            f"A {name} with {field_} = {getattr(element, field_)} needs floors, but this structure has none. Give "
            "RockingProperties the floors (FloorModes), or use a structure with floors, such as a Frame.",
            field=field_,
        )
    count, top = floors.heights.size, float(floors.heights.max())
    if element.between is not None and max(element.between) > count:
        raise InputError(
            f"between must be floors from 0, the base, to {count}, but a {name} is between {element.between}.",
            field="between",
        )
    if element.height is not None and element.height > top * (1.0 + SUM_TOLERANCE):
        raise InputError(
            f"height must be at most that of the top, {top:g} m, but a {name} is at {element.height:g} m.",
            field="height",
        )


def checked_stories(
    given: Iterable[YieldingStory], floors: FloorModes | None, n_modes: int
) -> tuple[YieldingStory, ...]:
    stories = tuple(given) if n_modes else ()
    for each in stories:
        floor = checked_instance("stories", each, YieldingStory).floor
        if floors is None or floor > floors.heights.size:
            known = "none" if floors is None else f"{floors.heights.size}"
            raise InputError(
                f"stories: story {floor} yields, but the structure has {known}. Give RockingProperties the floors "
                "(FloorModes) with it.",
                field="stories",
            )
    return stories


def checked_top_height(floors: FloorModes | None, given: float | None) -> float | None:
    if given is not None:
        return checked_positive("top_height", given, "m")
    return None if floors is None else float(floors.heights.max())


def checked_base_mass(modes: dict[str, Array], moved: float, inertia: float, given: float | None) -> float | None:
    mass = modes["effective_mass"]
    modal_mass = float(mass.sum())
    if given is not None:
        base = checked_positive("base_mass", given, "kg", zero=True)
        if moved - base < modal_mass - SUM_TOLERANCE * moved:
            raise InputError(
                f"base_mass must leave the effective mass of the modes, {modal_mass:.9g} kg, but {base:.9g} kg of "
                f"m_tot = {moved:.9g} kg was given.",
                field="base_mass",
            )
        return base
    complete = mass.size > 0 and float(mass @ modes["effective_height"] ** 2) >= (1.0 - SUM_TOLERANCE) * inertia
    return max(moved - modal_mass, 0.0) if complete else None


@explaining_overflow("The inertia of the modes, from effective_mass and effective_height,")
def checked_translational_inertia(
    modes: dict[str, Array], scalars: dict[str, float], leaning_mass: float, given: float | None
) -> float:
    mass = modes["effective_mass"]
    modal_mass = float(mass.sum())
    modal_inertia = float(mass @ modes["effective_height"] ** 2)
    i_theta, m_tot = scalars["i_theta"], scalars["m_tot"]
    if m_tot + leaning_mass < modal_mass * (1.0 - SUM_TOLERANCE):
        raise InputError(
            f"m_tot must be at least the sum of effective_mass, {modal_mass:.9g} kg, but {m_tot:.9g} kg was "
            "given. It is the mass of the whole structure including its base; check the units too.",
            field="m_tot",
        )
    if i_theta <= modal_inertia:
        raise InputError(
            "i_theta must exceed the sum of effective_mass * effective_height**2, "
            f"{modal_inertia:.9g} kg m², but {i_theta:.9g} kg m² was given: no inertia is left for the rotation. "
            "It refers to a pivot and includes the base; check the units too.",
            field="i_theta",
        )
    source = "i_theta - m_tot * half_width**2, its default," if given is None else "the given value"
    if given is None:
        inertia = i_theta - m_tot * scalars["half_width"] ** 2
    else:
        inertia = checked_positive("translational_inertia", given, "kg m²")
    if not modal_inertia * (1.0 - SUM_TOLERANCE) <= inertia < i_theta:
        raise InputError(
            "translational_inertia must be at least the sum of effective_mass * effective_height**2, "
            f"{modal_inertia:.9g} kg m², and below i_theta, {i_theta:.9g} kg m², but {source} is "
            f"{inertia:.9g} kg m². Give the sum of m_i h_i² over the masses above the base.",
            field="translational_inertia",
        )
    least = inertia + m_tot * scalars["half_width"] ** 2
    if i_theta < least * (1.0 - PRINTED_TOLERANCE):
        raise InputError(
            "i_theta must be at least translational_inertia + m_tot * half_width**2, "
            f"{least:.9g} kg m², but {i_theta:.9g} kg m² was given. It refers to a pivot, so it changes with the "
            "base: properties.with_half_width(B) gives the same structure on another base.",
            field="i_theta",
        )
    return max(inertia, modal_inertia)


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
        Total mass in kg that stands on the base, with the base; with `leaning_mass` at least Σ_n m*_n.
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
        Elements between the base and the ground, at most B + |e| from the axis of the masses, and elements between
        floors or from a height to the ground, which need `floors`; see `Attachment`.
    eccentricity : float
        e in m, smaller than B in magnitude: distance of the vertical axis of the masses to the right of the middle of
        the base. The pivots are B - e to the right and B + e to the left of this axis.
    stories : tuple of YieldingStory
        Stories that yield, which need the `floors`; see `YieldingStories`. None by default.
    leaning_mass : float
        Σ l_i in kg, zero by default: mass that moves with the floors and stands on other columns, which are hinged; see
        `Leaning`. It is in the modes, in L_0^r and in Σ m_i h_i², but not in `m_tot`, so not in M_r.

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
    leaning_mass: float
    stories: tuple[YieldingStory, ...]

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
        leaning_mass: float = 0.0,
        stories: Iterable[YieldingStory] = (),
    ) -> None:
        modes = checked_modal_values(omega, effective_mass, effective_height, top_ordinate)
        scalars = checked_rocking_scalars(i_theta, l0r, m_tot, half_width)
        leaning = checked_positive("leaning_mass", leaning_mass, "kg", zero=True)
        inertia = checked_translational_inertia(modes, scalars, leaning, translational_inertia)
        e = checked_eccentricity(modes, scalars, inertia, eccentricity)
        vars(self).update(
            modes,
            **scalars,
            zeta=checked_damping_ratios("zeta", zeta, modes["omega"].size),
            translational_inertia=inertia,
            floors=checked_floor_modes(floors, modes["omega"].size),
            elements=elements_in_place(
                base_element_tuple(elements), scalars["half_width"], e, floors, modes["omega"].size
            ),
            top_height=checked_top_height(floors, top_height),
            base_mass=checked_base_mass(modes, scalars["m_tot"] + leaning, inertia, base_mass),
            eccentricity=e,
            leaning_mass=leaning,
            stories=checked_stories(stories, floors, modes["omega"].size),
        )

    @property
    def n_modes(self) -> int:
        """Number of modes n."""
        return self.omega.size

    @property
    def horizontal_mass(self) -> float:
        """Mass m_tot + Σ l_i in kg that moves horizontally with the structure."""
        return self.m_tot + self.leaning_mass

    @property
    def weight_share(self) -> float:
        """Share of the weight that stands on the base, and so resists uplift; 1 without leaning mass."""
        return self.m_tot / self.horizontal_mass

    @property
    def mass_left_out(self) -> Array:
        """Parts of Σ m_i, Σ m_i h_i and Σ m_i h_i² that the n modes leave out, in kg, kg m and kg m², shape (3,).

        The sums exclude the base. Stiff modes that are left out move with the base, and so does this mass. The first
        entry is NaN if `base_mass` is not known.
        """
        above = math.nan if self.base_mass is None else self.horizontal_mass - self.base_mass
        moments = np.array([above, self.l0r, self.translational_inertia])
        left = moments - np.array([self.effective_mass * self.effective_height**k for k in range(3)]).sum(axis=1)
        left[np.abs(left) <= SUM_TOLERANCE * np.abs(moments)] = 0.0
        return left

    def pivot(self, side: int) -> Pivot:
        """Return the properties about one edge of the base: 1 is the right edge, where θ > 0, and -1 the left edge.

        If the structure is `symmetric` the two differ only in their `side`.

        Raises
        ------
        InputError
            If `side` is neither.
        """
        return self._by_side[side if type(side) is int and side in (1, -1) else checked_pivot_side(side)]

    @cached_property
    def _by_side(self) -> dict[int, Pivot]:
        values: dict[str, float] = {name: getattr(self, name) for name in PIVOT_VALUES}
        height = float(self.effective_height[0]) if self.n_modes else self.l0r / self.m_tot
        return build_both_pivots(self.elements, alike=self.symmetric, height=height, **values)

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
        return self.eccentricity == 0.0 and (not self.elements or are_elements_symmetric(self.elements))

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
        """Sum of the initial forces of the elements under the base in N, those of tendons for example."""
        return sum((initial_force(each) for each in self.elements if not each.attached), 0.0)

    @cached_property
    def resting_reaction(self) -> float:
        """Vertical reaction m_tot g + prestress of a base at rest, in N."""
        return self.m_tot * GRAVITY + self.prestress

    @property
    def resisting_moment(self) -> float:
        """M_r = (m_tot g + prestress) B in N m: the base lifts when the overturning moment exceeds it (Eq. 24).

        If the pivots differ, it is the smaller value, about the `weaker_pivot`.
        """
        return self.weaker_pivot.resisting_moment

    @property
    def uplift_acceleration(self) -> float:
        """M_r/L_0^r in m/s²: the slow ground acceleration that lifts the base, about the `weaker_pivot`."""
        return self.weaker_pivot.uplift_acceleration

    @property
    def axial_stiffness(self) -> float:
        """Sum of the stiffnesses of tendons under the base in N/m: against lifting it without rotation."""
        return sum((each.stiffness for each in self.tendons if not each.attached), 0.0)

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

        The ratio of NZS 3101:2006, Appendix B: the moments of the weight, of the tendons and of bars that return to
        zero force over the dissipators', all pushed slowly from zero to the rotation, so that tendons pull more and
        fuses harden. The standard asks for their overstrength factor, 1.15 at least. The moment L_0^r g θ, by which
        the weight's falls, is not in it.

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
        turn = checked_positive("rotation", checked_magnitude("rotation", rotation, 0.5 * math.pi, "rad"), "rad")
        found: list[float] = []
        for pivot in self.pivots:
            arms = [(each, each.arm(pivot.arm, pivot.side)) for each in self.elements if not each.attached]
            moments = [(closes(each), element_pushover_force(each, r * turn) * r) for each, r in arms]
            locked = sum((abs(moment) for helps, moment in moments if not helps), 0.0)
            closing = pivot.weight_moment + sum((moment for helps, moment in moments if helps), 0.0)
            found.append(closing / locked if locked > 0.0 else math.inf)
        return min(found)

    @property
    def nominal_overturning_rotation(self) -> float:
        """Nominal limit 0.7 atan(B/h*_1) of the rotation in rad (Section 3.3); for a rigid block with L_0^r/m_tot.

        For an eccentric base it is the smaller of the two, with the distance of the nearer pivot in place of B.
        """
        return min(pivot.nominal_overturning_rotation for pivot in self.pivots)

    @explaining_overflow("The inertia of the structure on this base")
    def with_half_width(self, half_width: float) -> "RockingProperties":
        """Return the same structure on a base of the same mass and another half-width B in m.

        The part m_tot B² of I_θ and M_r change with B; modes, L_0^r, rotary inertia, tendons and eccentricity do not.

        Raises
        ------
        InputError
            If the half-width is not positive or not above the eccentricity, or a tendon is outside the base.
        """
        b = checked_positive("half_width", half_width, "m")
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
        k = checked_whole_number("n_modes", n_modes, 0, self.n_modes)
        if k == self.n_modes:
            return self
        return with_changed_fields(
            self,
            omega=self.omega[:k],
            effective_mass=self.effective_mass[:k],
            effective_height=self.effective_height[:k],
            top_ordinate=self.top_ordinate[:k],
            zeta=self.zeta[:k],
            floors=None if self.floors is None or k == 0 else self.floors.truncated(k),
            stories=self.stories if k else (),
        )
