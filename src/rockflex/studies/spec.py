"""The specification of a study in a file: the keys that all kinds share."""

from collections.abc import Callable, Container, Mapping
from dataclasses import asdict, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, cast

from pydantic import (
    AfterValidator,
    Field,
    InstanceOf,
    PrivateAttr,
    ValidationError,
    ValidatorFunctionWrapHandler,
    field_validator,
    model_validator,
)

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.json import as_json_value
from rockflex.foundation.schema import IMPACT, ImpactSchema, LawName
from rockflex.foundation.shown import shown
from rockflex.fragility._limit_states import check_limit_columns, limit_state_of
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import LAWS, ImpactLaw, law_of_name, unused_restitution_error
from rockflex.models._label import Model, parse_model
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._read_suite import OnError, Vertical, read_suite
from rockflex.motion._suite import Selection, Suite, load_suite
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._toml_table import TomlTable, table_of, toml_problem_sentences
from rockflex.studies._arguments import (
    WORK_LIMIT,
    check_run_options,
    checked_motions,
    checked_structures,
    checked_work_limit,
    free_vibration_time,
    is_structure_or_properties,
    rocking_properties_of,
)
from rockflex.studies._ground_tables import GivenGround, GroundTable
from rockflex.studies._objects import (
    added_checksums,
    function_document,
    impact_law_document,
    object_checksum,
    object_document,
)
from rockflex.studies._plan import ChunkedPlan
from rockflex.studies._run_matrix import StudyMatrix, StudyOptions, check_different_values, checked_demands


class Records(TomlTable):
    """Records by the names of embedded suites, from a folder, or both.

    Examples
    --------
    >>> import rockflex as rf
    >>> records = rf.Records(suites=["fema-p695-far-field"], include=["FF-1-*"])
    >>> rf.PopulationStudy(records=records.model_dump()).records.include
    ['FF-1-*']
    """

    suites: list[str] = Field(default_factory=list, description='a list of suites, such as "fema-p695-far-field"')
    folder: str | None = Field(None, description="the path of a folder of records, in quotes")
    on_error: OnError = Field(
        "raise", description='"raise" or "skip": what to do with files of the folder that cannot be read'
    )
    vertical: Vertical | None = Field(
        None, description='"pair": each record of the folder with the vertical component of its station'
    )
    include: list[str] = Field(["*"], description='a list of patterns of record names to keep, such as "FF-1-*"')

    @model_validator(mode="after")
    def _some(self) -> "Records":
        if not self.suites and self.folder is None:
            raise InputError('no record is named. Give suites = ["fema-p695-far-field"], folder = "...", or both.')
        if self.folder is None and self.on_error != "raise":
            raise InputError("on_error is for the files of a folder, but none is named. Leave it out.")
        if self.folder is None and self.vertical is not None:
            raise InputError(
                "vertical is for the files of a folder, but none is named: the embedded suites hold no vertical "
                "components. Leave it out."
            )
        return self

    def load(self, base: Path) -> Suite:
        """Load the records, first those of the suites; relative paths start from `base`.

        Raises
        ------
        InputError
            If a suite is unknown, the folder or, unless `on_error` is "skip", a file in it cannot be read, two records
            have the same name, or a pattern of `include` matches no record.
        """
        motions = [motion for name in self.suites for motion in load_suite(name)]
        if self.folder is not None:
            motions += read_suite(base / self.folder, on_error=self.on_error, vertical=self.vertical)
        names = [motion.name for motion in motions]
        for pattern in self.include:
            if not any(fnmatchcase(name, pattern) for name in names):
                raise InputError(
                    f"[records] include: no record's name fits {shown(pattern)}. There are {len(names)}, from "
                    f"{shown(names[0])} to {shown(names[-1])}; * stands for any text and ? for one letter."
                )
        return Suite(m for m in motions if any(fnmatchcase(m.name, pattern) for pattern in self.include))


class GivenRecords(Records):
    """Motions in the place of a table."""

    given: InstanceOf[Suite]

    def load(self, base: Path) -> Suite:  # noqa: ARG002
        """Return the motions."""
        return self.given

    def document(self) -> dict[str, Any]:
        """Return their names; the samples are among the checksums of a study."""
        return {"motions": self.given.names}


