"""Design of a base: its width and the tendon that holds it down (Section 4.1)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, Unpack

from numpy.typing import ArrayLike
from pydantic import Field, ValidationInfo, field_validator, model_validator

from rockflex.foundation.checks import checked_in_range, checked_instance, checked_instances, checked_positive
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.json import as_json_value
from rockflex.foundation.shown import shown
from rockflex.fragility._hazard import HazardCurve
from rockflex.fragility._limit_states import check_limit_columns
from rockflex.models._label import Model
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._toml_table import TomlTable
from rockflex.studies._arguments import Models, Motions, RockingStructure
from rockflex.studies._case_keys import FreeVibration, validator_of_check
from rockflex.studies._plan import PER_CHUNK
from rockflex.studies._result_tables import Columns, Row, Table
from rockflex.studies._run_matrix import StudyMatrix, check_base_can_lift, study_matrix
from rockflex.studies._run_plan import StudyKeywords, run_plan, split_keywords, study_of_matrix
from rockflex.studies.cloud import CloudPlan, Factors
from rockflex.studies.design._design_search import DesignSearchPlan
from rockflex.studies.design._design_table import design_table
from rockflex.studies.design._designs import (
    BaseDesign,
    DesignSearch,
    Scaling,
    TendonLevel,
    checked_design_factors,
    checked_half_widths,
    designs_of_structure,
    facts_of_design,
)
from rockflex.studies.design._exceedance_fit import (
    check_design_limit,
    check_hazard_damping,
    check_measure_of_record_alone,
    design_limit_state,
    first_damping_column,
)
from rockflex.studies.design._requirements import DesignCost, Requirement, checked_requirements
from rockflex.studies.spec import StructuresStudySpec

if TYPE_CHECKING:
    import pandas as pd


_OF_QUESTION = {"limits", "level", "target", "hazard", "measure", "search"}


@dataclass(frozen=True)
class DesignQuestion:
    """The question of a design study: its limits, the shaking at which each counts, and what a design may reach.

    `levels` and `targets` have a value, perhaps None, for each limit. `cost` is that of a search, None without one.
    """

    limits: Sequence[float | str]
    levels: Sequence[float | None]
    targets: Sequence[float | None]
    hazard: HazardCurve | None
    measure: str
    cost: DesignCost | None

    @classmethod
    def of_document(cls, spec: Mapping[str, Any]) -> Self:
        """Return the question of a study from its document, or from these keys of it."""
        limits: list[float | str] = spec["limits"]
        levels, targets = (
            given if isinstance(given, list) else [given] * len(limits)
            for given in (spec.get("level"), spec.get("target"))
        )
        hazard = None if spec.get("hazard") is None else HazardCurve(**spec["hazard"])
        cost = None if spec.get("search") is None else DesignCost(**spec["search"]["cost"])
        return cls(limits, levels, targets, hazard, spec["measure"], cost)

    @property
    def requirements(self) -> list[Requirement]:
        """The limits with their targets, for a search."""
        each = zip(self.limits, self.targets, self.levels, strict=True)
        return checked_requirements(
            [Requirement(limit, target, at, self.hazard, self.measure) for limit, target, at in each]  # pyright: ignore[reportArgumentType]
        )

    def tables(self, runs: "pd.DataFrame") -> "Iterator[tuple[float | str, float | None, pd.DataFrame]]":
        """Yield each limit with its target and the `design_table` of the runs."""
        for limit, target, at in zip(self.limits, self.targets, self.levels, strict=True):
            yield limit, target, design_table(runs, limit, measure=self.measure, at=at, hazard=self.hazard)


_FACTORS = "a list of factors on the {} of the structure, or a range {{smallest = 0.5, largest = 2.0, count = 4}}"
_SCALING = '"size" (force and stiffness) or "force"'


class TendonLevelTable(TomlTable):
    """The arguments of `TendonLevel`."""

    prestress_ratio: float = Field(0.0, description="the initial force over the weight m_tot g, a number")
    stiffness_ratio: float = Field(0.0, description="EA/L over L_0^r g/B², a number; 1 keeps the moment constant")
    yield_ratio: float | None = Field(None, description="the yield force over the weight m_tot g, a number")
    name: str = Field("", description="a name, in quotes")


class HazardCurveTable(TomlTable):
    """The arguments of `HazardCurve`."""

    im: list[float] = Field(description="a list of levels of the measure, in SI units, rising")
    rate: list[float] = Field(description="a list of annual rates at which they are exceeded, falling")
    damping: float = Field(0.05, description="the damping ratio of a spectral measure, a number")


class DesignCostTable(TomlTable):
    """The arguments of `DesignCost`."""

    half_width: float = Field(0.0, description="the cost of each metre of the half width B, a number")
    prestress: float = Field(0.0, description="the cost of each newton of the tendons' initial forces, a number")
    dissipator_force: float = Field(
        0.0, description="the cost of each newton of the dissipators' yield forces, a number"
    )


class DesignSearchTable(TomlTable):
    """The arguments of `DesignSearch` other than those of the study itself, and the unit costs."""

    cost: DesignCostTable = Field(
        description="a table of half_width, prestress and dissipator_force, in cost/m and cost/N"
    )
    tendon_factors: list[float] = Field([1.0], description=_FACTORS.format("tendons"))
    dissipator_factors: list[float] = Field([1.0], description=_FACTORS.format("dissipators"))
    tendon_scaling: Scaling = Field("size", description=_SCALING)
    dissipator_scaling: Scaling = Field("size", description=_SCALING)
    refinements: int = Field(4, description="how often the distance of neighbouring values is halved, a whole number")
    designs_per_refinement: int = Field(8, description="the largest number of designs of a refinement, a whole number")

    @field_validator("tendon_factors", "dissipator_factors", mode="before")
    @classmethod
    def _factors(cls, given: object, info: ValidationInfo) -> object:
        return list(checked_design_factors(str(info.field_name), given)) if isinstance(given, list | dict) else given


class DesignStudy(StructuresStudySpec):
    """One structure on bases of many half widths B, with tendons of a few levels, under all records.

    The table has one row per run and the columns of `run_design`. `limits`, `measure`, `level` or `hazard`, and
    `target` define the requirements: see `design_table` and `smallest_width`. `level` and `target` are numbers, or
    lists with one for each limit.

    With a table `search`, width, tendons and dissipators are searched together for the cheapest design that meets all
    requirements; the columns are then those of `search_design`, and `best_design` evaluates them.

    With ``limits = []`` the study only stores the runs, and needs no level, hazard or target.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = {"n_stories": 3, "story_height": 3.0, "story_mass": 40e3,
    ...     "base_mass": 40e3, "stiffness_ratio": 1e9,
    ...          "period": 0.6, "aspect_ratio": 6.0, "damping_ratio": 0.02}
    >>> study = rf.DesignStudy(
    ...     structures=[{"frame": frame}], records={"suites": ["el-centro-1940"]},
    ...     half_widths=[1.0, 1.5], level=0.5)
    >>> study.plan().columns["structure"]
    ['B = 1 m', 'B = 1.5 m']
    """

    study: Literal["design"] = Field("design", description='"design"')
    structures: list[StructureEntry] = Field(min_length=1, max_length=1, description="one table [[structures]]")
    free_vibration: FreeVibration = "settle"
    half_widths: list[float] = Field(
        description="a list of half widths B in m, or a range {smallest = 1.0, largest = 3.0, count = 9}"
    )
    tendons: list[TendonLevelTable] = Field(
        default_factory=list[TendonLevelTable], description="a list of tables, each under a heading [[tendons]]"
    )
    base_mass_per_width: float = Field(
        0.0, description="the mass that the base gains for each metre of its width 2 B, a number in kg/m"
    )
    scales: Factors = Field([1.0])
    limits: Annotated[list[float | str], validator_of_check(lambda limits: [*map(check_design_limit, limits)])] = Field(
        ["overturning"],
        description='a list of limits, such as [0.02, "0.5 nominal", "overturning"]; [] to store runs alone',
    )
    measure: Annotated[str, validator_of_check(check_measure_of_record_alone)] = Field(
        "pgv", description='the intensity measure, such as "pga", "pgv" or "sa_t1_5"'
    )
    level: float | list[float] | None = Field(
        None, description="the level of the measure in SI units, a number, or a list of one for each limit"
    )
    hazard: HazardCurveTable | None = Field(None, description="a table of the lists im and rate, and damping")
    target: float | list[float] | None = Field(
        None,
        description="the probability, or with a hazard the annual rate, that a design must not exceed, a number, or a "
        "list of one for each limit",
    )
    search: DesignSearchTable | None = Field(
        None, description="a table of a search for the cheapest design, under the heading [search]"
    )

    @field_validator("tendons", mode="before")
    @classmethod
    def _levels(cls, given: Any) -> Any:
        several = isinstance(given, list | tuple)
        return [asdict(each) if isinstance(each, TendonLevel) else each for each in given] if several else given

    @field_validator("hazard", mode="before")
    @classmethod
    def _curve(cls, given: Any) -> Any:
        return as_json_value(given) if isinstance(given, HazardCurve) else given

    @field_validator("half_widths", mode="before")
    @classmethod
    def _widths(cls, given: object) -> object:
        return checked_half_widths(given) if isinstance(given, list | dict) else given

    @model_validator(mode="after")
    def _question(self) -> "DesignStudy":
        if len(self.structures) != 1:
            raise InputError(f"structures: a design study has one structure, but {len(self.structures)} were given.")
        if self.limits and (self.level is None) == (self.hazard is None):
            raise InputError("level and hazard: give one of them, not both, for the strength of the shaking.")
        for name in ("level", "target"):
            given = getattr(self, name)
            if isinstance(given, list) and len(given) != len(self.limits):  # pyright: ignore[reportUnknownArgumentType]
                raise InputError(
                    f"{name} must be one number, or one for each of the {len(self.limits)} limits, but "
                    f"{shown(given)} was given."
                )
        question = self.question
        for level, target in zip(question.levels, question.targets, strict=True):
            if level is not None:
                checked_positive("level", level, "the unit of the measure")
            if target is not None:
                checked_positive("target", target, "probability or 1/year")
                if question.hazard is None:
                    checked_in_range("target", target, 0.0, 1.0, hint="With a level it is a probability.")
        return self

    @model_validator(mode="after")
    def _searched(self) -> "DesignStudy":
        if self.search is None:
            return self
        if self.target is None:
            raise InputError(
                "target is missing: a search needs the probability or annual rate that must not be exceeded."
            )
        if self.tendons:
            raise InputError(
                "A search varies the elements of the structure itself by factors. Leave out the levels [[tendons]], "
                "and give the structure its tendons as [[structures.elements]]."
            )
        _ = self.question.requirements, self._space(self.search)
        return self

    @property
    def question(self) -> DesignQuestion:
        """Limits, shaking, targets and cost."""
        return DesignQuestion.of_document(self.model_dump(include=_OF_QUESTION))

    def _space(self, search: DesignSearchTable) -> DesignSearch:
        given: dict[str, Any] = search.model_dump(exclude={"cost"})
        return DesignSearch(self.half_widths, base_mass_per_width=self.base_mass_per_width, **given)  # pyright: ignore[reportArgumentType]

    def plan(self) -> "DesignPlan | DesignSearchPlan":
        """Build the designs, load the records, and cut the study into chunks.

        Raises
        ------
        InputError
            If a design cannot be built, a record cannot be read, a limit is out of range for a design, a model's base
            cannot lift, or measure and hazard curve are of different damping.
        """
        matrix = self.matrix()
        if self.search is not None:
            question = self.question
            wanted, cost = question.requirements, question.cost
            assert cost is not None  # a search has one
            return DesignSearchPlan(matrix, self._space(self.search), wanted, cost, self.scales, self.runs_per_chunk)
        levels = [TendonLevel(**each.model_dump()) for each in self.tendons]
        (properties,) = matrix.structures
        if (hazard := self.question.hazard) is not None:
            check_hazard_damping(hazard, first_damping_column(properties), self.measure)
        designs = designs_of_structure(properties, self.half_widths, levels, self.base_mass_per_width)
        for design in designs:
            for limit in self.limits:
                try:
                    state = design_limit_state(limit, design.properties.nominal_overturning_rotation)
                    check_limit_columns([state], matrix.columns)
                except InputError as error:
                    raise InputError(f"{design.name}: {error}") from error
        return DesignPlan(matrix, designs, self.scales, self.runs_per_chunk)


ORDER = ("half_width", "aspect_ratio", "tendon", "prestress_ratio", "stiffness_ratio", "resisting_moment")


class DesignPlan(CloudPlan):
    """The cross product of designs, records, models and scales, cut into chunks."""

    def __init__(
        self, matrix: StudyMatrix, designs: Sequence[BaseDesign], scales: Sequence[float], per_chunk: int
    ) -> None:
        check_base_can_lift(matrix, "a fixed base, so the base width has no effect")
        self._tendons = list(dict.fromkeys(design.tendon for design in designs))
        self._facts = [self._facts_of(design) for design in designs]
        made = StudyMatrix({each.name: each.properties for each in designs}, matrix.motions, matrix.options)
        super().__init__(made, scales, per_chunk)

    def _facts_of(self, design: BaseDesign) -> Row:
        p = design.properties
        found: Row = {**facts_of_design(p), "tendon": self._tendons.index(design.tendon)}
        found["stiffness_ratio"] = p.tendon_stiffness / (p.l0r * GRAVITY)
        return {name: found[name] for name in ORDER}

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        facts = {name: self._tendons if name == "tendon" else float for name in self._facts[0]}
        return {"structure": self.matrix.names, **facts, **self.matrix.columns}

    def results(self, units: Sequence[int]) -> Table:
        """Simulate one run a unit."""
        found = super().results(units)
        return {**found, **{name: [self._facts[each][name] for each in found["structure"]] for name in self._facts[0]}}


def run_design(
    structure: RockingStructure | RockingProperties,
    motions: Motions,
    half_widths: ArrayLike,
    tendons: Sequence[TendonLevel] = (),
    models: Models = "MDOF-S",
    scales: float | Sequence[float] = 1.0,
    base_mass_per_width: float = 0.0,
    **options: Unpack[StudyKeywords],
) -> "pd.DataFrame":
    """Simulate a structure on bases of many widths, with tendons of a few levels, under every motion.

    The structure above the base does not change; I_θ changes with m_tot B² (Silva & Stojadinović 2024, Table 2).

    Parameters
    ----------
    structure
        A structure, or its `RockingProperties`, on a base of any width. Its own tendons keep their forces,
        stiffnesses and positions.
    motions
        As in `run_cloud`.
    half_widths : array_like, shape (n,)
        B in m, positive.
    tendons
        Levels of a tendon on the axis, each with every width; `TendonLevel()` means none. Default: the structure's own.
    models, scales
        As in `run_cloud`.
    base_mass_per_width
        Mass in kg/m that the base gains for each metre of width 2 B above the structure's own width, and loses for each
        metre below it. Default: 0, a constant base mass.
    options
        As in `run_cloud`, but ``free_vibration="settle"`` by default. A `folder` is that of the `DesignStudy` of these
        arguments with ``limits=[]`` and ``runs_per_chunk=64``.

    Returns
    -------
    pandas.DataFrame
        One row per run, in the order of tendons, increasing half widths, motions, models and scales. The columns are
        those of `run_cloud`, where `structure` names the design, followed by `half_width` (m); `aspect_ratio` = h*_1/B;
        `tendon`, the name of the level; `prestress_ratio` = ΣF_0/(m_tot g); `stiffness_ratio` = the tendons' stiffness
        against rotation over L_0^r g, about the edge that lifts first; `resisting_moment` (M_r in N m).

    Raises
    ------
    InputError
        If a half width is not positive or occurs twice, a model's base cannot lift, a design cannot be built, or as in
        `run_cloud`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> runs = rf.run_design(frame, pulses, half_widths=[1.0, 1.5],
    ...     models="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> len(runs)
    16
    >>> runs["structure"].cat.categories.tolist()
    ['B = 1 m', 'B = 1.5 m']
    """
    given: Any = scales
    run, place = split_keywords({"free_vibration": "settle", **options})
    matrix = study_matrix([structure], motions, models, run)
    levels = checked_instances("tendons", tendons, TendonLevel)
    designs = designs_of_structure(matrix.structures[0], half_widths, levels, base_mass_per_width)
    plan = DesignPlan(matrix, designs, given, PER_CHUNK)

    def study() -> DesignStudy:
        return study_of_matrix(
            DesignStudy, structure, matrix, run, scales=plan.scales, limits=[],
            half_widths=checked_half_widths(half_widths), tendons=levels, base_mass_per_width=base_mass_per_width,
        )  # fmt: skip

    return run_plan(plan, study=study, **place)


def search_design(
    structure: RockingStructure | RockingProperties,
    motions: Motions,
    search: DesignSearch,
    requirements: Sequence[Requirement],
    cost: DesignCost,
    model: str | Model = "MDOF-S",
    scales: float | Sequence[float] = 1.0,
    **options: Unpack[StudyKeywords],
) -> "pd.DataFrame":
    """Search base width, tendons and dissipators together for the cheapest design that meets all requirements.

    All combinations of the values of the search are run under all motions, then the designs of each refinement; the
    same call always runs the same designs. `best_design` evaluates the table.

    Parameters
    ----------
    structure
        A structure, or its `RockingProperties`, with the elements that the factors of the search multiply.
    motions, scales
        As in `run_cloud`.
    search
        The values of the variables, and the number of refinements.
    requirements
        Limits with their targets, which all must be met.
    cost
        Unit costs of the width and of the forces.
    model
        One model, as in `simulate`.
    options
        As in `run_cloud`, but ``free_vibration="settle"`` by default; `progress` is counted in designs. A `folder` is
        that of the `DesignStudy` with a `search` of these arguments and ``runs_per_chunk=64``; its requirements have
        one measure, and either levels or one hazard curve.

    Returns
    -------
    pandas.DataFrame
        One row per run, in the order of the search. The columns are those of `run_cloud`, where `structure` numbers the
        designs, and after it: `round`, 0 for the values given; `half_width` (m), `tendon_factor`, `dissipator_factor`;
        `aspect_ratio` = h*_1/B; `prestress` = ΣF_0 and `dissipator_force` = ΣF_y in N; `prestress_ratio` =
        ΣF_0/(m_tot g); `resisting_moment` (M_r in N m).

    Raises
    ------
    InputError
        If the structure lacks elements for the factors, a design cannot be built, the model's base cannot lift, or as
        in `run_cloud`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0],
    ...     refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(
    ...     half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost,
    ...     model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> runs.groupby("round")["structure"].nunique().tolist()
    [9, 8]
    """
    given: Any = scales
    run, place = split_keywords({"free_vibration": "settle", **options})
    matrix = study_matrix([structure], motions, [model], run)
    wanted = checked_requirements(requirements)
    space, unit_costs = checked_instance("search", search, DesignSearch), checked_instance("cost", cost, DesignCost)
    plan = DesignSearchPlan(matrix, space, wanted, unit_costs, given, PER_CHUNK)

    def study() -> DesignStudy:
        first, table = wanted[0], as_json_value(space) | {"cost": asdict(unit_costs)}
        if any((each.measure, each.hazard) != (first.measure, first.hazard) for each in wanted):
            raise InputError(
                "requirements: a folder stores those of one measure, with levels or with one hazard curve. Leave out "
                "folder, or search with the others alone."
            )
        return study_of_matrix(
            DesignStudy, structure, matrix, run, scales=plan.scales,
            half_widths=table.pop("half_widths"),
            base_mass_per_width=table.pop("base_mass_per_width"), search=table,
            limits=[each.limit for each in wanted], target=[each.target for each in wanted], measure=first.measure,
            level=[each.at for each in wanted] if first.hazard is None else None, hazard=first.hazard,
        )  # fmt: skip

    return run_plan(plan, study=study, **place)
