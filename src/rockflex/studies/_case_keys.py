"""The keys that a case and every study share: structures, records, models, and the options of the runs."""

import os
from collections.abc import Callable, Mapping
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, cast

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    InstanceOf,
    PrivateAttr,
    ValidationError,
    ValidatorFunctionWrapHandler,
    field_validator,
)

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path, write_given_file
from rockflex.foundation.json import as_json_value
from rockflex.foundation.schema import IMPACT, ImpactSchema, LawName, ReportKeys
from rockflex.foundation.shown import shown
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import LAWS, ImpactLaw, law_of_name, unused_restitution_error
from rockflex.models._label import Model, parse_model
from rockflex.motion._columns import record_csv
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._suite import Selection, Suite
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._object_tables import CLASS, structure_from_table
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._structure_file import build_structure_in_file, read_toml_file
from rockflex.structure.file._structure_tables import Built
from rockflex.structure.file._toml_table import TomlTable, parse_toml_table, table_of, toml_problem_sentences
from rockflex.studies._arguments import (
    check_run_options,
    checked_motions,
    checked_scale_factors,
    expand_scale_range,
    free_vibration_time,
    rocking_properties_of,
)
from rockflex.studies._ground_tables import GivenGround, GroundTable
from rockflex.studies._objects import (
    Given,
    function_document,
    impact_law_document,
    object_checksum,
    object_document,
    object_in_file,
    option_of_file,
)
from rockflex.studies._record_tables import GivenRecords, Moved, Records, numbered_file_name, record_row
from rockflex.studies.running import WORK_LIMIT, checked_work_limit

if TYPE_CHECKING:
    BoucWenTable = TomlTable
else:
    BoucWenTable = table_of(BoucWen, TomlTable, __name__)


class RunOptionKeys(ImpactSchema, TomlTable):
    """The options of a run that files, links and forms share: impact law, hysteresis and ground.

    By default each model has its own law, nothing yields, and the base cannot slide on rigid ground.

    In Python `impact` may also be any `ImpactLaw`, in place of a name.
    """

    impact: Annotated[LawName | InstanceOf[ImpactLaw] | None, IMPACT] = None  # pyright: ignore[reportIncompatibleVariableOverride]
    bouc_wen: Annotated[BoucWenTable | None, Described("a table", form=PLAIN)] = None
    ground: Annotated[GroundTable | None, Described("a table", form=PLAIN)] = None

    @field_validator("impact", mode="before")
    @classmethod
    def _law(cls, given: object) -> object:
        if not isinstance(given, str | int | float | list | dict | None):  # not a value that a file can hold
            check_run_options(None, given)  # pyright: ignore[reportArgumentType]
        return given

    def law(self) -> ImpactLaw | None:
        """Return the impact law; None for the model's own."""
        if isinstance(self.impact, str):
            if self.impact not in LAWS:  # a copy with another law was not checked
                raise InputError(f"impact must be {IMPACT.expected}, but {shown(self.impact)} was given.")
            return law_of_name(self.impact, self.restitution)
        if self.restitution is not None:
            raise unused_restitution_error(
                self.restitution, "the model's own" if self.impact is None else shown(self.impact)
            )
        if self.impact is None:
            return None
        check_run_options(None, self.impact)
        return self.impact

    def hysteresis(self) -> BoucWen | None:
        """Return the hysteresis; None if nothing yields."""
        return None if self.bouc_wen is None else BoucWen(**self.bouc_wen.model_dump())

    def ground_rule(self) -> Callable[[RockingProperties], Ground] | None:
        """Return the function that gives each structure its ground; None for rigid ground without sliding."""
        return None if self.ground is None else self.ground.under


class ReportHeadTable(ReportKeys, TomlTable):
    """The head of a report, and whether further sheets follow."""

    appendix: Annotated[
        bool, Described("whether cross-sections and loops of elements follow", form="true or false: {}")
    ] = False


class StructureFile(RunOptionKeys, StructureEntry):
    """A structure file: one structure, optionally a name and elements, and options of its runs."""

    report: Annotated[ReportHeadTable | None, Described("a table", form=PLAIN)] = None


