"""The picture of an animation: drawn once where nothing moves, and frame by frame where something does."""

from collections.abc import Generator, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rockflex.plot._curves import Curve
from rockflex.plot._panel import Quantity, add_key
from rockflex.plot._style import new_figure, styled
from rockflex.plot.animation._chart import Chart
from rockflex.plot.animation._clock import Clock
from rockflex.plot.animation._poses import Poses
from rockflex.plot.animation._stage import Stage

Picture = NDArray[np.uint8]
"""Red, green and blue of every pixel, shape (height, width, 3)."""

INCHES = 9.6  # width of the figure: letters grow with the number of pixels
BESIDE = 2  # structures that are drawn to the left of the histories; more are drawn above them
_LETTERS = 110  # in a row of the legend


class Scene:
    """The figure of an animation and what moves in it."""

    def __init__(
        self, curves: list[Curve], poses: Sequence[Poses], quantities: Sequence[Quantity], clock: Clock,
        amplification: float, title: str | None, width: int,
    ) -> None:  # fmt: skip
        with styled():
            self._figure, axes, grid = _layout(len(curves), len(quantities), width)
            chart = Chart(grid, quantities, curves, clock)
            add_key(self._figure, curves, chart.handles, chart.names, title, _LETTERS)
            self._canvas = FigureCanvasAgg(self._figure)
            self._figure.draw_without_rendering()  # so that the places are known
            self._figure.set_layout_engine("none")
            stage = Stage(axes, curves, poses, clock, amplification)
            self._parts = stage, chart
            self._moving: list[tuple[Axes, Artist]] = [
                (_axes(each), each) for part in self._parts for each in part.moving
            ]
            self._canvas.draw()
            self._still = self._canvas.copy_from_bbox(self._figure.bbox)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        width, height = self._canvas.get_width_height()
        return width, height

    def picture(self, frame: int) -> Picture:
        """Return a frame."""
        with styled():
            self._canvas.restore_region(self._still)
            for part in self._parts:
                part.show(frame)
            for axes, each in self._moving:
                axes.draw_artist(each)
            return np.asarray(self._canvas.buffer_rgba())[:, :, :3].copy()

    def pictures(self, count: int) -> Generator[Picture]:
        """Yield the first frames, one after the other."""
        for frame in range(count):
            yield self.picture(frame)


def _axes(artist: Artist) -> Axes:
    axes = artist.axes
    assert isinstance(axes, Axes)  # everything that moves was added to axes
    return axes


def _layout(models: int, panels: int, width: int) -> tuple[Figure, Axes, list[Axes]]:
    """Return a figure, the axes of the stage and those of the panels; both numbers of pixels are even, for H.264."""
    beside = models <= BESIDE
    inches = max(4.8, 1.35 * panels + 1.1) if beside else 3.3 + 1.2 * panels + 0.9
    dpi = width / INCHES
    pixels = 2 * (width // 2), 2 * round(0.5 * inches * dpi)
    figure = new_figure(*((each + 1e-3) / dpi for each in pixels))
    figure.set_dpi(dpi)
    if beside:
        cells = figure.add_gridspec(panels, 2, width_ratios=(0.42, 0.58) if models == 1 else (0.5, 0.5))
        stage, places = figure.add_subplot(cells[:, 0]), [cells[row, 1] for row in range(panels)]
    else:
        cells = figure.add_gridspec(panels + 1, 1, height_ratios=(3.3, *([1.2] * panels)))
        stage, places = figure.add_subplot(cells[0, 0]), [cells[row + 1, 0] for row in range(panels)]
    grid: list[Axes] = []
    for place in places:
        grid.append(figure.add_subplot(place, sharex=grid[0] if grid else None))
    for axes in grid[:-1]:
        axes.tick_params(labelbottom=False)
    stage.set_axis_off()
    figure.align_ylabels(grid)
    return figure, stage, grid
