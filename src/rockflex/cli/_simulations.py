"""The runs of one structure: timed one by one where they are few, shared among threads where they are many."""

from collections.abc import Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field, replace
from itertools import product
from time import perf_counter
from typing import Any, Literal

from rockflex._errors import SolverError
from rockflex.cli._choices import Assumptions
from rockflex.cli._console import progress
from rockflex.modal import RockingProperties
from rockflex.models import parse_model
from rockflex.motion import GroundMotion
from rockflex.response import PEAKS, Response, warnings_of
from rockflex.solve import WorkLimitError
from rockflex.study import WORK_LIMIT, Case
from rockflex.study._arguments import free_vibration_time, work_limit_of
from rockflex.study._runs import map_runs

FEW = 64  # runs; more are not timed one by one


@dataclass(frozen=True)
class Plan:
    """What is to be run: every motion at every scale with every model."""

    properties: RockingProperties
    motions: Sequence[GroundMotion]
    scales: Sequence[float]
    models: Sequence[str]
    free_vibration: float | Literal["settle"] = 0.0
    history: bool = False
    workers: int | None = None
    assumptions: Assumptions = field(default_factory=Assumptions)
    friction: float | None = None
    """Coefficient of friction, or None where sliding is not asked about."""
    work_limit: float | None = WORK_LIMIT
    """The most computing of one run in s, or None."""

    def case(self, model: str) -> Case:
        """Return what is run with one model, which may keep its history: the friction is found from it."""
        chosen = parse_model(model)
        given, whole = self.assumptions, self.history or self.friction is not None
        tied = chosen.of(self.properties, given.law, given.bouc_wen if chosen.yields else None)
        free = free_vibration_time(self.free_vibration)
        return Case(tied, free, given.initial, work_limit_of(self.work_limit), history=whole, floors=whole)

    def describe(self) -> dict[str, Any]:
        """Return what was asked for, for a document."""
        described = {"models": self.models, "scales": self.scales, "free_vibration": self.free_vibration}
        friction = {} if self.friction is None else {"friction": self.friction}
        return {**described, **self.assumptions.describe(), **friction}

    @property
    def size(self) -> int:
        """Number of runs."""
        return len(self.motions) * len(self.scales) * len(self.models)


@dataclass(frozen=True)
class Run:
    """One run: its place in the plan, its peaks by name, and what became of it."""

    motion: str
    scale: float
    model: str
    status: str | None
    error: str | None
    peaks: dict[str, Any] = field(default_factory=dict[str, Any])
    run_time: float | None = None
    """Seconds; None where runs were shared among threads."""
    response: Response | None = None
    friction: dict[str, float | None] = field(default_factory=dict[str, float | None])
    """Required friction and when sliding would start, by their names; empty where not asked for."""
    refused: bool = False
    """Whether it was not begun, since it is more work than it may be."""

    def row(self) -> dict[str, Any]:
        """Return everything but the run time and the history, in the columns of `simulate_many`."""
        head = {"motion": self.motion, "scale": self.scale, "model": self.model}
        return {**head, "status": self.status, "error": self.error, **self.peaks, **self.friction}

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the run asks of the ground or of its tendons that they cannot do."""
        return () if self.error is not None else warnings_of(self.model, self.peaks)


COLUMNS = tuple(name for name in PEAKS if name not in ("model", "motion", "status"))
SLIDING = ("required_friction", "required_friction_excluding_impacts", "sliding_time")


def perform(plan: Plan) -> list[Run]:
    """Perform a plan; motions outermost, then scales, then models. A run that cannot be solved is no error here.

    Raises
    ------
    InputError
        If a value of the plan is out of range, or every run is more work than it may be.
    SolverError
        If not one run could be solved.
    """
    cases = {model: plan.case(model) for model in plan.models}
    many = plan.size > FEW

    def run(task: tuple[int, tuple[GroundMotion, float, str]]) -> tuple[int, Run]:
        place, (motion, scale, model) = task
        return place, _run(plan, cases[model], motion, scale, timed=not many)

    tasks = enumerate(product(plan.motions, plan.scales, plan.models))
    done: list[tuple[int, Run]] = []
    with progress("Simulating", plan.size) if many else nullcontext() as advance:
        for item in map_runs(run, tasks, plan.workers if many else plan.workers or 1):
            done.append(item)
            if advance is not None:
                advance(1)
    runs = [found for _, found in sorted(done, key=lambda item: item[0])]
    failed = [found for found in runs if found.error is not None]
    if len(failed) == len(runs):
        first = failed[0]
        if first.error is not None and all(found.refused for found in runs):
            raise WorkLimitError(first.error)
        raise SolverError(
            f"None of the {len(runs)} runs could be solved; {first.model} under {first.motion}: {first.error}"
        )
    return runs


def warm_up(plan: Plan) -> None:
    """Load the kernels, or compile them where that was never done, so that no run is charged with it."""
    with progress("Loading the kernels (compiling them, the first time)"):
        for model in plan.models:
            with suppress(SolverError, WorkLimitError):
                _friction(plan, replace(plan.case(model), free_vibration=0.0).run(plan.motions[0]))


def _run(plan: Plan, case: Case, motion: GroundMotion, scale: float, *, timed: bool) -> Run:
    model = case.model.label
    start = perf_counter()
    try:
        response = case.run(motion, scale)
    except (SolverError, WorkLimitError) as error:
        lost: dict[str, float | None] = {} if plan.friction is None else dict.fromkeys(SLIDING, None)
        refused = isinstance(error, WorkLimitError)
        return Run(motion.name, scale, model, None, str(error), dict.fromkeys(COLUMNS), friction=lost, refused=refused)
    elapsed = perf_counter() - start if timed else None
    peaks = {name: getattr(response, name) for name in COLUMNS}
    kept = response if plan.history else None
    return Run(motion.name, scale, model, response.status, None, peaks, elapsed, kept, _friction(plan, response))


def _friction(plan: Plan, response: Response) -> dict[str, float | None]:
    """The friction of one run, if it is asked for."""
    if plan.friction is None:
        return {}
    values = (
        response.required_friction,
        response.required_friction_excluding_impacts(),
        response.sliding_time(plan.friction),
    )
    return dict(zip(SLIDING, values, strict=True))
