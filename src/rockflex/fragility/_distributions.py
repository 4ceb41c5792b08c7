"""Measured against computed distributions: of the largest responses under many records, not of single runs."""

from dataclasses import dataclass
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_whole_number, float_array
from rockflex.foundation.errors import InputError
from rockflex.foundation.values import Value
from rockflex.fragility._arguments import checked_confidence

FEWEST = 5  # values of each sample


@dataclass(frozen=True, eq=False, kw_only=True)
class DistributionComparison(Value):
    """How two distributions of maxima compare.

    Attributes
    ----------
    n_measured, n_computed : int
        Numbers of values.
    statistic, p_value : float
        Of the two-sample test of Kolmogorov and Smirnov: the largest difference of the cumulative distributions, and
        the probability of such a one or a larger if both are samples of one distribution.
    median_ratio : float
        Computed over measured median.
    median_band : ndarray, shape (2,)
        Its confidence band, by resampling.
    dispersion_ratio : float
        Computed over measured standard deviation of the logarithms of finite values.
    dispersion_band : ndarray, shape (2,)
        Its confidence band.
    overturned : tuple of float
        Shares of infinite values, measured and computed.

    Examples
    --------
    >>> import numpy as np
    >>> import rockflex as rf
    >>> draws = np.random.default_rng(0).lognormal(-4.0, 0.5, (2, 200))
    >>> rf.compare_distributions(draws[0], draws[1]).p_value > 0.05
    True
    """

    n_measured: int
    n_computed: int
    statistic: float
    p_value: float
    median_ratio: float
    median_band: Array
    dispersion_ratio: float
    dispersion_band: Array
    overturned: tuple[float, float]

    def __repr__(self) -> str:
        low, high = self.median_band
        return (
            f"DistributionComparison({self.n_measured} measured, {self.n_computed} computed: median ratio "
            f"{self.median_ratio:.3g} ({low:.3g} to {high:.3g}), p = {self.p_value:.2g})"
        )


def compare_distributions(
    measured: ArrayLike,
    computed: ArrayLike,
    *,
    confidence: float = 0.9,
    n_resamples: SupportsIndex = 2000,
    seed: SupportsIndex = 0,
) -> DistributionComparison:
    """Compare the distribution of measured maxima with that of computed ones.

    A single rocking run is sensitive: two tests of one specimen under one record may differ by more than any model from
    either. What a model can predict, and what fragilities need, is the distribution over many records; so it is that
    which is compared, by ranks.

    Parameters
    ----------
    measured, computed
        Largest rotations, for example, of tests and of runs; infinite where the specimen overturned. They need not be
        of the same records, nor as many.
    confidence
        Of the bands.
    n_resamples
        Number of resamples, each of both samples, for the bands.
    seed
        Of the resamples.

    Returns
    -------
    DistributionComparison
        The test of Kolmogorov and Smirnov, and ratios of medians and dispersions with bands.

    Raises
    ------
    InputError
        If there are fewer than 5 values, a value is negative, zero or NaN, or more than half are infinite.

    Examples
    --------
    >>> import numpy as np
    >>> import rockflex as rf
    >>> draws = np.random.default_rng(0).lognormal(-4.0, 0.5, (2, 200))
    >>> found = rf.compare_distributions(draws[0], 1.5 * draws[1])
    >>> found.p_value < 0.01, 1.2 < found.median_ratio < 1.9
    (True, True)
    """
    samples = [_checked(name, given) for name, given in (("measured", measured), ("computed", computed))]
    share, count = checked_confidence(confidence), checked_whole_number("n_resamples", n_resamples, 100, 1_000_000)
    rng = np.random.default_rng(checked_whole_number("seed", seed, 0))
    from scipy.stats import ks_2samp

    test: Any = ks_2samp(samples[0], samples[1])
    ratios = [_ratios(*samples)]
    for _ in range(count):
        ratios.append(_ratios(*(each[rng.integers(each.size, size=each.size)] for each in samples)))
    (median, dispersion), *others = ratios
    ends = 0.5 - 0.5 * share, 0.5 + 0.5 * share
    bands = np.nanquantile(np.array(others), ends, axis=0)
    return DistributionComparison(
        n_measured=samples[0].size,
        n_computed=samples[1].size,
        statistic=float(test.statistic),
        p_value=float(test.pvalue),
        median_ratio=median,
        median_band=bands[:, 0],
        dispersion_ratio=dispersion,
        dispersion_band=bands[:, 1],
        overturned=(float(np.isinf(samples[0]).mean()), float(np.isinf(samples[1]).mean())),
    )


def _ratios(measured: Array, computed: Array) -> tuple[float, float]:
    """The ratios of the medians and of the dispersions; NaN where one is not known."""
    medians = [float(np.median(each)) for each in (measured, computed)]
    spreads = [float(np.log(each[np.isfinite(each)]).std(ddof=1)) for each in (measured, computed)]
    median = medians[1] / medians[0] if np.isfinite(medians).all() else np.nan
    return median, spreads[1] / spreads[0] if spreads[0] > 0.0 else np.nan


def _checked(name: str, given: ArrayLike) -> Array:
    values = float_array(given)
    found = np.zeros(0) if values is None else values.ravel()
    if found.size < FEWEST or not (found > 0.0).all() or np.isfinite(found).mean() <= 0.5:
        raise InputError(
            f"{name} must be {FEWEST} or more positive values, more than half of them finite, but {found.size} with "
            f"{int(np.isinf(found).sum())} infinite ones were given. Leave out runs without uplift from both samples.",
            field=name,
        )
    return found
