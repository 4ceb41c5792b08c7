"""The chunks of a plan computed: in memory or in a folder that can be resumed, here or on a Dask cluster."""

from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, SupportsIndex, TypedDict, TypeVar, cast

from rockflex.engine.loops import LEVEL as VECTOR_LEVEL
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.versions import git_commit, package_versions
from rockflex.studies._arguments import Models, Motions, Structures, check_keywords, checked_scale_factors
from rockflex.studies._plan import PER_CHUNK, ChunkedPlan
from rockflex.studies._result_tables import ArrowTable, tables_to_dataframe
from rockflex.studies._run_matrix import StudyMatrix, StudyRunKeywords, study_matrix
from rockflex.studies.folders._folder import StudyFolder
from rockflex.studies.folders._manifest import LEVEL
from rockflex.studies.folders._parts import PartMaker, StudyPart
from rockflex.studies.parallel import NumberedChunks, map_chunks_on_dask, map_runs
from rockflex.studies.progress import Begin, ProgressChoice, reporting_progress
from rockflex.studies.running import checked_work_limit, worker_count
from rockflex.studies.spec import StudySpec

if TYPE_CHECKING:
    import pandas as pd


Result = TypeVar("Result")
Kind = TypeVar("Kind", bound=StudySpec)
MIN_CHUNKS_PER_THREAD = 2  # with fewer, the threads share one chunk after the other, and none is idle at the end
LIBRARIES = ("rockflex", "numpy", "scipy")  # those that affect the numbers


class PlaceKeywords(TypedDict, total=False):
    """Where and how a study is computed, by name; `run_cloud` has the meaning."""

    workers: SupportsIndex | None
    progress: ProgressChoice
    folder: str | Path | None
    dask: str | None


class StudyKeywords(StudyRunKeywords, PlaceKeywords, total=False):
    """The options of a study's runs, and where and how they are computed."""


def run_of_arguments(
    kind: type[StudySpec],
    structures: Structures,
    motions: Motions,
    models: Models,
    keys: dict[str, Any],
    options: StudyKeywords,
) -> "pd.DataFrame":
    """Run a study of a kind, as its function in Python does; `keys` are those of its file beside these arguments."""
    run, place = split_keywords(options)
    matrix = study_matrix(structures, motions, models, run)
    if "scales" in keys:
        keys |= {"scales": checked_scale_factors(keys["scales"], max(matrix.motions, key=lambda motion: motion.pga))}
    # The plan takes the properties, so that modes are found once; a folder records the structures as they were given.
    properties = dict(zip(matrix.names, matrix.structures, strict=True))
    plan = study_of_matrix(kind, properties, matrix, run, **keys).plan()
    return run_plan(plan, study=lambda: study_of_matrix(kind, structures, matrix, run, **keys), **place)


def study_of_matrix(
    kind: type[Kind], structures: Structures, matrix: StudyMatrix, run: StudyRunKeywords, **keys: Any
) -> Kind:
    """Return the study of these structures with the records and models of their matrix, and these options."""
    given: dict[str, Any] = {"structures": structures, "records": matrix.motions, "models": matrix.labels, **run}
    return kind(**given, **keys, runs_per_chunk=PER_CHUNK)


def split_keywords(options: StudyKeywords) -> tuple[StudyRunKeywords, PlaceKeywords]:
    """Return the options of the runs, and where and how they are computed.

    Raises
    ------
    TypeError
        If there is no option of a name, as for any function of Python.
    """
    check_keywords(options, StudyKeywords)
    place = {name: value for name, value in options.items() if name in PlaceKeywords.__annotations__}
    run = {name: value for name, value in options.items() if name not in place}
    run["work_limit"] = checked_work_limit(options.get("work_limit", "default"))
    return cast("StudyRunKeywords", run), cast("PlaceKeywords", place)


def run_plan(
    plan: ChunkedPlan,
    workers: SupportsIndex | None = None,
    progress: ProgressChoice = None,
    *,
    dask: str | None = None,
    folder: str | Path | None = None,
    study: Callable[[], StudySpec] | None = None,
) -> "pd.DataFrame":
    """Compute all chunks of a plan, and return them as one table, in order.

    `progress` is None, "bar", or a function of the number of units that are done, and of all. A folder needs the
    `study` of the plan.
    """

    def begin(missing: Sequence[int]) -> Callable[[int, int], object]:
        kept = plan.n_units - sum(len(plan.units_of(number)) for number in missing)
        if kept:
            advance(kept)
        return lambda number, _: advance(len(plan.units_of(number)))

    check_place(workers, dask)
    with reporting_progress(progress, plan.n_units, plan.units) as advance:
        plan.check_work()
        if folder is None or study is None:
            return table_of_plan(plan, workers, dask, begin)
        filled = fill_folder(plan, study(), folder, range(plan.n_chunks), workers, dask, begin)
    return tables_to_dataframe(filled.table())


