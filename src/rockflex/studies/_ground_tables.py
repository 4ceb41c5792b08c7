"""The ground of a structure in files and forms: springs, beds of springs, friction, and the inertia of the base."""

from dataclasses import replace
from typing import Annotated, Any, Literal, NoReturn, cast

from rockflex.foundation.descriptions import PLAIN, WHOLE, Described, one_for_each
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import GroundSchema, SpringBedSchema
from rockflex.structure._beds import (
    BEARING_CAPACITY,
    BED_DAMPING,
    END_RATIO,
    END_ZONE,
    NUMBER_OF_SPRINGS,
    SOIL_DENSITY,
    asce41_bed,
    gazetas_bed,
    winkler_bed,
)
from rockflex.structure._ground import Ground, Springs
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._toml_table import TomlTable
from rockflex.studies._arguments import ground_under_structure
from rockflex.studies._objects import Given, function_document, object_document, object_in_file

_EACH = one_for_each("spring")
_DAMPING_RATIO = Described("the damping of the heave mode over the critical damping", low=0.0, high=100.0)


class SpringsTable(TomlTable):
    """The arguments of `Springs`; by default two springs are at the edges of the base."""

    positions: Annotated[
        list[float] | None,
        Described(
            "a list of distances to the right of the axis of the masses in m (default: the edges)", "m", form=PLAIN
        ),
    ] = None
    stiffness: Annotated[float | list[float], Described("the stiffness in N/m", "N/m", form=_EACH, low=1.0, high=1e15)]
    damping: Annotated[
        float | list[float] | None,
        Described("the damping coefficient in N s/m", "N s/m", form=_EACH, low=0.0, high=1e15),
    ] = None
    heave_damping_ratio: Annotated[float | None, _DAMPING_RATIO] = None
    capacity: Annotated[
        float | list[float] | None,
        Described("the largest force of a spring, at which it yields, in N", "N", form=_EACH, low=1.0, high=1e15),
    ] = None

    def under(self, properties: RockingProperties) -> Springs:
        """Return the springs under a structure."""
        edges = [side * properties.half_width - properties.eccentricity for side in (-1, 1)]
        springs = Springs(
            edges if self.positions is None else self.positions,
            self.stiffness,
            0.0 if self.damping is None else self.damping,
            capacity=self.capacity,
        )
        return _springs_with_heave_damping(springs, self, properties)


class SpringBedTable(SpringBedSchema, TomlTable):
    """The arguments of `winkler_bed` or, with a shear modulus, of `asce41_bed` or `gazetas_bed`, for a structure."""

    damping: Annotated[float | None, BED_DAMPING] = None
    n: Annotated[int, replace(NUMBER_OF_SPRINGS, form=WHOLE)] = 20
    end_zone: Annotated[float | None, END_ZONE] = None
    end_ratio: Annotated[float | None, END_RATIO] = None
    method: Annotated[
        Literal["asce41", "gazetas"] | None,
        Described('"asce41" or "gazetas", for a shear modulus (default: ASCE 41)', form=PLAIN),
    ] = None
    density: Annotated[
        float | None,
        replace(SOIL_DENSITY, description=f"{SOIL_DENSITY.description}, with Gazetas"),
    ] = None
    bearing_capacity: Annotated[float | None, BEARING_CAPACITY] = None

    def under(self, properties: RockingProperties) -> Springs:
        """Return the bed under a structure."""
        where: dict[str, Any] = {"n": self.n, "damping": self.damping or 0.0, "eccentricity": properties.eccentricity}
        where["bearing_capacity"] = self.bearing_capacity
        zones = {"end_zone": self.end_zone, "end_ratio": self.end_ratio}
        ends: dict[str, Any] = {name: value for name, value in zones.items() if value is not None}
        if self.density is not None and self.method != "gazetas":
            raise InputError('density is for method = "gazetas". Leave it out, or give the method.', field="density")
        if self.subgrade_modulus is not None:
            if self.shear_modulus is not None or self.poisson_ratio is not None:
                _refuse_both("subgrade_modulus", "the shear_modulus and poisson_ratio")
            if self.method is not None:
                _refuse_both("method", "the subgrade_modulus")
            bed = winkler_bed(properties.half_width, self.breadth, self.subgrade_modulus, **where, **ends)
        elif self.shear_modulus is not None and self.poisson_ratio is not None and self.method == "gazetas":
            for name in ("end_ratio", "damping"):
                if getattr(self, name) is not None:
                    _refuse_both(name, 'the method "gazetas", which gives it')
            if self.density is not None and self.heave_damping_ratio is not None:
                _refuse_both("density", "the heave_damping_ratio")
            size = properties.half_width, self.breadth
            more: dict[str, Any] = {"end_zone": self.end_zone, "density": self.density}
            more |= {"n": self.n, "eccentricity": properties.eccentricity, "bearing_capacity": self.bearing_capacity}
            bed = gazetas_bed(*size, self.shear_modulus, self.poisson_ratio, **more)
        elif self.shear_modulus is not None and self.poisson_ratio is not None:
            if ends:
                _refuse_both(next(iter(ends)), "the shear_modulus, whose end zones are those of ASCE 41")
            bed = asce41_bed(properties.half_width, self.breadth, self.shear_modulus, self.poisson_ratio, **where)
        else:
            raise InputError(
                "A bed needs its stiffness. Give subgrade_modulus in N/m³; or shear_modulus in N/m² and poisson_ratio, "
                "for the stiffened ends of ASCE 41.",
                field="subgrade_modulus",
            )
        return _springs_with_heave_damping(bed, self, properties)


