"""The total probability of `fit_outcomes` for many resamples at once, each as weights of the runs."""

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Bool = NDArray[np.bool_]

NEWTON, SCORING, HALVINGS = 100, 1000, 20  # steps of each at most
LONGEST = 5.0  # step of scoring
ARRIVED = 1e-8  # of a run's share in the score


def resample_weights(groups: NDArray[np.int64], n: int, seed: int) -> Float:
    """How often each run is in each resample of its groups, shape (n, n_runs); the draws are those of `bootstrap_band`.

    Parameters
    ----------
    groups : ndarray, shape (n_runs,)
        Number of the group of every run, from 0 in the order in which the groups first appear.
    n, seed
        As in `bootstrap_band`.
    """
    count = int(groups.max()) + 1
    drawn = np.random.default_rng(seed).integers(count, size=(n, count))
    times = np.zeros((n, count))
    np.add.at(times, (np.arange(n)[:, None], drawn), 1.0)
    return times[:, groups]


def exceedances(
    im: Float, rotation: Float, fallen: Bool, weights: Float, nodes: Float, limit: float | None, threshold: float
) -> Float:
    """P(OV) + P(no OV) P(rocking | no OV) P(θ_max > limit | rocking) at the nodes, shape (n, n_nodes).

    `fit_outcomes` of each resample and its `exceedance`, by the same estimators; without a limit P(OV) alone. NaN where
    a factor that counts cannot be fitted.
    """
    x, moves = np.log(im), rotation > threshold
    at = np.log(nodes)
    falls = _curves(x, fallen, weights, at)
    if limit is None:
        return falls
    rocks = _curves(x, moves, weights * ~fallen, at)
    beyond = _beyond(x, rotation, weights * (moves & ~fallen), at, np.log(limit))
    rocked = np.where(falls == 1.0, 0.0, (1.0 - falls) * rocks)
    return falls + np.where(rocked == 0.0, 0.0, rocked * beyond)


def _curves(x: Float, outcome: Bool, weights: Float, at: Float) -> Float:
    """Logistic curves of each row of weights at `at`; 0 or 1 where all outcomes are alike, NaN without two measures."""
    from scipy.special import expit

    held = weights > 0.0
    low = np.where(held, x, np.inf).min(axis=1)
    varied = np.where(held, x, -np.inf).max(axis=1) > low
    yes, no = (held & outcome).any(axis=1), (held & ~outcome).any(axis=1)
    found = np.full((weights.shape[0], at.size), np.nan)
    found[~yes & no], found[yes & ~no] = 0.0, 1.0
    mixed = np.flatnonzero(yes & no & varied)
    if mixed.size:
        mean, spread = x.mean(), x.std()
        b = _logistic((x - mean) / spread, outcome, weights[mixed])
        found[mixed] = expit(b[:, :1] + b[:, 1:] * ((at - mean) / spread))
    return found


def _logistic(x: Float, outcome: Bool, weights: Float) -> Float:
    """Intercept and slope for each row: maximum likelihood, with Firth's penalty where the outcomes are separated."""
    b = np.full((weights.shape[0], 2), np.nan)
    held = weights > 0.0
    top_no, top_yes = (np.where(held & kind, x, -np.inf).max(axis=1) for kind in (~outcome, outcome))
    low_no, low_yes = (np.where(held & kind, x, np.inf).min(axis=1) for kind in (~outcome, outcome))
    separated = (top_no <= low_yes) | (top_yes <= low_no)
    free = np.flatnonzero(~separated)
    if free.size:
        b[free] = _newton(x, outcome, weights[free])
    rest = np.flatnonzero(np.isnan(b[:, 0]))
    if rest.size:
        b[rest] = _firth(x, outcome, weights[rest])
    return b


