"""Monte Carlo simulation: structures whose dimensions and elements are random, under a suite of records."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, cast

import numpy as np
from pydantic import Field, InstanceOf, ValidatorFunctionWrapHandler, field_validator

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.motion._measures import scalable_measures
from rockflex.motion._suite import Suite
from rockflex.response._respond import MAX_OF_STORIES
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._toml_table import TomlTable, parse_toml_table, toml_key_label
from rockflex.studies._arguments import (
    GroundChoice,
    checked_scale_factors,
    ground_under_structure,
    rocking_properties_of,
)
from rockflex.studies._ground_tables import GroundTable
from rockflex.studies._objects import object_checksum
from rockflex.studies._plan import ChunkedPlan
from rockflex.studies._random_variables import (
    RandomVariables,
    check_formula_names_known,
    formula_value,
    is_formula,
    names_in_formula,
    uniform_draws,
)
from rockflex.studies._result_tables import (
    RESULTS,
    Columns,
    Row,
    Table,
    columns_of_kind,
    joined_tables,
    story_columns,
)
from rockflex.studies._run_matrix import StudyMatrix, results_of_matrix_runs
from rockflex.studies.cloud import Factors
from rockflex.studies.spec import LimitKeys, RunsStudySpec

LATER_KEYS = ("elements", "stories")  # what may depend on the facts of the structure
FACTS = {
    "weight": "the weight m_tot g of the structure in N",
    "weight_moment": "the moment m_tot g B of the weight in N m",
    "half_width": "the half width B of the base in m",
    "l0r_g": "the moment L_0^r g of the weight, a radian, in N m",
}
"""Properties that formulas of tendons, elements, stories and the ground may use besides the variables."""

Place = tuple[str | int, ...]


class _StructureEntryHolder(TomlTable):
    structure: StructureEntry


class _GroundHolder(TomlTable):
    ground: GroundTable


class RandomPopulation:
    """Structures that differ in the values of variables.

    `structure` is a structure as a file describes it, with formulas such as "= 0.3 * weight" in place of some numbers,
    or a function of the values of the variables, by name, that returns a structure; `ground` is the ground in the same
    way, a `Ground` or a function as in `simulate`, and None for rigid ground. Relative paths of files of numbers start
    in `folder`. An `InputError` tells of a formula that cannot be read, or refers to unknown names.
    """

    def __init__(
        self,
        variables: RandomVariables,
        structure: Mapping[str, Any] | Callable[..., Any],
        folder: Path,
        ground: Mapping[str, Any] | GroundChoice = None,
    ) -> None:
        self.variables, self._structure, self._folder, self._ground = variables, structure, folder, ground
        for place, formula in (
            *_formulas_in_structure_entry(structure, ("structure",)),
            *_formulas_in_structure_entry(ground, ("ground",)),
        ):
            label, held = toml_key_label(place), place[0] == "ground" or place[1] in LATER_KEYS
            try:
                needed = names_in_formula(formula)
            except InputError as error:
                raise InputError(f"{label}: {error}") from error
            if not held and (early := sorted(needed & FACTS.keys())):
                raise InputError(
                    f"{label}: {early[0]} is known only after the structure is built, so only formulas of elements, "
                    "tendons, stories and the ground may use it."
                )
            check_formula_names_known(label, needed, variables.kinds | (FACTS if held else {}))

    def entry(self, values: Mapping[str, float]) -> StructureEntry:
        """Return the structure without tendons, elements and yielding stories for values of the variables."""
        items = self._structure.items() if isinstance(self._structure, Mapping) else ()
        return _checked_random_structure({key: value for key, value in items if key not in LATER_KEYS}, values)

    def build(self, values: Mapping[str, float]) -> RockingProperties:
        """Return the structure for values of the variables."""
        if not isinstance(self._structure, Mapping):
            return rocking_properties_of(self._structure({name: values[name] for name in self.variables.kinds}))
        free = rocking_properties_of(self.entry(values).build(self._folder))
        if not any(self._structure.get(key) for key in LATER_KEYS):
            return free
        whole = _checked_random_structure(self._structure, {**values, **random_structure_facts(free)})
        return rocking_properties_of(whole.build(self._folder) if "stories" in whole.wrappers else whole.hold(free))

    def ground_under(self, properties: RockingProperties, values: Mapping[str, float]) -> Ground | None:
        """Return the ground under a structure for values of the variables."""
        if not isinstance(self._ground, Mapping):
            return ground_under_structure(properties, self._ground)
        content = _structure_entry_with_values(
            self._ground, {**values, **random_structure_facts(properties)}, ("ground",)
        )
        return parse_toml_table(_GroundHolder, {"ground": content}).ground.under(properties)


def random_structure_facts(properties: RockingProperties) -> dict[str, float]:
    """Return the values of `FACTS`."""
    weight = properties.m_tot * GRAVITY
    return {
        "weight": weight,
        "weight_moment": weight * properties.half_width,
        "half_width": properties.half_width,
        "l0r_g": properties.l0r * GRAVITY,
    }


def _checked_random_structure(content: Mapping[str, Any], values: Mapping[str, float]) -> StructureEntry:
    return parse_toml_table(
        _StructureEntryHolder, {"structure": _structure_entry_with_values(content, values, ("structure",))}
    ).structure


def _formulas_in_structure_entry(content: object, place: Place) -> Iterator[tuple[Place, str]]:
    if is_formula(content):
        yield place, str(content)
    for key, each in _structure_entry_items(content):
        yield from _formulas_in_structure_entry(each, (*place, key))


def _structure_entry_with_values(content: Any, values: Mapping[str, float], place: Place) -> Any:
    """Return the content with the values of its formulas."""
    if is_formula(content):
        try:
            return formula_value(content, values)
        except InputError as error:
            raise InputError(f"{toml_key_label(place)}: {error}") from error
    evaluated = (
        (key, _structure_entry_with_values(each, values, (*place, key)))
        for key, each in _structure_entry_items(content)
    )
    if isinstance(content, Mapping):
        return dict(evaluated)
    return [each for _, each in evaluated] if isinstance(content, list) else content


def _structure_entry_items(content: object) -> Iterator[tuple[str | int, Any]]:
    if isinstance(content, Mapping):
        yield from cast("Mapping[str, Any]", content).items()
    elif isinstance(content, list):
        yield from enumerate(cast("list[Any]", content))


MAX_STRUCTURES = 2**32 - 1  # structures with different random numbers
MAX_TRIALS = 20  # structures, at most, until one can be built
STRUCTURES_PER_BATCH = 256  # structures that are prepared together
OF_STRUCTURE = "resisting_moment recentring_ratio"
_RUN = "structure number motion group magnitude distance_km model scale nominal_limit zeta_1 error"
_COLUMNS = (
    *_RUN.split(),
    *OF_STRUCTURE.split(),
    *(measure.name for measure in scalable_measures()),
    "status",
    *RESULTS,
    *MAX_OF_STORIES,
)


class MonteCarloStudy(LimitKeys, RunsStudySpec):
    """Random structures under all records, or under some that are drawn for each structure.

    `variables` are distributions (`uniform`, `log_uniform`, `whole`, `normal`, `lognormal` or `one_of`), formulas of
    other variables, and numbers. `structure` is a structure as a file describes it; any number in it may be a formula,
    a text that begins with "=": numbers, names of variables, + - * / **, parentheses, min, max, sqrt, exp and log.
    `ground` is the ground as a file describes it, and may have formulas too. Formulas of tendons, elements, stories
    that yield and the ground may also use `weight` (m_tot g, N), `weight_moment` (m_tot g B, N m), `half_width` (B, m)
    and `l0r_g` (L_0^r g, N m), so that strengths can be shares of the weight. In Python `structure` may also be a
    function of the values of the variables, by name, that returns a structure, and `ground` as in `simulate`.

    The table has one row per run, structures outermost, then records, models and scales. Its columns are those of
    `run_cloud`, with the name of the study as `structure`; `number`, which counts the structures from 0; each variable;
    `weight`, `weight_moment`, `half_width`, `l0r_g`, `resisting_moment` and `recentring_ratio` of the structure. The
    runs of a structure that cannot be built have a message in `error`. The draw of a variable depends only on `seed`,
    the number, and the name of the variable: other variables, or more structures, change no value.

    Examples
    --------
    >>> import rockflex as rf
    >>> study = rf.MonteCarloStudy(
    ...     count=1000,
    ...     variables={"height": {"uniform": [10.0, 40.0]},
    ...     "fuse": {"lognormal": [0.3, 0.4]}},
    ...     structure={
    ...         "wall_frame": {
    ...             "height": "= height", "mass": "= 2e4 * height",
    ...             "stiffness_parameter": 0.0, "base_mass": 4e4,
    ...             "period": "= 0.05 * height**0.75", "aspect_ratio": 5.0,
    ...             "damping_ratio": 0.03, "n_modes": 3},
    ...         "elements": [{"kind": "yielding_dissipator",
    ...         "stiffness": "= 50 * weight / half_width",
    ...                       "yield_force": "= fuse * weight"}]},
    ...     records={"suites": ["fema-p695-far-field"]},
    ...     records_per_structure=4,
    ... )
    >>> study.plan().n_runs
    4000
    >>> wall = study.structure_of(0)
    >>> round(wall.recentring_ratio, 3)
    3.246
    """

    study: Literal["monte_carlo"] = Field("monte_carlo", description='"monte_carlo"')
    count: int = Field(
        1000,
        ge=1,
        le=MAX_STRUCTURES,
        description="the number of random structures, a whole number from 1 to 4294967295",
    )
    seed: int = Field(0, ge=0, description="what the draws depend on, a whole number of at least 0")
    variables: dict[str, Any] = Field(description="a table of random variables")
    structure: dict[str, Any] | Callable[..., Any] = Field(
        description="a table of a structure, such as [structure.frame]"
    )
    ground: Annotated[  # pyright: ignore[reportIncompatibleVariableOverride]
        dict[str, Any] | InstanceOf[Ground] | Callable[..., Any] | None, Described("a table", form=PLAIN)
    ] = None
    scales: Factors = Field([1.0])
    records_per_structure: int | None = Field(
        None, ge=1, description="how many records to draw for each structure, a whole number (default: all records)"
    )

    @field_validator("ground", mode="wrap")
    @classmethod
    def _given_ground(cls, given: Any, table: ValidatorFunctionWrapHandler) -> Any:
        return table(given)  # each structure has its own

    def population(self) -> RandomPopulation:
        """Return the population of structures.

        Raises
        ------
        InputError
            If a variable or a formula is wrong.
        """
        taken = dict.fromkeys((*_COLUMNS, *self.all_demands), "a column of the table")
        return RandomPopulation(
            RandomVariables(self.variables, taken | FACTS), self.structure, self._folder, self.ground
        )

    def structure_of(self, number: int) -> RockingProperties:
        """Return the random structure of a number from 0.

        Raises
        ------
        InputError
            If it cannot be built.
        """
        population = self.population()
        return population.build(population.variables.draw(self.seed, number))

    def ground_of(self, number: int) -> Ground | None:
        """Return the ground under the random structure of a number from 0; None for rigid ground without sliding.

        Raises
        ------
        InputError
            If the structure or its ground cannot be built.
        """
        population = self.population()
        values = population.variables.draw(self.seed, number)
        return population.ground_under(population.build(values), values)

    def ground_rule(self) -> None:
        """Return None: each structure has a ground of its own."""

    def checksums(self) -> dict[str, str]:
        """Return the SHA-256 of the numbers in each file that the structure names, and of a user-defined impact law.

        Raises
        ------
        InputError
            If a file cannot be read, or that law is not defined in a file.
        """
        population = self.population()
        if callable(self.structure):
            own = object_checksum("structure", self.structure, "function")
            for each in population.build(population.variables.draw(self.seed, 0)).elements:
                own |= object_checksum("element", type(each))
            return own | super().checksums()
        entry = population.entry(population.variables.draw(self.seed, 0))
        files = {f"structure.{key}": value for key, value in entry.checksums(self._folder).items()}
        return files | super().checksums()

    def plan(self) -> "MonteCarloPlan":
        """Load the records, and divide the study into chunks.

        Raises
        ------
        InputError
            If a variable or a formula is wrong, none of the first structures can be built, a record cannot be read, or
            fewer records are there than are to be drawn.
        """
        plan = MonteCarloPlan(self, self.records.load(self._folder))
        self.check_limits(plan.columns)
        return plan


class MonteCarloPlan(ChunkedPlan):
    """The runs of each random structure, divided into chunks of structures.

    Structures share nothing but the records, so a study of any size fits in memory.
    """

    def __init__(self, study: MonteCarloStudy, motions: Suite) -> None:
        self.population, self.seed = study.population(), study.seed
        self._per_structure = len(motions) if study.records_per_structure is None else study.records_per_structure
        if self._per_structure > len(motions):
            raise InputError(
                f"records_per_structure must be at most the number of records, {len(motions)}, but "
                f"{self._per_structure} was given."
            )
        self.scales = checked_scale_factors(study.scales, max(motions, key=lambda motion: motion.pga))
        first = self._first(study.count)
        self.matrix = StudyMatrix({study.name or "random structures": first}, motions, study.study_options())
        runs = self._per_structure * len(self.matrix.labels) * len(self.scales)
        super().__init__(motions, study.count, max(1, study.runs_per_chunk // runs))

    def _first(self, count: int) -> RockingProperties:
        """Return the first structure that can be built."""
        first: InputError | None = None
        for number in range(min(count, MAX_TRIALS)):
            try:
                values = self.population.variables.draw(self.seed, number)
                built = self.population.build(values)
                self.population.ground_under(built, values)
            except InputError as error:
                first = first or error
            else:
                return built
        raise InputError(f"None of the first {min(count, MAX_TRIALS)} structures can be built. Number 0: {first}")

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return self.n_units * self._per_structure * len(self.matrix.labels) * len(self.scales)

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        by_story = story_columns(self.matrix.structures).keys() - set(MAX_OF_STORIES)  # their number may be random
        head, *rest = ((name, kind) for name, kind in self.matrix.columns.items() if name not in by_story)
        drawn = dict.fromkeys(self.population.variables.kinds, float)
        of_structure = dict.fromkeys(FACTS, float) | columns_of_kind(OF_STRUCTURE, float)
        return dict([head]) | {"number": int} | drawn | of_structure | dict(rest)

    def records_of(self, number: int) -> list[int]:
        """Return the places of the records of a structure, in the order of the suite."""
        if self._per_structure == len(self.motions):
            return [*range(len(self.motions))]
        order = np.argsort(uniform_draws(self.seed, number, "", len(self.motions)), kind="stable")
        return sorted(order[: self._per_structure].tolist())

    def results(self, units: Sequence[int]) -> Table:
        """Draw a structure a unit, and simulate it; some at a time, which are prepared together."""
        parts = (units[first : first + STRUCTURES_PER_BATCH] for first in range(0, len(units), STRUCTURES_PER_BATCH))
        return joined_tables([self._results(part) for part in parts])

    def _results(self, units: Sequence[int]) -> dict[str, list[Any]]:
        drawn = {unit: self._drawn(unit) for unit in units}
        runs = [(unit, drawn[unit][1], run) for unit in units for run in self._runs(unit)]
        found = results_of_matrix_runs([(matrix, run) for _, matrix, run in runs], keep=False)
        for name in ("number", *self.population.variables.kinds, *FACTS, *OF_STRUCTURE.split()):
            found[name] = [drawn[unit][0].get(name) for unit, *_ in runs]
        return found

    def _drawn(self, unit: int) -> tuple[Row, StudyMatrix]:
        """Return what describes a structure, and the matrix for its runs, which fail if it cannot be built."""
        row: Row = {"number": unit}
        try:
            row |= self.population.variables.draw(self.seed, unit)
            properties = self.population.build(row)
            ground = self.population.ground_under(properties, row)
        except InputError as error:
            return row, self.matrix.without_structure(error)
        row |= random_structure_facts(properties)
        row |= {"resisting_moment": properties.resisting_moment, "recentring_ratio": properties.recentring_ratio}
        return row, self.matrix.on_ground(properties, ground)

    def _runs(self, number: int) -> Iterator[tuple[int, int, int, float]]:
        return self.matrix.cross(self.scales, [0], self.records_of(number))
