"""Tables of cross-sections: a shape with its sizes, or several parts."""

from collections.abc import Callable
from typing import Annotated, Any, Literal, get_args

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.structure._cross_section import Section
from rockflex.structure.file._toml_table import TomlTable

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
