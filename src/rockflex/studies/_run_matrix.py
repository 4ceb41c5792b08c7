"""The structures, records and models of a study, and every run of one of each at a scale."""

import hashlib
import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any, Self, cast

import numpy as np

from rockflex.foundation.checks import real_or_nan
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import few_texts_shown, shown
from rockflex.models._label import Model
from rockflex.models._work import Task, WorkLimitError
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._measures import MEASURES, MeasureInput, scalable_measures
from rockflex.motion._recordings import recording_names
from rockflex.motion._suite import Suite
from rockflex.response._response import Response
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import (
    Models,
    Motions,
    RockingStructure,
    Structures,
    checked_models,
    checked_motions,
    checked_structures,
    rocking_properties_of,
)
from rockflex.studies._prepared_case import PreparedCase, RunKeywords, RunOptions, Scaled, peaks_of_runs
from rockflex.studies._result_tables import Columns, Row, Table, columns_of_kind, result_columns

Demands = Mapping[str, Callable[[Response], float]]

STUDY_COLUMNS = (
    *("error", "level", "number", "round", "overturned", "first_overturning_scale", "last_survival_scale"),
    *("resurrections", "right_censored", "half_width", "aspect_ratio", "tendon", "prestress_ratio", "stiffness_ratio"),
    *("resisting_moment", "tendon_factor", "dissipator_factor", "prestress", "dissipator_force", "weight"),
    *("weight_moment", "l0r_g", "recentring_ratio"),
)
"""Columns that some kind of study adds to those of a run."""


def checked_demands(demands: Demands | None, taken: Collection[str]) -> Demands:
    """Return demands whose names are free and whose values can be called."""
    if demands is None:
        return {}
    if not isinstance(demands, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"demands must be a dictionary from names of columns to functions of a Response, but {shown(demands)} was "
            'given. Write demands={"roof_acceleration": function}.',
            field="demands",
        )
    for name, demand in demands.items():
        if not isinstance(name, str) or not name or not callable(demand):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"demands must be functions of a Response by the names of their columns, but {shown(name)} is "
                f"{shown(demand)}. Give a text as the name, and a function.",
                field="demands",
            )
    known = [name for name in demands if name in taken]
    if known:
        raise InputError(
            f"demands: the table has a column {few_texts_shown(known)} already. Give the demand another name.",
            field="demands",
        )
    return dict(demands)


def friction_and_demand_columns(response: Response, demands: Demands, *, friction: bool) -> Row:
    """Return the friction that a response with its history requires, if asked for, and the value of each demand.

    A friction that cannot be found is a message in `error`; a demand that is no number is an `InputError`, but NaN is
    one.
    """
    found: Row = {name: _demand_value(name, demand, response) for name, demand in demands.items()}
    return found | _required_friction_column(response) if friction else found


def _required_friction_column(response: Response) -> Row:
    try:
        return {"required_friction": response.required_friction}
    except (SolverError, InputError) as error:
        return {"error": f"No required friction: {error}"}


def _is_nan_demand(found: object) -> bool:
    """Return whether a function answered NaN, as a number of Python or NumPy or an array without dimensions."""
    array = np.asarray(found)
    return array.ndim == 0 and array.dtype.kind == "f"


def _demand_value(name: str, demand: Callable[[Response], float], response: Response) -> float:
    what = f"{response.model} under {response.motion}"
    try:
        found = cast("object", demand(response))
    except Exception as error:
        error.add_note(f"This was raised by the demand {shown(name)} of {what}.")
        raise
    value = real_or_nan(found)
    if value != value and not _is_nan_demand(found):
        raise InputError(
            f"The demand {shown(name)} must return one number, but for {what} it returned {shown(found)}. Reduce it, "
            "by abs(...).max() for instance.",
            field="demands",
        )
    return value


