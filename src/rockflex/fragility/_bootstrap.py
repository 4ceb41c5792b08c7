"""Confidence bands from resampled runs or records."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_finite_vector, checked_whole_number, float_array
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.fragility import _regression
from rockflex.fragility._arguments import check_same_column_length, checked_confidence
from rockflex.fragility._jackknife import RecordingGroups
from rockflex.fragility._limit_states import OVERTURNED, ROCKED
from rockflex.fragility._outcomes import total_exceedance_probability

MAX_RESAMPLES = 1_000_000  # resamples
MIN_RESAMPLES = 20  # fewest fitted resamples for meaningful quantiles
MIN_GROUPS = 40  # blocks from which on percentiles are taken as they are
Integers = NDArray[np.int64]
RESAMPLE_SCORING = _regression.FirthScoringOptions(1e-8)


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
        Resamples that could not be fitted, such as resamples without a single event; the band excludes them.
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

    The fits have bands of their own, which hold the truth as often as they say: prefer them, and `annual_rate` for
    rates. Percentiles of skewed curves do not: with 22 recordings, 90 % bands of logistic ones held it in 77 to 85 %.
    With `groups`, whole groups are drawn. The components and scale factors of one record are not independent, and a
    band that treats them as independent is too narrow (Davison & Hinkley 1997, Bootstrap Methods and their Application,
    Section 3.8). The percentiles widen the band by Student's t and √(m/(m - 1)) for m blocks (Hesterberg
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
    >>> band = rf.bootstrap_band(rf.fit_cloud, im, response, at=[0.5], n=200,
    ...     seed=1)
    >>> ends = f"{band.low[0]:.3g} to {band.high[0]:.3g}"
    >>> print(f"{band.estimate[0]:.3g} from {ends}")
    0.0137 from 0.0118 to 0.0152
    """
    measures, grid = checked_finite_vector("im", im, "one unit"), checked_finite_vector("at", at, "one unit")
    values = _checked_resampled_rows("outcome_or_response", outcome_or_response)
    recordings = RecordingGroups.of(np.arange(measures.size) if groups is None else groups)
    check_same_column_length(im=measures, outcome_or_response=values, groups=recordings.codes)
    wanted, times = checked_confidence(confidence), checked_whole_number("n", n, MIN_RESAMPLES, MAX_RESAMPLES)
    evaluate = _fitted_curve_at if curve is None else curve
    for name, function in (("fit_function", fit_function), ("curve", evaluate)):
        if not callable(function):
            raise InputError(f"{name} must be a function, but {type(function).__name__} was given.")
    estimate = float_array(evaluate(fit_function(measures, values), grid))
    if estimate is None:
        raise InputError("curve must return numbers, one for each of `at`, but it returned something else.")

    blocks = _rows_by_recording(recordings)
    curves: list[Array] = []
    failures: list[str] = []
    separated = 0
    for drawn in draw_recording_groups(len(blocks), times, checked_whole_number("seed", seed, 0)):
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
    if len(curves) < MIN_RESAMPLES:
        raise InputError(
            f"Only {len(curves)} of {times} resamples could be fitted, {MIN_RESAMPLES} are needed. The first failure: "
            f"{failures[0]}"
        )
    low, high = np.quantile(curves, _band_percentiles(wanted, len(blocks)), axis=0)
    note = _bootstrap_note(times, failures, separated, len(blocks))
    return BootstrapBand(grid, estimate, low, high, wanted, times, len(failures), separated, len(blocks), note)


def _band_percentiles(confidence: float, n_blocks: int) -> tuple[float, float]:
    """Shares of the resamples below the limits of a band, so that few blocks do not make it too narrow."""
    from scipy.special import ndtr, stdtrit

    half = stdtrit(n_blocks - 1, 0.5 + 0.5 * confidence) * np.sqrt(n_blocks / (n_blocks - 1.0))
    return float(ndtr(-half)), float(ndtr(half))


def _fitted_curve_at(fit: Any, grid: Array) -> Any:
    return fit.probability(grid) if hasattr(fit, "probability") else fit.median(grid)


def _checked_resampled_rows(name: str, values: ArrayLike) -> NDArray[Any]:
    try:
        rows = np.asarray(values)
    except ValueError:
        rows = np.zeros(())
    if rows.ndim == 0:
        raise InputError(f"{name} must hold a value for every run, but {shown(values)} was given.", field=name)
    return rows