def structure_in_file(path: Path) -> tuple[Built, StructureFile | None]:
    """Return the structure of a file, and the file's content; None for the arguments of a class.

    Raises
    ------
    InputError
        As `read_structure`.
    """
    content = read_toml_file(path, "structure")
    if CLASS in content:
        return structure_from_table(content, str(path)), None
    if "structures" in content or "study" in content:
        raise InputError(f"{path} is a case or a study, but the file of one structure is expected.")
    found = parse_toml_table(StructureFile, content, str(path))
    return build_structure_in_file(path, found), found


def impact_law_name(law: ImpactLaw) -> str:
    """Return the name of an impact law of the package in a file."""
    return next(name for name, kind in LAWS.items() if type(law) is kind)


def validator_of_check(check: Callable[[Any], object]) -> AfterValidator:
    """Return a validator that raises what `check` raises, and keeps the value as it is."""

    def checked(value: Any) -> Any:
        check(value)
        return value

    return AfterValidator(checked)


FreeVibration = Annotated[
    float | Literal["settle"],
    Field(description='the free vibration after the record, a number in s or "settle"'),
    validator_of_check(free_vibration_time),
]


class ObjectOptionKeys(RunOptionKeys):
    """The options of a run, which may be objects of Python, and in a file tables with the name of their class."""

    @field_validator("impact", mode="before")
    @classmethod
    def _law_of_class(cls, given: Any) -> Any:
        return option_of_file("impact", given) if _names_class(given) else given

    @field_validator("bouc_wen", mode="before")
    @classmethod
    def _hysteresis(cls, given: Any) -> Any:
        found = option_of_file("bouc_wen", given) if _names_class(given) else given
        return asdict(found) if isinstance(found, BoucWen) else found

    @field_validator("ground", mode="wrap")
    @classmethod
    def _given_ground(cls, given: Any, table: ValidatorFunctionWrapHandler) -> Any:
        found = option_of_file("ground", given) if _names_class(given) else given
        if isinstance(found, Ground) or callable(found):
            return GivenGround.model_construct(given=found)
        return table(found)


def _names_class(given: Any) -> bool:
    return isinstance(given, Mapping) and CLASS in given


QUIET = GroundMotion([0.0, 0.0, 0.0], 1.0)
Factors = Annotated[
    list[float],
    BeforeValidator(expand_scale_range),
    Field(
        min_length=1,
        description="a list of factors on the acceleration, or a range such as "
        "{smallest = 0.5, largest = 3.0, step = 0.25}",
    ),
    AfterValidator(lambda scales: checked_scale_factors(scales, QUIET)),
]


