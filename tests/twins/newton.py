"""Newton's laws for the masses of a frame, in coordinates of the ground: no rotating frame, no modes, no Lagrangian.

Simplified: x_i is where mass i stands, relative to the ground, and θ turns the base by small angles. Complete: every
mass has its place (X, Z); the columns push it along the base, and it keeps its height above the base, which turns about
a pivot. Integrated by SciPy's DOP853, afresh at every sample and event; impacts keep the horizontal velocities.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import minimize_scalar

from twins.complete_model import Rope
from twins.frame import frame_stiffness
from twins.result import Vector

GRAVITY = 9.81
RTOL, ATOL = 1e-12, 1e-17
LOOKS = 8  # at each step of the solver, for peaks
START = 1e-9  # s: a rotation that has just left zero is not coming back


@dataclass(frozen=True)
class Masses:
    """A frame of equal stories, by its masses, stiffness and modal damping in place."""

    mass: Vector
    height: Vector
    stiffness: Vector
    damping: Vector
    base_mass: float
    half_width: float
    eccentricity: float = 0.0
    ropes: tuple[Rope, ...] = ()

    @property
    def total(self) -> float:
        return float(self.mass.sum()) + self.base_mass

    def edge(self, side: int) -> float:
        """Where the base touches the ground, from the axis of the masses."""
        return side * self.half_width - self.eccentricity

    def share(self, moment: float) -> float:
        """An overturning moment over the one at which the base lifts to the side to which it would."""
        edge = self.edge(-1 if moment > 0.0 else 1)
        held = self.total * GRAVITY * abs(edge) + sum(rope.force * abs(edge - rope.x) for rope in self.ropes)
        return moment / held

    def pushed(self, u: Vector, rate: Vector) -> Vector:
        """Acceleration that the columns give each mass along the base."""
        return -(self.stiffness @ u + self.damping @ rate) / self.mass


def masses_of(
    *, n_stories, story_height, story_mass, base_mass, stiffness_ratio, period, aspect_ratio, damping_ratio,
    eccentricity=0.0, ropes=(),
) -> Masses:  # fmt: skip
    height = story_height * np.arange(1.0, n_stories + 1.0)
    mass = np.full(n_stories, float(story_mass))
    stiffness = frame_stiffness(n_stories, story_height, stiffness_ratio)
    square, _ = eigh(stiffness, np.diag(mass))
    stiffness = stiffness * (2.0 * np.pi / period) ** 2 / square[0]
    square, shape = eigh(stiffness, np.diag(mass))  # φ^T M φ = 1
    moved = mass[:, None] * shape
    damping = moved @ np.diag(2.0 * damping_ratio * np.sqrt(square)) @ moved.T
    first = shape[:, 0]
    half_width = float(mass * height @ first / (mass @ first)) / aspect_ratio
    return Masses(mass, height, stiffness, damping, base_mass, half_width, eccentricity, tuple(ropes))


class Simplified:
    """State [x_i, θ, x'_i, θ']."""

    def __init__(self, masses: Masses) -> None:
        self.m = masses

    def start(self) -> Vector:
        return np.zeros(2 * self.m.mass.size + 2)

    def rotation(self, y: Vector) -> float:
        return y[self.m.mass.size]

    def accelerations(self, y: Vector, a: float, side: int) -> tuple[Vector, float]:
        m, n = self.m, self.m.mass.size
        x, theta, v, spin = y[:n], y[n], y[n + 1 : -1], y[-1]
        moved = m.pushed(x - m.height * theta, v - m.height * spin) - a
        if side == 0:
            return moved, 0.0
        arm = float(m.mass @ m.height)
        moment = arm * GRAVITY * theta - m.total * GRAVITY * m.edge(side) - arm * a - self._pull(theta, side)[1]
        return moved, float(moment - m.mass * m.height @ moved) / (m.total * m.edge(side) ** 2)

    def _pull(self, theta: float, side: int) -> tuple[float, float]:
        """Sum of the ropes' forces, and of their moments about the pivot against θ."""
        force = moment = 0.0
        for rope in self.m.ropes:
            reach = self.m.edge(side) - rope.x if side else 0.0
            tension = rope.force + rope.stiffness * reach * theta
            force, moment = force + tension, moment + tension * reach
        return force, moment

    def field(self, y: Vector, a: float, side: int) -> Vector:
        moved, turn = self.accelerations(y, a, side)
        n = self.m.mass.size
        return np.concatenate((y[n + 1 :], moved, [turn]))

    def overturning(self, y: Vector, a: float) -> float:
        """Moment that the ground must resist in contact, over the moment at which the base lifts."""
        m = self.m
        moved, _ = self.accelerations(y, a, 0)
        return m.share(float(m.mass * m.height @ (moved + a)))

    def landed(self, y: Vector) -> Vector:
        after, n = y.copy(), self.m.mass.size
        after[n] = after[-1] = 0.0
        return after

    def places(self, y: Vector) -> Vector:
        return y[: self.m.mass.size]

    def reactions(self, y: Vector, a: float, side: int) -> tuple[float, float]:
        m = self.m
        moved, turn = self.accelerations(y, a, side)
        upward = m.edge(side) * turn if side else 0.0
        return float(m.mass @ moved) + m.total * a, m.total * (GRAVITY + upward) + self._pull(y[m.mass.size], side)[0]


