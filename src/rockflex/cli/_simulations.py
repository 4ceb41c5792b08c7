"""The runs of one structure: a few are timed one by one, many are shared among threads."""

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
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
from rockflex.study._yielding import labelled_hysteresis

FEW = 64  # runs; more are not timed one by one


@dataclass(frozen=True)
class Batch:
    """The runs of one command: every motion at every scale with every model."""

    properties: RockingProperties
    motions: Sequence[GroundMotion]
    scales: Sequence[float]
    models: Sequence[str]
    free_vibration: float | Literal["settle"] = 0.0
    history: bool = False
    workers: int | None = None
    assumptions: Assumptions = field(default_factory=Assumptions)
    friction: float | None = None
    """Coefficient of friction at which sliding is reported, or None."""
    work_limit: float | None = WORK_LIMIT
    """Longest computing time of one run in s, or None for no limit."""

    def case(self, model: str) -> Case:
        """Return the case of one model, with its history where that is written or the friction is needed."""
        chosen, given, whole = parse_model(model), self.assumptions, self.history or self.friction is not None
        (bouc_wen,) = labelled_hysteresis([chosen], given.bouc_wen)
        tied = chosen.of(self.properties, given.law, bouc_wen, given.ground)
        free = free_vibration_time(self.free_vibration)
        return Case(tied, free, given.initial, work_limit_of(self.work_limit), history=whole, floors=whole)

    def describe(self) -> dict[str, Any]:
        """Return the options of the runs, for a document."""
        described = {"models": self.models, "scales": self.scales, "free_vibration": self.free_vibration}
        friction = {} if self.friction is None else {"friction": self.friction}
        return {**described, **self.assumptions.describe(), **friction}

    @property
    def size(self) -> int:
        """Number of runs."""
        return len(self.motions) * len(self.scales) * len(self.models)


@dataclass(frozen=True)
class Run:
    """One run: its motion, scale and model, its peaks by name, and its outcome."""

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
    """Required friction and the time at which sliding would start, by name; empty unless requested."""
    elements: dict[str, list[float]] = field(default_factory=dict[str, list[float]])
    """Peaks of each element between base and ground, and its energy of a run with a history, by name."""
    refused: bool = False
    """Whether it was not started, because it would exceed the work limit."""

    def row(self) -> dict[str, Any]:
        """Return everything but the run time and the history, in the columns of `simulate_many`.

        Those of an element have its number, from 1, at the end of their names.
        """
        head = {"motion": self.motion, "scale": self.scale, "model": self.model}
        elements = {f"{name}_{k}": each for name, values in self.elements.items() for k, each in enumerate(values, 1)}
        return {**head, "status": self.status, "error": self.error, **self.peaks, **self.friction, **elements}

    @property
    def warnings(self) -> tuple[str, ...]:
        """Demands of the run that the ground or its tendons cannot meet; with a history also energies in imbalance."""
        if self.response is not None:
            return self.response.warnings
        return () if self.error is not None else warnings_of(self.model, self.peaks)


COLUMNS = tuple(name for name in PEAKS if name not in ("model", "motion", "status"))
OF_ELEMENTS = ("max_element_force", "max_element_elongation")
SLIDING = ("required_friction", "required_friction_excluding_impacts", "sliding_time")


def perform(batch: Batch) -> list[Run]:
    """Perform a batch, motions outermost, then scales, then models; one run that cannot be solved is not an error.

    Raises
    ------
    InputError
        If a value of the batch is out of range, or every run would exceed the work limit.
    SolverError
        If no run could be solved.
    """
    cases = {model: batch.case(model) for model in batch.models}
    many = batch.size > FEW

    def run(task: tuple[int, tuple[GroundMotion, float, str]]) -> tuple[int, Run]:
        place, (motion, scale, model) = task
        return place, _run(batch, cases[model], motion, scale, timed=not many)

    tasks = enumerate(product(batch.motions, batch.scales, batch.models))
    done: list[tuple[int, Run]] = []
    with progress("Simulating", batch.size) if many else nullcontext() as advance:
        for item in map_runs(run, tasks, batch.workers if many else batch.workers or 1):
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


def _run(batch: Batch, case: Case, motion: GroundMotion, scale: float, *, timed: bool) -> Run:
    model = case.model.label
    start = perf_counter()
    try:
        response = case.run(motion, scale)
    except (SolverError, WorkLimitError) as error:
        lost: dict[str, float | None] = {} if batch.friction is None else dict.fromkeys(SLIDING, None)
        refused = isinstance(error, WorkLimitError)
        return Run(motion.name, scale, model, None, str(error), dict.fromkeys(COLUMNS), friction=lost, refused=refused)
    elapsed = perf_counter() - start if timed else None
    peaks = {name: getattr(response, name) for name in COLUMNS}
    kept = response if batch.history else None
    friction, elements = _friction(batch, response), _elements(batch, response)
    return Run(motion.name, scale, model, response.status, None, peaks, elapsed, kept, friction, elements)


def _elements(batch: Batch, response: Response) -> dict[str, list[float]]:
    """Return the peaks of the elements, and the energy that each dissipated if the history is known."""
    if not batch.properties.elements:
        return {}
    names = OF_ELEMENTS if response.history is None else (*OF_ELEMENTS, "element_energy")
    return {name: getattr(response, name).tolist() for name in names}


def _friction(batch: Batch, response: Response) -> dict[str, float | None]:
    """Return the friction of one run, if requested."""
    if batch.friction is None:
        return {}
    values = (
        response.required_friction,
        response.required_friction_excluding_impacts(),
        response.sliding_time(batch.friction),
    )
    return dict(zip(SLIDING, values, strict=True))
