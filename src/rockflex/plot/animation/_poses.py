"""Frames of an animation: their instants, the poses of a structure, and the factor on displacements."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_finite, checked_positive, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.plot._history import ResponseCurve, time_axis_limits
from rockflex.response._history import History
from rockflex.structure._outline import BODY, GROUND, StructureOutline, has_shapes, structure_outline
from rockflex.structure._rocking import RockingProperties

MAX_FRAMES = 20_000
RATES = {".gif": (1.0, 50.0), ".mp4": (1.0, 120.0)}
"""Frames per second that a file may have: viewers slow down a faster GIF."""

_WIDTH_TOLERANCE = 1e-6  # relative difference of two widths of the same base
_MIN_SLIP_SPEED = 1e-4  # m/s below which a base counts as still
_IMPACT_SECONDS = 0.12  # s of the animation for which an impact is marked
ROUND_FACTORS = (
    *(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 150.0, 200.0, 300.0),
    *(400.0, 500.0, 600.0, 800.0, 1000.0),
)
MAX_DRAWN_MOTION = 0.15  # drawn displacement of the top over the size of the structure, at most


@dataclass(frozen=True, eq=False)
class FrameTiming:
    """The instants of the response in s that the frames show, shape (k,), and the frames per second."""

    times: Array
    speed: float
    frames_per_second: float

    @property
    def hundredths(self) -> NDArray[np.intp]:
        """Time for which each frame is shown in 1/100 s, shape (k,); rounding errors do not add up."""
        ends = np.round(100.0 / self.frames_per_second * np.arange(self.times.size + 1))
        return np.diff(ends).astype(int)


def frame_timing(
    curves: Sequence[ResponseCurve],
    suffix: str,
    speed: float,
    frames_per_second: float,
    start: float | None,
    stop: float | None,
) -> FrameTiming:
    """Return the frames of an animation in a file with some suffix; the arguments are those of `animate`."""
    ratio = checked_positive("speed", speed, "seconds of the response per second of the animation")
    low, high = RATES[suffix]
    rate = real_or_nan(frames_per_second)
    if not low <= rate <= high:
        more = ", or write .mp4" if suffix == ".gif" and rate > high else ""
        raise InputError(
            f"frames_per_second must be from {low:g} to {high:g} for {suffix}, but {shown(frames_per_second)} was "
            f"given. Give 25, which is smooth{more}.",
            field="frames_per_second",
        )
    first, last = time_axis_limits(curves)
    begin = first if start is None else checked_finite("start", start, "s")
    end = last if stop is None else checked_finite("stop", stop, "s")
    if not first <= begin < end <= last:
        raise InputError(
            f"start and stop must be times within the responses, from {first:g} to {last:g} s, start before stop, but "
            f"{begin:g} and {end:g} s were given.",
            field="start",
        )
    step = ratio / rate
    count = (end - begin) / step
    if count > MAX_FRAMES:
        raise InputError(
            f"{end - begin:g} s at speed {ratio:g} and {rate:g} frames per second are {count:.3g} frames, above the "
            f"limit of {MAX_FRAMES}. Raise the speed, lower frames_per_second, or give start and stop.",
            field="speed",
        )
    times = np.asarray(begin + step * np.arange(int(count * (1.0 + 1e-12)) + 1), np.float64)
    if end - times[-1] > 0.25 * step:
        times = np.append(times, end)
    times[-1] = end  # where a fall ends
    return FrameTiming(times, ratio, rate)


def outline_of_response(history: History, structure: Any | None, place: int) -> StructureOutline:
    """Return the outline of the structure of a response, number `place` of those given."""
    p = history.model.properties
    if p.n_modes and has_shapes(structure):
        _check_structure_of_response(structure, p, place)
    return structure_outline(p, structure)


def _check_structure_of_response(structure: Any, p: RockingProperties, place: int) -> None:
    """Check that a structure has these properties."""
    if not hasattr(structure, "modal"):
        raise InputError(
            f"structure must be that of responses[{place}], such as a Frame, but {type(structure).__name__} was given. "
            "Give what simulate was given, or leave it out.",
            field="structure",
        )
    own = structure.rocking()
    if own.n_modes < p.n_modes or abs(own.half_width - p.half_width) > _WIDTH_TOLERANCE * p.half_width:
        raise InputError(
            f"structure is not that of responses[{place}]: it has {own.n_modes} modes and B = {own.half_width:g} m, "
            f"and the response {p.n_modes} modes and B = {p.half_width:g} m. Give what simulate was given, one for "
            "each response if they differ, or leave it out.",
            field="structure",
        )


@dataclass(frozen=True, eq=False)
class StructurePoses:
    """The motion of one response at the instants of the frames, shape (k,) each; after its end as at its end.

    Attributes
    ----------
    outline
        The structure at rest.
    springs
        Positions of the springs under the base in m, shape (n_springs,); none on rigid ground.
    rotation, slip, heave
        θ in rad, and the displacement of the base to the right and, on springs, upwards in m.
    sway
        Horizontal displacements of the points of the outline relative to the base in m, shape (k, m).
    rise
        Rise of the left and of the right edge in m, shape (k, 2).
    uplifted, sliding, impact
        Whether the base is off the ground, slides, and hit the ground a moment ago.
    lifts, sprung
        Whether the base can lift, and whether it is on springs.
    """

    outline: StructureOutline
    springs: Array
    rotation: Array
    slip: Array
    heave: Array
    sway: Array
    rise: Array
    uplifted: Bools
    sliding: Bools
    impact: Bools
    lifts: bool
    sprung: bool

    def place(self, frame: int, x: Array, y: Array, amplification: float) -> tuple[Array, Array]:
        """Return where points of the body at rest, in m, are drawn in a frame, with an enlarged motion.

        The body turns about the edge on which it stands, on springs about the axis of its masses; at most by π/2.
        """
        across, up = amplification * self.slip[frame], amplification * self.heave[frame]
        theta = float(np.clip(amplification * self.rotation[frame], -0.5 * np.pi, 0.5 * np.pi))
        pivot = 0.0 if self.sprung or theta == 0.0 else self.outline.right if theta > 0.0 else self.outline.left
        cosine, sine, arm = np.cos(theta), np.sin(theta), np.asarray(x) - pivot
        return across + pivot + arm * cosine + y * sine, up + y * cosine - arm * sine

    def moved(self, frame: int, points: Array, amplification: float, sunk: float = 0.0) -> tuple[Array, Array]:
        """Return where points of the outline, shape (k, 3), are drawn in a frame; those in the ground `sunk` lower."""
        x, z, how = points.T
        sway = np.interp(z, self.outline.heights, self.sway[frame])
        turning = np.minimum(z, self.outline.turning)
        across, up = self.place(frame, x + amplification * sway, turning, amplification)
        still = np.where(z > 0.0, z, z - sunk * (how == GROUND))
        return np.where(how == GROUND, x, across), np.where(how == BODY, up, still)

    def base(self, frame: int, amplification: float) -> tuple[Array, Array]:
        """Return where the left and the right edge of the base are drawn in a frame; columns under one stand there."""
        edges = np.array([self.outline.left, self.outline.right])
        if self.outline.turning < np.inf:
            return edges, np.zeros(2)
        return self.place(frame, edges, np.zeros(2), amplification)


def structure_poses(curve: ResponseCurve, outline: StructureOutline, times: Array, speed: float) -> StructurePoses:
    """Return the poses of a response at some instants in s; `speed` is in seconds of the response per second."""
    history = curve.history
    model, springs = history.model, history.model.springs
    known = history.time
    at = history.at(np.clip(times, known[0], known[-1]))
    sprung = springs is not None
    running = times <= known[-1]
    still = np.zeros(times.size)
    struck = history.impact_times
    last = np.searchsorted(struck, times, side="right") - 1
    since = np.where(last >= 0, times - struck[last], np.inf) if struck.size else np.full(times.size, np.inf)
    return StructurePoses(
        outline=outline,
        springs=np.empty(0) if springs is None else springs.positions,
        rotation=at.rotation if model.lifts else still,
        slip=at.slip if model.lifts else still,
        heave=at.heave if sprung else still,
        sway=outline.sway(at.modal_displacement, at.joint_rotation),
        rise=at.edge_uplift if model.lifts and outline.turning == np.inf else np.zeros((times.size, 2)),
        uplifted=np.asarray(at.uplifted) if model.lifts else np.zeros(times.size, bool),
        sliding=running & (np.abs(at.slip_velocity) > _MIN_SLIP_SPEED) if model.lifts else np.zeros(times.size, bool),
        impact=(since < _IMPACT_SECONDS * speed) & running,
        lifts=model.lifts,
        sprung=sprung,
    )


def resting_poses(outline: StructureOutline, springs: Array) -> StructurePoses:
    """Return the pose of a structure that stands on the ground or on unloaded springs, as a single frame."""
    still, never = np.zeros(1), np.zeros(1, bool)
    return StructurePoses(
        outline=outline,
        springs=springs,
        rotation=still,
        slip=still,
        heave=still,
        sway=np.zeros((1, outline.heights.size)),
        rise=np.zeros((1, 2)),
        uplifted=never,
        sliding=never,
        impact=never,
        lifts=True,
        sprung=springs.size > 0,
    )


def default_amplification(curves: Sequence[ResponseCurve], poses: Sequence[StructurePoses]) -> float:
    """Return the largest round number for which no structure is drawn to move by more than 0.15 of its size.

    At least 1, and 1 if one falls: a fall shows without it, and could not be told from a large rotation with it.
    """
    if any(curve.falls or curve.overturned for curve in curves):
        return 1.0
    largest = max(map(_largest_relative_motion, poses))
    fitting = [each for each in ROUND_FACTORS if each * largest <= MAX_DRAWN_MOTION]
    return fitting[-1] if fitting else 1.0


def _largest_relative_motion(poses: StructurePoses) -> float:
    """Return the largest displacement in the frames over the size of the structure."""
    size = poses.outline.size
    turned = np.abs(poses.rotation) * size + np.abs(poses.sway).max(axis=1)
    moved = turned + np.abs(poses.slip) + np.abs(poses.heave)
    return float(moved.max()) / size
