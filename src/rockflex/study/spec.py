"""The specification of a study in a file: the keys that all kinds share."""

import math
from collections.abc import Callable, Container, Mapping
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any, Literal, NoReturn, Self, cast

import numpy as np
from pydantic import AfterValidator, Field, InstanceOf, PrivateAttr, ValidationError, field_validator, model_validator

from rockflex._errors import InputError
from rockflex._json import as_json_value
from rockflex._registry import source_checksum
from rockflex._schema import (
    IMPACT,
    PLAIN,
    WHOLE,
    BoucWenKeys,
    GroundKeys,
    ImpactKeys,
    LawName,
    SchemaKey,
    SpringBedKeys,
    one_for_each,
)
from rockflex._shown import shown
from rockflex.fragility import check_limit_columns, limit_state_of
from rockflex.modal import Ground, RockingProperties, Springs, asce41_bed, winkler_bed
from rockflex.models import BoucWen, ImpactLaw, Restitution, VVELComplete, VVELSimplified, parse_model
from rockflex.motion import MEASURES, OnError, Suite, Vertical, load_suite, read_suite
from rockflex.structure.file import StructureEntry, TomlTable, toml_problem_sentences
from rockflex.study._arguments import (
    WORK_LIMIT,
    check_run_options,
    checked_work_limit,
    free_vibration_time,
    rocking_properties_of,
)
from rockflex.study._plan import ChunkedPlan
from rockflex.study._run_matrix import StudyMatrix, StudyOptions, check_different_values


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


_EACH = one_for_each("spring")
_DAMPING_RATIO = SchemaKey("the damping of the heave mode over the critical damping", low=0.0, high=100.0)


class SpringsTable(TomlTable):
    """The arguments of `Springs`; by default two springs are at the edges of the base."""

    positions: Annotated[
        list[float] | None,
        SchemaKey(
            "a list of distances to the right of the axis of the masses in m (default: the edges)", "m", form=PLAIN
        ),
    ] = None
    stiffness: Annotated[float | list[float], SchemaKey("the stiffness in N/m", "N/m", form=_EACH, low=1.0, high=1e15)]
    damping: Annotated[
        float | list[float] | None,
        SchemaKey("the damping coefficient in N s/m", "N s/m", form=_EACH, low=0.0, high=1e15),
    ] = None
    heave_damping_ratio: Annotated[float | None, _DAMPING_RATIO] = None

    def under(self, properties: RockingProperties) -> Springs:
        """Return the springs under a structure."""
        edges = [side * properties.half_width - properties.eccentricity for side in (-1, 1)]
        springs = Springs(
            edges if self.positions is None else self.positions,
            self.stiffness,
            0.0 if self.damping is None else self.damping,
        )
        return _springs_with_heave_damping(springs, self, properties)


class SpringBedTable(SpringBedKeys, TomlTable):
    """The arguments of `winkler_bed` or, with a shear modulus, of `asce41_bed`, for the width of the structure."""

    damping: Annotated[
        float | None, SchemaKey("the damping coefficient of all springs together", "N s/m", low=0.0, high=1e15)
    ] = None
    n: Annotated[int, SchemaKey("the number of springs", label="Number of springs", form=WHOLE, low=2, high=200)] = 20
    end_zone: Annotated[
        float | None, SchemaKey("the length of the stiffer zone at either end", "m", low=0.0, high=1000.0)
    ] = None
    end_ratio: Annotated[
        float | None, SchemaKey("the stiffness of the end zones over that of the rest", low=1e-3, high=1e3)
    ] = None

    def under(self, properties: RockingProperties) -> Springs:
        """Return the bed under a structure."""
        where: dict[str, Any] = {"n": self.n, "damping": self.damping or 0.0, "eccentricity": properties.eccentricity}
        zones = {"end_zone": self.end_zone, "end_ratio": self.end_ratio}
        ends: dict[str, Any] = {name: value for name, value in zones.items() if value is not None}
        if self.subgrade_modulus is not None:
            if self.shear_modulus is not None or self.poisson_ratio is not None:
                _refuse_both("subgrade_modulus", "the shear_modulus and poisson_ratio")
            bed = winkler_bed(properties.half_width, self.breadth, self.subgrade_modulus, **where, **ends)
        elif self.shear_modulus is not None and self.poisson_ratio is not None:
            if ends:
                _refuse_both(next(iter(ends)), "the shear_modulus, whose end zones are those of ASCE 41")
            bed = asce41_bed(properties.half_width, self.breadth, self.shear_modulus, self.poisson_ratio, **where)
        else:
            raise InputError(
                "A bed needs its stiffness. Give subgrade_modulus in N/m³; or shear_modulus in N/m² and poisson_ratio, "
                "for the stiffened ends of ASCE 41.",
                field="subgrade_modulus",
            )
        return _springs_with_heave_damping(bed, self, properties)


