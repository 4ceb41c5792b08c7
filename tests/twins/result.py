"""What the twins take and give: no equation of motion lives here, so that the twins share none."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

QUANTITIES = ("rotation", "top_displacement", "base_moment", "base_shear")


@dataclass(frozen=True)
class InitialState:
    """A start with the base at rest (rotation in rad, modal values in m and m/s)."""

    rotation: float = 0.0
    modal_displacement: Vector | None = None
    modal_velocity: Vector | None = None


@dataclass(frozen=True)
class TwinResult:
    """Peaks (absolute, SI, with their times), events and last state of one run of N modes.

    A state is the row ``[θ, θ', D_1..D_N, D'_1..D'_N]``; ``impact_states`` holds the ones just before each
    impact, ``history`` the ones at the samples (None where the twin keeps none).
    """

    status: str
    max_rotation: float
    max_top_displacement: float
    max_base_moment: float
    max_base_shear: float
    time_of_max_rotation: float
    time_of_max_top_displacement: float
    time_of_max_base_moment: float
    time_of_max_base_shear: float
    uplift_times: Vector
    impact_times: Vector
    impact_states: Vector
    final_time: float
    final_side: int
    final_state: Vector
    history: Vector | None

    @property
    def n_uplifts(self) -> int:
        return self.uplift_times.size

    @property
    def n_impacts(self) -> int:
        return self.impact_times.size


class Ledger:
    """Largest absolute values and events met so far."""

    def __init__(self) -> None:
        self.best = np.zeros(len(QUANTITIES))
        self.when = np.zeros(len(QUANTITIES))
        self.uplifts: list[float] = []
        self.impacts: list[float] = []
        self.states: list[Vector] = []

    def offer(self, index: int, value: float, time: float) -> None:
        if abs(value) > self.best[index]:
            self.best[index], self.when[index] = abs(value), time

    def close(
        self, *, time: float, side: int, state: Vector, overturned: bool, history: list[Vector] | None
    ) -> TwinResult:
        rocked = bool(self.uplifts) or self.best[0] > 0.0
        return TwinResult(
            "overturned" if overturned else "rocking" if rocked else "no_uplift",
            *(float(b) for b in self.best),
            *(float(w) for w in self.when),
            uplift_times=np.array(self.uplifts),
            impact_times=np.array(self.impacts),
            impact_states=np.array(self.states).reshape(-1, state.size),
            final_time=time,
            final_side=side,
            final_state=state.copy(),
            history=None if history is None else np.array(history),
        )
