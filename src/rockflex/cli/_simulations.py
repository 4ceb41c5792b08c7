"""The runs of one structure: timed one by one where they are few, shared among threads where they are many."""

from collections.abc import Iterator, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field
from itertools import groupby, product
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
from rockflex.study import WORK_LIMIT, simulate, simulate_many
from rockflex.study._runs import map_runs

FEW = 64  # runs; more are not timed one by one
BATCH = 1024  # runs between two steps of the progress bar


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

    @property
    def output(self) -> Literal["history", "peaks"]:
        """What a run returns; the friction is that of a history."""
        return "history" if self.history or self.friction is not None else "peaks"

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
    runs = _one_by_one(plan) if plan.output == "history" or plan.size <= FEW else _in_batches(plan)
    failed = [run for run in runs if run.error is not None]
    if len(failed) == len(runs):
        first = failed[0]
        if first.error is not None and all(run.refused for run in runs):
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
                options: dict[str, Any] = {"work_limit": plan.work_limit, **plan.assumptions.options(model)}
                response = simulate(plan.properties, plan.motions[0], model, output=plan.output, **options)
                _friction(plan, response)


def _one_by_one(plan: Plan) -> list[Run]:
    def run(task: tuple[int, tuple[GroundMotion, float, str]]) -> tuple[int, Run]:
        place, (motion, scale, model) = task
        start = perf_counter()
        try:
            response = simulate(
                plan.properties,
                motion.scaled(scale),
                model,
                output=plan.output,
                free_vibration=plan.free_vibration,
                work_limit=plan.work_limit,
                **plan.assumptions.options(model),
            )
        except (SolverError, WorkLimitError) as error:
            lost: dict[str, float | None] = {} if plan.friction is None else dict.fromkeys(SLIDING, None)
            refused = isinstance(error, WorkLimitError)
            nothing = dict.fromkeys(COLUMNS)
            return place, Run(motion.name, scale, model, None, str(error), nothing, friction=lost, refused=refused)
        elapsed = None if many else perf_counter() - start
        peaks = {name: getattr(response, name) for name in COLUMNS}
        kept = response if plan.history else None
        friction = _friction(plan, response)
        return place, Run(motion.name, scale, model, response.status, None, peaks, elapsed, kept, friction)

    many = plan.size > FEW
    tasks = enumerate(product(plan.motions, plan.scales, plan.models))
    done: list[tuple[int, Run]] = []
    with progress("Simulating", plan.size) if many else nullcontext() as advance:
        for item in map_runs(run, tasks, plan.workers if many else plan.workers or 1):
            done.append(item)
            if advance is not None:
                advance(1)
    return [run for _, run in sorted(done, key=lambda item: item[0])]


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


def _in_batches(plan: Plan) -> list[Run]:
    step = max(1, BATCH // (len(plan.scales) * len(plan.models)))
    runs: list[Run] = []
    with progress("Simulating", plan.size) as advance:
        for first in range(0, len(plan.motions), step):
            motions = plan.motions[first : first + step]
            found: dict[tuple[str, float, str], Run] = {}
            # Elastic and yielding models differ in their options.
            for _, group in groupby(sorted(plan.models, key=_yields), key=_yields):
                models = list(group)
                try:
                    table = simulate_many(
                        plan.properties,
                        motions,
                        models,
                        scales=plan.scales,
                        free_vibration=plan.free_vibration,
                        workers=plan.workers,
                        work_limit=plan.work_limit,
                        **plan.assumptions.options(models[0]),
                    )
                    rows = list(_rows(table))
                except WorkLimitError as error:  # all of these; others may be made
                    said, places = str(error), product([motion.name for motion in motions], plan.scales, models)
                    nothing = dict.fromkeys(COLUMNS)
                    rows = [Run(*place, None, said, nothing, refused=True) for place in places]
                found |= {(run.motion, run.scale, run.model): run for run in rows}
            names = [motion.name for motion in motions]
            runs += [found[place] for place in product(names, plan.scales, plan.models)]
            advance(len(found))
    return runs


def _yields(model: str) -> bool:
    return parse_model(model).yields


def _rows(table: Any) -> Iterator[Run]:
    for row in table.to_dict("records"):
        error = row["error"] if isinstance(row["error"], str) else None
        peaks = {name: row[name] if error is None else None for name in COLUMNS}
        status = row["status"] if error is None else None
        yield Run(row["motion"], float(row["scale"]), row["model"], status, error, peaks)
