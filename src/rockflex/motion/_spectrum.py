"""Elastic response spectra."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import in_range
from rockflex._values import Value
from rockflex.engine.oscillator import peaks
from rockflex.motion._periods import SHORTEST, checked_periods


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


def largest_displacement(acceleration: Array, dt: float, period: float, damping_ratio: float) -> float:
    """Return the spectral displacement in m at one period; see `GroundMotion.spectrum`."""
    if type(period) is type(damping_ratio) is float and SHORTEST <= period < math.inf and 0.0 <= damping_ratio < 1.0:
        # Most are asked one by one, and each takes less than the checks of a whole spectrum.
        return float(peaks(acceleration, dt, [2 * np.pi / period], damping_ratio)[0, 0])
    return float(response_spectrum(acceleration, dt, [period], damping_ratio).sd[0])


def response_spectrum(acceleration: Array, dt: float, periods: ArrayLike, damping_ratio: float) -> ResponseSpectrum:
    """Return the response spectrum of a sampled acceleration; see `GroundMotion.spectrum`."""
    period = checked_periods(periods)
    zeta = in_range("damping_ratio", damping_ratio, 0.0, 1.0, hint="It is a fraction: 5 % is 0.05.")
    moves, found = period > 0, np.zeros((period.size, 2))
    found[moves] = peaks(acceleration, dt, 2 * np.pi / period[moves], zeta)
    sd, sv = found.T.copy()
    pga = np.full(period.size, np.max(np.abs(acceleration)))
    with np.errstate(over="ignore"):  # the acceleration is zero if the square of the period overflows
        sa = np.divide(4 * np.pi**2 * sd, period**2, out=pga, where=moves)
    return ResponseSpectrum(period, zeta, sd, sv, sa)
