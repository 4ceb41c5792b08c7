"""Tables of the kinds of structures: their keys, and how each is built."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, TypeAlias, get_args

from pydantic import Field, StringConstraints

from rockflex.foundation.descriptions import PLAIN, WHOLE, Described, one_for_each
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import BaseMass
from rockflex.structure._beam import Beam
from rockflex.structure._beam_sections import LumpedMasses
from rockflex.structure._cross_section import Section
from rockflex.structure._frames import FishBone, Frame, LumpedStructure
from rockflex.structure._from_matrices import from_matrices, from_modes
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Structure
from rockflex.structure._towers import CantileverWithTipMass, TaperedTower, rigid_block
from rockflex.structure._wall_frame import WallFrame
from rockflex.structure.file._toml_table import TomlTable, table_of

Shape = Literal["rectangle", "box", "circle", "tube"]
_SIZES: dict[str, tuple[Callable[..., Section], tuple[str, ...]]] = {
    "rectangle": (Section.rectangle, ("width", "depth")),
    "box": (Section.box, ("width", "depth", "wall")),
    "circle": (Section.circle, ("diameter",)),
    "tube": (Section.tube, ("diameter", "wall")),
}
_SHAPES = ", ".join(f'"{shape}"' for shape in get_args(Shape))
_WIDTH = Described("the width perpendicular to the plane of rocking", "m", low=1e-3, high=500.0)
_DEPTH = Described("the depth in the plane of rocking", "m", low=1e-3, high=500.0)
_DIAMETER = Described("the outer diameter", "m", low=1e-3, high=500.0)
_WALL = Described("the thickness of the wall", "m", low=1e-4, high=100.0)
_MODULUS = Described("Young's modulus of the material", "N/m²")
_DENSITY = Described("the density of the material", "kg/m³", low=1.0, high=1e5)
_FACTOR = Described("the effective over the uncracked bending stiffness", low=1e-3, high=1.0)
Vector = list[float]
Matrix = list[list[float]]
HalfWidth = Annotated[float, Described("half the width of the base", "m", low=1e-3, high=1000.0)]
Damping = Annotated[
    float | Vector, Described("the fraction of critical damping", form=one_for_each("mode"), low=0.0, high=0.99)
]
Height = Annotated[float, Described("the height above the base", "m", low=0.01, high=2000.0)]
Modes = Annotated[int, Described("how many modes to take", form=WHOLE, low=1, high=100, label="Modes")]
PROFILES = ("mass", "bending_stiffness", "shear_stiffness", "rotary_inertia")
_EACH_HEIGHT = one_for_each("height in z")
Index = Annotated[str, StringConstraints(pattern=r"^[0-9]+$")]
_OR_FILE = "{}, or the path of a .npz, .mtx or .csv file"


class PartTable(TomlTable):
    """A part of a composite section, and the place of its centroid."""

    shape: Annotated[Shape, Described(f"one of {_SHAPES}", form=PLAIN)]
    width: Annotated[float | None, _WIDTH] = None
    depth: Annotated[float | None, _DEPTH] = None
    diameter: Annotated[float | None, _DIAMETER] = None
    wall: Annotated[float | None, _WALL] = None
    elastic_modulus: Annotated[float, _MODULUS]
    density: Annotated[float, _DENSITY]
    stiffness_factor: Annotated[float, _FACTOR] = 1.0
    offset: Annotated[
        float, Described("the distance of its centroid from any axis common to all parts, along the depth", "m")
    ] = 0.0


class SectionTable(TomlTable):
    """The arguments of one of the constructors of `Section`."""

    shape: Annotated[
        Literal[Shape, "composite"], Described(f'one of {_SHAPES} and "composite" (of several parts)', form=PLAIN)
    ]
    width: Annotated[float | None, _WIDTH] = None
    depth: Annotated[float | None, _DEPTH] = None
    diameter: Annotated[float | None, _DIAMETER] = None
    wall: Annotated[float | None, _WALL] = None
    elastic_modulus: Annotated[float | None, _MODULUS] = None
    density: Annotated[float | None, _DENSITY] = None
    stiffness_factor: Annotated[float, _FACTOR] = 1.0
    parts: Annotated[
        list[PartTable] | None, Described("a list of tables, one of each part of a composite section", form=PLAIN)
    ] = None

    def build(self) -> Section:
        """Return the section.

        Raises
        ------
        InputError
            If a size is missing, does not belong to the shape, or is outside its range.
        """
        if self.shape != "composite":
            return _section_of_shape(self.shape, self.model_dump(exclude={"shape"}, exclude_none=True))
        given = self.model_dump(exclude={"shape", "parts", "stiffness_factor"}, exclude_none=True)
        if given:
            raise InputError(f"section: {next(iter(given))} belongs to each part of a composite one.", field="section")
        found: list[tuple[Section, float]] = []
        for place, part in enumerate(self.parts or [], start=1):
            values = part.model_dump(exclude={"shape", "offset"}, exclude_none=True)
            try:
                found.append((_section_of_shape(part.shape, values), part.offset))
            except InputError as error:
                raise InputError(f"part no. {place} of the {error}", field="section") from error
        return _with_section_in_errors(lambda: Section.composite(found, stiffness_factor=self.stiffness_factor))


SectionKey = Annotated[
    SectionTable | None, Described("the cross-section in place of bending stiffness and mass", form="a table of {}")
]


def section_argument(table: SectionTable | None) -> dict[str, Any]:
    """Return the argument `section` of a structure; none without a table."""
    return {} if table is None else {"section": table.build()}


def _section_of_shape(shape: str, given: dict[str, Any]) -> Section:
    make, sizes = _SIZES[shape]
    needed = (*sizes, "elastic_modulus", "density")
    lacking = [name for name in needed if name not in given]
    other = [name for name in given if name not in (*needed, "stiffness_factor")]
    if lacking or other:
        wrong = f"but it lacks {', '.join(lacking)}" if lacking else f"not {', '.join(other)}"
        raise InputError(
            f"section: a {shape} takes {', '.join(needed)} and stiffness_factor, {wrong}.", field="section"
        )
    return _with_section_in_errors(lambda: make(**given))


def _with_section_in_errors(make: Callable[[], Section]) -> Section:
    """A message about an argument of a section says that it is one."""
    try:
        return make()
    except InputError as error:
        raise InputError(f"section: {error}", field="section") from error


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


class RockingPropertiesTable(StructureTable):
    """The arguments of `RockingProperties`, without its floors."""

    makes = RockingProperties
    title = "Rocking parameters"

    omega: Annotated[
        Vector,
        Described(
            "a list of circular frequencies in rad/s, one a mode", "rad/s", form=PLAIN, low=1e-3, high=1e6, label="ω"
        ),
    ]
    effective_mass: Annotated[Vector, Described("a list of effective masses m*_n in kg", "kg", form=PLAIN)]
    effective_height: Annotated[Vector, Described("a list of effective heights h*_n in m", "m", form=PLAIN)]
    top_ordinate: Annotated[Vector, Described("a list of the top's displacement for a unit of each mode", form=PLAIN)]
    i_theta: Annotated[float, Described("the moment of inertia about a pivot", "kg m²", label="I_θ")]
    l0r: Annotated[float, Described("the sum of m_i h_i", "kg m", label="L₀ʳ")]
    m_tot: Annotated[float, Described("the total mass with the base", "kg", label="Total mass")]
    half_width: HalfWidth
    zeta: Annotated[
        float | Vector,
        Described(
            "the fraction of critical damping", form=one_for_each("mode"), low=0.0, high=0.99, label="Damping ratio"
        ),
    ]
    translational_inertia: Annotated[
        float | None, Described("the sum of m_i h_i² (default: i_theta - m_tot half_width²)", "kg m²")
    ] = None
    top_height: Annotated[
        float | None, Described("the height of the top, for its total displacement, in m", "m", form=PLAIN)
    ] = None
    base_mass: Annotated[float | None, Described("the mass of the base, a part of m_tot", "kg", low=0.0, high=1e12)] = (
        None
    )
    leaning_mass: Annotated[
        float | None,
        Described("the mass that stands on other columns, not in m_tot but in the modes", "kg", low=0.0, high=1e12),
    ] = None


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
}
"""The table of each kind of structure of this package by its name in a file."""
