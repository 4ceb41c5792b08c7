"""The picture of an animation: still parts drawn once, structures and histories drawn frame by frame."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon, Rectangle
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.language import translated
from rockflex.plot import _figures as figures
from rockflex.plot import _history as histories
from rockflex.plot._history import PanelQuantity, ResponseCurve
from rockflex.plot.animation._poses import (
    FrameTiming,
    StructurePoses,
    default_amplification,
    outline_of_response,
    structure_poses,
)
from rockflex.structure._outline import ELEMENT_COLORS, SYMBOLS, Stroke

Polyline = Sequence[tuple[float, float]]

SPRING, SPRING_FREE = "#64748b", "#a9b1bb"
DARK_RED = "#b3261e"
_MAX_WIDE_SPRINGS = 4
_WIDTH = 0.75  # points of a pixel
_AT_REST = "#c9ced6"
HEAD, FOOT, EDGE = 34.0, 40.0, 8.0  # points above, below and beside the structures
_NARROW, _LINE = 230.0, 11.0  # points in which time and scale have room beside each other, and of a line
MIN_SPRING, MAX_SPRING = 14.0, 60.0  # points of a spring that is unloaded
_MAX_FRAMES_SEARCHED = 200  # of which the extent of a structure is taken
_ASIDE = 1.8  # reach to one side over that to the other, beyond which a structure is not drawn in the middle
_INK = "#404040"
_STILL = 1e-9  # speed of a response, at which no impact is marked after its instant
_FADING = 0.62  # opacity of white over times after the cursor
Picture = NDArray[np.uint8]
"""Red, green and blue of every pixel, shape (height, width, 3)."""

INCHES = 9.6  # width of the figure: letters grow with the number of pixels
MAX_BESIDE = 2  # structures that are drawn to the left of the histories; more are drawn above them


def symbol_lines(name: str, length: float, across: float = 0.8) -> list[Polyline]:
    """Return the lines of a symbol of a length as (across, along) in points."""
    return [[(across * u, length * share) for u, share in points] for points, *_ in SYMBOLS[name]]


def lines_between_points(lines: Sequence[Polyline], start: Array, end: Array) -> tuple[Array, Array]:
    """Return x and y of lines of (across, along) laid from one point to another, with gaps between them."""
    direction = end - start
    along = direction / (float(np.hypot(*direction)) or 1.0)
    across = np.array([along[1], -along[0]])
    return joined_polylines([start + np.outer([u for u, _ in line], across) + np.outer([v for _, v in line], along)
                   for line in lines])  # fmt: skip


def joined_polylines(lines: Sequence[Array]) -> tuple[Array, Array]:
    """Return x and y of several lines, each of shape (k, 2), with gaps between them."""
    if not lines:
        return np.empty(0), np.empty(0)
    gap = np.full((1, 2), np.nan)
    points = np.concatenate([part for line in lines for part in (line, gap)])
    return points[:, 0], points[:, 1]


def structure_state_text(curve: ResponseCurve, poses: StructurePoses, frame: int, time: float) -> tuple[str, str]:
    """Return the state of a structure in a frame, such as "uplifted", and the colour of the words."""
    end = float(curve.history.time[-1])
    if curve.overturned and time >= end:
        return translated("overturned at {time} s", time=f"{end:.2f}"), DARK_RED
    if curve.falls and time >= float(curve.history.time[curve.before_fall][-1]):
        return translated("falling"), DARK_RED
    if time > end:
        return translated("ends at {time} s", time=f"{end:.2f}"), figures.GRAY
    if not poses.lifts:
        return translated("fixed base"), figures.GRAY
    if poses.sprung and poses.rise[frame].min() > 0.0:
        return translated("off the ground"), figures.BLUE
    if poses.impact[frame] and not poses.uplifted[frame]:
        return translated("impact"), figures.RED
    words = {translated("uplifted"): poses.uplifted[frame], translated("sliding"): poses.sliding[frame]}
    texts = [word for word, holds in words.items() if holds]
    return (", ".join(texts), figures.BLUE) if texts else (translated("in contact"), figures.GRAY)


class MetresToStagePoints(NamedTuple):
    """From metres to the points of the stage: middle of the cell, level of the base at rest, ground, points per m."""

    middle: float
    level: float
    ground: float
    zoom: float

    def __call__(self, points: tuple[Array, Array]) -> tuple[Array, Array]:
        """Return x and y in points."""
        return self.middle + self.zoom * points[0], self.level + self.zoom * points[1]


class StructureArtists:
    """The artists of one structure; `show` moves them to a frame.

    Elements are in the colours of their kinds, or in given ones.
    """

    def __init__(
        self,
        axes: Axes,
        poses: StructurePoses,
        color: str,
        here: MetresToStagePoints,
        amplification: float,
        element_colors: Sequence[str] = (),
    ) -> None:
        self._poses, self._here, self._by = poses, here, amplification
        self._sunk = (here.level - here.ground) / here.zoom
        self._elements = poses.outline.elements if poses.lifts else ()
        self._colors = element_colors or [ELEMENT_COLORS[symbol] for symbol, _ in self._elements]
        strokes = poses.outline.strokes
        for points, *_ in strokes:
            axes.plot(*here((points[:, 0], points[:, 1])), color=_AT_REST, linewidth=0.8)
        self._gap = _animated_area(axes, facecolor=figures.RED, alpha=0.25, linewidth=0.0)
        self._free = _animated_line(axes, SPRING_FREE, 1.0)
        self._pressed = _animated_line(axes, SPRING, 1.2)
        self._filled = [(_animated_area(axes, facecolor=figures.SHADE), each.points) for each in strokes if each.filled]
        self._body = [
            (_animated_line(axes, color, _WIDTH * width, capstyle="butt"), _joined_strokes(strokes, width))
            for width in sorted({each.width for each in strokes})
        ]
        self._element_lines = {each: _animated_line(axes, each, 1.3) for each in dict.fromkeys(self._colors)}
        self._impacts = _animated_line(
            axes, figures.RED, 0.0, marker="o", markersize=11.0, markerfacecolor="none", markeredgewidth=1.8
        )

    @property
    def moving(self) -> list[Artist]:
        """Artists that are redrawn in each frame, from the back to the front."""
        body = [line for line, _ in (*self._filled, *self._body)]
        parts = (self._gap, self._free, self._pressed, *body)
        return [*parts, *self._element_lines.values(), self._impacts]

    def show(self, frame: int) -> None:
        """Move the lines to where they are in a frame."""
        poses, by = self._poses, self._by
        for area, points in self._filled:
            area.set_xy(np.column_stack(self._here(poses.moved(frame, points, by))))
        for line, points in self._body:
            line.set_data(*self._here(poses.moved(frame, points, by, self._sunk)))
        base = poses.base(frame, by)
        if poses.sprung:
            self._show_springs(frame)
        else:
            gap = self._here((np.append(base[0], base[0][::-1]), np.append(base[1], [0.0, 0.0])))
            self._gap.set_xy(np.column_stack(gap))
        self._show_elements(frame)
        edges = self._here((np.array([poses.outline.left, poses.outline.right]) + by * poses.slip[frame], np.zeros(2)))
        self._impacts.set_data(*(edges if poses.impact[frame] else ([], [])))

    def _show_springs(self, frame: int) -> None:
        """Draw the springs from the ground to the base; without contact they have their full length and are lighter."""
        poses, (middle, rest, ground, zoom) = self._poses, self._here
        half = 2.2 if poses.springs.size > _MAX_WIDE_SPRINGS else 4.0
        ends = poses.place(frame, poses.springs, np.zeros(poses.springs.size), self._by)
        across, up = middle + zoom * ends[0], rest + zoom * ends[1]
        lines: dict[bool, list[Array]] = {False: [], True: []}
        for x, y in zip(across, up, strict=True):
            free = bool(y > rest)
            (turns,) = symbol_lines("spring", max((rest if free else y) - ground, 1.0), half)
            lines[free].append(np.array(turns) + np.array([x, ground]))
        self._pressed.set_data(*joined_polylines(lines[False]))
        self._free.set_data(*joined_polylines(lines[True]))

    def _show_elements(self, frame: int) -> None:
        parts: dict[str, list[Array]] = {color: [] for color in self._element_lines}
        for (symbol, ends), color in zip(self._elements, self._colors, strict=True):
            start, end = np.column_stack(self._here(self._poses.moved(frame, ends, self._by, self._sunk)))
            lines = symbol_lines(symbol, float(np.hypot(*(end - start))))
            parts[color].append(np.column_stack(lines_between_points(lines, start, end)))
        for color, lines in parts.items():
            self._element_lines[color].set_data(*joined_polylines(lines))


def _joined_strokes(strokes: Sequence[Stroke], width: float) -> Array:
    """Return the points of the strokes of a width, shape (k, 3), with gaps between them."""
    gap = np.full((1, 3), np.nan)
    return np.concatenate([part for each in strokes if each.width == width for part in (each.points, gap)])


def _animated_line(axes: Axes, color: str, width: float, *, capstyle: Any = "round", **more: Any) -> Line2D:
    """Return an empty line that is drawn anew in each frame."""
    style: dict[str, Any] = {
        "solid_capstyle": capstyle,
        "solid_joinstyle": "round",
        "linestyle": "-" if width else "none",
    }
    (line,) = axes.plot([], [], color=color, linewidth=width or 1.0, animated=True, **(style | more))
    return line


def _animated_area(axes: Axes, **style: Any) -> Polygon:
    """Return an area that is drawn anew in each frame."""
    area = Polygon(np.zeros((4, 2)), animated=True, **style)
    axes.add_patch(area)
    return area


class StructurePanel:
    """One cell for each response over a common ground; the axes' coordinates are points of 1/72 inch."""

    def __init__(
        self,
        axes: Axes,
        curves: Sequence[ResponseCurve],
        poses: Sequence[StructurePoses],
        timing: FrameTiming,
        amplification: float,
    ) -> None:
        self._timing, self._curves, self._poses = timing, curves, poses
        self._turn = figures.axis_unit("rotation", usual="mrad")
        width, height = np.asarray(axes.get_window_extent().size) * (72.0 / axes.figure.dpi)
        axes.set(xlim=(0.0, width), ylim=(0.0, height))
        cell, narrow = width / len(curves), width < _NARROW
        head = HEAD + _LINE * narrow
        extents = [structure_extent(each, amplification) for each in poses]
        sprung = any(each.sprung for each in poses)
        zoom, depth = _stage_zoom(extents, cell - 2.0 * EDGE, height - head - FOOT, sprung=sprung)
        self._structures: list[StructureArtists] = []
        self._texts: list[tuple[Artist, Artist]] = []
        for place, (curve, each, extent) in enumerate(zip(curves, poses, extents, strict=True)):
            middle = cell * (place + 0.5)
            draw_stage_ground(axes, FOOT, middle - 0.5 * cell + EDGE, middle + 0.5 * cell - EDGE)
            here = MetresToStagePoints(
                middle - zoom * extent.middle, FOOT + (depth if each.sprung else 0.0), FOOT, zoom
            )
            self._structures.append(StructureArtists(axes, each, curve.style.color, here, amplification))
            axes.text(
                middle, height - head + 8.0, curve.label, color=curve.style.color, ha="center", weight="bold",
                fontsize=9.0, wrap=False,
            )  # fmt: skip
            state = axes.text(middle, 17.0, "", ha="center", fontsize=8.0, animated=True)
            number = axes.text(middle, 5.0, "", ha="center", fontsize=figures.SMALL, color=_INK, animated=True)
            self._texts.append((state, number))
        self._time = axes.text(EDGE, height - 10.0, "", fontsize=9.0, color="black", animated=True)
        axes.text(
            EDGE if narrow else width - EDGE,
            height - 10.0 - _LINE * narrow,
            animation_scales_text(amplification, timing.speed),
            ha="left" if narrow else "right",
            fontsize=8.0,
            color=_INK,
        )

    @property
    def moving(self) -> list[Artist]:
        """Artists that are redrawn in each frame, from the back to the front."""
        texts = [each for pair in self._texts for each in pair]
        return [part for structure in self._structures for part in structure.moving] + texts + [self._time]

    def show(self, frame: int) -> None:
        """Move everything to where it is in a frame."""
        time = float(self._timing.times[frame])
        self._time.set(text=f"t = {time:.2f} s")
        for structure, curve, poses, (state, number) in zip(
            self._structures, self._curves, self._poses, self._texts, strict=True
        ):
            structure.show(frame)
            text, color = structure_state_text(curve, poses, frame, time)
            state.set(text=text, color=color)
            digits = 2 if self._turn.name == "mrad" else 4
            rotation = f"{poses.rotation[frame] / self._turn.size:.{digits}f}".replace("-", "−")
            number.set(text=f"θ = {rotation} {self._turn.name}" if poses.lifts else "")


