"""Frames with lumped masses: given by matrices, story by story, or regular."""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Annotated, ClassVar, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    check_all_positive,
    checked_damping_ratios,
    checked_finite_vector,
    checked_mode_count,
    checked_positive,
    float_array,
    number_of_dimensions,
)
from rockflex.foundation.descriptions import PLAIN, Described, described, one_for_each
from rockflex.foundation.errors import InputError
from rockflex.foundation.matrices import checked_heights, checked_mass, checked_stiffness
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.schema import DAMPING_RATIOS, BaseMass, FrameSchema, HalfWidth
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value, with_changed_fields
from rockflex.structure._analysis import ModalProperties, modal_properties
from rockflex.structure._outline import DrawnStructure, Kind, Masses
from rockflex.structure._participation import rocking_properties
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import AssembledStructure

MIN_SAFE, MAX_SAFE = 1e-20, 1e20  # of numbers in SI units whose products certainly do not overflow
MAX_ASPECT_RATIO = 1e4  # h*_1/B from which the base hardly adds to the inertia, which must be checked


@described
@dataclass(frozen=True, eq=False, init=False)
class LumpedStructure(DrawnStructure, Value):
    """Any linear structure with N masses above a rigid base that can rock.

    Its degrees of freedom are the horizontal displacements of the masses relative to the base (Silva & Stojadinović
    2024, Fig. 1 and Eq. 1); all others must be condensed out. Sequences become read-only arrays. The modes are
    computed once, when they are first needed.

    Raises
    ------
    InputError
        If the shapes do not match, a value is not finite or outside its range, the heights do not increase, or a
        matrix is not symmetric positive definite.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.LumpedStructure(
    ...     masses=[20e3, 20e3], stiffness=[[8e6, -4e6], [-4e6, 4e6]],
    ...     heights=[3.0, 6.0],
    ...     base_mass=20e3, half_width=0.6, damping_ratio=0.02,
    ... )
    >>> structure.modal().period.round(3)
    array([0.719, 0.275])
    >>> structure.rocking(1).effective_height.round(3)
    array([4.854])
    """

    title: ClassVar[str] = "Lumped masses"

    masses: Annotated[
        Array,
        Described(
            "a list of masses in kg, from the lowest up, or the mass matrix",
            "kg",
            form=PLAIN,
            in_file=list[float] | list[list[float]],
            note="Without the base; the matrix symmetric and positive definite.",
        ),
    ]
    stiffness: Annotated[
        Array,
        Described(
            "the stiffness matrix in N/m, a list of rows",
            "N/m",
            form=PLAIN,
            in_file=list[list[float]],
            note="On a fixed base; symmetric and positive definite.",
        ),
    ]
    heights: Annotated[
        Array,
        Described(
            "a list of the heights of the masses above the base in m, from the lowest up",
            "m",
            form=PLAIN,
            in_file=list[float],
            note="Positive and strictly increasing.",
        ),
    ]
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Annotated[Array, DAMPING_RATIOS]

    def __init__(
        self,
        masses: ArrayLike,
        stiffness: ArrayLike,
        heights: ArrayLike,
        *,
        base_mass: float,
        half_width: float,
        damping_ratio: ArrayLike,
    ) -> None:
        h = checked_heights(heights)
        vars(self).update(
            masses=checked_mass(masses, h.size, field="masses"),
            stiffness=checked_stiffness(stiffness, h.size),
            heights=h,
            base_mass=base_mass,
            half_width=half_width,
            damping_ratio=checked_damping_ratios("damping_ratio", damping_ratio, h.size),
        )

    def outline_kind(self) -> Kind:
        return "frame"

    def concentrated_masses(self) -> Masses:
        by_floor = self.masses if self.masses.ndim == 1 else self.masses.sum(axis=1)
        return tuple(zip(self.heights.tolist(), by_floor.tolist(), strict=True))

    @property
    def height(self) -> float:
        """Height of the top mass above the base in m."""
        return float(self.heights[-1])

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base (default: all N).

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to N.
        """
        return self._modes if n_modes is None else self._modes.truncated(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes (default: all).

        Modes that contribute neither to the base shear nor to the base moment are left out and not counted.

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`, or one of them contributes only to the base moment.
        """
        return self._rocking if n_modes is None else self._with_modes(n_modes)

    @cached_property
    def _modes(self) -> ModalProperties:
        return modal_properties(self.masses, self.stiffness, self.heights)

    @cached_property
    def _rocking(self) -> RockingProperties:
        return self._with_modes(None)

    def _with_modes(self, n_modes: SupportsIndex | None) -> RockingProperties:
        return rocking_properties(
            self._modes,
            self.masses,
            self.heights,
            self.base_mass,
            self.half_width,
            self.damping_ratio,
            n_modes,
        )


