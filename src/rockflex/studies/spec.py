"""The specification of a study in a file: the keys that all kinds share."""

import math
from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self, cast

from pydantic import Field, ValidatorFunctionWrapHandler, WrapValidator, field_validator

import rockflex.studies
from rockflex.foundation.checks import is_one_of
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.fragility._limit_states import check_limit_columns, limit_state_of
from rockflex.models._label import parse_model
from rockflex.response._response import Response
from rockflex.response._sensitivity import DERIVED
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._object_tables import structure_from_table
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._toml_table import TomlTable, parse_toml_table
from rockflex.studies._arguments import checked_structures, is_structure_or_properties, rocking_properties_of
from rockflex.studies._case_keys import CaseKeys, FileStructure, GivenStructure, RunsKeys, validator_of_check
from rockflex.studies._objects import added_checksums, object_checksum
from rockflex.studies._plan import ChunkedPlan
from rockflex.studies._record_tables import Moved
from rockflex.studies._run_matrix import StudyMatrix, StudyOptions, check_different_values, checked_demands

if TYPE_CHECKING:
    import pandas as pd


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


class StudySpec(CaseKeys):
    """A study as a file or Python describes it.

    In Python, tables are dictionaries or the objects that `run_cloud` takes: `structures` and `records` one, a sequence
    or a mapping from names, `models`, `impact`, `bouc_wen`, `ground` and `demands`. A folder records their values;
    functions, and classes of other packages, must be of a module, whose checksum it records.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is wrong; the message lists them all.
    """

    runs_per_chunk: int = Field(
        256, ge=1, description="about how many runs to compute and store together, a whole number of at least 1"
    )

    @property
    def kind(self) -> str:
        """Kind of the study: the value of its key `study`."""
        return type(self).model_fields["study"].default

    def plan(self) -> ChunkedPlan:
        """Prepare the runs; each kind of study has its own plan."""
        raise NotImplementedError

    def run(self, folder: str | Path | None = None, **options: Any) -> "pd.DataFrame":
        """Run the study, or the rest of it in a folder, and return its table; all arguments are those of `run_study`.

        Raises
        ------
        InputError
            As `run_study`.
        """
        return rockflex.studies.run_study(self, folder, **options)

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of what the study needs besides its document and records, by its key or module.

        These are files that a structure names, and sources that are not of rockflex.

        Raises
        ------
        InputError
            If an impact law, an element or a function of the user's is not defined in a file.
        """
        return added_checksums(type(self))


@dataclass(frozen=True)
class ElasticityOf:
    """The change of a peak in per cent for 1 % on the scale of the record; NaN of one that is zero or overturned."""

    name: str

    def __call__(self, response: Response) -> float:
        """Return it for a response with its history."""
        return math.nan if response.status == "overturned" else response.sensitivity.get(self.name, math.nan)


def checked_derived_numbers(given: list[str] | None) -> list[str] | None:
    """Return names of numbers that have derivatives."""
    for name in given or ():
        if not is_one_of(name, DERIVED):
            raise InputError(
                f"sensitivities must be among {', '.join(DERIVED)}, but {shown(name)} was given.", field="sensitivities"
            )
    check_different_values("sensitivities", given or ())
    return given


class RunsStudySpec(RunsKeys, StudySpec):
    """A study with models, and with the options of the runs."""

    demands: Annotated[dict[str, Any] | None, validator_of_check(lambda given: checked_demands(given, ()))] = Field(
        None, description="in Python only: functions of a Response by the names of their columns, as in `run_cloud`"
    )
    sensitivities: Annotated[list[str] | None, validator_of_check(checked_derived_numbers)] = Field(
        None,
        description='a list of peaks, such as ["max_rotation"], whose change in per cent for 1 % of the scale is a '
        "column, sensitivity_max_rotation; a run then takes several times as long",
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
        functions["ground"] = getattr(self.ground, "given", None)
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
        return replace(options, models=models, friction=friction, demands=self.all_demands)

    @property
    def all_demands(self) -> dict[str, Callable[[Response], float]]:
        """The demands, and then the sensitivities, by the names of their columns."""
        return {
            **(self.demands or {}),
            **{f"sensitivity_{name}": ElasticityOf(name) for name in self.sensitivities or ()},
        }


def _given_or_table(given: Any, table: ValidatorFunctionWrapHandler) -> Any:
    """Return a structure of Python, which a file has as a table `object`, one in a file of its own, or an entry."""
    if isinstance(given, Mapping) and "file" in given:
        return parse_toml_table(FileStructure, cast("Mapping[str, Any]", given))
    if not isinstance(given, Mapping) or "object" not in given:
        return given if isinstance(given, GivenStructure | FileStructure) else table(given)
    unknown = [str(key) for key in given if key not in ("name", "object")]
    if unknown:
        raise InputError(f"{unknown[0]} is not known beside object; it is among the arguments of its class.")
    return GivenStructure.model_construct(
        name=given.get("name", ""), given=structure_from_table(given["object"], "object")
    )


class StructuresStudySpec(RunsStudySpec):
    """A study of given structures: the structures, the models, and the options of the runs.

    In Python, `structures` may also be structures: one, a sequence, or a mapping from names.
    """

    structures: list[Annotated[StructureEntry, WrapValidator(_given_or_table)]] = Field(
        min_length=1, description="one or more tables [[structures]]"
    )

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

    def _moved(self, path: Moved) -> Self:
        moved = [each.moved(path) for each in self.structures]
        return super()._moved(path).model_copy(update={"structures": moved})

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
