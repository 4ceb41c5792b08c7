"""The runs of one structure: prepared from the arguments of a command, and performed."""

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import typer

from rockflex.cli import _console as console
from rockflex.cli._find_motions import FoundMotion, find_motions, quiet_ground_motion
from rockflex.cli._options import flag_values, flags_of_tables, naming_flags_in_errors
from rockflex.cli._output import output_file_stems
from rockflex.cli._run_options import (
    choose_run_models,
    describe_run_options,
    make_run_options,
    number_or_word,
    parse_work_limit,
)
from rockflex.cli._structures import LoadedStructure, load_structure, split_structure_file_argument
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.schema import (
    BoucWenSchema,
    FrameFlags,
    GroundSchema,
    ImpactSchema,
    InitialStateSchema,
    SpringBedSchema,
)
from rockflex.models._label import parse_model
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._read_suite import OnError
from rockflex.response._friction import friction_coefficient
from rockflex.response._respond import BY_STORY, story_results
from rockflex.response._response import PEAKS, Response, warnings_of_sensitivity
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._structure_file import read_toml_file
from rockflex.studies._arguments import (
    checked_scale_factors,
    free_vibration_argument,
    free_vibration_time,
    ground_under_structure,
    parse_scale_range,
)
from rockflex.studies._objects import object_in_file
from rockflex.studies._prepared_case import PreparedCase, RunOptions, yielding_model_labels
from rockflex.studies.case import Case, CaseRuns, case_in_file
from rockflex.studies.parallel import map_runs_in_order

MAX_TIMED_RUNS = 64  # runs; more are not timed one by one
MAX_NOTED_RUNS = 12  # runs; of more, none by itself is what is read


@dataclass(frozen=True)
class RunBatch:
    """The runs of one command: every motion at every scale with every model."""

    properties: RockingProperties
    motions: Sequence[GroundMotion]
    scales: Sequence[float]
    models: Sequence[str]
    options: RunOptions = field(default_factory=RunOptions)
    ground_values: dict[str, Any] = field(default_factory=dict[str, Any])
    """The values of the ground as they were given."""
    history: bool = False
    workers: int | None = None
    friction: float | None = None
    """Coefficient of friction at which sliding is reported, or None."""

    @property
    def noted(self) -> bool:
        """Whether a run says so where it depends on the scale of its record by much."""
        return self.size <= MAX_NOTED_RUNS

    def case(self, model: str) -> PreparedCase:
        """Return the case of one model, with its history where that is written or the friction is needed."""
        whole = self.history or self.friction is not None
        return self.options.case(parse_model(model), self.properties, history=whole, floors=whole)

    def describe(self) -> dict[str, Any]:
        """Return the options of the runs, for a document."""
        free = free_vibration_argument(self.options.free_vibration)
        described = {"models": self.models, "scales": self.scales, "free_vibration": free}
        friction = {} if self.friction is None else {"friction": self.friction}
        return described | describe_run_options(self.options, self.ground_values) | friction

    @property
    def size(self) -> int:
        """Number of runs."""
        return len(self.motions) * len(self.scales) * len(self.models)


@dataclass(frozen=True)
class BatchRun:
    """One run: its motion, scale and model, and its response, or the error for which it has none."""

    motion: str
    scale: float
    model: str
    response: Response | None = None
    """With its history only if the batch has histories."""
    failure: InputError | SolverError | None = None
    run_time: float | None = None
    """Seconds; None where runs were shared among threads."""
    friction: dict[str, float | None] = field(default_factory=dict[str, float | None])
    """Required friction and the time at which sliding would start, by name; empty unless requested."""
    note: tuple[str, ...] = ()
    """What its sensitivity to the record says in words."""
    elements: dict[str, list[float]] = field(default_factory=dict[str, list[float]])
    """Peaks of each element, its energy of a run with a history, and what is left of each story, by name."""

    @property
    def error(self) -> str | None:
        """The message of the failure."""
        return None if self.failure is None else str(self.failure)

    @cached_property
    def peaks(self) -> dict[str, Any]:
        """Every scalar of the response by name; None if there is none."""
        return {name: getattr(self.response, name, None) for name in COLUMNS}

    @property
    def status(self) -> str | None:
        """Status of the response."""
        return None if self.response is None else self.response.status

    def row(self) -> dict[str, Any]:
        """Return everything but the run time and the history, in the columns of `simulate_many`.

        Columns of an element or a story end in its number, from 1.
        """
        head = {"motion": self.motion, "scale": self.scale, "model": self.model}
        elements = {f"{name}_{k}": each for name, values in self.elements.items() for k, each in enumerate(values, 1)}
        stories = {} if self.response is None else story_results(self.response)
        return {
            **head,
            "status": self.status,
            "error": self.error,
            **self.peaks,
            **self.friction,
            **elements,
            **stories,
        }

    @property
    def warnings(self) -> tuple[str, ...]:
        """Demands of the run that the ground or its tendons cannot meet; with a history also energies in imbalance.

        Where few runs are made, also that 1 % of the record moves a peak by much.
        """
        return () if self.response is None else (*self.response.warnings, *self.note)


