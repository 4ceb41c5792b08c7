"""Resamples of the groups of runs, and the total probability of `fit_outcomes` for all of them at once."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex.fragility._limit_states import OVERTURNED, ROCKED
from rockflex.fragility._outcomes import total_probability
from rockflex.fragility._predictor import Standardised
from rockflex.fragility._regression import Scoring, fit_curves, fit_lines

Integer = NDArray[np.int64]

SCORING = Scoring(1e-8)


def draws(n_groups: int, n: int, seed: int) -> Iterator[Integer]:
    """Numbers of the groups in each of `n` resamples, drawn with replacement."""
    generator = np.random.default_rng(seed)
    return (generator.integers(n_groups, size=n_groups) for _ in range(n))


def resample_weights(groups: Integer, n: int, seed: int) -> Array:
    """How often each run occurs in each resample of its groups, shape (n, n_runs), drawn as in `bootstrap_band`.

    Parameters
    ----------
    groups : ndarray, shape (n_runs,)
        Number of the group of every run, from 0 in the order in which the groups first appear.
    n, seed
        As in `bootstrap_band`.

    Examples
    --------
    >>> import numpy as np
    >>> from rockflex.fragility import resample_weights
    >>> weights = resample_weights(np.array([0, 0, 1]), n=20, seed=0)
    >>> weights.shape
    (20, 3)
    >>> bool((weights[:, 0] + weights[:, 2] == 2.0).all())
    True
    """
    count = int(groups.max()) + 1
    return np.array([np.bincount(drawn, minlength=count)[groups] for drawn in draws(count, n, seed)], dtype=np.float64)


def resampled_exceedance(
    im: Array, rotation: Array, overturned: Bools, weights: Array, at: Array, limit: float, threshold: float = ROCKED
) -> Array:
    """Probability of exceeding a limit at measures `at`, for each row of weights, shape (n, n_at).

    The same as `fit_outcomes` of each resample and its `exceedance`; P(OV) where the limit is π/2. NaN where a factor
    that matters cannot be fitted.

    Examples
    --------
    >>> import numpy as np
    >>> from rockflex.fragility import fit_outcomes, resampled_exceedance
    >>> im, overturned = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]), np.array([False] * 6 + [True])
    >>> rotation = np.array([0.0, 0.0, 0.01, 0.0, 0.02, 0.05, 1.6])
    >>> found = resampled_exceedance(im, rotation, overturned, np.ones((1, 7)), np.array([0.5]), 0.02)
    >>> print(f"{found[0, 0]:.3g}, {fit_outcomes(im, rotation, overturned).exceedance(0.5, 0.02):.3g}")
    0.759, 0.759
    """
    scaled = Standardised(np.log(im))
    nodes, moves = scaled.of(np.log(at)), rotation > threshold
    falls = _probability(scaled.x, overturned, weights, nodes)
    if limit >= OVERTURNED:
        return falls
    rocks = _probability(scaled.x, moves, weights * ~overturned, nodes)
    rocked = moves & ~overturned
    beyond = _beyond(np.log(im[rocked]), np.log(rotation[rocked]), weights[:, rocked], np.log(at), np.log(limit))
    return total_probability(falls, rocks, beyond)


def _probability(x: Array, outcome: Bools, weights: Array, nodes: Array) -> Array:
    """Logistic curve of each row at `nodes`; 0 or 1 where all outcomes are the same, NaN if all x are."""
    from scipy.special import expit

    held = weights > 0.0
    varied = np.where(held, x, -np.inf).max(axis=1) > np.where(held, x, np.inf).min(axis=1)
    yes, no = (held & outcome).any(axis=1), (held & ~outcome).any(axis=1)
    found = np.full((weights.shape[0], nodes.size), np.nan)
    found[~yes & no], found[yes & ~no] = 0.0, 1.0
    mixed = np.flatnonzero(yes & no & varied)
    if mixed.size:
        b = fit_curves(x, outcome, weights[mixed], SCORING).parameters
        found[mixed] = expit(b[:, :1] + b[:, 1:] * nodes)
    return found


def _beyond(x: Array, y: Array, weights: Array, at: Array, log_limit: float) -> Array:
    """P(θ_max > limit | rocking) of each row at `at`; NaN for fewer than three runs or two x or y."""
    from scipy.special import ndtr

    lines = fit_lines(x, y, weights)
    with np.errstate(all="ignore"):
        above = lines.intercept[:, None] + lines.slope[:, None] * at - log_limit
        found = ndtr(above / lines.dispersion[:, None])
    fitted = (lines.size >= 3.0) & (lines.sxx > 1e-12 * lines.size) & (lines.syy > 1e-12 * lines.size)
    found[~fitted] = np.nan
    return found
