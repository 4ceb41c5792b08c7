"""Conditional spectra: the mean and the spread of spectra that have one given ordinate."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    check_all_positive,
    checked_finite_vector,
    checked_magnitude,
    checked_positive,
)
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion._spectra import TargetSpectrum

MAX_EPSILON = 20.0  # standard deviations, beyond any hazard
MAX_LOG = 700.0  # whose exponential is still a number
CORNER = 0.109  # s, where the correlation model changes
SHORT = 0.2  # s
N_BETWEEN = 201  # periods of a conditional spectrum beside those of its model
FITTED = (0.01, 10.0)  # s, periods for which the correlation was fitted


@dataclass(frozen=True, eq=False, init=False, repr=False)
class ConditionalSpectrum(TargetSpectrum):
    """A target of median and spread: the spectra of a scenario that have a given ordinate at one period.

    `conditional_spectrum` computes it from a ground-motion model; here the table of another program is taken as it is.
    Between periods the spread is linear in ln T.

    Parameters
    ----------
    periods : array_like, shape (m,)
        Increasing periods in s, all positive.
    sa : array_like, shape (m,)
        Median pseudo-acceleration in m/s², exp of the mean of ln S_a.
    dispersion : array_like, shape (m,)
        Standard deviation of ln S_a.
    period : float
        The period T* in s at which all spectra have the same ordinate; within the table.
    damping_ratio, name
        As in `TargetSpectrum`.

    Raises
    ------
    InputError
        As for `TargetSpectrum`; or if a standard deviation is negative, or the period is outside the table.

    Examples
    --------
    >>> import rockflex as rf
    >>> target = rf.ConditionalSpectrum([0.2, 1.0, 3.0], [6.0, 3.0, 0.9],
    ...     [0.5, 0.0, 0.4], 1.0, name="site")
    >>> target
    ConditionalSpectrum('site', S_a(1 s) = 3 m/s², 0.2 to 3 s, ζ = 0.05)
    >>> target.dispersion_at([1.0, 3.0])
    array([0. , 0.4])
    """

    dispersion: Array
    period: float

    def __init__(
        self,
        periods: ArrayLike,
        sa: ArrayLike,
        dispersion: ArrayLike,
        period: float,
        damping_ratio: float = 0.05,
        name: str = "",
    ) -> None:
        super().__init__(periods, sa, damping_ratio, name)
        spread, at = _checked_spread("dispersion", dispersion, self.periods), checked_positive("period", period, "s")
        if not 0.0 < self.periods[0] <= at <= self.periods[-1]:
            raise InputError(
                f"period must lie within the periods of the table, which are positive, but {at:g} s was given with "
                f"{self.periods[0]:g} to {self.periods[-1]:g} s.",
                field="period",
            )
        vars(self).update(dispersion=spread, period=at)

    def __repr__(self) -> str:
        level, span = f"{self.at([self.period])[0]:.4g}", f"{self.periods[0]:g} to {self.periods[-1]:g} s"
        return (
            f"ConditionalSpectrum({self.name!r}, S_a({self.period:g} s) = {level} m/s², {span}, "
            f"ζ = {self.damping_ratio:g})"
        )

    def dispersion_at(self, periods: ArrayLike) -> Array:
        """Return the standard deviation of ln S_a at periods in s, shape (m,).

        Raises
        ------
        InputError
            If a period is outside the table.
        """
        self.at(periods)  # refuses what is outside
        period = checked_finite_vector("periods", periods, "s")
        return np.interp(np.log(period), np.log(self.periods), self.dispersion)

    def scaled(self, factor: float) -> "ConditionalSpectrum":
        """Return the target with all ordinates multiplied by a positive factor, with the same spread.

        It is not the conditional spectrum of another level, whose shape differs: `conditional_spectrum` computes that.

        Raises
        ------
        InputError
            As `TargetSpectrum.scaled`.
        """
        sa = super().scaled(factor).sa
        return ConditionalSpectrum(self.periods, sa, self.dispersion, self.period, self.damping_ratio, self.name)


def conditional_spectrum(
    periods: ArrayLike,
    median: ArrayLike,
    dispersion: ArrayLike,
    period: float,
    *,
    sa: float | None = None,
    epsilon: float | None = None,
    damping_ratio: float = 0.05,
    name: str = "",
) -> ConditionalSpectrum:
    """Return the conditional spectrum of a scenario, from the median and spread of a ground-motion model.

    With ε = ln(S_a(T*)/median(T*))/σ(T*), and ρ by `spectral_correlation`:

    - mean of ln S_a(T): ln median(T) + ρ(T, T*) σ(T) ε
    - standard deviation: σ(T) √(1 - ρ²)

    The model is yours: evaluate it for the magnitude and distance that contribute most to the hazard at T*, with pygmm,
    OpenQuake or a national tool.

    Parameters
    ----------
    periods : array_like, shape (m,)
        Increasing periods in s, from 0.01 to 10 s; give the peak ground acceleration at 0.01 s.
    median : array_like, shape (m,)
        Median of S_a of the model in m/s².
    dispersion : array_like, shape (m,)
        Standard deviation of ln S_a of the model, which includes that between earthquakes.
    period : float
        T* in s, such as the first period of the structure; within the table.
    sa, epsilon : float
        S_a(T*) in m/s², as from the hazard curve, or ε; one of them.
    damping_ratio, name
        As in `TargetSpectrum`.

    Raises
    ------
    InputError
        If an argument is out of range, or not exactly one of `sa` and `epsilon` is given.

    References
    ----------
    Baker JW. Conditional mean spectrum: tool for ground-motion selection. *J Struct Eng* 2011;137(3):322–331.
    Lin T, Haselton CB, Baker JW. Conditional spectrum-based ground motion selection. Part I. *Earthquake Engng Struct
    Dyn* 2013;42(12):1847–1865.

    Examples
    --------
    >>> import rockflex as rf
    >>> target = rf.conditional_spectrum([0.05, 0.2, 0.5, 1.0, 2.0],
    ...     [2.9, 5.1, 3.2, 1.6, 0.7], [0.60, 0.65, 0.66, 0.68, 0.72], 1.0,
    ...     epsilon=1.5)
    >>> target.at([0.2, 1.0, 2.0]).round(2)
    array([7.87, 4.44, 1.57])
    >>> target.dispersion_at([0.2, 1.0, 2.0]).round(2)
    array([0.58, 0.  , 0.48])
    """
    check_all_positive("median", checked_finite_vector("median", median, "m/s²"), "m/s²")
    model = TargetSpectrum(periods, median, damping_ratio, name)
    spread, at = _checked_spread("dispersion", dispersion, model.periods), checked_positive("period", period, "s")
    if not FITTED[0] <= model.periods[0] <= at <= model.periods[-1] <= FITTED[1]:
        raise InputError(
            f"periods must lie from {FITTED[0]:g} to {FITTED[1]:g} s, for which the correlation was fitted, and "
            f"include period, but {model.periods[0]:g} to {model.periods[-1]:g} s were given with period={at:g} s. "
            f"Give a peak ground acceleration at {FITTED[0]:g} s.",
            field="periods",
        )
    fine = np.geomspace(model.periods[0], model.periods[-1], N_BETWEEN)  # the spread has a corner at T*
    nodes = np.union1d(np.union1d(model.periods, fine), [at])
    logs, spreads = np.log(model.at(nodes)), np.interp(np.log(nodes), np.log(model.periods), spread)
    place = int(np.searchsorted(nodes, at))
    check_level(sa, epsilon)
    away = math.log(sa) - logs[place] if sa is not None else (epsilon or 0.0) * spreads[place]
    # σ ε ρ is 0 at a model without spread, which has one spectrum only.
    slope = np.divide(spreads, spreads[place], out=np.zeros_like(spreads), where=spreads[place] > 0.0)
    rho = spectral_correlation(nodes, at)
    exponents = logs + rho * slope * away
    exponents[place] = logs[place] + away
    if not np.abs(exponents).max() < MAX_LOG:
        raise InputError(
            f"The spectrum would be beyond double precision: {away:.4g} from the median in ln S_a, with a dispersion "
            f"of {spreads[place]:.4g} at {at:g} s. Check epsilon, and that the dispersion is that of ln S_a.",
            field="sa" if epsilon is None else "epsilon",
        )
    return ConditionalSpectrum(nodes, np.exp(exponents), spreads * np.sqrt(1.0 - rho**2), at, damping_ratio, name)


def check_level(sa: float | None, epsilon: float | None) -> None:
    """Raise an InputError unless one of the ordinate in m/s² and its distance in standard deviations is given."""
    if (sa is None) == (epsilon is None):
        raise InputError(
            f"Give sa, in m/s², or epsilon, but sa={shown(sa)} and epsilon={shown(epsilon)} were given.", field="sa"
        )
    if sa is not None:
        checked_positive("sa", sa, "m/s²")
    if epsilon is not None:
        checked_magnitude("epsilon", epsilon, MAX_EPSILON, "standard deviations")


def spectral_correlation(first: ArrayLike, second: ArrayLike) -> Array:
    """Correlation of ln S_a at two periods, beside a ground-motion model (Baker & Jayaram 2008, Eq. 5).

    Fitted to the records of NGA, for shallow crustal earthquakes.

    Parameters
    ----------
    first, second : array_like
        Periods in s from 0.01 to 10 s, of shapes that broadcast.

    Raises
    ------
    InputError
        If a period is out of range.

    References
    ----------
    Baker JW, Jayaram N. Correlation of spectral acceleration values from NGA ground motion models. *Earthquake Spectra*
    2008;24(1):299–317.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.spectral_correlation([0.05, 0.5, 1.0, 2.0], 1.0).round(3)
    array([0.416, 0.749, 1.   , 0.749])
    """
    one, other = (_checked_fitted(name, given) for name, given in (("first", first), ("second", second)))
    try:
        np.broadcast_shapes(one.shape, other.shape)
    except ValueError as error:
        raise InputError(
            f"first and second must have shapes that broadcast, but {one.shape} and {other.shape} were given.",
            field="second",
        ) from error
    low, high = np.minimum(one, other), np.maximum(one, other)
    far = 1.0 - np.sin(0.366 * np.log(high / np.maximum(low, CORNER)))  # cos(π/2 - x), exactly 1 at equal periods
    rise = 1.0 / (1.0 + np.exp(100.0 * np.minimum(high, SHORT) - 5.0))
    near = np.where(high < SHORT, 1.0 - 0.105 * (1.0 - rise) * (high - low) / (high - 0.0099), 0.0)
    base = np.where(high < CORNER, near, far)
    between = far + 0.5 * (np.sqrt(base) - base) * (1.0 + np.cos(math.pi * low / CORNER))
    mixed = np.where(high < SHORT, np.minimum(near, between), between)
    return np.where(high < CORNER, near, np.where(low > CORNER, far, mixed))


def _checked_fitted(name: str, given: ArrayLike) -> Array:
    """Return periods for which the correlation was fitted, of any shape."""
    try:
        found = np.asarray(given)
    except (TypeError, ValueError, OverflowError, RecursionError):
        found = np.array(None)  # rows of different lengths
    numbers = found.dtype.kind in "fiu" and not np.ma.isMaskedArray(given)
    if not numbers or not ((found >= FITTED[0]) & (found <= FITTED[1])).all():
        raise InputError(
            f"{name} must be periods from {FITTED[0]:g} to {FITTED[1]:g} s, but {shown(given)} was given.", field=name
        )
    return found.astype(float)


def _checked_spread(name: str, given: ArrayLike, periods: Array) -> Array:
    spread = checked_finite_vector(name, given, "")
    if spread.size != periods.size or spread.min() < 0.0:
        raise InputError(
            f"{name} must be {periods.size} standard deviations of ln S_a, one for each period and none negative, but "
            f"{shown(given)} was given.",
            field=name,
        )
    return spread
