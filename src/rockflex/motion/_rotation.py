"""Response spectra of two horizontal components in all directions: RotD50 and RotD100."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import in_range, instance, real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.engine.oscillator import rotated_peaks
from rockflex.motion._periods import checked_periods
from rockflex.motion._samples import Samples

ANGLES: Array = np.radians(np.arange(180.0))


@dataclass(frozen=True, eq=False)
class RotatedSpectrum(Value):
    """Pseudo-acceleration of two horizontal components in every direction (Boore 2010).

    In the direction φ from the first component the ground moves by a₁ cos φ + a₂ sin φ. RotDnn is the nn-th percentile,
    over directions of 0°, 1°, ... 179°, of the spectral ordinates; unlike the geometric mean of the two components it
    does not depend on how the instrument was placed.

    Parameters
    ----------
    period : ndarray, shape (m,)
        Natural periods in s.
    damping_ratio : float
        Fraction of critical damping.
    angle : ndarray, shape (180,)
        Directions φ in rad.
    sa : ndarray, shape (m, 180)
        Pseudo-acceleration in m/s² at each period and in each direction.

    References
    ----------
    Boore DM. Orientation-independent, nongeometric-mean measures of seismic intensity from two horizontal components of
    motion. *Bull Seismol Soc Am* 2010;100(4):1830–1835. https://doi.org/10.1785/0120090400

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> spectrum = rf.rotated_spectrum(suite["FF-1-a"], suite["FF-1-b"], [0.5, 1.0])
    >>> spectrum.sa.shape
    (2, 180)
    >>> bool((spectrum.rotd50 < spectrum.rotd100).all())
    True
    """

    period: Array
    damping_ratio: float
    angle: Array
    sa: Array

    def rotd(self, percentile: float) -> Array:
        """Return a percentile, 0 to 100, of the ordinates over all directions, in m/s², shape (m,).

        Raises
        ------
        InputError
            If the percentile is out of range.
        """
        share = real_or_nan(percentile)
        if not 0.0 <= share <= 100.0:
            raise InputError(
                f"percentile must be a number from 0 to 100, but {shown(percentile)} was given. RotD50 is the 50th.",
                field="percentile",
            )
        return np.percentile(self.sa, share, axis=1)

    @property
    def rotd50(self) -> Array:
        """The median over all directions, in m/s², shape (m,)."""
        return np.median(self.sa, axis=1)

    @property
    def rotd100(self) -> Array:
        """The largest over all directions, in m/s², shape (m,)."""
        return np.max(self.sa, axis=1)

    @property
    def geometric_mean(self) -> Array:
        """Geometric mean of the two components as recorded, in m/s², shape (m,)."""
        return np.sqrt(self.sa[:, 0] * self.sa[:, 90])


def rotated_spectrum(
    first: Samples, second: Samples, periods: ArrayLike, damping_ratio: float = 0.05
) -> RotatedSpectrum:
    """Response spectrum of two horizontal components in 180 directions, for RotD50 and RotD100.

    Each of the 180 peaks is exact, as in `ResponseSpectrum`: peaks between samples are included.

    Parameters
    ----------
    first, second : GroundMotion
        Horizontal components of one recording, at right angles. They start at the same instant; zeros are appended to
        the shorter one.
    periods : array_like, shape (m,)
        Natural periods in s: zero, or at least 1e-6 s.
    damping_ratio : float
        Fraction of critical damping, 0 <= ζ < 1.

    Returns
    -------
    RotatedSpectrum
        The ordinates of pseudo-acceleration by period and direction.

    Raises
    ------
    InputError
        If the time steps of the components differ, a period is negative or not finite, or the damping ratio is out of
        range.

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> spectrum = rf.rotated_spectrum(suite["FF-1-a"], suite["FF-1-b"], [1.0])
    >>> spectrum.rotd50.round(2), spectrum.rotd100.round(2), spectrum.geometric_mean.round(2)
    (array([9.58]), array([13.06]), array([9.61]))
    """
    one, other = instance("first", first, Samples), instance("second", second, Samples)
    if abs(one.dt - other.dt) > 1e-9 * one.dt:
        raise InputError(
            f"first and second need the same time step, but {one.dt:g} s and {other.dt:g} s were given. Resample the "
            f"coarser one, for example with motion.resampled({min(one.dt, other.dt):g})."
        )
    period = checked_periods(periods)
    zeta = in_range("damping_ratio", damping_ratio, 0.0, 1.0, hint="It is a fraction: 5 % is 0.05.")
    size = max(one.acceleration.size, other.acceleration.size)
    a1, a2 = (np.pad(each.acceleration, (0, size - each.acceleration.size)) for each in (one, other))
    moves, sa = period > 0, np.empty((period.size, ANGLES.size))
    if not moves.all():
        sa[~moves] = [np.max(np.abs(math.cos(angle) * a1 + math.sin(angle) * a2)) for angle in ANGLES]
    omega = 2 * np.pi / period[moves]
    sa[moves] = rotated_peaks(a1, a2, one.dt, omega, zeta, ANGLES)
    with np.errstate(over="ignore"):
        sa[moves] *= omega[:, None] ** 2
    return RotatedSpectrum(period, zeta, ANGLES, sa)
