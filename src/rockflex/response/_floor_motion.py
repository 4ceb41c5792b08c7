"""The acceleration of a floor as a motion: what equipment on it feels."""

import math
from typing import TYPE_CHECKING, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import positive, whole_number
from rockflex.modal import FloorModes
from rockflex.models import TIME, RockingModel, floor_accelerations
from rockflex.motion import GroundMotion
from rockflex.response._missing import MissingQuantityError
from rockflex.response._sampled import even_instants, states_at

if TYPE_CHECKING:
    from rockflex.motion import ResponseSpectrum

FINE = 0.005  # s: the longest step of a floor's motion unless another is given
PER_PERIOD = 20  # steps in the shortest period of the modes


class FloorMotions:
    """The motions of the floors of a history."""

    model: RockingModel
    states: Array

    def floor_motion(self, floor: SupportsIndex, dt: float | None = None, *, impulses: bool = True) -> GroundMotion:
        """Return the total horizontal acceleration of a floor as a motion, for its measures and spectra.

        Parameters
        ----------
        floor
            Number of the floor; 1 is the first above the base, as in the columns of `to_frame`.
        dt
            Longest step in s between samples, which are joined linearly; the step divides the history equally. None:
            0.005 s, or a twentieth of the shortest period of the modes if that is shorter.
        impulses
            Whether to include what an impact changes in the velocity of the floor at once. The samples before and after
            it take it as an acceleration during `dt`, and likewise what a straight line between samples leaves out of a
            sudden change of the acceleration, so that the velocity of the floor is right. With False the samples are
            those of `floor_acceleration`.

        Returns
        -------
        GroundMotion
            From the first state to the last, with the free vibration.

        Raises
        ------
        InputError
            If the structure has no floors or not this one, or `dt` is not positive or too short.
        """
        floors = self.model.properties.floors
        if floors is None:
            raise MissingQuantityError(
                "The properties of the structure include no floors, so there is no floor motion. Simulate a Frame or a "
                "LumpedStructure, or give RockingProperties their floors."
            )
        number = whole_number("floor", floor, 1, floors.heights.size)
        omega, known = self.model.properties.omega, self.states[:, TIME]
        shortest = 2.0 * math.pi / float(omega.max()) if omega.size else math.inf
        step = min(FINE, shortest / PER_PERIOD) if dt is None else positive("dt", dt, "s")
        span = float(known[-1] - known[0])
        times = even_instants(span / max(math.ceil(span / step - 1e-9), 2), known)
        samples = floor_accelerations(self.model, floors, states_at(self.model, self.states, times))[:, number - 1]
        step = span / (times.size - 1)
        if impulses:
            place = np.minimum((known[1:] - known[0]) / step, times.size - 1.0)
            before = np.minimum(place.astype(np.intp), times.size - 2)
            later = place - before
            gained, risen = (each[:, number - 1] for each in _jumps(self.model, floors, self.states))
            gained = gained + (0.5 - later) * step * risen  # what a straight line through a step leaves out
            samples = samples.copy()
            np.add.at(samples, before, (1.0 - later) * gained / step)
            np.add.at(samples, before + 1, later * gained / step)
        return GroundMotion(samples, step, f"floor {number}")

    def floor_spectrum(
        self,
        floor: SupportsIndex,
        periods: ArrayLike,
        damping_ratio: float = 0.05,
        *,
        dt: float | None = None,
        impulses: bool = True,
    ) -> "ResponseSpectrum":
        """Return the response spectrum of the total horizontal acceleration of a floor, for light equipment on it.

        It is exact for the motion of `floor_motion`, whose error is proportional to `dt`²; at periods shorter than `dt`
        the impulses of impacts count as accelerations during `dt`.

        Parameters
        ----------
        floor, dt, impulses
            As in `floor_motion`.
        periods, damping_ratio
            As in `GroundMotion.spectrum`: periods in s, and the fraction of critical damping of the equipment.

        Raises
        ------
        InputError
            As for `floor_motion` and `GroundMotion.spectrum`.
        """
        return self.floor_motion(floor, dt, impulses=impulses).spectrum(periods, damping_ratio)


def _jumps(model: RockingModel, floors: FloorModes, states: Array) -> tuple[Array, Array]:
    """Return the sudden changes of the velocity and acceleration of the floors, in m/s and m/s², (n_states - 1, N).

    Velocities change at impacts, where θ = 0, so the sum is that of small rotations for all models.
    """
    layout = model.layout
    speed = layout.of(states, layout.spin)[:, None] * floors.heights + layout.velocities(states) @ floors.displacement.T
    if layout.slip >= 0:
        speed = speed + layout.of(states, layout.slip + 1)[:, None]
    sudden = np.diff(states[:, TIME])[:, None] == 0.0
    changes = speed, floor_accelerations(model, floors, states)
    return tuple(np.where(sudden, np.diff(each, axis=0), 0.0) for each in changes)  # pyright: ignore[reportReturnType]
