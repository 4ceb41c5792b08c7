"""Tables of structures that need only a few numbers each."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Protocol, SupportsIndex, TypeAlias

from rockflex._schema import PLAIN, WHOLE, AspectRatio, BaseMass, FrameKeys, Key, Period, each
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
from rockflex.structure.file._section_table import SectionKey, section_of
from rockflex.structure.file._table import Table

Vector = list[float]
Matrix = list[list[float]]
HalfWidth = Annotated[float, Key("half the width of the base", "m", low=1e-3, high=1000.0)]
Damping = Annotated[float | Vector, Key("the fraction of critical damping", form=each("mode"), low=0.0, high=0.99)]
Height = Annotated[float, Key("the height above the base", "m", low=0.01, high=2000.0)]
Modes = Annotated[int, Key("how many modes to take", form=WHOLE, low=1, high=100, label="Modes")]


class Structure(Protocol):
    """Anything with modes on a fixed base that can rock, such as a `Frame`."""

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Modes on a fixed base."""
        ...

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Parameters of the rocking structure."""
        ...


Built: TypeAlias = Structure | RockingProperties
"""The result of building a table."""


class StructureTable(Table):
    """A table that is a structure; `title` is its name in the list of a form."""

    makes: ClassVar[Callable[..., Built]]
    title: ClassVar[str]

    def build(self, folder: Path) -> Built:
        """Build the structure; the paths of other files are relative to `folder`.

        Raises
        ------
        InputError
            If a value is outside its range, or the values contradict each other.
        """
        return type(self).makes(**self.arguments(folder))

    def values(self) -> dict[str, Any]:
        """Return the given values, and the defaults of the others."""
        return self.model_dump(exclude_none=True)

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments of `makes`, with paths relative to `folder`."""
        return self.values() | self.files(folder)

    def files(self, _folder: Path) -> dict[str, Path]:
        """Return the path, relative to `folder`, of each value that is stored in a file."""
        return {}


class FrameTable(FrameKeys, StructureTable):
    """The arguments of `Frame`."""

    makes = Frame
    title = "Frame of equal stories"


class LumpedTable(StructureTable):
    """The arguments of `LumpedStructure`."""

    makes = LumpedStructure
    title = "Lumped masses"

    masses: Annotated[
        Vector | Matrix, Key("a list of masses in kg, from the lowest up, or the mass matrix", "kg", form=PLAIN)
    ]
    stiffness: Annotated[Matrix, Key("the stiffness matrix in N/m, a list of rows", "N/m", form=PLAIN)]
    heights: Annotated[
        Vector, Key("a list of the heights of the masses above the base in m, from the lowest up", "m", form=PLAIN)
    ]
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping


class PropertiesTable(StructureTable):
    """The arguments of `RockingProperties`, without its floors."""

    makes = RockingProperties
    title = "Rocking parameters"

    omega: Annotated[
        Vector,
        Key("a list of circular frequencies in rad/s, one a mode", "rad/s", form=PLAIN, low=1e-3, high=1e6, label="ω"),
    ]
    effective_mass: Annotated[Vector, Key("a list of effective masses m*_n in kg", "kg", form=PLAIN)]
    effective_height: Annotated[Vector, Key("a list of effective heights h*_n in m", "m", form=PLAIN)]
    top_ordinate: Annotated[Vector, Key("a list of the top's displacement for a unit of each mode", form=PLAIN)]
    i_theta: Annotated[float, Key("the moment of inertia about a pivot", "kg m²", label="I_θ")]
    l0r: Annotated[float, Key("the sum of m_i h_i", "kg m", label="L₀ʳ")]
    m_tot: Annotated[float, Key("the total mass with the base", "kg", label="Total mass")]
    half_width: HalfWidth
    zeta: Annotated[
        float | Vector,
        Key("the fraction of critical damping", form=each("mode"), low=0.0, high=0.99, label="Damping ratio"),
    ]
    translational_inertia: Annotated[
        float | None, Key("the sum of m_i h_i² (default: i_theta - m_tot half_width²)", "kg m²")
    ] = None
    top_height: Annotated[
        float | None, Key("the height of the top, for its total displacement, in m", "m", form=PLAIN)
    ] = None
    base_mass: Annotated[float | None, Key("the mass of the base, a part of m_tot", "kg", low=0.0, high=1e12)] = None


