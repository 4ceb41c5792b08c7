"""A structure in a TOML file: leaning mass, stories that yield, its place on the base, and its elements."""

import tomllib
from collections.abc import Callable, Iterable
from dataclasses import MISSING, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, TypeAlias, Union, get_origin, get_type_hints

from pydantic import Field, SerializerFunctionWrapHandler, create_model, model_serializer, model_validator

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file, checked_file_path, unicode_text
from rockflex.foundation.registry import registered_objects, source_checksum
from rockflex.foundation.schema import NUMBER, PLAIN, WHOLE, Eccentricity, SchemaKey, one_for_each
from rockflex.foundation.shown import shortened
from rockflex.structure._attachment import PLACE
from rockflex.structure._devices import STEELS, STRANDS, bar_fuse, strand_tendon, u_plate_fuse
from rockflex.structure._element_law import ElementLaw
from rockflex.structure._elements import BaseElement, FrictionDamper, Tendon, ViscousDamper, YieldingDissipator
from rockflex.structure._from_matrices import matrix_file_checksum
from rockflex.structure._law_bars import BARS
from rockflex.structure._leaning import Leaning
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Eccentric, Restrained, Structure
from rockflex.structure._yielding_stories import YieldingStories
from rockflex.structure.file._object_tables import CLASS, structure_from_table
from rockflex.structure.file._structure_tables import (
    BeamTable,
    Built,
    CantileverTable,
    FishBoneTable,
    FrameTable,
    LumpedStructureTable,
    MatricesTable,
    ModesTable,
    RigidBlockTable,
    RockingPropertiesTable,
    StructureTable,
    TaperedTowerTable,
    WallFrameTable,
)
from rockflex.structure.file._toml_table import (
    AnyTable,
    TomlTable,
    first_table_in_annotation,
    members_of_annotation,
    parse_toml_table,
)

_POST_YIELD_RATIO = "the stiffness after yielding over the elastic one"
_POSITION = SchemaKey("the distance to the right of the axis of the masses", "m")
LAWS: dict[str, type[ElementLaw]] = BARS | registered_objects("elements")
_DEVICES = ("strand_tendon", "bar_fuse", "u_plate_fuse")
_ELEMENT_KINDS = ("tendon", "yielding_dissipator", "viscous_damper", "friction_damper", *_DEVICES, *LAWS)
_ELEMENT_KIND = SchemaKey(
    ", ".join(f'"{kind}"' for kind in _ELEMENT_KINDS[:-1]) + f' or "{_ELEMENT_KINDS[-1]}"', form=PLAIN
)
_TABLE_KEY = SchemaKey("a table", form=PLAIN)
_RUN_KEYS = ("impact", "restitution", "bouc_wen", "ground", "report")  # only for `rockflex run`


