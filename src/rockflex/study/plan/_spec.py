"""The specification of a study: the keys that all kinds share."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field, PrivateAttr, ValidationError

from rockflex._errors import InputError
from rockflex._json import plain
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.models import parse_model
from rockflex.structure.file import StructureEntry, Table, problems
from rockflex.study._arguments import WORK_LIMIT, free_vibration_time, properties_of, work_limit_of
from rockflex.study._option_tables import RunOptionKeys
from rockflex.study.plan._bench import Bench, StudyOptions, check_different
from rockflex.study.plan._chunked import ChunkedPlan
from rockflex.study.plan._own_law import law_checksum, law_document
from rockflex.study.plan._records import Records


def checked_by(check: Callable[[Any], object]) -> AfterValidator:
    """Return a validator that raises what `check` raises, and keeps the value as it is."""

    def checked(value: Any) -> Any:
        check(value)
        return value

    return AfterValidator(checked)


FreeVibration = Annotated[
    float | Literal["settle"],
    Field(description='the free vibration after the record, a number in s or "settle"'),
    checked_by(free_vibration_time),
]


class Spec(Table):
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
    work_limit: Annotated[float | Literal["none"], checked_by(work_limit_of)] = Field(
        WORK_LIMIT, description='the most computing that one run may take, a number in s or "none"'
    )

    _folder: Path = PrivateAttr(default_factory=Path)
    _file: Path | None = PrivateAttr(default=None)

    def __init__(self, **content: Any) -> None:
        try:
            super().__init__(**content)
        except ValidationError as error:
            raise InputError(" ".join(problems(error, content, type(self)))) from error

    @property
    def kind(self) -> str:
        """Kind of the study: the value of its key `study`."""
        return type(self).model_fields["study"].default

    def plan(self) -> ChunkedPlan:
        """Prepare the runs; each kind of study has its own plan."""
        raise NotImplementedError

    def document(self) -> dict[str, Any]:
        """Return all that determines the study as plain JSON: infinite numbers are "inf", and None is left out."""
        return plain(self.model_dump(exclude_none=True))

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of the numbers in each file that a structure names, by its key in the document."""
        return {}

    @property
    def file(self) -> Path | None:
        """The file that the study was read from, if any."""
        return self._file

    def read_from(self, folder: Path, file: Path | None = None) -> Self:
        """Let relative paths start from a folder instead of the working directory, and return the study."""
        self._folder, self._file = folder, file
        return self


class RunsSpec(RunOptionKeys, Spec):
    """A study with models, and with the options of the runs."""

    models: Annotated[list[str], checked_by(lambda labels: [*map(parse_model, labels)])] = Field(
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
        return self.model_copy(update={"impact": None}).document() | {"impact": law_document(self.impact)}

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of the source of a user-defined impact law.

        Raises
        ------
        InputError
            If that law is not defined in a file.
        """
        return {} if self.impact is None or isinstance(self.impact, str) else law_checksum(self.impact)

    def study_options(self, *, friction: bool = False) -> StudyOptions:
        """Return the options that all runs share.

        Raises
        ------
        InputError
            If they contradict each other.
        """
        options = StudyOptions.of(
            self.free_vibration, impact=self.law(), bouc_wen=self.hysteresis(), ground=self.ground_rule(),
            work_limit=self.work_limit,
        )  # fmt: skip
        return replace(options, models=tuple(map(parse_model, self.models)), friction=friction)


class StructuresSpec(RunsSpec):
    """A study of given structures: the structures, the models, and the options of the runs."""

    structures: list[StructureEntry] = Field(min_length=1, description="one or more tables [[structures]]")

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of the numbers in each file that a structure names, and of a user-defined impact law.

        Raises
        ------
        InputError
            If that law is not defined in a file.
        """
        files = {
            f"structures[{place}].{key}": value
            for place, entry in enumerate(self.structures)
            for key, value in entry.checksums(self._folder).items()
        }
        return files | super().checksums()

    def bench(self, *, friction: bool = False) -> Bench:
        """Build the structures and load the records.

        Raises
        ------
        InputError
            If a structure or a record is not available, or the options contradict each other.
        """
        names = [entry.name or f"S{place}" for place, entry in enumerate(self.structures, start=1)]
        check_different("the names of the structures", names)
        properties: dict[str, RockingProperties] = {}
        for place, entry in enumerate(self.structures, start=1):
            try:
                built = properties[names[place - 1]] = properties_of(entry.build(self._folder))
            except InputError as error:
                raise InputError(
                    f"[[structures]] no. {place}{entry.name and f', {shown(entry.name)}'}: {error}"
                ) from error
            if self.ground is not None:
                self.ground.under(built)  # before any run
        return Bench(properties, self.records.load(self._folder), self.study_options(friction=friction))
