"""The structure file of the command line: a structure, and what `rockflex run` is to assume of it."""

from typing import Literal

from pydantic import Field

from rockflex.structure.file import StructureEntry, Table

__all__ = ["BoucWenTable", "StructureFile"]


class BoucWenTable(Table):
    """The arguments of `BoucWen`."""

    yield_displacement: float = Field(description="D_y of the first mode, a number in m")
    post_yield_ratio: float | None = Field(None, description="stiffness after yielding over that before, a number")
    gamma: float | None = Field(None, description="γ of the hysteresis, a number")
    beta: float | None = Field(None, description="β of the hysteresis, a number")
    exponent: float | None = Field(None, description="n of the hysteresis, a number of at least 1")


class StructureFile(StructureEntry):
    """A structure file: one structure, perhaps a name and tendons, and what `rockflex run` is to assume of it."""

    impact: Literal["simplified", "complete", "restitution"] | None = Field(
        None, description='"simplified", "complete" or "restitution"'
    )
    restitution: float | None = Field(None, description="a number from 0 to 1")
    bouc_wen: BoucWenTable | None = Field(None, description="a table")