@described
@dataclass(frozen=True, eq=False, init=False)
class FishBone(AssembledStructure, Value):
    """A fish-bone frame: one column with half beams at each floor, clamped to a base that can rock.

    The column represents all columns of a story and the half beams all beams of a floor. Members are
    inextensible, masses are lumped at the floors, and the rotations of the floors are condensed out.

    Raises
    ------
    InputError
        If the lengths differ, or a value is outside its range.

    Notes
    -----
    A number in place of an array applies to all stories. With equal stories, EI_i = 2 EI_c and
    beam_stiffness = 12 ρ EI_i/L_i it is the same as `Frame`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.FishBone(
    ...     story_heights=[4.0, 3.0], masses=[50e3, 40e3],
    ...     column_stiffness=[2e8, 1.5e8], beam_stiffness=5e8,
    ...     base_mass=50e3, half_width=1.5, damping_ratio=0.02,
    ... )
    >>> frame.height
    7.0
    >>> frame.modal().period.round(3)
    array([0.398, 0.122])
    """

    title: ClassVar[str] = "Frame of unequal stories"

    story_heights: Annotated[
        Array,
        Described(
            "a list of the heights of the stories in m, from the base up",
            "m",
            form=PLAIN,
            in_file=list[float],
            low=0.1,
            high=100.0,
        ),
    ]
    masses: Annotated[
        Array,
        Described("the mass of each floor in kg", "kg", form=one_for_each("story"), in_file=float | list[float]),
    ]
    column_stiffness: Annotated[
        Array,
        Described(
            "EI of all columns of a story together in N m²",
            "N m²",
            form=one_for_each("story"),
            in_file=float | list[float],
        ),
    ]
    beam_stiffness: Annotated[
        Array,
        Described(
            "the rotational stiffness of the beams of a floor in N m/rad (0: no beams, inf: rigid ones)",
            "N m/rad",
            form=one_for_each("story"),
            in_file=float | list[float],
            high=math.inf,
            note="12 EI_b/L_b for a bay in antisymmetric bending; half beams on rollers give the same.",
        ),
    ]
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Annotated[ArrayLike, DAMPING_RATIOS]

    def __init__(
        self,
        story_heights: ArrayLike,
        masses: ArrayLike,
        column_stiffness: ArrayLike,
        beam_stiffness: ArrayLike,
        *,
        base_mass: float,
        half_width: float,
        damping_ratio: ArrayLike,
    ) -> None:
        lengths = checked_finite_vector("story_heights", story_heights, "m")
        n = lengths.size
        check_all_positive("story_heights", lengths, "m")
        if n == 0:
            raise InputError(
                "story_heights must contain at least one height in m, but none was given.", field="story_heights"
            )
        vars(self).update(
            story_heights=lengths,
            masses=_one_value_per_story("masses", masses, n, "kg"),
            column_stiffness=_one_value_per_story("column_stiffness", column_stiffness, n, "N m²"),
            beam_stiffness=_checked_beam_stiffnesses(beam_stiffness, n),
            base_mass=base_mass,
            half_width=half_width,
            damping_ratio=damping_ratio,
        )
        vars(self).update(damping_ratio=self.lumped.damping_ratio)

    def outline_kind(self) -> Kind:
        return "frame"

    def concentrated_masses(self) -> Masses:
        return self.lumped.concentrated_masses()

    @property
    def height(self) -> float:
        """Height of the top floor above the base in m."""
        return float(self.story_heights.sum())

    @cached_property
    def lumped(self) -> LumpedStructure:
        """The assembled structure: floor masses, condensed stiffness, floor heights."""
        return LumpedStructure(
            self.masses,
            condensed_lateral_stiffness(self.story_heights, self.column_stiffness, self.beam_stiffness),
            np.cumsum(self.story_heights),
            base_mass=self.base_mass,
            half_width=self.half_width,
            damping_ratio=self.damping_ratio,
        )

    @property
    def assembled(self) -> LumpedStructure:
        """The lumped masses: `lumped`."""
        return self.lumped


