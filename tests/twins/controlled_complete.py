"""Controlled rocking with large rotations or a Bouc-Wen superstructure, by SciPy's DOP853 with events.

An element stands on the base at the distance r from the pivot and points to the place below which it stood in contact:
it is stretched by the chord 2 r sin(|θ|/2), and its moment follows from its virtual work F dδ. In a simplified model
the stretch is r |θ|.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from twins.complete import ATOL, ROOT, Run, Sample, first_root, sizes
from twins.complete_model import GRAVITY, BoucWen, CompleteModel, Structure
from twins.controlled import DOWN, SLACK, UP, Bar, Dashpot
from twins.impact_laws import CompleteVVEL, Law
from twins.result import Vector

PLACES, WEIGHTS = np.polynomial.legendre.leggauss(4)
PLACES, WEIGHTS = 0.5 + 0.5 * PLACES, 0.5 * WEIGHTS
AT_ONCE = 1e-11  # of the yield stretch: a limit this close at the start of a phase is the one just left


class ControlledModel(CompleteModel):
    """The model with elements on their present branches."""

    def __init__(
        self, structure: Structure, elements: list[Bar | Dashpot], *, complete: bool, bouc_wen: BoucWen | None
    ) -> None:
        super().__init__(structure, complete=complete, bouc_wen=bouc_wen)
        self.elements = elements

    def reach(self, element: Bar | Dashpot, side: int) -> float:
        """Distance from the pivot towards the base; negative beyond the pivot."""
        return side * (self.structure.edge(side) - element.position)

    def stretch(self, element: Bar | Dashpot, turn: Vector | float, side: int) -> Vector | float:
        size, sin = side * turn, math.sin if isinstance(turn, float) else np.sin
        return self.reach(element, side) * (2.0 * sin(0.5 * size) if self.complete else size)

    def lever(self, element: Bar | Dashpot, turn: Vector | float, side: int) -> Vector | float:
        """dδ/dθ."""
        cos = math.cos if isinstance(turn, float) else np.cos
        return side * self.reach(element, side) * (cos(0.5 * turn) if self.complete else 1.0)

    def tension(self, element: Bar | Dashpot, turn: float, spin: float, side: int) -> float:
        k, c, force = element.tangent()
        if side == 0:
            return force
        return force + k * self.stretch(element, turn, side) + c * self.lever(element, turn, side) * spin

    def resisting(self, side: int, g: Vector | float = GRAVITY) -> Vector | float:
        return super().resisting(side, g) + sum(each.tangent()[2] * self.reach(each, side) for each in self.elements)

    def holding(self, turn: float, spin: float, side: int) -> float:
        return sum(self.tension(each, turn, spin, side) * self.lever(each, turn, side) for each in self.elements)

    def pull(self, turn: float, side: int) -> tuple[float, float]:
        return 0.0, 0.0

    def dissipation(self, y: Vector, side: int) -> float:
        """Power of the dampers."""
        rates = [self.lever(each, y[0], side) * y[1] for each in self.elements]
        return sum(each.tangent()[1] * rate**2 for each, rate in zip(self.elements, rates, strict=True))

    def ground_forces(self, y: Vector, a: float, side: int) -> tuple[float, float]:
        horizontal, vertical = super().ground_forces(y, a, side)
        total = sum(self.tension(each, y[0], y[1] if side else 0.0, side) for each in self.elements)
        half = 0.5 * y[0] if self.complete else 0.0
        return horizontal + total * np.sin(half), vertical + total * np.cos(half)


@dataclass
class ControlledRun(Run):
    """A run whose elements change their branches at events: "back" where the rotation turns, or (place, branch).

    `forces` are time, horizontal and vertical reaction at the samples, `damped` the energy taken by the dampers.
    """

    n_changes: int = 0
    damped: float = 0.0
    forces: list[tuple[float, float, float]] = field(default_factory=list)

    @property
    def bars(self) -> list[Bar]:
        return [each for each in self.model.elements if isinstance(each, Bar)]

    def advance(self, sample: Sample) -> None:
        super().advance(sample)
        forces = self.model.ground_forces(self.y, sample.excitation(sample.length), self.side)
        self.forces.append((sample.start + sample.length, *forces))

    def _peaks(self, dense, grid: Vector) -> None:
        super()._peaks(dense, grid)
        if self.side and any(isinstance(each, Dashpot) for each in self.model.elements):
            length = np.diff(grid)
            states = dense((grid[:-1, None] + length[:, None] * PLACES).ravel())
            power = self.model.dissipation(states, self.side).reshape(-1, PLACES.size)
            self.damped += float(length @ power @ WEIGHTS)

    def _phase(self, sample: Sample, tau: float) -> tuple[float, str]:
        tau, kind = super()._phase(sample, tau)
        if kind == "impact":
            for each in self.bars:
                each.rest()
        elif kind == "back":
            self.n_changes += 1
            for each in self.bars:
                each.settle(float(self.model.stretch(each, self.y[0], self.side)))
            self.y[1] = 0.0
        elif isinstance(kind, tuple):
            self.n_changes += 1
            bar, branch = self.bars[kind[0]], kind[1]
            if branch == SLACK:
                bar.slacken(float(self.model.stretch(bar, self.y[0], self.side)))
            bar.branch = branch
        return tau, kind

    def _guards(self, sample: Sample):
        guards, s = super()._guards(sample), self.side
        for place, bar in enumerate(self.bars if s else ()):
            reach = self.model.reach(bar, s)
            if reach != 0.0 and bar.branch in (UP, DOWN):
                outward = (1.0 if bar.branch == UP else -1.0) * np.sign(reach) * s
                guards["back"] = lambda t, y, sign=outward: sign * y[1]
                low = bar.emptied()
                if np.isfinite(low):
                    guards[place, SLACK] = lambda t, y, b=bar, end=low: self.model.stretch(b, y[0], s) - end
            elif reach != 0.0:
                low, below, high, above = bar.limits()
                if np.isfinite(high):
                    guards[place, above] = lambda t, y, b=bar, end=high: end - self.model.stretch(b, y[0], s)
                if np.isfinite(low):
                    guards[place, below] = lambda t, y, b=bar, end=low: self.model.stretch(b, y[0], s) - end
        return guards

    def _first_event(self, sample: Sample, dense, grid: Vector):
        states, found = dense(grid), []
        for kind, guard in self._guards(sample).items():
            values = np.array(guard(grid, states), dtype=float)
            fresh = kind == "impact" and self.y[0] == 0.0
            if kind == "back" or isinstance(kind, tuple):
                # A limit at which the phase begins is left behind, like the ground after an uplift.
                size = np.ptp(states[1]) if kind == "back" else self.bars[kind[0]].reach
                fresh = abs(values[0]) < AT_ONCE * size
                soon = grid[0] + 0.01 * (grid[1] - grid[0])
                if fresh and values[1] <= 0.0 and guard(soon, dense(soon)) <= 0.0:
                    found.append((grid[0], kind))
                    continue
            at = first_root(lambda t, guard=guard: float(guard(t, dense(t))), grid, values, fresh=fresh)
            if at is not None:
                found.append((at, kind))
        speed = states[3] if self.model.bouc_wen is not None else np.zeros(0)
        for k in np.flatnonzero(speed[:-1] * speed[1:] < 0.0)[:1]:
            found.append((brentq(lambda t: float(dense(t)[3]), grid[k], grid[k + 1], **ROOT), "turn"))
        return min(found, key=lambda event: event[0]) if found else None


def simulate_controlled(
    structure: Structure,
    elements: list[Bar | Dashpot],
    acceleration: ArrayLike,
    dt: float,
    *,
    complete: bool = True,
    bouc_wen: BoucWen | None = None,
    law: Law | None = None,
    rotation: float = 0.0,
    free: float = 0.0,
) -> ControlledRun:
    """Run one structure; ``law`` defaults to ``CompleteVVEL``. The ground comes to rest after the last sample."""
    model = ControlledModel(structure, elements, complete=complete, bouc_wen=bouc_wen)
    record = np.asarray(acceleration, float)
    y = np.zeros(model.size)
    y[0] = rotation
    run = ControlledRun(model, law or CompleteVVEL(), True, sizes(model, record) * ATOL, y, int(np.sign(rotation)))
    for each in run.bars:
        each.rest()
    run.note(0.0)
    samples = [Sample(k * dt, dt, record[k], (record[k + 1] - record[k]) / dt) for k in range(record.size - 1)]
    end = dt * (record.size - 1)
    samples += [Sample(end + k * dt, dt, 0.0, 0.0) for k in range(int(np.ceil(free / dt - 1e-9)))]
    for sample in samples:
        run.advance(sample)
        if run.overturned:
            break
    return run
