"""A case: structures, records, models and the options of their runs as one value, and as one file."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self, SupportsIndex, cast

from pydantic import BeforeValidator, Field, InstanceOf, ValidationError, field_validator, model_validator

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.json import as_json_value
from rockflex.foundation.shown import shown
from rockflex.models._label import parse_model
from rockflex.motion._suite import Suite
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._object_entries import entry_of_object_table
from rockflex.structure.file._object_tables import CLASS, structure_from_table
from rockflex.structure.file._structure_entry import KINDS, StructureEntry
from rockflex.structure.file._structure_tables import Built
from rockflex.structure.file._wrappers import WRAPPERS
from rockflex.studies._arguments import (
    InitialState,
    Output,
    checked_structures,
    ground_under_structure,
    is_structure_or_properties,
    rocking_properties_of,
)
from rockflex.studies._case_keys import (
    Factors,
    ObjectOptionKeys,
    RunOptionKeys,
    RunsKeys,
    key_in_file,
    model_labels,
    structure_in_file,
    validator_of_check,
)
from rockflex.studies._objects import object_in_file, option_of_file
from rockflex.studies._record_tables import GivenRecords, Moved
from rockflex.studies._run_matrix import check_different_values
from rockflex.studies._simulate import simulate_many
from rockflex.studies.progress import ProgressChoice, reporting_progress
from rockflex.studies.running import checked_work_limit

if TYPE_CHECKING:
    import pandas as pd

_PARTS = (*WRAPPERS, "elements")  # of a structure that is a table


def _initial_state(given: Any) -> Any:
    return option_of_file("initial", {CLASS: InitialState.__name__, **given}) if isinstance(given, Mapping) else given


def _structure_object(given: Any) -> Any:
    if isinstance(given, Mapping):
        return structure_from_table(cast("Mapping[str, Any]", given), "object")
    if given is not None and not is_structure_or_properties(given):
        raise InputError(f'object must be a table with the key "class", but {shown(given)} was given.')
    return given


Initial = Annotated[
    InstanceOf[InitialState] | None,
    BeforeValidator(_initial_state),
    Field(description="a table with the rotation in rad at t = 0, or other arguments of InitialState"),
]


class OwnRunKeys(ObjectOptionKeys):
    """The models and options of one structure, where they differ from those of a case."""

    models: Annotated[
        list[str] | None,
        BeforeValidator(model_labels),
        validator_of_check(lambda labels: [*map(parse_model, labels or [])]),
    ] = Field(None, min_length=1, description='a list of models, such as ["MDOF-S", "2DOF-S"]')
    initial: Initial = None

    def options_in_file(self) -> dict[str, Any]:
        """Return the models and options that were given as the keys of a file."""
        given = {name: getattr(self, name) for name in OwnRunKeys.model_fields if name in self.model_fields_set}
        return {name: key_in_file(name, value) for name, value in given.items() if value is not None}


class CaseStructure(OwnRunKeys, StructureEntry):
    """A structure of a case: a table as in a structure file, such a file, or an object; with options of its own.

    Options that it has replace those of the case, and of its file.
    """

    file: Annotated[str | None, Described("the path of a structure file, in quotes", form=PLAIN)] = None
    object: Annotated[
        Any, BeforeValidator(_structure_object), Described('a table with the key "class", and arguments', form=PLAIN)
    ] = None

    @property
    def elsewhere(self) -> str:
        """The key that holds the structure in place of a table; empty for a table."""
        return next((name for name in ("file", "object") if getattr(self, name) is not None), "")

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        others = [name for name in ("object", *KINDS, *_PARTS) if getattr(self, name) is not None]
        if self.elsewhere and others[self.elsewhere == "object" :]:
            raise InputError(
                f"{others[-1]} was given besides {self.elsewhere}, which is a whole structure. Leave one of them out."
            )
        return self

    def built(self, folder: Path) -> tuple[Built, Self]:
        """Build the structure; return it with its options and those of its file.

        Raises
        ------
        InputError
            As `StructureEntry.build` and `read_structure`.
        """
        if self.object is not None:
            return self.object, self
        if self.file is None:
            return self.build(folder), self
        built, found = structure_in_file(folder / self.file)
        names = [] if found is None else [name for name in RunOptionKeys.model_fields if getattr(self, name) is None]
        if self.impact is not None and "restitution" in names:
            names.remove("restitution")
        return built, self.model_copy(update={name: getattr(found, name) for name in names})

    def moved(self, path: Moved) -> Self:
        """Return the same structure with the paths of its files from another folder."""
        if self.object is not None:
            return self
        return super().moved(path) if self.file is None else self.model_copy(update={"file": path(self.file)})

    def in_file(self) -> dict[str, Any]:
        """Return the keys of a file."""
        name = {"name": self.name} if self.name else {}
        if self.object is not None:
            return name | _structure_in_file(self.object) | self.options_in_file()
        table = self.model_dump(exclude={"name", *OwnRunKeys.model_fields}, exclude_unset=True, exclude_none=True)
        return name | table | self.options_in_file()


def _structure_in_file(structure: Any) -> dict[str, Any]:
    """Return the keys of a structure file that builds an equal structure, or a table with the name of its class."""
    table = object_in_file("structures", structure)
    try:
        entry = StructureEntry(**entry_of_object_table(table, "structures"))
        same = entry.build() == structure
    except (InputError, ValidationError):  # no kind of structure in a file is this one
        return {"object": table}
    return entry.model_dump(exclude_unset=True, exclude_none=True) if same else {"object": table}


@dataclass(frozen=True)
class CaseRuns:
    """The runs of a structure of a case: its name, itself, its models, and the options by name.

    `options` has the names of `simulate_many`.
    """

    name: str
    structure: Built
    properties: RockingProperties
    models: tuple[str, ...]
    options: dict[str, Any]


class Case(RunsKeys):
    """Structures, records, models and options: the runs of all with all, in one file.

    A study is a case with a question. In Python, tables are dictionaries, or the objects that `simulate_many` takes:
    `structures` and `records` one, a sequence or a mapping from names, `models`, `impact`, `bouc_wen`, `ground` and
    `initial`.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is wrong; the message lists them all.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> records = {"suites": ["el-centro-1940"]}
    >>> case = rf.Case(structures={"block": block}, records=records,
    ...     models=["rigid"])
    >>> case.run()[["structure", "motion", "status"]]
      structure             motion   status
    0     block  EL-CENTRO-1940-NS  rocking
    >>> path = case.write("block.toml")
    >>> rf.read_case(path).run().equals(case.run())
    True
    """

    scales: Factors = Field([1.0])
    initial: Initial = None
    structures: list[CaseStructure] = Field(min_length=1, description="one or more tables [[structures]]")

    if TYPE_CHECKING:  # type checkers take every field for an argument that must be given

        def __init__(self, **content: Any) -> None: ...

    @field_validator("structures", mode="before")
    @classmethod
    def _given_structures(cls, given: Any) -> Any:
        items = list(given.values()) if isinstance(given, Mapping) else given
        several = isinstance(items, list | tuple) and any(map(is_structure_or_properties, items))
        if not several and not is_structure_or_properties(given):
            return given
        listed, names = checked_structures(given)
        named = zip(names or [""] * len(listed), listed, strict=True)
        return [{**({"name": name} if name else {}), "object": each} for name, each in named]

    def __repr__(self) -> str:
        names = ", ".join(map(repr, self.structure_names))
        return f"Case({names} with {', '.join(self.models)})"

    __str__ = __repr__

    @property
    def structure_names(self) -> list[str]:
        """The names of the structures; those without are "S1", "S2", ... by their places."""
        return [each.name or f"S{place}" for place, each in enumerate(self.structures, 1)]

    def motions(self) -> Suite:
        """Load the records.

        Raises
        ------
        InputError
            If a record cannot be read, or two have the same name.
        """
        return self.records.load(self._folder)

    def runs(self) -> list[CaseRuns]:
        """Build the structures, and return each with its models and options.

        Raises
        ------
        InputError
            If a structure cannot be built, two have the same name, or an option is wrong.
        """
        names = self.structure_names
        check_different_values("the names of the structures", names)
        return [self._runs_of(place) for place in range(len(names))]

    def _runs_of(self, place: int) -> CaseRuns:
        name = self.structure_names[place]
        try:
            built, own = self.structures[place].built(self._folder)
            properties = rocking_properties_of(built)
            models = tuple(own.models or self.models)
            check_different_values("models", models)
            law, ground = own if own.impact is not None else self, own if own.ground is not None else self
            ground_under_structure(properties, ground.ground_rule())  # before any run
            options = {
                "free_vibration": self.free_vibration,
                "impact": law.law(),
                "bouc_wen": own.hysteresis() or self.hysteresis(),
                "ground": ground.ground_rule(),
                "initial": own.initial or self.initial,
                "work_limit": checked_work_limit(self.work_limit),
            }
            return CaseRuns(name, built, properties, models, options)
        except InputError as error:
            given = self.structures[place].name
            raise InputError(f"[[structures]] no. {place + 1}{given and f', {shown(given)}'}: {error}") from error

    def run(
        self, output: Output = "peaks", *, workers: SupportsIndex | None = None, progress: ProgressChoice = None
    ) -> "pd.DataFrame":
        """Simulate every structure under every record with every model at every scale.

        Parameters
        ----------
        output, workers, progress
            As in `simulate_many`; with "history", a column `response` has every run's `Response`.

        Returns
        -------
        pandas.DataFrame
            The table of `simulate_many`: one row a run, structures outermost, then records, models and scales.

        Raises
        ------
        InputError
            If a structure cannot be built or a record cannot be read; see also `simulate_many`.
        """
        motions, runs = self.motions(), self.runs()
        total = len(motions) * len(self.scales) * sum(len(each.models) for each in runs)
        tables: list[pd.DataFrame] = []
        with reporting_progress(progress, total, "runs") as advance:
            # Structures that share their options share the threads.
            for (models, options), group in groupby(runs, key=lambda each: (each.models, each.options)):
                told = 0

                def tell(done: int, _: int) -> None:
                    nonlocal told
                    advance(done - told)
                    told = done

                table = simulate_many(
                    {each.name: each.properties for each in group},
                    motions,
                    models,
                    output,
                    self.scales,
                    workers=workers,
                    progress=None if progress is None else tell,
                    **options,
                )
                tables.append(table)
        return _joined(tables)

    def document(self) -> dict[str, Any]:
        """Return everything that was given as plain JSON: infinite numbers are "inf", and None is left out.

        Of records of Python it has the names.

        Raises
        ------
        InputError
            If a function or an impact law was given in Python that no file can hold.
        """
        given = self.records
        return as_json_value(
            self._in_file(given.document() if isinstance(given, GivenRecords) else key_in_file("records", given))
        )

    def _moved(self, path: Moved) -> Self:
        moved = [each.moved(path) for each in self.structures]
        return super()._moved(path).model_copy(update={"structures": moved})


def case_in_file(file: Path, content: Mapping[str, Any]) -> Case:
    """Return the case that a file holds; paths in it start from its folder.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is wrong; the message names file and key.
    """
    try:
        return Case(**content).read_from(file.parent, file)
    except InputError as error:
        raise InputError(f"{file}: {error}") from error


def _joined(tables: "list[pd.DataFrame]") -> "pd.DataFrame":
    """Return the rows of all tables; names stay categories."""
    import pandas as pd

    for name in ("structure", "motion", "model") if len(tables) > 1 else ():
        known = dict.fromkeys(each for table in tables for each in table[name].cat.categories)
        for table in tables:
            table[name] = table[name].cat.set_categories(list(known))
    return tables[0] if len(tables) == 1 else pd.concat(tables, ignore_index=True)