class TaperedTowerTable(StructureTable):
    """The arguments of `TaperedTower`."""

    makes = TaperedTower
    title = "Tapered tower"

    height: Height
    base_radius: Annotated[float, Key("the outer radius at the base, half its width", "m", low=1e-2, high=500.0)]
    top_radius: Annotated[float, Key("the outer radius at the top", "m", low=1e-2, high=500.0)]
    wall: Annotated[float, Key("the thickness of the wall", "m", low=1e-3, high=100.0)]
    density: Annotated[float, Key("the density of the material", "kg/m³", low=1.0, high=1e5)]
    elastic_modulus: Annotated[float, Key("Young's modulus of the material", "N/m²")]
    damping_ratio: Damping
    method: Annotated[
        Literal["ritz", "fe"], Key('"ritz" (shapes over the whole height) or "fe" (2000 finite elements)', form=PLAIN)
    ] = "ritz"
    n_modes: Modes = 5


class CantileverTable(StructureTable):
    """The arguments of `CantileverWithTipMass`."""

    makes = CantileverWithTipMass
    title = "Cantilever with a mass at its tip"

    height: Annotated[float, Key("the height of the body at the tip above the base", "m", low=0.01, high=2000.0)]
    tip_mass: Annotated[float, Key("the mass of the body at the tip", "kg")]
    bending_stiffness: Annotated[
        float | None, Key("EI of the column (unless a section gives it)", "N m²", label="Bending stiffness")
    ] = None
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping
    mass_per_length: Annotated[float, Key("the mass of the column per metre", "kg/m")] = 0.0
    tip_inertia: Annotated[float, Key("the rotary inertia of the body at the tip about its own axis", "kg m²")] = 0.0
    n_modes: Annotated[int | None, Key("how many modes to take", form=WHOLE, low=1, high=100, label="Modes")] = None
    section: SectionKey = None

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments with the section built."""
        return super().arguments(folder) | section_of(self.section)


class WallFrameTable(StructureTable):
    """The arguments of `WallFrame`."""

    makes = WallFrame
    title = "Wall and frame"

    height: Height
    mass: Annotated[float, Key("the mass of wall and frame together, without the base", "kg")]
    stiffness_parameter: Annotated[
        float,
        Key(
            "α = H √(GA/EI), a number from 0 (a wall alone: flexure) to inf (a frame alone: shear)",
            form=PLAIN,
            low=0.0,
            high=math.inf,
        ),
    ]
    base_mass: BaseMass
    period: Period
    aspect_ratio: AspectRatio
    damping_ratio: Damping
    n_modes: Modes = 5


class FishBoneTable(StructureTable):
    """The arguments of `FishBone`."""

    makes = FishBone
    title = "Frame of unequal stories"

    story_heights: Annotated[
        Vector, Key("a list of the heights of the stories in m, from the base up", "m", form=PLAIN, low=0.1, high=100.0)
    ]
    masses: Annotated[float | Vector, Key("the mass of each floor in kg", "kg", form=each("story"))]
    column_stiffness: Annotated[
        float | Vector, Key("EI of all columns of a story together in N m²", "N m²", form=each("story"))
    ]
    beam_stiffness: Annotated[
        float | Vector,
        Key(
            "the rotational stiffness of the beams of a floor in N m/rad (0: no beams, inf: rigid ones)",
            "N m/rad",
            form=each("story"),
            high=math.inf,
        ),
    ]
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping


class BlockTable(StructureTable):
    """The arguments of `rigid_block`."""

    makes = rigid_block
    title = "Rigid block"

    slenderness: Annotated[float, Key("atan(b/h) of the half sides", "rad", low=1e-4, high=1.5)]
    half_diagonal: Annotated[float, Key("the distance from the corner to the centre", "m", low=1e-3, high=1000.0)]
    mass: Annotated[float, Key("the mass, which rotations do not depend on", "kg")] = 1.0
