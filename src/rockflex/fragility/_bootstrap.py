"""Confidence bands from resampled runs or records."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._arrays import Array
from rockflex._checks import finite_vector, float_array, whole_number
from rockflex._errors import InputError, SolverError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.fragility._arguments import checked_confidence, same_length
from rockflex.fragility._resamples import draws

MOST = 1_000_000  # resamples
NEEDED = 20  # fewest fitted resamples for meaningful quantiles
MANY = 40  # blocks from which on percentiles are taken as they are


@dataclass(frozen=True, eq=False)
class BootstrapBand(Value):
    """A percentile band of a curve over resamples. The arrays are read-only.

    Attributes
    ----------
    at, estimate, low, high : ndarray, shape (m,)
        Measures at which the curve was evaluated, the curve of the original data, and the limits of the band.
    confidence : float
        Confidence of the band.
    n : int
        Number of resamples requested.
    n_failed : int
        Resamples that could not be fitted, such as those without a single event; the band excludes them.
    n_separated : int
        Resamples with separated outcomes, which were fitted with Firth's penalty.
    n_groups : int
        Number of blocks resampled: the groups, or the runs if no groups were given.
    note : str
        Warnings about the band; empty if there are none.

    Examples
    --------
    >>> import rockflex as rf
    >>> im, response = [0.2, 0.4, 0.6, 0.8], [0.004, 0.011, 0.016, 0.026]
    >>> band = rf.bootstrap_band(rf.fit_cloud, im, response, at=[0.5], n=200)
    >>> bool(band.low[0] < band.estimate[0] < band.high[0])
    True
    >>> band.confidence, band.n_groups
    (0.9, 4)
    """

    at: Array
    estimate: Array
    low: Array
    high: Array
    confidence: float
    n: int
    n_failed: int
    n_separated: int
    n_groups: int
    note: str


def bootstrap_band(
    fit_function: Callable[[Any, Any], Any],
    im: ArrayLike,
    outcome_or_response: ArrayLike,
    groups: ArrayLike | None = None,
    *,
    at: ArrayLike,
    confidence: float = 0.9,
    n: SupportsIndex = 1000,
    seed: int = 0,
    curve: Callable[[Any, Array], Any] | None = None,
) -> BootstrapBand:
    """Percentile band of any statistic from resamples of the runs, or of the records that they share.

    The fits have bands of their own, which hold the truth as often as they say: prefer those, and `annual_rate` for
    rates. Percentiles of skewed curves do not: with 22 recordings, 90 % bands of logistic ones held it in 77 to 85 %.
    With `groups`, whole groups are drawn. The components and scale factors of one record are not independent, and a
    band that treats them as independent is too narrow (Davison & Hinkley 1997, Bootstrap Methods and their Application,
    Section 3.8). The percentiles are those that widen the band by Student's t and √(m/(m - 1)) for m blocks (Hesterberg
    2015, Am. Stat. 69(4), 371-386).

    Parameters
    ----------
    fit_function
        `fit_logistic`, `fit_cloud`, `fit_capacities`, or any function of the two columns.
    im : array_like, shape (k,)
        First column.
    outcome_or_response : array_like, shape (k,) or (k, ...)
        Second column; a table of several is resampled by rows.
    groups : array_like, shape (k,), optional
        Name or number of the record of every run, the same for both components.
    at : array_like, shape (m,)
        Measures at which the curve is evaluated.
    confidence
        Confidence of the band, in [0, 1).
    n
        Number of resamples, at least 20.
    seed
        Seed of NumPy's default generator; the same seed gives the same band.
    curve
        Function of a fit and `at`; by default the fit's `probability`, or its `median` where it has none.

    Raises
    ------
    InputError
        If the columns differ in length, an argument is out of range, the data as given cannot be fitted, or fewer than
        20 resamples can.

    Examples
    --------
    >>> import rockflex as rf
    >>> im, response = [0.2, 0.4, 0.6, 0.8], [0.004, 0.011, 0.016, 0.026]
    >>> band = rf.bootstrap_band(rf.fit_cloud, im, response, at=[0.5], n=200, seed=1)
    >>> print(f"{band.estimate[0]:.3g} from {band.low[0]:.3g} to {band.high[0]:.3g}")
    0.0137 from 0.0118 to 0.0152
    """
    measures, grid = finite_vector("im", im, "one unit"), finite_vector("at", at, "one unit")
    values = _column("outcome_or_response", outcome_or_response)
    labels = np.arange(measures.size) if groups is None else _column("groups", groups)
    same_length(im=measures, outcome_or_response=values, groups=labels)
    wanted, times = checked_confidence(confidence), whole_number("n", n, NEEDED, MOST)
    evaluate = _curve if curve is None else curve
    for name, function in (("fit_function", fit_function), ("curve", evaluate)):
        if not callable(function):
            raise InputError(f"{name} must be a function, but {type(function).__name__} was given.")
    estimate = float_array(evaluate(fit_function(measures, values), grid))
    if estimate is None:
        raise InputError("curve must return numbers, one for each of `at`, but it returned something else.")

    blocks = _blocks(labels)
    curves: list[Array] = []
    failures: list[str] = []
    separated = 0
    for drawn in draws(len(blocks), times, whole_number("seed", seed, 0)):
        rows = np.concatenate([blocks[i] for i in drawn])
        try:
            fit = fit_function(measures[rows], values[rows])
            found = np.asarray(evaluate(fit, grid), dtype=np.float64)
        except (InputError, SolverError) as error:
            failures.append(str(error))
            continue
        if not np.isfinite(found).all():
            failures.append("The curve is not finite everywhere.")
            continue
        curves.append(found)
        separated += bool(getattr(fit, "separated", False))
    if len(curves) < NEEDED:
        raise InputError(
            f"Only {len(curves)} of {times} resamples could be fitted, {NEEDED} are needed. The first failure: "
            f"{failures[0]}"
        )
    low, high = np.quantile(curves, _shares(wanted, len(blocks)), axis=0)
    note = _note(times, failures, separated, len(blocks))
    return BootstrapBand(grid, estimate, low, high, wanted, times, len(failures), separated, len(blocks), note)


def _shares(confidence: float, n_blocks: int) -> tuple[float, float]:
    """Shares of the resamples below the limits of a band, so that few blocks do not make it too narrow."""
    from scipy.special import ndtr, stdtrit

    half = stdtrit(n_blocks - 1, 0.5 + 0.5 * confidence) * np.sqrt(n_blocks / (n_blocks - 1.0))
    return float(ndtr(-half)), float(ndtr(half))


def _curve(fit: Any, grid: Array) -> Any:
    return fit.probability(grid) if hasattr(fit, "probability") else fit.median(grid)


def _column(name: str, values: ArrayLike) -> NDArray[Any]:
    try:
        column = np.asarray(values)
    except ValueError:
        column = np.zeros(())
    if column.ndim == 0 or (name == "groups" and column.ndim != 1):
        raise InputError(f"{name} must hold a value for every run, but {shown(values)} was given.")
    return column


def _blocks(labels: NDArray[Any]) -> list[NDArray[np.int64]]:
    """Rows of every group, in the order in which the groups first appear."""
    import pandas as pd

    try:
        codes, names = pd.factorize(labels, use_na_sentinel=True)
    except TypeError as error:
        raise InputError(f"groups must hold names or numbers, but {shown(labels)} was given.") from error
    if (codes < 0).any():
        raise InputError(f"groups must name the record of every run, but {int((codes < 0).sum())} names are missing.")
    if len(names) < 2:
        raise InputError(f"groups must hold at least two groups, but all {labels.size} runs belong to {len(names)}.")
    return np.split(np.argsort(codes, kind="stable"), np.cumsum(np.bincount(codes))[:-1])


def _note(n: int, failures: list[str], separated: int, groups: int) -> str:
    notes: list[str] = []
    if failures:
        notes.append(
            f"{len(failures)} of {n} resamples could not be fitted and are left out, so the band is too narrow. "
            f"The first failure: {failures[0]}"
        )
    if separated:
        notes.append(f"{separated} of {n} resamples were separated and fitted with Firth's penalty.")
    if groups < MANY:
        notes.append(f"Percentile bands from {groups} blocks may be too narrow; take them as a lower bound.")
    return " ".join(notes)
