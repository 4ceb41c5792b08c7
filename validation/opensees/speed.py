"""Seconds of one excursion in rockflex and in OpenSees, at a stated error of θ_max."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from first_excursion import Excursion, complete, pulse, simplified
from frames import Prototype
from references import reference

import rockflex as rf

GRID = [(stiffness, dt) for stiffness in (1e12, 1e13) for dt in (5e-3, 2e-3, 1e-3, 5e-4, 2e-4)]
REPETITIONS = 4  # of the settings that were chosen, for the least time


@dataclass(frozen=True)
class Speed:
    """One model at one error."""

    model: str
    target: float  # error of θ_max of the first excursion that OpenSees may make
    contact: float  # N/m
    dt: float  # s, of OpenSees
    error: float  # that it made
    opensees: float  # s, in analyze alone
    rockflex: float  # s, one call of simulate with its structure ready, peaks only

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
    """The fastest of `grid` in OpenSees that meets each target, beside rockflex over the same stretch of the pulse.

    Both are undamped and run from rest to 0.1 s past the first impact. Large rotations are judged by
    Newton's law with columns that shorten (see `newton`), since OpenSees has no other columns. Targets that nothing of
    the grid meets are left out.
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
    """Least time of a call in s, after one that is not counted."""
    function()
    times = []
    for _ in range(repetitions):
        started = time.perf_counter()
        function()
        times.append(time.perf_counter() - started)
    return min(times)
