"""Fragility curves of lognormal shape, and their fits to the capacities of records and to stripes."""

import math
import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_finite_matrix, checked_finite_vector, checked_positive
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.values import Value, with_changed_fields
from rockflex.fragility import _arguments, _jackknife
from rockflex.fragility._regression import StandardisedLogs, fit_capacity_lines


@dataclass(frozen=True, eq=False)
class LognormalFragility(HtmlTable, Value):
    """The curve P = Φ(ln(IM/median)/beta).

    Attributes
    ----------
    median : float
        Median capacity, in the unit of IM.
    beta : float
        Standard deviation of the logarithm of the capacity.
    covariance : ndarray, shape (2, 2), or None
        Covariance of (ln median, beta), read-only: the jackknife over recordings, or for independent runs or
        records; None where it is not known.
    n : int
        Number of runs or records in the fit; 0 for a curve that was given.
    method : str
        Method of the fit.
    n_groups : int
        Number of recordings; 0 if the runs or records were taken as independent.
    damping : float or None
        Damping ratio of the spectral acceleration or displacement that IM is; None for other measures.
    without : ndarray, shape (n_groups, 2), or None
        Intercept and slope of ln(IM/median)/beta over ln IM without each recording, in the order of their names; None
        unless fitted with recordings.

    Raises
    ------
    InputError
        If the median or beta is not positive and finite, or the covariance is not a finite 2 by 2 matrix.

    Examples
    --------
    >>> import rockflex as rf
    >>> curve = rf.LognormalFragility(median=0.5, beta=0.4)
    >>> print(f"{curve.probability(0.3):.3g}, {curve.quantile(0.84):.3g}")
    0.101, 0.744
    """

    median: float
    beta: float
    covariance: Array | None = None
    n: int = 0
    method: str = "given"
    n_groups: int = 0
    damping: float | None = None
    without: Array | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        median = checked_positive("median", self.median, "the unit of IM")
        vars(self).update(median=median, beta=checked_positive("beta", self.beta, "natural logarithms"))
        if self.covariance is not None:
            matrix = checked_finite_matrix("covariance", self.covariance, "natural logarithms squared", (2, 2))
            matrix.setflags(write=False)
            vars(self).update(covariance=matrix)

    def probability(self, im: ArrayLike) -> Array:
        """Probability of failure, of the shape of `im`."""
        from scipy.special import ndtr

        return ndtr(self._score(im))

    def quantile(self, p: ArrayLike) -> Array:
        """Capacity that a fraction `p` stay below, of the shape of `p`."""
        from scipy.special import ndtri

        return self.median * np.exp(self.beta * ndtri(_arguments.checked_probabilities("p", p)))

    def band(self, im: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Lower and upper confidence limits of the probability: delta method on ln(IM/median)/beta, then Φ.

        Student's t with `n_groups` - 1 degrees of freedom; the normal distribution for independent runs.

        Raises
        ------
        InputError
            If the covariance is not known.
        """
        from scipy.special import ndtr

        z = self._score(im)
        gradient = np.stack((np.full_like(z, -1.0), -z)) / self.beta
        error = np.sqrt(np.einsum("i...,ij,j...->...", gradient, self._known_covariance, gradient))
        half = _jackknife.student_t_quantile(_arguments.checked_confidence(confidence), self.n_groups) * error
        return ndtr(z - half), ndtr(z + half)

    @property
    def _known_covariance(self) -> Array:
        if self.covariance is None:
            why = "which this curve was given without" if self.n_groups != 1 else f"but: {_jackknife.ONE_RECORDING}"
            raise InputError(f"A band needs the covariance of (ln median, beta), {why}.".replace("..", "."))
        return self.covariance

    def drawn(self, im: Array) -> Array:
        """Probabilities at `im`, shape (m,), for 2048 parameters drawn from the t distribution of the estimate."""
        from scipy.special import ndtr

        away = normal_score_derivatives(self.median, self.beta)
        score = -math.log(self.median) / self.beta, 1.0 / self.beta
        b = _jackknife.sampled_fit_parameters(score, away @ self._known_covariance @ away.T, self.n_groups)
        return ndtr(b[:, :1] + b[:, 1:] * np.log(im))

    def probability_without(self, im: Array) -> Array | None:
        """Probabilities at `im`, shape (m,), without each recording, shape (n_groups, m); None for independent runs."""
        from scipy.special import ndtr

        return None if self.without is None else ndtr(self.without[:, :1] + self.without[:, 1:] * np.log(im))

    def _score(self, im: ArrayLike) -> Array:
        with np.errstate(over="ignore"):  # a nearly zero dispersion makes a step
            return (_arguments.log_of_evaluation_points(im) - math.log(self.median)) / self.beta


def normal_score_derivatives(median: float, beta: float) -> Array:
    """Derivatives of intercept and slope of the normal score of log(IM) by (ln median, beta)."""
    return np.array([[-1.0 / beta, math.log(median) / beta**2], [0.0, -1.0 / beta**2]])


def lognormal_fit_covariance(replicates: Array, median: float, beta: float) -> Array | None:
    """Covariance of (ln median, beta) from intercepts and slopes without each recording; None if it is not known."""
    covariance = _jackknife.jackknife_covariance(replicates)
    if not np.isfinite(covariance).all():
        return None
    back = np.linalg.inv(normal_score_derivatives(median, beta))
    return back @ covariance @ back.T


def fit_capacities(
    im: ArrayLike, censored: ArrayLike | None = None, groups: ArrayLike | None = None, *, damping: float | None = None
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
    >>> fit = rf.fit_capacities([0.4, 0.6, 0.9, 1.0],
    ...     censored=[False, False, False, True])
    >>> print(f"{fit.median:.3g}, {fit.beta:.3g}")
    0.73, 0.458
    """
    x = _arguments.log_column("im", im, "Leave those records out.")
    above = np.zeros(x.size, dtype=np.bool_) if censored is None else _arguments.boolean_column("censored", censored)
    recordings = _jackknife.RecordingGroups.beside(groups, im=x, censored=above)
    known = x[~above]
    if known.size < 2 or np.ptp(known) == 0.0:
        raise InputError(
            f"im must hold at least two different capacities that were reached, but {np.unique(known).size} were given "
            f"besides {int(above.sum())} censored records. Scale the records further up."
        )
    if above.any():
        mean, beta = _censored_lognormal_fit(known, x[above])
        method = "censored capacities, maximum likelihood"
        covariance = _censored_lognormal_covariance(known, x[above], mean, beta)
    else:
        mean, beta, n = float(known.mean()), float(known.std(ddof=1)), known.size
        method, covariance = "capacities, moments", np.diag([beta**2 / n, beta**2 / (2.0 * (n - 1))])
    median, count, replicates = math.exp(mean), 0, None
    if recordings is not None:
        replicates = recordings.without_each(lambda some: _normal_score_lines(x, above, some, mean, beta))
        covariance, count = lognormal_fit_covariance(replicates, median, beta), recordings.n
    fit = LognormalFragility(median, beta, covariance, x.size, method, count, damping)
    return with_changed_fields(fit, without=replicates)


def _normal_score_lines(x: Array, above: Bools, weights: Array, mean: float, beta: float) -> Array:
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


def _censored_lognormal_fit(known: Array, above: Array) -> tuple[float, float]:
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


def _censored_lognormal_covariance(known: Array, above: Array, mean: float, beta: float) -> Array:
    """Inverse of the observed information of (mean, beta) of a normal sample with right-censored values."""
    from scipy.special import log_ndtr

    z, c = (known - mean) / beta, (above - mean) / beta
    hazard = np.exp(-0.5 * c**2 - 0.5 * math.log(2.0 * math.pi) - log_ndtr(-c))  # φ(c)/(1 - Φ(c))
    slope = hazard * (hazard - c)  # its derivative
    mean_mean = z.size + slope.sum()
    mean_beta = 2.0 * z.sum() + (hazard + c * slope).sum()
    beta_beta = (3.0 * z**2 - 1.0).sum() + (c**2 * slope + 2.0 * c * hazard).sum()
    return beta**2 * np.linalg.inv(np.array([[mean_mean, mean_beta], [mean_beta, beta_beta]]))


def fit_stripes(
    im_levels: ArrayLike,
    n_exceeding: ArrayLike,
    n_total: ArrayLike,
    groups: ArrayLike | None = None,
    *,
    damping: float | None = None,
) -> LognormalFragility:
    """Fit a lognormal fragility to stripes by maximum likelihood of the binomial counts.

    A generalised linear model with probit link on log IM (Baker 2015, Earthquake Spectra 31(1), 579-599). Stripes may
    have different records, and different numbers of them. Where they share recordings, their runs are not independent:
    for a band give single runs, or counts by recording, with their `groups`. Without them the covariance assumes
    independent runs, from the Fisher information by the delta method, and the band is too narrow.

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
    >>> fit = rf.fit_stripes([0.2, 0.4, 0.8], n_exceeding=[1, 4, 9],
    ...     n_total=[10, 10, 10])
    >>> print(f"{fit.median:.3g}, {fit.beta:.3g}")
    0.427, 0.539
    """
    x = _arguments.log_measures(im_levels, "im_levels")
    total, events = _checked_stripe_counts("n_total", n_total, 1), _checked_stripe_counts("n_exceeding", n_exceeding, 0)
    recordings = _jackknife.RecordingGroups.beside(groups, im_levels=x, n_exceeding=events, n_total=total)
    if (events > total).any():
        row = int(np.flatnonzero(events > total)[0])
        raise InputError(
            f"n_exceeding must be at most n_total, but stripe {row} has {events[row]:g} of {total[row]:g}. "
            "Give counts, not fractions, and check their order."
        )
    _check_stripe_overlap(x, events, total)

    from statsmodels.api import GLM, families
    from statsmodels.tools.sm_exceptions import PerfectSeparationWarning

    scaled = StandardisedLogs(x)
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
    median, beta, count, replicates = math.exp(-a / b), 1.0 / b, 0, None
    if recordings is None:
        back = np.array([[-1.0 / b, a / b**2], [0.0, -1.0 / b**2]])
        found = back @ covariance @ back.T
    else:
        kind, both = np.repeat((1.0, -1.0), x.size), np.tile(scaled.x, 2)
        runs = np.concatenate((events, total - events))
        twice, at = recordings._replace(codes=np.tile(recordings.codes, 2)), np.asarray(result.params)
        replicates = scaled.back(twice.without_each(lambda some: fit_capacity_lines(both, kind, some * runs, at)))
        found, count = lognormal_fit_covariance(replicates, median, beta), recordings.n
    method = "binomial counts, maximum likelihood"
    fit = LognormalFragility(median, beta, found, int(total.sum()), method, count, damping)
    return with_changed_fields(fit, without=replicates)


def _checked_stripe_counts(name: str, values: ArrayLike, least: int) -> Array:
    numbers = checked_finite_vector(name, values, "runs", booleans=True)  # of one run each
    bad = np.flatnonzero((numbers != np.rint(numbers)) | (numbers < least))
    if bad.size:
        raise InputError(
            f"{name} must hold whole numbers of at least {least}, but row {bad[0]} holds {numbers[bad[0]]:g}."
        )
    return numbers


def _check_stripe_overlap(x: Array, events: Array, total: Array) -> None:
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
