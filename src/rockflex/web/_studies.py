"""What the studies of the page have in common: their structure and assumptions, their limits, and their table."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from rockflex._errors import InputError
from rockflex.motion import MEASURES
from rockflex.study._yielding import yielding
from rockflex.study.plans import CloudPlan, CloudStudy, DesignStudy, to_frame
from rockflex.web._jobs import Job
from rockflex.web._limits import RUN, check_runs
from rockflex.web._refusal import Refusal
from rockflex.web._state import CloudChoice, DesignChoice, State

if TYPE_CHECKING:
    import pandas as pd

PER_CHUNK = 24  # runs between two looks at whether to go on
CALM = 10.0  # s of free vibration of a study that yields: none can tell when a hysteretic spring is at rest

AnyStudy = TypeVar("AnyStudy", CloudStudy, DesignStudy)


def shared(state: State, choice: CloudChoice | DesignChoice, labels: Sequence[str], name: str) -> dict[str, Any]:
    """Return the content that both kinds of study have; `name` is for a nameless structure."""
    return {
        "name": state.structure.name or name,
        "structures": [state.structure.model_dump(exclude_none=True)],
        "records": {"suites": list(choice.suites)},
        "models": list(labels),
        "scales": list(choice.scales),
        "free_vibration": CALM if yielding(labels) else "settle",
        "runs_per_chunk": PER_CHUNK,
        **state.assumed(labels),
    }


def study_of(kind: type[AnyStudy], content: dict[str, Any], path: str) -> AnyStudy:
    """Return a study.

    Raises
    ------
    Refusal
        If it is not one.
    """
    try:
        return kind(**content)
    except InputError as error:
        raise Refusal({path: str(error)}) from error


def planned(study: CloudStudy | DesignStudy, path: str) -> CloudPlan:
    """Return the runs of a study, cut into small chunks.

    Raises
    ------
    Refusal
        If they cannot be made, are too many for a page, or take too long.
    """
    try:
        plan = study.plan()
    except InputError as error:
        raise Refusal({path: str(error)}) from error
    plan.bench = plan.bench.limited(RUN)
    check_runs(plan, path)
    return plan


def runs_of(job: Job) -> "pd.DataFrame | None":
    """Return the table of the runs so far; None if there are none."""
    tables = list(job.tables)
    return to_frame(*tables) if tables else None


def progress(job: Job, measure: str) -> dict[str, Any]:
    """Return how far a study is, and room for what follows from its runs."""
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
    """Return what the page is to say of a study that is over and none of whose runs was solved."""
    if not job.over or runs["status"].notna().any():
        return {}
    return {"status": "failed", "message": f"no run could be solved. {runs['error'].dropna().iloc[0]}"}