class CaseKeys(TomlTable):
    """A name, records, and what one run may take: with the file that has them, and the file that they are written to.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is wrong; the message lists them all.
    """

    name: str = Field("", description="a name, in quotes")
    records: Records = Field(description="a table of suites, a folder or files")
    work_limit: Annotated[float | Literal["none"], validator_of_check(checked_work_limit)] = Field(
        WORK_LIMIT, description='the most computing that one run may take, a number in s or "none"'
    )

    _folder: Path = PrivateAttr(default_factory=Path)
    _file: Path | None = PrivateAttr(default=None)

    def __init__(self, **content: Any) -> None:
        try:
            super().__init__(**content)
        except ValidationError as error:
            raise InputError(" ".join(toml_problem_sentences(error, content, type(self)))) from error

    @field_validator("records", mode="wrap")
    @classmethod
    def _motions(cls, given: Any, table: ValidatorFunctionWrapHandler) -> Any:
        items = list(given.values()) if isinstance(given, Mapping) else given
        several = isinstance(items, list | tuple | Suite) and any(isinstance(each, GroundMotion) for each in items)
        if not several and not isinstance(given, GroundMotion | Selection):
            return table(given)
        suite = given if isinstance(given, Suite) else Suite(checked_motions(given))
        return GivenRecords.model_construct(given=suite)

    @field_validator("work_limit", mode="before")
    @classmethod
    def _no_limit(cls, given: object) -> object:
        return "none" if given is None else given

    def document(self) -> dict[str, Any]:
        """Return all that determines the study as plain JSON: infinite numbers are "inf", and None is left out.

        Raises
        ------
        InputError
            If an object of Python holds what is not plain JSON.
        """
        given: Any = self
        objects = {name: _document_of_object(name, value) for name, value in given}
        objects = {name: value for name, value in objects.items() if value is not None}
        return as_json_value(self.model_dump(exclude={*objects}, exclude_none=True)) | objects

    def to_toml(self) -> str:
        """Return the text of a file with everything that was given; paths are as they were given.

        Raises
        ------
        InputError
            If the records, a function or an impact law were given in Python, and no text can hold them.
        """
        if isinstance(self.records, GivenRecords):
            raise InputError(
                "The records were given in Python, and a text holds no samples. Use write(path), which writes each to "
                "a CSV file, or name suites or files: records={'files': ['quake.AT2']}.",
                field="records",
            )
        return _toml(self._in_file(key_in_file("records", self.records)))

    def write(self, path: str | Path) -> Path:
        """Write everything that was given to a file of TOML, and return its path.

        Records of Python are written to CSV files in a folder beside it. Paths of other files start from its folder.

        Raises
        ------
        InputError
            If a function or an impact law was given in Python that no file can hold, or the path cannot be written to.
        """
        file = checked_file_path("path", path)
        moved, beside = self._moved(_path_from_folder(self._folder, file.parent)), dict[str, GroundMotion]()
        if isinstance(self.records, GivenRecords):
            for place, motion in enumerate(self.records.given, 1):
                beside[f"{file.stem}-records/{numbered_file_name(place, motion.name, '.csv')}"] = motion
            records = {"files": [record_row(*each) for each in beside.items()]}
        else:
            records = key_in_file("records", moved.records)
        text = _toml(moved._in_file(records))  # before anything is written
        for name, motion in beside.items():
            target = file.parent / name
            try:
                target.parent.mkdir(exist_ok=True)
            except OSError as error:
                raise InputError(f"{target.parent} cannot be made: {error.strerror}.", field="path") from error
            write_given_file(target, record_csv(motion).encode())
        return write_given_file(file, text.encode())

    def _in_file(self, records: Any) -> dict[str, Any]:
        """Return the keys of a file: those that were given, and the kind of a study."""
        given: Any = self
        found: dict[str, Any] = {name: value for name, value in given if value is not None}
        named = {name: value for name, value in found.items() if name in self.model_fields_set or name == "study"}
        plain = {name: key_in_file(name, value) for name, value in named.items() if name != "records"}
        tables = {name: value for name, value in plain.items() if isinstance(value, dict | list)}
        return {name: value for name, value in plain.items() if name not in tables} | {"records": records} | tables

    def _moved(self, path: Moved) -> Self:
        """Return the same with its paths from another folder."""
        return self.model_copy(update={"records": self.records.moved(path)})

    @property
    def file(self) -> Path | None:
        """The file that the study was read from, if any."""
        return self._file

    def read_from(self, folder: Path, file: Path | None = None) -> Self:
        """Let relative paths start from a folder instead of the working directory, and return the study."""
        self._folder, self._file = folder, file
        return self


def key_in_file(name: str, value: Any) -> Any:
    """Return the value of a key in a file."""
    if isinstance(value, list):
        return [key_in_file(name, each) for each in cast("list[Any]", value)]
    if hasattr(value, "in_file"):
        return value.in_file()
    if isinstance(value, TomlTable):
        return value.model_dump(exclude_unset=True, exclude_none=True)
    if callable(value) or isinstance(value, Mapping):
        raise InputError(
            f"{name} was given as a function of Python, which no file can hold. Leave it out, or give a table.",
            field=name,
        )
    return object_in_file(name, value)


def _toml(keys: dict[str, Any]) -> str:
    import tomli_w

    return tomli_w.dumps(keys)


def _path_from_folder(old: Path, new: Path) -> Moved:
    """Return the function that lets a path relative to one folder start from another."""

    def moved(path: str) -> str:
        given = Path(path)
        if given.is_absolute() or old.resolve() == new.resolve():
            return path
        target = (old / given).resolve()
        try:
            return Path(os.path.relpath(target, new.resolve())).as_posix()
        except ValueError:  # on another drive of Windows
            return str(target)

    return moved