COLUMNS = tuple(name for name in PEAKS if name not in ("model", "motion", "status"))
OF_ELEMENTS = ("max_element_force", "max_element_elongation")
SLIDING = ("required_friction", "required_friction_excluding_impacts", "sliding_time")


def run_batch(batch: RunBatch) -> list[BatchRun]:
    """Perform a batch, motions outermost, then scales, then models; one run that cannot be solved is not an error.

    Raises
    ------
    InputError
        If a value of the batch is out of range, or every run is refused: it would exceed the work limit, the initial
        state does not fit the model, or the time step is too long.
    SolverError
        If no run could be solved.
    """
    cases = {model: batch.case(model) for model in batch.models}
    many = batch.size > MAX_TIMED_RUNS
    tasks = product(batch.motions, batch.scales, batch.models)
    with console.step_bar("Simulating", batch.size) if many else nullcontext() as advance:
        runs = map_runs_in_order(
            lambda task: _run_one_of_batch(batch, cases[task[2]], task[0], task[1], timed=not many),
            tasks,
            batch.workers if many else batch.workers or 1,
            lambda _: None if advance is None else advance(1),
        )
    failures = [found.failure for found in runs if found.failure is not None]
    if len(failures) == len(runs):
        first = runs[0]
        if isinstance(failures[0], InputError) and all(isinstance(each, InputError) for each in failures):
            raise failures[0]
        raise SolverError(
            f"None of the {len(runs)} runs could be solved; {first.model} under {first.motion}: {first.error}"
        )
    return runs


def _run_one_of_batch(
    batch: RunBatch, case: PreparedCase, motion: GroundMotion, scale: float, *, timed: bool
) -> BatchRun:
    made = BatchRun(motion.name, scale, case.model.label)
    start = perf_counter()
    try:
        response = case.run(motion, scale)
    except (InputError, SolverError) as error:
        lost: dict[str, float | None] = {} if batch.friction is None else dict.fromkeys(SLIDING)
        return replace(made, failure=error, friction=lost)
    elapsed = perf_counter() - start if timed else None
    friction: dict[str, float | None] = {}
    if batch.friction is not None:
        values = (response.required_friction, response.required_friction_excluding_impacts())
        friction = dict(zip(SLIDING, (*values, response.sliding_time(batch.friction)), strict=True))
    elements: dict[str, list[float]] = {}
    if batch.properties.elements:
        names = OF_ELEMENTS if response.history is None else (*OF_ELEMENTS, "element_energy")
        elements = {name: getattr(response, name).tolist() for name in names}
    if batch.properties.stories and response.ductility.size:
        elements |= {name: getattr(response, name).tolist() for name in BY_STORY}
    kept = response if batch.history else replace(response, history=None)
    note = _note_of_run(case, motion, scale, response) if batch.noted else ()
    return replace(made, response=kept, run_time=elapsed, friction=friction, elements=elements, note=note)


def _note_of_run(case: PreparedCase, motion: GroundMotion, scale: float, response: Response) -> tuple[str, ...]:
    """Return what the sensitivity of a run says in words; of one without a history by running it once more."""
    if case.model.integrated:
        return ()
    if response.history is None:
        try:
            response = replace(case, history=True, work_limit=None).run(motion, scale)
        except (InputError, SolverError):  # the run itself is solved, and needs no note
            return ()
    return warnings_of_sensitivity(response)


FLAGS = {"free_vibration": "--free-vibration", "scales": "--scale", "mu": "--friction"}


@dataclass(frozen=True)
class RunArguments:
    """The arguments of such a command as they were given; None of each was not given."""

    arguments: Sequence[str]
    structure: Path | None
    motion: Sequence[str] | None
    model: Sequence[str] | None
    scale: Sequence[str]
    free_vibration: str
    work_limit: str | None = None
    workers: int | None = None
    friction: float | None = None
    units: str | None = None
    dt: float | None = None
    on_error: OnError = "raise"
    vertical: str | None = None


class PreparedBatch(NamedTuple):
    """A structure, the motions that were found, and the runs of one with the other."""

    loaded: LoadedStructure
    found: list[FoundMotion]
    batch: RunBatch


_IN_CASE = {name: f"--{name.replace('_', '-')}" for name in (
    "motion", "model", "scale", "free_vibration", "work_limit", "units", "dt", "on_error", "vertical"
)}  # fmt: skip
_TABLES_IN_CASE = (FrameFlags, ImpactSchema, InitialStateSchema, BoucWenSchema, GroundSchema, SpringBedSchema)


