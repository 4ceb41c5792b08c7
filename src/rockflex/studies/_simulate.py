"""Runs in Python: one structure, motion and model; or the cross product of many."""

import math
from collections import OrderedDict
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace
from threading import Lock
from typing import TYPE_CHECKING, Any, Literal, Unpack

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.checks import checked_finite_vector
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import shown
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import LAW_CLASSES, ImpactLaw
from rockflex.models._label import Model, parse_model
from rockflex.models._work import WorkLimitError
from rockflex.motion._ground_motion import GroundMotion, check_horizontal_component
from rockflex.motion._suite import Selection
from rockflex.response._record_set import RecordSet, Rule, checked_rule
from rockflex.response._respond import STATUSES
from rockflex.response._response import Response
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import (
    GroundChoice,
    InitialState,
    Models,
    Motions,
    Output,
    RockingStructure,
    Structures,
    check_keywords,
    check_motion_argument,
    checked_models,
    checked_motions,
    checked_scale_factors,
    checked_structures,
    ground_under_structure,
    rocking_properties_of,
    wants_history,
)
from rockflex.studies._prepared_case import ManyKeywords, PreparedCase, RunOptions, RunPeaks, peaks_of_runs
from rockflex.studies._result_tables import RESULTS, categories_of, pandas_columns
from rockflex.studies._run_matrix import RunMatrix
from rockflex.studies.parallel import map_runs_in_order
from rockflex.studies.progress import reporting_progress
from rockflex.studies.running import WorkLimit, worker_count

if TYPE_CHECKING:
    import pandas as pd


MAX_CASES = 32  # cases kept
MIN_WEIGHED_BYTES, MAX_TOTAL_BYTES = 8_000_000, 256_000_000  # of the tables of a case that are counted anew, and of all

_cache: OrderedDict[Hashable, tuple[PreparedCase, RockingProperties, RunOptions, int]] = OrderedDict()
_lock = Lock()


def simulate_with_cached_case(
    model: Model, properties: RockingProperties, options: RunOptions, motion: GroundMotion, *, history: bool
) -> Response:
    """Run a motion on a structure, with the case of an earlier run if everything but the motion is the same.

    The structure and the ground are the same only if they are the same objects, which cannot change; a user-defined
    impact law can. A case is kept only for the time step of its run, and not if its run failed, so that no run depends
    on those before it.
    """
    rest = (options.bouc_wen, options.free_vibration, options.work_limit, history, motion.dt)
    key = (id(properties), id(options.ground), id(options.initial), model, options.impact, *rest)
    keeps = options.impact is None or type(options.impact) in LAW_CLASSES.values()
    known = _cached_case(key) if keeps else None
    case = known or options.case(model, properties, history=history, floors=history)
    response = case.run(motion)
    if keeps and ((size := case.engine.size) > MIN_WEIGHED_BYTES or known is None):
        with _lock:
            # What a key identifies is kept with it, so that no later object can have its place in memory.
            _cache[key] = case, properties, options, size
            while len(_cache) > MAX_CASES or sum(weight for *_, weight in _cache.values()) > MAX_TOTAL_BYTES:
                _cache.popitem(last=False)
    return response


def _cached_case(key: Hashable) -> PreparedCase | None:
    with _lock:
        found = _cache.get(key)
        if found is None:
            return None
        _cache.move_to_end(key)
        return found[0]