class Complete:
    """State [X_i, Z_i, θ, X'_i, Z'_i, θ'] from the masses' axis at rest, in contact Z_i = h_i."""

    def __init__(self, masses: Masses) -> None:
        self.m = masses

    def start(self) -> Vector:
        n = self.m.mass.size
        return np.concatenate((np.zeros(n), self.m.height, np.zeros(2 * n + 2)))

    def rotation(self, y: Vector) -> float:
        return y[2 * self.m.mass.size]

    def _parts(self, y: Vector) -> tuple[Vector, Vector, float, Vector, Vector, float]:
        n = self.m.mass.size
        return y[:n], y[n : 2 * n], y[2 * n], y[2 * n + 1 : 3 * n + 1], y[3 * n + 1 : -1], y[-1]

    def accelerations(self, y: Vector, a: float, side: int) -> tuple[Vector, Vector, float]:
        m = self.m
        x, z, theta, vx, vz, spin = self._parts(y)
        if side == 0:
            return m.pushed(x, vx) - a, np.zeros_like(x), 0.0
        sine, cosine = np.sin(theta), np.cos(theta)
        pivot = m.edge(side)
        along, upward = (x - pivot) * cosine - z * sine, vx * cosine - vz * sine
        pushed = m.pushed(along + pivot, upward - spin * m.height) + GRAVITY * sine - a * cosine
        free = 2.0 * spin * along * upward - spin**2 * m.height * along
        torque = float(m.mass @ (-z * a + (x - pivot) * GRAVITY))
        torque += m.base_mass * (-pivot * cosine * GRAVITY - pivot * sine * a) - self._pull(theta, side)[2]
        turn = torque - float(m.mass @ (m.height * pushed + free))
        turn /= float(m.mass @ along**2) + m.base_mass * pivot**2
        normal = -2.0 * spin * upward - turn * along + spin**2 * m.height
        return pushed * cosine + normal * sine, -pushed * sine + normal * cosine, turn

    def field(self, y: Vector, a: float, side: int) -> Vector:
        ax, az, turn = self.accelerations(y, a, side)
        n = self.m.mass.size
        return np.concatenate((y[2 * n + 1 :], ax, az, [turn]))

    def overturning(self, y: Vector, a: float) -> float:
        m = self.m
        ax, _, _ = self.accelerations(y, a, 0)
        leaning = float(m.mass @ y[: m.mass.size]) * GRAVITY
        return m.share(float(m.mass * m.height @ (ax + a)) - leaning)

    def _pull(self, theta: float, side: int) -> tuple[float, float, float]:
        """Sum of the ropes' pulls on the base to the left and downward, and of their moments against θ."""
        left = down = moment = 0.0
        for rope in self.m.ropes:
            pivot = self.m.edge(side) if side else rope.x
            arm = rope.x - pivot
            place = np.array([arm * np.cos(theta), -arm * np.sin(theta)])  # where it leaves the base, from the pivot
            chord = place - [arm, 0.0]
            length = float(np.hypot(*chord))
            pull = (rope.force + rope.stiffness * length) * (chord / length if length else np.array([0.0, 1.0]))
            left, down = left + pull[0], down + pull[1]
            moment += place[1] * pull[0] - place[0] * pull[1]
        return left, down, moment

    def landed(self, y: Vector) -> Vector:
        x, _, _, vx, _, _ = self._parts(y)
        n = self.m.mass.size
        return np.concatenate((x, self.m.height, [0.0], vx, np.zeros(n), [0.0]))

    def places(self, y: Vector) -> Vector:
        return y[: self.m.mass.size]

    def reactions(self, y: Vector, a: float, side: int) -> tuple[float, float]:
        m = self.m
        ax, az, turn = self.accelerations(y, a, side)
        _, _, theta, _, _, spin = self._parts(y)
        pivot = m.edge(side) if side else 0.0
        base_x = pivot * (turn * np.sin(theta) + spin**2 * np.cos(theta))
        base_z = pivot * (turn * np.cos(theta) - spin**2 * np.sin(theta))
        x = float(m.mass @ (ax + a)) + m.base_mass * (base_x + a)
        left, down, _ = self._pull(theta, side)
        return x + left, float(m.mass @ (az + GRAVITY)) + m.base_mass * (base_z + GRAVITY) + down


