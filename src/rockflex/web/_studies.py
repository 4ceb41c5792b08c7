"""The studies of the page: the cloud of the Fragility tab, and the search for a width of the Design tab."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.json import as_json_value
from rockflex.foundation.language import translated
from rockflex.fragility._clouds import CloudFits, fit_each_cloud, recordings_of_runs
from rockflex.fragility._limit_states import (
    NOMINAL,
    OVERTURNING,
    ROCKING,
    LimitState,
    limit_state_of,
    observed_exceedance_fractions,
)
from rockflex.fragility._logistic import UnanimousOutcome, fit_logistic
from rockflex.fragility._outcomes import fit_outcomes
from rockflex.motion._measures import MEASURES
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._prepared_case import yielding_model_labels
from rockflex.studies._result_tables import count_pivot_lifts, tables_to_dataframe
from rockflex.studies._study_kind import KINDS
from rockflex.studies.cloud import CloudPlan, CloudStudy
from rockflex.studies.design._design_study import DesignStudy
from rockflex.studies.design._design_table import design_table, smallest_width
from rockflex.studies.design._designs import TendonLevel
from rockflex.web._jobs import RunsJob, StudyJob
from rockflex.web._limits import MAX_RUN_COST, check_size_of_study
from rockflex.web._refusal import Refusal, errors_as_refusals
from rockflex.web._script import cloud_script, design_script
from rockflex.web._selection import records_of_named_suites
from rockflex.web._state import DRIFT, OF_STORIES, ROTATION, CloudChoice, PageState, limit_of_choice
from rockflex.web._structure import build_page_structure
from rockflex.web._uploads import UploadedRecords

if TYPE_CHECKING:
    import pandas as pd


RUNS_PER_CHUNK = 24  # runs between two checks whether to continue
YIELDING_FREE_VIBRATION = (
    10.0  # s of free vibration of yielding models: when a hysteretic spring is at rest is not known
)


@dataclass(frozen=True, kw_only=True)
class StudyPage:
    """How the page shows one kind of study.

    Attributes
    ----------
    study : callable
        Returns the study of a state, with the records of visitors.
    job : callable
        Returns the job that computes a study of this kind.
    view : callable
        Returns what its tab shows of the runs so far, for the choices of a state.
    table, figure : callable
        Return a DataFrame and a Figure of the runs so far. `table_name` and `figure_name` are the names of the files.
    script : callable
        Returns a Python program that repeats the study.
    report, comparison : callable or None
        Return the report of the study, and of it and the alternatives, as a page of HTML, where there is one.
    """

    study: Callable[[PageState, UploadedRecords], Any]
    view: Callable[[Any, PageState], dict[str, Any]]
    table: "Callable[[Any, PageState], pd.DataFrame]"
    figure: Callable[[Any, PageState], Any]
    script: Callable[[PageState, Any], str]
    table_name: str
    figure_name: str
    job: Callable[[Any, str], RunsJob] = lambda study, kind: StudyJob(study_plan(study, kind), kind)
    report: Callable[[Any, PageState], str] | None = None
    comparison: Callable[[Any, PageState], str] | None = None


def common_study_content(
    state: PageState, uploads: UploadedRecords, kind: Literal["cloud", "design"], labels: Sequence[str], name: str
) -> dict[str, Any]:
    """Return the content that both kinds of study share; `name` is used for a structure without a name."""
    choice = state.cloud if kind == "cloud" else state.design
    return {
        "name": state.structure.name or name,
        "structures": [state.structure.model_dump(exclude_none=True)],
        "records": records_of_named_suites(state, choice.suites, uploads, f"{kind}.suites"),
        "models": list(labels),
        "scales": list(choice.scales),
        "free_vibration": YIELDING_FREE_VIBRATION if yielding_model_labels(labels) else "settle",
        "runs_per_chunk": RUNS_PER_CHUNK,
        **state.option_keys(labels),
    }


def study_plan(study: CloudStudy | DesignStudy, path: str) -> CloudPlan:
    """Return the runs of a study, divided into small chunks."""
    with errors_as_refusals(path):
        plan = cast("CloudPlan", study.plan())  # the page has no design study with a search
    plan.matrix = plan.matrix.limited(MAX_RUN_COST)
    check_size_of_study(plan, path)
    return plan


def runs_of_study_job(job: StudyJob) -> "pd.DataFrame | None":
    """Return the table of the runs so far; None if there are none."""
    tables = list(job.tables)
    return tables_to_dataframe(*tables) if tables else None


def some_runs_of_study_job(job: StudyJob) -> "pd.DataFrame":
    """Return the table of the runs so far."""
    runs = runs_of_study_job(job)
    if runs is None:
        raise Refusal("There are no runs yet.")
    return runs


def study_progress_view(job: StudyJob, measure: str) -> dict[str, Any]:
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


def no_solved_run_message(job: StudyJob, runs: "pd.DataFrame") -> dict[str, str]:
    """Return the message for a study that has ended without a solved run; an empty dictionary otherwise."""
    if not job.over or runs["status"].notna().any():
        return {}
    return {"status": "failed", "message": f"no run could be solved. {runs['error'].dropna().iloc[0]}"}


CURVE_POINTS = 60  # points of a curve
MIN_RUNS_FITTED = 12  # runs before a curve is fitted
OBSERVED_BINS = 8  # groups of the observed fractions


def cloud_study(state: PageState, uploads: UploadedRecords) -> CloudStudy:
    """Return the study of a state, as `rockflex cloud` runs it; `uploads` are the records of visitors."""
    build_page_structure(state.structure)  # for its messages, which are shown next to the fields
    content = common_study_content(state, uploads, "cloud", state.cloud.models, "Cloud")
    with errors_as_refusals("cloud"):
        return CloudStudy(**content)


def fragility_limit_of_choice(state: PageState) -> LimitState:
    """Return the limit state of the Fragility tab; refuse one on a demand that the structure has not."""
    choice, p = state.cloud, build_page_structure(state.structure).properties
    if choice.limit in OF_STORIES and not p.stories:
        message = "no story of this structure yields. Give its stories a strength, or choose another limit."
        raise Refusal({"cloud.limit": message})
    if choice.limit == DRIFT and not (p.n_modes and p.top_height):
        raise Refusal({"cloud.limit": "the top of this structure has no drift that is known. Choose another limit."})
    return limit_state_of(limit_of_choice(choice, p.top_height))


def cloud_view(job: StudyJob, state: PageState) -> dict[str, Any]:
    """Return progress, points and curves for the chosen measure and limit state."""
    choice = state.cloud
    view = study_progress_view(job, choice.measure)
    runs = runs_of_study_job(job)
    if runs is None:
        return view
    view |= no_solved_run_message(job, runs)
    solved = runs[runs["status"].notna() & runs[choice.measure].notna()]
    failed = len(runs) - len(solved)
    if failed:
        first = runs["error"].dropna()
        view["notes"].append(
            translated(
                "{n} run could not be solved. {error}" if failed == 1 else "{n} runs could not be solved. {error}",
                n=failed,
                error=first.iloc[0] if len(first) else "",
            )
        )
    view["notes"] += [text for each in count_pivot_lifts(solved) for text in each.warnings]
    if len(solved) < MIN_RUNS_FITTED:
        return as_json_value(view)
    im = solved[choice.measure].to_numpy(dtype=float)
    if not (im > 0.0).all() or im.min() == im.max():
        view["notes"].append(translated("All runs so far have the same intensity."))
        return as_json_value(view)
    limit = fragility_limit_of_choice(state)
    grid = np.geomspace(im.min(), im.max(), CURVE_POINTS)
    fits, reasons = fit_each_cloud(solved, choice.measure, nominal=choice.limit == NOMINAL.name)
    view["notes"] += [f"{model}: {reason}" for (_, model), reason in reasons.items()]
    for fit in fits:
        part = solved[solved["model"].astype(str) == fit.model]
        view["curves"].append(_fragility_curve_view(fit, part, choice, limit, grid, view["notes"]))
    return as_json_value(view)


def _fragility_curve_view(
    fit: CloudFits,
    part: "pd.DataFrame",
    choice: CloudChoice,
    limit: LimitState,
    grid: Array,
    notes: list[str],
) -> dict[str, Any]:
    im, rotation = (part[name].to_numpy(dtype=float) for name in (choice.measure, "max_rotation"))
    over = limit.exceeded(part).to_numpy(dtype=bool)
    found: dict[str, Any] = {
        "model": fit.model,
        "n": len(part),
        "n_exceeding": int(over.sum()),
        "im": grid,
        "point_im": im,
        "point_rotation": np.minimum(rotation, 0.5 * math.pi),
        "point_over": over.astype(int),
        "observed": observed_exceedance_fractions(im, over, OBSERVED_BINS),
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
            turned = fit_outcomes(im, rotation, fallen, recordings_of_runs(part)).curve(choice.rotation)
            found["p"] = turned.probability(grid)
            found["median"] = _interpolated_fragility_median(grid, found["p"])
            found["low"], found["high"] = _rising_band(*turned.band(grid, choice.confidence))
        except (InputError, SolverError) as error:
            notes.append(f"{fit.model}: {error}")
        return found
    curve: Any = fit.outcomes.initiation if choice.limit == ROCKING.name else fit.outcomes.overturning
    if limit.column:
        groups = recordings_of_runs(part)
        alike = UnanimousOutcome(bool(over[0]), over.size, 0 if groups is None else groups.nunique())
        try:
            curve = alike if over.all() or not over.any() else fit_logistic(im, over, groups)
        except (InputError, SolverError) as error:
            notes.append(f"{fit.model}: {error}")
            return found
    low, high = _rising_band(*curve.band(grid, choice.confidence))
    median = getattr(curve, "median", None)
    note = getattr(curve, "note", "")
    if note:
        notes.append(f"{fit.model}: {note}")
    return found | {"p": curve.probability(grid), "low": low, "high": high, "median": median}


def _rising_band(low: Array, high: Array) -> tuple[Array, Array]:
    """Return a band that rises with the intensity, as the probability does.

    Far from the runs that exceed the limit the error of the logit outgrows the logit, and the band of each intensity by
    itself reaches from 0 to 1; what a higher intensity has as its upper limit holds for a lower one, too.
    """
    return np.fmax.accumulate(low), np.fmin.accumulate(high[::-1])[::-1]


def _interpolated_fragility_median(grid: Array, p: Array) -> float | None:
    """Return the lowest intensity at which the probability reaches one half, interpolated; None if it does not."""
    above = np.flatnonzero(p >= 0.5)
    if not above.size or above[0] == 0:
        return None
    k = int(above[0])
    share = (0.5 - p[k - 1]) / (p[k] - p[k - 1])
    return float(np.exp(np.log(grid[k - 1]) + share * np.log(grid[k] / grid[k - 1])))


def _cloud_table(job: StudyJob, _: PageState) -> "pd.DataFrame":
    return some_runs_of_study_job(job)


def _cloud_figure(job: StudyJob, state: PageState) -> Any:
    from rockflex.plot._fragility import plot_fragility

    choice = state.cloud
    fits, reasons = fit_each_cloud(some_runs_of_study_job(job), choice.measure, nominal=choice.limit == NOMINAL.name)
    if not fits:
        reason = " ".join(f"{model}: {why}" for (_, model), why in reasons.items())
        raise Refusal(f"There is no curve to draw. {reason}")
    return plot_fragility(fits, confidence=choice.confidence, overturning=True)


CLOUD_PAGE = StudyPage(
    study=cloud_study,
    view=cloud_view,
    table=_cloud_table,
    figure=_cloud_figure,
    script=cloud_script,
    table_name="runs",
    figure_name="fragility",
)


def design_study(state: PageState, uploads: UploadedRecords) -> DesignStudy:
    """Return the study of a state, as `rockflex design` runs it; `uploads` are the records of visitors."""
    choice = state.design
    present = build_page_structure(state.structure).properties
    if choice.widest <= choice.narrowest:
        message = f"it must be more than the narrowest, {choice.narrowest:g}, but {choice.widest:g} was given."
        raise Refusal({"design.widest": message})
    widths = np.linspace(choice.narrowest, choice.widest, choice.widths) * present.half_width
    levels: list[dict[str, Any]] = []
    if not present.elements:  # else the structure keeps its own, which levels of tendons would replace
        for force in dict.fromkeys(choice.tendons):
            name = f"F₀ = {force:g} W" if force else "no tendon"
            stiffness = choice.stiffness if force else 0.0
            levels.append({"prestress_ratio": force, "stiffness_ratio": stiffness, "name": name})
    content: dict[str, Any] = common_study_content(state, uploads, "design", [choice.model], "Design") | {
        "half_widths": [float(f"{width:.6g}") for width in widths],
        "tendons": levels,
        "measure": choice.measure,
        "level": choice.at,
        "limits": [limit_of_choice(choice)],
        "target": choice.target,
    }
    with errors_as_refusals("design"):
        return DesignStudy(**content)


def _design_table(job: StudyJob, state: PageState) -> "pd.DataFrame":
    """Return the table of designs from the runs so far, one row per design."""
    runs, choice = some_runs_of_study_job(job), state.design
    with errors_as_refusals("design"):
        return design_table(runs, limit_of_choice(choice), measure=choice.measure, at=choice.at)


def design_view(job: StudyJob, state: PageState) -> dict[str, Any]:
    """Return progress, the probability against the half width for every tendon, and once done the smallest width."""
    choice = state.design
    p = build_page_structure(state.structure).properties
    view: dict[str, Any] = study_progress_view(job, choice.measure) | {"present": p.half_width, "answers": []}
    runs = runs_of_study_job(job)
    lost = {} if runs is None else no_solved_run_message(job, runs)
    if runs is None or lost:
        return as_json_value(view | lost)
    table = _design_table(job, state)
    for tendon, part in table.groupby("tendon", observed=True, sort=False):
        names = ("half_width", "aspect_ratio", "probability", "low", "high", "median_base_moment", "n_runs")
        view["curves"].append({"tendon": str(tendon), **{name: part[name].to_numpy(dtype=float) for name in names}})
        view["notes"] += [f"{translated(str(tendon))}: {note}" for note in dict.fromkeys(part["note"]) if note]
    view["notes"] += [text for each in count_pivot_lifts(KINDS["design"].runs(runs)) for text in each.warnings]
    if job.status == "done":  # the widths that lack runs may be wide enough, or not
        answers = smallest_width(table, choice.target)
        shown = ["tendon", "half_width", "half_width_upper", "outcome", "monotone", "note"]
        view["answers"] = answers[shown].to_dict("records")
        for found, row in zip(view["answers"], answers.itertuples(), strict=True):
            found["tendon_of"] = _tendon_at(p, row)
    return as_json_value(view)


def _tendon_at(p: RockingProperties, row: Any) -> dict[str, float] | None:
    """Return the tendon of an answer on a base of the width found; None where there is none, or the structure's own."""
    if p.elements or not (row.half_width > 0.0 and row.prestress_ratio > 0.0):
        return None
    level = TendonLevel(float(row.prestress_ratio), float(row.stiffness_ratio))
    (tendon, *_) = level.held(p.with_half_width(float(row.half_width))).tendons
    return {"initial_force": tendon.initial_force, "stiffness": tendon.stiffness}


def _design_figure(job: StudyJob, state: PageState) -> Any:
    from rockflex.plot._design import plot_design

    return plot_design(_design_table(job, state), state.design.target)


DESIGN_PAGE = StudyPage(
    study=design_study,
    view=design_view,
    table=_design_table,
    figure=_design_figure,
    script=design_script,
    table_name="design",
    figure_name="design",
)