def _rows_by_recording(recordings: RecordingGroups) -> list[NDArray[np.int64]]:
    """Rows of every group, in the order in which the groups first appear."""
    codes, n_groups = recordings.codes, recordings.n
    if n_groups < 2:
        raise InputError(
            f"groups must hold at least two groups, but all {codes.size} runs belong to {n_groups}.", field="groups"
        )
    return np.split(np.argsort(codes, kind="stable"), np.cumsum(np.bincount(codes))[:-1])


def _bootstrap_note(n: int, failures: list[str], separated: int, groups: int) -> str:
    notes: list[str] = []
    if failures:
        notes.append(
            f"{len(failures)} of {n} resamples could not be fitted and are left out, so the band is too narrow. "
            f"The first failure: {failures[0]}"
        )
    if separated:
        notes.append(f"{separated} of {n} resamples were separated and fitted with Firth's penalty.")
    if groups < MIN_GROUPS:
        notes.append(f"Percentile bands from {groups} blocks may be too narrow; take them as a lower bound.")
    return " ".join(notes)


def draw_recording_groups(n_groups: int, n: int, seed: int) -> Iterator[Integers]:
    """Numbers of the groups in each of `n` resamples, drawn with replacement."""
    generator = np.random.default_rng(seed)
    return (generator.integers(n_groups, size=n_groups) for _ in range(n))


def bootstrap_weights(groups: Integers, n: int, seed: int) -> Array:
    """How often each run occurs in each resample of its groups, shape (n, n_runs), drawn as in `bootstrap_band`.

    `groups` numbers the group of every run, from 0 in the order in which the groups first appear.
    """
    count = int(groups.max()) + 1
    return np.array(
        [np.bincount(drawn, minlength=count)[groups] for drawn in draw_recording_groups(count, n, seed)],
        dtype=np.float64,
    )


def resampled_exceedance(
    im: Array, rotation: Array, overturned: Bools, weights: Array, at: Array, limit: float, threshold: float = ROCKED
) -> Array:
    """Probability of exceeding a limit at measures `at`, for each row of weights, shape (n, n_at).

    The same as `fit_outcomes` of each resample and its `exceedance`; P(OV) where the limit is π/2. NaN where a factor
    that matters cannot be fitted.
    """
    scaled = _regression.StandardisedLogs(np.log(im))
    nodes, moves = scaled.of(np.log(at)), rotation > threshold
    falls = _resampled_outcome_curves(scaled.x, overturned, weights, nodes)
    if limit >= OVERTURNED:
        return falls
    rocks = _resampled_outcome_curves(scaled.x, moves, weights * ~overturned, nodes)
    rocked = moves & ~overturned
    beyond = _resampled_limit_curves(
        np.log(im[rocked]), np.log(rotation[rocked]), weights[:, rocked], np.log(at), np.log(limit)
    )
    return total_exceedance_probability(falls, rocks, beyond)


def _resampled_outcome_curves(x: Array, outcome: Bools, weights: Array, nodes: Array) -> Array:
    """Logistic curve of each row at `nodes`; 0 or 1 where all outcomes are the same, NaN if all x are."""
    from scipy.special import expit

    held = weights > 0.0
    varied = np.where(held, x, -np.inf).max(axis=1) > np.where(held, x, np.inf).min(axis=1)
    yes, no = (held & outcome).any(axis=1), (held & ~outcome).any(axis=1)
    found = np.full((weights.shape[0], nodes.size), np.nan)
    found[~yes & no], found[yes & ~no] = 0.0, 1.0
    mixed = np.flatnonzero(yes & no & varied)
    if mixed.size:
        b = _regression.fit_logistic_curves(x, outcome, weights[mixed], RESAMPLE_SCORING).parameters
        found[mixed] = expit(b[:, :1] + b[:, 1:] * nodes)
    return found


def _resampled_limit_curves(x: Array, y: Array, weights: Array, at: Array, log_limit: float) -> Array:
    """P(θ_max > limit | rocking) of each row at `at`; NaN for fewer than three runs or two x or y."""
    from scipy.special import ndtr

    lines = _regression.fit_least_squares_lines(x, y, weights)
    with np.errstate(all="ignore"):
        above = lines.intercept[:, None] + lines.slope[:, None] * at - log_limit
        found = ndtr(above / lines.dispersion[:, None])
    fitted = (lines.size >= 3.0) & (lines.sxx > 1e-12 * lines.size) & (lines.syy > 1e-12 * lines.size)
    found[~fitted] = np.nan
    return found
