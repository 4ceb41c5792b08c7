"""Incremental dynamic analysis: a lognormal curve through the capacities of single records."""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array, Bools
from rockflex._errors import InputError
from rockflex.fragility._arguments import flags, log_column
from rockflex.fragility._lognormal import LognormalFragility, covariance_of_scores
from rockflex.fragility._recordings import Recordings
from rockflex.fragility._regression import fit_capacity_lines


def fit_capacities(
    im: ArrayLike,
    censored: ArrayLike | None = None,
    groups: ArrayLike | None = None,
    *,
    damping: float | None = None,
) -> LognormalFragility:
    """Fit a lognormal fragility to the capacities of records.

    Without censored records: mean and standard deviation (n - 1) of the logarithms, the method of moments of Baker 2015
    (Earthquake Spectra 31(1), 579-599). With them: maximum likelihood, in which a censored record contributes the
    probability of a larger capacity; this dispersion is not corrected for small samples.

    Parameters
    ----------
    im : array_like, shape (n,)
        Intensity measure at which each record first reached the limit or overturned, in any one unit; for a censored
        record the largest measure that was tried.
    censored : array_like, shape (n,), optional
        Whether the record never reached the limit.
    groups : array_like, shape (n,), optional
        Name or number of the recording of every record, the same for both components. Without it the band assumes
        independent records, and is too narrow where recordings repeat.
    damping
        As in `fit_logistic`.

    Raises
    ------
    InputError
        If a value is not positive, fewer than two different capacities are known, or the name of a recording is
        missing.

    Examples
    --------
    >>> import rockflex as rf
    >>> fit = rf.fit_capacities([0.4, 0.6, 0.9, 1.0], censored=[False, False, False, True])
    >>> print(f"{fit.median:.3g}, {fit.beta:.3g}")
    0.73, 0.458
    """
    x = log_column("im", im, "Leave those records out.")
    above = np.zeros(x.size, dtype=np.bool_) if censored is None else flags("censored", censored)
    recordings = Recordings.beside(groups, im=x, censored=above)
    known = x[~above]
    if known.size < 2 or np.ptp(known) == 0.0:
        raise InputError(
            f"im must hold at least two different capacities that were reached, but {np.unique(known).size} were given "
            f"besides {int(above.sum())} censored records. Scale the records further up."
        )
    if above.any():
        mean, beta = _maximum_likelihood(known, x[above])
        method, covariance = "censored capacities, maximum likelihood", _covariance(known, x[above], mean, beta)
    else:
        mean, beta, n = float(known.mean()), float(known.std(ddof=1)), known.size
        method, covariance = "capacities, moments", np.diag([beta**2 / n, beta**2 / (2.0 * (n - 1))])
    if recordings is None:
        return LognormalFragility(math.exp(mean), beta, covariance, x.size, method, damping=damping)
    median, replicates = math.exp(mean), recordings.without_each(lambda some: _scores(x, above, some, mean, beta))
    covariance = covariance_of_scores(replicates, median, beta)
    return LognormalFragility(median, beta, covariance, x.size, method, recordings.n, damping)


def _scores(x: Array, above: Bools, weights: Array, mean: float, beta: float) -> Array:
    """Intercept and slope of the normal score for each row of weights, by the method of the fit of all records."""
    if above.any():
        shifted = fit_capacity_lines((x - mean) / beta, -above.astype(float), weights, np.array([0.0, 1.0]))
        slope = shifted[:, 1] / beta
        return np.column_stack((shifted[:, 0] - slope * mean, slope))
    size = weights.sum(axis=1)
    with np.errstate(all="ignore"):  # NaN where one record is left
        means = weights @ x / size
        slope = 1.0 / np.sqrt((weights * (x - means[:, None]) ** 2).sum(axis=1) / (size - 1.0))
    return np.column_stack((-means * slope, slope))


def _maximum_likelihood(known: Array, above: Array) -> tuple[float, float]:
    from scipy.optimize import fmin
    from scipy.stats import CensoredData, norm

    def search(function: Any, start: Any, args: Any = (), disp: Any = 0) -> Any:
        return fmin(function, start, args, xtol=1e-7, ftol=1e-11, maxiter=10_000, maxfun=10_000, disp=disp)

    # Shifted and scaled, so that the tolerances mean the same for every unit and dispersion.
    shift, scale = float(known.mean()), float(np.ptp(known))
    data = CensoredData(uncensored=(known - shift) / scale, right=(above - shift) / scale)
    fit: Any = norm.fit  # its stubs do not accept a function as the optimizer
    mean, beta = fit(data, loc=0.0, scale=0.5, optimizer=search)
    return shift + scale * float(mean), scale * float(beta)


def _covariance(known: Array, above: Array, mean: float, beta: float) -> Array:
    """Inverse of the observed information of (mean, beta) of a normal sample with right-censored values."""
    from scipy.special import log_ndtr

    z, c = (known - mean) / beta, (above - mean) / beta
    hazard = np.exp(-0.5 * c**2 - 0.5 * math.log(2.0 * math.pi) - log_ndtr(-c))  # φ(c)/(1 - Φ(c))
    slope = hazard * (hazard - c)  # its derivative
    mean_mean = z.size + slope.sum()
    mean_beta = 2.0 * z.sum() + (hazard + c * slope).sum()
    beta_beta = (3.0 * z**2 - 1.0).sum() + (c**2 * slope + 2.0 * c * hazard).sum()
    return beta**2 * np.linalg.inv(np.array([[mean_mean, mean_beta], [mean_beta, beta_beta]]))
