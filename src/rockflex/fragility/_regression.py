"""Regressions on x = log(IM) for many resamples at once, and the scaling that keeps solvers well conditioned.

Each row of `weights`, shape (m, n), says how often each of the n runs counts in one of the m fits. A single fit is the
row of unit weights.
"""

from typing import NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array, Bools

MAX_NEWTON_STEPS, MAX_SCORING_STEPS, MAX_HALVINGS = 100, 1000, 20  # largest numbers of iterations
NEWTON_TOLERANCE = 1e-8  # of the parameters, at which Newton's method has converged
RIDGE = 1e-10  # added to the information, for each run; where the likelihood is flat, Newton then converges too slowly
MAX_SCORING_STEP = 5.0  # step of Fisher scoring


class LogisticCurves(NamedTuple):
    """Logistic curves through standardised x."""

    parameters: Array  # (m, 2): intercept and slope; NaN where no fit converged
    separated: Bools  # (m,): whether one x separates the outcomes, so that maximum likelihood has no finite slope
    penalised: Bools  # (m,): whether Firth's penalty was used: separated, or Newton's method did not converge


class FirthScoringOptions(NamedTuple):
    """Steps of the penalised fit, and when it has converged.

    Every choice leads to the same maximum. Each caller has its own, so that the digits of its results stay the same.
    """

    score: float  # largest component of the penalised score, over the number of runs
    step: float = np.inf  # largest component of the next step
    augmented: bool = False  # whether a run with leverage h counts 1 + h times in the information that sets the step


def fit_logistic_curves(x: Array, outcome: Bools, weights: Array, scoring: FirthScoringOptions) -> LogisticCurves:
    """Fit logistic curves by maximum likelihood, or with Firth's penalty where that has no finite slope.

    x, shape (n,), has mean 0 and standard deviation 1; both outcomes must occur in each fit. Firth 1993, Biometrika
    80(1), 27-38; Heinze & Schemper 2002, Stat. Med. 21(16), 2409-2419.
    """
    separated = are_outcomes_separated(x, outcome, weights)
    parameters = np.full((weights.shape[0], 2), np.nan)
    parameters[~separated] = _newton_logistic_fit(x, outcome, weights[~separated])
    penalised = np.isnan(parameters[:, 0])
    parameters[penalised] = _firth_logistic_fit(x, outcome, weights[penalised], scoring)
    return LogisticCurves(parameters, separated, penalised)


def are_outcomes_separated(x: Array, outcome: Bools, weights: Array) -> Bools:
    """Whether some value of x separates the outcomes of each row; runs at that value may have either."""
    (low_no, high_no), (low_yes, high_yes) = (
        (np.where(held, x, np.inf).min(axis=1), np.where(held, x, -np.inf).max(axis=1))
        for held in ((weights > 0.0) & ~outcome, (weights > 0.0) & outcome)
    )
    return (high_no <= low_yes) | (high_yes <= low_no)


def fisher_information(x: Array, weights: Array, parameters: Array) -> Array:
    """Fisher information of the parameters without the penalty, shape (m, 2, 2)."""
    one, first, second = _LogisticPoint(x, weights, parameters).moments
    return np.moveaxis(np.array([[one, first], [first, second]]), -1, 0)


def fit_capacity_lines(x: Array, kind: Array, weights: Array, start: Array) -> Array:
    """Fit a + b x, the normal score of log(IM)/capacity, to capacities of which some are bounds, by maximum likelihood.

    `kind`, shape (n,), is 0 where the capacity is x, 1 where it is smaller (the run exceeds the limit), -1 where it is
    larger; `start` has a and b near all solutions, such as the fit of all runs. Returns a and b, shape (m, 2); where
    the likelihood has no maximum nearby, one step of Newton's method from `start`.
    """
    from scipy.special import log_ndtr

    known = kind == 0.0
    b = np.tile(start, (weights.shape[0], 1))
    first, converged = b, np.zeros(weights.shape[0], dtype=np.bool_)
    with np.errstate(all="ignore"):
        for number in range(MAX_NEWTON_STEPS):
            z = b[:, :1] + b[:, 1:] * x
            side = np.where(known, 1.0, kind)
            ratio = np.exp(-0.5 * z**2 - 0.5 * np.log(2.0 * np.pi) - log_ndtr(side * z))  # φ/Φ
            slope = np.where(known, -z, side * ratio)
            bend = weights * np.where(known, 1.0, ratio * (ratio + side * z))
            n_known, (one, cross, second) = weights @ known.astype(float), _weighted_moments(x, bend)
            _, step = _newton_step(x, weights * slope, (one, cross, second + n_known / b[:, 1] ** 2), n_known / b[:, 1])
            b = b + step
            first = b if number == 0 else first
            converged = np.abs(step).max(axis=1) <= NEWTON_TOLERANCE * np.abs(start).max()
            if (converged | ~np.isfinite(b).all(axis=1)).all():
                break
    return np.where(converged[:, None] & np.isfinite(b), b, first)


class LeastSquaresLines(NamedTuple):
    """Least-squares lines y = intercept + slope x, each field of shape (m,).

    `sxx` and `syy` are the weighted sums of squares about the means, `residual` that about the line, `size` the sums
    of the weights.
    """

    intercept: Array
    slope: Array
    mean: Array
    size: Array
    sxx: Array
    syy: Array
    residual: Array

    @property
    def dispersion(self) -> Array:
        """Standard deviation of the residuals, with size - 2 degrees of freedom."""
        return np.sqrt(self.residual / (self.size - 2.0))