def draw_structures_at(
    axes: Axes, curves: Sequence[ResponseCurve], structures: Sequence[Any | None], time: float
) -> None:
    """Draw the structures of some responses side by side as they stood at an instant; the axes keep their place."""
    timing = FrameTiming(np.array([time]), 1.0, 1.0)
    outlines = [
        outline_of_response(curve.history, structure, place)
        for place, (curve, structure) in enumerate(zip(curves, structures, strict=True))
    ]
    poses = [
        structure_poses(curve, outline, timing.times, _STILL) for curve, outline in zip(curves, outlines, strict=True)
    ]
    axes.set_axis_off()
    panel = StructurePanel(axes, curves, poses, timing, default_amplification(curves, poses))
    panel.show(0)
    for part in panel.moving:
        part.set_animated(False)


def animation_scales_text(amplification: float, speed: float) -> str:
    """Say how displacements and time are enlarged."""
    size = translated("displacements × {factor}", factor=f"{amplification:g}")
    size = translated("true displacements") if amplification == 1.0 else size
    return size if speed == 1.0 else f"{size}, {translated('speed × {factor}', factor=f'{speed:g}')}"


class StructureExtent(NamedTuple):
    """Extent of a structure in m: to the left and right of its axis, upwards, and below its unloaded springs."""

    left: float
    right: float
    up: float
    sunk: float

    @property
    def middle(self) -> float:
        """Middle of the cell: the axis of the masses, unless the structure falls to one side."""
        aside = max(self.left, self.right) > _ASIDE * min(self.left, self.right)
        return 0.5 * (self.right - self.left) if aside else 0.0

    @property
    def width(self) -> float:
        """Width about the middle."""
        return 2.0 * max(self.right - self.middle, self.left + self.middle)


