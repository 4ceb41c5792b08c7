"""Multiple-stripe analysis: a lognormal curve through counts at a few levels of intensity."""

import math
import warnings

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector
from rockflex._errors import InputError, SolverError
from rockflex.fragility._arguments import log_measures
from rockflex.fragility._lognormal import LognormalFragility, covariance_of_scores
from rockflex.fragility._predictor import Standardised
from rockflex.fragility._recordings import Recordings
from rockflex.fragility._regression import fit_capacity_lines


def fit_stripes(
    im_levels: ArrayLike,
    n_exceeding: ArrayLike,
    n_total: ArrayLike,
    groups: ArrayLike | None = None,
    *,
    damping: float | None = None,
) -> LognormalFragility:
    """Fit a lognormal fragility to stripes by maximum likelihood of the binomial counts.

    A generalised linear model with probit link on log IM (Baker 2015, Earthquake Spectra 31(1), 579-599). Every stripe
    runs the same recordings, so its runs and those of the others are not independent: for a band give single runs, or
    counts by recording, with their `groups`. Without them the covariance is that of independent runs, from the Fisher
    information by the delta method, and the band is too narrow.

    Parameters
    ----------
    im_levels : array_like, shape (k,)
        Intensity measure of every stripe, in any one unit.
    n_exceeding, n_total : array_like, shape (k,)
        Number of runs in each stripe that exceed the limit or overturn, and of all its runs.
    groups : array_like, shape (k,), optional
        Name or number of the recording of every row, the same for both components; a level then has several rows, such
        as one for each run, with the counts 0 or 1, and 1.
    damping
        As in `fit_logistic`.

    Raises
    ------
    InputError
        If a level is not positive, a count is not a whole number or exceeds its total, the counts do not determine a
        dispersion (one level separates the runs that exceed the limit from the others), or the curve does not rise.
    SolverError
        If the fit does not converge.

    Examples
    --------
    >>> import rockflex as rf
    >>> fit = rf.fit_stripes([0.2, 0.4, 0.8], n_exceeding=[1, 4, 9], n_total=[10, 10, 10])
    >>> print(f"{fit.median:.3g}, {fit.beta:.3g}")
    0.427, 0.539
    """
    x = log_measures(im_levels, "im_levels")
    total, events = _counts("n_total", n_total, 1), _counts("n_exceeding", n_exceeding, 0)
    recordings = Recordings.beside(groups, im_levels=x, n_exceeding=events, n_total=total)
    if (events > total).any():
        row = int(np.flatnonzero(events > total)[0])
        raise InputError(
            f"n_exceeding must be at most n_total, but stripe {row} has {events[row]:g} of {total[row]:g}. "
            "Give counts, not fractions, and check their order."
        )
    _check_overlap(x, events, total)

    from statsmodels.api import GLM, families
    from statsmodels.tools.sm_exceptions import PerfectSeparationWarning

    scaled = Standardised(x)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PerfectSeparationWarning)  # stripes with probabilities close to 0 or 1
        family = families.Binomial(link=families.links.Probit())
        result = GLM(np.column_stack((events, total - events)), scaled.design, family=family).fit()
    if not (result.converged and np.isfinite(result.params).all()):
        raise SolverError(
            "The fit of the stripes did not converge. Add stripes at which some runs exceed and others do not."
        )
    a, b, covariance = scaled.unscaled(np.asarray(result.params), np.asarray(result.cov_params()))
    if b <= 0.0:
        raise InputError(
            f"The fraction of runs that exceed does not rise with im_levels (slope {b:.3g}), so no lognormal capacity "
            "fits. Check the order of the columns."
        )
    median, beta, count = math.exp(-a / b), 1.0 / b, 0
    if recordings is None:
        back = np.array([[-1.0 / b, a / b**2], [0.0, -1.0 / b**2]])
        found = back @ covariance @ back.T
    else:
        kind, both = np.repeat((1.0, -1.0), x.size), np.tile(scaled.x, 2)
        runs = np.concatenate((events, total - events))
        twice, at = Recordings(np.tile(recordings.codes, 2), recordings.n), np.asarray(result.params)
        replicates = twice.without_each(lambda some: fit_capacity_lines(both, kind, some * runs, at))
        found, count = covariance_of_scores(scaled.back(replicates), median, beta), recordings.n
    method = "binomial counts, maximum likelihood"
    return LognormalFragility(median, beta, found, int(total.sum()), method, count, damping)


def _counts(name: str, values: ArrayLike, least: int) -> Array:
    numbers = finite_vector(name, values, "runs")
    bad = np.flatnonzero((numbers != np.rint(numbers)) | (numbers < least))
    if bad.size:
        raise InputError(
            f"{name} must hold whole numbers of at least {least}, but row {bad[0]} holds {numbers[bad[0]]:g}."
        )
    return numbers


def _check_overlap(x: Array, events: Array, total: Array) -> None:
    with_events, without = x[events > 0], x[events < total]
    if with_events.size == 0 or without.size == 0:
        word, side = ("No run exceeds", "larger") if with_events.size == 0 else ("All runs exceed", "smaller")
        raise InputError(f"{word} the limit at any level, so no curve can be fitted. Add stripes at {side} levels.")
    low, high = math.exp(without.max()), math.exp(with_events.min())
    if low <= high:
        between = f"at {low:.4g}" if low == high else f"between {low:.4g} and {high:.4g}"
        raise InputError(
            f"The stripes are separated {between}: no run exceeds the limit below, all do above, so the maximum-"
            "likelihood dispersion is zero. Add stripes near that level, or pass the single runs to fit_logistic, "
            "which uses a penalty for this."
        )