def measures_for_structure(properties: RockingProperties, motion: GroundMotion) -> dict[str, float]:
    """Return the measures of a motion for a structure, by name; those of a mode are NaN for a rigid block."""
    omega, zeta = math.nan, math.nan
    if properties.n_modes:
        omega, zeta = float(properties.omega[0]), float(properties.zeta[0])
    rate = math.sqrt(properties.l0r * GRAVITY / properties.i_theta)
    shaking = MeasureInput(motion, omega, zeta, properties.uplift_acceleration, rate)
    return {measure.name: float(measure.of(shaking)) for measure in scalable_measures()}


def measures_of_scaled_motion(measures: dict[str, float], scale: float) -> dict[str, float]:
    """Return the measures of the motion multiplied by `scale`, which may be negative."""
    return {name: MEASURES[name].scaled(value, scale) for name, value in measures.items()}


Run = tuple[int, int, int, float]  # the places of a structure, a record and a model, and a scale


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


class RunMatrix:
    """Every structure with every model, and the runs of each under records at a scale.

    Engines are built when needed. A pickle holds none, so that it is small; they are rebuilt where it is loaded.
    `history` tells whether the response of each run with its history is kept, `floors` whether the peaks of the floors
    are tracked.
    """

    def __init__(
        self,
        structures: Sequence[RockingStructure | RockingProperties],
        motions: Sequence[GroundMotion],
        models: Sequence[Model],
        options: RunOptions,
        *,
        history: bool = False,
        floors: bool = False,
    ) -> None:
        self.structures, self.motions, self.models = list(structures), motions, models
        self.options, self.history, self.floors = options.for_models(models), history, floors
        self._cases: dict[tuple[int, int], PreparedCase | InputError] = {}

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"_cases": {}}

    def with_structure(self, structure: RockingStructure | RockingProperties) -> Self:
        """Return the runs of the same records and models with one structure in place of all."""
        other = object.__new__(type(self))
        vars(other).update(vars(self), structures=[structure], _cases={})
        return other

    def case(self, structure: int, model: int) -> PreparedCase | InputError:
        """Return the case of a structure and a model, which is built once, or the reason why there is none."""
        found = self._cases.get((structure, model))
        if found is None:
            try:
                properties = rocking_properties_of(self.structures[structure])
                found = self.options.case(self.models[model], properties, history=self.history, floors=self.floors)
            except InputError as error:
                found = error
            self._cases[structure, model] = found
        return found

    def cross(
        self, scales: Iterable[float], structures: Iterable[int] | None = None, records: Iterable[int] | None = None
    ) -> Iterator[Run]:
        """Yield the runs of every structure, record and model at every scale, structures outermost.

        `structures` and `records` are the places of some of them, in place of all.
        """
        chosen = range(len(self.structures)) if structures is None else structures
        shaking = range(len(self.motions)) if records is None else records
        return product(chosen, shaking, range(len(self.models)), scales)

    def run_at(self, place: int, n_levels: int) -> tuple[int, int, int, int]:
        """Return the places of the structure, record, model and level of a run of `cross`, from its own."""
        rest, level = divmod(place, n_levels)
        rest, model = divmod(rest, len(self.models))
        return *divmod(rest, len(self.motions)), model, level

    def scaled(self, runs: Iterable[Run]) -> list[Scaled]:
        """Return the case, the motion and the scale of runs."""
        return [(self.case(structure, model), self.motions[record], scale) for structure, record, model, scale in runs]

    def task(self, structure: int, record: int, model: int, scale: float) -> Task | None:
        """Return the task of a run, from which its work is estimated; None if the structure cannot have the model."""
        case = self.case(structure, model)
        return None if isinstance(case, InputError) else case.task(self.motions[record], scale)

    def check_work(self, runs: Iterable[Run]) -> None:
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


