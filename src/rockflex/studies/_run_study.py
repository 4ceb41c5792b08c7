"""Loading a study from a file, and running it: here or on a cluster, in memory or in a resumable folder."""

from collections.abc import Mapping
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, SupportsIndex

from rockflex.foundation.checks import checked_whole_number
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path
from rockflex.foundation.shown import shown
from rockflex.structure.file._structure_file import read_toml_file
from rockflex.studies._plan import ChunkedPlan
from rockflex.studies._result_tables import tables_to_dataframe
from rockflex.studies._run_plan import check_place, fill_folder, table_of_plan
from rockflex.studies._study_kind import study_kind_named
from rockflex.studies.folders._folder import StudyFolder
from rockflex.studies.progress import PartProgress, check_progress, reporting_part_progress
from rockflex.studies.running import worker_count
from rockflex.studies.spec import StudySpec

if TYPE_CHECKING:
    import pandas as pd


def load_study(path: str | Path) -> StudySpec:
    """Read a study from a TOML file.

    Its key `study` is "cloud", "incremental", "stripes", "population", "monte_carlo" or "design"; the other keys are
    the fields of `CloudStudy`, `IncrementalStudy`, `StripeStudy`, `PopulationStudy`, `MonteCarloStudy` or
    `DesignStudy`. Relative paths start from the folder of the file.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    CloudStudy, IncrementalStudy, StripeStudy, PopulationStudy, MonteCarloStudy or DesignStudy
        The study; `.plan()` prepares its runs.

    Raises
    ------
    InputError
        If the file cannot be read, a key is unknown or missing, or a value is wrong; the message names file and key.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import rockflex as rf
    >>> text = '''
    ... study = "population"
    ... pairs = 5
    ... records.suites = ["el-centro-1940"]
    ... '''
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "study.toml")
    ...     _ = file.write_text(text)
    ...     study = rf.load_study(file)
    >>> study.plan().n_runs
    10
    """
    file = checked_file_path("path", path)
    return study_in_file(file, read_toml_file(file, "study"))


def study_in_file(file: Path, content: Mapping[str, Any]) -> StudySpec:
    """Return the study that a file holds; paths in it start from its folder.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is wrong; the message names file and key.
    """
    try:
        return study_kind_named(content.get("study")).spec()(**content).read_from(file.parent, file)
    except InputError as error:
        raise InputError(f"{file}: {error}") from error


MAX_SAMPLE = 48  # largest number of units that an estimate runs
MAX_SAMPLE_TIME = 2.0  # s after which an estimate stops


def run_study(
    study: "StudySpec | str | Path",
    folder: str | Path | None = None,
    *,
    workers: SupportsIndex | None = None,
    dask: str | None = None,
    any_version: bool = False,
    progress: PartProgress = None,
) -> "pd.DataFrame":
    """Run a study, or the rest of one that was stopped, and return its table.

    Parameters
    ----------
    study
        A `CloudStudy`, an `IncrementalStudy` or another kind, of tables or of objects; or the path of its TOML file.
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
        ``"bar"`` for a bar with the time left, in a terminal or a notebook; or a function of one `Progress`, called
        here at the start and after every part.

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
    >>> study = rf.PopulationStudy(pairs=3, seed=1,
    ...     records={"suites": ["el-centro-1940"]})
    >>> rf.run_study(study)[["pair", "n_stories", "status_mdof"]]
       pair  n_stories status_mdof
    0     0          4     rocking
    1     1          4     rocking
    2     2          3     rocking
    """
    if folder is not None:
        filled = fill_study(study, folder, workers=workers, dask=dask, any_version=any_version, progress=progress)
        return tables_to_dataframe(filled.table())
    plan = _plan_of_study(_loaded_study(study), workers, dask, progress)
    with reporting_part_progress(progress, plan.n_chunks) as begin:
        return table_of_plan(plan, workers, dask, begin)