class ElementTable(TomlTable):
    """A table that is an element; `title` is its name in a list, and a key `kind` is no argument."""

    makes: ClassVar[Callable[..., BaseElement]]
    title: ClassVar[str]
    tuples: ClassVar[tuple[str, ...]] = ()  # keys whose lists are tuples in the element, which sees to that itself

    between: Annotated[
        list[int] | None,
        SchemaKey("the two floors that it connects, in place of a position", form="{}, such as [0, 2]; 0 is the base"),
    ] = None
    cosine: Annotated[
        float, SchemaKey("the cosine of its inclination between floors or from a height, negative to the other side")
    ] = 1.0
    height: Annotated[
        float | None, SchemaKey("the height of a tie to the ground, in place of a position", "m", label="Tie at height")
    ] = None

    def element(self) -> BaseElement:
        """Return the element.

        Raises
        ------
        InputError
            If a value is outside its range, or the values contradict each other.
        """
        values = self.model_dump(exclude={"kind"})
        return type(self).makes(**{name: value for name, value in values.items() if value is not None})

    def describe(self) -> dict[str, Any]:
        """Return the given values, and the defaults of the others."""
        return self.model_dump(exclude_none=True)

    @model_serializer(mode="wrap")
    def _serialized(self, serialize: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Return the values; an element under the base has no direction."""
        found: dict[str, Any] = serialize(self)
        if self.between is None and self.height is None:
            found.pop("cosine", None)
        return found


class TendonTable(ElementTable):
    """The arguments of `Tendon`."""

    makes = Tendon
    title = "Tendon"

    position: Annotated[float, _POSITION] = 0.0
    initial_force: Annotated[float, SchemaKey("the force while the base stands on the ground", "N")]
    stiffness: Annotated[float, SchemaKey("EA/L over the unbonded length", "N/m")]
    yield_force: Annotated[float | None, SchemaKey("the force at which the tendon yields", "N")] = None
    post_yield_ratio: Annotated[float | None, SchemaKey(f"{_POST_YIELD_RATIO} (default: the tendon stays elastic)")] = (
        None
    )
    rupture_elongation: Annotated[
        float | None, SchemaKey("the elongation at which a tendon that yields breaks", "m")
    ] = None


class _TendonKindKey(TomlTable):
    kind: Annotated[Literal["tendon"], _ELEMENT_KIND]


class TendonElementTable(TendonTable, _TendonKindKey):
    """A tendon among the elements."""


class YieldingDissipatorTable(ElementTable):
    """The arguments of `YieldingDissipator`."""

    makes = YieldingDissipator
    title = "Yielding dissipator"

    kind: Annotated[Literal["yielding_dissipator"], _ELEMENT_KIND]
    position: Annotated[float, _POSITION] = 0.0
    stiffness: Annotated[float, SchemaKey("the elastic stiffness", "N/m")]
    yield_force: Annotated[float, SchemaKey("the force at which the fuse yields", "N")]
    post_yield_ratio: Annotated[float, SchemaKey(_POST_YIELD_RATIO)] = 0.0
    tension_only: Annotated[bool, SchemaKey("whether the fuse cannot push", form="true or false: {}")] = False
    rupture_elongation: Annotated[float | None, SchemaKey("the elongation at which the fuse breaks", "m")] = None


class ViscousDamperTable(ElementTable):
    """The arguments of `ViscousDamper`."""

    makes = ViscousDamper
    title = "Viscous damper"

    kind: Annotated[Literal["viscous_damper"], _ELEMENT_KIND]
    position: Annotated[float, _POSITION] = 0.0
    coefficient: Annotated[float, SchemaKey("the force over the velocity", "N s/m")]


class FrictionDamperTable(ElementTable):
    """The arguments of `FrictionDamper`."""

    makes = FrictionDamper
    title = "Friction damper"

    kind: Annotated[Literal["friction_damper"], _ELEMENT_KIND]
    position: Annotated[float, _POSITION] = 0.0
    force: Annotated[float, SchemaKey("the force at which the damper slides", "N")]


def _names(catalogue: Iterable[str]) -> str:
    return ", ".join(f'"{name}"' for name in catalogue)


_Steel: TypeAlias = Annotated[Literal[tuple(STEELS)], SchemaKey(f"a steel: {_names(STEELS)}", form=PLAIN)]  # pyright: ignore
_Strand: TypeAlias = Annotated[Literal[tuple(STRANDS)], SchemaKey(f"a strand: {_names(STRANDS)}", form=PLAIN)]  # pyright: ignore


class StrandTendonTable(ElementTable):
    """The arguments of `strand_tendon`."""

    makes = strand_tendon
    title = "Tendon of strands"

    kind: Annotated[Literal["strand_tendon"], _ELEMENT_KIND]
    position: Annotated[float, _POSITION] = 0.0
    n: Annotated[int, SchemaKey("the number of strands", form=WHOLE, low=1, high=10_000)]
    strand: _Strand
    length: Annotated[float, SchemaKey("the free length", "m")]
    prestress: Annotated[float, SchemaKey("the force at rest over the breaking force", low=0.0, high=0.9)]
    post_yield_ratio: Annotated[float | None, SchemaKey(f"{_POST_YIELD_RATIO} (default: the tendon stays elastic)")] = (
        None
    )
    ultimate_strain: Annotated[float | None, SchemaKey("the strain at which a tendon that yields breaks")] = None


class BarFuseTable(ElementTable):
    """The arguments of `bar_fuse`."""

    makes = bar_fuse
    title = "Fuse of steel bars"

    kind: Annotated[Literal["bar_fuse"], _ELEMENT_KIND]
    position: Annotated[float, _POSITION] = 0.0
    n: Annotated[int, SchemaKey("the number of bars", form=WHOLE, low=1, high=10_000)]
    diameter: Annotated[float, SchemaKey("the diameter of a bar where it yields", "m")]
    length: Annotated[float, SchemaKey("the length that yields", "m")]
    steel: _Steel
    tension_only: Annotated[bool, SchemaKey("whether the bars cannot push", form="true or false: {}")] = False
    ultimate_strain: Annotated[
        float | None, SchemaKey("the strain at which the bars break (default: that of the steel)")
    ] = None


class UPlateFuseTable(ElementTable):
    """The arguments of `u_plate_fuse`."""

    makes = u_plate_fuse
    title = "U-shaped flexural plates"

    kind: Annotated[Literal["u_plate_fuse"], _ELEMENT_KIND]
    position: Annotated[float, _POSITION] = 0.0
    n: Annotated[int, SchemaKey("the number of plates", form=WHOLE, low=1, high=10_000)]
    width: Annotated[float, SchemaKey("the width of a plate", "m")]
    thickness: Annotated[float, SchemaKey("the thickness of a plate", "m")]
    diameter: Annotated[float, SchemaKey("the diameter of the bend, between the middles of the legs", "m")]
    steel: _Steel
    post_yield_ratio: Annotated[float, SchemaKey(_POST_YIELD_RATIO)] = 0.0


_FORMS = {
    float: NUMBER,
    int: WHOLE,
    bool: "true or false: {}",
    str: "{}, a text in quotes",
    list[float]: "{}, a list of numbers{unit}",
}


def registered_table(made: Any, base: type[AnyTable], **more: Any) -> type[AnyTable]:
    """Return the table of a class, a dataclass, from its fields.

    The metadata of a field may hold its "description", its "unit", and the least and largest number that the page
    accepts, "low" and "high".
    """
    hints = get_type_hints(made)
    keys: dict[str, Any] = {}
    for part in fields(made):
        if not part.init or part.name in base.model_fields:
            continue
        kind = list[float] if get_origin(hints[part.name]) is tuple else hints[part.name]
        first = members_of_annotation(kind)[0]
        said: dict[str, Any] = {"description": part.name, "form": _FORMS.get(first, PLAIN), **part.metadata}
        default: Any = ... if part.default is MISSING else part.default
        if part.default_factory is not MISSING:
            default = Field(default_factory=part.default_factory)
        keys[part.name] = Annotated[kind, SchemaKey(**said)], default
    found: Any = create_model(f"{made.__name__}Table", __base__=base, **keys, **more)
    found.makes, found.title = made, getattr(made, "title", "") or made.__name__
    found.tuples = tuple(name for name in keys if get_origin(hints[name]) is tuple)
    return found


def _element_table(kind: str, law: type[ElementLaw]) -> type[ElementTable]:
    return registered_table(law, ElementTable, kind=(Annotated[Literal[kind], _ELEMENT_KIND], ...))


ELEMENTS: dict[str, type[ElementTable]] = {
    "tendon": TendonElementTable,
    "yielding_dissipator": YieldingDissipatorTable,
    "viscous_damper": ViscousDamperTable,
    "friction_damper": FrictionDamperTable,
    "strand_tendon": StrandTendonTable,
    "bar_fuse": BarFuseTable,
    "u_plate_fuse": UPlateFuseTable,
    **{kind: _element_table(kind, law) for kind, law in LAWS.items()},
}
"""The table of each kind of element by its name in a file."""

ELEMENT_NAMES = {table: kind for kind, table in ELEMENTS.items()}

AnyElementTable: TypeAlias = Annotated[Union[tuple(ELEMENTS.values())], Field(discriminator="kind")]  # pyright: ignore # noqa: UP007
"""The table of any element, chosen by its `kind`."""


class StoriesTable(TomlTable):
    """The arguments of `YieldingStories`."""

    strengths: Annotated[
        float | list[float], SchemaKey("the shear at which a story yields first", "N", form=one_for_each("story"))
    ]
    post_yield_ratio: Annotated[float | list[float], SchemaKey(_POST_YIELD_RATIO, form=one_for_each("story"))] = 0.0


class _OwnStructures(TomlTable):
    """A structure, with its name, leaning mass, yielding stories, its place on the base, and its elements.

    Attributes
    ----------
    name : str
        Empty where none was given.
    frame, fish_bone, wall_frame, tapered_tower, cantilever, beam, lumped, matrices, modes, properties, block
        One of them is a table, the others are None.
    leaning_masses : float, list or None
        In kg, of each floor; None if all mass stands on the base.
    stories : StoriesTable or None
        None if no story yields.
    eccentricity : float or None
        In m; None in the middle of the base.
    tendons : list of TendonTable
        May be empty.
    elements : list of tables, one of each element
        None if there are none. They follow the tendons.
    """

    name: Annotated[str, SchemaKey("a name, in quotes", form=PLAIN)] = ""
    frame: Annotated[FrameTable | None, _TABLE_KEY] = None
    fish_bone: Annotated[FishBoneTable | None, _TABLE_KEY] = None
    wall_frame: Annotated[WallFrameTable | None, _TABLE_KEY] = None
    tapered_tower: Annotated[TaperedTowerTable | None, _TABLE_KEY] = None
    cantilever: Annotated[CantileverTable | None, _TABLE_KEY] = None
    beam: Annotated[BeamTable | None, _TABLE_KEY] = None
    lumped: Annotated[LumpedStructureTable | None, _TABLE_KEY] = None
    matrices: Annotated[MatricesTable | None, _TABLE_KEY] = None
    modes: Annotated[ModesTable | None, _TABLE_KEY] = None
    properties: Annotated[RockingPropertiesTable | None, _TABLE_KEY] = None
    block: Annotated[RigidBlockTable | None, _TABLE_KEY] = None
    leaning_masses: Annotated[
        float | list[float] | None,
        SchemaKey("the mass of each floor that stands on other columns", "kg", form=one_for_each("floor")),
    ] = None
    stories: Annotated[
        StoriesTable | None,
        SchemaKey("a table", label="Stories that yield", form=PLAIN, page="the shear at which they yield"),
    ] = None
    eccentricity: Eccentricity = None
    tendons: Annotated[
        list[TendonTable], SchemaKey("a list of tables, each under a heading [[tendons]]", form=PLAIN)
    ] = Field(default_factory=list[TendonTable])
    elements: Annotated[
        list[AnyElementTable] | None, SchemaKey("a list of tables, each under a heading [[elements]]", form=PLAIN)
    ] = None  # not an empty list, which would be new in the documents of stored studies

    @model_validator(mode="after")
    def _one_structure(self) -> Self:
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
        if self.leaning_masses is not None:
            built = _wrapped("leaning_masses", lambda: Leaning(_floors_of(built), self.leaning_masses or 0.0))
        if (stories := self.stories) is not None:
            built = _wrapped("stories", lambda: YieldingStories(_floors_of(built), **stories.model_dump()))
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
            except InputError as error:  # it is outside the base, or at no floor
                name = error.field if error.field in PLACE else "position"
                raise InputError(str(error), place=f"[[{key}]] no. {place}", field=f"{row}.{name}") from error
        return replace(built, elements=elements) if known else Restrained(built, elements)

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
        more |= {"eccentricity": self.eccentricity} if self.eccentricity else {}
        for key, tables in (("tendons", self.tendons), ("elements", self.elements)):
            if tables:
                more[key] = [each.describe() for each in tables]
        return {**self.table.values(), **more}


def _floors_of(built: Built) -> Structure:
    if isinstance(built, RockingProperties):
        raise InputError(
            "Leaning masses and stories that yield need floors, which a [properties] or [block] table does not have. "
            "Use [frame], [fish_bone] or [lumped]; the leaning mass of [properties] is its key leaning_mass.",
            field="structure",
        )
    return built


def _wrapped(key: str, make: Callable[[], Built]) -> Built:
    try:
        return make()
    except InputError as error:
        place = f"[{key}]" if key == "stories" else key
        inner = key if error.field in ("", "masses", "structure") or key == "leaning_masses" else f"{key}.{error.field}"
        raise InputError(str(error), place=place, field=inner) from error


if TYPE_CHECKING:
    StructureEntry = _OwnStructures
else:
    StructureEntry = create_model(
        "StructureEntry",
        __base__=_OwnStructures,
        __doc__=_OwnStructures.__doc__,
        __module__=__name__,
        **{
            kind: (Annotated[registered_table(made, StructureTable) | None, _TABLE_KEY], None)
            for kind, made in registered_objects("structures").items()
        },
    )

KINDS: dict[str, type[StructureTable]] = {
    name: table
    for name, field in StructureEntry.model_fields.items()
    if issubclass(table := first_table_in_annotation(field.annotation) or TomlTable, StructureTable)
}
"""The table of each kind of structure by its name in a file."""


def read_structure(path: str | Path) -> Built:
    """Return the structure of a TOML file, the same file that the command line reads.

    The file holds one table, whose keys are the arguments of the class: ``[frame]`` (`Frame`), ``[fish_bone]``
    (`FishBone`), ``[wall_frame]`` (`WallFrame`), ``[tapered_tower]`` (`TaperedTower`), ``[cantilever]``
    (`CantileverWithTipMass`), ``[beam]`` (`Beam`, with lists of values at the heights ``z``), ``[lumped]``
    (`LumpedStructure`), ``[matrices]`` (`from_matrices`), ``[modes]`` (`from_modes`), ``[properties]``
    (`RockingProperties`) or ``[block]`` (`rigid_block`). Tables ``[[elements]]`` restrain it; their key ``kind`` is
    "tendon" (`Tendon`), "yielding_dissipator" (`YieldingDissipator`), "viscous_damper" (`ViscousDamper`),
    "friction_damper" (`FrictionDamper`), "strand_tendon" (`strand_tendon`), "bar_fuse" (`bar_fuse`), "u_plate_fuse"
    (`u_plate_fuse`), "flag_shaped_bar" (`FlagShapedBar`), "gap_bar" (`GapBar`), "multilinear_bar"
    (`MultilinearBar`), or the name that another package registers (`ElementLaw`). Tables ``[[tendons]]`` are tendons
    without that key. In place of a ``position`` an element takes ``between`` (two floors) or the ``height`` of a tie,
    with a ``cosine`` (`Attachment`). ``leaning_masses`` above all tables is mass on other columns (`Leaning`), a table
    ``[stories]`` with ``strengths`` and ``post_yield_ratio`` makes stories yield (`YieldingStories`), and a number
    ``eccentricity`` moves the structure from the middle of its base
    (`Eccentric`). Units are kg, m, s, N and rad; paths of matrices are relative to the folder of the file. A file of a
    `Project` has the key ``class`` above all tables, the name of the class, and its arguments.

    Parameters
    ----------
    path
        The file. The keys ``impact``, ``restitution``, ``[bouc_wen]``, ``[ground]`` and ``[report]`` are for ``rockflex
        run`` and are ignored; in Python they are arguments of `simulate` and `write_report`.

    Returns
    -------
    Frame, Beam, ..., Eccentric, Restrained or RockingProperties

    Raises
    ------
    InputError
        If the file cannot be read, a key is unknown or missing, or a value is wrong; the message names file, table
        and key.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> length = Path("block.toml").write_text("block = { slenderness = 0.2, half_diagonal = 2.5, mass = 5e3 }")
    >>> round(rf.read_structure("block.toml").resisting_moment)  # m g b in N m
    24362
    """
    file = checked_file_path("path", path)
    content = {key: value for key, value in read_toml_file(file, "structure").items() if key not in _RUN_KEYS}
    if "study" in content:
        raise InputError(f"{file} is the file of a study, but one of a structure is expected. Use load_study(path).")
    if CLASS in content:
        return structure_from_table(content, str(file))
    return build_structure_in_file(file, parse_toml_table(StructureEntry, content, str(path)))


def read_toml_file(file: Path, kind: str) -> dict[str, Any]:
    """Return the content of a TOML file; `kind` names its expected content in messages.

    Raises
    ------
    InputError
        If the file cannot be read, is not a regular file, or is not TOML.
    """
    check_regular_file(checked_file_path("path", file))
    try:
        return tomllib.loads(unicode_text(file.read_bytes()))
    except FileNotFoundError as error:
        raise InputError(f"The {kind} file {file} does not exist (working directory: {Path.cwd()}).") from error
    except OSError as error:
        raise InputError(f"The {kind} file {file} cannot be read: {error.strerror}.") from error
    except ValueError as error:  # not TOML, or in another encoding
        hint = " Save it as UTF-8." if isinstance(error, UnicodeDecodeError) else ""
        raise InputError(f"{file} is not a valid TOML file: {shortened(str(error))}.{hint}") from error
    except RecursionError as error:
        raise InputError(
            f"{file} is nested too deep to be read: brackets within brackets, more than any {kind} has."
        ) from error


def build_structure_in_file(file: Path, entry: StructureEntry) -> Built:
    """Build the structure of a file, which messages name.

    Raises
    ------
    InputError
        As `StructureEntry.build`.
    """
    try:
        return entry.build(file.parent)
    except InputError as error:
        raise InputError(f"{file}, {error}") from error
