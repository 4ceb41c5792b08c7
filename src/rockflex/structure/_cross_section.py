"""Cross-sections of columns, piers and walls, and their stiffness and mass."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Self

from rockflex.foundation.checks import checked_finite, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value


@dataclass(frozen=True, eq=False)
class Section(Value):
    """A cross-section and its material, for the bending stiffness and the mass of a column.

    `rectangle`, `box`, `circle`, `tube` and `composite` compute the area and the second moment; the numbers of a rolled
    or any other section can be given as they are. Depths are measured in the plane of rocking, widths perpendicular
    to it.

    Attributes
    ----------
    area : float
        Area A in m², of a composite section transformed to its first part.
    second_moment : float
        Second moment of area I in m⁴ of the uncracked section about the bending axis through its centroid, of a
        composite section transformed too.
    elastic_modulus : float
        Young's modulus E in N/m²; of a composite section, the modulus of its first part.
    density : float
        Density in kg/m³, of a composite section its mass per length over `area`.
    stiffness_factor : float
        Effective over uncracked bending stiffness, above 0 and at most 1. Default: 1.
    rotary_inertia : float, optional
        Mass moment of inertia per length about the bending axis in kg m, for `Beam.rotary_inertia`. Default: density
        times second moment.

    Raises
    ------
    InputError
        If a value is not positive and finite, or the factor is not above 0 and at most 1.

    Examples
    --------
    >>> import rockflex as rf
    >>> pier = rf.Section.box(width=4.0, depth=2.5, wall=0.35,
    ...     elastic_modulus=33e9, density=2500, stiffness_factor=0.5)
    >>> stiffness, mass = pier.bending_stiffness, pier.mass_per_length
    >>> print(f"{stiffness:.4g} N m², {mass:.5g} kg/m")
    5.947e+10 N m², 10150 kg/m
    >>> column = rf.CantileverWithTipMass(
    ...     height=15.0, tip_mass=600e3, section=pier, base_mass=250e3,
    ...     half_width=2.0, damping_ratio=0.03
    ... )
    >>> print(f"{column.modal().period[0]:.3f} s")
    0.689 s
    """

    area: float
    second_moment: float
    elastic_modulus: float
    density: float
    stiffness_factor: float = 1.0
    rotary_inertia: float | None = None

    def __post_init__(self) -> None:
        values = {
            "area": checked_positive("area", self.area, "m²"),
            "second_moment": checked_positive("second_moment", self.second_moment, "m⁴"),
            "elastic_modulus": checked_positive("elastic_modulus", self.elastic_modulus, "N/m²"),
            "density": checked_positive("density", self.density, "kg/m³"),
            "stiffness_factor": _checked_stiffness_factor(self.stiffness_factor),
        }
        vars(self).update(values)
        given = self.density * self.second_moment if self.rotary_inertia is None else self.rotary_inertia
        vars(self).update(rotary_inertia=checked_positive("rotary_inertia", given, "kg m"))
        for name, value in (("bending_stiffness", self.bending_stiffness), ("mass_per_length", self.mass_per_length)):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"The {name} of the section must be positive and finite, but it is {value:g}.")

    @property
    def bending_stiffness(self) -> float:
        """Effective EI in N m²: `stiffness_factor` times E times I."""
        return self.stiffness_factor * (self.elastic_modulus * self.second_moment)

    @property
    def mass_per_length(self) -> float:
        """Mass per unit length in kg/m."""
        return self.density * self.area

    @classmethod
    @explaining_overflow("The second moment of the section")
    def rectangle(
        cls, width: float, depth: float, *, elastic_modulus: float, density: float, stiffness_factor: float = 1.0
    ) -> Self:
        """Return a solid rectangle: width and depth in m.

        Examples
        --------
        >>> import rockflex as rf
        >>> wall = rf.Section.rectangle(width=0.3, depth=4.0, elastic_modulus=30e9,
        ...     density=2500)
        >>> round(wall.area, 6), round(wall.second_moment, 6)
        (1.2, 1.6)
        """
        b, d = checked_positive("width", width, "m"), checked_positive("depth", depth, "m")
        return cls(b * d, b * d**3 / 12.0, elastic_modulus, density, stiffness_factor)

    @classmethod
    @explaining_overflow("The second moment of the section")
    def box(
        cls,
        width: float,
        depth: float,
        wall: float,
        *,
        elastic_modulus: float,
        density: float,
        stiffness_factor: float = 1.0,
    ) -> Self:
        """Return a hollow rectangle: outer width and depth, and the thickness of all four walls, in m.

        Raises
        ------
        InputError
            If the walls leave no hollow.

        Examples
        --------
        >>> import rockflex as rf
        >>> box = rf.Section.box(width=4.0, depth=2.0, wall=0.5, elastic_modulus=30e9,
        ...     density=2500)
        >>> round(box.area, 6), round(box.second_moment, 6)
        (5.0, 2.416667)
        """
        b, d, t = (
            checked_positive("width", width, "m"),
            checked_positive("depth", depth, "m"),
            checked_positive("wall", wall, "m"),
        )
        _check_hollow_section(t, min(b, d), "a rectangle")
        inner_b, inner_d = b - 2.0 * t, d - 2.0 * t
        area = 2.0 * t * (b + inner_d)
        return cls(area, (b * d**3 - inner_b * inner_d**3) / 12.0, elastic_modulus, density, stiffness_factor)

    @classmethod
    @explaining_overflow("The second moment of the section")
    def circle(cls, diameter: float, *, elastic_modulus: float, density: float, stiffness_factor: float = 1.0) -> Self:
        """Return a solid circle: diameter in m.

        Examples
        --------
        >>> import rockflex as rf
        >>> column = rf.Section.circle(diameter=2.0, elastic_modulus=30e9,
        ...     density=2500)
        >>> round(column.area, 6), round(column.second_moment, 6)
        (3.141593, 0.785398)
        """
        d = checked_positive("diameter", diameter, "m")
        return cls(math.pi * d**2 / 4.0, math.pi * d**4 / 64.0, elastic_modulus, density, stiffness_factor)

    @classmethod
    @explaining_overflow("The second moment of the section")
    def tube(
        cls, diameter: float, wall: float, *, elastic_modulus: float, density: float, stiffness_factor: float = 1.0
    ) -> Self:
        """Return a hollow circle: outer diameter and thickness of the wall in m.

        Raises
        ------
        InputError
            If the wall leaves no hollow.

        Examples
        --------
        >>> import rockflex as rf
        >>> tube = rf.Section.tube(diameter=2.0, wall=0.02, elastic_modulus=210e9,
        ...     density=7850)
        >>> round(tube.area, 6), round(tube.second_moment, 6)
        (0.124407, 0.060972)
        """
        d, t = checked_positive("diameter", diameter, "m"), checked_positive("wall", wall, "m")
        _check_hollow_section(t, d, "a circle")
        inner, area = d - 2.0 * t, math.pi * t * (d - t)
        return cls(area, area * (d**2 + inner**2) / 16.0, elastic_modulus, density, stiffness_factor)

    @classmethod
    @explaining_overflow("The second moment of the section")
    def composite(cls, parts: Iterable[tuple["Section", float]], *, stiffness_factor: float = 1.0) -> Self:
        """Return several sections that bend as one: plane sections stay plane, and none slips on another.

        Each part counts with its modular ratio E_i/E_1, times its own `stiffness_factor`, about the common neutral
        axis (parallel-axis theorem).

        Parameters
        ----------
        parts : iterable of (Section, float)
            The sections, and the distance of each one's centroid from any common axis, in m along the depth.
        stiffness_factor
            For the whole, besides the factors of the parts.

        Raises
        ------
        InputError
            If there are no parts, or one is not a section and an offset.

        Examples
        --------
        >>> import rockflex as rf
        >>> steel, concrete = {"elastic_modulus": 210e9,
        ...     "density": 7850}, {"elastic_modulus": 30e9, "density": 2500}
        >>> tube, core = rf.Section.tube(1.0, 0.02,
        ...     **steel), rf.Section.circle(0.96, **concrete)
        >>> filled = rf.Section.composite([(tube, 0.0), (core, 0.0)])
        >>> stiffness, mass = filled.bending_stiffness, filled.mass_per_length
        >>> print(f"{stiffness:.4g} N m², {mass:.4g} kg/m")
        2.804e+09 N m², 2293 kg/m
        """
        found = _checked_composite_parts(parts)
        first = found[0][0].elastic_modulus
        ratios = [each.stiffness_factor * each.elastic_modulus / first for each, _ in found]
        areas = [ratio * each.area for ratio, (each, _) in zip(ratios, found, strict=True)]
        area = math.fsum(areas)
        axis = math.fsum(part * offset for part, (_, offset) in zip(areas, found, strict=True)) / area
        second = math.fsum(
            ratio * each.second_moment + part * (offset - axis) ** 2
            for ratio, part, (each, offset) in zip(ratios, areas, found, strict=True)
        )
        mass = math.fsum(each.mass_per_length for each, _ in found)
        rotary = math.fsum((each.rotary_inertia or 0.0) + each.mass_per_length * (y - axis) ** 2 for each, y in found)
        return cls(area, second, first, mass / area, stiffness_factor, rotary)


def value_from_section(section: Section | None, name: str, given: Any, absent: float | None = None) -> Any:
    """Return the `given` quantity, or the value of the section where it is None or `absent`.

    Raises
    ------
    InputError
        If neither is given, or they differ.
    """
    if section is None:
        if given is None:
            raise InputError(f"{name} is missing: give it, or a section.", field=name)
        return given
    attribute = "bending_stiffness" if name == "bending_stiffness" else "mass_per_length"
    value: float = getattr(section, attribute)
    if given is None or (isinstance(given, float | int) and given in (absent, value)):
        return value
    raise InputError(
        f"{name} is {value:g} by the section, but {shown(given)} was given too. Leave one of them out; for "
        f"more mass or another stiffness give numbers without a section, such as section.{attribute}.",
        field=name,
    )


def checked_section(given: Any) -> Section | None:
    """Return a section or None.

    Raises
    ------
    InputError
        If it is neither.
    """
    if given is not None and not isinstance(given, Section):
        raise InputError(
            f"section must be a Section, such as Section.circle(...), but {shown(given)} was given.", field="section"
        )
    return given


def _checked_stiffness_factor(given: float) -> float:
    factor = checked_positive("stiffness_factor", given, "fractions of the uncracked stiffness")
    if factor > 1.0:
        raise InputError(
            f"stiffness_factor must be at most 1, but {factor:g} was given. Half the uncracked stiffness is 0.5.",
            field="stiffness_factor",
        )
    return factor


def _check_hollow_section(wall: float, least: float, what: str) -> None:
    if not 2.0 * wall < least:
        raise InputError(
            f"wall must be less than half of {least:g} m, but {wall:g} m was given. Without a hollow it is {what}.",
            field="wall",
        )


def _checked_composite_parts(given: Any) -> list[tuple[Section, float]]:
    try:
        pairs = [(section, offset) for section, offset in given]
    except (TypeError, ValueError) as error:
        raise InputError(
            f"parts must be a list of sections and offsets, [(section, offset), ...], but {shown(given)} was given.",
            field="parts",
        ) from error
    if not pairs:
        raise InputError("parts must hold one section at least, but it is empty.", field="parts")
    for section, _ in pairs:
        if not isinstance(section, Section):
            raise InputError(
                f"parts must be a list of sections and offsets, but {shown(section)} stands in place of a section.",
                field="parts",
            )
    return [(section, checked_finite("parts: the offset", offset, "m")) for section, offset in pairs]
