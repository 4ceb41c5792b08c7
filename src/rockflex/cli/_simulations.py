"""The runs of one structure: timed one by one where they are few, shared among threads where they are many."""

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import product
from time import perf_counter
from typing import Any, Literal

from rockflex._errors import InputError, SolverError
from rockflex.cli._console import progress
from rockflex.modal import RockingProperties
from rockflex.models import parse_model
from rockflex.motion import GroundMotion
from rockflex.parallel import map_threads
from rockflex.response import PEAKS, Response
from rockflex.study import simulate, simulate_many

__all__ = ["Plan", "Run", "parse_free_vibration", "parse_models", "parse_scales", "perform", "warm_up"]

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

    @property
    def output(self) -> Literal["history", "peaks"]:
        """What is kept of each run."""
        return "history" if self.history else "peaks"

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

    def row(self) -> dict[str, Any]:
        """Return everything but the run time and the history, in the columns of `simulate_many`."""
        head = {"motion": self.motion, "scale": self.scale, "model": self.model}
        return {**head, "status": self.status, "error": self.error, **self.peaks}


COLUMNS = tuple(name for name in PEAKS if name not in ("model", "motion", "status"))


def perform(plan: Plan) -> list[Run]:
    """Perform a plan; motions outermost, then scales, then models. A run that cannot be solved is no error here.

    Raises
    ------
    InputError
        If a value of the plan is out of range.
    SolverError
        If not one run could be solved.
    """
    runs = _one_by_one(plan) if plan.history or plan.size <= FEW else _in_batches(plan)
    failed = [run for run in runs if run.error is not None]
    if len(failed) == len(runs):
        first = failed[0]
        message = f"None of the {len(runs)} runs could be solved; {first.model} under {first.motion}: {first.error}"
        raise SolverError(message)
    return runs


def warm_up(plan: Plan) -> None:
    """Load the kernels, or compile them where that was never done, so that no run is charged with it."""
    with progress("Loading the kernels (compiling them, the first time)"):
        for model in plan.models:
            with suppress(SolverError):
                simulate(plan.properties, plan.motions[0], model, output=plan.output)


def parse_models(given: Sequence[str], properties: RockingProperties) -> list[str]:
    """Split the labels at commas, and check that the structure has the modes for each.

    Raises
    ------
    InputError
        If a label is unknown, or needs more modes than there are.
    """
    labels = [label.strip() for item in given for label in item.split(",") if label.strip()]
    if not labels:
        message = "No model was given. Expected labels such as 2DOF-S,MDOF-S,fixed."
        raise InputError(message)
    return list(dict.fromkeys(parse_model(label).of(properties).label for label in labels))


def parse_free_vibration(given: str) -> float | Literal["settle"]:
    """Read seconds, or "settle".

    Raises
    ------
    InputError
        If the text is neither.
    """
    if given == "settle":
        return "settle"
    try:
        seconds = float(given)
    except ValueError:
        seconds = math.nan
    if not (seconds >= 0.0 and math.isfinite(seconds)):
        message = f"--free-vibration must be zero or more seconds, or settle, but {given!r} was given."
        raise InputError(message)
    return seconds


def parse_scales(given: Sequence[float]) -> list[float]:
    """Return the factors, each once.

    Raises
    ------
    InputError
        If one is not finite.
    """
    for scale in given:
        if not math.isfinite(scale):
            message = f"--scale must be a finite factor on the acceleration, but {scale} was given."
            raise InputError(message)
    return list(dict.fromkeys(given))


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
            )
        except SolverError as error:
            return place, Run(motion.name, scale, model, None, str(error), dict.fromkeys(COLUMNS))
        elapsed = perf_counter() - start
        peaks = {name: getattr(response, name) for name in COLUMNS}
        return place, Run(motion.name, scale, model, response.status, None, peaks, elapsed, response)

    tasks = enumerate(product(plan.motions, plan.scales, plan.models))
    done = sorted(map_threads(run, tasks, plan.workers or 1), key=lambda item: item[0])
    return [run for _, run in done]


def _in_batches(plan: Plan) -> list[Run]:
    each = len(plan.scales) * len(plan.models)
    step = max(1, BATCH // each)
    runs: list[Run] = []
    with progress("Simulating", plan.size) as advance:
        for first in range(0, len(plan.motions), step):
            motions = plan.motions[first : first + step]
            table = simulate_many(
                plan.properties,
                motions,
                plan.models,
                scales=plan.scales,
                free_vibration=plan.free_vibration,
                workers=plan.workers,
            )
            rows = list(_rows(table))
            n_scales, n_models = len(plan.scales), len(plan.models)
            runs += [
                rows[(motion * n_models + model) * n_scales + scale]
                for motion, scale, model in product(range(len(motions)), range(n_scales), range(n_models))
            ]
            advance(len(rows))
    return runs


def _rows(table: Any) -> Iterator[Run]:
    for row in table.to_dict("records"):
        error = row["error"] if isinstance(row["error"], str) else None
        peaks = {name: row[name] if error is None else None for name in COLUMNS}
        status = row["status"] if error is None else None
        yield Run(row["motion"], float(row["scale"]), row["model"], status, error, peaks)
