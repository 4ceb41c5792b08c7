"""The table of a beam whose mass and stiffness vary along the height."""

from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from rockflex._errors import InputError
from rockflex.structure import Beam, LumpedMasses
from rockflex.structure.file._table import WHOLE, Table, each, number, written
from rockflex.structure.file._tables import BaseMass, Damping, HalfWidth, StructureTable, Vector

_PROFILES = ("mass", "bending_stiffness", "shear_stiffness", "rotary_inertia")


class LumpedMassesTable(Table):
    """The arguments of `LumpedMasses`."""

    heights: Vector = Field(
        description="a list of the heights of the bodies above the base in m", json_schema_extra={"unit": "m"}
    )
    masses: Vector = Field(description="a list of the masses of the bodies in kg", json_schema_extra={"unit": "kg"})
    rotary: Vector | None = Field(
        None,
        description="a list of the rotary inertias of the bodies about their own axes in kg m²",
        json_schema_extra={"unit": "kg m²"},
    )


class BeamTable(StructureTable):
    """The arguments of `Beam`; what varies along the height has a value for each height in `z`."""

    makes = Beam

    height: float = Field(description="the height of the beam above the base", json_schema_extra=number("m"))
    z: Vector | None = Field(
        None,
        description="a list of heights in m from 0 to the top, for the lists of values (the same twice: a jump)",
        json_schema_extra={"unit": "m"},
    )
    mass: float | Vector = Field(
        description="the mass for each metre in kg/m", json_schema_extra=each("height in z", "kg/m")
    )
    bending_stiffness: float | Vector = Field(description="EI in N m²", json_schema_extra=each("height in z", "N m²"))
    shear_stiffness: float | Vector | None = Field(
        None, description="GA_s in N (default: no deformation in shear)", json_schema_extra=each("height in z", "N")
    )
    rotary_inertia: float | Vector | None = Field(
        None, description="ρI in kg m (default: none)", json_schema_extra=each("height in z", "kg m")
    )
    lumped_masses: LumpedMassesTable | None = Field(
        None, description="bodies", json_schema_extra=written("a table of {}")
    )
    half_width: HalfWidth
    damping_ratio: Damping
    base_mass: BaseMass = 0.0
    rotary_in_modes: bool = Field(
        True,
        description="whether the rotary inertia takes part in the modes, or in I_θ alone",
        json_schema_extra=written("true or false: {}"),
    )
    method: Literal["fe", "ritz"] = Field(
        "fe", description='"fe" (finite elements) or "ritz" (shapes over the whole height)'
    )
    n_modes: int = Field(5, description="how many modes to take", json_schema_extra=WHOLE)
    n_elements: int | None = Field(
        None, description="how many finite elements to take (default: 1000)", json_schema_extra=WHOLE
    )

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments with a table for each list."""
        given = super().arguments(folder)
        z = given.pop("z", None)
        lists = [name for name in _PROFILES if isinstance(given.get(name), list)]
        if z is None and lists:
            raise InputError(
                f"{lists[0]} is a list, but its heights are not known. Add z, a list of as many heights in m.",
                field=lists[0],
            )
        if z is not None and not lists:
            raise InputError(
                "z holds heights, but nothing varies along them. Give a list of as many values, or leave z out.",
                field="z",
            )
        given |= {name: (z, given[name]) for name in lists}
        if self.lumped_masses is not None:
            given["lumped_masses"] = LumpedMasses(**given["lumped_masses"])
        return given
