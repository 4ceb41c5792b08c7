"""Tables of structures that are known by a few numbers each."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Protocol, SupportsIndex, TypeAlias

from pydantic import Field

from rockflex.modal import ModalProperties, RockingProperties
from rockflex.structure import (
    CantileverWithTipMass,
    FishBone,
    Frame,
    LumpedStructure,
    TaperedTower,
    WallFrame,
    rigid_block,
)
from rockflex.structure.file._table import NUMBER, WHOLE, Table, each, number, written

Vector = list[float]
Matrix = list[list[float]]
BaseMass = Annotated[float, Field(description="the mass of the base", json_schema_extra=number("kg"))]
HalfWidth = Annotated[float, Field(description="half the width of the base", json_schema_extra=number("m"))]
OneDamping = Annotated[
    float, Field(description="the fraction of critical damping", json_schema_extra=written("{}, a number such as 0.02"))
]
Damping = Annotated[
    float | Vector, Field(description="the fraction of critical damping", json_schema_extra=each("mode"))
]
AspectRatio = Annotated[float, Field(description="h*_1/B", json_schema_extra=NUMBER)]
Period = Annotated[float, Field(description="the first period on a fixed base", json_schema_extra=number("s"))]
Height = Annotated[float, Field(description="the height above the base", json_schema_extra=number("m"))]
Modes = Annotated[int, Field(description="how many modes to take", json_schema_extra=WHOLE)]


class Structure(Protocol):
    """Anything with modes on a fixed base that can rock, such as a `Frame`."""

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Modes on a fixed base."""
        ...

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Parameters of the rocking structure."""
        ...


Built: TypeAlias = Structure | RockingProperties
"""What a table makes."""


class StructureTable(Table):
    """A table that is a structure."""

    makes: ClassVar[Callable[..., Built]]

    def build(self, folder: Path) -> Built:
        """Make the structure; the paths of other files start from `folder`.

        Raises
        ------
        InputError
            If a value is outside its range, or values do not go together.
        """
        return type(self).makes(**self.arguments(folder))

    def values(self) -> dict[str, Any]:
        """Return what was given, and the defaults of what was not."""
        return self.model_dump(exclude_none=True)

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the values as the arguments of what makes the structure, with paths from `folder`."""
        return self.values() | self.files(folder)

    def files(self, _folder: Path) -> dict[str, Path]:
        """Return the path, from `folder`, of each value that is kept in a file."""
        return {}


class FrameTable(StructureTable):
    """The arguments of `Frame`."""

    makes = Frame

    n_stories: int = Field(description="the number of stories", json_schema_extra=WHOLE)
    story_height: float = Field(description="the height of a story", json_schema_extra=number("m"))
    story_mass: float = Field(description="the mass of each floor", json_schema_extra=number("kg"))
    base_mass: BaseMass
    stiffness_ratio: float = Field(
        description="the ratio of beam to column stiffness", json_schema_extra=written("{}, a number from 0 to inf")
    )
    period: Period
    aspect_ratio: AspectRatio
    damping_ratio: OneDamping


class LumpedTable(StructureTable):
    """The arguments of `LumpedStructure`."""

    makes = LumpedStructure

    masses: Vector | Matrix = Field(
        description="a list of masses in kg, from the lowest up, or the mass matrix",
        json_schema_extra={"unit": "kg"},
    )
    stiffness: Matrix = Field(
        description="the stiffness matrix in N/m, a list of rows", json_schema_extra={"unit": "N/m"}
    )
    heights: Vector = Field(
        description="a list of the heights of the masses above the base in m, from the lowest up",
        json_schema_extra={"unit": "m"},
    )
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping


