"""What the studies of the page share: structure and assumptions, limits, and the table of their runs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, cast

from rockflex.motion import MEASURES
from rockflex.study._yielding import yielding
from rockflex.study.cloud import CloudPlan, CloudStudy
from rockflex.study.design import DesignStudy
from rockflex.study.plan import to_frame
from rockflex.web._jobs import Job
from rockflex.web._limits import RUN, check_runs
from rockflex.web._refusal import Refusal, refusing
from rockflex.web._state import State
from rockflex.web._suites import records_of
from rockflex.web._uploads import Uploads

if TYPE_CHECKING:
    import pandas as pd

PER_CHUNK = 24  # runs between two checks whether to continue
CALM = 10.0  # s of free vibration of yielding models: when a hysteretic spring is at rest is not known


@dataclass(frozen=True, kw_only=True)
class StudyPage:
    """How the page shows one kind of study.

    Attributes
    ----------
    study : callable
        Returns the study of a state, with the records of visitors.
    view : callable
        Returns what its tab shows of the runs so far, for the choices of a state.
    table, figure : callable
        Return a DataFrame and a Figure of the runs so far. `table_name` and `figure_name` are the names of the files.
    script : callable
        Returns a Python program that repeats the study.
    """

    study: Callable[[State, Uploads], Any]
    view: "Callable[[Job, State], dict[str, Any]]"
    table: "Callable[[Job, State], pd.DataFrame]"
    figure: "Callable[[Job, State], Any]"
    script: Callable[[State, Any], str]
    table_name: str
    figure_name: str


def shared(
    state: State, uploads: Uploads, kind: Literal["cloud", "design"], labels: Sequence[str], name: str
) -> dict[str, Any]:
    """Return the content that both kinds of study share; `name` is used for a structure without a name.

    Raises
    ------
    Refusal
        If the server does not have the records.
    """
    choice = state.cloud if kind == "cloud" else state.design
    return {
        "name": state.structure.name or name,
        "structures": [state.structure.model_dump(exclude_none=True)],
        "records": records_of(state, choice.suites, uploads, f"{kind}.suites"),
        "models": list(labels),
        "scales": list(choice.scales),
        "free_vibration": CALM if yielding(labels) else "settle",
        "runs_per_chunk": PER_CHUNK,
        **state.assumed(labels),
    }


def planned(study: CloudStudy | DesignStudy, path: str) -> CloudPlan:
    """Return the runs of a study, divided into small chunks.

    Raises
    ------
    Refusal
        If they cannot be prepared, are too many for the page, or take too long.
    """
    with refusing(path):
        plan = cast("CloudPlan", study.plan())  # the page has no design study with a search
    plan.bench = plan.bench.limited(RUN)
    check_runs(plan, path)
    return plan


def runs_of(job: Job) -> "pd.DataFrame | None":
    """Return the table of the runs so far; None if there are none."""
    tables = list(job.tables)
    return to_frame(*tables) if tables else None


def some_runs_of(job: Job) -> "pd.DataFrame":
    """Return the table of the runs so far.

    Raises
    ------
    Refusal
        If there are none.
    """
    runs = runs_of(job)
    if runs is None:
        raise Refusal("There are no runs yet.")
    return runs


def progress(job: Job, measure: str) -> dict[str, Any]:
    """Return the progress of a study, with empty lists for the curves and notes."""
    return {
        "status": job.status,
        "message": job.message,
        "done": job.runs,
        "total": job.plan.n_runs,
        "unit": MEASURES[measure].unit,
        "curves": [],
        "notes": [],
    }


def none_solved(job: Job, runs: "pd.DataFrame") -> dict[str, str]:
    """Return the message for a study that has ended without a solved run; an empty dictionary otherwise."""
    if not job.over or runs["status"].notna().any():
        return {}
    return {"status": "failed", "message": f"no run could be solved. {runs['error'].dropna().iloc[0]}"}