class GroundTable(GroundKeys, TomlTable):
    """The arguments of `Ground`, with springs or a bed as tables."""

    springs: Annotated[SpringsTable | None, SchemaKey("a table", form=PLAIN)] = None
    bed: Annotated[SpringBedTable | None, SchemaKey("a table", form=PLAIN)] = None

    def under(self, properties: RockingProperties) -> Ground:
        """Return the ground under a structure."""
        if self.springs is not None and self.bed is not None:
            raise InputError(
                "The ground has springs and a bed. Give one of the two tables.", place="[ground]", field="ground.bed"
            )
        springs = None
        for name, table in (("springs", self.springs), ("bed", self.bed)):
            try:
                springs = springs if table is None else table.under(properties)
            except InputError as error:
                raise InputError(str(error), place=f"[ground.{name}]", field=f"ground.{name}.{error.field}") from error
        try:
            return Ground(self.friction, springs, self._inertia(properties))
        except InputError as error:
            raise InputError(str(error), place="[ground]", field=f"ground.{error.field or 'friction'}") from error

    def _inertia(self, properties: RockingProperties) -> float | None:
        if self.mat_mass is None:
            if self.base_inertia is None and (self.springs or self.bed):
                raise InputError(
                    "A base without rotary inertia on springs has no inertia against rotation once all modes are "
                    "included. Give mat_mass in kg for a rigid mat as wide as the base, or base_inertia in kg m² for "
                    "base and floors together.",
                    field="base_inertia",
                )
            return self.base_inertia
        if self.base_inertia is not None:
            _refuse_both("mat_mass", "the base_inertia")
        return self.mat_mass * (2.0 * properties.half_width) ** 2 / 12.0


def _springs_with_heave_damping(
    springs: Springs, table: SpringsTable | SpringBedTable, properties: RockingProperties
) -> Springs:
    if table.heave_damping_ratio is None:
        return springs
    if table.damping is not None:
        _refuse_both("heave_damping_ratio", "the damping")
    return springs.damped(table.heave_damping_ratio, properties.m_tot)


def _refuse_both(name: str, other: str) -> NoReturn:
    raise InputError(f"{name} was given besides {other}. Leave one of them out.", field=name)


_LAWS: dict[str, Callable[..., ImpactLaw]] = {
    "simplified": VVELSimplified,
    "complete": VVELComplete,
    "restitution": Restitution,
}


class BoucWenTable(BoucWenKeys, TomlTable):
    """The arguments of `BoucWen`."""


class RunOptionKeys(ImpactKeys, TomlTable):
    """The options of a run that files, links and forms share: impact law, hysteresis and ground.

    By default each model has its own law, nothing yields, and the base cannot slide on rigid ground.

    In Python `impact` may also be any `ImpactLaw`, in place of a name.
    """

    impact: Annotated[LawName | InstanceOf[ImpactLaw] | None, IMPACT] = None  # pyright: ignore[reportIncompatibleVariableOverride]
    bouc_wen: Annotated[BoucWenTable | None, SchemaKey("a table", form=PLAIN)] = None
    ground: Annotated[GroundTable | None, SchemaKey("a table", form=PLAIN)] = None

    @field_validator("impact", mode="before")
    @classmethod
    def _law(cls, given: object) -> object:
        if not isinstance(given, str | int | float | list | dict | None):  # not a value that a file can hold
            check_run_options(None, given)  # pyright: ignore[reportArgumentType]
        return given

    def law(self) -> ImpactLaw | None:
        """Return the impact law; None for the model's own."""
        if self.impact == "restitution" and self.restitution is None:
            raise InputError(
                'The impact law "restitution" needs its coefficient. Give restitution, a number from 0 to 1.',
                field="restitution",
            )
        if self.restitution is not None and self.impact != "restitution":
            chosen = "the model's own" if self.impact is None else shown(self.impact)
            raise InputError(
                f"A restitution of {self.restitution:g} was given, but the impact law is {chosen}. "
                'Choose the impact law "restitution", or leave restitution out.',
                field="restitution",
            )
        if self.impact is None:
            return None
        if isinstance(self.impact, str):
            if self.impact not in _LAWS:  # a copy with another law was not checked
                raise InputError(f"impact must be {IMPACT.expected}, but {shown(self.impact)} was given.")
            return _LAWS[self.impact](*[] if self.restitution is None else [self.restitution])
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
    return next(name for name, kind in _LAWS.items() if type(law) is kind)


