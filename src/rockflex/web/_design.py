"""The Design tab: the required width of the base, with and without tendons."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rockflex._json import plain
from rockflex.kinds import KINDS
from rockflex.study.design import DesignStudy, design_table, smallest_width
from rockflex.study.plan import pivot_lifts
from rockflex.web._jobs import Job
from rockflex.web._limit_states import ROTATION
from rockflex.web._refusal import Refusal, refusing
from rockflex.web._script import design_script
from rockflex.web._state import DesignChoice, State
from rockflex.web._structures import build
from rockflex.web._studies import StudyPage, none_solved, progress, runs_of, shared, some_runs_of
from rockflex.web._uploads import Uploads

if TYPE_CHECKING:
    import pandas as pd


def limit_of(choice: DesignChoice) -> float | str:
    """Return the limit in the form that the library expects."""
    return choice.rotation if choice.limit == ROTATION else choice.limit


def design_study(state: State, uploads: Uploads) -> DesignStudy:
    """Return the study of a state, as `rockflex design` runs it; `uploads` are the records of visitors.

    Raises
    ------
    Refusal
        If the state does not describe a valid study.
    """
    choice = state.design
    present = build(state.structure).properties
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
    content: dict[str, Any] = shared(state, uploads, "design", [choice.model], "Design") | {
        "half_widths": [float(f"{width:.6g}") for width in widths],
        "tendons": levels,
        "measure": choice.measure,
        "level": choice.at,
        "limits": [limit_of(choice)],
        "target": choice.target,
    }
    with refusing("design"):
        return DesignStudy(**content)


def _table(job: Job, state: State) -> "pd.DataFrame":
    """Return the table of designs from the runs so far, one row per design."""
    runs, choice = some_runs_of(job), state.design
    with refusing("design"):
        return design_table(runs, limit_of(choice), measure=choice.measure, at=choice.at)


def design_view(job: Job, state: State) -> dict[str, Any]:
    """Return progress, the probability against the half width for every tendon, and the smallest width."""
    choice = state.design
    present = build(state.structure).properties.half_width
    view: dict[str, Any] = progress(job, choice.measure) | {"present": present, "answers": []}
    runs = runs_of(job)
    lost = {} if runs is None else none_solved(job, runs)
    if runs is None or lost:
        return plain(view | lost)
    table = _table(job, state)
    for tendon, part in table.groupby("tendon", observed=True, sort=False):
        names = ("half_width", "aspect_ratio", "probability", "low", "high", "median_base_moment", "n_runs")
        view["curves"].append({"tendon": str(tendon), **{name: part[name].to_numpy(dtype=float) for name in names}})
        view["notes"] += [f"{tendon}: {note}" for note in dict.fromkeys(part["note"]) if note]
    view["notes"] += [text for each in pivot_lifts(KINDS["design"].runs(runs)) for text in each.warnings]
    answers = smallest_width(table, choice.target)
    view["answers"] = answers[["tendon", "half_width", "half_width_upper", "outcome", "monotone", "note"]].to_dict(
        "records"
    )
    return plain(view)


def _figure(job: Job, state: State) -> Any:
    from rockflex.plot import plot_design

    return plot_design(_table(job, state), state.design.target)


PAGE = StudyPage(
    study=design_study,
    view=design_view,
    table=_table,
    figure=_figure,
    script=design_script,
    table_name="design",
    figure_name="design",
)
