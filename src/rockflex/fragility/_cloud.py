"""Cloud analysis: a straight line through the logarithms of response and intensity measure."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.fragility._arguments import (
    check_same_column_length,
    checked_probabilities,
    log_column,
    log_measures,
    log_of_evaluation_points,
)
from rockflex.fragility._jackknife import RecordingGroups, band_of_line, jackknife_covariance
from rockflex.fragility._regression import fit_least_squares_lines

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, repr=False)
class CloudFit(HtmlTable, Value):
    """The line log(y) = c1 + c2 log(IM), with natural logarithms, and the scatter about it.

    Given IM, the response is lognormal about the line with the same dispersion everywhere (Silva & Stojadinović 2024,
    Section 3.2; Jalayer & Cornell 2009, Earthquake Eng. Struct. Dyn. 38(8), 951-972).

    Attributes
    ----------
    c1, c2 : float
        Intercept (logarithm of the response at IM = 1, in the unit given) and slope.
    dispersion : float
        Standard deviation of the residuals of log(y), with n - 2 degrees of freedom.
    r2 : float
        Coefficient of determination of the logarithms.
    n : int
        Number of runs.
    covariance : ndarray, shape (2, 2)
        Covariance of (c1, c2), read-only: the jackknife over recordings; for independent runs from least squares.
    n_groups : int
        Number of recordings; 0 if the runs were taken as independent.

    Examples
    --------
    >>> import rockflex as rf
    >>> fit = rf.fit_cloud([0.2, 0.4, 0.6, 0.8], [0.004, 0.011, 0.016, 0.026])
    >>> print(f"{fit.median(0.5):.3g}, {fit.exceedance(0.5, 0.02):.3g}")
    0.0137, 2.09e-06
    >>> low, high = fit.band([0.4, 0.6], confidence=0.9)
    >>> low.shape
    (2,)
    """

    c1: float
    c2: float
    dispersion: float
    r2: float
    n: int
    covariance: Array
    n_groups: int = 0

    def __repr__(self) -> str:
        line = f"c1={self.c1:.4g}, c2={self.c2:.4g}, dispersion={self.dispersion:.4g}"
        return f"CloudFit({line}, r2={self.r2:.4g}, n={self.n})"

    def median(self, im: ArrayLike) -> Array:
        """Median response exp(c1) IM^c2, of the shape of `im`."""
        with np.errstate(over="ignore"):
            return np.exp(self.c1 + self.c2 * log_of_evaluation_points(im))

    def quantile(self, im: ArrayLike, p: ArrayLike) -> Array:
        """Response that a fraction `p` of the runs at `im` stay below; `im` and `p` broadcast."""
        from scipy.special import ndtri

        return self.median(im) * np.exp(self.dispersion * ndtri(checked_probabilities("p", p)))

    def band(self, im: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Lower and upper confidence limits of the median.

        Student's t with `n_groups` - 1 degrees of freedom; n - 2 for independent runs. NaN if all runs belong to one
        recording.
        """
        x = log_of_evaluation_points(im)
        low, high = band_of_line((self.c1, self.c2), x, self.covariance, confidence, self.n_groups or self.n - 1)
        with np.errstate(over="ignore"):
            return np.exp(low), np.exp(high)

    def exceedance(self, im: ArrayLike, limit: ArrayLike) -> Array:
        """Probability that the response exceeds `limit` at `im`; the two broadcast."""
        from scipy.special import ndtr

        above = self.c1 + self.c2 * log_of_evaluation_points(im) - log_of_evaluation_points(limit, "limit")
        if self.dispersion == 0.0:
            return np.where(above > 0.0, 1.0, 0.0)
        return ndtr(above / self.dispersion)