class PropertiesTable(StructureTable):
    """The arguments of `RockingProperties`, but for its floors."""

    makes = RockingProperties

    omega: Vector = Field(
        description="a list of circular frequencies in rad/s, one a mode", json_schema_extra={"unit": "rad/s"}
    )
    effective_mass: Vector = Field(
        description="a list of effective masses m*_n in kg", json_schema_extra={"unit": "kg"}
    )
    effective_height: Vector = Field(
        description="a list of effective heights h*_n in m", json_schema_extra={"unit": "m"}
    )
    top_ordinate: Vector = Field(description="a list of the top's displacement for a unit of each mode")
    i_theta: float = Field(description="the moment of inertia about a pivot", json_schema_extra=number("kg m²"))
    l0r: float = Field(description="the sum of m_i h_i", json_schema_extra=number("kg m"))
    m_tot: float = Field(description="the total mass with the base", json_schema_extra=number("kg"))
    half_width: HalfWidth
    zeta: Damping
    translational_inertia: float | None = Field(
        None,
        description="the sum of m_i h_i² (default: i_theta - m_tot half_width²)",
        json_schema_extra=number("kg m²"),
    )
    top_height: float | None = Field(
        None,
        description="the height of the top, for its total displacement, in m",
        json_schema_extra={"unit": "m"},
    )
    base_mass: float | None = Field(
        None, description="the mass of the base, a part of m_tot", json_schema_extra=number("kg")
    )


class TaperedTowerTable(StructureTable):
    """The arguments of `TaperedTower`."""

    makes = TaperedTower

    height: Height
    base_radius: float = Field(
        description="the outer radius at the base, half its width", json_schema_extra=number("m")
    )
    top_radius: float = Field(description="the outer radius at the top", json_schema_extra=number("m"))
    wall: float = Field(description="the thickness of the wall", json_schema_extra=number("m"))
    density: float = Field(description="the density of the material", json_schema_extra=number("kg/m³"))
    elastic_modulus: float = Field(description="Young's modulus of the material", json_schema_extra=number("N/m²"))
    damping_ratio: Damping
    method: Literal["ritz", "fe"] = Field(
        "ritz", description='"ritz" (shapes over the whole height) or "fe" (2000 finite elements)'
    )
    n_modes: Modes = 5


class CantileverTable(StructureTable):
    """The arguments of `CantileverWithTipMass`."""

    makes = CantileverWithTipMass

    height: float = Field(description="the height of the body at the tip above the base", json_schema_extra=number("m"))
    tip_mass: float = Field(description="the mass of the body at the tip", json_schema_extra=number("kg"))
    bending_stiffness: float = Field(description="EI of the column", json_schema_extra=number("N m²"))
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping
    mass_per_length: float = Field(
        0.0, description="the mass of the column for each metre", json_schema_extra=number("kg/m")
    )
    tip_inertia: float = Field(
        0.0,
        description="the rotary inertia of the body at the tip about its own axis",
        json_schema_extra=number("kg m²"),
    )
    n_modes: Modes | None = Field(None, description="how many modes to take", json_schema_extra=WHOLE)


class WallFrameTable(StructureTable):
    """The arguments of `WallFrame`."""

    makes = WallFrame

    height: Height
    mass: float = Field(
        description="the mass of wall and frame together, without the base", json_schema_extra=number("kg")
    )
    stiffness_parameter: float = Field(
        description="α = H √(GA/EI), a number from 0 (a wall alone: flexure) to inf (a frame alone: shear)"
    )
    base_mass: BaseMass
    period: Period
    aspect_ratio: AspectRatio
    damping_ratio: Damping
    n_modes: Modes = 5


class FishBoneTable(StructureTable):
    """The arguments of `FishBone`."""

    makes = FishBone

    story_heights: Vector = Field(
        description="a list of the heights of the stories in m, from the base up", json_schema_extra={"unit": "m"}
    )
    masses: float | Vector = Field(description="the mass of each floor in kg", json_schema_extra=each("story", "kg"))
    column_stiffness: float | Vector = Field(
        description="EI of all columns of a story together in N m²", json_schema_extra=each("story", "N m²")
    )
    beam_stiffness: float | Vector = Field(
        description="the rotational stiffness of the beams of a floor in N m/rad (0: no beams, inf: rigid ones)",
        json_schema_extra=each("story", "N m/rad"),
    )
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping


class BlockTable(StructureTable):
    """The arguments of `rigid_block`."""

    makes = rigid_block

    slenderness: float = Field(description="atan(b/h) of the half sides", json_schema_extra=number("rad"))
    half_diagonal: float = Field(
        description="the distance from the corner to the centre", json_schema_extra=number("m")
    )
    mass: float = Field(1.0, description="the mass, which rotations do not depend on", json_schema_extra=number("kg"))
