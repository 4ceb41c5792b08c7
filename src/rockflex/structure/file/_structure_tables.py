"""Tables of the kinds of structures: their keys, and how each is built."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeAlias

from pydantic import Field, StringConstraints

from rockflex.foundation.descriptions import PLAIN, WHOLE, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import DAMPING_RATIOS, BaseMass, HalfWidth
from rockflex.structure._beam import Beam
from rockflex.structure._beam_sections import LumpedMasses
from rockflex.structure._frames import FishBone, Frame, LumpedStructure
from rockflex.structure._from_matrices import from_matrices, from_modes
from rockflex.structure._rigid_bodies import rigid_block, rocking_frame
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Structure
from rockflex.structure._towers import CantileverWithTipMass, TaperedTower
from rockflex.structure._wall_frame import WallFrame
from rockflex.structure.file._section_tables import SectionTable, section_argument
from rockflex.structure.file._toml_table import TomlTable, table_of

Vector = list[float]
Matrix = list[list[float]]
Damping = Annotated[float | Vector, DAMPING_RATIOS]
PROFILES = ("mass", "bending_stiffness", "shear_stiffness", "rotary_inertia")
Index = Annotated[str, StringConstraints(pattern=r"^[0-9]+$")]
_OR_FILE = "{}, or the path of a .npz, .mtx or .csv file"

Built: TypeAlias = Structure | RockingProperties
"""The result of building a table."""


class StructureTable(TomlTable):
    """A table that is a structure; `title` is its name in the list of a form."""

    makes: ClassVar[Callable[..., Built]]
    title: ClassVar[str]
    tuples: ClassVar[tuple[str, ...]] = ()  # keys whose lists `makes` takes as tuples

    def build(self, folder: Path) -> Built:
        """Build the structure; the paths of other files are relative to `folder`.

        Raises
        ------
        InputError
            If a value is outside its range, or the values contradict each other.
        """
        given = self.arguments(folder)
        return type(self).makes(**given | {name: tuple(given[name]) for name in self.tuples if name in given})

    def values(self) -> dict[str, Any]:
        """Return the given values, and the defaults of the others."""
        return self.model_dump(exclude_none=True)

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments of `makes`, with paths relative to `folder`."""
        return self.values() | self.files(folder)

    def files(self, _folder: Path) -> dict[str, Path]:
        """Return the path, relative to `folder`, of each value that is stored in a file."""
        return {}


FrameTable = table_of(Frame, StructureTable, __name__)
LumpedStructureTable = table_of(LumpedStructure, StructureTable, __name__)


RockingPropertiesTable = table_of(RockingProperties, StructureTable, __name__)


TaperedTowerTable = table_of(TaperedTower, StructureTable, __name__)


class _SectionStructure(StructureTable):
    """A structure that may have a cross-section."""

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments with the section built."""
        return super().arguments(folder) | section_argument(getattr(self, "section", None))


CantileverTable = table_of(CantileverWithTipMass, _SectionStructure, __name__, {"section": SectionTable | None})


WallFrameTable = table_of(WallFrame, StructureTable, __name__)


FishBoneTable = table_of(FishBone, StructureTable, __name__)


RigidBlockTable = table_of(rigid_block, StructureTable, __name__)
RockingFrameTable = table_of(rocking_frame, StructureTable, __name__)


class LumpedMassesTable(TomlTable):
    """The arguments of `LumpedMasses`."""

    heights: Annotated[Vector, Described("a list of the heights of the bodies above the base in m", "m", form=PLAIN)]
    masses: Annotated[Vector, Described("a list of the masses of the bodies in kg", "kg", form=PLAIN)]
    rotary: Annotated[
        Vector | None,
        Described("a list of the rotary inertias of the bodies about their own axes in kg m²", "kg m²", form=PLAIN),
    ] = None


class _BeamStructure(StructureTable):
    """The arguments of `Beam`; a quantity that varies along the height has a value for each height in `z`."""

    z: Annotated[
        Vector | None,
        Described(
            "a list of heights in m from 0 to the top, for the lists of values (the same twice: a jump)",
            "m",
            form=PLAIN,
            label="Heights z",
        ),
    ] = None

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments with a table for each list."""
        given = super().arguments(folder)
        z = given.pop("z", None)
        lists = [name for name in PROFILES if isinstance(given.get(name), list)]
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
        if given.get("lumped_masses") is not None:
            given["lumped_masses"] = LumpedMasses(**given["lumped_masses"])
        return given | section_argument(getattr(self, "section", None))