class GroundTable(GroundSchema, TomlTable):
    """The arguments of `Ground`, with springs or a bed as tables."""

    springs: Annotated[SpringsTable | None, Described("a table", form=PLAIN)] = None
    bed: Annotated[SpringBedTable | None, Described("a table", form=PLAIN)] = None

    def under(self, properties: RockingProperties) -> Ground:
        """Return the ground under a structure."""
        if self.springs is not None and self.bed is not None:
            raise InputError(
                "The ground has springs and a bed. Give one of the two tables.", place="[ground]", field="ground.bed"
            )
        springs = None
        for name, table in (("springs", self.springs), ("bed", self.bed)):
            try:
                springs = springs if table is None else table.under(properties)
            except InputError as error:
                raise InputError(str(error), place=f"[ground.{name}]", field=f"ground.{name}.{error.field}") from error
        try:
            return Ground(self.friction, springs, self._inertia(properties))
        except InputError as error:
            raise InputError(str(error), place="[ground]", field=f"ground.{error.field or 'friction'}") from error

    def _inertia(self, properties: RockingProperties) -> float | None:
        if self.mat_mass is None:
            if self.base_inertia is None and (self.springs or self.bed):
                raise InputError(
                    "A base without rotary inertia on springs has no inertia against rotation once all modes are "
                    "included. Give mat_mass in kg for a rigid mat as wide as the base, or base_inertia in kg m² for "
                    "base and floors together; base_inertia = 0 for a block, whose own would count twice.",
                    field="base_inertia",
                )
            return self.base_inertia
        if self.base_inertia is not None:
            _refuse_both("mat_mass", "the base_inertia")
        return self.mat_mass * (2.0 * properties.half_width) ** 2 / 12.0


class GivenGround(GroundTable, Given):
    """A `Ground`, or a function of `RockingProperties` that returns one, in the place of a table."""

    given: Any

    def under(self, properties: RockingProperties) -> Ground:
        """Return the ground under a structure."""
        return cast("Ground", ground_under_structure(properties, self.given))

    def in_file(self) -> Any:
        """Return the table of its class.

        Raises
        ------
        InputError
            If it is a function.
        """
        if isinstance(self.given, Ground):
            return object_in_file("ground", self.given)
        raise InputError(
            "ground is a function of Python, which no file can hold. Give a Ground, or a table: {'friction': 0.4}.",
            field="ground",
        )

    def document(self) -> Any:
        """Return what determines it."""
        of = object_document if isinstance(self.given, Ground) else function_document
        return of("ground", self.given)


def _springs_with_heave_damping(
    springs: Springs, table: SpringsTable | SpringBedTable, properties: RockingProperties
) -> Springs:
    if table.heave_damping_ratio is None:
        return springs
    if table.damping is not None:
        _refuse_both("heave_damping_ratio", "the damping")
    return springs.damped(table.heave_damping_ratio, properties.m_tot)


def _refuse_both(name: str, other: str) -> NoReturn:
    raise InputError(f"{name} was given besides {other}. Leave one of them out.", field=name)
