"""The instants of the frames of an animation, and how long each is shown."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._checks import finite, positive, real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.plot._curves import Curve

MOST_FRAMES = 20_000
LAST = 100  # hundredths of a second for which the last frame stays: a fall must be seen before all begins anew
RATES = {".gif": (1.0, 50.0), ".mp4": (1.0, 120.0)}
"""Frames per second that a file may have: viewers of GIF slow down what is faster."""


@dataclass(frozen=True, eq=False)
class Clock:
    """The instants of the response in s that the frames show, shape (k,), and the frames per second."""

    times: Array
    speed: float
    frames_per_second: float

    @property
    def hundredths(self) -> NDArray[np.intp]:
        """Time for which each frame is shown in 1/100 s, shape (k,); rounding errors do not add up."""
        ends = np.round(100.0 / self.frames_per_second * np.arange(self.times.size + 1))
        return np.diff(ends).astype(int)


def clock_of(
    curves: Sequence[Curve],
    suffix: str,
    speed: float,
    frames_per_second: float,
    start: float | None,
    stop: float | None,
) -> Clock:
    """Return the frames of an animation in a file with some suffix; the arguments are those of `animate`.

    Raises
    ------
    InputError
        If one is out of range, or there would be too many frames.
    """
    pace = positive("speed", speed, "seconds of the response per second of the animation")
    low, high = RATES[suffix]
    rate = real_or_nan(frames_per_second)
    if not low <= rate <= high:
        more = ", or write .mp4" if suffix == ".gif" and rate > high else ""
        raise InputError(
            f"frames_per_second must be from {low:g} to {high:g} for {suffix}, but {shown(frames_per_second)} was "
            f"given. Give 25, which is smooth{more}.",
            field="frames_per_second",
        )
    first = min(float(curve.history.time[0]) for curve in curves)
    last = max(float(curve.history.time[-1]) for curve in curves)
    begin = first if start is None else finite("start", start, "s")
    end = last if stop is None else finite("stop", stop, "s")
    if not first <= begin < end <= last:
        raise InputError(
            f"start and stop must be times within the responses, from {first:g} to {last:g} s, start before stop, but "
            f"{begin:g} and {end:g} s were given.",
            field="start",
        )
    step = pace / rate
    count = (end - begin) / step
    if count > MOST_FRAMES:
        raise InputError(
            f"{end - begin:g} s at speed {pace:g} and {rate:g} frames per second are {count:.3g} frames, above the "
            f"limit of {MOST_FRAMES}. Raise the speed, lower frames_per_second, or give start and stop.",
            field="speed",
        )
    times = np.asarray(begin + step * np.arange(int(count * (1.0 + 1e-12)) + 1), np.float64)
    if end - times[-1] > 0.25 * step:
        times = np.append(times, end)
    times[-1] = end  # where a fall ends
    return Clock(times, pace, rate)
