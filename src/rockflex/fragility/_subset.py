"""Subset simulation: the probability of a rare event, as a product of probabilities that are not rare."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, SupportsIndex

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite, checked_in_range, checked_whole_number
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value

MAX_SAMPLES, MAX_VARIABLES = 1_000_000, 1_000_000
ACCEPTED = 0.44  # share of steps to be accepted, for which chains move fastest


@dataclass(frozen=True, eq=False, kw_only=True)
class SubsetEstimate(Value):
    """The probability of a rare event, and how sure it is.

    Attributes
    ----------
    probability : float
        Probability that the demand exceeds the threshold.
    variation : float
        Its coefficient of variation, with the correlation along the chains, but not that between levels.
    levels : ndarray, shape (m,)
        Thresholds of the levels, of which the last one is that asked for.
    shares : ndarray, shape (m,)
        Probability of each given the one before; their product is `probability`.
    n_runs : int
        Number of demands that were computed.

    Examples
    --------
    >>> import rockflex as rf
    >>> found = rf.subset_simulation(
    ...     lambda u: u.sum(axis=1) / 2.0, 4, 4.0, seed=1)
    >>> found.levels.size, found.n_runs
    (5, 4600)
    """

    probability: float
    variation: float
    levels: Array
    shares: Array
    n_runs: int

    def __repr__(self) -> str:
        return (
            f"SubsetEstimate({self.probability:.3g}, coefficient of variation {self.variation:.2g}, {self.n_runs} runs)"
        )


def subset_simulation(
    demand: Callable[[Array], Any],
    n_variables: SupportsIndex,
    threshold: float,
    *,
    n: SupportsIndex = 1000,
    share: float = 0.1,
    seed: SupportsIndex = 0,
    max_levels: SupportsIndex = 20,
) -> SubsetEstimate:
    """Estimate the probability that a demand exceeds a threshold, also if it is as small as 1e-6.

    Plain sampling needs some 100 / P runs. Here each level asks for the demand that a tenth of the samples of the level
    before exceeds, and chains that start from those fill the next level (Au & Beck 2001, Probabilistic Engineering
    Mechanics 16(4)), with conditional samples whose step adapts itself (Papaioannou et al. 2015, the same, 41).

    Parameters
    ----------
    demand
        A function of independent standard normal variables, shape (k, n_variables), that returns k demands: it makes
        records and structures of them, ``1.2 * np.exp(0.3 * u[:, 0])``, and runs these.
    n_variables
        Number of variables.
    threshold
        The demand whose exceedance is rare.
    n
        Samples of each level.
    share
        Conditional probability of each level; its inverse must be whole and divide `n`.
    seed
        Of the random numbers.
    max_levels
        After so many levels it is given up.

    Returns
    -------
    SubsetEstimate
        The probability with its coefficient of variation.

    Raises
    ------
    InputError
        If an argument is out of range, or `demand` does not return k numbers.
    SolverError
        If the threshold is not reached, as when no demand can exceed it.

    Examples
    --------
    >>> import math
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> pulse = rf.one_sine_pulse(amplitude=1.0, period=0.8)
    >>> def rotations(u):
    ...     runs = rf.simulate_many(block, pulse, "rigid",
    ...         scales=[1.5 * math.exp(0.4 * x) for x in u[:, 0]], workers=1)
    ...     return runs["max_rotation"].to_numpy()
    >>> found = rf.subset_simulation(rotations, 1, 0.05, n=200)
    >>> 1e-4 < found.probability < 1e-2
    True
    """
    count = checked_whole_number("n", n, 10, MAX_SAMPLES)
    size = checked_whole_number("n_variables", n_variables, 1, MAX_VARIABLES)
    most = checked_whole_number("max_levels", max_levels, 1, 1000)
    length = round(1.0 / checked_in_range("share", share, 0.0, 0.5))
    limit = checked_finite("threshold", threshold, "the unit of the demand")
    if abs(length * share - 1.0) > 1e-9 or count % length:
        raise InputError(
            f"share must be 1 over a whole number that divides n, such as 0.1 with n = 1000, but {shown(share)} and "
            f"n = {count} were given.",
            field="share",
        )
    rng = np.random.default_rng(checked_whole_number("seed", seed, 0))
    u = rng.normal(size=(count, size))
    g, n_runs = _demands(demand, u), count
    chains, levels, shares, squares, step = np.arange(count)[:, None], list[float](), list[float](), 0.0, 0.6
    for _ in range(most):
        seeds = np.argsort(-g, kind="stable")[: count // length]
        level = min(limit, 0.5 * (float(g[seeds[-1]]) + float(np.sort(g)[-count // length - 1])))
        above = g > level
        part = float(above.mean())
        if not 0.0 < part < 1.0:
            break
        levels.append(level)
        shares.append(part)
        squares += (1.0 - part) / (part * count) * (1.0 + _correlation(above[chains], part))
        if level >= limit:
            return SubsetEstimate(
                probability=math.prod(shares),
                variation=math.sqrt(squares),
                levels=np.array(levels),
                shares=np.array(shares),
                n_runs=n_runs,
            )
        seeds = np.resize(rng.permutation(np.flatnonzero(above)), count // length)  # fewer where chains stood still
        at, held = u[seeds], g[seeds]
        made, found = [at], [held]
        for k in range(1, length):
            part_of_noise = min(step, 1.0)
            moved = math.sqrt(1.0 - part_of_noise**2) * at + part_of_noise * rng.normal(size=at.shape)
            values = _demands(demand, moved)
            taken = values > level
            at, held = np.where(taken[:, None], moved, at), np.where(taken, values, held)
            made.append(at)
            found.append(held)
            n_runs += len(values)
            step *= math.exp((float(taken.mean()) - ACCEPTED) / math.sqrt(k))
        u, g = np.concatenate(made), np.concatenate(found)
        chains = np.arange(count).reshape(length, -1).T
    raise SolverError(
        f"The threshold {limit:g} was not reached in {len(levels)} levels; the largest demand was {float(g.max()):g}. "
        "Lower it, or look whether the demand can exceed it at all."
    )


def _demands(demand: Callable[[Array], Any], u: Array) -> Array:
    """The demands of some samples, checked."""
    found = np.asarray(demand(u.copy()), dtype=float)
    if found.shape != (len(u),) or np.isnan(found).any():
        raise InputError(
            f"demand must return {len(u)} numbers for {len(u)} samples, but it returned {shown(found)}.", field="demand"
        )
    return found


def _correlation(above: Any, part: float) -> float:
    """Twice the sum of the correlations along chains, shape (chains, length), with their weights (Au & Beck 2001)."""
    length, values = above.shape[1], above - part
    variance = part * (1.0 - part)
    lags = [float((values[:, k:] * values[:, : length - k]).mean()) / variance for k in range(1, length)]
    return max(2.0 * sum((1.0 - k / length) * lag for k, lag in enumerate(lags, 1)), 0.0)
