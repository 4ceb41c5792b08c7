"""Ground acceleration, linear between its samples."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite, finite_vector, positive
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.motion import _integrals, _processing
from rockflex.motion._record_info import RecordInfo

if TYPE_CHECKING:
    from rockflex.motion._spectrum import ResponseSpectrum


@dataclass(frozen=True, eq=False, init=False, repr=False)
class GroundMotion(Value):
    """A ground acceleration sampled at equal steps and linear between samples.

    The ground is at rest before t = 0, the time of the first sample; after the last sample the
    acceleration is zero. Every measure is exact for this piecewise linear function, including peaks between
    samples, and covers the time from the first sample to the last.

    Parameters
    ----------
    acceleration : array_like, shape (n,)
        Samples in m/s², at least three; stored as a read-only copy.
    dt : float
        Sampling step in s.
    name : str, optional
        Name by which suites and tables refer to the motion.
    metadata : RecordInfo, optional
        Information about the record.

    Raises
    ------
    InputError
        If there are fewer than three samples, a sample is not finite, or `dt` is not positive.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> t = np.arange(0.0, 2.001, 0.01)
    >>> motion = rf.GroundMotion(3.0 * np.sin(2.0 * np.pi * t), dt=0.01, name="sine")
    >>> motion
    GroundMotion('sine', 201 samples, dt=0.01 s, duration=2 s, pga=3 m/s²)
    >>> round(motion.scaled(2.0).pgv, 3)
    1.909
    """

    acceleration: Array
    dt: float
    name: str = ""
    metadata: RecordInfo | None = None

    def __init__(self, acceleration: ArrayLike, dt: float, name: str = "", metadata: RecordInfo | None = None) -> None:
        samples = finite_vector("acceleration", acceleration, "m/s²")
        if samples.size < 3:
            raise InputError(
                f"acceleration must have at least 3 samples, but {samples.size} were given. For a record "
                "without motion use quiet_motion(duration)."
            )
        if not isinstance(name, str):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(f"name must be a string, but {shown(name)} was given.")
        if not isinstance(metadata, RecordInfo | None):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"metadata must be a RecordInfo or None, but {type(metadata).__name__} was given. "
                "Write metadata=RecordInfo(event=..., year=...)."
            )
        vars(self).update(acceleration=samples, dt=positive("dt", dt, "s"), name=name, metadata=metadata)

    def __repr__(self) -> str:
        return (
            f"GroundMotion({self.name!r}, {self.acceleration.size} samples, dt={self.dt:g} s, "
            f"duration={self.duration:g} s, pga={self.pga:.4g} m/s²)"
        )

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

    def scaled(self, factor: float) -> "GroundMotion":
        """Return the motion multiplied by `factor` (negative to reverse it), with the same name.

        Raises
        ------
        InputError
            If `factor` or a scaled sample is not finite.
        """
        factor = finite("factor", factor, "")
        with np.errstate(over="ignore"):
            return self._with(self.acceleration * factor)

    def refined(self, k: int) -> "GroundMotion":
        """Return the same piecewise linear function with every interval split into `k` equal ones.

        Raises
        ------
        InputError
            If `k` is not a whole number of at least 1.
        """
        return self._with(_processing.refine(self.acceleration, k), self.dt / k)

    def resampled(self, dt: float) -> "GroundMotion":
        """Return the same piecewise linear function sampled at the finer step `dt` (s).

        The function stays unchanged only if the present step is a whole multiple of `dt` (within 1e-9), so other
        steps are rejected; the new step is the present one divided by that whole number.

        Raises
        ------
        InputError
            If the present step is not a whole multiple of `dt`; the error suggests the nearest valid steps.
        """
        return self.refined(_processing.refinement_of(self.dt, dt))

    def baseline_corrected(self, degree: int = 1) -> "GroundMotion":
        """Return the motion without the polynomial drift of its velocity.

        A polynomial p in time of the given degree is subtracted from the acceleration. Its coefficients are
        chosen so that the velocity ∫p dt (zero at t = 0, with p sampled and linear between samples) is the
        least-squares fit to the velocity of the record at the samples. The default removes a linear
        acceleration, which is a parabola through zero in velocity. Correcting twice changes nothing.

        Parameters
        ----------
        degree : int
            Degree of the polynomial removed from the acceleration.

        Returns
        -------
        GroundMotion
            The corrected motion.

        Raises
        ------
        InputError
            If `degree` is negative, not whole, or too high for the number of samples.
        """
        return self._with(_processing.baseline_correct(self.acceleration, self.dt, degree))

    def band_passed(self, low: float, high: float, order: int = 4) -> "GroundMotion":
        """Return the motion filtered by a Butterworth band-pass, forwards and backwards.

        The two passes cancel the phase shift and double the order; at a corner the amplitude is halved.

        Parameters
        ----------
        low, high : float
            Corner frequencies in Hz, 0 < low < high < 1/(2 dt).
        order : int
            Order of the filter of one pass.

        Returns
        -------
        GroundMotion
            The filtered motion, of the same length.

        Raises
        ------
        InputError
            If the corners are not in order below the Nyquist frequency, the order is not a whole positive
            number, or the record is too short for the filter.
        """
        return self._with(_processing.band_pass(self.acceleration, self.dt, low, high, order))

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
        return float(self.spectrum([period], damping_ratio).sd[0])

    def sa(self, period: float, damping_ratio: float = 0.05) -> float:
        """Spectral pseudo-acceleration in m/s² at one period (s); see `spectrum`."""
        return float(self.spectrum([period], damping_ratio).sa[0])

    def _with(self, acceleration: Array, dt: float | None = None) -> "GroundMotion":
        return GroundMotion(acceleration, self.dt if dt is None else dt, self.name, self.metadata)