def check_place(workers: SupportsIndex | None, dask: str | None) -> None:
    """Raise an InputError if a number of threads here is given together with a cluster."""
    if workers is not None and dask is not None:
        raise InputError(
            f"workers is for this machine, but {shown(workers)} was given together with the cluster at {dask}."
        )


def table_of_plan(plan: ChunkedPlan, workers: SupportsIndex | None, dask: str | None, begin: Begin) -> "pd.DataFrame":
    """Compute all chunks of a plan in memory, and return them as one table, in order."""
    tables = dict[int, ArrowTable]()

    def keep(number: int, table: ArrowTable) -> int:
        tables[number] = table
        return table.num_rows

    def so_far() -> "pd.DataFrame":
        return tables_to_dataframe(*(tables[number] for number in sorted(tables)))

    _compute_chunks(plan, range(plan.n_chunks), lambda each: each, keep, so_far, workers, dask, begin)
    return so_far()


def fill_folder(
    plan: ChunkedPlan,
    study: StudySpec,
    folder: str | Path,
    mine: range,
    workers: SupportsIndex | None,
    dask: str | None,
    begin: Begin,
    *,
    any_version: bool = False,
) -> StudyFolder:
    """Compute the chunks of `mine` that a folder of the study does not have, and return the folder for reading."""
    checksums = plan.checksums | study.checksums()
    with StudyFolder.open(
        folder, study.document(), plan.n_chunks, _versions_of_study(study), checksums, any_version=any_version
    ) as target:

        def keep(_: int, part: StudyPart) -> int:
            target.add(part)
            return part.rows

        def so_far() -> "pd.DataFrame":
            # Damaged parts of later rounds are computed anew in their turn.
            parts = (target.part(number) for number in range(target.n_chunks))
            return tables_to_dataframe(*(part for part in parts if part is not None))

        def stored(plan: ChunkedPlan) -> _StudyPartPlan:
            return _StudyPartPlan(plan, target.maker)

        numbers = [number for number in target.missing() if number in mine]
        _compute_chunks(plan, numbers, stored, keep, so_far, workers, dask, begin)
    return StudyFolder.load(folder)


@dataclass(frozen=True)
class _StudyPartPlan:
    """A plan whose chunks are the content of files, so that they are made where they are computed."""

    plan: ChunkedPlan
    maker: PartMaker

    def chunk(self, number: int) -> StudyPart:
        return self.maker.make(number, self.plan.chunk(number))


def _versions_of_study(study: StudySpec) -> dict[str, str]:
    """Return versions of libraries, the level of vector instructions, and commits of rockflex and the study's file."""
    commits = {
        "rockflex commit": git_commit(Path(__file__), known=True),
        "study commit": None if study.file is None else git_commit(study.file, known=False),
    }
    found = package_versions(LIBRARIES) | {LEVEL: VECTOR_LEVEL}
    return found | {name: commit for name, commit in commits.items() if commit is not None}


def _compute_chunks(
    plan: ChunkedPlan,
    numbers: Sequence[int],
    sent: Callable[[ChunkedPlan], NumberedChunks[Result]],
    keep: Callable[[int, Result], int],
    so_far: "Callable[[], pd.DataFrame]",
    workers: SupportsIndex | None,
    dask: str | None,
    begin: Begin,
) -> None:
    """Compute chunks round by round; `keep` takes each one when it is done, and counts its rows."""
    told, threads = begin(numbers), worker_count(workers)
    for place, each in enumerate(plan.rounds):
        if not any(number >= each.start for number in numbers):
            break
        if place:
            plan = plan.next_round(so_far())
        missing = [number for number in numbers if number in each]
        shared = dask is None and len(missing) < MIN_CHUNKS_PER_THREAD * threads
        work = sent(plan.on_threads(threads if shared else 1))
        # Closed at once if a part cannot be stored, or a cluster would hold the plan until this process ends.
        coming = (
            map_chunks(work.chunk, missing, 1 if shared else workers)
            if dask is None
            else map_chunks_on_dask(work, missing, dask)
        )
        with closing(coming):
            for number, result in coming:
                told(number, keep(number, result))


def map_chunks(
    chunk: Callable[[int], Any], numbers: Sequence[int], workers: SupportsIndex | None
) -> Generator[tuple[int, Any]]:
    """Yield the number and the result of chunks in order of completion."""
    return map_runs(lambda number: (number, chunk(number)), numbers, workers)
