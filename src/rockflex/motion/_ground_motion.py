"""Ground acceleration, linear between its samples: its integrals, peaks, spectra, changes and vertical component."""

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    checked_finite,
    checked_finite_vector,
    checked_instance,
    checked_positive,
    real_or_nan,
)
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.language import translated
from rockflex.foundation.shown import first_texts_shown, shown
from rockflex.foundation.values import Value
from rockflex.motion import _signal, _spectra
from rockflex.motion._incremental_velocity import filtered_incremental_velocity
from rockflex.motion._record_info import RecordInfo

SHOWN_METADATA = ("event", "year", "magnitude", "distance_km", "vs30", "station", "component", "source", "scale")
MAX_LENGTH_DIFFERENCE = 1.0  # s by which the lengths of two components may differ without a warning


@dataclass(frozen=True, eq=False, init=False, repr=False)
class GroundMotion(HtmlTable, Value):
    """A ground acceleration sampled at equal steps and linear between samples.

    The ground is at rest before t = 0, the time of the first sample; after the last sample the
    acceleration is zero. Every measure is exact for this piecewise linear function, including peaks between
    samples, and covers the time from the first sample to the last.

    The ground may also move vertically. Measures refer to the horizontal component, unless their name says otherwise;
    `vertical_motion` gives the measures of the vertical one. Methods that change a motion, such as `scaled`, change
    both components.

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
    vertical : array_like, shape (n,), optional
        Samples of the vertical acceleration in m/s² at the same instants, positive upwards; None if unknown.

    Raises
    ------
    InputError
        If there are fewer than three samples, a sample is not finite, `dt` is not positive, or the components differ
        in length.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> t = np.arange(0.0, 2.001, 0.01)
    >>> motion = rf.GroundMotion(3.0 * np.sin(2.0 * np.pi * t), dt=0.01,
    ...     name="sine")
    >>> motion
    GroundMotion('sine', 201 samples, dt=0.01 s, duration=2 s, pga=3 m/s²)
    >>> round(motion.scaled(2.0).pgv, 3)
    1.909
    >>> both = rf.GroundMotion([0.0, 2.0, 0.0], dt=0.01,
    ...     vertical=[0.0, 0.0, -1.5])
    >>> both.scaled(2.0).pva
    3.0
    """

    acceleration: Array
    dt: float
    name: str = ""
    metadata: RecordInfo | None = None
    vertical: Array | None = None

    def __init__(
        self,
        acceleration: ArrayLike,
        dt: float,
        name: str = "",
        metadata: RecordInfo | None = None,
        vertical: ArrayLike | None = None,
    ) -> None:
        samples = checked_finite_vector("acceleration", acceleration, "m/s²")
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
        upwards = None if vertical is None else _checked_vertical_samples(vertical, samples.size)
        step = checked_positive("dt", dt, "s")
        vars(self).update(acceleration=samples, dt=step, name=name, metadata=metadata, vertical=upwards)

    def __repr__(self) -> str:
        upwards = "" if self.vertical is None else f", pva={self.pva:.4g} m/s²"
        return (
            f"GroundMotion({self.name!r}, {self.acceleration.size} samples, dt={self.dt:g} s, "
            f"duration={self.duration:g} s, pga={self.pga:.4g} m/s²{upwards})"
        )

    def _shown_as(self) -> Mapping[str, Any]:
        return {
            "name": self.name or None,
            "samples": f"{self.acceleration.size}, every {self.dt:g} s",
            "duration": f"{self.duration:g} s",
            "pga": f"{self.pga:.4g} m/s²",
            "pgv": f"{self.pgv:.4g} m/s",
            "pgd": f"{self.pgd:.4g} m",
            "pva": None if self.vertical is None else f"{self.pva:.4g} m/s²",
            **{name: getattr(self.metadata, name, None) for name in SHOWN_METADATA},
        }

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
        return _signal.velocity_from_acceleration(self.acceleration, self.dt)

    @property
    def displacement(self) -> Array:
        """Ground displacement at the samples in m, shape (n,): the exact second integral, starting from rest."""
        a, v, dt = self.acceleration, self.velocity, self.dt
        return _signal.cumulative_sum(dt * v[:-1] + dt**2 / 6 * (2 * a[:-1] + a[1:]))

    @cached_property
    def pga(self) -> float:
        """Peak ground acceleration in m/s²."""
        return float(np.max(np.abs(self.acceleration)))

    @cached_property
    def pgv(self) -> float:
        """Peak ground velocity in m/s, including peaks between samples."""
        # Between samples v has an extreme where a crosses zero.
        a, v = self.acceleration, self.velocity
        k = np.flatnonzero(np.sign(a[:-1]) * np.sign(a[1:]) < 0)
        inside = v[k] + 0.5 * self.dt * a[k] * (a[k] / (a[k] - a[k + 1]))
        return float(np.max(np.abs(np.concatenate((v, inside)))))

    @cached_property
    def pgd(self) -> float:
        """Peak ground displacement in m up to the last sample, including peaks between samples."""
        # Between samples d has an extreme at the zeros of the quadratic v = c + b x + q x², with x = t/dt in [0, 1].
        a, v, d, dt = self.acceleration, self.velocity, self.displacement, self.dt
        c, b, q = v[:-1], dt * a[:-1], 0.5 * dt * np.diff(a)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            w = -0.5 * (b + np.copysign(np.sqrt(b**2 - 4 * q * c), b))
            roots = np.stack((w / q, c / w))
            inside = (roots > 0) & (roots < 1)
        x = np.where(inside, roots, 0.0)
        extremes = d[:-1] + dt * x * (c + x * (b / 2 + x * q / 3))
        return float(max(np.max(np.abs(d)), np.max(np.abs(extremes))))

    @cached_property
    def arias(self) -> float:
        """Arias intensity π/(2g) ∫a² dt in m/s (Arias 1970).

        The integral is exact. Databases often sum a² dt over the samples instead, which gives a larger value,
        especially if the frequency content of the record is close to its Nyquist frequency.
        """
        return math.pi / (2 * GRAVITY) * float(np.sum(_signal.squares_between_samples(self.acceleration, self.dt)))

    @cached_property
    def cav(self) -> float:
        """Cumulative absolute velocity ∫|a| dt in m/s (EPRI 1988, without a threshold)."""
        left, right = self.acceleration[:-1], self.acceleration[1:]
        total = np.abs(left) + np.abs(right)
        # Where a changes sign, two triangles of heights |left| and |right| divide the interval in proportion to these.
        crossing = np.sign(left) * np.sign(right) < 0
        ratio = np.divide(left**2 + right**2, total, out=total.copy(), where=crossing)
        return float(np.sum(0.5 * self.dt * ratio))

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
        if not 0 <= real_or_nan(low) < real_or_nan(high) <= 1:
            raise InputError(
                f"low and high must be fractions with 0 <= low < high <= 1, but low={shown(low)} and "
                f"high={shown(high)} were given. Significant duration D5-95 is low=0.05, high=0.95."
            )
        first, last = _signal.times_of_energy_shares(self.acceleration, self.dt, (float(low), float(high)))
        return last - first

    def spectrum(self, periods: ArrayLike, damping_ratio: float = 0.05) -> _spectra.ResponseSpectrum:
        """Elastic response spectrum; see `ResponseSpectrum`.

        Parameters
        ----------
        periods : array_like, shape (m,)
            Natural periods in s: zero, or at least 1e-6 s.
        damping_ratio : float
            Fraction of critical damping, 0 <= ζ < 1.

        Raises
        ------
        InputError
            If a period is negative or not finite, or the damping ratio is out of range.
        """
        return _spectra.response_spectrum(self.acceleration, self.dt, periods, damping_ratio)

    def sd(self, period: float, damping_ratio: float = 0.05) -> float:
        """Spectral displacement in m at one period (s); see `spectrum`."""
        return _spectra.spectral_displacement(self.acceleration, self.dt, period, damping_ratio)

    def sa(self, period: float, damping_ratio: float = 0.05) -> float:
        """Spectral pseudo-acceleration in m/s² at one period (s); see `spectrum`."""
        return float(self.spectrum([period], damping_ratio).sa[0])

    def sa_avg(self, period: float, damping_ratio: float = 0.05) -> float:
        """Average spectral acceleration in m/s²: the geometric mean of S_a at 0.2 T, 0.3 T, ... 3 T.

        Unlike S_a(T) it sees higher modes and periods that lengthen (Eads, Miranda & Lignos 2015, EESD 44; Kohrangi,
        Bazzurro & Vamvatsikos 2016, Bull Earthq Eng 14).

        Parameters
        ----------
        period : float
            The period T in s.
        damping_ratio : float
            Fraction of critical damping, 0 <= ζ < 1.

        Raises
        ------
        InputError
            If the period is not positive, or the damping ratio is out of range.
        """
        return _spectra.average_spectral_acceleration(self.acceleration, self.dt, period, damping_ratio)

    def fiv3(self, period: float, alpha: float = 0.7, beta: float = 0.85) -> float:
        """Filtered incremental velocity FIV3 in m/s, a measure for collapse (Dávalos & Miranda 2019, EESD 48).

        The acceleration passes once through a Butterworth low-pass filter of order two with the cut-off frequency
        beta/T. Its integral over a window of length alpha T is a function of where the window begins, from the first
        sample to the last one, with zeros after the record. FIV3 is the sum of its three highest peaks, or, if that is
        larger, of its three lowest troughs without their sign; the two ends count as peaks, too.

        Parameters
        ----------
        period : float
            The period T in s.
        alpha, beta : float
            Length of the window over T, and cut-off frequency times T.

        Raises
        ------
        InputError
            If an argument is not positive.
        """
        return filtered_incremental_velocity(self.acceleration, self.dt, period, alpha, beta)

    @cached_property
    def pva(self) -> float:
        """Peak vertical acceleration in m/s²; NaN without a vertical component."""
        return math.nan if self.vertical is None else float(np.max(np.abs(self.vertical)))

    @property
    def vertical_motion(self) -> "GroundMotion":
        """The vertical component as a motion of its own, for its measures: ``motion.vertical_motion.sa(0.1)``.

        Its metadata say that it is vertical, so that it cannot be used as a horizontal motion.

        Raises
        ------
        InputError
            If there is no vertical component.
        """
        if self.vertical is None:
            raise InputError(
                f"The motion {shown(self.name)} has no vertical component. Give one: "
                "read_motion(path, vertical=...), or motion.with_vertical(...)."
            )
        known = record_info_of(self)
        info = replace(known, component=None, direction="vertical", source=known.vertical_source, vertical_source=None)
        return GroundMotion(self.vertical, self.dt, self.name, info)

    def vertical_ratio(self, periods: ArrayLike, damping_ratio: float = 0.05) -> Array:
        """Vertical over horizontal pseudo-acceleration, V/H, at periods (s) as in `spectrum`.

        At a period of zero it is PVA/PGA. It is NaN where the horizontal component does not move.

        Raises
        ------
        InputError
            If there is no vertical component, or as for `spectrum`.
        """
        upwards, along = self.vertical_motion.spectrum(periods, damping_ratio), self.spectrum(periods, damping_ratio)
        return np.divide(upwards.sa, along.sa, out=np.full(along.sa.size, math.nan), where=along.sa > 0)

    def with_vertical(self, vertical: "GroundMotion | ArrayLike") -> "GroundMotion":
        """Return the motion with this vertical component, in place of any other.

        Parameters
        ----------
        vertical : GroundMotion or array_like, shape (n,)
            A motion, such as a record read from the file of the vertical component, or samples in m/s², positive
            upwards. Both components start at the same instant. If one motion is shorter, zeros are appended to it,
            since components of one recording often differ by a few samples. A record known to be positive downwards
            (DWN, DN or DOWN; see `RecordInfo.direction`) is reversed.

        Returns
        -------
        GroundMotion
            Both components. `RecordInfo.vertical_source` names the vertical record.

        Raises
        ------
        InputError
            If the time steps differ, samples differ in number from those of the motion, the given motion is known to be
            horizontal or itself has a vertical component, or this motion is known to be vertical.

        Warns
        -----
        RecordWarning
            If two motions differ in length by more than 1 s.

        Examples
        --------
        >>> import rockflex as rf
        >>> along = rf.GroundMotion([0.0, 2.0, -1.0, 0.0], dt=0.01)
        >>> upwards = rf.GroundMotion([0.0, 0.5, 0.0], dt=0.01)
        >>> along.with_vertical(upwards).vertical.tolist()
        [0.0, 0.5, 0.0, 0.0]
        """
        if is_vertical_component(self):
            raise InputError(
                f"{shown(self.name)} is itself a vertical component according to the header or name of the file. Give "
                "the horizontal one first: horizontal.with_vertical(vertical)."
            )
        if not isinstance(vertical, GroundMotion):
            return GroundMotion(self.acceleration, self.dt, self.name, self.metadata, vertical)
        if vertical.vertical is not None:
            raise InputError(
                f"{shown(vertical.name)} has a vertical component of its own. Give one of both: "
                "with_vertical(other.vertical_motion) or with_vertical(other.without_vertical())."
            )
        sign, info = _vertical_sign_and_info(vertical, self.metadata)
        along, upwards = _aligned_components(self, vertical)
        return GroundMotion(along, self.dt, self.name, info, sign * upwards)

    def without_vertical(self) -> "GroundMotion":
        """Return the horizontal component alone."""
        info = None if self.metadata is None else replace(self.metadata, vertical_source=None)
        return GroundMotion(self.acceleration, self.dt, self.name, info)

    def scaled(self, factor: float) -> "GroundMotion":
        """Return the motion multiplied by `factor` (negative to reverse it), with the same name.

        `RecordInfo.scale` of the result is the factor on the motion as it was recorded.

        Raises
        ------
        InputError
            If `factor` or a scaled sample is not finite.
        """
        factor = checked_finite("factor", factor, "")
        with np.errstate(over="ignore"):
            return self._changed(lambda samples: samples * factor, metadata=_scaled_record_info(self.metadata, factor))

    def scaled_to(
        self,
        target: _spectra.TargetSpectrum | None = None,
        periods: ArrayLike | None = None,
        *,
        sa: float | None = None,
        period: float | None = None,
        damping_ratio: float | None = None,
    ) -> "GroundMotion":
        """Return the motion scaled to `sa` (m/s²) at `period` (s), for 5 % damping or `damping_ratio`, or to a target.

        ``scaled_to(target, (0.2, 2.0))`` fits a `TargetSpectrum` with the least mean square of ln(S_a/target) over
        `periods`, as in `Suite.select`. `InputError` where neither, or both, are given, or the motion does not move.
        """
        if target is not None and periods is not None and sa is None and period is None and damping_ratio is None:
            fitted = checked_instance("target", target, _spectra.TargetSpectrum)
            compared = _spectra.comparison_periods(periods)
            spectrum = self.spectrum(compared, fitted.damping_ratio).sa
            return self.scaled(_spectra.spectrum_fitting_factor(spectrum, fitted.at(compared), self.name))
        if sa is None or period is None or target is not None or periods is not None:
            raise InputError(
                "scaled_to needs either a target and periods, or sa and period, with damping_ratio if it is not 0.05: "
                "motion.scaled_to(target, (0.2, 2.0)) or motion.scaled_to(sa=5.0, period=1.0). A target has its own "
                "damping ratio."
            )
        ordinate, at = checked_positive("sa", sa, "m/s²"), checked_positive("period", period, "s", zero=True)
        own = self.sa(at, 0.05 if damping_ratio is None else damping_ratio)
        return self.scaled(ordinate / _spectra.scalable_spectral_ordinate(own, self.name, at))

    def refined(self, k: int) -> "GroundMotion":
        """Return the same piecewise linear function with every interval split into `k` equal ones.

        Raises
        ------
        InputError
            If `k` is not a whole number of at least 1.
        """
        return self._changed(lambda samples: _signal.refine_samples(samples, k), k)

    def resampled(self, dt: float) -> "GroundMotion":
        """Return the same piecewise linear function sampled at the finer step `dt` (s).

        The function stays unchanged only if the present step is a whole multiple of `dt` (within 1e-9), so other
        steps are rejected; the new step is the present one divided by that whole number.

        Raises
        ------
        InputError
            If the present step is not a whole multiple of `dt`; the error suggests the nearest valid steps.
        """
        return self.refined(_signal.refinement_factor(self.dt, dt))

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

        Raises
        ------
        InputError
            If `degree` is negative, not whole, or too high for the number of samples.
        """
        return self._changed(lambda samples: _signal.correct_baseline(samples, self.dt, degree))

    def band_passed(self, low: float, high: float, order: int = 4) -> "GroundMotion":
        """Return the motion filtered by a Butterworth band-pass, forwards and backwards.

        The two passes cancel the phase shift and double the order; at a corner the amplitude is halved.

        Parameters
        ----------
        low, high : float
            Corner frequencies in Hz, 0 < low < high < 1/(2 dt).
        order : int
            Order of the filter of one pass.

        Raises
        ------
        InputError
            If the corners are not in order below the Nyquist frequency, the order is not a whole positive
            number, or the record is too short for the filter.
        """
        return self._changed(lambda samples: _signal.band_pass_filter(samples, self.dt, low, high, order))

    def _changed(
        self, change: Callable[[Array], Array], k: int = 1, metadata: RecordInfo | None = None
    ) -> "GroundMotion":
        """Return the motion with both components changed alike; the new step is 1/k of the present one."""
        upwards = None if self.vertical is None else change(self.vertical)
        return GroundMotion(change(self.acceleration), self.dt / k, self.name, metadata or self.metadata, upwards)


def _scaled_record_info(info: RecordInfo | None, factor: float) -> RecordInfo | None:
    """Return the metadata of a motion multiplied by a factor; None if they stay as they are."""
    if factor == 1.0:
        return None
    before = info or RecordInfo()
    scale = factor if before.scale is None else factor * before.scale
    return replace(before, scale=None if scale == 1.0 else scale)


def _checked_vertical_samples(vertical: ArrayLike, n_samples: int) -> Array:
    """Return the vertical samples, as many as the horizontal ones."""
    samples = checked_finite_vector("vertical", vertical, "m/s²")
    if samples.size != n_samples:
        raise InputError(
            f"vertical must have as many samples as acceleration, {n_samples}, but {samples.size} were given. Append "
            "zeros to the shorter one; motion.with_vertical(GroundMotion(vertical, dt)) does this.",
            field="vertical",
        )
    return samples


def _vertical_sign_and_info(vertical: GroundMotion, info: RecordInfo | None) -> tuple[int, RecordInfo | None]:
    """Return the sign that makes a vertical record positive upwards, and the metadata with its source."""
    given = record_info_of(vertical)
    if given.direction == "horizontal":
        raise InputError(
            f"A vertical ground motion is expected, but {shown(vertical.name)} is a horizontal component according to "
            "the header of the file. Give the vertical component (UP, V, UD or DWN). If it is one, declare it: "
            'dataclasses.replace(motion, metadata=RecordInfo(direction="vertical")).',
            field="vertical",
        )
    sign, note = (-1, " (reversed: it is positive downwards)") if given.direction == "down" else (1, "")
    source = vertical.name or given.source
    return sign, info if source is None else replace(info or RecordInfo(), vertical_source=f"{source}{note}")


def _aligned_components(along: GroundMotion, upwards: GroundMotion) -> tuple[Array, Array]:
    """Return the samples of both components of a motion, with zeros after the end of the shorter one."""
    if abs(along.dt - upwards.dt) > 1e-9 * along.dt:
        finer = min(along.dt, upwards.dt)
        raise InputError(
            f"Both components need the same time step, but the horizontal one has dt = {along.dt:g} s and the vertical "
            f"one {upwards.dt:g} s. Resample the coarser one, for example with motion.resampled({finer:g}), before "
            "horizontal.with_vertical(vertical).",
            field="vertical",
        )
    longest = max(along.acceleration.size, upwards.acceleration.size)
    if abs(along.duration - upwards.duration) > MAX_LENGTH_DIFFERENCE:
        warnings.warn(
            translated(
                "The motion {name} lasts {duration} s, and its vertical component {vertical} s; zeros were appended to "
                "the shorter one. Make sure that both start at the same instant.",
                name=shown(along.name),
                duration=f"{along.duration:g}",
                vertical=f"{upwards.duration:g}",
            ),
            RecordWarning,
            stacklevel=3,
        )
    first, second = (np.pad(each.acceleration, (0, longest - each.acceleration.size)) for each in (along, upwards))
    return first, second


def record_info_of(motion: GroundMotion) -> RecordInfo:
    """Return what is known about a motion."""
    return motion.metadata or RecordInfo()


def is_vertical_component(motion: GroundMotion) -> bool:
    """Return whether a motion is known to be a vertical component."""
    return record_info_of(motion).is_vertical


def check_horizontal_component(*motions: GroundMotion) -> None:
    """Raise an InputError if a vertical component would be applied horizontally."""
    vertical = [repr(motion.name) for motion in motions if is_vertical_component(motion)]
    if vertical:
        raise InputError(
            f"A horizontal ground motion is expected, but {first_texts_shown(vertical, 3)} "
            f"{'is a vertical component' if len(vertical) == 1 else 'are vertical components'} according to the header "
            "or name of the file. Give a horizontal component. If it is one, declare it: dataclasses.replace(motion, "
            'metadata=RecordInfo(direction="horizontal")), or rename the file.'
        )