class StudyMatrix(RunMatrix):
    """The run matrix of a study, whose runs are rows of a table with intensity measures."""

    structures: list[RockingProperties]  # pyright: ignore[reportIncompatibleVariableOverride]
    motions: Suite  # pyright: ignore[reportIncompatibleVariableOverride]
    options: StudyOptions  # pyright: ignore[reportIncompatibleVariableOverride]

    def __init__(self, structures: Mapping[str, RockingProperties], motions: Suite, options: StudyOptions) -> None:
        super().__init__([*structures.values()], motions, options.models, options, history=options.history)
        self.names = list(structures)
        self.labels = [model.label for model in options.models]
        check_different_values("models", self.labels)
        if options.bouc_wen is not None and options.free_vibration is None:
            raise InputError(
                'free_vibration="settle" cannot tell when a hysteretic spring is at rest. Give the free vibration in '
                "seconds."
            )
        checked_demands(options.demands, [*self._own_columns, *STUDY_COLUMNS])
        self.facts = record_facts(motions)
        self._measures: dict[tuple[int, int], dict[str, float]] = {}

    def __getstate__(self) -> dict[str, Any]:
        return super().__getstate__() | {"_measures": {}}

    def limited(self, work_limit: float | None) -> "StudyMatrix":
        """Return the same runs with another work limit for each."""
        given = dict(zip(self.names, self.structures, strict=True))
        return StudyMatrix(given, self.motions, replace(self.options, work_limit=work_limit))

    def on_ground(self, properties: RockingProperties, ground: Ground | None) -> "StudyMatrix":
        """Return the runs of the same records and models on another structure and ground than the only one."""
        other = self.with_structure(properties)
        other._measures, other.options = {}, replace(self.options, ground=ground)
        return other

    def without_structure(self, reason: InputError) -> "StudyMatrix":
        """Return the runs of a structure that cannot be built: they all fail, and have no measures."""
        other, none = copy(self), {measure.name: math.nan for measure in scalable_measures()}
        other._cases = {(0, model): reason for model in range(len(self.models))}
        other._measures = {(0, record): none for record in range(len(self.motions))}
        return other

    @property
    def columns(self) -> Columns:
        """Columns of a run."""
        return self._own_columns | dict.fromkeys(self.options.demands, float) | {"error": str}

    @property
    def _own_columns(self) -> dict[str, type | Sequence[str]]:
        found: dict[str, type | Sequence[str]] = {"structure": self.names}
        found |= record_columns(self.motions)
        found |= {"model": self.labels, "scale": float}
        found |= dict.fromkeys((measure.name for measure in scalable_measures()), float)
        found |= result_columns(self.structures, with_ground=self.options.ground is not None) | {
            "nominal_limit": float,
            "zeta_1": float,
        }
        if self.options.friction:
            found["required_friction"] = float
        return found

    def measures(self, structure: int, record: int) -> dict[str, float]:
        """Intensity measures of a record at the scale 1; computed once."""
        found = self._measures.get((structure, record))
        if found is None:
            found = measures_for_structure(self.structures[structure], self.motions[record])
            self._measures[structure, record] = found
        return found

    def results(self, runs: Sequence[Run]) -> Table:
        """Simulate runs, those of a structure with a model together, and return their columns.

        A run that cannot be solved has a message in `error` and no results.
        """
        return results_of_matrix_runs([(self, run) for run in runs])


