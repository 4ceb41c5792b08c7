"""Running a study: here or on a cluster, in memory or in a folder from which it can be resumed."""
# pyright: reportUnknownParameterType=false, reportUnknownLambdaType=false
# (pyarrow comes without types)

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, SupportsIndex

from rockflex._checks import whole_number
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._versions import versions_of
from rockflex.parallel import core_count, map_dask
from rockflex.store import StudyFolder
from rockflex.study._runs import map_runs

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

    from rockflex.study.plan import ChunkedPlan, Spec

LIBRARIES = ("rockflex", "numpy", "scipy", "numba")  # those that affect the numbers
SAMPLE = 48  # largest number of units that an estimate runs
PATIENCE = 2.0  # s after which an estimate stops, without compilation


@dataclass(frozen=True)
class Progress:
    """Progress of a study, in parts; `kept` of them were stored by an earlier call.

    Examples
    --------
    >>> import rockflex as rf
    >>> study = rf.PopulationStudy(pairs=3, seed=1, runs_per_chunk=2, records={"suites": ["el-centro-1940"]})
    >>> seen = []
    >>> table = rf.run_study(study, progress=seen.append)
    >>> seen[-1]
    Progress(parts=3, done=3, kept=0, runs=3)
    """

    parts: int
    done: int
    kept: int
    runs: int
    """Rows of the table that this call has computed."""


def run_study(
    study: "Spec | str | Path",
    folder: str | Path | None = None,
    *,
    workers: SupportsIndex | None = None,
    dask: str | None = None,
    any_version: bool = False,
    progress: Callable[[Progress], None] | None = None,
) -> "pd.DataFrame":
    """Run a study, or the rest of one that was stopped, and return its table.

    Parameters
    ----------
    study
        A `CloudStudy`, an `IncrementalStudy` or another kind, or the path of its TOML file.
    folder
        Where the study is stored, as ``spec.json``, ``manifest.json`` and ``parts/*.parquet``. An existing folder of
        this study is resumed; completed parts are skipped. With None nothing is stored.
    workers
        Number of threads here; None for one a core.
    dask
        Address of a Dask scheduler, such as ``"tcp://10.0.0.1:8786"``, whose workers do the runs.
    any_version
        Resume a study that was started with other versions of the libraries.
    progress
        Called at the start and after every part.

    Returns
    -------
    pandas.DataFrame
        All rows in the order of the study; the docstring of the study names the columns.

    Raises
    ------
    InputError
        If the specification is wrong, the folder holds another study or is not writable, or no cluster answers.
    ClusterError
        If the connection to the cluster is lost. Completed parts remain stored.

    Examples
    --------
    >>> import rockflex as rf
    >>> study = rf.PopulationStudy(pairs=3, seed=1, records={"suites": ["el-centro-1940"]})
    >>> rf.run_study(study)[["pair", "n_stories", "status_mdof"]]
       pair  n_stories status_mdof
    0     0          4     rocking
    1     1          4     rocking
    2     2          3     rocking
    """
    from rockflex.kinds._load import load_study
    from rockflex.study.plan import to_frame

    spec = load_study(study) if isinstance(study, str | Path) else study
    if workers is not None and dask is not None:
        raise InputError(
            f"workers is for threads here, but {shown(workers)} was given together with the cluster at {dask}."
        )
    plan = spec.plan()
    plan.check_work()
    if folder is None:
        tables: dict[int, pa.Table] = {}

        def so_far() -> "pd.DataFrame":
            return to_frame(*(tables[number] for number in sorted(tables)))

        _compute(plan, range(plan.n_chunks), tables.__setitem__, so_far, workers, dask, progress)
        return so_far()
    checksums = plan.checksums | spec.checksums()
    with StudyFolder.open(
        folder, spec.document(), plan.n_chunks, versions_of(LIBRARIES), checksums, any_version=any_version
    ) as kept:
        _compute(
            plan,
            kept.missing(),
            kept.write,
            lambda: to_frame(kept.table(partial=True)),
            workers,
            dask,
            progress,
        )
        return to_frame(kept.table())


def _compute(
    plan: "ChunkedPlan",
    numbers: "range | list[int]",
    keep: "Callable[[int, pa.Table], object]",
    so_far: "Callable[[], pd.DataFrame]",
    workers: SupportsIndex | None,
    dask: str | None,
    progress: Callable[[Progress], None] | None,
) -> None:
    """Compute these chunks, round by round, and store each one when it is complete."""
    done = kept = plan.n_chunks - len(numbers)
    runs = 0
    tell = progress or (lambda _: None)
    tell(Progress(plan.n_chunks, done, kept, runs))
    for place, each in enumerate(plan.rounds):
        missing = [number for number in numbers if number in each]
        if done == plan.n_chunks:
            break
        if place:
            plan = plan.informed(so_far())
        # Closed at once if a part cannot be stored, or a cluster would hold the plan until this process ends.
        with closing(_here(plan, missing, workers) if dask is None else map_dask(plan, missing, dask)) as coming:
            for number, table in coming:
                keep(number, table)
                done, runs = done + 1, runs + table.num_rows
                tell(Progress(plan.n_chunks, done, kept, runs))


def _here(
    plan: "ChunkedPlan", numbers: "range | list[int]", workers: SupportsIndex | None
) -> "Generator[tuple[int, pa.Table]]":
    yield from map_runs(lambda number: (number, plan.chunk(number)), numbers, workers)


def estimate_time(study: "Spec", workers: SupportsIndex | None = None) -> float:
    """Estimate from a sample of its runs how long a study takes on this machine.

    Parameters
    ----------
    study
        The study.
    workers
        Number of threads; None for one a core.

    Returns
    -------
    float
        Time in s, without the compilation of a first call.

    Examples
    --------
    >>> import rockflex as rf
    >>> study = rf.PopulationStudy(pairs=3, seed=1, records={"suites": ["el-centro-1940"]})
    >>> rf.estimate_time(study) < 60.0
    True
    """
    plan = study.plan()
    plan.check_work()
    threads = core_count() if workers is None else whole_number("workers", workers, 1)
    sample = sorted({round(place * (plan.n_ready - 1) / max(SAMPLE - 1, 1)) for place in range(SAMPLE)})
    for unit in sample[:: max(len(sample) // 6, 1)]:  # compile, and fill the caches that the study fills once
        list(plan.rows(unit))
    start, tried = perf_counter(), 0
    for unit in sample:
        list(plan.rows(unit))
        tried += 1
        if perf_counter() - start > PATIENCE:
            break
    return (perf_counter() - start) / tried * plan.n_units / min(threads, plan.n_chunks)