def _document_of_object(name: str, value: Any) -> Any:
    """Return what the document of a study has for an object of Python in one of its fields; None for plain values."""
    if isinstance(value, Given):
        return value.document()
    if isinstance(value, list):
        entries = cast("list[Any]", value)
        return [_entry_document(each) for each in entries] if any(isinstance(each, Given) for each in entries) else None
    if isinstance(value, ImpactLaw):
        return impact_law_document(value)
    if name == "demands" and value:
        return {each: function_document(f"demands.{each}", function) for each, function in value.items()}
    if isinstance(value, Ground):
        return object_document(name, value)
    return function_document(name, value) if callable(value) else None


def _entry_document(entry: Any) -> Any:
    return entry.document() if isinstance(entry, Given) else as_json_value(entry.model_dump(exclude_none=True))


class GivenStructure(StructureEntry, Given):
    """A structure in the place of a table."""

    given: Any

    def build(self, folder: Path | str = "") -> Any:  # noqa: ARG002
        """Return the structure."""
        return self.given

    def checksums(self, folder: Path | str = "") -> dict[str, str]:  # noqa: ARG002
        """Return the SHA-256 of the modules of its elements that are not of rockflex."""
        kinds = dict.fromkeys(type(each) for each in rocking_properties_of(self.given).elements)
        return {key: value for kind in kinds for key, value in object_checksum("element", kind).items()}

    def moved(self, path: Moved) -> Self:  # noqa: ARG002
        """Return the same structure."""
        return self

    def in_file(self) -> dict[str, Any]:
        """Return its name, and the table of its class."""
        name = {"name": self.name} if self.name else {}
        return {**name, "object": object_in_file("structures", self.given)}

    def document(self) -> dict[str, Any]:
        """Return its name, and what determines it."""
        return {"name": self.name, "given": object_document("structures", self.given)}


class FileStructure(StructureEntry, Given):
    """A structure file in the place of a table."""

    file: Annotated[str, Described("the path of a structure file, in quotes", form=PLAIN)]

    @property
    def elsewhere(self) -> str:
        """The key that holds the structure in place of a table."""
        return "file"

    def build(self, folder: Path | str = "") -> Built:
        """Build the structure.

        Raises
        ------
        InputError
            As `read_structure`, or if the file has options of runs, which a study has for all its structures.
        """
        built, found = structure_in_file(Path(folder) / self.file)
        options = [name for name in RunOptionKeys.model_fields if found and getattr(found, name) is not None]
        if options:
            raise InputError(
                f"{self.file} has {', '.join(options)}, but the structures of a study share their options. Write it in "
                "the study, and leave it out there."
            )
        return built

    def checksums(self, folder: Path | str = "") -> dict[str, str]:
        """Return the SHA-256 of the file, and of what it is made from besides."""
        path = Path(folder) / self.file
        _, found = structure_in_file(path)
        own = {} if found is None else found.checksums(path.parent)
        return {"file": sha256(path.read_bytes()).hexdigest(), **own}

    def moved(self, path: Moved) -> Self:
        """Return the same structure with the path of its file from another folder."""
        return self.model_copy(update={"file": path(self.file)})

    def in_file(self) -> dict[str, Any]:
        """Return its name and its file."""
        return self.model_dump(include={"name", "file"}, exclude_unset=True)

    def document(self) -> dict[str, Any]:
        """Return its name and its file."""
        return {"name": self.name, "file": self.file}


class RunsKeys(ObjectOptionKeys, CaseKeys):
    """The models, and the options of their runs."""

    models: Annotated[list[str], validator_of_check(lambda labels: [*map(parse_model, labels)])] = Field(
        ["MDOF-S"], min_length=1, description='a list of models, such as ["MDOF-S", "2DOF-S"]'
    )
    free_vibration: FreeVibration = 0.0

    @field_validator("models", mode="before")
    @classmethod
    def _labels(cls, given: Any) -> Any:
        return model_labels(given)


def model_labels(given: Any) -> Any:
    """Return the labels of models, of one or several; anything else unchanged."""
    listed = [given] if isinstance(given, str | Model) else given
    several = isinstance(listed, list | tuple)
    return [each.label if isinstance(each, Model) else each for each in listed] if several else given