BeamTable = table_of(
    Beam,
    _BeamStructure,
    __name__,
    {"section": SectionTable | None, "lumped_masses": LumpedMassesTable | None},
)


class _MatrixFilesTable(StructureTable):
    """The keys that both kinds share: degrees of freedom above a base."""

    mass: Annotated[
        Vector | Matrix | str,
        Described(
            "a list of masses in kg, or the mass matrix",
            "kg",
            form=_OR_FILE,
            page="the masses in kg, 0 for freedoms without mass, or the rows of the mass matrix",
        ),
    ]
    heights: Annotated[
        Vector | dict[Index, float] | str,
        Described(
            "a list of the heights of all freedoms in m (nan: does not move sideways), or a table { index = height } "
            "of those that move sideways, counted from 0",
            "m",
            form=_OR_FILE,
            page="the heights in m of the freedoms that move sideways: of all freedoms but the rotations in their "
            "order, or each after its index, counted from 0 (0: 3, 2: 6)",
        ),
    ]
    rotations: Annotated[
        list[int], Described("a list of the indices of rotations in the plane, counted from 0", form=PLAIN)
    ] = Field(default_factory=list[int])
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping
    n_modes: Annotated[
        int | None, Described("how many modes to take (default: all)", form=WHOLE, low=1, high=100, label="Modes")
    ] = None

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments with paths relative to `folder`, and indices as numbers."""
        given = super().arguments(folder)
        if isinstance(self.heights, dict):
            given["heights"] = {int(index): height for index, height in self.heights.items()}
        return given

    def files(self, folder: Path) -> dict[str, Path]:
        """Return the path, relative to `folder`, of each value that is stored in a file."""
        return {name: folder / value for name, value in self.values().items() if isinstance(value, str)}


class MatricesTable(_MatrixFilesTable):
    """The arguments of `from_matrices`."""

    makes = from_matrices
    title = "Mass and stiffness matrices"

    stiffness: Annotated[
        Matrix | str,
        Described(
            "the stiffness matrix in N/m, a list of rows",
            "N/m",
            form=_OR_FILE,
            page="the stiffness matrix in N/m, a line for each row",
        ),
    ]


class ModesTable(_MatrixFilesTable):
    """The arguments of `from_modes`."""

    makes = from_modes
    title = "Modes of a finite element model"

    omega: Annotated[
        Vector | str,
        Described(
            "a list of circular frequencies in rad/s, one a mode",
            "rad/s",
            form=_OR_FILE,
            low=1e-3,
            high=1e6,
            label="ω",
            page="the circular frequencies in rad/s, one a mode",
        ),
    ]
    shapes: Annotated[
        Matrix | str,
        Described(
            "the mode shapes, a list of rows, one a freedom with a column for each mode",
            form=_OR_FILE,
            page="the mode shapes, a line for each freedom with a column for each mode",
        ),
    ]


STRUCTURES: dict[str, type[StructureTable]] = {
    "frame": FrameTable,
    "fish_bone": FishBoneTable,
    "wall_frame": WallFrameTable,
    "tapered_tower": TaperedTowerTable,
    "cantilever": CantileverTable,
    "beam": BeamTable,
    "lumped": LumpedStructureTable,
    "matrices": MatricesTable,
    "modes": ModesTable,
    "properties": RockingPropertiesTable,
    "block": RigidBlockTable,
    "rocking_frame": RockingFrameTable,
}
"""The table of each kind of structure of this package by its name in a file."""