@dataclass
class NewtonResult:
    """Largest magnitudes of the places of the masses (N,), of ΣF_x and of |θ|, and the least ΣF_z."""

    places: Vector
    horizontal: float
    vertical: float
    rotation: float
    n_uplifts: int = 0
    n_impacts: int = 0


def integrate(model: Simplified | Complete, acceleration: Vector, dt: float) -> NewtonResult:
    """Carry the masses through a record from rest."""
    y, side = model.start(), 0
    result = NewtonResult(np.zeros(model.m.mass.size), 0.0, np.inf, 0.0)
    for first, last in pairwise(acceleration):
        t = 0.0
        while t < dt * (1.0 - 1e-12):
            a = first + (last - first) * t / dt
            if side == 0 and abs(model.overturning(y, a)) > 1.0 + 1e-13:
                side = -int(np.sign(model.overturning(y, a)))
                result.n_uplifts += 1
            t, y, event = _phase(model, result, y, side, t, first, last, dt)
            if event == "impact":
                y, side = model.landed(y), 0
                result.n_impacts += 1
            elif event == "uplift":
                side = -int(np.sign(model.overturning(y, first + (last - first) * t / dt)))
                result.n_uplifts += 1
    return result


def _phase(model, result, y, side, start, first, last, dt):
    def at(t: float) -> float:
        return first + (last - first) * t / dt

    def back(t, z):
        return side * model.rotation(z) if t > start + START else 1.0

    def lift(t, z):
        return abs(model.overturning(z, at(t))) - 1.0 if t > start + START else -1.0

    guard = lift if side == 0 else back
    guard.terminal, guard.direction = True, 1.0 if side == 0 else -1.0
    sol = solve_ivp(
        lambda t, z: model.field(z, at(t), side), (start, dt), y, "DOP853", rtol=RTOL, atol=ATOL, max_step=dt / 4,
        dense_output=True, events=guard,
    )  # fmt: skip
    assert sol.success
    grid = np.linspace(sol.t[:-1], sol.t[1:], LOOKS, endpoint=False, axis=1).ravel()
    grid = np.append(grid, sol.t[-1])

    def values(t: float) -> Vector:
        z = sol.sol(t)
        x, n = model.reactions(z, at(t), side)
        return np.concatenate((np.abs(model.places(z)), [abs(x), -n, abs(model.rotation(z))]))

    seen = np.array([values(t) for t in grid])
    best = np.concatenate((result.places, [result.horizontal, -result.vertical, result.rotation]))
    for f in range(best.size):
        k = int(np.argmax(seen[:, f]))
        top = seen[k, f]
        low, high = grid[max(k - 1, 0)], grid[min(k + 1, grid.size - 1)]
        room = np.ptp(seen[max(k - 1, 0) : k + 2, f])
        if low < high and top + room > best[f]:  # also beside an end of the piece
            found = minimize_scalar(lambda t, f=f: -values(t)[f], bounds=(low, high), method="bounded",
                                    options={"xatol": 1e-9})  # fmt: skip
            top = max(top, -found.fun)
        best[f] = max(best[f], top)
    result.places, result.horizontal = best[:-3], float(best[-3])
    result.vertical, result.rotation = -float(best[-2]), float(best[-1])
    event = "" if sol.status == 0 else ("uplift" if side == 0 else "impact")
    return float(sol.t[-1]), sol.y[:, -1], event