def _stage_zoom(
    extents: Sequence[StructureExtent], width: float, height: float, *, sprung: bool
) -> tuple[float, float]:
    """Return the points per metre that keep everything in its cell, and the points below the unloaded springs."""
    up = max(extent.up for extent in extents)
    zoom = min(width / max(extent.width for extent in extents), height / up)
    if not sprung:
        return zoom, 0.0
    depth = min(MAX_SPRING, MIN_SPRING + zoom * max(extent.sunk for extent in extents))
    return min(zoom, (height - depth) / up), depth


def structure_extent(poses: StructurePoses, amplification: float) -> StructureExtent:
    """Return the room that a structure needs in all frames."""
    o, frames = poses.outline, np.unique(np.linspace(0, poses.rotation.size - 1, _MAX_FRAMES_SEARCHED).astype(int))
    extreme = [int(each) for each in (poses.rotation.argmax(), poses.rotation.argmin())]
    extreme += [int(each) for each in (poses.slip.argmax(), poses.slip.argmin())]
    points = np.concatenate([*(each.points for each in o.strokes), *(ends for _, ends in o.elements)])
    across, up = [1.4 * o.right, 1.4 * o.left, 0.12 * o.top, -0.12 * o.top], [1.03 * o.top]
    for frame in [*frames, *extreme]:
        there, above = poses.moved(frame, points, amplification)
        across += [*there]
        up.append(float(above.max()))
    sunk = float(np.maximum(-poses.rise, 0.0).max()) * amplification
    return StructureExtent(-1.05 * float(min(across)), 1.05 * float(max(across)), 1.03 * float(max(up)), sunk)


