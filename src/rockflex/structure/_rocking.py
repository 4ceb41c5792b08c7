"""The parameters of a flexible rocking structure."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated, ClassVar, Literal, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    checked_damping_ratios,
    checked_instance,
    checked_instances,
    checked_magnitude,
    checked_positive,
    checked_whole_number,
)
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.descriptions import PLAIN, Described, described
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.schema import DAMPING_RATIOS, HalfWidth
from rockflex.foundation.values import Value, with_changed_fields
from rockflex.structure._analysis import FloorModes
from rockflex.structure._attachment import YieldingStory
from rockflex.structure._base_element import BaseElement
from rockflex.structure._elements import Tendon, are_elements_symmetric, base_element_tuple, tendons_among
from rockflex.structure._joint import JointAbove
from rockflex.structure._pivot import PIVOT_VALUES, OnColumns, Pivot, build_both_pivots, checked_pivot_side
from rockflex.structure._rocking_checks import (
    SUM_TOLERANCE,
    checked_base_mass,
    checked_eccentricity,
    checked_floor_modes,
    checked_modal_values,
    checked_restitution,
    checked_stories,
    checked_top_height,
    checked_translational_inertia,
    elements_in_place,
)


@described
@dataclass(frozen=True, eq=False, init=False)
class RockingProperties(HtmlTable, Value):
    """The parameters of a rocking structure with n modes (Silva & Stojadinović 2024, Table 2).

    They describe any structure, and can be entered by hand from the output of any finite element program. Without modes
    they describe a rigid block. Sequences become read-only arrays.

    Raises
    ------
    InputError
        If a value is not finite or outside the range given above, or the lengths differ.

    Examples
    --------
    >>> import rockflex as rf
    >>> props = rf.RockingProperties(
    ...     omega=[6.28], effective_mass=[160e3], effective_height=[10.5],
    ...     top_ordinate=[1.3],
    ...     i_theta=22e6, l0r=1.8e6, m_tot=240e3, half_width=1.3, zeta=0.02,
    ... )
    >>> round(props.resisting_moment)
    3060720
    """

    title: ClassVar[str] = "Rocking parameters"

    omega: Annotated[
        Array,
        Described(
            "a list of circular frequencies in rad/s, one a mode",
            "rad/s",
            form=PLAIN,
            in_file=list[float],
            note="On a fixed base, in ascending order.",
            low=1e-3,
            high=1e6,
            label="ω",
        ),
    ]
    effective_mass: Annotated[
        Array,
        Described(
            "a list of effective masses m*_n in kg", "kg", form=PLAIN, in_file=list[float], note="They are positive."
        ),
    ]
    effective_height: Annotated[
        Array,
        Described(
            "a list of effective heights h*_n in m", "m", form=PLAIN, in_file=list[float], note="They have either sign."
        ),
    ]
    top_ordinate: Annotated[
        Array,
        Described(
            "a list of the top's displacement for a unit of each mode",
            form=PLAIN,
            in_file=list[float],
            note="Γ_n φ_top,n, dimensionless: u_top = Σ_n Γ_n φ_top,n D_n.",
        ),
    ]
    i_theta: Annotated[
        float,
        Described(
            "the moment of inertia about a pivot",
            "kg m²",
            rule="positive",
            note="With the base; above Σ_n m*_n h*_n², and at least `translational_inertia` + m_tot B². For an "
            "eccentric base, too, it refers to a pivot at the distance B from the axis of the masses; `pivot` gives "
            "the inertia about the actual pivots.",
            label="I_θ",
        ),
    ]
    l0r: Annotated[float, Described("the sum of m_i h_i", "kg m", rule="positive", label="L₀ʳ")]
    m_tot: Annotated[
        float,
        Described(
            "the total mass with the base",
            "kg",
            rule="positive",
            note="Of what stands on the base; with `leaning_mass` at least Σ_n m*_n.",
            label="Total mass",
        ),
    ]
    half_width: HalfWidth
    zeta: Annotated[Array, replace(DAMPING_RATIOS, label="Damping ratio")]
    translational_inertia: Annotated[
        float,
        Described(
            "the sum of m_i h_i² (default: i_theta - m_tot half_width²)",
            "kg m²",
            rule="positive",
            in_file=float | None,
            note="Needed by Eqs. 19 and 29; at least Σ_n m*_n h*_n². The default is exact for lumped masses without "
            "rotary inertia.",
        ),
    ]
    floors: Annotated[
        FloorModes | None,
        Described(
            "displacements and forces of the floors",
            in_file=False,
            note="Of the same modes, for quantities of floors.",
        ),
    ] = field(repr=False)
    elements: Annotated[
        tuple[BaseElement, ...],
        Described(
            "elements that hold the structure",
            in_file=False,
            note="Between the base and the ground, at most B + |e| from the axis of the masses, or between floors or "
            "from a height to the ground, which need `floors`; see `Attachment`.",
        ),
    ]
    top_height: Annotated[
        float | None,
        Described(
            "the height of the top, for its total displacement, in m",
            "m",
            rule="positive",
            form=PLAIN,
            note="Default: the highest floor. If None, there is no total top displacement.",
        ),
    ]
    base_mass: Annotated[
        float | None,
        Described(
            "the mass of the base, a part of m_tot",
            "kg",
            rule="zero or positive",
            note="Default: `m_tot` minus the effective mass of all modes; None if modes are missing.",
            low=0.0,
            high=1e12,
        ),
    ]
    eccentricity: Annotated[
        float,
        Described(
            "the distance of the axis of the masses to the right of the middle of the base",
            "m",
            rule="finite",
            in_file=False,
            note="e, smaller than B in magnitude: the pivots are B - e to the right and B + e to the left of it.",
        ),
    ]
    leaning_mass: Annotated[
        float,
        Described(
            "the mass that stands on other columns, not in m_tot but in the modes",
            "kg",
            rule="zero or positive",
            in_file=float | None,
            note="Σ l_i, which moves with the floors on columns that are hinged; see `Leaning`. It is in L_0^r and in "
            "Σ m_i h_i², but not in M_r.",
            low=0.0,
            high=1e12,
        ),
    ]
    stories: Annotated[
        tuple[YieldingStory, ...],
        Described("stories that yield", in_file=False, note="They need the `floors`; see `YieldingStories`."),
    ]
    restitution: Annotated[
        float | None,
        Described(
            "the share of the rotation's velocity that an impact leaves, of a body without modes",
            rule="zero or positive",
            note="At most 1; of what opens to one side, that with which it turns back. Default: that of the impact law "
            "of the model.",
            low=0.0,
            high=1.0,
        ),
    ]
    opens: Annotated[
        Literal["both", "right", "left"],
        Described(
            "the side to which the base can rotate",
            in_file=False,
            note='Both, or one: "right" is about the right edge, where θ > 0, and a wall behind holds the other side. '
            "See `OneSided`.",
        ),
    ]

    joints: Annotated[
        tuple[JointAbove, ...],
        Described("joints above the base at which it rocks, too", in_file=False, note="See `Jointed`."),
    ]
    columns: Annotated[
        OnColumns | None,
        Described(
            "columns that rock under it",
            in_file=False,
            note="See `Podium`: a rotation then moves all floors alike, and `effective_height` is that of the columns.",
        ),
    ]

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
        restitution: float | None = None,
        opens: Literal["both", "right", "left"] = "both",
        joints: Iterable[JointAbove] = (),
        columns: OnColumns | None = None,
    ) -> None:
        modes = checked_modal_values(omega, effective_mass, effective_height, top_ordinate)
        scalars = {"i_theta": i_theta, "l0r": l0r, "m_tot": m_tot, "half_width": half_width}
        inertia = checked_translational_inertia(modes, scalars, leaning_mass, translational_inertia)
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
            base_mass=checked_base_mass(modes, m_tot + leaning_mass, inertia, base_mass),
            eccentricity=e,
            leaning_mass=leaning_mass,
            stories=checked_stories(stories, floors, modes["omega"].size),
            restitution=checked_restitution(restitution, opens, modes["omega"].size, columns),
            opens=opens,
            joints=checked_instances("joints", joints, JointAbove),
            columns=None if columns is None else checked_instance("columns", columns, OnColumns),
        )

    def rocking(self, n_modes: SupportsIndex | None = None) -> "RockingProperties":
        """Return these properties, or those of the first `n_modes` modes, as every structure has them."""
        return self if n_modes is None else self.truncated(n_modes)

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

    @cached_property
    def moment_heights(self) -> Array:
        """Height in m at which the elastic force of each mode acts above what it stands on: h*_n, shape (n,)."""
        if self.columns is None or self.floors is None:
            return self.effective_height
        return self.floors.heights @ self.floors.force / (self.effective_mass * self.omega**2)

    def turning_heights(self, heights: ArrayLike) -> Array:
        """Return how far a unit of θ moves points at some heights in m: as high as they are, but on columns."""
        found = np.asarray(heights, dtype=float)
        return found if self.columns is None else np.full(found.shape, self.columns.height)

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
        of_mode = self.n_modes and self.columns is None
        height = float(self.effective_height[0]) if of_mode else self.l0r / self.m_tot
        return build_both_pivots(self.elements, alike=self.symmetric, height=height, **values)

    @property
    def pivots(self) -> tuple[Pivot, ...]:
        """The distinct pivots: one for a `symmetric` structure, otherwise the right and the left one."""
        return (self.pivot(1),) if self.symmetric else (self.pivot(1), self.pivot(-1))

    @property
    def sides(self) -> tuple[int, ...]:
        """The sides to which the base can rotate: 1 is right, -1 left; both unless it `opens` to one."""
        return {"right": (1,), "left": (-1,)}.get(self.opens, (1, -1))

    @cached_property
    def weaker_pivot(self) -> Pivot:
        """The pivot with the smaller resisting moment, about which the base lifts first; the right one if equal.

        Of what opens to one side it is the only one about which it rotates.
        """
        return min(map(self.pivot, self.sides), key=lambda pivot: pivot.resisting_moment)

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
        return tendons_among(self.elements)

    @property
    def prestress(self) -> float:
        """Sum of the initial forces of the elements under the base in N, those of tendons for example."""
        return sum((each.force_at_rest for each in self.elements if not each.attached), 0.0)

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
        return sum((each.restoring_stiffness for each in self.elements if not each.attached), 0.0)

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
        return all(pivot.self_centring for pivot in map(self.pivot, self.sides))

    @property
    def recentring_ratio(self) -> float:
        """λ of weight and prestress over dissipators, the smaller of both pivots; see `Pivot.recentring_ratio`."""
        return min(pivot.recentring_ratio for pivot in map(self.pivot, self.sides))

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
        >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
        ...     damping_ratio=0.02)
        >>> held = rf.Restrained(frame,
        ...     [rf.Tendon(100e3, 5e6), rf.YieldingDissipator(2e7, 400e3)]).rocking()
        >>> round(held.recentring_ratio, 2), round(held.recentring_ratio_at(0.03), 2)
        (3.19, 3.69)
        """
        turn = checked_positive("rotation", checked_magnitude("rotation", rotation, 0.5 * math.pi, "rad"), "rad")
        found: list[float] = []
        for pivot in map(self.pivot, self.sides):
            arms = [(each, each.arm(pivot.arm, pivot.side)) for each in self.elements if not each.attached]
            moments = [(each.recentres, each.slow_force(r * turn) * r) for each, r in arms]
            locked = sum((abs(moment) for helps, moment in moments if not helps), 0.0)
            closing = pivot.weight_moment + sum((moment for helps, moment in moments if helps), 0.0)
            found.append(closing / locked if locked > 0.0 else math.inf)
        return min(found)

    @property
    def nominal_overturning_rotation(self) -> float:
        """Nominal limit 0.7 atan(B/h*_1) of the rotation in rad (Section 3.3); for a rigid block with L_0^r/m_tot.

        For an eccentric base it is the smaller of the two, with the distance of the nearer pivot in place of B.
        """
        return min(pivot.nominal_overturning_rotation for pivot in map(self.pivot, self.sides))

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
            joints=tuple(each.truncated(k) for each in self.joints),
        )
