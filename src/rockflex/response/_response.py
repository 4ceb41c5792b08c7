"""What one run answers: peaks, when they occurred, how the run ended and, where kept, its history."""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Generic, Self, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from rockflex._files import path_of
from rockflex._values import Value
from rockflex.models import RockingModel, floor_accelerations
from rockflex.response._energy import EnergyLedger
from rockflex.response._file import load, save
from rockflex.response._floor_peaks import FloorPeaks
from rockflex.response._global import GLOBAL, tracked_of_floors
from rockflex.response._history import History
from rockflex.response._missing import MissingQuantityError
from rockflex.response._tendons import largest_tendon_force
from rockflex.response._warnings import warnings_of
from rockflex.solve import Solution

Array = NDArray[np.float64]
Quantity = TypeVar("Quantity")


class _OfHistory(Generic[Quantity]):
    """A quantity of the history that is the response's own, by the same name."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name
        self.__doc__ = getattr(History, name).__doc__

    @overload
    def __get__(self, response: None, owner: type) -> Self: ...
    @overload
    def __get__(self, response: "Response", owner: type) -> Quantity: ...
    def __get__(self, response: "Response | None", owner: type) -> Self | Quantity:
        if response is None:
            return self
        if response.history is None:
            raise MissingQuantityError(
                f'This response keeps peaks only, so it has no {self.name}. Simulate with output="history".'
            )
        return getattr(response.history, self.name)


@dataclass(frozen=True, eq=False, kw_only=True)
class Response(Value):
    """The response of one structure to one motion.

    All peaks are the largest magnitudes of the continuous motion, between samples too. A response that keeps its
    history has the history's quantities as its own: `time`, `side`, `ground_acceleration`, `modal_displacement`,
    `modal_velocity`, `modal_acceleration`, `rotation`, `rotation_velocity`, `rotation_acceleration`, `yielding`,
    `top_displacement`, `total_top_displacement`, `base_moment`, `base_shear`, `uplift_times`, `impact_times`,
    `story_drift`, `story_shear`, `floor_acceleration`, `total_floor_displacement`, `tendon_force`,
    `horizontal_reaction`, `vertical_reaction`, `friction_demand`, `required_friction`,
    `required_friction_excluding_impacts()`, `sliding_time()` and `energy`; see `History`. One that keeps peaks only has
    none of them: `hasattr` is False, and to ask for one is an `InputError` that says so.

    Parameters
    ----------
    model
        Label of the model, such as ``"2DOF-S"``.
    motion
        Name of the ground motion.
    status
        ``"no_uplift"``, ``"rocking"`` (the base was off the ground) or ``"overturned"`` (|θ| reached π/2, where the
        run stopped). A run that starts uplifted is rocking from the start.
    max_rotation, time_of_max_rotation
        Largest |θ| in rad, and when, in s.
    max_top_displacement, time_of_max_top_displacement
        Largest |u_top| relative to the rotating base in m, and when.
    max_base_moment, time_of_max_base_moment
        Largest |M_b| of the elastic forces in N m, and when; zero for a rigid block, which has none.
    max_base_shear, time_of_max_base_shear
        Largest |V_b| of the elastic forces in N, and when; zero for a rigid block.
    max_total_top_displacement, time_of_max_total_top_displacement
        Largest horizontal displacement of the top relative to the ground in m, what the rotation of the base carries it
        included, and when: u_top + h_top θ, in the complete models by Eq. 3. NaN where the height of the top is not
        known.
    max_horizontal_reaction, time_of_max_horizontal_reaction
        Largest |ΣF_x| that the ground must hold in N (Eq. 21), and when: the base's mass, the damping forces and the
        mass of modes left out are in it, other than in `max_base_shear`. What an impact gives in an instant is not.
    min_vertical_reaction, time_of_min_vertical_reaction
        Least vertical force between base and ground in N (Eq. 22 with the sign of the weight mended), and when.
        Where it is negative the model pulls the base down, which no ground can: the pivot would lift.
    max_tendon_force
        Largest force of any tendon in N; zero without tendons.
    tendon_utilisation
        Largest force over yield force of any tendon; zero without tendons, NaN where no yield force is known. Tendons
        stay elastic, so a run with more than 1 is not to be trusted.
    n_uplifts, n_impacts
        How often the base left the ground, and how often it came back, during the run. A start off the ground is no
        uplift, so there may then be one impact more than there are uplifts.
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
    max_total_top_displacement: float
    time_of_max_total_top_displacement: float
    max_horizontal_reaction: float
    time_of_max_horizontal_reaction: float
    min_vertical_reaction: float
    time_of_min_vertical_reaction: float
    max_tendon_force: float
    tendon_utilisation: float
    n_uplifts: int
    n_impacts: int
    nominal_overturning: bool
    end_time: float
    settled: bool
    floors: FloorPeaks | None = None
    history: History | None = None

    time = _OfHistory[Array]()
    side = _OfHistory[Array]()
    ground_acceleration = _OfHistory[Array]()
    modal_displacement = _OfHistory[Array]()
    modal_velocity = _OfHistory[Array]()
    rotation = _OfHistory[Array]()
    rotation_velocity = _OfHistory[Array]()
    modal_acceleration = _OfHistory[Array]()
    rotation_acceleration = _OfHistory[Array]()
    yielding = _OfHistory[Array]()
    top_displacement = _OfHistory[Array]()
    total_top_displacement = _OfHistory[Array]()
    base_moment = _OfHistory[Array]()
    base_shear = _OfHistory[Array]()
    uplift_times = _OfHistory[Array]()
    impact_times = _OfHistory[Array]()
    story_drift = _OfHistory[Array]()
    story_shear = _OfHistory[Array]()
    floor_acceleration = _OfHistory[Array]()
    total_floor_displacement = _OfHistory[Array]()
    tendon_force = _OfHistory[Array]()
    horizontal_reaction = _OfHistory[Array]()
    vertical_reaction = _OfHistory[Array]()
    friction_demand = _OfHistory[Array]()
    required_friction = _OfHistory[float]()
    required_friction_excluding_impacts = _OfHistory[Callable[..., float]]()
    sliding_time = _OfHistory[Callable[..., float | None]]()
    energy = _OfHistory[EnergyLedger]()

    def __post_init__(self) -> None:
        pass  # no arrays of its own to make read-only, and every run of a study makes one

    def __repr__(self) -> str:
        return (
            f"Response({self.model} under {self.motion!r}: {self.status}, θ_max={self.max_rotation:.4g} rad, "
            f"u_top,max={self.max_top_displacement:.4g} m, {self.n_impacts} impacts)"
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the run asks of the ground or of its tendons that they cannot do, a sentence each."""
        return warnings_of(self.model, self.peaks())

    def peaks(self) -> dict[str, Any]:
        """Every scalar by its name, as a row of a table or a JSON object."""
        return {name: getattr(self, name) for name in PEAKS}

    def save(self, path: str | Path) -> Path:
        """Write the response, history included, to one ``.npz`` file, and return its path; see `load`.

        The suffix is added to a path that has none.

        Raises
        ------
        InputError
            If the path has another suffix, such as ``.parquet``.
        """
        return save(path_of("path", path), self.peaks(), self.floors, self.history)

    @classmethod
    def load(cls, path: str | Path) -> "Response":
        """Read a response that `save` wrote.

        Raises
        ------
        InputError
            If the file is missing or is not a saved response.
        """
        peaks, floors, history = load(path_of("path", path), KINDS)
        return Response(**peaks, floors=floors, history=history)


PEAKS = tuple(f.name for f in fields(Response) if f.name not in ("floors", "history"))
KINDS: dict[str, type] = {name: Response.__annotations__[name] for name in PEAKS}


def respond(model: RockingModel, motion: str, solution: Solution, *, floors: bool = False) -> Response:
    """Name what a solver returned; its rows are those of `asked_of`, with those of the floors or without."""
    p = model.properties
    rotation, peaks = float(solution.peaks[0]), solution.peaks[1:]
    right = left = rotation
    end = count = len(GLOBAL)
    if not p.symmetric:
        right, left = peaks[end : end + 2].tolist()
        end += 2
    left_ground = solution.n_uplifts > 0 or solution.n_impacts > 0 or rotation > 0.0
    status = "rocking" if left_ground else "no_uplift"
    known = {f"max_{name}": value for name, value in zip(GLOBAL, peaks[:count].tolist(), strict=True)}
    at = solution.peak_times[1 : 1 + count].tolist()
    times = {f"time_of_max_{name}": value for name, value in zip(GLOBAL, at, strict=True)}
    if p.top_height is None:
        known["max_total_top_displacement"] = times["time_of_max_total_top_displacement"] = math.nan
    force, utilisation = largest_tendon_force(model, right, left)
    return Response(
        model=model.label,
        motion=motion,
        status="overturned" if solution.overturned else status,
        max_rotation=rotation,
        time_of_max_rotation=float(solution.peak_times[0]),
        **known,
        **times,
        min_vertical_reaction=p.resting_reaction - solution.lost_support,
        time_of_min_vertical_reaction=solution.time_of_lost_support,
        max_tendon_force=force,
        tendon_utilisation=utilisation,
        n_uplifts=solution.n_uplifts,
        n_impacts=solution.n_impacts,
        nominal_overturning=right > p.pivot(1).nominal_overturning_rotation
        or left > p.pivot(-1).nominal_overturning_rotation,
        end_time=solution.end_time,
        settled=solution.settled,
        floors=_floor_peaks(model, solution, peaks[end:]) if floors and p.floors is not None else None,
        history=None if solution.nodes is None else History(model, solution.nodes),
    )


def _floor_peaks(model: RockingModel, solution: Solution, peaks: Array) -> FloorPeaks:
    names = tracked_of_floors(model)
    found = dict(zip(names, np.split(peaks, len(names)), strict=True))
    floors = model.properties.floors
    if "floor_acceleration" not in found and floors is not None and solution.nodes is not None:
        # No linear functional in large rotations: the largest stands at a sample or an event.
        found["floor_acceleration"] = np.abs(floor_accelerations(model, floors, solution.nodes)).max(axis=0)
    return FloorPeaks(**found)
