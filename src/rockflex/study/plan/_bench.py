"""The structures, records and models of a study, prepared for its runs."""

import math
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from rockflex._checks import instance
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import Ground, RockingProperties
from rockflex.models import BoucWen, ImpactLaw, Model
from rockflex.motion import Suite, intensities
from rockflex.response import Response
from rockflex.solve import Task, WorkLimitError
from rockflex.study._arguments import (
    WORK_LIMIT,
    GroundChoice,
    properties_of,
)
from rockflex.study._case import Case, prepare_together
from rockflex.study._peaks import peaks_of
from rockflex.study._results import result_columns, results_of
from rockflex.study._run_options import RunOptions
from rockflex.study._subjects import Models, Motions, Structures, models_of, motions_of, structures_of
from rockflex.study._tables import Columns, Row, kinds_of
from rockflex.study.plan._demands import Demands, checked_demands, derived
from rockflex.study.plan._intensity import intensity_measures, scaled_measures
from rockflex.study.plan._records import record_groups

Run = tuple[int, int, int, float]  # the places of a structure, a record and a model, and a scale

BRIEF = 3  # samples of a record that a rehearsal runs


@dataclass(frozen=True, kw_only=True)
class StudyOptions(RunOptions):
    """The options that all runs of a study share.

    `models` are those of every structure; `friction` tells whether the friction that each run requires is computed, and
    `demands` are functions of each response by the names of their columns.
    """

    models: tuple[Model, ...] = ()
    friction: bool = False
    demands: Demands = field(default_factory=dict[str, Any])

    @property
    def history(self) -> bool:
        """Whether runs need their history."""
        return self.friction or bool(self.demands)


class Bench:
    """Structures, records and models, with their engines, which are built when needed.

    A pickle holds no engines, so that it is small; they are rebuilt where it is loaded.
    """

    def __init__(self, structures: Mapping[str, RockingProperties], motions: Suite, options: StudyOptions) -> None:
        self.names, self.structures = list(structures), list(structures.values())
        self.motions, self.options = motions, options.among(options.models)
        self.labels = [model.label for model in options.models]
        check_different("models", self.labels)
        if options.bouc_wen is not None and options.free_vibration is None:
            raise InputError(
                'free_vibration="settle" cannot tell when a hysteretic spring is at rest. Give the free vibration in '
                "seconds."
            )
        self._facts = record_facts(motions)
        self._cases: dict[tuple[int, int], Case | str] = {}
        self._measures: dict[tuple[int, int], dict[str, float]] = {}

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"_cases": {}, "_measures": {}}

    def limited(self, work_limit: float | None) -> "Bench":
        """Return the same bench with another work limit for each run."""
        given = dict(zip(self.names, self.structures, strict=True))
        return Bench(given, self.motions, replace(self.options, work_limit=work_limit))

    def with_structure(self, properties: RockingProperties, ground: Ground | None) -> "Bench":
        """Return a bench of the same records and models with another structure and ground in place of the only one."""
        other = copy(self)
        other.structures, other._cases, other._measures = [properties], {}, {}
        other.options = replace(self.options, ground=ground)
        return other

    @property
    def columns(self) -> Columns:
        """Columns of a run."""
        found: dict[str, type | Sequence[str]] = {"structure": self.names}
        found |= record_columns(self.motions)
        found |= {"model": self.labels, "scale": float}
        found |= dict.fromkeys((measure.name for measure in intensities()), float)
        found |= result_columns(self.structures, grounded=self.options.ground is not None) | {
            "nominal_limit": float,
            "zeta_1": float,
        }
        if self.options.friction:
            found["required_friction"] = float
        return found | dict.fromkeys(self.options.demands, float) | {"error": str}

    def measures(self, structure: int, record: int) -> dict[str, float]:
        """Intensity measures of a record at the scale 1; computed once."""
        found = self._measures.get((structure, record))
        if found is None:
            found = intensity_measures(self.structures[structure], self.motions[record])
            self._measures[structure, record] = found
        return found

    def head(self, structure: int, record: int, model: int, scale: float) -> Row:
        """Return the columns of a run that need no simulation."""
        return {"structure": structure, **self._facts[record], "model": model, "scale": scale}

    def run(self, structure: int, record: int, model: int, scale: float) -> Row:
        """Simulate one run and return its row; if it cannot be solved, the row has a message and no results."""
        return self.run_all([(structure, record, model, scale)])[0]

    def run_all(self, runs: Sequence[Run]) -> list[Row]:
        """Simulate runs and return their rows, as `run` does; those of a structure with a model together."""
        alike = dict[tuple[int, int], list[int]]()
        for place, (structure, _, model, _) in enumerate(runs):
            alike.setdefault((structure, model), []).append(place)
        prepare_together(self._case(*pair) for pair in alike)
        rows: list[Row] = [self.head(*run) for run in runs]
        for (structure, model), places in alike.items():
            some = [(runs[place][1], runs[place][3]) for place in places]
            for place, (record, scale), found in zip(places, some, self._results(structure, model, some), strict=True):
                rows[place] |= scaled_measures(self.measures(structure, record), scale) | found
        return rows

    def _results(self, structure: int, model: int, runs: Sequence[tuple[int, float]]) -> list[Row]:
        """Return the results of a structure with a model under records, each at a scale."""
        case = self._case(structure, model)
        if isinstance(case, str):
            return [{"error": case} for _ in runs]
        scaled = [(self.motions[record], scale) for record, scale in runs]
        properties = case.model.properties
        limit = {"nominal_limit": properties.nominal_overturning_rotation}
        limit["zeta_1"] = float(properties.zeta[0]) if properties.n_modes else math.nan
        if not self.options.history:
            return [row if "error" in row else row | limit for row in peaks_of(case, scaled).rows()]
        found = [case.attempt(*each) for each in scaled]
        return [
            results_of(each) | limit | self._derived(each) if isinstance(each, Response) else {"error": str(each)}
            for each in found
        ]

    def _derived(self, response: Response) -> Row:
        return derived(response, self.options.demands, friction=self.options.friction)

    def task(self, structure: int, record: int, model: int, scale: float) -> Task | None:
        """Return the task of a run, from which its work is estimated; None if the structure cannot have the model."""
        case = self._case(structure, model)
        return None if isinstance(case, str) else case.task(self.motions[record], scale)

    def check_work(self, runs: Iterable[tuple[int, int, int, float]]) -> None:
        """Raise the error of the first of these runs if every one of them exceeds its work limit."""
        first: WorkLimitError | None = None
        for run in runs:
            task = self.task(*run)
            if task is None:
                return
            try:
                task.check(self.options.work_limit)
            except WorkLimitError as error:
                first = first or error
            else:
                return
        if first is not None:
            raise first

    def _case(self, structure: int, model: int) -> Case | str:
        """Return the case of a structure and a model, which is built once, or the reason why there is none."""
        found = self._cases.get((structure, model))
        if found is None:
            found = self._cases[structure, model] = self._new_case(structure, model)
        return found

    def cases(self, structure: int) -> list[Case | str]:
        """Return the cases of a structure with all models, or the reasons why there are none."""
        return [self._case(structure, model) for model in range(len(self.labels))]

    def _new_case(self, structure: int, model: int) -> Case | str:
        try:
            return self.options.case(
                self.options.models[model], self.structures[structure], history=self.options.history
            )
        except InputError as error:
            return str(error)