class GivenStructure(StructureEntry):
    """A structure in the place of a table."""

    given: Any

    def build(self, folder: Path | str = "") -> Any:  # noqa: ARG002
        """Return the structure."""
        return self.given

    def checksums(self, folder: Path | str = "") -> dict[str, str]:  # noqa: ARG002
        """Return the SHA-256 of the modules of its elements that are not of rockflex."""
        kinds = dict.fromkeys(type(each) for each in rocking_properties_of(self.given).elements)
        return {key: value for kind in kinds for key, value in object_checksum("element", kind).items()}

    def document(self) -> dict[str, Any]:
        """Return its name, and what determines it."""
        return {"name": self.name, "given": object_document("structures", self.given)}


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


class LimitKeys(TomlTable):
    """The limits whose fragility curves the report of a study has."""

    limits: Annotated[
        list[float | str] | None, validator_of_check(lambda given: [limit_state_of(each) for each in given or ()])
    ] = Field(
        None,
        description='a list of limits to report, such as [0.02, "uplift", "max_ductility > 4"] (default: the usual '
        "ones of such a study)",
    )

    def check_limits(self, columns: Container[str]) -> None:
        """Raise an InputError if a limit is on a demand that the table will not have."""
        check_limit_columns(map(limit_state_of, self.limits or ()), columns)


class StudySpec(TomlTable):
    """A study as a file or Python describes it.

    In Python, tables are dictionaries or the objects that `run_cloud` takes: `structures` and `records` one, a sequence
    or a mapping from names, `models`, `impact`, `bouc_wen`, `ground` and `demands`. A folder records their values;
    functions, and classes of other packages, must be of a module, whose checksum it records.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is wrong; the message lists them all.
    """

    name: str = Field("", description="a name, in quotes")
    records: Records = Field(description="a table of suites or a folder")
    runs_per_chunk: int = Field(
        256, ge=1, description="about how many runs to compute and store together, a whole number of at least 1"
    )
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

    @property
    def kind(self) -> str:
        """Kind of the study: the value of its key `study`."""
        return type(self).model_fields["study"].default

    def plan(self) -> ChunkedPlan:
        """Prepare the runs; each kind of study has its own plan."""
        raise NotImplementedError

    def document(self) -> dict[str, Any]:
        """Return all that determines the study as plain JSON: infinite numbers are "inf", and None is left out.

        Raises
        ------
        InputError
            If an object of Python holds what is not plain JSON.
        """
        given: Any = self
        objects = {name: _object_in_field(name, value) for name, value in given}
        objects = {name: value for name, value in objects.items() if value is not None}
        return as_json_value(self.model_dump(exclude={*objects}, exclude_none=True)) | objects

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of what the study needs besides its document and records, by its key or module.

        These are files that a structure names, and sources that are not of rockflex.

        Raises
        ------
        InputError
            If an impact law, an element or a function of the user's is not defined in a file.
        """
        return added_checksums(type(self))

    @property
    def file(self) -> Path | None:
        """The file that the study was read from, if any."""
        return self._file

    def read_from(self, folder: Path, file: Path | None = None) -> Self:
        """Let relative paths start from a folder instead of the working directory, and return the study."""
        self._folder, self._file = folder, file
        return self


class RunsStudySpec(RunOptionKeys, StudySpec):
    """A study with models, and with the options of the runs."""

    models: Annotated[list[str], validator_of_check(lambda labels: [*map(parse_model, labels)])] = Field(
        ["MDOF-S"], min_length=1, description='a list of models, such as ["MDOF-S", "2DOF-S"]'
    )
    free_vibration: FreeVibration = 0.0
    demands: Annotated[dict[str, Any] | None, validator_of_check(lambda given: checked_demands(given, ()))] = Field(
        None, description="in Python only: functions of a Response by the names of their columns, as in `run_cloud`"
    )

    @field_validator("models", mode="before")
    @classmethod
    def _labels(cls, given: Any) -> Any:
        listed = [given] if isinstance(given, str | Model) else given
        several = isinstance(listed, list | tuple)
        return [each.label if isinstance(each, Model) else each for each in listed] if several else given

    @field_validator("bouc_wen", mode="before")
    @classmethod
    def _hysteresis(cls, given: Any) -> Any:
        return asdict(given) if isinstance(given, BoucWen) else given

    @field_validator("ground", mode="wrap")
    @classmethod
    def _given_ground(cls, given: Any, table: ValidatorFunctionWrapHandler) -> Any:
        return (
            GivenGround.model_construct(given=given) if isinstance(given, Ground) or callable(given) else table(given)
        )

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of what the study needs besides its document and records, by its key or module.

        Raises
        ------
        InputError
            If an impact law, an element or a function of the user's is not defined in a file.
        """
        found = super().checksums()
        if not isinstance(self.impact, str | None):
            found |= object_checksum("impact", type(self.impact), "impact law")
        functions = {f"demand {name}": each for name, each in (self.demands or {}).items()}
        functions["ground"] = self.ground.given if isinstance(self.ground, GivenGround) else self.ground
        for key, each in functions.items():
            found |= object_checksum(key, each, "function") if callable(each) else {}
        return found

    def study_options(self, *, friction: bool = False) -> StudyOptions:
        """Return the options that all runs share."""
        options = StudyOptions.of(
            self.free_vibration, impact=self.law(), bouc_wen=self.hysteresis(), ground=self.ground_rule(),
            work_limit=self.work_limit
        )  # fmt: skip
        models = tuple(map(parse_model, self.models))
        return replace(options, models=models, friction=friction, demands=self.demands or {})


