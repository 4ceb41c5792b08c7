"""One run: the options, a model tied to its structure, and the peaks of several such runs as columns."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from rockflex._errors import InputError, SolverError
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.models import BoucWen, ImpactLaw, Model, Quantities, RockingModel, parse_model
from rockflex.motion import GroundMotion
from rockflex.response import (
    STATUSES,
    Response,
    columns_among,
    columns_of,
    respond,
    tracked_extremes,
    tracked_quantities,
)
from rockflex.solve import Engine, Excitation, Solution, Solutions, Task, gather, preparing
from rockflex.study._arguments import (
    WORK_LIMIT,
    GroundChoice,
    InitialState,
    check_options,
    free_vibration_time,
    ground_under,
    work_limit_of,
)


@dataclass(frozen=True, eq=False)
class Case:
    """A model tied to a structure, with the options of its runs. Its engine is built once, for any number of runs.

    Attributes
    ----------
    model
        The model, tied to its structure.
    free_vibration
        Seconds of free vibration; None means until settled.
    initial
        The state at t = 0; at rest if None.
    work_limit
        Limit of the work of a run in s; None for no limit.
    history
        Whether the history of the states is stored.
    floors
        Whether the peaks of the floors are tracked.
    extra
        Additional quantities whose peaks are tracked.
    engine
        The engine of the model, ready to run records.

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
    extra: Quantities | None = None
    engine: Engine = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if self.free_vibration is None and self.model.bouc_wen is not None:
            raise InputError(
                f'free_vibration="settle" cannot tell when the hysteretic spring of {self.model.label} is at rest. '
                "Give the free vibration in seconds.",
                field="free_vibration",
            )
        with preparing(self.model):
            asked = tracked_quantities(self.model, floors=self.floors)
        asked = asked if self.extra is None else asked + self.extra
        most = tracked_extremes(self.model)
        object.__setattr__(self, "engine", Engine(self.model, asked, most))

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
        return self.solve_all([(motion, scale)], motion.dt, shaken=has_vertical(motion)).one(0)

    def solve_all(self, runs: Sequence[tuple[GroundMotion, float]], dt: float, *, shaken: bool) -> Solutions:
        """Run motions with one time step, each at a scale, which are all `shaken` vertically or none of them.

        Only a single run can have a history. Runs that cannot be solved are among the failures.

        Raises
        ------
        InputError
            If the initial state does not fit the model, or its numbers overflow.
        """
        return self.engine.run_all(
            [Excitation(motion.acceleration, motion.vertical if shaken else None, scale) for motion, scale in runs],
            dt,
            free_vibration=self.free_vibration,
            state=None if self.initial is None else self.initial.state(self.model),
            history=self.history,
            work_limit=self.work_limit,
        )

    def run(self, motion: GroundMotion, scale: float = 1.0) -> Response:
        """Run the motion at a scale and return the response; raises the errors of `solve`."""
        return respond(self.model, motion.name, self.solve(motion, scale), floors=self.floors)

    def attempt(self, motion: GroundMotion, scale: float = 1.0) -> Response | InputError | SolverError:
        """Run the motion at a scale and return the response, or the error of `solve`."""
        try:
            return self.run(motion, scale)
        except (InputError, SolverError) as error:
            return error


def prepare_together(cases: Iterable[object]) -> None:
    """Let those of many cases that differ only in numbers share their preparation."""
    gather(case.engine for case in cases if isinstance(case, Case))


