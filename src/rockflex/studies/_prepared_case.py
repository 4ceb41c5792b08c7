"""One run: the options, a model tied to its structure, and the peaks of several such runs as columns."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import accumulate
from typing import Any, Literal, Self, SupportsIndex, TypedDict, cast

import numpy as np
from numpy.typing import NDArray

from rockflex.engine.solution import Excitation, Solution, Solutions
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import shown
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import ImpactLaw
from rockflex.models._label import Model, parse_model
from rockflex.models._prepared_model import PreparedModel, Start, run_all, share_solvers
from rockflex.models._quantities import Quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.models._run_failures import explaining_engine_failures
from rockflex.models._work import Task
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._peaks import TrackedPeaks, tracked_quantities
from rockflex.response._respond import (
    STATUSES,
    columns_of_responses,
    missing_values,
    response_columns_of_runs,
    response_of_solution,
)
from rockflex.response._response import Response
from rockflex.response._sensitivity import TiedModel
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import (
    GroundChoice,
    InitialState,
    check_run_options,
    free_vibration_time,
    ground_under_structure,
)
from rockflex.studies.progress import ProgressChoice
from rockflex.studies.running import WORK_LIMIT, WorkLimit, checked_work_limit


@dataclass(frozen=True, eq=False)
class PreparedCase:
    """A model tied to a structure, with the options of its runs. Its engine is built once, for any number of runs.

    `free_vibration` is in s, None until settled; `initial` is the state at t = 0, None for rest; `work_limit` is in s.
    `history` tells whether the states are stored, and `floors` whether the peaks of the floors are tracked; `extra` are
    further quantities whose peaks are, by name, and `tracked` all of them.

    Raises
    ------
    InputError
        If a run with a hysteretic spring is to settle, or the numbers of the model overflow.
    """

    model: RockingModel
    free_vibration: float | None = 0.0
    initial: InitialState | None = None
    work_limit: float | None = WORK_LIMIT
    history: bool = False
    floors: bool = False
    extra: Mapping[str, Quantities] | None = None
    tracked: TrackedPeaks = field(init=False, repr=False)
    engine: PreparedModel = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if self.free_vibration is None and self.model.bouc_wen is not None:
            raise InputError(
                f'free_vibration="settle" cannot tell when the hysteretic spring of {self.model.label} is at rest. '
                "Give the free vibration in seconds.",
                field="free_vibration",
            )
        with explaining_engine_failures(self.model):
            tracked = tracked_quantities(self.model, floors=self.floors, more=self.extra)
        object.__setattr__(self, "tracked", tracked)
        extremes = None if tracked.extremes is None else tracked.extremes.quantities
        object.__setattr__(self, "engine", PreparedModel(self.model, tracked.peaks.quantities, extremes))

    @property
    def tied(self) -> TiedModel:
        """The model, its engine, and what runs track."""
        return TiedModel(self.model, self.engine, self.tracked)

    def task(self, motion: GroundMotion, scale: float = 1.0) -> Task:
        """Return the task of a run, from which its work is estimated."""
        return self.engine.task(
            Excitation(motion.acceleration, None, scale), motion.dt, self.free_vibration, history=self.history
        )

    def solve(self, motion: GroundMotion, scale: float = 1.0) -> Solution:
        """Run the motion at a scale and return the solution.

        Raises
        ------
        InputError
            If the initial state does not fit the model, or the run exceeds its work limit.
        SolverError
            If the run cannot be solved.
        """
        return solve_runs_together([(self, motion, scale)]).one(0)

    @property
    def start(self) -> Start:
        """The state of the model at t = 0; None if at rest."""
        return None if self.initial is None else self.initial.state(self.model)

    @property
    def batch_key(self) -> tuple[object, ...]:
        """Equal for cases whose runs can be solved together: of one stack, with the same options."""
        return self.engine.group, self.free_vibration, self.work_limit

    def run(self, motion: GroundMotion, scale: float = 1.0) -> Response:
        """Run the motion at a scale and return the response; raises the errors of `solve`."""
        return self.response(motion, self.solve(motion, scale))

    def response(self, motion: GroundMotion, solution: Solution) -> Response:
        """Return the response to a motion from its solution."""
        return response_of_solution(self.model, motion.name, solution, self.tracked)


def has_vertical_motion(motion: GroundMotion) -> bool:
    """Return whether the ground moves vertically in a motion."""
    return motion.vertical is not None and bool(motion.vertical.any())


class RunKeywords(TypedDict, total=False):
    """The options of a run by name, as functions of many runs take them; `simulate` has their meaning."""

    free_vibration: float | Literal["settle"]
    bouc_wen: BoucWen | None
    impact: ImpactLaw | None
    ground: GroundChoice
    work_limit: WorkLimit


class ManyKeywords(RunKeywords, total=False):
    """The options of many runs by name; `simulate_many` has their meaning."""

    initial: InitialState | None
    workers: SupportsIndex | None
    progress: ProgressChoice


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """The options of a run.

    `free_vibration` is in s, None until settled. `impact` stands in place of each model's own law. `bouc_wen` is the
    hysteresis of the models whose label ends in -BW, or of every model if `all_yield`. `ground` is the ground, or a
    function that returns that of each structure; None: rigid, without sliding. `initial` is the state at t = 0, None
    for rest. `work_limit` is the limit of the work of a run in s; None for no limit.
    """

    free_vibration: float | None = 0.0
    impact: ImpactLaw | None = None
    bouc_wen: BoucWen | None = None
    all_yield: bool = False
    ground: GroundChoice = None
    initial: InitialState | None = None
    work_limit: float | None = WORK_LIMIT

    @classmethod
    def of(
        cls,
        free_vibration: float | Literal["settle"] = 0.0,
        *,
        impact: ImpactLaw | None = None,
        bouc_wen: BoucWen | None = None,
        ground: GroundChoice = None,
        initial: InitialState | None = None,
        work_limit: WorkLimit = "default",
    ) -> Self:
        """Return the options that a function was called with."""
        if not isinstance(initial, InitialState | None):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"initial must be an InitialState or None, but {shown(initial)} was given. "
                "Write InitialState(rotation=...)."
            )
        free, limit = free_vibration_time(free_vibration), checked_work_limit(work_limit)
        check_run_options(bouc_wen, impact, ground)
        return cls(
            free_vibration=free, impact=impact, bouc_wen=bouc_wen, ground=ground, initial=initial, work_limit=limit
        )

    def for_models(self, models: Iterable[Model]) -> Self:
        """Return the options for a set of models: if no label ends in -BW, all of them have the hysteresis."""
        return replace(self, all_yield=not yielding_model_labels(models))

    def model_of(self, model: Model, properties: RockingProperties) -> RockingModel:
        """Return a model of a structure."""
        bouc_wen = self.bouc_wen if self.all_yield or model.yields else None
        return model.of(properties, self.impact, bouc_wen, ground_under_structure(properties, self.ground))

    def case(
        self,
        model: Model,
        properties: RockingProperties,
        *,
        history: bool = False,
        floors: bool = False,
        extra: Mapping[str, Quantities] | None = None,
    ) -> PreparedCase:
        """Return the runs of a model of a structure."""
        tied, of_runs = self.model_of(model, properties), (self.free_vibration, self.initial, self.work_limit)
        return PreparedCase(tied, *of_runs, history=history, floors=floors, extra=extra)


def yielding_model_labels(models: Iterable[str | Model]) -> list[str]:
    """Return the labels of the models that end in -BW."""
    return [model.label for model in map(parse_model, models) if model.yields]


# A case, a motion, and a factor on it; or in place of the case the reason why there is none.
PreparedRun = tuple[PreparedCase, GroundMotion, float]
Scaled = tuple[PreparedCase | InputError, GroundMotion, float]


@dataclass(frozen=True, eq=False)
class RunPeaks:
    """Results of some runs, by their places.

    `columns` are the status, as a place in `rockflex.response.STATUSES`, every scalar of the responses, and "max_" with
    the name of each `extra` quantity of the cases, which has one value, each of shape (count,); empty if all runs
    failed. The values of runs that failed mean nothing; their errors are the
    `failures`, in the order of the runs. `responses` are those of the runs of cases with histories.
    """

    count: int
    columns: Mapping[str, NDArray[Any]]
    failures: Mapping[int, InputError | SolverError]
    responses: Mapping[int, Response]

    @property
    def failed(self) -> NDArray[np.bool_]:
        """Which runs failed, shape (count,)."""
        return np.isin(np.arange(self.count), list(self.failures))

    @property
    def errors(self) -> list[str | None]:
        """The message of each run that failed, None for the others."""
        return [str(self.failures[place]) if place in self.failures else None for place in range(self.count)]

    def lists(self) -> dict[str, list[Any]]:
        """Return the results of all runs by name, None where a run failed, with the status in words and the errors."""
        found = {name: values.tolist() for name, values in self.columns.items()}
        found["status"] = [STATUSES[code] for code in found.get("status", ())] or [None] * self.count
        for values in found.values():
            for place in self.failures:
                values[place] = None
        return found | {"error": self.errors}

    @classmethod
    def joined(cls, parts: Iterable[Self]) -> Self:
        """Return the results of several sets of runs, one after another."""
        listed = list(parts)
        if len(listed) == 1:
            return listed[0]
        starts = [0, *accumulate(part.count for part in listed)]
        kinds = {name: values.dtype for part in listed for name, values in part.columns.items()}
        columns = {
            name: np.concatenate([part.columns.get(name, missing_values(part.count, kind)) for part in listed])
            for name, kind in kinds.items()
        }
        pairs = list(zip(starts, listed, strict=False))
        failures = {start + place: error for start, part in pairs for place, error in part.failures.items()}
        responses = {start + place: each for start, part in pairs for place, each in part.responses.items()}
        return cls(starts[-1], columns, failures, responses)


def solve_runs_together(runs: Sequence[PreparedRun]) -> Solutions:
    """Run motions, each at a scale on a case, where all cases are `batch_key` and the motions have one time step.

    The ground moves vertically in all runs, or in none. Only a single run can have a history. Runs that cannot be
    solved are among the failures.
    """
    case, motion, _ = runs[0]
    shaken = has_vertical_motion(motion)
    return run_all(
        [each.engine for each, *_ in runs],
        [Excitation(motion.acceleration, motion.vertical if shaken else None, scale) for _, motion, scale in runs],
        motion.dt,
        free_vibration=case.free_vibration,
        starts=None if case.initial is None else [each.start for each, *_ in runs],
        history=case.history,
        work_limit=case.work_limit,
    )


def share_case_preparation(runs: Iterable[Scaled]) -> None:
    """Let the cases of many runs that differ only in numbers, and have the same time steps, share their preparation."""
    steps = defaultdict[PreparedModel, set[float]](set)
    for case, motion, _ in runs:
        if isinstance(case, PreparedCase):
            steps[case.engine].add(motion.dt)
    share_solvers(steps)


def peaks_of_runs(runs: Sequence[Scaled], *, keep: bool = True) -> RunPeaks:
    """Run motions, each at a scale on a case; those that can be are prepared and solved together.

    Unless engines are to `keep` their tables for further runs, each releases them as soon as its runs have ended.
    """
    share_case_preparation(runs)
    columns, left = dict[str, NDArray[Any]](), Counter(case for case, *_ in runs)
    failures, responses = dict[int, InputError | SolverError](), dict[int, Response]()
    for places, solutions in _solutions_by_group(runs, failures):
        cases = [cast("PreparedCase", runs[place][0]) for place in places]
        failures |= {places[place]: error for place, error in solutions.failures.items()}
        if not cases[0].history:
            found = response_columns_of_runs([case.model for case in cases], solutions, cases[0].tracked)
            more = cases[0].tracked.peaks.named(solutions.peaks)
            found |= {f"max_{name}": more[name].reshape(len(cases)) for name in cases[0].extra or ()}
        elif solutions.failures:
            found = {}
        else:
            response = cases[0].response(runs[places[0]][1], solutions.one(0))
            responses[places[0]], found = response, columns_of_responses([response])
        where = np.array(places)
        for name, values in found.items():
            if name not in columns:
                columns[name] = missing_values(len(runs), values.dtype)
            columns[name][where] = values
        left.subtract(cases)
        if not keep:
            for case in {case for case in cases if not left[case]}:
                case.engine.release()
    return RunPeaks(len(runs), columns, dict(sorted(failures.items())), responses)


def _solutions_by_group(
    runs: Sequence[Scaled], failures: dict[int, InputError | SolverError]
) -> Iterator[tuple[list[int], Solutions]]:
    """Yield the places of runs that are solved together, one by one if there are histories, and their solutions."""
    alike, keys = dict[object, list[int]](), dict[PreparedCase, tuple[object, ...]]()
    for place, (case, motion, _) in enumerate(runs):
        if isinstance(case, InputError):
            failures[place] = case
            continue
        if case not in keys:
            keys[case] = case.batch_key
        kind = place if case.history else (keys[case], motion.dt, has_vertical_motion(motion))
        alike.setdefault(kind, []).append(place)
    for places in alike.values():
        try:
            yield places, solve_runs_together(cast("list[PreparedRun]", [runs[place] for place in places]))
        except (InputError, SolverError) as error:  # none of them can begin
            failures |= dict.fromkeys(places, error)
