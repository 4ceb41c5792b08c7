"""Tables of structures from the matrices or the modes of any finite element program."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, StringConstraints

from rockflex.structure import from_matrices, from_modes
from rockflex.structure.file._table import WHOLE, written
from rockflex.structure.file._tables import BaseMass, Damping, HalfWidth, StructureTable, Vector

Matrix = list[list[float]]
Index = Annotated[str, StringConstraints(pattern=r"^[0-9]+$")]

_OR_FILE = "{}, or the path of a .npz, .mtx or .csv file"


class _FromFiles(StructureTable):
    """What both kinds have: freedoms above a base."""

    mass: Vector | Matrix | str = Field(
        description="a list of masses in kg, or the mass matrix", json_schema_extra=written(_OR_FILE, "kg")
    )
    heights: Vector | dict[Index, float] | str = Field(
        description="a list of the heights of all freedoms in m, or a table { index = height } of those that move "
        "sideways, counted from 0",
        json_schema_extra=written(_OR_FILE, "m"),
    )
    rotations: list[int] = Field(
        default_factory=list[int], description="a list of the indices of rotations in the plane, counted from 0"
    )
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping
    n_modes: int | None = Field(None, description="how many modes to take (default: all)", json_schema_extra=WHOLE)

    def arguments(self, folder: Path) -> dict[str, Any]:
        """Return the arguments with paths from `folder`, and indices as numbers."""
        given = super().arguments(folder)
        if isinstance(self.heights, dict):
            given["heights"] = {int(index): height for index, height in self.heights.items()}
        return given

    def files(self, folder: Path) -> dict[str, Path]:
        """Return the path, from `folder`, of each value that is kept in a file."""
        return {name: folder / value for name, value in self.values().items() if isinstance(value, str)}


class MatricesTable(_FromFiles):
    """The arguments of `from_matrices`."""

    makes = from_matrices

    stiffness: Matrix | str = Field(
        description="the stiffness matrix in N/m, a list of rows", json_schema_extra=written(_OR_FILE, "N/m")
    )


class ModesTable(_FromFiles):
    """The arguments of `from_modes`."""

    makes = from_modes

    omega: Vector | str = Field(
        description="a list of circular frequencies in rad/s, one a mode", json_schema_extra=written(_OR_FILE, "rad/s")
    )
    shapes: Matrix | str = Field(
        description="the mode shapes, a list of rows, one a freedom with a column for each mode",
        json_schema_extra=written(_OR_FILE),
    )