def simulate(
    structure: RockingStructure | RockingProperties,
    motion: GroundMotion,
    model: str | Model = "MDOF-S",
    output: Output = "history",
    free_vibration: float | Literal["settle"] = 0.0,
    bouc_wen: BoucWen | None = None,
    impact: ImpactLaw | None = None,
    initial: InitialState | None = None,
    work_limit: WorkLimit = "default",
    ground: GroundChoice = None,
) -> Response:
    """Simulate one structure under one ground motion.

    The simplified models (Silva & Stojadinović 2024, Eqs. 15, 23-25 and 30-32) are advanced in closed form; every
    uplift, impact and peak is found to machine precision, also between samples. The complete models (Eqs. 13-16 and
    26-29) are advanced in closed form while in contact, and integrated to about ten digits while they rock; yielding
    models (Eqs. 37-38) are always integrated.

    Parameters
    ----------
    structure
        A structure, or its `RockingProperties`.
    motion
        The ground motion; linear between samples, and zero in the free vibration after the last one.
    model
        ``"2DOF-S"``, ``"3DOF-S"``, ... ``"MDOF-S"`` (all modes): simplified. ``"2DOF-C"``, ``"MDOF-C"``: complete;
        with some of several modes ``"3DOF-C-SI"`` (impact by Eq. 25) or ``"3DOF-C-E"`` (scaled to meet Eq. 19).
        ``"rigid"``, ``"rigid-C"``: the same structure without flexure, and with Housner's impact. ``"fixed"``,
        ``"5DOF-fixed"``: on a base that cannot lift. Or a `Model`.
    output
        ``"history"`` stores the state at every sample and event, ``"peaks"`` only the peaks.
    free_vibration
        Seconds of free vibration after the record (rounded up to whole samples), or ``"settle"``: until overturned,
        or until the base cannot lift again and no peak can grow. With zero the run ends at the last sample, where the
        last acceleration of the record still acts. In free vibration the ground is at rest: if the record ends with an
        acceleration that is not zero, it jumps to zero there, and the history has both sides of the jump.
    bouc_wen
        Hysteresis of the superstructure of a model with one mode, "2DOF-S" or "1DOF-fixed" for instance.
    impact
        An impact law other than the model's own: `VVELSimplified`, `VVELComplete`, `Restitution`, or any object that
        is an `ImpactLaw`.
    initial
        The state at t = 0; at rest if None.
    work_limit
        Limit of the work of the run, in s of computing on one core; None for no limit. ``"default"``: that of
        `running`, or else 30 s. A run is refused if its estimate exceeds the limit, and stopped when it reaches the
        limit. Work is counted, not timed, so the limit is the same on every machine. A typical run takes milliseconds.
    ground
        Springs under the base, friction between base and ground, or both; for models whose base can lift. Or a
        function that returns a `Ground` for the `RockingProperties` of a structure. Default: rigid ground on which the
        base cannot slide.

    Returns
    -------
    Response
        Peaks, times, counts and, with ``output="history"``, the history.

    Raises
    ------
    InputError
        If the model's label is unknown, a value is out of range, an argument is of the wrong kind, or the motion is a
        vertical component; if the run is more work than `work_limit`, or its history more than memory holds.
    SolverError
        If the run cannot be solved, or has done the work of `work_limit`; the message names the time and the state.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> response = rf.simulate(frame, pulse, "2DOF-S")
    >>> response.status, round(response.max_rotation, 4)
    ('rocking', 0.0198)
    """
    history = wants_history(output)
    options = RunOptions.of(
        free_vibration, impact=impact, bouc_wen=bouc_wen, ground=ground, initial=initial, work_limit=work_limit
    )
    properties = rocking_properties_of(structure)
    choice, below = parse_model(model), ground_under_structure(properties, ground)
    check_motion_argument(motion)
    return simulate_with_cached_case(
        choice, properties, replace(options, ground=below, all_yield=True), motion, history=history
    )


RUNS_PER_TASK = 16, 256  # at least, to hide a task's cost; at most, in the share of a thread
TASKS_PER_THREAD = 4  # so that the threads end together

Part = tuple[RunMatrix, int, int]  # some runs of a structure: its matrix, the first and the last


