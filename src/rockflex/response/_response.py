"""What one run answers: peaks, when they occurred, how the run ended and, where kept, its history."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex._errors import InputError
from rockflex.models import LinearModel
from rockflex.response._history import History
from rockflex.response._observables import GLOBAL
from rockflex.solve import Solution

__all__ = ["PEAKS", "FloorPeaks", "Response", "respond"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FloorPeaks:
    """Largest magnitudes over the run, peaks between samples included, shape (N_floors,) each."""

    story_drift: Array
    """Displacement of each floor less that of the one below, relative to the rotated base, in m."""
    story_shear: Array
    """Sum of the elastic forces from each floor up, in N."""
    floor_acceleration: Array
    """Total horizontal acceleration of each floor, in m/s²."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Response:
    """The response of one structure to one motion.

    All peaks are the largest magnitudes of the continuous motion, between samples too.

    Parameters
    ----------
    model
        Label of the model, such as ``"2DOF-S"``.
    motion
        Name of the ground motion.
    status
        ``"no_uplift"``, ``"rocking"`` (the base lifted at least once) or ``"overturned"`` (|θ| reached π/2, where
        the run stopped).
    max_rotation, time_of_max_rotation
        Largest |θ| in rad, and when, in s.
    max_top_displacement, time_of_max_top_displacement
        Largest |u_top| relative to the rotating base in m, and when.
    max_base_moment, time_of_max_base_moment
        Largest |M_b| of the elastic forces in N m, and when.
    max_base_shear, time_of_max_base_shear
        Largest |V_b| of the elastic forces in N, and when.
    n_uplifts, n_impacts
        How often the base left the ground, and how often it came back.
    nominal_overturning
        Whether |θ| passed 0.7 atan(B/h*_1) (Section 3.3).
    end_time
        Time of the last state in s.
    settled
        Whether the run ended because nothing more could happen (``free_vibration="settle"``).
    floors
        Peaks above the base, where the structure names its floors and a history was asked for; else None.
    history
        The time history, or None with ``output="peaks"``.
    """

    model: str
    motion: str
    status: str
    max_rotation: float
    time_of_max_rotation: float
    max_top_displacement: float
    time_of_max_top_displacement: float
    max_base_moment: float
    time_of_max_base_moment: float
    max_base_shear: float
    time_of_max_base_shear: float
    n_uplifts: int
    n_impacts: int
    nominal_overturning: bool
    end_time: float
    settled: bool
    floors: FloorPeaks | None = None
    history: History | None = None

    def __repr__(self) -> str:
        return (
            f"Response({self.model} under {self.motion!r}: {self.status}, θ_max={self.max_rotation:.4g} rad, "
            f"u_top,max={self.max_top_displacement:.4g} m, {self.n_impacts} impacts)"
        )

    def __getattr__(self, name: str) -> Any:
        # The history's quantities are the response's own: response.rotation, response.energy, ...
        if name.startswith("_") or not hasattr(History, name):
            message = f"{type(self).__name__!r} object has no attribute {name!r}"
            raise AttributeError(message)
        if self.history is None:
            message = f'This response keeps peaks only, so it has no {name}. Simulate with output="history".'
            raise InputError(message)
        return getattr(self.history, name)

    def peaks(self) -> dict[str, Any]:
        """Every scalar by its name, as a row of a table or a JSON object."""
        return {name: getattr(self, name) for name in PEAKS}

    def save(self, path: str | Path) -> Path:
        """Write the response, history included, to one ``.npz`` file; see `load`."""
        from rockflex.response._file import save

        return save(self, Path(path))

    @classmethod
    def load(cls, path: str | Path) -> "Response":
        """Read a response that `save` wrote.

        Raises
        ------
        InputError
            If the file is missing or is not a saved response.
        """
        from rockflex.response._file import load

        return load(Path(path))


PEAKS = tuple(f.name for f in fields(Response) if f.name not in ("floors", "history"))


def respond(model: LinearModel, motion: str, solution: Solution) -> Response:
    """Name what a solver returned; its rows are those of `global_observables`, then of `floor_observables`."""
    rotation = float(solution.peaks[0])
    floors = None
    if solution.peaks.size > 1 + len(GLOBAL):
        floors = FloorPeaks(*np.split(solution.peaks[1 + len(GLOBAL) :], 3))
    status = "rocking" if solution.n_uplifts > 0 or rotation > 0.0 else "no_uplift"
    peaks = {f"max_{name}": float(value) for name, value in zip(GLOBAL, solution.peaks[1:], strict=False)}
    times = {f"time_of_max_{name}": float(t) for name, t in zip(GLOBAL, solution.peak_times[1:], strict=False)}
    return Response(
        model=model.label,
        motion=motion,
        status="overturned" if solution.overturned else status,
        max_rotation=rotation,
        time_of_max_rotation=float(solution.peak_times[0]),
        **peaks,
        **times,
        n_uplifts=solution.n_uplifts,
        n_impacts=solution.n_impacts,
        nominal_overturning=rotation > model.properties.nominal_overturning_rotation,
        end_time=solution.end_time,
        settled=solution.settled,
        floors=floors,
        history=None if solution.nodes is None else History(model, solution.nodes),
    )
