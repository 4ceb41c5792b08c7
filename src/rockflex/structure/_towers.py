"""Towers, columns and blocks: a tapered tower, a cantilever with a mass at its tip, a rigid block."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_magnitude, checked_mode_count, checked_positive, is_one_of
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.structure._beam import Beam
from rockflex.structure._beam_sections import LumpedMasses
from rockflex.structure._cross_section import Section, checked_section, value_from_section
from rockflex.structure._from_matrices import from_matrices
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import AssembledStructure, ModalStructure

_TOWER_ELEMENTS = 2000  # as in the paper
_CANTILEVER_MODES = 5
MIN_TIP_RATIO = 0.1  # of the mass of the column


@dataclass(frozen=True, eq=False)
class TaperedTower(AssembledStructure, Value):
    """A hollow truncated cone with a wall of constant thickness (Silva & Stojadinović 2024, Section 4.1.1).

    Attributes
    ----------
    height : float
        Height in m.
    base_radius, top_radius : float
        Outer radius at the base and at the top in m, linear in between. The half-width B is `base_radius`.
    wall : float
        Thickness of the wall in m, at most the smaller radius.
    density : float
        Density in kg/m³.
    elastic_modulus : float
        Young's modulus in N/m².
    damping_ratio : float or ndarray, shape (n_modes,)
        Damping ratio in [0, 1): one number for all modes, or one per mode.
    method : {"ritz", "fe"}
        Rayleigh-Ritz with the shapes of Eq. 36 (five, or `n_modes` if more), or 2000 finite elements.
    n_modes : int
        Number of modes, at most 200.

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
    ...     height=200.0, base_radius=8.0, top_radius=4.0, wall=1.0, density=2400.0, elastic_modulus=25e9,
    ...     damping_ratio=0.02,
    ... )
    >>> tower.modal(3).period.round(2)
    array([3.79, 0.81, 0.32])
    """

    height: float
    base_radius: float
    top_radius: float
    wall: float
    density: float
    elastic_modulus: float
    damping_ratio: ArrayLike
    method: Literal["ritz", "fe"] = "ritz"
    n_modes: int = 5

    def __post_init__(self) -> None:
        if not is_one_of(self.method, ("fe", "ritz")):
            raise InputError(f'method must be "fe" or "ritz", but {shown(self.method)} was given.', field="method")
        vars(self).update(
            height=checked_positive("height", self.height, "m"),
            base_radius=checked_positive("base_radius", self.base_radius, "m"),
            top_radius=checked_positive("top_radius", self.top_radius, "m"),
            wall=checked_positive("wall", self.wall, "m"),
            density=checked_positive("density", self.density, "kg/m³"),
            elastic_modulus=checked_positive("elastic_modulus", self.elastic_modulus, "N/m²"),
        )
        name, radius = min(("top_radius", self.top_radius), ("base_radius", self.base_radius), key=lambda r: r[1])
        if self.wall > radius:
            raise InputError(
                f"wall must be at most the smaller radius, {name} = {radius:g} m, but {self.wall:g} m was given. "
                "It is the wall thickness, not a diameter; for a solid tower it equals the radius.",
                field="wall",
            )
        vars(self).update(n_modes=self.beam.n_modes, damping_ratio=self.beam.damping_ratio)

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


@dataclass(frozen=True)
class _RingSection:
    """The annular section at any height: height, radii and wall of the tower in m, and a factor."""

    height: float
    base_radius: float
    top_radius: float
    wall: float
    factor: float

    def radii(self, z: Array) -> tuple[Array, Array]:
        outer = self.base_radius + (self.top_radius - self.base_radius) * z / self.height
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


@dataclass(frozen=True, eq=False, kw_only=True)
class CantileverWithTipMass(AssembledStructure, Value):
    """A uniform column with a mass at its tip, clamped to a base that can rock.

    Attributes
    ----------
    height : float
        Height H of the tip in m.
    tip_mass : float
        Mass at the tip in kg.
    bending_stiffness : float
        EI of the column in N m². With a section, its stiffness.
    base_mass : float
        Mass m_0 of the base in kg, zero or positive.
    half_width : float
        Half-width B of the base in m.
    damping_ratio : float or ndarray, shape (n_modes,)
        Damping ratio in [0, 1): one number for all modes, or one per mode.
    mass_per_length : float
        Mass of the column in kg/m, zero or positive. With a section, its mass.
    tip_inertia : float
        Rotary inertia of the tip mass about its own axis in kg m², zero or positive.
    n_modes : int, optional
        Number of modes. Default: 5; for a massless column all its modes: one, or two with `tip_inertia`.
    section : Section, optional
        Section of the column, in place of `bending_stiffness` and `mass_per_length`.

    Raises
    ------
    InputError
        If a value is outside its range, or the structure has fewer modes than `n_modes`.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0, damping_ratio=0.02
    ... )
    >>> column.modal().period.round(3)
    array([1.814])
    >>> round(column.rocking().resisting_moment)
    588600
    """

    height: float
    tip_mass: float
    bending_stiffness: float | None = None
    base_mass: float
    half_width: float
    damping_ratio: ArrayLike
    mass_per_length: float = 0.0
    tip_inertia: float = 0.0
    n_modes: int | None = None
    section: Section | None = None

    def __post_init__(self) -> None:
        section = checked_section(self.section)
        stiffness = value_from_section(section, "bending_stiffness", self.bending_stiffness)
        mass = value_from_section(section, "mass_per_length", self.mass_per_length, absent=0.0)
        vars(self).update(
            height=checked_positive("height", self.height, "m"),
            tip_mass=checked_positive("tip_mass", self.tip_mass, "kg"),
            bending_stiffness=checked_positive("bending_stiffness", stiffness, "N m²"),
            mass_per_length=checked_positive("mass_per_length", mass, "kg/m", zero=True),
            tip_inertia=checked_positive("tip_inertia", self.tip_inertia, "kg m²", zero=True),
        )
        built = self.built
        vars(self).update(base_mass=built.base_mass, half_width=built.half_width, damping_ratio=built.damping_ratio)

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


@explaining_overflow("The inertia of a block with this half_diagonal and mass")
def rigid_block(slenderness: float, half_diagonal: float, mass: float = 1.0) -> RockingProperties:
    """Return the properties of a homogeneous rectangular block, for the models "rigid" and "rigid-C".

    I_θ = 4/3 m R², B = R sin α, L_0^r = m R cos α; the frequency parameter is p² = 3 g/(4 R). Housner's coefficient
    1 - 2 m B²/I_θ is 1 - 1.5 sin² α (Housner 1963, Bull. Seism. Soc. Am. 53(2), 403-417).

    Parameters
    ----------
    slenderness
        α = atan(b/h) in rad, above 0 and below π/2.
    half_diagonal
        R in m, positive.
    mass
        m in kg, positive; the rotations do not depend on it.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> round(block.half_width, 3), round(block.resisting_moment, 3)
    (0.742, 7.281)
    """
    alpha = checked_magnitude("slenderness", slenderness, 0.5 * math.pi, "rad")
    if alpha <= 0.0:
        raise InputError(
            f"slenderness must be positive, but {shown(slenderness)} was given. It is atan(b/h) in rad.",
            field="slenderness",
        )
    r, m = checked_positive("half_diagonal", half_diagonal, "m"), checked_positive("mass", mass, "kg")
    return RockingProperties(
        omega=(),
        effective_mass=(),
        effective_height=(),
        top_ordinate=(),
        i_theta=4.0 / 3.0 * m * r**2,
        l0r=m * r * math.cos(alpha),
        m_tot=m,
        half_width=r * math.sin(alpha),
        zeta=(),
        top_height=2.0 * r * math.cos(alpha),
        base_mass=0.0,
    )