def _newton(x: Float, outcome: Bool, weights: Float) -> Float:
    """Maximum likelihood for each row; NaN where Newton's method does not arrive."""
    b, arrived = np.zeros((weights.shape[0], 2)), np.zeros(weights.shape[0], dtype=np.bool_)
    size = weights.sum(axis=1)
    with np.errstate(all="ignore"):
        for _ in range(NEWTON):
            score, step, _ = _step(x, outcome, weights, b, penalised=False)
            b += step
            arrived = np.abs(score).max(axis=1) <= ARRIVED * size
            if (arrived | ~np.isfinite(b).all(axis=1)).all():
                break
    return np.where(arrived[:, None] & np.isfinite(b), b, np.nan)


def _firth(x: Float, outcome: Bool, weights: Float) -> Float:
    """Penalised likelihood for each row (Firth 1993); NaN where scoring does not arrive."""
    b, arrived = np.zeros((weights.shape[0], 2)), np.zeros(weights.shape[0], dtype=np.bool_)
    size = weights.sum(axis=1)
    with np.errstate(all="ignore"):
        for _ in range(SCORING):
            score, step, likely = _step(x, outcome, weights, b, penalised=True)
            arrived = np.abs(score).max(axis=1) <= ARRIVED * size
            if arrived.all():
                break
            step *= np.minimum(1.0, LONGEST / np.abs(step).max(axis=1, keepdims=True))
            for _ in range(HALVINGS):
                worse = ~(_step(x, outcome, weights, b + step, penalised=True)[2] >= likely - 1e-12 * np.abs(likely))
                if not worse.any():
                    break
                step[worse] *= 0.5
            b += np.where(arrived[:, None], 0.0, step)
    return np.where(arrived[:, None], b, np.nan)


def _step(x: Float, outcome: Bool, weights: Float, b: Float, *, penalised: bool) -> tuple[Float, Float, Float]:
    """Score, Newton's step and log likelihood of each row."""
    from scipy.special import expit

    eta = b[:, :1] + b[:, 1:] * x
    p = expit(eta)
    q = p * (1.0 - p)
    one, first, second = (weights * q).sum(axis=1), (weights * q) @ x, (weights * q) @ x**2
    determinant = one * second - first**2
    residual = weights * (outcome - p)
    likely = (weights * np.where(outcome, -np.logaddexp(0.0, -eta), -np.logaddexp(0.0, eta))).sum(axis=1)
    if penalised:
        leverage = q * (second[:, None] - 2.0 * first[:, None] * x + one[:, None] * x**2) / determinant[:, None]
        residual = residual + weights * leverage * (0.5 - p)
        likely = likely + 0.5 * np.log(determinant)
    score = np.column_stack((residual.sum(axis=1), residual @ x))
    step = np.column_stack((second * score[:, 0] - first * score[:, 1], one * score[:, 1] - first * score[:, 0]))
    return score, step / determinant[:, None], likely


def _beyond(x: Float, rotation: Float, weights: Float, at: Float, log_limit: float) -> Float:
    """P(θ_max > limit) at `at` by least squares of each row; NaN of fewer than three runs, or of runs all alike."""
    from scipy.special import ndtr

    rocked = weights.any(axis=0)
    x, y, weights = x[rocked], np.log(rotation[rocked]), weights[:, rocked]
    size = weights.sum(axis=1)
    with np.errstate(all="ignore"):
        mean_x, mean_y = (weights @ x) / size, (weights @ y) / size
        dx, dy = x - mean_x[:, None], y - mean_y[:, None]
        sxx, sxy, syy = ((weights * one * other).sum(axis=1) for one, other in ((dx, dx), (dx, dy), (dy, dy)))
        slope = sxy / sxx
        scatter = np.sqrt((weights * (dy - slope[:, None] * dx) ** 2).sum(axis=1) / (size - 2.0))
        line = mean_y[:, None] + slope[:, None] * (at - mean_x[:, None])
        found = ndtr((line - log_limit) / scatter[:, None])
    alike = ~((size >= 3.0) & (sxx > 1e-12 * size) & (syy > 1e-12 * size))
    found[alike] = np.nan
    return found
