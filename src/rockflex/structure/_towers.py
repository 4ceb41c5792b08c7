"""Towers and columns: a tapered tower, and a cantilever with a mass at its tip."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_mode_count, is_one_of
from rockflex.foundation.constants import MOST_MODES
from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.schema import DAMPING_RATIOS, BaseMass, HalfWidth, Height, Modes
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.structure._beam import Beam
from rockflex.structure._beam_sections import LumpedMasses
from rockflex.structure._cross_section import Section, checked_section, value_from_section
from rockflex.structure._from_matrices import from_matrices
from rockflex.structure._outline import Kind, Masses
from rockflex.structure._structure import AssembledStructure, ModalStructure

_TOWER_ELEMENTS = 2000  # as in the paper
_CANTILEVER_MODES = 5
MIN_TIP_RATIO = 0.1  # of the mass of the column


@described
@dataclass(frozen=True, eq=False)
class TaperedTower(AssembledStructure, Value):
    """A hollow truncated cone with a wall of constant thickness (Silva & Stojadinović 2024, Section 4.1.1).

    Raises
    ------
    InputError
        If a value is outside its range, or the wall is thicker than the smaller radius.

    Notes
    -----
    The rotary inertia of the sections is included in I_θ (Eq. 33), but not in the modes.

    Examples
    --------
    >>> import rockflex as rf
    >>> tower = rf.TaperedTower(
    ...     height=200.0, base_radius=8.0, top_radius=4.0, wall=1.0,
    ...     density=2400.0, elastic_modulus=25e9,
    ...     damping_ratio=0.02,
    ... )
    >>> tower.modal(3).period.round(2)
    array([3.79, 0.81, 0.32])
    """

    title: ClassVar[str] = "Tapered tower"

    height: Height
    base_radius: Annotated[
        float, Described("the outer radius at the base, half its width", "m", rule="positive", low=1e-2, high=500.0)
    ]
    top_radius: Annotated[
        float,
        Described("the outer radius at the top", "m", rule="positive", note="Linear in between.", low=1e-2, high=500.0),
    ]
    wall: Annotated[
        float,
        Described(
            "the thickness of the wall",
            "m",
            rule="positive",
            note="At most the smaller radius.",
            low=1e-3,
            high=100.0,
        ),
    ]
    density: Annotated[float, Described("the density of the material", "kg/m³", rule="positive", low=1.0, high=1e5)]
    elastic_modulus: Annotated[float, Described("Young's modulus of the material", "N/m²", rule="positive")]
    damping_ratio: Annotated[ArrayLike, DAMPING_RATIOS]
    method: Annotated[
        Literal["ritz", "fe"],
        Described(
            '"ritz" (shapes over the whole height) or "fe" (2000 finite elements)',
            note="The shapes are those of Eq. 36, five, or `n_modes` if more.",
        ),
    ] = "ritz"
    n_modes: Modes = 5

    def __post_init__(self) -> None:
        if not is_one_of(self.method, ("fe", "ritz")):
            raise InputError(f'method must be "fe" or "ritz", but {shown(self.method)} was given.', field="method")
        name, radius = min(("top_radius", self.top_radius), ("base_radius", self.base_radius), key=lambda r: r[1])
        if self.wall > radius:
            raise InputError(
                f"wall must be at most the smaller radius, {name} = {radius:g} m, but {self.wall:g} m was given. "
                "It is the wall thickness, not a diameter; for a solid tower it equals the radius.",
                field="wall",
            )
        vars(self)["damping_ratio"] = self.beam.damping_ratio

    @cached_property
    @explaining_overflow("The sections of a tower with these radii, wall, density and elastic_modulus")
    def beam(self) -> Beam:
        """The tower as a cantilever beam."""
        ring = (self.height, self.base_radius, self.top_radius, self.wall)
        return Beam(
            height=self.height,
            mass=_RingArea(*ring, self.density),
            bending_stiffness=_RingSecondMoment(*ring, self.elastic_modulus),
            half_width=self.base_radius,
            damping_ratio=self.damping_ratio,
            rotary_inertia=_RingSecondMoment(*ring, self.density),
            rotary_in_modes=False,
            method=self.method,
            n_modes=self.n_modes,
            n_elements=max(_TOWER_ELEMENTS, self.n_modes) if self.method == "fe" else None,
        )

    @property
    def half_width(self) -> float:
        """Half-width B of the base in m."""
        return self.base_radius

    @property
    def assembled(self) -> Beam:
        """The cantilever of `beam`."""
        return self.beam

    def half_widths(self, heights: Array) -> Array:
        return _outer_radius(self.height, self.base_radius, self.top_radius, heights)


def _outer_radius(height: float, base: float, top: float, z: Array) -> Array:
    return base + (top - base) * z / height


@dataclass(frozen=True)
class _RingSection:
    """The annular section at any height: height, radii and wall of the tower in m, and a factor."""

    height: float
    base_radius: float
    top_radius: float
    wall: float
    factor: float

    def radii(self, z: Array) -> tuple[Array, Array]:
        outer = _outer_radius(self.height, self.base_radius, self.top_radius, z)
        return outer, np.maximum(outer - self.wall, 0.0)


class _RingArea(_RingSection):
    """The factor times the area in m²."""

    def __call__(self, z: Array) -> Array:
        outer, inner = self.radii(z)
        return self.factor * (math.pi * (outer**2 - inner**2))


class _RingSecondMoment(_RingSection):
    """The factor times the second moment of the area in m⁴."""

    def __call__(self, z: Array) -> Array:
        outer, inner = self.radii(z)
        return self.factor * (math.pi * (outer**2 - inner**2)) * ((outer**2 + inner**2) / 4.0)


@described
@dataclass(frozen=True, eq=False, kw_only=True)
class CantileverWithTipMass(AssembledStructure, Value):
    """A uniform column with a mass at its tip, clamped to a base that can rock.

    Raises
    ------
    InputError
        If a value is outside its range, or the structure has fewer modes than `n_modes`.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> column.modal().period.round(3)
    array([1.814])
    >>> round(column.rocking().resisting_moment)
    588600
    """

    title: ClassVar[str] = "Cantilever with a mass at its tip"

    height: Annotated[
        float,
        Described("the height of the body at the tip above the base", "m", rule="positive", low=0.01, high=2000.0),
    ]
    tip_mass: Annotated[float, Described("the mass of the body at the tip", "kg", rule="positive")]
    bending_stiffness: Annotated[
        float | None,
        Described("EI of the column (unless a section gives it)", "N m²", rule="positive", label="Bending stiffness"),
    ] = None
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Annotated[ArrayLike, DAMPING_RATIOS]
    mass_per_length: Annotated[
        float, Described("the mass of the column per metre", "kg/m", rule="zero or positive", note="Or of its section.")
    ] = 0.0
    tip_inertia: Annotated[
        float,
        Described("the rotary inertia of the body at the tip about its own axis", "kg m²", rule="zero or positive"),
    ] = 0.0
    n_modes: Annotated[
        int | None,
        Described(
            "how many modes to take",
            rule="whole",
            within=(1, MOST_MODES),
            note="Default: 5; for a massless column all its modes: one, or two with `tip_inertia`.",
            low=1,
            high=100,
            label="Modes",
        ),
    ] = None
    section: Annotated[
        Section | None, Described("the cross-section in place of bending stiffness and mass", form="a table of {}")
    ] = None

    def __post_init__(self) -> None:
        section = checked_section(self.section)
        stiffness = value_from_section(section, "bending_stiffness", self.bending_stiffness)
        mass = value_from_section(section, "mass_per_length", self.mass_per_length, absent=0.0)
        vars(self).update(bending_stiffness=stiffness, mass_per_length=mass)
        vars(self)["damping_ratio"] = self.built.damping_ratio

    @cached_property
    def built(self) -> Beam | ModalStructure:
        """The column as a beam; for a massless column, the tip mass with two degrees of freedom."""
        if self.mass_per_length > 0.0:
            return Beam(
                height=self.height,
                mass=self.mass_per_length,
                bending_stiffness=self.bending_stiffness,
                lumped_masses=LumpedMasses([self.height], [self.tip_mass], [self.tip_inertia]),
                base_mass=self.base_mass,
                half_width=self.half_width,
                damping_ratio=self.damping_ratio,
                n_modes=_CANTILEVER_MODES if self.n_modes is None else self.n_modes,
            )
        modes = 1 if self.tip_inertia == 0.0 else 2
        h, stiffness = self.height, self.bending_stiffness or 0.0
        with explaining_overflow(f"The stiffness of a column with height = {h:g} m and EI = {stiffness:g} N m²"):
            k = stiffness / h**3
            matrix = [[12.0 * k, -6.0 * k * h], [-6.0 * k * h, 4.0 * k * h**2]]
        return from_matrices(
            [self.tip_mass, self.tip_inertia],
            matrix,
            {0: h},
            rotations=[1],
            base_mass=self.base_mass,
            half_width=self.half_width,
            damping_ratio=self.damping_ratio,
            n_modes=checked_mode_count(self.n_modes, modes),
        )

    @property
    def assembled(self) -> Beam | ModalStructure:
        """The beam, or the body with two degrees of freedom: `built`."""
        return self.built

    def outline_kind(self) -> Kind:
        return "mast"

    def concentrated_masses(self) -> Masses:
        return ((self.height, self.tip_mass),)

    def unit_warnings(self) -> tuple[str, ...]:
        """Return a text about a tip of less than a tenth of the mass of its column."""
        column = self.mass_per_length * self.height
        if self.tip_mass >= MIN_TIP_RATIO * column:
            return ()
        return (
            translated(
                "The tip has a mass of {tip:g} kg, less than a tenth of the {column:g} kg of its column. Masses are "
                "in kg: a tonne is 1000 kg.",
                tip=self.tip_mass,
                column=column,
            ),
        )