def fit_cloud(im: ArrayLike, response: ArrayLike, groups: ArrayLike | None = None) -> CloudFit:
    """Fit log(y) = c1 + c2 log(IM) by least squares (Silva & Stojadinović 2024, Figures 6 and 7).

    Parameters
    ----------
    im : array_like, shape (n,)
        Intensity measure of every run, in any one unit; n >= 3.
    response : array_like, shape (n,)
        Peak response of every run, in any one unit: the runs that rocked and did not overturn.
    groups : array_like, shape (n,), optional
        Name or number of the recording of every run, as in `fit_logistic`. Without it the band assumes independent
        runs, and is too narrow where recordings repeat.

    Raises
    ------
    InputError
        If a value is not positive and finite, fewer than three runs are given, all have the same measure or the same
        response, or the name of a recording is missing.

    Examples
    --------
    >>> import rockflex as rf
    >>> fit = rf.fit_cloud([0.2, 0.4, 0.6, 0.8], [0.004, 0.011, 0.016, 0.026])
    >>> print(f"{fit.c1:.3g}, {fit.c2:.3g}, {fit.dispersion:.3g}, {fit.r2:.3g}")
    -3.38, 1.32, 0.083, 0.993
    """
    x = log_measures(im)
    y = log_column(
        "response", response, "A cloud holds the runs that responded: leave the others out, or see fit_outcomes."
    )
    return fit_cloud_line(x, y, RecordingGroups.beside(groups, im=x, response=y))[0]


def fit_cloud_line(x: Array, y: Array, recordings: RecordingGroups | None = None) -> tuple[CloudFit, Array | None]:
    """Least squares through logarithms of equal length; c1, c2 and ln(dispersion) without each recording."""
    if x.size < 3 or np.ptp(y) == 0.0:
        raise InputError(
            f"A cloud needs at least 3 runs with different responses, but {x.size} runs with {np.unique(y).size} "
            "different responses were given."
        )
    line = fit_least_squares_lines(x, y, np.ones((1, x.size)))
    c1, c2, mean, n, sxx, syy, residual = (float(value[0]) for value in line)
    variance = residual / (n - 2.0)
    count, replicates = 0, None
    if recordings is None:
        covariance = variance * np.array([[1.0 / n + mean**2 / sxx, -mean / sxx], [-mean / sxx, 1.0 / sxx]])
    else:
        count = int(recordings.held.sum())
        replicates = recordings.without_each(lambda some: _cloud_parameters(x, y, some))
        covariance = jackknife_covariance(replicates[recordings.held])[:2, :2]
    fit = CloudFit(c1, c2, math.sqrt(variance), 1.0 - residual / syy, x.size, covariance, count)
    return fit, replicates


def _cloud_parameters(x: Array, y: Array, weights: Array) -> Array:
    lines = fit_least_squares_lines(x, y, weights)
    with np.errstate(all="ignore"):  # NaN where too few runs are left
        return np.column_stack((lines.intercept, lines.slope, np.log(lines.dispersion)))


def describe_power_law(fit: CloudFit, unit: str) -> str:
    """Return a line through logarithms as the text of a power law; `unit` is the unit of the response."""
    return f"{math.exp(fit.c1):.4g} {unit} · IM^{fit.c2:.4g}, dispersion {fit.dispersion:.4g}, R² {fit.r2:.4g}"


