"""How a structure stands at the instants of an animation, and where its points are then."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex.plot._curves import Curve
from rockflex.plot.animation._outline import Outline

_SLIDING = 1e-4  # m/s below which a base counts as still
_MARKED = 0.12  # s of the animation for which an impact is marked


@dataclass(frozen=True, eq=False)
class Poses:
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

    outline: Outline
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

    def bent(self, frame: int, x: float, amplification: float) -> tuple[Array, Array]:
        """Return where the points of a vertical line at `x` of the structure are drawn in a frame, bent by its sway."""
        heights = self.outline.heights
        return self.place(frame, x + amplification * self.sway[frame], heights, amplification)

    def base(self, frame: int, amplification: float) -> tuple[Array, Array]:
        """Return where the left and the right edge of the base are drawn in a frame."""
        edges = np.array([self.outline.left, self.outline.right])
        return self.place(frame, edges, np.zeros(2), amplification)


def poses_of(curve: Curve, outline: Outline, times: Array, speed: float) -> Poses:
    """Return the poses of a response at some instants in s; `speed` is what an animation shows of it in a second."""
    history = curve.history
    model: Any = history.model
    known = history.time
    at = history.at(np.clip(times, known[0], known[-1]))
    sprung = model.layout.heave >= 0
    running = times <= known[-1]
    still = np.zeros(times.size)
    struck = history.impact_times
    last = np.searchsorted(struck, times, side="right") - 1
    since = np.where(last >= 0, times - struck[last], np.inf) if struck.size else np.full(times.size, np.inf)
    return Poses(
        outline=outline,
        springs=model.springs.positions if sprung else np.empty(0),
        rotation=at.rotation if model.lifts else still,
        slip=at.slip if model.lifts else still,
        heave=at.heave if sprung else still,
        sway=at.modal_displacement @ outline.shapes.T,
        rise=at.edge_uplift if model.lifts else np.zeros((times.size, 2)),
        uplifted=np.asarray(at.uplifted) if model.lifts else np.zeros(times.size, bool),
        sliding=running & (np.abs(at.slip_velocity) > _SLIDING) if model.lifts else np.zeros(times.size, bool),
        impact=(since < _MARKED * speed) & running,
        lifts=model.lifts,
        sprung=sprung,
    )
