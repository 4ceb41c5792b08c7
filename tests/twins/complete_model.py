"""The complete and the simplified rocking models as one vector field, guard and set of responses.

Source: Silva & Stojadinović 2024, Eqs. 13-16, 21-24, 37 and 38. State ``[θ, θ', D_1..D_N, D'_1..D'_N]``, and
at its end Bouc-Wen's z where there is one. N = 0 is the rigid block. A state may hold one column an instant.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from twins.result import Vector

GRAVITY = 9.81


class Shaking(NamedTuple):
    """Acceleration of the ground to the right and upwards; a number stands for one to the right alone."""

    right: Vector | float
    up: Vector | float


Ground = Shaking | Vector | float


def split(a: Ground) -> tuple[Vector | float, Vector | float]:
    """The horizontal acceleration, and the weight of a unit of mass on ground that moves upwards."""
    return (a.right, GRAVITY + a.up) if isinstance(a, Shaking) else (a, GRAVITY)


@dataclass(frozen=True)
class BoucWen:
    """Hysteresis of the one mode (Eqs. 37-38); the defaults are those of Section 4.2."""

    yield_displacement: float
    post_yield_ratio: float = 0.01
    gamma: float = 0.5
    beta: float = 0.5
    exponent: float = 8.0

    def force(self, stiffness: float, d: Vector, z: Vector) -> Vector:
        """Eq. 37, for one unit of mass; linear in (D, z), so of (D', z') it is the rate."""
        elastic = self.post_yield_ratio
        return stiffness * (elastic * d + (1.0 - elastic) * self.yield_displacement * z)

    def rate(self, v: Vector, z: Vector) -> Vector:
        """Eq. 38."""
        size = abs(z) ** self.exponent
        return (v - self.gamma * abs(v) * np.sign(z) * size - self.beta * v * size) / self.yield_displacement


@dataclass(frozen=True)
class Rope:
    """A tendon at x from the axis of the masses: force at rest and stiffness."""

    force: float
    stiffness: float
    x: float = 0.0


@dataclass(frozen=True)
class Structure:
    """N modes on a base of half width B, by the names of the equations; their axis may stand beside its middle."""

    omega: Vector
    effective_mass: Vector
    effective_height: Vector
    top_ordinate: Vector
    i_theta: float
    l0r: float
    m_tot: float
    half_width: float
    zeta: Vector
    translational_inertia: float
    eccentricity: float = 0.0
    ropes: tuple[Rope, ...] = ()

    def __post_init__(self) -> None:
        modal = {name: np.asarray(getattr(self, name), float) for name in list(self.__dataclass_fields__)[:4]}
        damping = np.broadcast_to(np.asarray(self.zeta, float), modal["omega"].shape) if modal["omega"].size else []
        self.__dict__.update(modal, zeta=np.asarray(damping, float), ropes=tuple(self.ropes))

    def edge(self, side: int) -> float:
        """Where the pivot of a side is, from the axis of the masses; the axis itself for side 0."""
        return side * self.half_width - self.eccentricity if side else 0.0


class CompleteModel:
    """Full trigonometry with ``complete`` (Eqs. 13, 14, 16), else small rotations (Eqs. 23, 24)."""

    def __init__(self, structure: Structure, *, complete: bool, bouc_wen: BoucWen | None = None) -> None:
        if bouc_wen is not None and structure.omega.size != 1:
            msg = "Bouc-Wen needs a model of one mode"
            raise ValueError(msg)
        self.structure, self.complete, self.bouc_wen = structure, complete, bouc_wen
        self.n = structure.omega.size
        self.size = 2 + 2 * self.n + (bouc_wen is not None)
        self.arm = structure.effective_mass * structure.effective_height
        self.stiffness, self.damping = structure.omega**2, 2.0 * structure.zeta * structure.omega
        self.arm_inertia = float(self.arm @ structure.effective_height)
        self.about_axis = structure.i_theta - structure.m_tot * structure.half_width**2

    def modal(self, y: Vector) -> tuple[Vector, Vector]:
        """D and D'."""
        return y[2 : 2 + self.n], y[2 + self.n : 2 + 2 * self.n]

    def restoring(self, d: Vector, y: Vector) -> Vector:
        """ω_n² D_n of every mode, or what Eq. 37 puts in its place."""
        if self.bouc_wen is None:
            return (self.stiffness * d.T).T
        return self.bouc_wen.force(self.stiffness[0], d, y[-1:])

    def free(self, y: Vector, a: Vector | float) -> Vector:
        """D'' of Eq. 15, as if the base did not rotate."""
        d, v = self.modal(y)
        return -a - (self.damping * v.T).T - self.restoring(d, y)

    def resisting(self, side: int, g: Vector | float = GRAVITY) -> Vector | float:
        """Moment about the pivot of what pulls the base down, each force at its place."""
        p = self.structure
        edge = p.edge(side)
        return p.m_tot * g * abs(edge) + sum(rope.force * abs(edge - rope.x) for rope in p.ropes)

    def pull(self, turn: float, side: int) -> tuple[float, float]:
        """Sum of the ropes' forces, and of their moments about the pivot; along chords in the complete model."""
        p = self.structure
        force = moment = 0.0
        for rope in p.ropes:
            reach = abs(p.edge(side) - rope.x)
            chord, lever = reach * abs(turn), reach
            if self.complete:
                chord, lever = 2.0 * reach * abs(math.sin(0.5 * turn)), reach * math.cos(0.5 * turn)
            force += rope.force + rope.stiffness * chord
            moment += (rope.force + rope.stiffness * chord) * lever
        return force, side * moment

    def holding(self, turn: float, spin: float, side: int) -> float:
        """Moment about the pivot of what is stretched by the rotation, against θ."""
        return self.pull(turn, side)[1]

    def overturning(self, y: Vector, a: Ground) -> Vector:
        """The moment that lifts the base, to θ > 0 below -`resisting(1)` and to θ < 0 above `resisting(-1)`.

        In contact (Eqs. 16 and 24).

        Eq. 16 has D on both sides of the inequality; here both stand on the left.
        """
        right, g = split(a)
        moment = self.arm @ self.free(y, right) + self.structure.l0r * right
        if self.complete:
            moment = moment - g * (self.structure.effective_mass @ self.modal(y)[0])
        return moment

    def room(self, y: Vector, a: Ground) -> Vector:
        """What the overturning moment has left to the nearer of its limits, in contact."""
        moment, g = self.overturning(y, a), split(a)[1]
        return np.minimum(self.resisting(-1, g) - moment, self.resisting(1, g) + moment)

    def side_wanted(self, y: Vector, a: Ground) -> int:
        """Side on which the base lifts at once, else 0."""
        moment, g = self.overturning(y, a), split(a)[1]
        return 1 if moment < -self.resisting(1, g) else -1 if moment > self.resisting(-1, g) else 0

    def inertia(self, d: Vector, side: int) -> float:
        """Factor of θ'' in its own equation: I_θ, with the masses where they are in the complete model."""
        p = self.structure
        inertia = self.about_axis + p.m_tot * (p.edge(side) if side else p.half_width) ** 2
        if not self.complete:
            return inertia
        return inertia + float(p.effective_mass @ (d * d - 2.0 * p.edge(side) * d))

    def accelerations(self, y: Vector, ground: Ground, side: int) -> tuple[float, Vector]:
        """(θ'', D'') under Eqs. 13 and 14, or 23; in contact (side 0) those of Eq. 15."""
        p, (a, g) = self.structure, split(ground)
        d, v = self.modal(y)
        if side == 0:
            return 0.0, self.free(y, a)
        turn, spin = float(y[0]), float(y[1])
        if not self.complete:
            moment = p.l0r * (g * turn - a) - p.m_tot * g * p.edge(side)
            modes = self.free(y, a)
        else:
            m, reach = p.effective_mass, p.edge(side)
            sin, cos = math.sin(turn), math.cos(turn)
            # Weight and inertia force act at the centre of mass, which the flexure moves.
            along, across, beyond = p.l0r, p.m_tot * reach - float(m @ d), d - reach
            moment = g * (along * sin - across * cos) - a * (along * cos + across * sin)
            moment -= 2.0 * spin * float(v @ (m * beyond))
            modes = self.free(y, a * cos - g * sin) + spin**2 * beyond
        moment -= self.holding(turn, spin, side)
        # The modal rows say D'' = modes - h* θ''; put into the row of θ:
        rotation = (moment - float(self.arm @ modes)) / (self.inertia(d, side) - self.arm_inertia)
        return rotation, modes - p.effective_height * rotation

    def field(self, y: Vector, a: Ground, side: int) -> Vector:
        """y'."""
        rotation, modes = self.accelerations(y, a, side)
        rates = np.empty(self.size)
        rates[0], rates[1] = (y[1], rotation) if side else (0.0, 0.0)
        rates[2 : 2 + self.n], rates[2 + self.n : 2 + 2 * self.n] = y[2 + self.n : 2 + 2 * self.n], modes
        if self.bouc_wen is not None:
            rates[-1] = self.bouc_wen.rate(float(y[3]), float(y[-1]))
        return rates

    def responses(self, y: Vector) -> Vector:
        """θ, u_top, base moment and base shear, shape (4,) or (4, instants)."""
        d = self.modal(y)[0]
        return self._combined(y[0], d, self.restoring(d, y))

    def response_rates(self, y: Vector) -> Vector:
        """Their derivatives in time; no acceleration enters them."""
        v = self.modal(y)[1]
        if self.bouc_wen is None:
            force = (self.stiffness * v.T).T
        else:
            force = self.bouc_wen.force(self.stiffness[0], v, self.bouc_wen.rate(v, y[-1:]))
        return self._combined(y[1], v, force)

    def _combined(self, turn: Vector, d: Vector, force: Vector) -> Vector:
        p = self.structure
        return np.stack([turn, p.top_ordinate @ d, self.arm @ force, p.effective_mass @ force])

    def ground_forces(self, y: Vector, ground: Ground, side: int) -> tuple[float, float]:
        """What the ground gives the base: Eq. 21, and Eq. 22 with the weight upward (its sign is a misprint)."""
        p, (a, g) = self.structure, split(ground)
        rotation, modes = self.accelerations(y, ground, side)
        d, v = self.modal(y)
        sin, cos, spin = np.sin(y[0]), np.cos(y[0]), y[1] if side else 0.0
        m, along, across = p.effective_mass, p.l0r, p.m_tot * p.edge(side) - p.effective_mass @ d
        along_speed, along_rate = 2.0 * spin * (m @ v), m @ modes
        horizontal = rotation * (across * sin + along * cos) + spin**2 * (across * cos - along * sin)
        vertical = rotation * (across * cos - along * sin) - spin**2 * (across * sin + along * cos)
        tension = self.pull(y[0], side)[0]
        return (
            p.m_tot * a + horizontal + along_rate * cos - along_speed * sin + tension * np.sin(0.5 * y[0]),
            p.m_tot * g + vertical - along_rate * sin - along_speed * cos + tension * np.cos(0.5 * y[0]),
        )

    def kinetic_energy(self, y: Vector, side: int) -> float:
        """Eq. 6 (complete), or the energy of which Eq. 23 is the equation of motion."""
        d, v = self.modal(y)
        m = self.structure.effective_mass
        return 0.5 * self.inertia(d, side) * y[1] ** 2 + y[1] * (self.arm @ v) + 0.5 * m @ (v * v)

    def potential_energy(self, y: Vector, side: int) -> float:
        """Eq. 8 without shaking, zero at rest; elastic structures without ropes alone."""
        p = self.structure
        d = self.modal(y)[0]
        strain = 0.5 * p.effective_mass @ (p.omega * d) ** 2
        if not self.complete:
            return strain + p.m_tot * GRAVITY * p.edge(side) * y[0] - 0.5 * p.l0r * GRAVITY * y[0] ** 2
        across = p.m_tot * p.edge(side) - p.effective_mass @ d
        return strain + GRAVITY * (across * np.sin(y[0]) - 2.0 * p.l0r * np.sin(0.5 * y[0]) ** 2)
