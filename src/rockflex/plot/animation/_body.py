"""The lines of one structure on its ground, moved from frame to frame."""

from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from rockflex._arrays import Array
from rockflex.plot._curves import Curve
from rockflex.plot._style import RED, SHADE
from rockflex.plot.animation._poses import Poses
from rockflex.plot.animation._symbols import COLORS, SPRING, SPRING_FREE, between, coil, joined, strokes

COLUMNS = 0.82  # of the distance from the axis to the nearer edge, at which columns are drawn
TENDON = 0.6  # of the height to which tendons reach
BRACKET = 26.0  # points above the base to which other elements reach
_FEW, _MANY = 4, 25  # springs that are drawn wide; stories with thick floors
_GHOST = "#c9ced6"


class Map(NamedTuple):
    """From metres to the points of the stage: middle of the cell, level of the base at rest, ground, points per m."""

    middle: float
    level: float
    ground: float
    zoom: float

    def __call__(self, points: tuple[Array, Array]) -> tuple[Array, Array]:
        """Return x and y in points."""
        return self.middle + self.zoom * points[0], self.level + self.zoom * points[1]


class Body:
    """The artists of one structure; `show` moves them to a frame."""

    def __init__(self, axes: Axes, poses: Poses, curve: Curve, here: Map, amplification: float) -> None:
        self._poses, self._here, self._by = poses, here, amplification
        self._elements = curve.history.model.properties.elements if poses.lifts else ()
        color = curve.look.color
        block = poses.outline.kind == "block"
        self._draw_ghost(axes)
        self._gap = _area(axes, facecolor=RED, alpha=0.25, linewidth=0.0)
        self._free = _line(axes, SPRING_FREE, 1.0)
        self._pressed = _line(axes, SPRING, 1.2)
        self._block = _area(axes, facecolor=SHADE, edgecolor=color, linewidth=2.0, visible=block)
        thick = 3.6 if poses.outline.kind == "column" else 2.0
        self._columns = _line(axes, color, thick)
        self._floors = _line(axes, color, 1.0 if poses.outline.heights.size > _MANY else 2.6)
        self._base = _line(axes, color, 4.0, capstyle="butt")
        self._mass = _line(axes, color, 0.0, marker="s", markersize=11.0)
        kinds = sorted({type(each).__name__ for each in self._elements})
        self._held = {kind: _line(axes, COLORS[kind], 1.3) for kind in kinds}
        self._blows = _line(axes, RED, 0.0, marker="o", markersize=11.0, markerfacecolor="none", markeredgewidth=1.8)

    @property
    def moving(self) -> list[Artist]:
        """What is drawn anew in each frame, from the back to the front."""
        parts = (self._gap, self._free, self._pressed, self._block, self._columns, self._floors, self._mass, self._base)
        return [*parts, *self._held.values(), self._blows]

    def show(self, frame: int) -> None:
        """Move the lines to where they are in a frame."""
        poses, by = self._poses, self._by
        base = poses.base(frame, by)
        self._base.set_data(*self._here(base))
        self._show_body(frame)
        if poses.sprung:
            self._show_springs(frame)
        else:
            gap = self._here((np.append(base[0], base[0][::-1]), np.append(base[1], [0.0, 0.0])))
            self._gap.set_xy(np.column_stack(gap))
        self._show_elements(frame)
        edges = self._here((np.array([poses.outline.left, poses.outline.right]) + by * poses.slip[frame], np.zeros(2)))
        self._blows.set_data(*(edges if poses.impact[frame] else ([], [])))

    def _lines(self, frame: int | None) -> tuple[list[Array], list[Array], Array]:
        """Return the columns, the floors and the top in points, in a frame or at rest."""
        poses = self._poses
        o = poses.outline

        def bent(x: float) -> Array:
            if frame is None:
                return np.column_stack(self._here((np.full(o.heights.size, x), o.heights)))
            return np.column_stack(self._here(poses.bent(frame, x, self._by)))

        if o.kind == "block":
            low, high = bent(o.left), bent(o.right)
            return [np.concatenate((low, high[::-1]))], [], high[-1]
        if o.kind == "frame":
            half = COLUMNS * min(-o.left, o.right)
            low, high = bent(-half), bent(half)
            return [low, high], [np.array(pair) for pair in zip(low[1:], high[1:], strict=True)], high[-1]
        axis = bent(0.0)
        return [axis], [], axis[-1]

    def _show_body(self, frame: int) -> None:
        columns, floors, top = self._lines(frame)
        if self._poses.outline.kind == "block":
            self._block.set_xy(columns[0])
            return
        self._columns.set_data(*joined(columns))
        self._floors.set_data(*joined(floors))
        if self._poses.outline.kind == "mast":
            self._mass.set_data(top[:1], top[1:])

    def _draw_ghost(self, axes: Axes) -> None:
        """Draw the structure at rest, faintly."""
        columns, floors, _ = self._lines(None)
        closed = [np.vstack((line, line[:1])) for line in columns] if self._poses.outline.kind == "block" else columns
        axes.plot(*joined([*closed, *floors]), color=_GHOST, linewidth=0.8)

    def _show_springs(self, frame: int) -> None:
        """Draw the springs from the ground to the base, those that it left at their full length and lighter."""
        poses, (middle, rest, ground, zoom) = self._poses, self._here
        half = 2.2 if poses.springs.size > _FEW else 4.0
        ends = poses.place(frame, poses.springs, np.zeros(poses.springs.size), self._by)
        across, up = middle + zoom * ends[0], rest + zoom * ends[1]
        lines: dict[bool, list[Array]] = {False: [], True: []}
        for x, y in zip(across, up, strict=True):
            free = bool(y > rest)
            (turns,) = coil(max((rest if free else y) - ground, 1.0), half)
            lines[free].append(np.array(turns) + np.array([x, ground]))
        self._pressed.set_data(*joined(lines[False]))
        self._free.set_data(*joined(lines[True]))

    def _show_elements(self, frame: int) -> None:
        """Draw tendons from below the ground into the structure, and the others up to a bracket on the base."""
        poses, here = self._poses, self._here
        top, sunk = poses.outline.top, (here.level - here.ground) / here.zoom
        parts: dict[str, list[Array]] = {kind: [] for kind in self._held}
        for element in self._elements:
            kind, x = type(element).__name__, np.array([element.position])
            reach = TENDON * top if kind == "Tendon" else min(BRACKET / here.zoom, 0.4 * top)
            below = sunk + (0.02 * top if kind == "Tendon" else 0.0)
            start = np.concatenate(here((x, np.array([-below]))))
            end = np.concatenate(here(poses.place(frame, x, np.array([reach]), self._by)))
            length = float(np.hypot(*(end - start)))
            parts[kind].append(np.column_stack(between(strokes(kind, length), start, end)))
        for kind, lines in parts.items():
            self._held[kind].set_data(*joined(lines))


def _line(axes: Axes, color: str, width: float, *, capstyle: Any = "round", **more: Any) -> Line2D:
    """Return an empty line that is drawn anew in each frame."""
    look: dict[str, Any] = {
        "solid_capstyle": capstyle,
        "solid_joinstyle": "round",
        "linestyle": "-" if width else "none",
    }
    (line,) = axes.plot([], [], color=color, linewidth=width or 1.0, animated=True, **(look | more))
    return line


def _area(axes: Axes, **look: Any) -> Polygon:
    """Return an area that is drawn anew in each frame."""
    area = Polygon(np.zeros((4, 2)), animated=True, **look)
    axes.add_patch(area)
    return area