def draw_stage_ground(axes: Axes, level: float, left: float, right: float) -> None:
    """Draw the surface of the ground, hatched below; everything in points."""
    axes.plot([left, right], [level - 1.5] * 2, color=figures.GRAY, linewidth=1.0)
    for x in np.arange(left + 6.0, right, 7.0):
        axes.plot([x, x - 4.0], [level - 2.0, level - 6.5], color=figures.GRAY, linewidth=0.7)


class HistoryPanels:
    """One panel for each quantity; times after the cursor are faded, and dots mark the values at it."""

    def __init__(
        self, grid: list[Axes], quantities: Sequence[PanelQuantity], curves: list[ResponseCurve], timing: FrameTiming
    ) -> None:
        self._timing = timing
        self.lines: list[Artist] = []
        for axes, quantity in zip(grid, quantities, strict=True):
            self.lines, _ = histories.draw_curves(axes, quantity, curves)
        self.uplifts = histories.shade_uplifts(grid, curves)
        grid[-1].set_xlabel(translated("time [s]"))
        self._end = float(timing.times[-1])
        grid[-1].set_xlim(float(timing.times[0]), self._end)
        self._future = [_fading_rectangle(axes) for axes in grid]
        self._cursors = [axes.axvline(0.0, color="black", linewidth=0.9, animated=True) for axes in grid]
        self._dots: list[tuple[Line2D, Array]] = []
        for axes, quantity in zip(grid, quantities, strict=True):
            factor = histories.quantity_axis_scale(quantity, curves)[0].size
            for curve in curves:
                dot = _animated_line(
                    axes, curve.style.color, 0.0, marker="o", markersize=4.5, markeredgecolor="white",
                    markeredgewidth=0.6,
                )  # fmt: skip
                self._dots.append((dot, _quantity_at_frames(quantity, curve, timing) / factor))

    @property
    def moving(self) -> list[Artist]:
        """Artists that are redrawn in each frame, from the back to the front."""
        return [*self._future, *self._cursors, *(dot for dot, _ in self._dots)]

    def show(self, frame: int) -> None:
        """Move the cursor to the time of a frame."""
        time = float(self._timing.times[frame])
        for cover in self._future:
            cover.set(x=time, width=max(self._end - time, 0.0))
        for cursor in self._cursors:
            cursor.set_xdata([time, time])
        for dot, values in self._dots:
            dot.set_data(np.full(values.shape[1], time), values[frame])


