"""Tables of structures from the matrices or the modes of any finite element program."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, StringConstraints

from rockflex._schema import PLAIN, WHOLE, BaseMass, Key
from rockflex.structure import from_matrices, from_modes
from rockflex.structure.file._tables import Damping, HalfWidth, Matrix, StructureTable, Vector

Index = Annotated[str, StringConstraints(pattern=r"^[0-9]+$")]

_OR_FILE = "{}, or the path of a .npz, .mtx or .csv file"


class _FromFiles(StructureTable):
    """The keys that both kinds share: degrees of freedom above a base."""

    mass: Annotated[
        Vector | Matrix | str,
        Key(
            "a list of masses in kg, or the mass matrix",
            "kg",
            form=_OR_FILE,
            page="the masses in kg, 0 for freedoms without mass, or the rows of the mass matrix",
        ),
    ]
    heights: Annotated[
        Vector | dict[Index, float] | str,
        Key(
            "a list of the heights of all freedoms in m (nan: does not move sideways), or a table { index = height } "
            "of those that move sideways, counted from 0",
            "m",
            form=_OR_FILE,
            page="the heights in m of the freedoms that move sideways: of all freedoms but the rotations in their "
            "order, or each after its index, counted from 0 (0: 3, 2: 6)",
        ),
    ]
    rotations: Annotated[
        list[int], Key("a list of the indices of rotations in the plane, counted from 0", form=PLAIN)
    ] = Field(default_factory=list[int])
    base_mass: BaseMass
    half_width: HalfWidth
    damping_ratio: Damping
    n_modes: Annotated[
        int | None, Key("how many modes to take (default: all)", form=WHOLE, low=1, high=100, label="Modes")
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


class MatricesTable(_FromFiles):
    """The arguments of `from_matrices`."""

    makes = from_matrices
    title = "Mass and stiffness matrices"

    stiffness: Annotated[
        Matrix | str,
        Key(
            "the stiffness matrix in N/m, a list of rows",
            "N/m",
            form=_OR_FILE,
            page="the stiffness matrix in N/m, a line for each row",
        ),
    ]


class ModesTable(_FromFiles):
    """The arguments of `from_modes`."""

    makes = from_modes
    title = "Modes of a finite element model"

    omega: Annotated[
        Vector | str,
        Key(
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
        Key(
            "the mode shapes, a list of rows, one a freedom with a column for each mode",
            form=_OR_FILE,
            page="the mode shapes, a line for each freedom with a column for each mode",
        ),
    ]