def impact_law_document(law: ImpactLaw) -> dict[str, Any]:
    """Return the class of a law, the names of what it keeps and loses, and its values, as plain JSON."""
    kind = type(law)
    state = cast("Any", law).__getstate__()
    parts = state if isinstance(state, tuple) else (state,)  # a class with slots gives two dictionaries
    values = {name: _impact_law_value(name, value, kind) for part in parts if part for name, value in part.items()}
    return {"law": f"{kind.__module__}.{kind.__qualname__}", "keeps": law.keeps, "loses": law.loses, "values": values}


def impact_law_checksum(law: ImpactLaw) -> dict[str, str]:
    """Return the SHA-256 of the module that defines the class of a law; an empty dictionary for laws of rockflex."""
    kind = type(law)
    try:
        found = source_checksum(kind)
    except LookupError as error:
        raise InputError(
            f"The impact law {kind.__qualname__} is not defined in a file, so a study that is resumed cannot check "
            "that it is the same. Put it into a module (a .py file) and import it, or run the study without a folder."
        ) from error
    return {} if found is None else {f"impact, {kind.__module__}": found}


def added_checksums(study: type) -> dict[str, str]:
    """Return the SHA-256 of the sources of a class of studies and of measures that are not of rockflex."""
    parts: dict[str, Any] = {"study": study} | {f"measure {name}": each.of for name, each in MEASURES.added.items()}
    found = dict[str, str]()
    for name, part in parts.items():
        try:
            checksum = source_checksum(part)
        except LookupError:  # as in a notebook
            checksum = "not in a file"
        if checksum is not None:
            found[f"{name}, {part.__module__}"] = checksum
    return found


def _impact_law_value(name: str, value: Any, kind: type) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, np.ndarray | np.generic):
        return _impact_law_value(name, value.tolist(), kind)
    if isinstance(value, list | tuple):
        return [_impact_law_value(name, each, kind) for each in cast("list[Any]", value)]
    if isinstance(value, Mapping):
        return {str(key): _impact_law_value(name, each, kind) for key, each in cast("Mapping[Any, Any]", value).items()}
    raise InputError(
        f"A study's folder must record the values of its impact law, but {kind.__qualname__}.{name} is of type "
        f"{type(value).__name__}. Let the law hold numbers, texts and arrays, or run the study without a folder."
    )


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
    """A study as a file or Python describes it; in Python, its tables are dictionaries.

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

    @property
    def kind(self) -> str:
        """Kind of the study: the value of its key `study`."""
        return type(self).model_fields["study"].default

    def plan(self) -> ChunkedPlan:
        """Prepare the runs; each kind of study has its own plan."""
        raise NotImplementedError

    def document(self) -> dict[str, Any]:
        """Return all that determines the study as plain JSON: infinite numbers are "inf", and None is left out."""
        return as_json_value(self.model_dump(exclude_none=True))

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of what the study needs besides its document and records, by its key or module.

        These are files that a structure names, and sources that are not of rockflex.

        Raises
        ------
        InputError
            If a user-defined impact law is not defined in a file.
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

    def document(self) -> dict[str, Any]:
        """Return all that determines the study as plain JSON: infinite numbers are "inf", and None is left out.

        Raises
        ------
        InputError
            If `impact` is a user-defined law with a value that is not plain JSON.
        """
        if self.impact is None or isinstance(self.impact, str):
            return super().document()
        return self.model_copy(update={"impact": None}).document() | {"impact": impact_law_document(self.impact)}

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of what the study needs besides its document and records, by its key or module.

        Raises
        ------
        InputError
            If a user-defined impact law is not defined in a file.
        """
        law = {} if self.impact is None or isinstance(self.impact, str) else impact_law_checksum(self.impact)
        return super().checksums() | law

    def study_options(self, *, friction: bool = False) -> StudyOptions:
        """Return the options that all runs share."""
        options = StudyOptions.of(
            self.free_vibration, impact=self.law(), bouc_wen=self.hysteresis(), ground=self.ground_rule(),
            work_limit=self.work_limit
        )  # fmt: skip
        return replace(options, models=tuple(map(parse_model, self.models)), friction=friction)


class StructuresStudySpec(RunsStudySpec):
    """A study of given structures: the structures, the models, and the options of the runs."""

    structures: list[StructureEntry] = Field(min_length=1, description="one or more tables [[structures]]")

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
