"""Cloud analysis: a straight line through the logarithms of response and intensity measure."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._html import HtmlTable
from rockflex._values import Value
from rockflex.fragility._arguments import checked_confidence, fractions, log_at, log_column, log_measures
from rockflex.fragility._predictor import standard_error
from rockflex.fragility._recordings import Recordings, jackknifed, quantile_of_t
from rockflex.fragility._regression import fit_lines


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
        Covariance of (c1, c2), read-only: the jackknife over recordings; for independent runs that of least squares.
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
            return np.exp(self.c1 + self.c2 * log_at(im))

    def quantile(self, im: ArrayLike, p: ArrayLike) -> Array:
        """Response that a fraction `p` of the runs at `im` stay below; `im` and `p` broadcast."""
        from scipy.special import ndtri

        return self.median(im) * np.exp(self.dispersion * ndtri(fractions("p", p)))

    def band(self, im: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Lower and upper confidence limits of the median.

        Student's t with `n_groups` - 1 degrees of freedom; n - 2 for independent runs. NaN if all runs belong to one
        recording.
        """
        x = log_at(im)
        times = quantile_of_t(checked_confidence(confidence), self.n_groups or self.n - 1)
        half = times * standard_error(x, self.covariance)
        centre = self.c1 + self.c2 * x
        with np.errstate(over="ignore"):
            return np.exp(centre - half), np.exp(centre + half)

    def exceedance(self, im: ArrayLike, limit: ArrayLike) -> Array:
        """Probability that the response exceeds `limit` at `im`; the two broadcast."""
        from scipy.special import ndtr

        above = self.c1 + self.c2 * log_at(im) - log_at(limit, "limit")
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
    return fit_line(x, y, Recordings.beside(groups, im=x, response=y))[0]


def fit_line(x: Array, y: Array, recordings: Recordings | None = None) -> tuple[CloudFit, Array | None]:
    """Least squares through logarithms of equal length; c1, c2 and ln(dispersion) without each recording."""
    if x.size < 3 or np.ptp(y) == 0.0:
        raise InputError(
            f"A cloud needs at least 3 runs with different responses, but {x.size} runs with {np.unique(y).size} "
            "different responses were given."
        )
    c1, c2, mean, n, sxx, syy, residual = (float(value[0]) for value in fit_lines(x, y, np.ones((1, x.size))))
    variance = residual / (n - 2.0)
    count, replicates = 0, None
    if recordings is None:
        covariance = variance * np.array([[1.0 / n + mean**2 / sxx, -mean / sxx], [-mean / sxx, 1.0 / sxx]])
    else:
        count, replicates = int(recordings.held.sum()), recordings.without_each(lambda some: _parameters(x, y, some))
        covariance = jackknifed(replicates[recordings.held])[:2, :2]
    fit = CloudFit(c1, c2, math.sqrt(variance), 1.0 - residual / syy, x.size, covariance, count)
    return fit, replicates


def _parameters(x: Array, y: Array, weights: Array) -> Array:
    lines = fit_lines(x, y, weights)
    with np.errstate(all="ignore"):  # NaN where too few runs are left
        return np.column_stack((lines.intercept, lines.slope, np.log(lines.dispersion)))
