"""The fits of a whole cloud study: one set for each structure and model."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.cases import runs_by_case
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.fragility._cloud import CloudFit, describe_power_law, fit_cloud
from rockflex.fragility._hazard import measure_damping_of_runs
from rockflex.fragility._limit_states import NOMINAL, OVERTURNING, ROCKED, UPLIFT, rocked_runs
from rockflex.fragility._outcomes import OutcomeFragility, fit_outcomes

if TYPE_CHECKING:
    import pandas as pd

DISPLACEMENTS = ("max_top_displacement", "max_total_top_displacement")


@dataclass(frozen=True, eq=False, repr=False)
class CloudFits(HtmlTable, Value):
    """Fits of the cloud of one structure and one model.

    Attributes
    ----------
    structure, model : str
        Names in the study.
    measure : str
        Column of the intensity measure.
    outcomes : OutcomeFragility
        No rocking, rocking and overturning, and the rotations of the runs that rocked without overturning.
    top_displacement : CloudFit or None
        log u_top,max, relative to the base, on log IM of the same runs, as in Figure 7. None if it cannot be
        fitted.
    total_top_displacement : CloudFit or None
        The same for the largest displacement of the top relative to the ground. Also None if the height of the top is
        not known.
    n_failed : int
        Runs that could not be solved; the fits exclude them.
    ductility : CloudFit or None
        The same for the largest ductility of stories that yield; None without such stories.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> motions = [rf.ricker_pulse(2.5, period) for period in (0.5, 0.7, 1.0)]
    >>> runs = rf.run_cloud(structure, dict(zip("abc", motions)), "rigid",
    ...     scales=[0.5, 1.0, 1.5, 2.0])
    >>> (fit,) = rf.fit_clouds(runs, "pga")
    >>> fit.model, fit.measure, fit.n_failed
    ('rigid', 'pga', 0)
    """

    structure: str
    model: str
    measure: str
    outcomes: OutcomeFragility
    top_displacement: CloudFit | None
    total_top_displacement: CloudFit | None
    n_failed: int
    ductility: CloudFit | None = None

    def __repr__(self) -> str:
        return (
            f"CloudFits({self.structure!r}, {self.model!r}, {self.measure!r}: {self.outcomes.counts}, "
            f"{self.n_failed} failed)"
        )

    def _shown_as(self) -> Mapping[str, Any]:
        tops = {name: getattr(self, name) for name in ("top_displacement", "total_top_displacement")}
        return {
            "structure": self.structure,
            "model": self.model,
            "measure": self.measure,
            **self.outcomes._shown_as(),  # pyright: ignore[reportPrivateUsage]
            **{name: None if fit is None else describe_power_law(fit, "m") for name, fit in tops.items()},
            **({} if self.ductility is None else {"ductility": describe_power_law(self.ductility, "")}),
            "failed": self.n_failed,
        }


def fit_clouds(
    runs: "pd.DataFrame", measure: str = "pgv", *, threshold: float = ROCKED, nominal: bool = False
) -> list[CloudFits]:
    """Fit the clouds of a study, in the order of its structures and models (Silva & Stojadinović 2024, Figs. 5-7).

    Parameters
    ----------
    runs : pandas.DataFrame
        The table of a cloud study.
    measure
        Column of the intensity measure.
    threshold
        A run counts as rocking if its base uplifted and its rotation in rad is larger.
    nominal
        Whether runs that exceed 0.7 atan(B/h*_1) count as overturned, as well as runs that reach π/2.

    Raises
    ------
    InputError
        If `runs` lacks a column, a structure has no solved run with a model, or its measures are not positive.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> motions = [rf.ricker_pulse(2.5, period) for period in (0.5, 0.7, 1.0)]
    >>> runs = rf.run_cloud(structure, dict(zip("abc", motions)), "rigid",
    ...     scales=[0.5, 1.0, 1.5, 2.0])
    >>> (fit,) = rf.fit_clouds(runs, "pga")
    >>> found = fit.outcomes
    >>> found.n_no_rocking, found.n_rocking, found.n_overturned
    (3, 9, 0)
    """
    return [
        _fits_of_cloud_case(structure, model, group, measure, threshold, nominal=nominal)
        for structure, model, group in _cases_of_cloud(runs, measure)
    ]


def fit_each_cloud(
    runs: "pd.DataFrame", measure: str = "pgv", *, threshold: float = ROCKED, nominal: bool = False
) -> tuple[list[CloudFits], dict[tuple[str, str], str]]:
    """Fit the clouds of a study as `fit_clouds` does, and say why others, by structure and model, cannot be fitted."""
    fits: list[CloudFits] = []
    reasons: dict[tuple[str, str], str] = {}
    for structure, model, group in _cases_of_cloud(runs, measure):
        try:
            fits.append(_fits_of_cloud_case(structure, model, group, measure, threshold, nominal=nominal))
        except (InputError, SolverError) as error:
            reasons[structure, model] = str(error)
    return fits, reasons


def recordings_of_runs(runs: "pd.DataFrame") -> "pd.Series[Any] | None":
    """Recording of every run, by the column `group`, else by `motion` where motions repeat; None without either."""
    if "group" in runs:
        return runs["group"].astype(str)
    repeat = "motion" in runs and runs["motion"].nunique() < len(runs)
    return runs["motion"].astype(str) if repeat else None


def _cases_of_cloud(runs: "pd.DataFrame", measure: str) -> "Iterator[tuple[str, str, pd.DataFrame]]":
    """Runs of each structure with each model."""
    needed = ["structure", "model", "status", "max_rotation", *DISPLACEMENTS, "nominal_overturning", measure]
    lacking = [name for name in needed if name not in runs]
    if lacking:
        raise InputError(f"runs must be the table of a cloud study, but it has no column {', '.join(lacking)}.")
    return runs_by_case(runs)


def _fits_of_cloud_case(
    structure: str, model: str, group: "pd.DataFrame", measure: str, threshold: float, *, nominal: bool
) -> CloudFits:
    solved = group[group["status"].notna()]
    if not len(solved):
        raise InputError(f"No run of {shown(structure)} with {model} was solved. See the column error of the table.")
    fallen = (NOMINAL if nominal else OVERTURNING).exceeded(solved).to_numpy(dtype=bool)
    im, rotation = (solved[name].to_numpy(dtype=float) for name in (measure, "max_rotation"))
    rocks = ~fallen & rocked_runs(solved, threshold).to_numpy(dtype=bool)
    lifts = UPLIFT.exceeded(solved).to_numpy(dtype=bool)
    groups = recordings_of_runs(solved)
    damping = measure_damping_of_runs(solved, measure)
    outcomes = fit_outcomes(im, rotation, fallen, groups, uplifted=lifts, threshold=threshold, damping=damping)
    relative, total, ductility = (
        _peak_fit(im, solved[name].to_numpy(dtype=float), rocks, groups) if name in solved else None
        for name in (*DISPLACEMENTS, "max_ductility")
    )
    return CloudFits(structure, model, measure, outcomes, relative, total, len(group) - len(solved), ductility)


def _peak_fit(im: Array, values: Array, rocked: Bools, groups: "pd.Series[Any] | None") -> CloudFit | None:
    """The fit of the runs that rocked, or None if it fails."""
    try:
        return fit_cloud(im[rocked], values[rocked], None if groups is None else groups[rocked])
    except InputError:
        return None