def _quantity_at_frames(quantity: PanelQuantity, curve: ResponseCurve, timing: FrameTiming) -> Array:
    """Return a quantity at the frames, shape (k, n); after the end of the response it has no value."""
    known = curve.history.time
    values = quantity.of(curve.history.at(np.clip(timing.times, known[0], known[-1])))
    return np.where((timing.times <= known[-1])[:, None], values.reshape(timing.times.size, -1), np.nan)


def _fading_rectangle(axes: Axes) -> Rectangle:
    shape = Rectangle(
        (0.0, 0.0), 1.0, 1.0, transform=axes.get_xaxis_transform(), facecolor="white", alpha=_FADING, linewidth=0.0,
        animated=True,
    )  # fmt: skip
    axes.add_patch(shape)
    return shape


class AnimatedFigure:
    """The figure of an animation, with its still and its moving artists."""

    def __init__(
        self, curves: list[ResponseCurve], poses: Sequence[StructurePoses], quantities: Sequence[PanelQuantity],
        timing: FrameTiming, amplification: float, title: str | None, width: int,
    ) -> None:  # fmt: skip
        with figures.applied_figure_style():
            self._figure, axes, grid = _animation_layout(len(curves), len(quantities), width)
            panels = HistoryPanels(grid, quantities, curves, timing)
            histories.add_legend(self._figure, curves, panels.lines, panels.uplifts, title)
            self._canvas = FigureCanvasAgg(self._figure)
            self._figure.draw_without_rendering()  # so that the places are known
            self._figure.set_layout_engine("none")
            structures = StructurePanel(axes, curves, poses, timing, amplification)
            self._parts = structures, panels
            self._moving = [each for part in self._parts for each in part.moving]
            self._canvas.draw()
            self._still = self._canvas.copy_from_bbox(self._figure.bbox)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        width, height = self._canvas.get_width_height()
        return width, height

    def picture(self, frame: int) -> Picture:
        """Return a frame."""
        with figures.applied_figure_style():
            self._canvas.restore_region(self._still)
            for part in self._parts:
                part.show(frame)
            for each in self._moving:
                each.axes.draw_artist(each)  # pyright: ignore[reportOptionalMemberAccess, reportAttributeAccessIssue]
            return np.asarray(self._canvas.buffer_rgba())[:, :, :3].copy()


def _animation_layout(models: int, panels: int, width: int) -> tuple[Figure, Axes, list[Axes]]:
    """Return a figure, the axes of the structures and of the panels; width and height in pixels are even, for H.264."""
    beside = models <= MAX_BESIDE
    inches = max(4.8, 1.35 * panels + 1.1) if beside else 3.3 + 1.2 * panels + 0.9
    dpi = width / INCHES
    pixels = 2 * (width // 2), 2 * round(0.5 * inches * dpi)
    figure = figures.new_figure(*((each + 1e-3) / dpi for each in pixels))
    figure.set_dpi(dpi)
    if beside:
        cells = figure.add_gridspec(panels, 2, width_ratios=(0.42, 0.58) if models == 1 else (0.5, 0.5))
        structures, places = figure.add_subplot(cells[:, 0]), [cells[row, 1] for row in range(panels)]
    else:
        cells = figure.add_gridspec(panels + 1, 1, height_ratios=(3.3, *([1.2] * panels)))
        structures, places = figure.add_subplot(cells[0, 0]), [cells[row + 1, 0] for row in range(panels)]
    grid: list[Axes] = []
    for place in places:
        grid.append(figure.add_subplot(place, sharex=grid[0] if grid else None))
    for axes in grid[:-1]:
        axes.tick_params(labelbottom=False)
    structures.set_axis_off()
    figure.align_ylabels(grid)
    return figure, structures, grid