def fill_study(
    study: "StudySpec | str | Path",
    folder: str | Path,
    *,
    share: tuple[SupportsIndex, SupportsIndex] = (1, 1),
    workers: SupportsIndex | None = None,
    dask: str | None = None,
    any_version: bool = False,
    progress: PartProgress = None,
) -> StudyFolder:
    """Run a study, or the rest of one that was stopped, into a folder, and return the folder for reading.

    Unlike `run_study` it reads no table, so that its memory does not grow with the number of runs.

    Parameters
    ----------
    study, folder, workers, dask, any_version, progress
        As in `run_study`.
    share
        ``(3, 10)`` computes the third of ten shares of the parts, every tenth from the third, so that ten jobs without
        a common scheduler can divide a study, each into a folder of its own. The files in the folders' ``parts`` can
        then be moved into those of any one of them, which is the whole study.

    Raises
    ------
    InputError
        As in `run_study`, and if `share` is not two whole numbers, of which the first is from 1 to the second, or if
        the study's parts depend on each other.
    ClusterError
        As in `run_study`.

    Examples
    --------
    >>> import tempfile
    >>> import rockflex as rf
    >>> study = rf.PopulationStudy(pairs=6, seed=1, runs_per_chunk=4,
    ...     records={"suites": ["el-centro-1940"]})
    >>> with tempfile.TemporaryDirectory() as path:
    ...     rf.fill_study(study, path, share=(1, 2)).missing()
    ...     rf.fill_study(study, path).finished
    [1]
    True
    """
    spec = _loaded_study(study)
    plan = _plan_of_study(spec, workers, dask, progress)
    mine = _share_of_chunks(plan, share)
    with reporting_part_progress(progress, len(mine)) as begin:
        return fill_folder(plan, spec, folder, mine, workers, dask, begin, any_version=any_version)


def _loaded_study(study: "StudySpec | str | Path") -> "StudySpec":
    return load_study(study) if isinstance(study, str | Path) else study


def _plan_of_study(
    spec: "StudySpec", workers: SupportsIndex | None, dask: str | None, progress: PartProgress
) -> "ChunkedPlan":
    check_progress(progress, "one Progress")
    check_place(workers, dask)
    plan = spec.plan()
    plan.check_work()
    return plan


def _share_of_chunks(plan: "ChunkedPlan", share: tuple[SupportsIndex, SupportsIndex]) -> range:
    if not isinstance(share, tuple) or len(share) != 2:  # pyright: ignore[reportUnnecessaryComparison, reportUnnecessaryIsInstance]
        raise InputError(f"share must be two whole numbers, such as (3, 10), but {shown(share)} was given.")
    count = checked_whole_number("the number of shares", share[1], 1)
    place = checked_whole_number("the number of the share", share[0], 1, count)
    if count > 1 and len(plan.rounds) > 1:
        raise InputError(
            "This study cannot be divided into shares, because later parts depend on earlier ones. Run it as a whole, "
            "on a Dask cluster if it is long."
        )
    return range(place - 1, plan.n_chunks, count)


def estimate_time(study: "StudySpec", workers: SupportsIndex | None = None) -> float:
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
        Time in s.

    Examples
    --------
    >>> import rockflex as rf
    >>> study = rf.PopulationStudy(pairs=3, seed=1,
    ...     records={"suites": ["el-centro-1940"]})
    >>> rf.estimate_time(study) < 60.0
    True
    """
    plan = study.plan()
    plan.check_work()
    threads = worker_count(workers)
    sample = sorted({round(place * (plan.n_ready - 1) / max(MAX_SAMPLE - 1, 1)) for place in range(MAX_SAMPLE)})
    for unit in sample[:: max(len(sample) // 6, 1)]:  # fill the caches that the study fills once
        plan.results([unit])
    start, tried = perf_counter(), 0
    for unit in sample:
        plan.results([unit])
        tried += 1
        if perf_counter() - start > MAX_SAMPLE_TIME:
            break
    return (perf_counter() - start) / tried * plan.n_units / min(threads, plan.n_units)