def simulate_many(
    structures: Structures,
    motions: Motions,
    models: Models = "MDOF-S",
    output: Output = "peaks",
    scales: float | Sequence[float] = 1.0,
    **options: Unpack[ManyKeywords],
) -> "pd.DataFrame":
    """Simulate every structure under every motion with every model at every scale.

    The runs are shared among threads; the engine releases the interpreter lock. With ``output="peaks"`` only the table
    grows with the number of runs.

    Parameters
    ----------
    structures, motions
        One of each, a sequence, or a mapping from names; a suite is a sequence of motions, and of a `Selection` its
        scaled records are used.
    models
        Labels or models, one or a sequence.
    output
        ``"peaks"``, or ``"history"`` for a further column `response` with every run's `Response`.
    scales
        Factor on the acceleration, or a sequence of factors.
    options
        `free_vibration`, `bouc_wen`, `impact`, `initial`, `ground` and `work_limit` by name, as in `simulate`; and
        those below. `bouc_wen` applies to the models whose label ends in "-BW", or to all models if there are
        none, which must then have one mode. All models start from the same initial state. A run fails if its model has
        fewer modes than the state has values, or a fixed base where the state rotates. With several structures, a
        function as the `ground` gives each its own: ``lambda properties: Ground(springs=winkler_bed(
        properties.half_width, ...), ...)``. A run that exceeds `work_limit` has a message in `error`.
    workers
        Number of threads; None for that of `running`, or else one a core.
    progress
        ``"bar"`` for a bar with the time left, in a terminal or a notebook; or a function ``progress(done, total)``
        of the runs that are done and of all, called here, first with 0. What it raises ends the study.

    Returns
    -------
    pandas.DataFrame
        One row a run, structures outermost, then motions, models and scales. Columns: `structure` (its name in a
        mapping, else its index), `motion` (name), `scale`, `model`, `status`, `error`, then every scalar of `Response`
        by its name, in SI units. A run that cannot be solved, or whose model has more modes than its structure, has a
        message in `error`. Its other results are missing: NaN, or NA in the columns of counts (Int64) and flags
        (boolean). If stories of a structure yield: `max_ductility` and `max_residual_drift_ratio` of all stories, and
        `ductility_1`, `residual_drift_1` (m), ... of each from the bottom, NaN for structures without.

    Raises
    ------
    InputError
        If a label is unknown, a sequence is empty, an argument is out of range or of the wrong kind, a motion is a
        vertical component, a scaled motion would overflow, or every run exceeds `work_limit`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> table = rf.simulate_many(frame, pulse, ["2DOF-S", "MDOF-S"],
    ...     scales=(0.5, 1.0))
    >>> table[["model", "scale", "status"]]
        model  scale   status
    0  2DOF-S    0.5  rocking
    1  2DOF-S    1.0  rocking
    2  MDOF-S    0.5  rocking
    3  MDOF-S    1.0  rocking
    """
    history = wants_history(output)
    check_keywords(options, ManyKeywords)
    given: dict[str, Any] = {**options}
    workers, progress = given.pop("workers", None), given.pop("progress", None)
    chosen_options = RunOptions.of(**given)
    everything, names = checked_structures(structures)
    records = checked_motions(motions)
    check_horizontal_component(*records)
    chosen = checked_models(models)
    factors = checked_scale_factors(scales, max(records, key=lambda motion: motion.pga))
    shape = (len(everything), len(records), len(chosen), len(factors))
    matrix = RunMatrix(everything, records, chosen, chosen_options, history=history, floors=history)
    runs_of_one = [*matrix.cross(factors, [0])]
    each, total = len(runs_of_one), math.prod(shape)
    least, most = RUNS_PER_TASK
    threads = worker_count(workers)
    per_task = most if threads == 1 else min(most, max(least, total // (TASKS_PER_THREAD * threads)))

    def tasks() -> Iterator[list[Part]]:
        task, runs = list[Part](), 0
        for structure in everything:
            own = matrix.with_structure(structure)
            for first in range(0, each, per_task):
                task.append((own, first, min(first + per_task, each)))
                runs += task[-1][2] - first
                if runs >= per_task:
                    yield task
                    task, runs = [], 0
        if task:
            yield task

    def work(task: list[Part]) -> RunPeaks:
        runs = [run for own, first, last in task for run in own.scaled(runs_of_one[first:last])]
        return peaks_of_runs(runs, keep=each > per_task)  # other tasks may need the engines

    with reporting_progress(progress, total, "runs") as advance:
        found = RunPeaks.joined(map_runs_in_order(work, tasks(), workers, lambda made: advance(made.count)))
    refused = [error for error in found.failures.values() if isinstance(error, WorkLimitError)]
    if len(refused) == total:
        raise refused[0]
    stories = {name: float for name in found.columns if name not in RESULTS and name != "status"}
    results = pandas_columns(
        {**found.columns, "error": found.errors}, {"status": STATUSES, "error": str, **RESULTS, **stories}, found.failed
    )

    import pandas as pd

    structure, motion, model, scale = (axis.ravel() for axis in np.indices(shape, dtype=np.int32))
    axes = {
        "structure": structure if names is None else _categorical_column(structure, names),
        "motion": _categorical_column(motion, [record.name for record in records]),
        "scale": np.asarray(factors)[scale],
        "model": _categorical_column(model, [each.label for each in chosen]),
    }
    table = pd.DataFrame({**axes, **results}, copy=False)
    if history:
        table["response"] = pd.Series([found.responses.get(place) for place in range(total)], dtype=object)
    return table


def _categorical_column(codes: NDArray[np.int32], names: list[str]) -> "pd.Categorical[Any]":
    """Return a categorical column; names that occur twice share a category."""
    import pandas as pd

    categories = {name: place for place, name in enumerate(dict.fromkeys(names))}
    places = np.array([categories[name] for name in names], dtype=np.int32)
    return pd.Categorical.from_codes(places[codes], dtype=categories_of(tuple(categories)))


def simulate_set(
    structure: RockingStructure | RockingProperties,
    motions: Motions,
    model: str | Model = "MDOF-S",
    rule: Rule | None = None,
    periods: tuple[float, float] | None = None,
    **options: Unpack[ManyKeywords],
) -> RecordSet:
    """Simulate one structure under a set of records, and find the values for which codes design.

    Parameters
    ----------
    structure
        A structure, or its `RockingProperties`.
    motions
        A suite or another sequence of motions, a mapping from names, or a `Selection`, whose scaled records are used.
    model
        As in `simulate`.
    rule
        ``"ec8"``: EN 1998-1:2004, 4.3.3.4.3: the mean of at least 7 records, or the most unfavourable value of 3 to 6.
        ``"asce7"``: ASCE 7-16, 16.4.1: the mean of at least 11 records, none of which overturns. ``"asce7-ii"``: its
        exception in 16.4.1.1 for Risk Categories I and II: one record may overturn, and then the larger of 1.2 times
        the median of all and the mean of the others counts. None: the most unfavourable value of any number.
    periods
        Smallest and largest period in s for which the records were chosen, to compare with that of rocking. Default:
        those of the `Selection`.
    options
        As in `simulate_many`.

    Returns
    -------
    RecordSet
        The peaks by record, their statistics, and the values for design with the reasons.

    Raises
    ------
    InputError
        As for `simulate_many`; if the rule is unknown or asks for more records, or `periods` are not two rising
        positive numbers.
    SolverError
        If a record cannot be solved: without it the set is another one.

    Examples
    --------
    >>> import rockflex as rf
    >>> chosen = rf.load_suite("fema-p695-far-field").select(
    ...     rf.ec8_spectrum(2.5, "C"), 7, (0.2, 2.0), per_event=1)
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> rf.simulate_set(frame, chosen, "2DOF-S", rule="ec8")
    RecordSet(2DOF-S under 7 records, 0 overturned, rule='ec8')
    """
    if periods is None and isinstance(motions, Selection):
        periods = (float(motions.periods.min()), float(motions.periods.max()))
    records, span = checked_motions(motions), None if periods is None else checked_period_range(periods)
    kept = checked_rule(rule, len(records))
    table = simulate_many(structure, records, model, "history", **options)
    failed = table[table["error"].notna()]
    if len(failed):
        first = failed.iloc[0]
        raise SolverError(
            f"{len(failed)} of {len(records)} records could not be solved, and without them the set is another one. "
            f"{first['motion']}: {first['error']}"
        )
    return RecordSet(
        responses=tuple(table["response"]),
        motions=tuple(records),
        properties=rocking_properties_of(structure),
        rule=kept,
        periods=span,
    )


def checked_period_range(periods: Any) -> tuple[float, float]:
    """Return the smallest and the largest period in s."""
    ends = checked_finite_vector("periods", periods, "s")
    if ends.size != 2 or not 0.0 <= ends[0] < ends[1]:
        raise InputError(
            f"periods must be the smallest and the largest period in s, but {shown(periods)} was given.",
            field="periods",
        )
    return float(ends[0]), float(ends[1])