@explaining_overflow("The stiffness of a frame with these story heights, column and beam stiffnesses")
def condensed_lateral_stiffness(story_heights: Array, column_stiffness: Array, beam_stiffness: Array) -> Array:
    """Return the condensed lateral stiffness of the floors in N/m, shape (N, N); arguments as in `FishBone`."""
    n = story_heights.size
    sway, coupling, bending = (np.zeros((n + 1, n + 1)) for _ in range(3))
    for i, (length, stiffness) in enumerate(zip(story_heights, column_stiffness, strict=True)):
        ends = np.ix_([i, i + 1], [i, i + 1])
        sway[ends] += 12.0 * stiffness / length**3 * np.array([[1.0, -1.0], [-1.0, 1.0]])
        coupling[ends] += 6.0 * stiffness / length**2 * np.array([[1.0, 1.0], [-1.0, -1.0]])
        bending[ends] += 2.0 * stiffness / length * np.array([[2.0, 1.0], [1.0, 2.0]])
    turning = np.flatnonzero(np.isfinite(beam_stiffness)) + 1  # rigid beams prevent the floor from rotating
    rotational = bending[np.ix_(turning, turning)] + np.diag(beam_stiffness[turning - 1])
    tied = coupling[1:, turning]
    stiffness = sway[1:, 1:] - tied @ np.linalg.solve(rotational, tied.T)
    return 0.5 * (stiffness + stiffness.T)


def _one_value_per_story(name: str, values: ArrayLike, n: int, unit: str) -> Array:
    if number_of_dimensions(values) == 0:
        filled = np.full(n, checked_positive(name, values, unit))  # pyright: ignore[reportArgumentType]
        filled.setflags(write=False)
        return filled
    array = checked_finite_vector(name, values, unit)
    if array.size != n:
        raise InputError(
            f"{name} must be one number, or one for each of the {n} stories, but {array.size} were given.", field=name
        )
    check_all_positive(name, array, unit)
    return array


def _checked_beam_stiffnesses(values: ArrayLike, n: int) -> Array:
    given = float_array(values)
    array = np.full(n, np.nan) if given is None else given
    if array.ndim == 0:
        array = np.full(n, float(array))
    if array.shape != (n,) or not (array >= 0.0).all():
        raise InputError(
            f"beam_stiffness must be one number, or one for each of the {n} stories, from 0 (no beams) to float('inf') "
            f"(rigid beams) in N m/rad, but {shown(values)} was given.",
            field="beam_stiffness",
        )
    array.setflags(write=False)
    return array


