"""A structure in a TOML file: leaning mass, stories that yield, its place on the base, and its elements."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import create_model, model_validator

from rockflex.foundation.descriptions import PLAIN, Described, one_for_each
from rockflex.foundation.errors import InputError
from rockflex.foundation.registry import registered_objects, source_checksum
from rockflex.foundation.schema import Eccentricity
from rockflex.structure._attachment import PLACE
from rockflex.structure._base_element import BaseElement
from rockflex.structure._from_matrices import matrix_file_checksum
from rockflex.structure._jointed import Jointed, joints_at
from rockflex.structure._leaning import Leaning
from rockflex.structure._one_sided import OneSided
from rockflex.structure._outline import has_shapes
from rockflex.structure._podium import Podium
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Eccentric, Restrained, Structure
from rockflex.structure._yielding_stories import YieldingStories
from rockflex.structure.file._element_tables import ELEMENT_NAMES, AnyElementTable
from rockflex.structure.file._structure_tables import STRUCTURES, Built, StructureTable
from rockflex.structure.file._toml_table import TomlTable, table_of

_TABLE_KEY = Described("a table", form=PLAIN)
if TYPE_CHECKING:
    StoriesTable = TomlTable
    JointsTable = TomlTable
    OneSidedTable = TomlTable
    PodiumTable = TomlTable
else:
    StoriesTable = table_of(YieldingStories, TomlTable, __name__)
    JointsTable = table_of(joints_at, TomlTable, __name__)
    OneSidedTable = table_of(OneSided, TomlTable, __name__)
    PodiumTable = table_of(Podium, TomlTable, __name__)


KINDS: dict[str, type[StructureTable]] = STRUCTURES | {
    kind: table_of(made, StructureTable, __name__) for kind, made in registered_objects("structures").items()
}
"""The table of each kind of structure by its name in a file."""


class _Named(TomlTable):
    name: Annotated[str, Described("a name, in quotes", form=PLAIN)] = ""


if TYPE_CHECKING:
    _OfKinds = _Named
else:
    _OfKinds = create_model(
        "_OfKinds",
        __base__=_Named,
        **{kind: (Annotated[table | None, _TABLE_KEY], None) for kind, table in KINDS.items()},
    )


class StructureEntry(_OfKinds):
    """A structure with its name, leaning mass, yielding stories, its place on the base, and its elements.

    Of the kinds of structures one is a table, and the others are None.

    Attributes
    ----------
    name : str
        Empty where none was given.
    leaning_masses : float, list or None
        In kg, of each floor; None if all mass stands on the base.
    stories : StoriesTable or None
        None if no story yields.
    podium : PodiumTable or None
        None if no columns rock under it.
    joints : JointsTable or None
        None if it rocks at its base alone.
    eccentricity : float or None
        In m; None in the middle of the base.
    one_sided : OneSidedTable or None
        None if it opens to both sides.
    elements : list of tables, one of each element
        None if there are none.
    """

    gone = {"tendons": 'Write each tendon as a table [[elements]] with kind = "tendon".'}  # noqa: RUF012

    leaning_masses: Annotated[
        float | list[float] | None,
        Described("the mass of each floor that stands on other columns", "kg", form=one_for_each("floor")),
    ] = None
    stories: Annotated[
        StoriesTable | None,
        Described("a table", label="Stories that yield", form=PLAIN, page="the shear at which they yield"),
    ] = None
    podium: Annotated[
        PodiumTable | None,
        Described("a table", label="Podium", form=PLAIN, page="columns under it that rock together"),
    ] = None
    joints: Annotated[
        JointsTable | None,
        Described("a table", label="Joints above the base", form=PLAIN, page="where it rocks besides its base"),
    ] = None
    eccentricity: Eccentricity = None
    one_sided: Annotated[
        OneSidedTable | None,
        Described("a table", label="One-sided", form=PLAIN, page="the wall behind it, so that it opens to one side"),
    ] = None
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
        if self.leaning_masses is not None:
            built = _built_from_key("leaning_masses", lambda: Leaning(_floors_of(built), self.leaning_masses or 0.0))
        if (stories := self.stories) is not None:
            built = _built_from_key("stories", lambda: YieldingStories(_floors_of(built), **stories.model_dump()))
        if (podium := self.podium) is not None:
            built = _built_from_key("podium", lambda: Podium(_floors_of(built), **podium.model_dump()))
        if (joints := self.joints) is not None:
            built = _built_from_key("joints", lambda: Jointed(_floors_of(built), joints_at(**joints.model_dump())))
        if self.eccentricity:
            e = self.eccentricity
            built = replace(built, eccentricity=e) if isinstance(built, RockingProperties) else Eccentric(built, e)
        if (one_sided := self.one_sided) is not None:
            built = _built_from_key("one_sided", lambda: OneSided(built, **one_sided.model_dump()))
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
        return (
            replace(built, elements=elements) if isinstance(built, RockingProperties) else Restrained(built, elements)
        )

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
        more: dict[str, Any] = {} if self.leaning_masses is None else {"leaning_masses": self.leaning_masses}
        more |= {"stories": self.stories.model_dump()} if self.stories else {}
        more |= {"podium": self.podium.model_dump()} if self.podium else {}
        more |= {"joints": self.joints.model_dump()} if self.joints else {}
        more |= {"eccentricity": self.eccentricity} if self.eccentricity else {}
        more |= {"one_sided": self.one_sided.model_dump()} if self.one_sided else {}
        more |= {"elements": [each.describe() for each in self.elements]} if self.elements else {}
        return {**self.table.values(), **more}


def _floors_of(built: Built) -> Structure:
    if isinstance(built, RockingProperties):
        raise InputError(
            "Leaning masses, stories that yield, podiums and joints need floors, which a [properties] or [block] table "
            "does not have. Use [frame], [fish_bone] or [lumped]; the leaning mass of [properties] is its key "
            "leaning_mass.",
            field="structure",
        )
    return built


def _built_from_key(key: str, make: Callable[[], Built]) -> Built:
    try:
        return make()
    except InputError as error:
        place = f"[{key}]" if key in ("stories", "podium", "joints", "one_sided") else key
        inner = key if error.field in ("", "masses", "structure") or key == "leaning_masses" else f"{key}.{error.field}"
        raise InputError(str(error), place=place, field=inner) from error