def compare_measures(
    measures: "pd.DataFrame", response: ArrayLike, covariates: "pd.DataFrame | None" = None
) -> "pd.DataFrame":
    """Rank intensity measures by how well each explains a response.

    Efficiency (small dispersion), practicality (steep slope c2), proficiency (small dispersion/c2) and sufficiency
    (residuals that do not depend on magnitude, distance or scale) as in Luco & Cornell 2007, Earthquake Spectra 23(2),
    357-392, and Padgett, Nielson & DesRoches 2008, Earthquake Eng. Struct. Dyn. 37(5), 711-725.

    Parameters
    ----------
    measures : pandas.DataFrame
        One row per run and one column per intensity measure; positive.
    response : array_like, shape (n,)
        Peak response of the same runs, positive.
    covariates : pandas.DataFrame, optional
        One row per run and one column per property of the record; take the logarithm of a distance or a scale first.
        Runs without a value (NaN) are left out of that test only.

    Returns
    -------
    pandas.DataFrame
        One row per measure, smallest dispersion first: `c2`, `dispersion`, `proficiency` (infinite if c2 <= 0), `r2`,
        `n`, and for each covariate `p_NAME`, the p-value of the slope of the residuals (Student's t; small values
        indicate insufficiency; NaN if fewer than three runs or a single value remain), and `left_out_NAME`. The
        p-values assume independent runs.

    Raises
    ------
    InputError
        If a table is not a DataFrame, has no column or other rows than the response, or a measure cannot be fitted.

    Examples
    --------
    >>> import rockflex as rf
    >>> import pandas as pd
    >>> measures = pd.DataFrame({"pga": [2.0, 3.0, 6.0, 5.0],
    ...     "pgv": [0.2, 0.4, 0.6, 0.8]})
    >>> table = rf.compare_measures(measures, [0.004, 0.011, 0.016, 0.026])
    >>> list(table.index)
    ['pgv', 'pga']
    >>> table["dispersion"].round(3).tolist()
    [0.083, 0.432]
    """
    import pandas as pd

    _check_measure_table("measures", measures)
    if isinstance(response, pd.Series):
        _check_measure_rows("response", response.index, measures.index)
    columns: dict[str, Array] = {}
    if covariates is not None:
        _check_measure_table("covariates", covariates)
        _check_measure_rows("covariates", covariates.index, measures.index)
        columns = {str(name): _numeric_measure_column(str(name), covariates[name]) for name in covariates.columns}
    y = log_column("response", response, "Leave those runs out of all tables.")

    rows: dict[str, dict[str, float]] = {}
    for name in measures.columns:
        x = log_measures(measures[name].to_numpy(), f"measures[{shown(name)}]")
        check_same_column_length(measures=x, response=y)
        fit, _ = fit_cloud_line(x, y)
        residuals = y - (fit.c1 + fit.c2 * x)
        row = {
            "c2": fit.c2,
            "dispersion": fit.dispersion,
            "proficiency": fit.dispersion / fit.c2 if fit.c2 > 0.0 else np.inf,
            "r2": fit.r2,
            "n": fit.n,
        }
        for other, column in columns.items():
            kept = np.isfinite(column)
            row[f"p_{other}"] = _sufficiency_p_value(column[kept], residuals[kept])
            row[f"left_out_{other}"] = int((~kept).sum())
        rows[name] = row
    table = pd.DataFrame.from_dict(rows, orient="index").rename_axis("measure")
    whole = ["n", *(f"left_out_{other}" for other in columns)]
    return table.astype(dict.fromkeys(whole, np.int64)).sort_values("dispersion", kind="stable")


def _check_measure_table(name: str, table: object) -> None:
    import pandas as pd

    if not isinstance(table, pd.DataFrame) or table.shape[1] == 0:
        raise InputError(
            f"{name} must be a pandas DataFrame with one column or more, but {type(table).__name__} was given."
        )


def _check_measure_rows(name: str, index: "pd.Index[Any]", expected: "pd.Index[Any]") -> None:
    if not index.equals(expected):
        raise InputError(
            f"{name} must have the same row labels as measures, in the same order. Take all from one table, or drop "
            "the labels of each with reset_index(drop=True)."
        )


def _numeric_measure_column(name: str, column: "pd.Series[Any]") -> Array:
    try:
        return column.to_numpy(dtype=np.float64, na_value=np.nan)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"covariates[{shown(name)}] must hold numbers, but {column.dtype} was given. Leave the column out."
        ) from error


def _sufficiency_p_value(covariate: Array, residuals: Array) -> float:
    from scipy.stats import linregress

    if covariate.size < 3 or np.ptp(covariate) == 0.0:
        return float("nan")
    return float(linregress(covariate, residuals).pvalue)
