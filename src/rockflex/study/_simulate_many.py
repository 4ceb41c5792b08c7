"""The cross product of structures, motions, scales and models, with one row per run."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex

import numpy as np
from numpy.typing import NDArray

from rockflex._errors import InputError
from rockflex.models import BoucWen, ImpactLaw
from rockflex.motion import check_horizontal
from rockflex.progress import ProgressChoice, telling
from rockflex.response import STATUSES, Response
from rockflex.solve import WorkLimitError
from rockflex.study._arguments import (
    WORK_LIMIT,
    GroundChoice,
    Output,
    factors_of,
    properties_of,
    wants_history,
)
from rockflex.study._case import Case, prepare_together
from rockflex.study._initial import InitialState
from rockflex.study._peaks import Peaks, Scaled, peaks_among, peaks_of
from rockflex.study._results import RESULTS
from rockflex.study._run_options import RunOptions
from rockflex.study._runs import in_order
from rockflex.study._subjects import Models, Motions, Structures, models_of, motions_of, structures_of
from rockflex.study._tables import Sheet

if TYPE_CHECKING:
    import pandas as pd

CHUNK = 64  # runs a task: long enough to hide a task's cost, short enough to share the work evenly

# Some runs of a structure: its index, the first and the last of them, and its case for each model, once prepared.
Part = tuple[int, int, int, list[Case | str | None]]


def simulate_many(
    structures: Structures,
    motions: Motions,
    models: Models = "MDOF-S",
    output: Output = "peaks",
    scales: float | Sequence[float] = 1.0,
    free_vibration: float | Literal["settle"] = 0.0,
    bouc_wen: BoucWen | None = None,
    impact: ImpactLaw | None = None,
    initial: InitialState | None = None,
    workers: SupportsIndex | None = None,
    work_limit: float | None = WORK_LIMIT,
    ground: GroundChoice = None,
    progress: ProgressChoice = None,
) -> "pd.DataFrame":
    """Simulate every structure under every motion with every model at every scale.

    The runs are shared among threads; the engine releases the interpreter lock. With ``output="peaks"`` only the table
    grows with the number of runs.

    Parameters
    ----------
    structures, motions
        One of each, a sequence, or a mapping from names; a suite is a sequence of motions.
    models
        Labels or models, one or a sequence.
    output
        ``"peaks"``, or ``"history"`` for a further column `response` with every run's `Response`.
    scales
        Factor on the acceleration, or a sequence of factors.
    free_vibration, bouc_wen, impact, initial
        As in `simulate`. `bouc_wen` applies to the models whose label ends in "-BW", or to all models if there are
        none, which must then have one mode. All models start from the same initial state. A run fails if its model has
        fewer modes than the state has values, or a fixed base where the state rotates.
    workers
        Number of threads; None for one a core.
    work_limit
        Work limit of each run, as in `simulate`. A run that exceeds it has a message in `error`.
    ground
        As in `simulate`. With several structures, a function gives each its own: ``lambda properties:
        Ground(springs=winkler_bed(properties.half_width, ...), ...)``.
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
        (boolean).

    Raises
    ------
    InputError
        If a label is unknown, a sequence is empty, an argument is out of range or of the wrong kind, a motion is a
        vertical component, a scaled motion would overflow, or every run exceeds `work_limit`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> table = rf.simulate_many(frame, pulse, ["2DOF-S", "MDOF-S"], scales=(0.5, 1.0))
    >>> table[["model", "scale", "status"]]
        model  scale   status
    0  2DOF-S    0.5  rocking
    1  2DOF-S    1.0  rocking
    2  MDOF-S    0.5  rocking
    3  MDOF-S    1.0  rocking
    """
    history = wants_history(output)
    options = RunOptions.of(
        free_vibration, impact=impact, bouc_wen=bouc_wen, ground=ground, initial=initial, work_limit=work_limit
    )
    everything, names = structures_of(structures)
    records = motions_of(motions)
    check_horizontal(*records)
    chosen = models_of(models)
    options = options.among(chosen)
    factors = factors_of(scales, max(records, key=lambda motion: motion.pga))
    shape = (len(everything), len(records), len(chosen), len(factors))
    inner = len(chosen) * len(factors)  # runs of one structure under one motion
    each = len(records) * inner
    responses = np.full(len(everything) * each if history else 0, None, dtype=object)

    def case_of(index: int, which: int) -> Case | str:
        """Return the case of a structure and a model, or the reason why there is none."""
        try:
            properties = properties_of(everything[index])
            return options.case(chosen[which], properties, history=history, floors=history)
        except InputError as error:
            return str(error)

    def tasks() -> Iterator[list[Part]]:
        task, runs = list[Part](), 0
        for index in range(len(everything)):
            cases: list[Case | str | None] = [None] * len(chosen)
            for first in range(0, each, CHUNK):
                task.append((index, first, min(first + CHUNK, each), cases))
                runs += task[-1][2] - first
                if runs >= CHUNK:
                    yield task
                    task, runs = [], 0
        if task:
            yield task

    def parts_of(places: range) -> dict[int, dict[int, Scaled]]:
        """Return the motion and the scale of each of these runs of a structure, by its model and its place."""
        found = dict[int, dict[int, Scaled]]()
        for place in places:
            which, factor = divmod(place % inner, len(factors))
            found.setdefault(which, {})[place] = records[place // inner], factors[factor]
        return found

    def responses_of(index: int, case: Case, runs: dict[int, Scaled]) -> Peaks:
        """Keep the responses with their histories, and return their peaks."""
        found = [case.attempt(*run) for run in runs.values()]
        for place, response in zip(runs, found, strict=True):
            responses[index * each + place] = response if isinstance(response, Response) else None
        return peaks_among(found)

    def work(task: list[Part]) -> tuple[Sheet, list[WorkLimitError]]:
        refused, begun = list[WorkLimitError](), 0
        sheet = Sheet(sum(last - first for _, first, last, _ in task), columns)
        for index, _, _, cases in task:  # all of them first, so that the code that prepares stays in the cache
            for which, case in enumerate(cases):
                cases[which] = case or case_of(index, which)
        prepare_together(case for *_, cases in task for case in cases)
        for index, first, last, cases in task:
            for which, runs in parts_of(range(first, last)).items():
                rows = [begun + place - first for place in runs]
                case = cases[which]
                if not isinstance(case, Case):
                    sheet.fail(rows, str(case))
                    continue
                peaks = responses_of(index, case, runs) if responses.size else peaks_of(case, list(runs.values()))
                sheet.put(rows, peaks.columns)
                for place, error in peaks.failures.items():
                    sheet.fail(rows[place : place + 1], str(error))
                refused += [error for error in peaks.failures.values() if isinstance(error, WorkLimitError)]
            begun += last - first
            if first == 0 and last == each:
                cases[:] = [None] * len(cases)  # no other task needs them, and the next tables find room in the cache
        return sheet, refused

    columns = {"status": STATUSES, "error": str, **RESULTS}
    with telling(progress, len(everything) * each, "runs") as advance:
        found = in_order(work, tasks(), workers, lambda made: advance(made[0].size))
    results = Sheet.joined([sheet for sheet, _ in found])
    refused = [error for _, errors in found for error in errors]
    if len(refused) == len(everything) * each:
        raise refused[0]

    import pandas as pd

    structure, motion, model, scale = (axis.ravel() for axis in np.indices(shape, dtype=np.int32))
    table = pd.DataFrame(
        {
            "structure": structure if names is None else _category(structure, names),
            "motion": _category(motion, [record.name for record in records]),
            "scale": np.asarray(factors)[scale],
            "model": _category(model, [each.label for each in chosen]),
            **results,
        }
    )
    return table.assign(response=responses) if responses.size else table


def _category(codes: NDArray[np.int32], names: list[str]) -> "pd.Categorical[Any]":
    """Return a categorical column; names that occur twice share a category."""
    import pandas as pd

    categories = list(dict.fromkeys(names))
    places = np.array([categories.index(name) for name in names], dtype=np.int32)
    return pd.Categorical.from_codes(places[codes], dtype=pd.CategoricalDtype(categories))