def _object_in_field(name: str, value: Any) -> Any:
    """Return what the document of a study has for an object of Python in one of its fields; None for plain values."""
    if isinstance(value, GivenRecords | GivenStructure | GivenGround):
        return value.document()
    if isinstance(value, list):
        found = [each.document() for each in cast("list[Any]", value) if isinstance(each, GivenStructure)]
        return found or None
    if isinstance(value, ImpactLaw):
        return impact_law_document(value)
    if name == "demands" and value:
        return {each: function_document(f"demands.{each}", function) for each, function in value.items()}
    if isinstance(value, Ground):
        return object_document(name, value)
    return function_document(name, value) if callable(value) else None


class StructuresStudySpec(RunsStudySpec):
    """A study of given structures: the structures, the models, and the options of the runs.

    In Python, `structures` may also be structures: one, a sequence, or a mapping from names.
    """

    structures: list[StructureEntry] = Field(min_length=1, description="one or more tables [[structures]]")

    @field_validator("structures", mode="wrap")
    @classmethod
    def _given_structures(cls, given: Any, tables: ValidatorFunctionWrapHandler) -> Any:
        items = list(given.values()) if isinstance(given, Mapping) else given
        several = isinstance(items, list | tuple) and any(map(is_structure_or_properties, items))
        if not several and not is_structure_or_properties(given):
            return tables(given)
        listed, names = checked_structures(given)
        return [
            GivenStructure.model_construct(name=name, given=each)
            for name, each in zip(names or [""] * len(listed), listed, strict=True)
        ]

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of what the study needs besides its document and records, by its key or module."""
        files = {
            f"structures[{place}].{key}": value
            for place, entry in enumerate(self.structures)
            for key, value in entry.checksums(self._folder).items()
        }
        return files | super().checksums()

    def matrix(self, *, friction: bool = False) -> StudyMatrix:
        """Build the structures and load the records."""
        names = [entry.name or f"S{place}" for place, entry in enumerate(self.structures, start=1)]
        check_different_values("the names of the structures", names)
        properties: dict[str, RockingProperties] = {}
        for place, entry in enumerate(self.structures, start=1):
            try:
                built = properties[names[place - 1]] = rocking_properties_of(entry.build(self._folder))
            except InputError as error:
                raise InputError(
                    f"[[structures]] no. {place}{entry.name and f', {shown(entry.name)}'}: {error}"
                ) from error
            if self.ground is not None:
                self.ground.under(built)  # before any run
        return StudyMatrix(properties, self.records.load(self._folder), self.study_options(friction=friction))