def results_of_matrix_runs(runs: Sequence[tuple[StudyMatrix, Run]], *, keep: bool = True) -> dict[str, list[Any]]:
    """Simulate runs of matrices with the same records and options, as `peaks_of_runs` does; return their columns."""
    if not runs:
        return {}
    peaks = peaks_of_runs([each for matrix, run in runs for each in matrix.scaled([run])], keep=keep)
    structures, records, models, scales = (list(places) for places in zip(*(run for _, run in runs), strict=True))
    facts, options = runs[0][0].facts, runs[0][0].options
    measures = [measures_of_scaled_motion(matrix.measures(run[0], run[1]), run[3]) for matrix, run in runs]
    found = {"structure": structures, "model": models, "scale": scales, **peaks.lists()}
    found |= {name: [facts[record][name] for record in records] for name in facts[0]}
    found |= {name: [each[name] for each in measures] for name in measures[0]}
    for name in ("nominal_limit", "zeta_1", "required_friction", *options.demands):
        found[name] = [None] * len(runs)
    for place, (matrix, (structure, _, model, _)) in enumerate(runs):
        case = matrix.case(structure, model)
        if place not in peaks.failures and isinstance(case, PreparedCase):
            p = case.model.properties
            found["nominal_limit"][place] = p.nominal_overturning_rotation
            found["zeta_1"][place] = float(p.zeta[0]) if p.n_modes else math.nan
        if place in peaks.responses:
            of_history = friction_and_demand_columns(peaks.responses[place], options.demands, friction=options.friction)
            for name, value in of_history.items():
                found[name][place] = value
    return found


def check_different_values(name: str, values: Sequence[str]) -> None:
    """Raise an InputError if a value occurs more than once."""
    repeated = [value for place, value in enumerate(values) if value in values[:place]]
    if repeated:
        raise InputError(f"{name}: {shown(repeated[0])} occurs more than once. Give each once.")


def check_base_can_lift(matrix: StudyMatrix, what: str) -> None:
    """Raise an InputError if the base of a model cannot lift; `what` it has, and why the study is not for it."""
    for model in matrix.options.models:
        if not model.lifts:
            raise InputError(f"models: {model.label} has {what}. Leave it out.")


def record_groups(motions: Iterable[GroundMotion]) -> list[str]:
    """Return the name of each motion's recording, which its components share because they are not independent.

    It is the record sequence number if known, else earthquake and station, else what two names share that differ only
    in the component (ABC000 and ABC090), else the name of the motion.
    """
    members = list(motions)
    alike = recording_names([each.name for each in members])
    return [_known_recording_name(each) or name for each, name in zip(members, alike, strict=True)]


def _known_recording_name(motion: GroundMotion) -> str | None:
    info = motion.metadata
    if info is not None and info.rsn is not None:
        return f"RSN{info.rsn}"
    if info is not None and info.event is not None and info.station is not None:
        return " ".join(str(part) for part in (info.event, info.year, info.station) if part is not None)
    return None


def record_checksums(motions: Iterable[GroundMotion]) -> dict[str, str]:
    """SHA-256 of each record's step and samples (little-endian doubles, vertical ones last), by its name."""
    return {motion.name: _record_checksum(motion) for motion in motions}


def _record_checksum(motion: GroundMotion) -> str:
    digest = hashlib.sha256(float(motion.dt).hex().encode())
    digest.update(motion.acceleration.astype("<f8").tobytes())
    if motion.vertical is not None:
        digest.update(motion.vertical.astype("<f8").tobytes())
    return digest.hexdigest()


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
    return {"motion": motions.names, "group": groups, **columns_of_kind("magnitude distance_km", float)}


class StudyRunKeywords(RunKeywords, total=False):
    """The options of a study's runs by name: those of a run, and the demands."""

    demands: Demands | None


def study_matrix(structures: Structures, motions: Motions, models: Models, keywords: StudyRunKeywords) -> StudyMatrix:
    """Check the arguments of a study in Python and return its matrix; structures without names are "S1", "S2", ..."""
    given: dict[str, Any] = {**keywords}
    demands = checked_demands(given.pop("demands", None), ())
    options = StudyOptions.of(**given)
    chosen = tuple(checked_models(models))
    suite = motions if isinstance(motions, Suite) else Suite(checked_motions(motions))
    listed, names = checked_structures(structures)
    names = names or [f"S{place}" for place in range(1, len(listed) + 1)]
    named = {name: rocking_properties_of(each) for name, each in zip(names, listed, strict=True)}
    return StudyMatrix(named, suite, replace(options, models=chosen, demands=demands))
