"""Fragility and hazard together: annual rates of failure, and capacities that meet a target rate."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_in_range, checked_instance, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.values import Value
from rockflex.fragility._arguments import Curve, FragilityCurve, checked_confidence, checked_fragility_curve
from rockflex.fragility._hazard import HazardCurve
from rockflex.fragility._jackknife import sampled_band_limits
from rockflex.fragility._logistic import UnanimousOutcome
from rockflex.fragility._lognormal import LognormalFragility

N_NODES = 12  # of Gauss and Legendre in a segment of a hazard curve
MAX_TAIL = 60.0  # in ln(IM): the tail below the curve's lower end is integrated this far


@dataclass(frozen=True, eq=False)
class AnnualRate(Value):
    """Mean annual rate of failure within the hazard curve, and bounds on the rate beyond its ends.

    Attributes
    ----------
    rate : float
        ∫ P(im) |dλ| in 1/year from the first to the last point of the curve.
    below : float
        Rate in 1/year from smaller measures if the curve continued with the slope of its first segment: an upper bound,
        because hazard curves flatten towards small measures. Infinite if the integral diverges.
    above : float
        Largest possible rate in 1/year from larger measures: the rate of the last point.
    low, high : float
        Confidence limits of `rate`, if a confidence was given; NaN otherwise, and where all runs had the same outcome.
    extrapolated : float
        Part of `rate` in 1/year from measures outside the range of the runs, where the fragility is extrapolated; NaN
        if the measures of the runs are not known.

    Examples
    --------
    >>> import rockflex as rf
    >>> hazard = rf.HazardCurve([0.1, 0.2, 0.4, 0.8], [1e-2, 3e-3, 6e-4, 1e-4])
    >>> rate = rf.annual_rate(hazard, rf.LognormalFragility(median=0.5, beta=0.4))
    >>> print(f"{rate.rate:.3g}, {rate.probability_in(50):.3g}")
    0.000436, 0.0216
    """

    rate: float
    below: float
    above: float
    low: float = math.nan
    high: float = math.nan
    extrapolated: float = math.nan

    @property
    def beyond(self) -> float:
        """Upper bound in 1/year on the rate outside the curve: the true rate is at most `rate` + `beyond`."""
        return self.below + self.above

    def probability_in(self, years: float) -> float:
        """Probability of at least one failure in `years`, 1 - exp(-rate years), as a Poisson process."""
        return -math.expm1(-self.rate * checked_positive("years", years, "years", zero=True))


def annual_rate(
    hazard: HazardCurve, fragility: FragilityCurve | Curve, *, confidence: float | None = None
) -> AnnualRate:
    """Integrate a fragility curve over a hazard curve, λ_f = ∫ P(im) |dλ(im)|.

    Between two points λ is a power law; adaptive Gauss-Kronrod quadrature in log IM integrates all segments at once.

    Parameters
    ----------
    hazard
        The hazard curve, in the measure and the unit of the fragility.
    fragility
        A fit with `probability`, such as ``outcomes.curve(0.01)``, or a function of an array of measures.
    confidence
        Confidence of a band, in [0, 1), for a fit with a covariance: quantiles of the rates for parameters drawn from
        Student's t with G - 1 degrees of freedom, where G is the number of recordings. It is the scatter of the records
        alone, without the hazard's. Default: no band.

    Raises
    ------
    InputError
        If the probabilities are not finite numbers from 0 to 1, the spectral accelerations of curve and fragility are
        known to be of different damping, or a band is wanted of a fragility that has none.

    Examples
    --------
    >>> import rockflex as rf
    >>> hazard = rf.HazardCurve([0.1, 0.2, 0.4, 0.8], [1e-2, 3e-3, 6e-4, 1e-4])
    >>> found = rf.annual_rate(hazard,
    ...     rf.LognormalFragility(median=0.5, beta=0.4))
    >>> print(f"{found.rate:.3g}")
    0.000436
    >>> print(f"{found.beyond:.3g}")
    0.0001
    """
    checked_instance("hazard", hazard, HazardCurve)
    probability = checked_fragility_curve(fragility)
    hazard.check_damping(getattr(fragility, "damping", None))
    im, share = hazard_quadrature(hazard)
    low, high = (math.nan, math.nan) if confidence is None else _annual_rate_band(fragility, im, share, confidence)
    ends, outside = getattr(fragility, "measured", None), math.nan
    if ends is not None:
        outside = float(np.sum((probability(im) * share)[(im < ends[0]) | (im > ends[1])]))
    rate, below = _rate_within_hazard_curve(hazard, probability), _rate_below_hazard_curve(hazard, probability)
    return AnnualRate(rate, below, float(hazard.rate[-1]), low, high, outside)


def hazard_quadrature(hazard: HazardCurve) -> tuple[Array, Array]:
    """Measures and weights: ∫ P |dλ| is close to the sum of P at these measures times the weights.

    Gauss and Legendre's rule in log IM, in each segment of the curve.
    """
    points, shares = np.polynomial.legendre.leggauss(N_NODES)
    step = 0.5 + 0.5 * points
    start, width, k = np.log(hazard.im[:-1]), np.diff(np.log(hazard.im)), hazard.slopes
    im = np.exp(start[:, None] + width[:, None] * step)
    falls = (k * width * hazard.rate[:-1])[:, None] * np.exp(-np.outer(k * width, step))
    return im.ravel(), (0.5 * shares * falls).ravel()


def _annual_rate_band(fragility: Any, im: Array, share: Array, confidence: float) -> tuple[float, float]:
    wanted = checked_confidence(confidence)
    if isinstance(fragility, UnanimousOutcome):
        return math.nan, math.nan
    if not hasattr(fragility, "drawn"):
        raise InputError(
            f"confidence needs a fit that knows its scatter, such as outcomes.curve(0.01), but "
            f"{type(fragility).__name__} was given. Leave confidence out for the rate alone.",
            field="confidence",
        )
    low, high = sampled_band_limits(fragility.drawn(im) @ share, wanted)
    return float(low), float(high)


def risk_targeted_median(
    hazard: HazardCurve, dispersion: float, target_rate: float, *, allowed_beyond: float = 0.1
) -> float:
    """Median capacity of a lognormal fragility whose annual rate of failure meets a target.

    The uniform-risk value, as in risk-targeted design maps (Luco et al. 2007, SEAOC Convention Proceedings), by Brent's
    method. A probability of 1 % in 50 years is a rate of 2.01e-4.

    Parameters
    ----------
    hazard
        The hazard curve.
    dispersion
        Standard deviation of the logarithm of the capacity.
    target_rate
        Annual rate of failure in 1/year.
    allowed_beyond
        Largest `AnnualRate.beyond` at the solution, as a fraction of the target. The target is met by the rate within
        the curve, so the true rate may be larger by this fraction.

    Raises
    ------
    InputError
        If an argument is out of range, no median within the curve meets the target, or too much of the rate lies
        beyond the ends of the curve.

    Examples
    --------
    >>> import rockflex as rf
    >>> hazard = rf.HazardCurve([0.1, 0.2, 0.4, 0.8], [1e-2, 3e-3, 6e-4, 1e-4])
    >>> median = rf.risk_targeted_median(hazard, dispersion=0.4, target_rate=1e-3,
    ...     allowed_beyond=0.3)
    >>> print(f"{median:.3g}")
    0.364
    """
    from scipy.optimize import brentq

    checked_instance("hazard", hazard, HazardCurve)
    beta = checked_positive("dispersion", dispersion, "natural logarithms")
    target = checked_positive("target_rate", target_rate, "1/year")
    share = checked_in_range("allowed_beyond", allowed_beyond, 0.0, math.inf)

    def rate(log_median: float) -> float:
        return _rate_within_hazard_curve(hazard, LognormalFragility(math.exp(log_median), beta).probability)

    low, high = math.log(hazard.im[0]), math.log(hazard.im[-1])
    most, least = rate(low), rate(high)
    if not least <= target <= most:
        raise InputError(
            f"target_rate must lie between {least:.4g} and {most:.4g} per year, the rates of medians at the ends of "
            f"the hazard curve, but {target:g} was given. Extend the curve."
        )
    median = math.exp(brentq(lambda x: rate(x) / target - 1.0, low, high, xtol=1e-12, rtol=1e-12))
    left = annual_rate(hazard, LognormalFragility(median, beta))
    if left.beyond > share * target:
        raise InputError(
            f"At the median {median:.4g}, up to {left.beyond:.3g} per year lie beyond the ends of the hazard curve "
            f"({left.below:.3g} below, {left.above:.3g} above), more than {share:g} of the target. Extend the curve, "
            "or set allowed_beyond."
        )
    return median


def _rate_within_hazard_curve(hazard: HazardCurve, probability: Curve) -> float:
    from scipy.integrate import quad_vec

    start, width = np.log(hazard.im[:-1]), np.diff(np.log(hazard.im))
    k, rates = hazard.slopes, hazard.rate[:-1]

    def segments(t: float) -> Array:
        return probability(np.exp(start + t * width)) * k * width * rates * np.exp(-k * width * t)

    parts, _ = quad_vec(segments, 0.0, 1.0, epsabs=1e-300, epsrel=1e-10, norm="max", limit=2000)
    return float(np.sum(parts))


def _rate_below_hazard_curve(hazard: HazardCurve, probability: Curve) -> float:
    """∫ P |dλ| below the first point, with the slope of the first segment; infinite if it diverges."""
    from scipy.integrate import quad_vec

    im, k, rate = float(hazard.im[0]), float(hazard.slopes[0]), float(hazard.rate[0])
    end = min(MAX_TAIL, 600.0 / k)  # keeps exp(k s) finite

    def tail(s: float) -> Array:
        return probability(np.array([im * math.exp(-s)])) * k * rate * math.exp(k * s)

    total, _ = quad_vec(tail, 0.0, end, epsabs=1e-12 * rate, epsrel=1e-8, limit=2000, points=(0.01 * end, 0.1 * end))
    return float(total[0]) if tail(end)[0] <= 1e-9 * rate else math.inf