def check_different(name: str, values: Sequence[str]) -> None:
    """Raise an InputError if a value occurs more than once."""
    repeated = [value for place, value in enumerate(values) if value in values[:place]]
    if repeated:
        raise InputError(f"{name}: {shown(repeated[0])} occurs more than once. Give each once.")


def check_lifts(bench: Bench, what: str) -> None:
    """Raise an InputError if the base of a model cannot lift; `what` it has, and why the study is not for it."""
    for model in bench.options.models:
        if not model.lifts:
            raise InputError(f"models: {model.label} has {what}. Leave it out.")


def record_facts(motions: Suite) -> list[Row]:
    """Return the columns that describe each record; its name and group are codes."""
    names = record_groups(motions)
    groups = list(dict.fromkeys(names))
    facts: list[Row] = []
    for place, motion in enumerate(motions):
        info = motion.metadata
        facts.append(
            {
                "motion": place,
                "group": groups.index(names[place]),
                "magnitude": None if info is None else info.magnitude,
                "distance_km": None if info is None else info.distance_km,
            }
        )
    return facts


def record_columns(motions: Suite) -> Columns:
    """Return the columns that `record_facts` fills."""
    groups = list(dict.fromkeys(record_groups(motions)))
    return {"motion": motions.names, "group": groups, **kinds_of("magnitude distance_km", float)}


def bench_of(
    structures: Structures,
    motions: Motions,
    models: Models,
    free_vibration: float | Literal["settle"],
    bouc_wen: BoucWen | None,
    impact: ImpactLaw | None,
    *,
    friction: bool = False,
    work_limit: float | None = WORK_LIMIT,
    ground: GroundChoice = None,
    demands: Demands | None = None,
) -> Bench:
    """Check the arguments of a study in Python and return its bench; structures without names are "S1", "S2", ...

    Raises
    ------
    InputError
        If a label is unknown, a sequence is empty or holds something else, two motions have the same name, or an
        option is out of range.
    """
    instance("friction", friction, bool)
    chosen = tuple(models_of(models))
    options = StudyOptions.of(free_vibration, impact=impact, bouc_wen=bouc_wen, ground=ground, work_limit=work_limit)
    suite = motions if isinstance(motions, Suite) else Suite(motions_of(motions))
    listed, names = structures_of(structures)
    names = names or [f"S{place}" for place in range(1, len(listed) + 1)]
    named = {name: properties_of(each) for name, each in zip(names, listed, strict=True)}
    options = replace(options, models=chosen, friction=friction)
    bench = Bench(named, suite, options)
    own = checked_demands(demands, bench.columns)
    return Bench(named, suite, replace(options, demands=own)) if own else bench
