"""An acceleration that is linear between its samples: integrals, peaks, durations and spectrum."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._values import Value
from rockflex.motion import _integrals

if TYPE_CHECKING:
    from rockflex.motion._spectrum import ResponseSpectrum


@dataclass(frozen=True, eq=False)
class Samples(Value):
    """Samples in m/s² at equal steps in s; what `GroundMotion` says of its horizontal component."""

    acceleration: Array
    dt: float

    @property
    def time(self) -> Array:
        """Time of the samples in s, shape (n,)."""
        return self.dt * np.arange(self.acceleration.size, dtype=np.float64)

    @property
    def duration(self) -> float:
        """Time from the first sample to the last, (n - 1) dt, in s."""
        return (self.acceleration.size - 1) * self.dt

    @property
    def velocity(self) -> Array:
        """Ground velocity at the samples in m/s, shape (n,): the exact integral, starting from rest."""
        return _integrals.velocity(self.acceleration, self.dt)

    @property
    def displacement(self) -> Array:
        """Ground displacement at the samples in m, shape (n,): the exact second integral, starting from rest."""
        return _integrals.displacement(self.acceleration, self.dt)

    @cached_property
    def pga(self) -> float:
        """Peak ground acceleration in m/s²."""
        return float(np.max(np.abs(self.acceleration)))

    @cached_property
    def pgv(self) -> float:
        """Peak ground velocity in m/s, including peaks between samples."""
        return _integrals.peak_velocity(self.acceleration, self.dt)

    @cached_property
    def pgd(self) -> float:
        """Peak ground displacement in m up to the last sample, including peaks between samples."""
        return _integrals.peak_displacement(self.acceleration, self.dt)

    @cached_property
    def arias(self) -> float:
        """Arias intensity π/(2g) ∫a² dt in m/s (Arias 1970).

        The integral is exact. Databases often sum a² dt over the samples instead, which gives a larger value,
        especially if the frequency content of the record is close to its Nyquist frequency.
        """
        return _integrals.arias_intensity(self.acceleration, self.dt)

    @cached_property
    def cav(self) -> float:
        """Cumulative absolute velocity ∫|a| dt in m/s (EPRI 1988, without a threshold)."""
        return _integrals.cumulative_absolute_velocity(self.acceleration, self.dt)

    @cached_property
    def d5_95(self) -> float:
        """Significant duration between 5 % and 95 % of the Arias intensity, in s."""
        return self.significant_duration()

    def significant_duration(self, low: float = 0.05, high: float = 0.95) -> float:
        """Time between two fractions of the Arias intensity (Trifunac & Brady 1975).

        Parameters
        ----------
        low, high : float
            Fractions of the Arias intensity, 0 <= low < high <= 1.

        Returns
        -------
        float
            Duration in s between the instants at which the fractions are first reached, found on the exact
            cubic growth between samples; zero for a record without motion.

        Raises
        ------
        InputError
            If the fractions are out of order or out of range.
        """
        return _integrals.significant_duration(self.acceleration, self.dt, low, high)

    def spectrum(self, periods: ArrayLike, damping_ratio: float = 0.05) -> "ResponseSpectrum":
        """Elastic response spectrum; see `ResponseSpectrum`.

        Parameters
        ----------
        periods : array_like, shape (m,)
            Natural periods in s: zero, or at least 1e-6 s.
        damping_ratio : float
            Fraction of critical damping, 0 <= ζ < 1.

        Returns
        -------
        ResponseSpectrum
            Peaks of relative displacement and velocity, and the pseudo-acceleration.

        Raises
        ------
        InputError
            If a period is negative or not finite, or the damping ratio is out of range.
        """
        from rockflex.motion._spectrum import response_spectrum

        return response_spectrum(self.acceleration, self.dt, periods, damping_ratio)

    def sd(self, period: float, damping_ratio: float = 0.05) -> float:
        """Spectral displacement in m at one period (s); see `spectrum`."""
        from rockflex.motion._spectrum import largest_displacement

        return largest_displacement(self.acceleration, self.dt, period, damping_ratio)

    def sa(self, period: float, damping_ratio: float = 0.05) -> float:
        """Spectral pseudo-acceleration in m/s² at one period (s); see `spectrum`."""
        return float(self.spectrum([period], damping_ratio).sa[0])