@described
@dataclass(frozen=True)
class Frame(FrameSchema, AssembledStructure):
    """A frame of one bay and N equal stories, with columns clamped to a base that can rock.

    Columns and beams are inextensible, of uniform stiffness, and the same in all stories; the masses are
    lumped at the floors. The stiffness is scaled to give the specified period, and the base width follows from the
    aspect ratio (Silva & Stojadinović 2024, Section 3.2 and Table 1).

    Raises
    ------
    InputError
        If a value is outside its range.

    Notes
    -----
    Sway is antisymmetric, so the two joints of a floor rotate by the same angle φ and a beam of stiffness
    EI_b/L_b bends in double curvature with end moments 6 (EI_b/L_b) φ. It adds the rotational stiffness
    12 EI_b/L_b = 12 ρ (2 EI_c/L_c). The two columns contribute 2 EI_c/L_c times the usual terms of a clamped bar. In
    units of 2 EI_c/L_c³, with φ L_c for the rotations, the beam enters only through ρ: neither the width of
    the bay nor EI_b matters by itself.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> round(frame.half_width, 3)
    1.318
    >>> frame.modal(3).period.round(3)
    array([1.   , 0.343, 0.217])
    """

    title: ClassVar[str] = "Frame of equal stories"

    def __post_init__(self) -> None:
        """No value says anything of another one."""

    def outline_kind(self) -> Kind:
        return "frame"

    def concentrated_masses(self) -> Masses:
        return self.lumped.concentrated_masses()

    @property
    def height(self) -> float:
        """Height N L_c of the top floor above the base in m."""
        return self.n_stories * self.story_height

    @property
    def half_width(self) -> float:
        """Half-width B = h*_1/aspect_ratio of the base in m."""
        _, unit_modes = _unit_frame(self.n_stories, self.stiffness_ratio)
        return float(unit_modes.effective_height[0]) * self.story_height / self.aspect_ratio

    @cached_property
    def lumped(self) -> LumpedStructure:
        """The assembled structure: floor masses, condensed stiffness, floor heights."""
        unit_stiffness, unit_modes = _unit_frame(self.n_stories, self.stiffness_ratio)
        given = f"story_mass = {self.story_mass:g} kg and period = {self.period:g} s"
        with explaining_overflow(f"The stiffness of a frame with {given}"):
            column_stiffness = self.story_mass * (2.0 * math.pi / (self.period * float(unit_modes.omega[0]))) ** 2
            stiffness = column_stiffness * unit_stiffness
        with explaining_overflow(f"The heights of {self.n_stories} stories of {self.story_height:g} m"):
            heights = self.story_height * np.arange(1.0, self.n_stories + 1.0)
        return LumpedStructure(
            np.full(self.n_stories, self.story_mass),
            stiffness,
            heights,
            base_mass=self.base_mass,
            half_width=self.half_width,
            damping_ratio=self.damping_ratio,
        )

    @property
    def assembled(self) -> LumpedStructure:
        """The lumped masses: `lumped`."""
        return self.lumped

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes, or with all.

        They are scaled from a frame with unit masses and stories.

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the number that the structure has.
        """
        whole = self._rocking
        return whole if n_modes is None else whole.truncated(checked_mode_count(n_modes, whole.n_modes))

    @cached_property
    def _rocking(self) -> RockingProperties:
        half_width = self.half_width
        given = (self.story_height, self.story_mass, self.period, half_width)
        if not (
            min(given) > MIN_SAFE and max(given) < MAX_SAFE > self.base_mass and self.aspect_ratio < MAX_ASPECT_RATIO
        ):
            return self.lumped.rocking()  # raises an error about the overflow
        _, unit_modes = _unit_frame(self.n_stories, self.stiffness_ratio)
        unit, m, length = _unit_frame_rocking(self.n_stories, self.stiffness_ratio), self.story_mass, self.story_height
        rate = 2.0 * math.pi / (self.period * float(unit_modes.omega[0]))
        mass, height = m * unit.effective_mass, length * unit.effective_height
        n, m_tot = self.n_stories, self.n_stories * m + self.base_mass
        inertia = m * length**2 * (n * (n + 1) * (2 * n + 1) // 6)
        floors = unit.floors
        assert floors is not None
        heights = length * floors.heights
        return with_changed_fields(
            unit,
            omega=rate * unit.omega,
            effective_mass=mass,
            effective_height=height,
            i_theta=inertia + m_tot * half_width**2,
            l0r=m * length * unit.l0r,
            m_tot=m_tot,
            half_width=half_width,
            zeta=np.full(unit.n_modes, self.damping_ratio),
            translational_inertia=max(inertia, float(mass @ height**2)),
            floors=with_changed_fields(floors, heights=heights, force=(m * rate**2) * floors.force),
            top_height=float(heights[-1]),
            base_mass=self.base_mass,
        )


@lru_cache(maxsize=128)
@explaining_overflow("The modes of the frame with this stiffness_ratio", field="stiffness_ratio")
def _unit_frame(n_stories: int, stiffness_ratio: float) -> tuple[Array, ModalProperties]:
    """Return the condensed stiffness in units of 2 EI_c/L_c³, and the modes for unit masses and stories."""
    one = np.ones(n_stories)
    stiffness = condensed_lateral_stiffness(one, one, 12.0 * stiffness_ratio * one)
    stiffness.setflags(write=False)
    return stiffness, modal_properties(one, stiffness, np.cumsum(one))


@lru_cache(maxsize=128)
def _unit_frame_rocking(n_stories: int, stiffness_ratio: float) -> RockingProperties:
    """Return the parameters for unit masses and stories, on a base of unit half-width without mass."""
    _, modes = _unit_frame(n_stories, stiffness_ratio)
    return rocking_properties(modes, np.ones(n_stories), modes.heights, 0.0, 1.0, 0.0)
