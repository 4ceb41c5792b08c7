"""The histories beside the structures, with a cursor that moves along them."""

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from rockflex._arrays import Array
from rockflex.plot._curves import Curve
from rockflex.plot._history import shade_uplifts
from rockflex.plot._panel import Quantity, draw_curves, scale_of
from rockflex.plot._style import GRAY, SHADE
from rockflex.plot.animation._clock import Clock

_FADED = 0.62  # of white over what is still to come


class Chart:
    """One panel for each quantity; what is still to come is faded, and dots mark the present values."""

    def __init__(self, grid: list[Axes], quantities: Sequence[Quantity], curves: list[Curve], clock: Clock) -> None:
        self._clock = clock
        self.handles: list[Artist] = []
        self.names = [curve.label for curve in curves]
        for axes, quantity in zip(grid, quantities, strict=True):
            self.handles, _ = draw_curves(axes, quantity, curves)
        main = shade_uplifts(grid, curves)
        if main is not None:
            self.handles = [*self.handles, Patch(facecolor=SHADE, edgecolor=GRAY, linewidth=0.4)]
            self.names.append(f"uplifted: {main.label}" if len(curves) > 1 else "uplifted")
        grid[-1].set_xlabel("time [s]")
        self._end = float(clock.times[-1])
        grid[-1].set_xlim(float(clock.times[0]), self._end)
        self._later = [_cover(axes) for axes in grid]
        self._cursors = [axes.axvline(0.0, color="black", linewidth=0.9, animated=True) for axes in grid]
        self._dots: list[tuple[Line2D, Array]] = []
        for axes, quantity in zip(grid, quantities, strict=True):
            factor, _, _ = scale_of(quantity, curves)
            for curve in curves:
                self._dots.append(_dot(axes, curve, _values(quantity, curve, clock) / factor))

    @property
    def moving(self) -> list[Artist]:
        """What is drawn anew in each frame, from the back to the front."""
        return [*self._later, *self._cursors, *(dot for dot, _ in self._dots)]

    def show(self, frame: int) -> None:
        """Move the cursor to the time of a frame."""
        time = float(self._clock.times[frame])
        for cover in self._later:
            cover.set(x=time, width=max(self._end - time, 0.0))
        for cursor in self._cursors:
            cursor.set_xdata([time, time])
        for dot, values in self._dots:
            dot.set_data(np.full(values.shape[1], time), values[frame])


def _values(quantity: Quantity, curve: Curve, clock: Clock) -> Array:
    """Return a quantity at the frames, shape (k, n); after the end of the response it has no value."""
    known = curve.history.time
    values = quantity.of(curve.history.at(np.clip(clock.times, known[0], known[-1])))
    return np.where((clock.times <= known[-1])[:, None], values.reshape(clock.times.size, -1), np.nan)


def _cover(axes: Axes) -> Rectangle:
    shape = Rectangle(
        (0.0, 0.0), 1.0, 1.0, transform=axes.get_xaxis_transform(), facecolor="white", alpha=_FADED, linewidth=0.0,
        animated=True,
    )  # fmt: skip
    axes.add_patch(shape)
    return shape


def _dot(axes: Axes, curve: Curve, values: Array) -> tuple[Line2D, Array]:
    (dot,) = axes.plot([], [], "o", color=curve.look.color, markersize=4.5, markeredgecolor="white",
                       markeredgewidth=0.6, animated=True)  # fmt: skip
    return dot, values
