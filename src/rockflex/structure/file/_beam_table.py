"""The table of a beam whose mass and stiffness vary along the height."""

from pathlib import Path
from typing import Annotated, Any, Literal

from rockflex._errors import InputError
from rockflex._schema import PLAIN, WHOLE, BaseMass, Key, each
from rockflex.structure import Beam, LumpedMasses
from rockflex.structure.file._section_table import SectionKey, section_of
from rockflex.structure.file._table import Table
from rockflex.structure.file._tables import Damping, HalfWidth, Modes, StructureTable, Vector

_PROFILES = ("mass", "bending_stiffness", "shear_stiffness", "rotary_inertia")
_ALONG = each("height in z")


class LumpedMassesTable(Table):
    """The arguments of `LumpedMasses`."""

    heights: Annotated[Vector, Key("a list of the heights of the bodies above the base in m", "m", form=PLAIN)]
    masses: Annotated[Vector, Key("a list of the masses of the bodies in kg", "kg", form=PLAIN)]
    rotary: Annotated[
        Vector | None,
        Key("a list of the rotary inertias of the bodies about their own axes in kg m²", "kg m²", form=PLAIN),
    ] = None


class BeamTable(StructureTable):
    """The arguments of `Beam`; a quantity that varies along the height has a value for each height in `z`."""

    makes = Beam
    title = "Beam, perhaps tapered"

    height: Annotated[float, Key("the height of the beam above the base", "m", low=0.01, high=2000.0)]
    z: Annotated[
        Vector | None,
        Key(
            "a list of heights in m from 0 to the top, for the lists of values (the same twice: a jump)",
            "m",
            form=PLAIN,
            label="Heights z",
        ),
    ] = None
    mass: Annotated[
        float | Vector | None, Key("the mass per metre in kg/m (unless a section gives it)", "kg/m", form=_ALONG)
    ] = None
    bending_stiffness: Annotated[
        float | Vector | None, Key("EI in N m² (unless a section gives it)", "N m²", form=_ALONG)
    ] = None
    section: SectionKey = None
    shear_stiffness: Annotated[
        float | Vector | None, Key("GA_s in N (default: no deformation in shear)", "N", form=_ALONG)
    ] = None
    rotary_inertia: Annotated[float | Vector | None, Key("ρI in kg m (default: none)", "kg m", form=_ALONG)] = None
    lumped_masses: Annotated[LumpedMassesTable | None, Key("bodies", form="a table of {}")] = None
    half_width: HalfWidth
    damping_ratio: Damping
    base_mass: BaseMass = 0.0
    rotary_in_modes: Annotated[
        bool, Key("whether the rotary inertia takes part in the modes, or in I_θ only", form="true or false: {}")
    ] = True
    method: Annotated[
        Literal["fe", "ritz"], Key('"fe" (finite elements) or "ritz" (shapes over the whole height)', form=PLAIN)
    ] = "fe"
    n_modes: Modes = 5
    n_elements: Annotated[
        int | None,
        Key("how many finite elements to take (default: 1000)", form=WHOLE, low=2, high=2000, label="Elements"),
    ] = None

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
        return given | section_of(self.section)
