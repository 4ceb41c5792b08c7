"""The options of a run as tables of a file or a link: impact law, hysteresis and ground."""

from collections.abc import Callable
from typing import Annotated, Any, NoReturn

from pydantic import InstanceOf, field_validator

from rockflex._errors import InputError
from rockflex._schema import IMPACT, PLAIN, WHOLE, BedKeys, BoucWenKeys, GroundKeys, ImpactKeys, Key, LawName, each
from rockflex._shown import shown
from rockflex.modal import Ground, RockingProperties, Springs, asce41_bed, winkler_bed
from rockflex.models import BoucWen, ImpactLaw, Restitution, VVELComplete, VVELSimplified
from rockflex.structure.file import Table
from rockflex.study._arguments import check_options

_EACH = each("spring")
_DAMPING_RATIO = Key("the damping of the heave mode over the critical damping", low=0.0, high=100.0)


class SpringsTable(Table):
    """The arguments of `Springs`; by default two springs are at the edges of the base."""

    positions: Annotated[
        list[float] | None,
        Key("a list of distances to the right of the axis of the masses in m (default: the edges)", "m", form=PLAIN),
    ] = None
    stiffness: Annotated[float | list[float], Key("the stiffness in N/m", "N/m", form=_EACH, low=1.0, high=1e15)]
    damping: Annotated[
        float | list[float] | None,
        Key("the damping coefficient in N s/m", "N s/m", form=_EACH, low=0.0, high=1e15),
    ] = None
    heave_damping_ratio: Annotated[float | None, _DAMPING_RATIO] = None

    def under(self, properties: RockingProperties) -> Springs:
        """Return the springs under a structure.

        Raises
        ------
        InputError
            If a value is out of range, or damping is given twice.
        """
        edges = [side * properties.half_width - properties.eccentricity for side in (-1, 1)]
        springs = Springs(
            edges if self.positions is None else self.positions,
            self.stiffness,
            0.0 if self.damping is None else self.damping,
        )
        return _damped(springs, self, properties)


class BedTable(BedKeys, Table):
    """The arguments of `winkler_bed` or, with a shear modulus, of `asce41_bed`, for the width of the structure."""

    damping: Annotated[
        float | None, Key("the damping coefficient of all springs together", "N s/m", low=0.0, high=1e15)
    ] = None
    n: Annotated[int, Key("the number of springs", label="Number of springs", form=WHOLE, low=2, high=200)] = 20
    end_zone: Annotated[
        float | None, Key("the length of the stiffer zone at either end", "m", low=0.0, high=1000.0)
    ] = None
    end_ratio: Annotated[
        float | None, Key("the stiffness of the end zones over that of the rest", low=1e-3, high=1e3)
    ] = None

    def under(self, properties: RockingProperties) -> Springs:
        """Return the bed under a structure.

        Raises
        ------
        InputError
            If a value is out of range, or the values contradict each other.
        """
        where: dict[str, Any] = {"n": self.n, "damping": self.damping or 0.0, "eccentricity": properties.eccentricity}
        zones = {"end_zone": self.end_zone, "end_ratio": self.end_ratio}
        ends: dict[str, Any] = {name: value for name, value in zones.items() if value is not None}
        if self.subgrade_modulus is not None:
            if self.shear_modulus is not None or self.poisson_ratio is not None:
                _refuse_both("subgrade_modulus", "the shear_modulus and poisson_ratio")
            bed = winkler_bed(properties.half_width, self.breadth, self.subgrade_modulus, **where, **ends)
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
        return _damped(bed, self, properties)


class GroundTable(GroundKeys, Table):
    """The arguments of `Ground`, with springs or a bed as tables."""

    springs: Annotated[SpringsTable | None, Key("a table", form=PLAIN)] = None
    bed: Annotated[BedTable | None, Key("a table", form=PLAIN)] = None

    def under(self, properties: RockingProperties) -> Ground:
        """Return the ground under a structure.

        Raises
        ------
        InputError
            If a value is out of range, or the values contradict each other. The message begins with the table, and the
            field with "ground".
        """
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
                    "base and floors together.",
                    field="base_inertia",
                )
            return self.base_inertia
        if self.base_inertia is not None:
            _refuse_both("mat_mass", "the base_inertia")
        return self.mat_mass * (2.0 * properties.half_width) ** 2 / 12.0


def _damped(springs: Springs, table: SpringsTable | BedTable, properties: RockingProperties) -> Springs:
    if table.heave_damping_ratio is None:
        return springs
    if table.damping is not None:
        _refuse_both("heave_damping_ratio", "the damping")
    return springs.damped(table.heave_damping_ratio, properties.m_tot)


def _refuse_both(name: str, other: str) -> NoReturn:
    raise InputError(f"{name} was given besides {other}. Leave one of them out.", field=name)


_LAWS: dict[str, Callable[..., ImpactLaw]] = {
    "simplified": VVELSimplified,
    "complete": VVELComplete,
    "restitution": Restitution,
}


class BoucWenTable(BoucWenKeys, Table):
    """The arguments of `BoucWen`."""


class RunOptionKeys(ImpactKeys, Table):
    """The options of a run that files, links and forms share: impact law, hysteresis and ground.

    By default each model has its own law, nothing yields, and the base cannot slide on rigid ground.

    In Python `impact` may also be any `ImpactLaw`, in place of a name.
    """

    impact: Annotated[LawName | InstanceOf[ImpactLaw] | None, IMPACT] = None  # pyright: ignore[reportIncompatibleVariableOverride]
    bouc_wen: Annotated[BoucWenTable | None, Key("a table", form=PLAIN)] = None
    ground: Annotated[GroundTable | None, Key("a table", form=PLAIN)] = None

    @field_validator("impact", mode="before")
    @classmethod
    def _law(cls, given: object) -> object:
        if not isinstance(given, str | int | float | list | dict | None):  # not a value that a file can hold
            check_options(None, given)  # pyright: ignore[reportArgumentType]
        return given

    def law(self) -> ImpactLaw | None:
        """Return the impact law; None for the model's own.

        Raises
        ------
        InputError
            If a coefficient of restitution is missing, out of range, or given to another law.
        """
        if self.impact == "restitution" and self.restitution is None:
            raise InputError(
                'The impact law "restitution" needs its coefficient. Give restitution, a number from 0 to 1.',
                field="restitution",
            )
        if self.restitution is not None and self.impact != "restitution":
            chosen = "the model's own" if self.impact is None else shown(self.impact)
            raise InputError(
                f"A restitution of {self.restitution:g} was given, but the impact law is {chosen}. "
                'Choose the impact law "restitution", or leave restitution out.',
                field="restitution",
            )
        if self.impact is None:
            return None
        if isinstance(self.impact, str):
            if self.impact not in _LAWS:  # a copy with another law was not checked
                raise InputError(f"impact must be {IMPACT.expected}, but {shown(self.impact)} was given.")
            return _LAWS[self.impact](*[] if self.restitution is None else [self.restitution])
        check_options(None, self.impact)
        return self.impact

    def hysteresis(self) -> BoucWen | None:
        """Return the hysteresis; None if nothing yields.

        Raises
        ------
        InputError
            If a value is out of range.
        """
        return None if self.bouc_wen is None else BoucWen(**self.bouc_wen.model_dump())

    def ground_rule(self) -> Callable[[RockingProperties], Ground] | None:
        """Return the function that gives each structure its ground; None for rigid ground without sliding."""
        return None if self.ground is None else self.ground.under


def name_of(law: ImpactLaw) -> str:
    """Return the name of an impact law of the package in a file."""
    return next(name for name, kind in _LAWS.items() if type(law) is kind)