def has_vertical(motion: GroundMotion) -> bool:
    """Return whether the ground moves vertically in a motion."""
    return motion.vertical is not None and bool(motion.vertical.any())


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """The options of a run.

    Attributes
    ----------
    free_vibration
        Seconds of free vibration after the record; None until settled.
    impact
        Impact law in place of each model's own, if not None.
    bouc_wen
        Hysteresis of the models whose label ends in -BW, or of every model if `all_yield`.
    ground
        The ground, or a function that returns the ground of each structure; None: rigid, without sliding.
    initial
        The state at t = 0; at rest if None.
    work_limit
        Limit of the work of a run in s; None for no limit.
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
        work_limit: float | Literal["none"] | None = WORK_LIMIT,
    ) -> Self:
        """Return the options that a function was called with.

        Raises
        ------
        InputError
            If one of them is out of range or of the wrong kind.
        """
        if not isinstance(initial, InitialState | None):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"initial must be an InitialState or None, but {shown(initial)} was given. "
                "Write InitialState(rotation=...)."
            )
        free, limit = free_vibration_time(free_vibration), work_limit_of(work_limit)
        check_options(bouc_wen, impact, ground)
        return cls(
            free_vibration=free, impact=impact, bouc_wen=bouc_wen, ground=ground, initial=initial, work_limit=limit
        )

    def among(self, models: Iterable[Model]) -> Self:
        """Return the options for a set of models: if no label ends in -BW, all of them have the hysteresis."""
        return replace(self, all_yield=not yielding(models))

    def tied(self, model: Model, properties: RockingProperties) -> RockingModel:
        """Return a model of a structure.

        Raises
        ------
        InputError
            If the structure cannot have the model, or the model these options.
        """
        bouc_wen = self.bouc_wen if self.all_yield or model.yields else None
        return model.of(properties, self.impact, bouc_wen, ground_under(properties, self.ground))

    def case(self, model: Model, properties: RockingProperties, *, history: bool = False, floors: bool = False) -> Case:
        """Return the runs of a model of a structure.

        Raises
        ------
        InputError
            As `tied`, or as `Case`.
        """
        tied = self.tied(model, properties)
        return Case(tied, self.free_vibration, self.initial, self.work_limit, history=history, floors=floors)


def yielding(models: Iterable[str | Model]) -> list[str]:
    """Return the labels of the models that end in -BW."""
    return [model.label for model in map(parse_model, models) if model.yields]


Scaled = tuple[GroundMotion, float]  # a motion, and the factor on its acceleration


@dataclass(frozen=True, eq=False)
class Peaks:
    """Results of some runs.

    Attributes
    ----------
    count
        Number of runs.
    columns
        The status, as a place in `rockflex.response.STATUSES`, and every scalar of the responses, each of shape
        (count,); empty if all runs failed. The values of runs that failed mean nothing.
    failures
        Errors of the runs that failed, by index.
    responses
        Response of each run of a case with histories, None if it failed; empty for other cases.
    """

    count: int
    columns: Mapping[str, NDArray[Any]]
    failures: Mapping[int, InputError | SolverError]
    responses: Sequence[Response | None] = ()

    def rows(self) -> list[dict[str, Any]]:
        """Return the results of each run by name, or its `error`."""
        names = tuple(self.columns)
        values = zip(*(column.tolist() for column in self.columns.values()), strict=True)
        rows = [dict(zip(names, row, strict=True)) for row in values] or [{} for _ in range(self.count)]
        for place, row in enumerate(rows):
            if place in self.failures:
                rows[place] = {"error": str(self.failures[place])}
            else:
                row["status"] = STATUSES[row["status"]]
        return rows


def peaks_of(case: Case | InputError, runs: Sequence[Scaled]) -> Peaks:
    """Run motions, each at a scale, on a case; all of them fail if there is none."""
    if isinstance(case, InputError):
        return Peaks(len(runs), {}, dict.fromkeys(range(len(runs)), case))
    if case.history:
        results = [case.attempt(*run) for run in runs]
        found = [each if isinstance(each, Response) else None for each in results]
        failures = {place: each for place, each in enumerate(results) if not isinstance(each, Response)}
        return Peaks(len(runs), columns_among(found), failures, found)
    columns, failures = dict[str, NDArray[Any]](), dict[int, InputError | SolverError]()
    parts = _alike(runs)
    for dt, shaken, places in parts:
        some = [runs[place] for place in places]
        try:
            solutions = case.solve_all(some, dt, shaken=shaken)
        except (InputError, SolverError) as error:  # none of them can begin
            failures |= dict.fromkeys(places, error)
            continue
        failures |= {places[place]: error for place, error in solutions.failures.items()}
        found = columns_of(case.model, solutions)
        if len(parts) == 1:
            return Peaks(len(runs), found, failures)
        for name, values in found.items():
            columns.setdefault(name, np.zeros(len(runs), values.dtype))[places] = values
    return Peaks(len(runs), columns, failures)


def _alike(runs: Sequence[Scaled]) -> list[tuple[float, bool, list[int]]]:
    """Return the places of the runs with the same time step, and with or without vertical motion."""
    found = dict[tuple[float, bool], list[int]]()
    for place, (motion, _) in enumerate(runs):
        found.setdefault((motion.dt, has_vertical(motion)), []).append(place)
    return [(dt, shaken, places) for (dt, shaken), places in found.items()]
