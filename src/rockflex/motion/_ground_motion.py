"""Ground acceleration, linear between its samples."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite, finite_vector, positive
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion import _processing, _vertical
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._samples import Samples
from rockflex.motion._scaling import factor_to
from rockflex.motion._shown_motion import ShownMotion
from rockflex.motion._target import TargetSpectrum


@dataclass(frozen=True, eq=False, init=False, repr=False)
class GroundMotion(ShownMotion, Samples):
    """A ground acceleration sampled at equal steps and linear between samples.

    The ground is at rest before t = 0, the time of the first sample; after the last sample the
    acceleration is zero. Every measure is exact for this piecewise linear function, including peaks between
    samples, and covers the time from the first sample to the last.

    The ground may also move vertically. All measures are those of the horizontal component, unless their name says
    otherwise; those of the vertical one are those of `vertical_motion`. What changes a motion, such as `scaled`,
    changes both components.

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
    >>> motion = rf.GroundMotion(3.0 * np.sin(2.0 * np.pi * t), dt=0.01, name="sine")
    >>> motion
    GroundMotion('sine', 201 samples, dt=0.01 s, duration=2 s, pga=3 m/s²)
    >>> round(motion.scaled(2.0).pgv, 3)
    1.909
    >>> both = rf.GroundMotion([0.0, 2.0, 0.0], dt=0.01, vertical=[0.0, 0.0, -1.5])
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
        upwards = None if vertical is None else _vertical.checked(vertical, samples.size)
        step = positive("dt", dt, "s")
        vars(self).update(acceleration=samples, dt=step, name=name, metadata=metadata, vertical=upwards)

    def __repr__(self) -> str:
        upwards = "" if self.vertical is None else f", pva={self.pva:.4g} m/s²"
        return (
            f"GroundMotion({self.name!r}, {self.acceleration.size} samples, dt={self.dt:g} s, "
            f"duration={self.duration:g} s, pga={self.pga:.4g} m/s²{upwards})"
        )

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
        return GroundMotion(
            _vertical.known(self.name, self.vertical), self.dt, self.name, _vertical.info_alone(self.metadata)
        )

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
        if self.metadata is not None and self.metadata.is_vertical:
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
        sign, info = _vertical.info_of_both(vertical.name, vertical.metadata, self.metadata)
        along, upwards = _vertical.aligned(self.name, self, vertical)
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
        factor = finite("factor", factor, "")
        with np.errstate(over="ignore"):
            return self._changed(lambda samples: samples * factor, metadata=_scaled_info(self.metadata, factor))

    def scaled_to(
        self,
        target: TargetSpectrum | None = None,
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
        return self.scaled(factor_to(self, self.name, target, periods, sa, period, damping_ratio))

    def refined(self, k: int) -> "GroundMotion":
        """Return the same piecewise linear function with every interval split into `k` equal ones.

        Raises
        ------
        InputError
            If `k` is not a whole number of at least 1.
        """
        return self._changed(lambda samples: _processing.refine(samples, k), k)

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
        return self._changed(lambda samples: _processing.baseline_correct(samples, self.dt, degree))

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
        return self._changed(lambda samples: _processing.band_pass(samples, self.dt, low, high, order))

    def _changed(
        self, change: Callable[[Array], Array], k: int = 1, metadata: RecordInfo | None = None
    ) -> "GroundMotion":
        """Return the motion with both components changed alike; the new step is 1/k of the present one."""
        upwards = None if self.vertical is None else change(self.vertical)
        return GroundMotion(change(self.acceleration), self.dt / k, self.name, metadata or self.metadata, upwards)


def _scaled_info(info: RecordInfo | None, factor: float) -> RecordInfo | None:
    """Return the metadata of a motion multiplied by a factor; None if they stay as they are."""
    if factor == 1.0:
        return None
    before = info or RecordInfo()
    scale = factor if before.scale is None else factor * before.scale
    return replace(before, scale=None if scale == 1.0 else scale)