def prepare_batches(context: typer.Context, arguments: RunArguments, *, histories: int) -> list[PreparedBatch]:
    """Return the runs of each structure of a case, or of the one that the arguments of a command give.

    Histories are kept of up to `histories` motions, each scale counted.
    """
    file, names = split_structure_file_argument(arguments.structure, arguments.arguments)
    content = {} if file is None else read_toml_file(file, "structure")
    if file is None or "structures" not in content or "study" in content:
        return [prepare_batch(context, arguments, histories=histories)]
    flags = flags_of_tables(*_TABLES_IN_CASE)
    given = [flags[name] for table in _TABLES_IN_CASE for name in flag_values(context, table)]
    given += [flag for name, flag in _IN_CASE.items() if _is_typed(context, name)]
    if given or names:
        raise InputError(
            f"{file} is a case, which has structures, records, models and options, but {', '.join([*names, *given])} "
            "was given as well. Write it in the file, or leave it out."
        )
    case = case_in_file(file, content)
    found = [FoundMotion(motion, str(file)) for motion in case.motions()]
    with naming_flags_in_errors(FLAGS):
        return [
            PreparedBatch(
                LoadedStructure(runs.name, type(runs.structure).__name__, row.in_file(), runs.structure, file=file),
                found,
                _batch_of_case(case, runs, found, arguments, histories),
            )
            for row, runs in zip(case.structures, case.runs(), strict=True)
        ]


def output_folders(out: Path | None, prepared: Sequence[PreparedBatch]) -> list[Path | None]:
    """Return the folder of the results of each structure: that of --out, or one in it for each of several."""
    if out is None or len(prepared) == 1:
        return [out] * len(prepared)
    return [out / stem for stem in output_file_stems(each.loaded.name for each in prepared)]


def _is_typed(context: typer.Context, name: str) -> bool:
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


def prepare_batch(context: typer.Context, arguments: RunArguments, *, histories: int) -> PreparedBatch:
    """Return the runs that the arguments and the generated flags of a command ask for.

    Histories are kept of up to `histories` motions, each scale counted.
    """
    file, names = split_structure_file_argument(arguments.structure, arguments.arguments)
    loaded = load_structure(file, flag_values(context, FrameFlags))
    options, ground_values = make_run_options(context, loaded)
    by_flag = bool(flag_values(context, BoucWenSchema))
    models = choose_run_models(arguments.model, loaded.properties, options, by_flag=by_flag)
    yields = bool(yielding_model_labels(models))
    if options.bouc_wen is not None and not yields:
        console.print_remark(f"[bouc_wen] of {file} is for models that end in -BW, such as 2DOF-S-BW; none was given")
    names += arguments.motion or []
    with naming_flags_in_errors(FLAGS):
        free = number_or_word(arguments.free_vibration)
        free_vibration_time(free)
        if names or arguments.vertical or not flag_values(context, InitialStateSchema):
            found = find_motions(names, arguments.units, arguments.dt, arguments.on_error, arguments.vertical)
        else:
            found, free = quiet_ground_motion(free)
        given_scales = [factor for text in arguments.scale for factor in parse_scale_range(text)]
        strongest = max((each.motion for each in found), key=lambda it: it.pga)
        case = Case(
            structures={loaded.name: loaded.built},
            records=[each.motion for each in found],
            models=models,
            scales=list(dict.fromkeys(checked_scale_factors(given_scales, strongest))),
            impact=options.impact,
            bouc_wen=options.bouc_wen if yields else None,
            initial=options.initial,
            ground=options.ground,
            free_vibration=free,
            work_limit=parse_work_limit(arguments.work_limit),
        )
        batch = _batch_of_case(case, case.runs()[0], found, arguments, histories)
    return PreparedBatch(loaded, found, replace(batch, ground_values=ground_values))


def _batch_of_case(
    case: Case, runs: CaseRuns, found: Sequence[FoundMotion], arguments: RunArguments, histories: int
) -> RunBatch:
    """Return the runs of a structure of a case."""
    options = RunOptions.of(**runs.options).for_models(map(parse_model, runs.models))
    ground = ground_under_structure(runs.properties, options.ground)
    return RunBatch(
        properties=runs.properties,
        motions=[each.motion for each in found],
        scales=case.scales,
        models=list(runs.models),
        options=replace(options, ground=ground),
        ground_values={} if ground is None else object_in_file("ground", ground),
        history=len(found) * len(case.scales) <= histories,
        workers=arguments.workers,
        friction=None if arguments.friction is None else friction_coefficient(arguments.friction),
    )
