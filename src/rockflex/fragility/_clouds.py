"""The fits of a whole cloud study: one set for each structure and model."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockflex._cases import cases
from rockflex._errors import InputError, SolverError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.fragility._cloud import CloudFit, fit_cloud
from rockflex.fragility._limit_states import NOMINAL, OVERTURNING, ROCKED
from rockflex.fragility._outcomes import OutcomeFragility, fit_outcomes

if TYPE_CHECKING:
    import pandas as pd

DISPLACEMENTS = ("max_top_displacement", "max_total_top_displacement")


@dataclass(frozen=True, eq=False)
class CloudFits(Value):
    """What the cloud of one structure and one model says.

    Attributes
    ----------
    structure, model : str
        Names in the study.
    measure : str
        Column of the intensity measure.
    outcomes : OutcomeFragility
        No rocking, rocking and overturning, and the rotations of the runs that rocked and stand.
    top_displacement : CloudFit or None
        log u_top,max, relative to the base, on log IM of the same runs, as in Figure 7. None where these cannot be
        fitted.
    total_top_displacement : CloudFit or None
        The same of the largest displacement of the top relative to the ground. None also where the height of the top
        is not known.
    n_failed : int
        Runs that could not be solved, which are in no fit.
    """

    structure: str
    model: str
    measure: str
    outcomes: OutcomeFragility
    top_displacement: CloudFit | None
    total_top_displacement: CloudFit | None
    n_failed: int


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
        Rotation in rad up to which a run counts as one without rocking.
    nominal
        Count runs as overturned that pass 0.7 atan(B/h*_1), and not only those that reach π/2.

    Raises
    ------
    InputError
        If `runs` lacks a column, a structure has no solved run with a model, or its measures are not positive.
    """
    return [
        _fits(structure, model, group, measure, threshold, nominal=nominal)
        for structure, model, group in _groups(runs, measure)
    ]


def fit_each_cloud(
    runs: "pd.DataFrame", measure: str = "pgv", *, threshold: float = ROCKED, nominal: bool = False
) -> tuple[list[CloudFits], dict[tuple[str, str], str]]:
    """Fit the clouds of a study as `fit_clouds` does, and beside them say why others cannot be fitted.

    Returns
    -------
    fits : list of CloudFits
        Of each structure and model whose runs can be fitted.
    reasons : dict
        By structure and model, why there is no fit.

    Raises
    ------
    InputError
        If `runs` lacks a column.
    """
    fits: list[CloudFits] = []
    reasons: dict[tuple[str, str], str] = {}
    for structure, model, group in _groups(runs, measure):
        try:
            fits.append(_fits(structure, model, group, measure, threshold, nominal=nominal))
        except (InputError, SolverError) as error:
            reasons[structure, model] = str(error)
    return fits, reasons


def _groups(runs: "pd.DataFrame", measure: str) -> "Iterator[tuple[str, str, pd.DataFrame]]":
    """Runs of each structure with each model."""
    needed = ["structure", "model", "status", "max_rotation", *DISPLACEMENTS, "nominal_overturning", measure]
    lacking = [name for name in needed if name not in runs]
    if lacking:
        raise InputError(f"runs must be the table of a cloud study, but it has no column {', '.join(lacking)}.")
    return cases(runs)


def _fits(
    structure: str, model: str, group: "pd.DataFrame", measure: str, threshold: float, *, nominal: bool
) -> CloudFits:
    solved = group[group["status"].notna()]
    if not len(solved):
        raise InputError(f"No run of {shown(structure)} with {model} was solved. See the column error of the table.")
    fallen = (NOMINAL if nominal else OVERTURNING).exceeded(solved).to_numpy(dtype=bool)
    im, rotation = (solved[name].to_numpy(dtype=float) for name in (measure, "max_rotation"))
    rocked = ~fallen & (rotation > threshold)
    outcomes = fit_outcomes(im, rotation, fallen, threshold=threshold)
    relative, total = (_line(im[rocked], solved[name].to_numpy(dtype=float)[rocked]) for name in DISPLACEMENTS)
    return CloudFits(structure, model, measure, outcomes, relative, total, len(group) - len(solved))


def _line(im: NDArray[np.float64], values: NDArray[np.float64]) -> CloudFit | None:
    """The fit, or None where there is none."""
    try:
        return fit_cloud(im, values)
    except InputError:
        return None
