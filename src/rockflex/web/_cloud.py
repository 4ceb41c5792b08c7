"""The Fragility tab: a cloud of runs, and the curves fitted to the runs so far."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError, SolverError
from rockflex._json import plain
from rockflex._shown import counted
from rockflex.fragility import (
    NOMINAL,
    OVERTURNING,
    ROCKING,
    CloudFits,
    fit_each_cloud,
    fit_outcomes,
    observed_fractions,
    recordings_of,
)
from rockflex.study.cloud import CloudStudy
from rockflex.study.plan import pivot_lifts
from rockflex.web._jobs import Job
from rockflex.web._limit_states import ROTATION, limit_state
from rockflex.web._refusal import Refusal, refusing
from rockflex.web._script import cloud_script
from rockflex.web._state import CloudChoice, State
from rockflex.web._structures import build
from rockflex.web._studies import StudyPage, none_solved, progress, runs_of, shared, some_runs_of
from rockflex.web._uploads import Uploads

if TYPE_CHECKING:
    import pandas as pd


GRID = 60  # points of a curve
FEWEST = 12  # runs before a curve is fitted
BINS = 8  # groups of the observed fractions


def cloud_study(state: State, uploads: Uploads) -> CloudStudy:
    """Return the study of a state, as `rockflex cloud` runs it; `uploads` are the records of visitors.

    Raises
    ------
    Refusal
        If the state does not describe a valid study.
    """
    build(state.structure)  # for its messages, which are shown next to the fields
    content = shared(state, uploads, "cloud", state.cloud.models, "Cloud")
    with refusing("cloud"):
        return CloudStudy(**content)


def cloud_view(job: Job, state: State) -> dict[str, Any]:
    """Return progress, points and curves for the chosen measure and limit state."""
    choice = state.cloud
    view = progress(job, choice.measure)
    runs = runs_of(job)
    if runs is None:
        return view
    view |= none_solved(job, runs)
    solved = runs[runs["status"].notna() & runs[choice.measure].notna()]
    failed = len(runs) - len(solved)
    if failed:
        first = runs["error"].dropna()
        view["notes"].append(f"{counted(failed, 'run')} could not be solved. {first.iloc[0] if len(first) else ''}")
    view["notes"] += [text for each in pivot_lifts(solved) for text in each.warnings]
    if len(solved) < FEWEST:
        return plain(view)
    im = solved[choice.measure].to_numpy(dtype=float)
    if not (im > 0.0).all() or im.min() == im.max():
        view["notes"].append("All runs so far have the same intensity.")
        return plain(view)
    grid = np.geomspace(im.min(), im.max(), GRID)
    fits, reasons = fit_each_cloud(solved, choice.measure, nominal=choice.limit == NOMINAL.name)
    view["notes"] += [f"{model}: {reason}" for (_, model), reason in reasons.items()]
    for fit in fits:
        part = solved[solved["model"].astype(str) == fit.model]
        view["curves"].append(_curve(fit, part, choice, grid, view["notes"]))
    return plain(view)


def _curve(fit: CloudFits, part: "pd.DataFrame", choice: CloudChoice, grid: Array, notes: list[str]) -> dict[str, Any]:
    im, rotation = (part[name].to_numpy(dtype=float) for name in (choice.measure, "max_rotation"))
    over = limit_state(choice.limit, choice.rotation).exceeded(part).to_numpy(dtype=bool)
    found: dict[str, Any] = {
        "model": fit.model,
        "n": len(part),
        "n_exceeding": int(over.sum()),
        "im": grid,
        "point_im": im,
        "point_rotation": np.minimum(rotation, 0.5 * math.pi),
        "point_over": over.astype(int),
        "observed": observed_fractions(im, over, BINS),
        "median": None,
        "p": None,
        "low": None,
        "high": None,
    }
    notes += [f"{fit.model}: {note}" for note in fit.outcomes.notes]
    if choice.limit == ROTATION:
        try:
            # On springs bases turn without uplift too, so a rotation is not one of rocking runs only.
            fallen = OVERTURNING.exceeded(part).to_numpy(dtype=bool)
            turned = fit_outcomes(im, rotation, fallen, recordings_of(part)).curve(choice.rotation)
            found["p"] = turned.probability(grid)
            found["median"] = _median(grid, found["p"])
            found["low"], found["high"] = turned.band(grid, choice.confidence)
        except (InputError, SolverError) as error:
            notes.append(f"{fit.model}: {error}")
        return found
    curve = fit.outcomes.initiation if choice.limit == ROCKING.name else fit.outcomes.overturning
    low, high = curve.band(grid, choice.confidence)
    median = getattr(curve, "median", None)
    note = getattr(curve, "note", "")
    if note:
        notes.append(f"{fit.model}: {note}")
    return found | {"p": curve.probability(grid), "low": low, "high": high, "median": median}


def _median(grid: Array, p: Array) -> float | None:
    """Return the lowest intensity at which the probability reaches one half, interpolated; None if it does not."""
    above = np.flatnonzero(p >= 0.5)
    if not above.size or above[0] == 0:
        return None
    k = int(above[0])
    share = (0.5 - p[k - 1]) / (p[k] - p[k - 1])
    return float(np.exp(np.log(grid[k - 1]) + share * np.log(grid[k] / grid[k - 1])))


def _runs(job: Job, _: State) -> "pd.DataFrame":
    return some_runs_of(job)


def _figure(job: Job, state: State) -> Any:
    from rockflex.plot import plot_fragility

    choice = state.cloud
    fits, reasons = fit_each_cloud(some_runs_of(job), choice.measure, nominal=choice.limit == NOMINAL.name)
    if not fits:
        reason = " ".join(f"{model}: {why}" for (_, model), why in reasons.items())
        raise Refusal(f"There is no curve to draw. {reason}")
    return plot_fragility(fits, confidence=choice.confidence, overturning=True)


PAGE = StudyPage(
    study=cloud_study,
    view=cloud_view,
    table=_runs,
    figure=_figure,
    script=cloud_script,
    table_name="runs",
    figure_name="fragility",
)
