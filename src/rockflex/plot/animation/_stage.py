"""The structures that rock on their ground, side by side, and the words below them."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from rockflex.plot._curves import Curve
from rockflex.plot._style import GRAY, SMALL
from rockflex.plot.animation._body import Body, Map
from rockflex.plot.animation._clock import Clock
from rockflex.plot.animation._poses import Poses
from rockflex.plot.animation._words import state_of

HEAD, FOOT, EDGE = 34.0, 40.0, 8.0  # points above, below and beside the structures
LEAST, MOST = 14.0, 60.0  # points of a spring that is unloaded
_FRAMES = 200  # that are looked at for the room a structure needs
_ASIDE = 1.8  # reach to one side over that to the other, beyond which a structure is not drawn in the middle
_INK = "#404040"


class Stage:
    """One cell for each response over a common ground; the axes' coordinates are points of 1/72 inch."""

    def __init__(
        self, axes: Axes, curves: Sequence[Curve], poses: Sequence[Poses], clock: Clock, amplification: float
    ) -> None:
        self._clock, self._curves, self._poses = clock, curves, poses
        width, height = np.asarray(axes.get_window_extent().size) * (72.0 / axes.figure.dpi)
        axes.set(xlim=(0.0, width), ylim=(0.0, height))
        cell = width / len(curves)
        rooms = [_room(each, amplification) for each in poses]
        sprung = any(each.sprung for each in poses)
        zoom, depth = _zoom(rooms, cell - 2.0 * EDGE, height - HEAD - FOOT, sprung=sprung)
        self._bodies: list[Body] = []
        self._words: list[tuple[Artist, Artist]] = []
        for place, (curve, each, room) in enumerate(zip(curves, poses, rooms, strict=True)):
            middle = cell * (place + 0.5)
            _draw_ground(axes, middle - 0.5 * cell + EDGE, middle + 0.5 * cell - EDGE)
            here = Map(middle - zoom * room.middle, FOOT + (depth if each.sprung else 0.0), FOOT, zoom)
            self._bodies.append(Body(axes, each, curve, here, amplification))
            axes.text(
                middle, height - HEAD + 8.0, curve.label, color=curve.look.color, ha="center", weight="bold",
                fontsize=9.0, wrap=False,
            )  # fmt: skip
            state = axes.text(middle, 17.0, "", ha="center", fontsize=8.0, animated=True)
            number = axes.text(middle, 5.0, "", ha="center", fontsize=SMALL, color=_INK, animated=True)
            self._words.append((state, number))
        self._time = axes.text(EDGE, height - 10.0, "", fontsize=9.0, color="black", animated=True)
        axes.text(
            width - EDGE, height - 10.0, _scales(amplification, clock.speed), ha="right", fontsize=8.0, color=_INK
        )

    @property
    def moving(self) -> list[Artist]:
        """What is drawn anew in each frame, from the back to the front."""
        words = [each for pair in self._words for each in pair]
        return [part for body in self._bodies for part in body.moving] + words + [self._time]

    def show(self, frame: int) -> None:
        """Move everything to where it is in a frame."""
        time = float(self._clock.times[frame])
        self._time.set(text=f"t = {time:.2f} s")
        for body, curve, poses, (state, number) in zip(
            self._bodies, self._curves, self._poses, self._words, strict=True
        ):
            body.show(frame)
            text, color = state_of(curve, poses, frame, time)
            state.set(text=text, color=color)
            rotation = f"{1e3 * poses.rotation[frame]:.2f}".replace("-", "−")
            number.set(text=f"θ = {rotation} mrad" if poses.lifts else "")


def _scales(amplification: float, speed: float) -> str:
    """Say how displacements and time are enlarged."""
    size = "true displacements" if amplification == 1.0 else f"displacements × {amplification:g}"
    return size if speed == 1.0 else f"{size}, speed × {speed:g}"


class _Room(NamedTuple):
    """What a structure needs in m: to the left and the right of its axis, upwards, and below its unloaded springs."""

    left: float
    right: float
    up: float
    sunk: float

    @property
    def middle(self) -> float:
        """What stands in the middle of the cell: the axis of the masses, unless the structure falls to one side."""
        aside = max(self.left, self.right) > _ASIDE * min(self.left, self.right)
        return 0.5 * (self.right - self.left) if aside else 0.0

    @property
    def width(self) -> float:
        """Width about the middle."""
        return 2.0 * max(self.right - self.middle, self.left + self.middle)


def _zoom(rooms: Sequence[_Room], width: float, height: float, *, sprung: bool) -> tuple[float, float]:
    """Return the points per metre with which everything stays in its cell, and those below the unloaded springs."""
    up = max(room.up for room in rooms)
    zoom = min(width / max(room.width for room in rooms), height / up)
    if not sprung:
        return zoom, 0.0
    depth = min(MOST, LEAST + zoom * max(room.sunk for room in rooms))
    return min(zoom, (height - depth) / up), depth


def _room(poses: Poses, amplification: float) -> _Room:
    """Return the room that a structure needs in all frames."""
    o, frames = poses.outline, np.unique(np.linspace(0, poses.rotation.size - 1, _FRAMES).astype(int))
    extreme = [int(each) for each in (poses.rotation.argmax(), poses.rotation.argmin())]
    extreme += [int(each) for each in (poses.slip.argmax(), poses.slip.argmin())]
    across, up = [1.4 * o.right, 1.4 * o.left, 0.12 * o.top, -0.12 * o.top], [1.03 * o.top]
    for frame in [*frames, *extreme]:
        for x in (o.left, o.right):
            there, above = poses.bent(frame, x if o.kind in ("block", "frame") else 0.3 * x, amplification)
            beside, _ = poses.base(frame, amplification)
            across += [*there, *beside]
            up.append(float(above.max()))
    sunk = float(np.maximum(-poses.rise, 0.0).max()) * amplification
    return _Room(-1.05 * float(min(across)), 1.05 * float(max(across)), 1.03 * float(max(up)), sunk)


def _draw_ground(axes: Axes, left: float, right: float) -> None:
    axes.plot([left, right], [FOOT - 1.5] * 2, color=GRAY, linewidth=1.0)
    for x in np.arange(left + 6.0, right, 7.0):
        axes.plot([x, x - 4.0], [FOOT - 2.0, FOOT - 6.5], color=GRAY, linewidth=0.7)
