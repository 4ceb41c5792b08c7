"""The Fragility tab: a cloud of runs, and the curves through what has come of it."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rockflex._errors import InputError, SolverError
from rockflex.fragility import CloudFits, OutcomeFragility, bootstrap_band, fit_clouds, fit_outcomes
from rockflex.modal import RockingProperties
from rockflex.study.plans import CloudStudy, to_frame
from rockflex.web._jobs import Job
from rockflex.web._limits import RUNS, check_motion, check_run, effort
from rockflex.web._packing import plain
from rockflex.web._refusal import Refusal
from rockflex.web._state import CloudChoice, State
from rockflex.web._structures import build

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.study.plans import ChunkedPlan

__all__ = ["UNITS", "check_effort", "cloud_plan", "cloud_study", "cloud_view", "table_of"]

Array = NDArray[np.float64]

GRID = 60  # points of a curve
FEWEST = 12  # runs before a curve is fitted
RESAMPLES = 60
EFFORT = 6e9  # of all runs: some ten minutes
UNITS = {
    "pga": "m/s²", "pgv": "m/s", "pgd": "m", "arias": "m/s", "cav": "m/s", "sd_t1": "m", "sa_t1": "m/s²",
    "relative_pga": "", "relative_pgv": "",
}  # fmt: skip


def cloud_study(state: State) -> CloudStudy:
    """Return the study of a state, as `rockflex cloud` runs it.

    Raises
    ------
    Refusal
        If it is not one.
    """
    content: dict[str, Any] = {
        "name": state.structure.name or "Cloud",
        "structures": [state.structure.model_dump(exclude_none=True)],
        "records": {"suites": list(state.cloud.suites)},
        "models": list(state.cloud.models),
        "scales": list(state.cloud.scales),
        "free_vibration": "settle",
        "impact": None if state.impact == "model" else state.impact,
        "runs_per_chunk": 24,
    }
    try:
        return CloudStudy(**content)
    except InputError as error:
        raise Refusal({"cloud": str(error)}) from error


def cloud_plan(state: State) -> "ChunkedPlan":
    """Return the runs of a state's cloud, cut into small chunks.

    Raises
    ------
    Refusal
        If it cannot be made, or has too many runs for a page, or takes too long.
    """
    built = build(state.structure)
    try:
        plan = cloud_study(state).plan()
    except InputError as error:
        raise Refusal({"cloud": str(error)}) from error
    if plan.n_runs > RUNS:
        message = f"the cloud has {plan.n_runs} runs, but the page takes {RUNS} at most. Use rockflex cloud."
        raise Refusal({"cloud": message})
    check_effort(plan, built.properties, state.cloud.models, len(state.cloud.scales), "cloud")
    return plan


def check_effort(
    plan: "ChunkedPlan", properties: RockingProperties, labels: Sequence[str], runs_each: int, path: str
) -> None:
    """Refuse a study whose runs take too long, one by one or together."""
    work = 0.0
    for label in labels:
        for motion in plan.motions:
            check_motion(motion, f"{path}.suites")
            check_run(properties, motion, label, 0.0)
            work += effort(properties, motion, label) * runs_each
    if work > EFFORT:
        message = "it takes too long for a page. Choose models with fewer modes, or use the command line."
        raise Refusal({path: message})


def table_of(job: Job) -> "pd.DataFrame | None":
    """Return the table of the runs so far; None if there are none."""
    tables = list(job.tables)
    return to_frame(*tables) if tables else None


def cloud_view(job: Job, state: State) -> dict[str, Any]:
    """Return progress, points and curves for the measure and the limit state that are chosen."""
    choice, total = state.cloud, job.plan.n_runs
    view: dict[str, Any] = {
        "status": job.status,
        "message": job.message,
        "done": job.runs,
        "total": total,
        "unit": UNITS[choice.measure],
        "curves": [],
        "notes": [],
    }
    runs = table_of(job)
    if runs is None:
        return view
    solved = runs[runs["status"].notna() & runs[choice.measure].notna()]
    failed = len(runs) - len(solved)
    if failed:
        first = runs["error"].dropna()
        view["notes"].append(f"{failed} runs could not be solved. {first.iloc[0] if len(first) else ''}")
    if len(solved) < FEWEST:
        return plain(view)
    im = solved[choice.measure].to_numpy(dtype=float)
    if not (im > 0.0).all() or im.min() == im.max():
        view["notes"].append("The runs so far share one intensity.")
        return plain(view)
    grid = np.geomspace(im.min(), im.max(), GRID)
    try:
        fits = fit_clouds(solved, choice.measure, nominal=choice.limit == "nominal")
    except (InputError, SolverError) as error:
        view["notes"].append(str(error))
        return plain(view)
    for fit in fits:
        part = solved[solved["model"].astype(str) == fit.model]
        view["curves"].append(_curve(fit, part, choice, grid, view["notes"]))
    return plain(view)


def _curve(fit: CloudFits, part: "pd.DataFrame", choice: CloudChoice, grid: Array, notes: list[str]) -> dict[str, Any]:
    im, rotation = (part[name].to_numpy(dtype=float) for name in (choice.measure, "max_rotation"))
    fallen = (part["status"] == "overturned").to_numpy(dtype=bool)
    nominal = part["nominal_overturning"].to_numpy(dtype=bool)
    over = {
        "rocking": rotation > fit.outcomes.threshold,
        "rotation": fallen | (rotation > choice.rotation),
        "nominal": nominal,
        "overturning": fallen,
    }[choice.limit]
    found: dict[str, Any] = {
        "model": fit.model,
        "n": len(part),
        "n_exceeding": int(over.sum()),
        "im": grid,
        "point_im": im,
        "point_rotation": np.minimum(rotation, 0.5 * math.pi),
        "point_over": over.astype(int),
        "observed": _observed(im, over),
        "median": None,
        "p": None,
        "low": None,
        "high": None,
    }
    notes += [f"{fit.model}: {note}" for note in fit.outcomes.notes]
    if choice.limit == "rotation":
        try:
            found["p"] = fit.outcomes.exceedance(grid, choice.rotation)
            low, high = _band(part, im, rotation, fallen, choice, grid)
            found |= {"low": low, "high": high}
        except (InputError, SolverError) as error:
            notes.append(f"{fit.model}: {error}")
        return found
    curve = fit.outcomes.initiation if choice.limit == "rocking" else fit.outcomes.overturning
    low, high = curve.band(grid, choice.level)
    median = getattr(curve, "median", None)
    note = getattr(curve, "note", "")
    if note:
        notes.append(f"{fit.model}: {note}")
    return found | {"p": curve.probability(grid), "low": low, "high": high, "median": median}


def _band(
    part: "pd.DataFrame", im: Array, rotation: Array, fallen: NDArray[np.bool_], choice: CloudChoice, grid: Array
) -> tuple[Array, Array]:
    """Percentile band over resampled recordings: no closed one is known for the total probability."""

    def fit(measures: Array, values: Array) -> OutcomeFragility:
        return fit_outcomes(measures, values[:, 0], values[:, 1] > 0.5)

    band = bootstrap_band(
        fit,
        im,
        np.column_stack((rotation, fallen)),
        part["group"].astype(str).to_numpy(),
        at=grid,
        level=choice.level,
        n=RESAMPLES,
        curve=lambda found, at: found.exceedance(at, choice.rotation),
    )
    return band.low, band.high


def _observed(im: Array, over: NDArray[np.bool_], bins: int = 8) -> list[list[float]]:
    """Share of runs beyond the limit in groups of neighbouring intensities, at their geometric means."""
    order = np.argsort(im, kind="stable")
    parts = [part for part in np.array_split(order, bins) if part.size]
    return [[float(np.exp(np.log(im[part]).mean())), float(over[part].mean())] for part in parts]