def fit_least_squares_lines(x: Array, y: Array, weights: Array) -> LeastSquaresLines:
    """Fit a line to each row of weights; infinite or NaN where fewer than two different x are left."""
    size = weights.sum(axis=1)
    with np.errstate(all="ignore"):
        mean_x, mean_y = (weights @ x) / size, (weights @ y) / size
        dx, dy = x - mean_x[:, None], y - mean_y[:, None]
        sxx, sxy, syy = ((weights * one * other).sum(axis=1) for one, other in ((dx, dx), (dx, dy), (dy, dy)))
        slope = sxy / sxx
        residual = (weights * (dy - slope[:, None] * dx) ** 2).sum(axis=1)
        return LeastSquaresLines(mean_y - slope * mean_x, slope, mean_x, size, sxx, syy, residual)


class _LogisticPoint:
    """Logistic curves at some parameters: eta, p, and the entries of the Fisher information."""

    def __init__(self, x: Array, weights: Array, parameters: Array) -> None:
        from scipy.special import expit

        self.eta = parameters[:, :1] + parameters[:, 1:] * x
        self.p = expit(self.eta)
        self.each = weights * self.p * (1.0 - self.p)
        self.moments = _weighted_moments(x, self.each)


def _weighted_moments(x: Array, each: Array) -> tuple[Array, Array, Array]:
    return each.sum(axis=1), each @ x, each @ x**2


def _moment_determinant(one: Array, first: Array, second: Array) -> Array:
    return one * second - first**2


def _newton_step(
    x: Array, residual: Array, moments: tuple[Array, Array, Array], more: Array | float = 0.0
) -> tuple[Array, Array]:
    """Score of the residuals, with `more` added to the component of the slope, and the step of the parameters."""
    one, first, second = moments
    a, b = residual.sum(axis=1), residual @ x + more
    step = np.column_stack((second * a - first * b, one * b - first * a))
    return np.column_stack((a, b)), step / _moment_determinant(*moments)[:, None]


def _newton_logistic_fit(x: Array, outcome: Bools, weights: Array) -> Array:
    """Maximum likelihood of each row; NaN where Newton's method does not converge."""
    b, converged = np.zeros((weights.shape[0], 2)), np.zeros(weights.shape[0], dtype=np.bool_)
    ridge = RIDGE * weights.sum(axis=1)
    with np.errstate(all="ignore"):
        for _ in range(MAX_NEWTON_STEPS):
            at = _LogisticPoint(x, weights, b)
            one, first, second = at.moments
            _, step = _newton_step(x, weights * (outcome - at.p), (one + ridge, first, second + ridge))
            b += step
            converged = np.abs(step).max(axis=1) <= NEWTON_TOLERANCE
            if (converged | ~np.isfinite(b).all(axis=1)).all():
                break
    return np.where(converged[:, None] & np.isfinite(b), b, np.nan)


def _firth_logistic_fit(x: Array, outcome: Bools, weights: Array, scoring: FirthScoringOptions) -> Array:
    """Maximum of the penalised likelihood of each row; NaN where Fisher scoring does not converge."""
    b, converged = np.zeros((weights.shape[0], 2)), np.zeros(weights.shape[0], dtype=np.bool_)
    bound = scoring.score * weights.sum(axis=1)
    with np.errstate(all="ignore"):
        for _ in range(MAX_SCORING_STEPS):
            at = _LogisticPoint(x, weights, b)
            one, first, second = (moment[:, None] for moment in at.moments)
            leverage = at.each * (second - 2.0 * first * x + one * x**2) / _moment_determinant(*at.moments)[:, None]
            residual = weights * (outcome - at.p) + leverage * (0.5 - at.p)
            moments = (
                _weighted_moments(x, at.each + leverage * at.p * (1.0 - at.p)) if scoring.augmented else at.moments
            )
            score, step = _newton_step(x, residual, moments)
            length = np.abs(step).max(axis=1)
            converged = (np.abs(score).max(axis=1) <= bound) & (length <= scoring.step)
            if converged.all():
                break
            step *= np.minimum(1.0, MAX_SCORING_STEP / length)[:, None]
            likely = _firth_penalised_likelihood(outcome, weights, at)
            for _ in range(MAX_HALVINGS):
                further = _firth_penalised_likelihood(outcome, weights, _LogisticPoint(x, weights, b + step))
                worse = ~(further >= likely - 1e-12 * np.abs(likely))
                if not worse.any():
                    break
                step[worse] *= 0.5
            b += np.where(converged[:, None], 0.0, step)
    return np.where(converged[:, None], b, np.nan)


def _firth_penalised_likelihood(outcome: Bools, weights: Array, at: _LogisticPoint) -> Array:
    likely = np.where(outcome, -np.logaddexp(0.0, -at.eta), -np.logaddexp(0.0, at.eta))
    return (weights * likely).sum(axis=1) + 0.5 * np.log(_moment_determinant(*at.moments))


class StandardisedLogs:
    """Logarithms scaled to mean 0 and standard deviation 1, and back."""

    def __init__(self, x: Array) -> None:
        self._mean, self._spread = mean, spread = float(x.mean()), float(x.std())
        self.x = self.of(x)
        self.design = np.column_stack((np.ones(x.size), self.x))
        self._back = np.array([[1.0, -mean / spread], [0.0, 1.0 / spread]])

    def of(self, x: Array) -> Array:
        """Other logarithms on the same scale."""
        return (x - self._mean) / self._spread

    def back(self, parameters: Array) -> Array:
        """Intercepts and slopes for the original logarithms, shape (m, 2)."""
        return parameters @ self._back.T

    def unscaled(self, parameters: Array, covariance: Array) -> tuple[float, float, Array]:
        """Intercept, slope and covariance for the original logarithms."""
        a, b = self._back @ parameters
        return float(a), float(b), self._back @ covariance @ self._back.T
