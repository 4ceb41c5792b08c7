"""A structure as an entry of a file."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, model_validator

from rockflex._errors import InputError
from rockflex._schema import PLAIN, Eccentricity, Key
from rockflex.modal import BaseElement, RockingProperties
from rockflex.structure import Eccentric, Restrained
from rockflex.structure._matrix_files import checksum
from rockflex.structure.file._beam_table import BeamTable
from rockflex.structure.file._element_tables import AnyElementTable, TendonTable
from rockflex.structure.file._matrix_tables import MatricesTable, ModesTable
from rockflex.structure.file._table import Table, inner_table
from rockflex.structure.file._tables import (
    BlockTable,
    Built,
    CantileverTable,
    FishBoneTable,
    FrameTable,
    LumpedTable,
    PropertiesTable,
    StructureTable,
    TaperedTowerTable,
    WallFrameTable,
)

_KIND = Key("a table", form=PLAIN)


class StructureEntry(Table):
    """A structure, with its optional name, its place on the base, and the elements that hold the base.

    Attributes
    ----------
    name : str
        Empty where none was given.
    frame, fish_bone, wall_frame, tapered_tower, cantilever, beam, lumped, matrices, modes, properties, block
        One of them is a table, the others are None.
    eccentricity : float or None
        In m; None in the middle of the base.
    tendons : list of TendonTable
        May be empty.
    elements : list of tables, one of each element
        None if there are none. They follow the tendons.
    """

    name: Annotated[str, Key("a name, in quotes", form=PLAIN)] = ""
    frame: Annotated[FrameTable | None, _KIND] = None
    fish_bone: Annotated[FishBoneTable | None, _KIND] = None
    wall_frame: Annotated[WallFrameTable | None, _KIND] = None
    tapered_tower: Annotated[TaperedTowerTable | None, _KIND] = None
    cantilever: Annotated[CantileverTable | None, _KIND] = None
    beam: Annotated[BeamTable | None, _KIND] = None
    lumped: Annotated[LumpedTable | None, _KIND] = None
    matrices: Annotated[MatricesTable | None, _KIND] = None
    modes: Annotated[ModesTable | None, _KIND] = None
    properties: Annotated[PropertiesTable | None, _KIND] = None
    block: Annotated[BlockTable | None, _KIND] = None
    eccentricity: Eccentricity = None
    tendons: Annotated[list[TendonTable], Key("a list of tables, each under a heading [[tendons]]", form=PLAIN)] = (
        Field(default_factory=list[TendonTable])
    )
    elements: Annotated[
        list[AnyElementTable] | None, Key("a list of tables, each under a heading [[elements]]", form=PLAIN)
    ] = None  # not an empty list, which would be new in the documents of stored studies

    @model_validator(mode="after")
    def _one_structure(self) -> "StructureEntry":
        found = [f"[{kind}]" for kind in KINDS if getattr(self, kind) is not None]
        if len(found) != 1:
            *others, last = (f"[{kind}]" for kind in KINDS)
            was = " and ".join(found) + " were" if found else "none was"
            raise InputError(f"one structure is expected, {', '.join(others)} or {last}, but {was} found.")
        return self

    @property
    def kind(self) -> str:
        """Name of the structure's table."""
        return next(kind for kind in KINDS if getattr(self, kind) is not None)

    @property
    def table(self) -> StructureTable:
        """The structure's table."""
        table: StructureTable = getattr(self, self.kind)
        return table

    def build(self, folder: Path | str = "") -> Built:
        """Build the structure.

        Parameters
        ----------
        folder
            Folder that the paths of matrices are relative to. Default: the working directory.

        Returns
        -------
        Frame, Beam, ..., Eccentric, Restrained or RockingProperties

        Raises
        ------
        InputError
            If a value is out of range, values contradict each other, or a file of numbers cannot be read. The
            message begins with the table.
        """
        try:
            built = self.table.build(Path(folder))
        except InputError as error:
            raise InputError(str(error), place=f"[{self.kind}]", field=error.field) from error
        if self.eccentricity:
            e = self.eccentricity
            built = replace(built, eccentricity=e) if isinstance(built, RockingProperties) else Eccentric(built, e)
        return self.hold(built)

    def hold(self, built: Built) -> Built:
        """Return a structure with the tendons and elements of this one.

        Raises
        ------
        InputError
            If a value is out of range, or an element is outside the base. The message begins with its heading and
            number; the field is such as ``"elements.0.position"``, which counts from zero.
        """
        tables = {
            **{("tendons", place): table for place, table in enumerate(self.tendons, start=1)},
            **{("elements", place): table for place, table in enumerate(self.elements or [], start=1)},
        }
        if not tables:
            return built
        known = isinstance(built, RockingProperties)
        alone = built if known else built.rocking(1)
        elements: list[BaseElement] = []
        for (key, place), table in tables.items():
            row = f"{key}.{place - 1}"
            try:
                elements.append(table.element())
            except InputError as error:
                raise InputError(str(error), place=f"[[{key}]] no. {place}", field=f"{row}.{error.field}") from error
            try:
                replace(alone, elements=elements[-1:])
            except InputError as error:  # it is outside the base
                raise InputError(str(error), place=f"[[{key}]] no. {place}", field=f"{row}.position") from error
        return replace(built, elements=elements) if known else Restrained(built, elements)

    def checksums(self, folder: Path | str = "") -> dict[str, str]:
        """SHA-256 of the numbers in each file that the structure is built from, by its key, such as "matrices.mass".

        Raises
        ------
        InputError
            If a file of numbers cannot be read.
        """
        files = self.table.files(Path(folder))
        return {f"{self.kind}.{name}": checksum(name, path) for name, path in files.items()}

    def describe(self) -> dict[str, Any]:
        """Return the values of the structure's table, with eccentricity, tendons and elements if given."""
        more: dict[str, Any] = {"eccentricity": self.eccentricity} if self.eccentricity else {}
        for key, tables in (("tendons", self.tendons), ("elements", self.elements)):
            if tables:
                more[key] = [each.describe() for each in tables]
        return {**self.table.values(), **more}


KINDS: dict[str, type[StructureTable]] = {
    name: table
    for name, field in StructureEntry.model_fields.items()
    if issubclass(table := inner_table(field.annotation) or Table, StructureTable)
}
"""The table of each kind of structure by its name in a file."""
