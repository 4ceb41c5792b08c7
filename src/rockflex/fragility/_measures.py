"""Which intensity measure predicts a response best."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.fragility._arguments import log_column, log_measures, same_length
from rockflex.fragility._cloud import fit_line

if TYPE_CHECKING:
    import pandas as pd


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
    >>> measures = pd.DataFrame({"pga": [2.0, 3.0, 6.0, 5.0], "pgv": [0.2, 0.4, 0.6, 0.8]})
    >>> table = rf.compare_measures(measures, [0.004, 0.011, 0.016, 0.026])
    >>> list(table.index)
    ['pgv', 'pga']
    >>> table["dispersion"].round(3).tolist()
    [0.083, 0.432]
    """
    import pandas as pd

    _check_table("measures", measures)
    if isinstance(response, pd.Series):
        _check_rows("response", response.index, measures.index)
    columns: dict[str, Array] = {}
    if covariates is not None:
        _check_table("covariates", covariates)
        _check_rows("covariates", covariates.index, measures.index)
        columns = {str(name): _numbers(str(name), covariates[name]) for name in covariates.columns}
    y = log_column("response", response, "Leave those runs out of all tables.")

    rows: dict[str, dict[str, float]] = {}
    for name in measures.columns:
        x = log_measures(measures[name].to_numpy(), f"measures[{shown(name)}]")
        same_length(measures=x, response=y)
        fit, _ = fit_line(x, y)
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
            row[f"p_{other}"] = _p_value(column[kept], residuals[kept])
            row[f"left_out_{other}"] = int((~kept).sum())
        rows[name] = row
    table = pd.DataFrame.from_dict(rows, orient="index").rename_axis("measure")
    whole = ["n", *(f"left_out_{other}" for other in columns)]
    return table.astype(dict.fromkeys(whole, np.int64)).sort_values("dispersion", kind="stable")


def _check_table(name: str, table: object) -> None:
    import pandas as pd

    if not isinstance(table, pd.DataFrame) or table.shape[1] == 0:
        raise InputError(
            f"{name} must be a pandas DataFrame with one column or more, but {type(table).__name__} was given."
        )


def _check_rows(name: str, index: "pd.Index[Any]", expected: "pd.Index[Any]") -> None:
    if not index.equals(expected):
        raise InputError(
            f"{name} must have the same row labels as measures, in the same order. Take all from one table, or drop "
            "the labels of each with reset_index(drop=True)."
        )


def _numbers(name: str, column: "pd.Series[Any]") -> Array:
    try:
        return column.to_numpy(dtype=np.float64, na_value=np.nan)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"covariates[{shown(name)}] must hold numbers, but {column.dtype} was given. Leave the column out."
        ) from error


def _p_value(covariate: Array, residuals: Array) -> float:
    from scipy.stats import linregress

    if covariate.size < 3 or np.ptp(covariate) == 0.0:
        return float("nan")
    return float(linregress(covariate, residuals).pvalue)
