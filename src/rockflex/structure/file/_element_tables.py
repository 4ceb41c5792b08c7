"""Tables of the elements between a base and the ground."""

from collections.abc import Callable
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

from pydantic import Field

from rockflex._schema import PLAIN, Key
from rockflex.modal import BaseElement, FrictionDamper, Tendon, ViscousDamper, YieldingDissipator
from rockflex.structure.file._table import Table

_RATIO = "the stiffness after yielding over the elastic one"
_POSITION = Key("the distance to the right of the axis of the masses", "m")
_KIND = Key('"tendon", "yielding_dissipator", "viscous_damper" or "friction_damper"', form=PLAIN)


class ElementTable(Table):
    """A table that is an element; `title` is its name in a list, and a key `kind` is no argument."""

    makes: ClassVar[Callable[..., BaseElement]]
    title: ClassVar[str]

    def element(self) -> BaseElement:
        """Return the element.

        Raises
        ------
        InputError
            If a value is outside its range, or the values contradict each other.
        """
        return type(self).makes(**self.model_dump(exclude={"kind"}))

    def describe(self) -> dict[str, Any]:
        """Return the given values, and the defaults of the others."""
        return self.model_dump(exclude_none=True)


class TendonTable(ElementTable):
    """The arguments of `Tendon`."""

    makes = Tendon
    title = "Tendon"

    position: Annotated[float, _POSITION] = 0.0
    initial_force: Annotated[float, Key("the force while the base stands on the ground", "N")]
    stiffness: Annotated[float, Key("EA/L over the unbonded length", "N/m")]
    yield_force: Annotated[float | None, Key("the force at which the tendon yields", "N")] = None
    post_yield_ratio: Annotated[float | None, Key(f"{_RATIO} (default: the tendon stays elastic)")] = None
    rupture_elongation: Annotated[float | None, Key("the elongation at which a tendon that yields breaks", "m")] = None


class _TendonKind(Table):
    kind: Annotated[Literal["tendon"], _KIND]


class TendonElementTable(TendonTable, _TendonKind):
    """A tendon among the elements."""


class YieldingDissipatorTable(ElementTable):
    """The arguments of `YieldingDissipator`."""

    makes = YieldingDissipator
    title = "Yielding dissipator"

    kind: Annotated[Literal["yielding_dissipator"], _KIND]
    position: Annotated[float, _POSITION] = 0.0
    stiffness: Annotated[float, Key("the elastic stiffness", "N/m")]
    yield_force: Annotated[float, Key("the force at which the fuse yields", "N")]
    post_yield_ratio: Annotated[float, Key(_RATIO)] = 0.0
    tension_only: Annotated[bool, Key("whether the fuse cannot push", form="true or false: {}")] = False
    rupture_elongation: Annotated[float | None, Key("the elongation at which the fuse breaks", "m")] = None


class ViscousDamperTable(ElementTable):
    """The arguments of `ViscousDamper`."""

    makes = ViscousDamper
    title = "Viscous damper"

    kind: Annotated[Literal["viscous_damper"], _KIND]
    position: Annotated[float, _POSITION] = 0.0
    coefficient: Annotated[float, Key("the force over the velocity", "N s/m")]


class FrictionDamperTable(ElementTable):
    """The arguments of `FrictionDamper`."""

    makes = FrictionDamper
    title = "Friction damper"

    kind: Annotated[Literal["friction_damper"], _KIND]
    position: Annotated[float, _POSITION] = 0.0
    force: Annotated[float, Key("the force at which the damper slides", "N")]


AnyElementTable: TypeAlias = Annotated[
    TendonElementTable | YieldingDissipatorTable | ViscousDamperTable | FrictionDamperTable,
    Field(discriminator="kind"),
]
"""The table of any element, chosen by its `kind`."""

ELEMENTS: dict[str, type[ElementTable]] = {
    "tendon": TendonElementTable,
    "yielding_dissipator": YieldingDissipatorTable,
    "viscous_damper": ViscousDamperTable,
    "friction_damper": FrictionDamperTable,
}
"""The table of each kind of element by its name in a file."""
