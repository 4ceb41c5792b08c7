"""A structure in a TOML file, with the wrappers around it and its elements."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import create_model, model_validator

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.registry import registered_objects, source_checksum
from rockflex.structure._attachment import PLACE
from rockflex.structure._base_element import BaseElement
from rockflex.structure._from_matrices import matrix_file_checksum
from rockflex.structure._outline import has_shapes
from rockflex.structure._structure import InFile, ModifiedStructure, Restrained
from rockflex.structure.file._element_tables import ELEMENT_NAMES, AnyElementTable
from rockflex.structure.file._structure_tables import STRUCTURES, Built, StructureTable
from rockflex.structure.file._toml_table import TomlTable, table_of
from rockflex.structure.file._wrappers import WRAPPERS, wrapped

_TABLE_KEY = Described("a table", form=PLAIN)

KINDS: dict[str, type[StructureTable]] = STRUCTURES | {
    kind: table_of(made, StructureTable, __name__) for kind, made in registered_objects("structures").items()
}
"""The table of each kind of structure by its name in a file."""


class _Named(TomlTable):
    name: Annotated[str, Described("a name, in quotes", form=PLAIN)] = ""


def _wrapper_field(kind: type[ModifiedStructure], told: InFile) -> Any:
    """Return the field of a wrapper: its value, or the table of the arguments that make it."""
    value = told.value or table_of(told.makes or kind, TomlTable, __name__)
    return Annotated[value | None, told.words], None


if TYPE_CHECKING:
    _OfKinds = _Named
else:
    _OfKinds = create_model(
        "_OfKinds",
        __base__=_Named,
        **{kind: (Annotated[table | None, _TABLE_KEY], None) for kind, table in KINDS.items()},
        **{key: _wrapper_field(*each) for key, each in WRAPPERS.items()},
    )


class StructureEntry(_OfKinds):
    """A structure with its name, the wrappers around it, and its elements.

    Of the kinds of structures one is a table, and the others are None; so are keys of `WRAPPERS` that are not given.

    Attributes
    ----------
    name : str
        Empty where none was given.
    elements : list of tables, one of each element
        None if there are none.
    """

    gone = {"tendons": 'Write each tendon as a table [[elements]] with kind = "tendon".'}  # noqa: RUF012

    elements: Annotated[
        list[AnyElementTable] | None, Described("a list of tables, each under a heading [[elements]]", form=PLAIN)
    ] = None  # not an empty list, which would be new in the documents of stored studies

    @property
    def elsewhere(self) -> str:
        """The key that holds the structure in place of a table; empty, as here there is none."""
        return ""

    @model_validator(mode="after")
    def _one_structure(self) -> Self:
        found = [f"[{kind}]" for kind in KINDS if getattr(self, kind) is not None]
        if len(found) != 1 and not self.elsewhere:
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

    @property
    def wrappers(self) -> dict[str, Any]:
        """The values of the keys of wrappers that change something, in the order in which these go around."""
        values = {key: getattr(self, key) for key in WRAPPERS}
        return {key: value for key, value in values.items() if value is not None and value != WRAPPERS[key][1].nothing}

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
        for key, value in self.wrappers.items():
            built = wrapped(key, value, built)
        return self.hold(built)

    def hold(self, built: Built) -> Built:
        """Return a structure with the elements of this one.

        Raises
        ------
        InputError
            If a value is out of range, or an element is outside the base. The message begins with its heading and
            number; the field is such as ``"elements.0.position"``, which counts from zero.
        """
        if not self.elements:
            return built
        alone = built.rocking(1 if has_shapes(built) else None)
        elements: list[BaseElement] = []
        for place, table in enumerate(self.elements):
            heading, row = f"[[elements]] no. {place + 1}", f"elements.{place}"
            try:
                elements.append(table.element())
            except InputError as error:
                raise InputError(str(error), place=heading, field=f"{row}.{error.field}") from error
            try:
                replace(alone, elements=elements[-1:])
            except InputError as error:  # it is outside the base, or at no floor
                name = error.field if error.field in PLACE else "position"
                raise InputError(str(error), place=heading, field=f"{row}.{name}") from error
        return Restrained.around(built, elements=elements)

    def moved(self, path: Callable[[str], str]) -> Self:
        """Return the same structure with the paths of its files from another folder."""
        files = {name: path(getattr(self.table, name)) for name in self.table.files(Path())}
        return self.model_copy(update={self.kind: self.table.model_copy(update=files)}) if files else self

    def checksums(self, folder: Path | str = "") -> dict[str, str]:
        """SHA-256 of the numbers in each file that the structure is built from, by its key, such as "matrices.mass".

        With those of the sources of structures and elements of other packages, by the name of their kind.

        Raises
        ------
        InputError
            If a file of numbers cannot be read.
        """
        files = self.table.files(Path(folder))
        found = {f"{self.kind}.{name}": matrix_file_checksum(name, path) for name, path in files.items()}
        made: dict[str, Any] = {self.kind: type(self.table).makes}
        made |= {ELEMENT_NAMES[type(each)]: type(each).makes for each in self.elements or []}
        sources = {f"source of {kind}": source_checksum(each) for kind, each in made.items()}
        return found | {kind: each for kind, each in sources.items() if each is not None}

    def describe(self) -> dict[str, Any]:
        """Return the values of the structure's table, and everything else that is given, but for the name."""
        more = {key: each.model_dump() if isinstance(each, TomlTable) else each for key, each in self.wrappers.items()}
        more |= {"elements": [each.describe() for each in self.elements]} if self.elements else {}
        return {**self.table.values(), **more}
