"""Seconds of one excursion in rockflex and in OpenSees, at a stated error of θ_max."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from first_excursion import Excursion, complete, pulse, simplified
from frames import Prototype
from references import reference

import rockflex as rf

GRID = [(stiffness, dt) for stiffness in (1e12, 1e13) for dt in (5e-3, 2e-3, 1e-3, 5e-4, 2e-4)]
REPETITIONS = 4  # of the selected settings, for the minimum time


@dataclass(frozen=True)
class Speed:
    """One model at one error."""

    model: str
    target: float  # admissible error of θ_max of the first excursion in OpenSees
    contact: float  # N/m
    dt: float  # s, of OpenSees
    error: float  # actual error
    opensees: float  # s, in analyze only
    rockflex: float  # s, one call of simulate with properties computed beforehand, peaks only

    @property
    def ratio(self) -> float:
        """OpenSees' time over rockflex's."""
        return self.opensees / self.rockflex


def speeds(
    prototype: Prototype,
    targets: tuple[float, ...] = (1e-3, 1e-4),
    grid: list[tuple[float, float]] = GRID,
    models: tuple[str, ...] = ("MDOF-S", "MDOF-C"),
) -> list[Speed]:
    """The fastest of `grid` in OpenSees that meets each target, and rockflex over the same part of the pulse.

    Both are undamped and run from rest to 0.1 s past the first impact. With large rotations the error is relative to
    Newton's law with shortening columns (see `newton`), since OpenSees has no other columns. Targets that no setting
    of the grid meets are omitted.
    """
    shaking = pulse()
    found = []
    for model in models:
        large = model == "MDOF-C"
        structure = prototype.structure(second_order=large)
        end = reference(structure, model, shaking).impact + 0.1
        stretch = rf.GroundMotion(shaking.acceleration[: round(end / shaking.dt) + 1], shaking.dt)
        properties = structure.rocking()
        mine = least(lambda p=properties, m=model, s=stretch: rf.simulate(p, s, m, "peaks"), 30)

        def excursions(cases: list[tuple[float, float]], large: bool = large) -> list[Excursion]:
            if large:
                return complete(prototype, shaking, cases, like_opensees=True)
            return simplified(prototype, shaking, cases)

        runs = excursions(grid)
        for target in targets:
            good = [run for run in runs if abs(run.peak) <= target and abs(run.uplift) < 0.01]
            if good:
                best = min(good, key=lambda run: run.seconds)
                again = excursions([(best.contact, best.dt)] * REPETITIONS)
                theirs = min(each.seconds for each in (best, *again))
                found.append(Speed(model, target, best.contact, best.dt, best.peak, theirs, mine))
    return found


def least(function: Callable[[], object], repetitions: int) -> float:
    """Minimum time of a call in s, after one that is not counted."""
    function()
    times = []
    for _ in range(repetitions):
        started = time.perf_counter()
        function()
        times.append(time.perf_counter() - started)
    return min(times)
