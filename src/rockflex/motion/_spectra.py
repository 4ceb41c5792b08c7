"""Spectra: periods, response spectra of one component, target spectra, and factors that fit one to the other."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex.engine.oscillator import peaks
from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    check_all_positive,
    checked_finite_vector,
    checked_in_range,
    checked_instance,
    checked_positive,
)
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value

MIN_PERIOD = 1e-6  # s
N_COMPARED = 50  # periods at which a range is examined
AVERAGED = np.arange(2, 31) / 10  # periods of an average spectral acceleration, over that of the structure


def checked_spectrum_periods(periods: ArrayLike) -> Array:
    """Return periods in s, each zero or at least 1e-6 s."""
    period = checked_finite_vector("periods", periods, "s")
    bad = np.flatnonzero((period < 0) | ((period > 0) & (period < MIN_PERIOD)))
    if bad.size:
        raise InputError(
            f"periods must be zero or at least 1e-6 s, but {period[bad[0]]:g} was given at index {bad[0]}. "
            "A period of zero gives the peak ground acceleration."
        )
    return period


def checked_spectrum_damping(damping_ratio: float) -> float:
    """Return a fraction of critical damping, 0 <= ζ < 1, or raise an InputError."""
    return checked_in_range("damping_ratio", damping_ratio, 0.0, 1.0, hint="It is a fraction: 5 % is 0.05.")


def comparison_periods(periods: ArrayLike) -> Array:
    """Return the periods at which spectra are compared: between two ends evenly in ln T, or as given."""
    given = checked_finite_vector("periods", periods, "s")
    if given.size == 2:
        if not 0.0 < given[0] < given[1]:
            raise InputError(
                f"periods must be a range such as (0.2, 2.0), but ({given[0]:g}, {given[1]:g}) was given. Two periods "
                "are the ends of a range, in order and positive; give three or more for single periods.",
                field="periods",
            )
        return np.geomspace(given[0], given[1], N_COMPARED)
    if not given.size or given.min() < 0.0 or (np.diff(given) <= 0.0).any():
        raise InputError(
            f"periods must be the two ends of a range, or increasing periods in s, but {shown(periods)} was given.",
            field="periods",
        )
    return given


@dataclass(frozen=True, eq=False)
class ResponseSpectrum(Value):
    """Peak response of damped linear oscillators to one ground motion.

    The response is exact for the piecewise linear acceleration (the recurrence of Nigam & Jennings 1969),
    and the peaks include those between samples. They cover the record, but not the free vibration after it.
    A period of zero is a rigid oscillator: sd = sv = 0 and sa = PGA.

    Parameters
    ----------
    period : ndarray, shape (m,)
        Natural periods in s.
    damping_ratio : float
        Fraction of critical damping.
    sd : ndarray, shape (m,)
        Peak relative displacement in m.
    sv : ndarray, shape (m,)
        Peak relative velocity in m/s.
    sa : ndarray, shape (m,)
        Pseudo-acceleration (2π/T)² sd in m/s².
    """

    period: Array
    damping_ratio: float
    sd: Array
    sv: Array
    sa: Array

    @property
    def psv(self) -> Array:
        """Pseudo-velocity (2π/T) sd in m/s, shape (m,); zero at a period of zero."""
        return np.divide(2 * np.pi * self.sd, self.period, out=np.zeros_like(self.sd), where=self.period > 0)


def spectral_displacement(acceleration: Array, dt: float, period: float, damping_ratio: float) -> float:
    """Return the spectral displacement in m at one period; see `GroundMotion.spectrum`."""
    if type(period) is type(damping_ratio) is float and MIN_PERIOD <= period < math.inf and 0.0 <= damping_ratio < 1.0:
        # Most are asked one by one, and each takes less than the checks of a whole spectrum.
        return float(peaks(acceleration, dt, [2 * np.pi / period], damping_ratio)[0, 0])
    return float(response_spectrum(acceleration, dt, [period], damping_ratio).sd[0])


def response_spectrum(acceleration: Array, dt: float, periods: ArrayLike, damping_ratio: float) -> ResponseSpectrum:
    """Return the response spectrum of a sampled acceleration; see `GroundMotion.spectrum`."""
    period = checked_spectrum_periods(periods)
    zeta = checked_spectrum_damping(damping_ratio)
    moves, found = period > 0, np.zeros((period.size, 2))
    found[moves] = peaks(acceleration, dt, 2 * np.pi / period[moves], zeta)
    sd, sv = found.T.copy()
    pga = np.full(period.size, np.max(np.abs(acceleration)))
    with np.errstate(over="ignore"):  # the acceleration is zero if the square of the period overflows
        sa = np.divide(4 * np.pi**2 * sd, period**2, out=pga, where=moves)
    return ResponseSpectrum(period, zeta, sd, sv, sa)


def average_spectral_acceleration(acceleration: Array, dt: float, period: float, damping_ratio: float) -> float:
    """Return the geometric mean of spectral accelerations in m/s²; see `GroundMotion.sa_avg`."""
    periods = checked_positive("period", period, "s") * AVERAGED
    periods[periods < MIN_PERIOD] = 0.0  # so stiff an oscillator moves with the ground
    with np.errstate(divide="ignore"):
        return float(np.exp(np.log(response_spectrum(acceleration, dt, periods, damping_ratio).sa).mean()))


@dataclass(frozen=True, eq=False, init=False, repr=False)
class TargetSpectrum(Value):
    """A target spectrum of pseudo-acceleration, from a table.

    Between two positive periods ln S_a is linear in ln T, so that branches of a code that are constant, or fall with
    1/T or 1/T², are exact between their corners. Between a period of zero and the next one S_a is linear in T. Outside
    the table the target is unknown.

    Parameters
    ----------
    periods : array_like, shape (m,)
        Increasing periods in s, at least two; the first may be zero, the ground acceleration.
    sa : array_like, shape (m,)
        Pseudo-acceleration in m/s², positive.
    damping_ratio : float
        Damping ratio for which the ordinates hold, 0 <= ζ < 1.
    name : str, optional
        Name for tables and figures.

    Raises
    ------
    InputError
        If periods do not increase, an ordinate is not positive, their numbers differ, or the damping ratio is out of
        range.

    Examples
    --------
    >>> import rockflex as rf
    >>> target = rf.TargetSpectrum([0.0, 0.1, 0.5, 2.0], [3.0, 7.5, 7.5, 1.875],
    ...     name="site")
    >>> target
    TargetSpectrum('site', 0 to 2 s, up to 7.5 m/s², ζ = 0.05)
    >>> target.at([0.05, 0.3, 1.0]).round(12)
    array([5.25, 7.5 , 3.75])
    """

    periods: Array
    sa: Array
    damping_ratio: float = 0.05
    name: str = ""

    def __init__(self, periods: ArrayLike, sa: ArrayLike, damping_ratio: float = 0.05, name: str = "") -> None:
        period, ordinates = checked_finite_vector("periods", periods, "s"), checked_finite_vector("sa", sa, "m/s²")
        if period.size < 2 or period.size != ordinates.size:
            raise InputError(
                "periods and sa must have the same length of at least 2, but "
                f"{period.size} and {ordinates.size} values were given."
            )
        if period[0] < 0.0 or (np.diff(period) <= 0.0).any():
            wrong = 0 if period[0] < 0.0 else int(np.argmax(np.diff(period) <= 0.0)) + 1
            raise InputError(
                f"periods must increase from zero or more, but {period[wrong]:g} s was given at index {wrong}. Sort "
                "the table by period, and keep each period once.",
                field="periods",
            )
        check_all_positive("sa", ordinates, "m/s²")
        zeta = checked_spectrum_damping(damping_ratio)
        vars(self).update(periods=period, sa=ordinates, damping_ratio=zeta, name=checked_instance("name", name, str))

    def __repr__(self) -> str:
        span = f"{self.periods[0]:g} to {self.periods[-1]:g} s"
        return f"TargetSpectrum({self.name!r}, {span}, up to {self.sa.max():.4g} m/s², ζ = {self.damping_ratio:g})"

    def at(self, periods: ArrayLike) -> Array:
        """Return the pseudo-acceleration in m/s² at periods in s, shape (m,).

        Raises
        ------
        InputError
            If a period is outside the table.
        """
        period = checked_finite_vector("periods", periods, "s")
        outside = (period < self.periods[0]) | (period > self.periods[-1])
        if outside.any():
            raise InputError(
                f"The target {shown(self.name)} is known from {self.periods[0]:g} to {self.periods[-1]:g} s, but not "
                f"at {period[np.argmax(outside)]:g} s. Choose periods within it, or extend the table.",
                field="periods",
            )
        table, ordinates = self.periods, self.sa
        found = np.empty(period.size)
        first = 0
        if table[0] == 0.0:
            first, low = 1, period < table[1]
            found[low] = ordinates[0] + (ordinates[1] - ordinates[0]) * (period[low] / table[1])
        high = period >= table[first]
        found[high] = np.exp(np.interp(np.log(period[high]), np.log(table[first:]), np.log(ordinates[first:])))
        return found

    def scaled(self, factor: float) -> "TargetSpectrum":
        """Return the target with all ordinates multiplied by a positive factor, such as a ratio to another level.

        Raises
        ------
        InputError
            If the factor is not positive, or an ordinate becomes too large.
        """
        with np.errstate(over="ignore"):
            ordinates = checked_positive("factor", factor, "") * self.sa
        return TargetSpectrum(self.periods, ordinates, self.damping_ratio, self.name)


def spectrum_fitting_factor(spectrum: Array, target: Array, name: str) -> float:
    """Return the factor with the least mean square of ln(factor · spectrum / target)."""
    scalable_spectral_ordinate(float(spectrum.min()), name, None)
    return float(np.exp(np.mean(np.log(target / spectrum))))


def scalable_spectral_ordinate(sa: float, name: str, period: float | None) -> float:
    """Return a spectral ordinate, or raise an InputError if no factor scales it."""
    if sa <= 0.0 or not np.isfinite(sa):
        where = "" if period is None else f" at a period of {period:g} s"
        raise InputError(f"The motion {shown(name)} cannot be scaled to a spectrum: its own is {sa:g} m/s²{where}.")
    return sa
