"""N modes rocking on rigid ground on which the base slides (Coulomb), shaken horizontally and vertically.

Freedoms: rotation θ, slip x of the base, and D_n. With s the side, and B and I_θ of its pivot:

    N = max(0, m_tot (g + a_v + s B θ''))
    D''_n + 2 ζ_n ω_n D'_n + ω_n² D_n + h*_n θ'' + x'' = -a
    I_θ θ'' + Σ m*_n h*_n D''_n + L x'' = L (g + a_v) θ - s m_tot (g + a_v) B - L a
    m_tot x'' + Σ m*_n D''_n + L θ'' = -m_tot a - sign(x') μ N

A phase is (side, slip, pressed): side 1, -1 or 0 in contact; the sign of x', or 0 where the base sticks; and whether
the ground pushes. Where more than one phase could follow an event, it is the one that none of its own limits ends at
once. An impact keeps all horizontal velocities; rocking goes on at ``restitution`` θ' unless the next excursion, by
2|θ'|/|θ''|, would be shorter than ``shortest``. Outputs: θ, top, base moment, base shear, x.
"""

from dataclasses import dataclass, field

import numpy as np

from twins.pieces import Phase, Run, Track
from twins.result import Vector

GRAVITY = 9.81
TURN, SLIP, MODES = 0, 1, 2
ROTATION, TOP, MOMENT, SHEAR, SLIDE = range(5)
POWERS = ("input", "modes", "friction")
LIFTS = {"lift right": 1, "lift left": -1}


def uplifts(track: Track) -> list[float]:
    """Times of uplift; a base that lands may lift at once."""
    return [t for t, before, name, after in track.events if after[0] and (name == "land" or not before[0])]


def impacts(track: Track) -> list[float]:
    return [t for t, _, name, _ in track.events if name == "land"]


@dataclass
class SlidingTwin:
    """The model; without `friction` the base cannot slide.

    ``i_theta`` and ``half_width`` are pairs, of the right pivot and of the left one, or numbers for both.
    """

    omega: Vector
    mass: Vector
    height: Vector
    top: Vector
    zeta: Vector
    i_theta: float | tuple[float, float]
    l0r: float
    m_tot: float
    half_width: float | tuple[float, float]
    friction: float | None = None
    gravity: float = GRAVITY
    restitution: float = 0.0
    shortest: float = 1e-4
    outputs: Vector = field(init=False)
    lost: list = field(init=False)  # energy of each impact
    n_powers: int = len(POWERS)

    def __post_init__(self) -> None:
        self.q = MODES + self.omega.size
        self.known, self.lost = {}, []
        d = slice(MODES, self.q)
        self.outputs = np.zeros((5, 2 * self.q))
        self.outputs[ROTATION, TURN] = 1.0
        self.outputs[TOP, d] = self.top
        self.outputs[MOMENT, d] = self.mass * self.height * self.omega**2
        self.outputs[SHEAR, d] = self.mass * self.omega**2
        self.outputs[SLIDE, SLIP] = 1.0
        self.arm, self.inertia = ({1: each[0], -1: each[1], 0: each[0]} for each in self._pairs())
        M = self.masses = np.zeros((self.q, self.q))
        M[SLIP, SLIP] = self.m_tot
        M[TURN, SLIP] = M[SLIP, TURN] = self.l0r
        M[TURN, d] = M[d, TURN] = self.mass * self.height
        M[SLIP, d] = M[d, SLIP] = self.mass
        M[d, d] = np.diag(self.mass)

    @classmethod
    def of(cls, p, friction: float | None, **more) -> "SlidingTwin":
        """The twin of a structure with the properties p."""
        modes = (p.omega, p.effective_mass, p.effective_height, p.top_ordinate, p.zeta)
        arms = (p.half_width - p.eccentricity, p.half_width + p.eccentricity)
        own = p.i_theta - p.m_tot * p.half_width**2
        inertia = tuple(own + p.m_tot * arm**2 for arm in arms)
        return cls(*modes, inertia, p.l0r, p.m_tot, arms, friction, **more)

    def _pairs(self) -> list[tuple[float, float]]:
        return [tuple(float(v) for v in np.broadcast_to(each, 2)) for each in (self.half_width, self.i_theta)]

    def mass_matrix(self, side: int) -> Vector:
        M = self.masses.copy()
        M[TURN, TURN] = self.inertia[side]
        return M

    def phase(self, key) -> Phase:
        if key not in self.known:
            self.known[key] = self._phase(key)
        return self.known[key]

    def reaction(self, key) -> tuple[Vector, Vector]:
        """Rows of N over the accelerations and over [1, a, a_v], without the limit at zero."""
        over = np.zeros(self.q)
        over[TURN] = key[0] * self.m_tot * self.arm[key[0]]
        return over, self.m_tot * np.array([self.gravity, 0.0, 1.0])

    def _phase(self, key) -> Phase:
        side, slip, pressed = key
        q, d = self.q, slice(MODES, self.q)
        force, by_vertical, load = np.zeros((q, 2 * q)), np.zeros((q, 2 * q)), np.zeros((q, 3))
        mass = self.mass_matrix(side)
        force[TURN, TURN], by_vertical[TURN, TURN] = self.l0r * self.gravity, self.l0r
        load[TURN] = -side * self.m_tot * self.arm[side] * np.array([self.gravity, 0.0, 1.0])
        load[TURN, 1], load[SLIP, 1], load[d, 1] = -self.l0r, -self.m_tot, -self.mass
        force[d, d] = -np.diag(self.mass * self.omega**2)
        force[d, q + MODES :] = -np.diag(2.0 * self.mass * self.zeta * self.omega)
        over, rest = self.reaction(key)
        if slip and pressed:
            mass[SLIP] += slip * self.friction * over
            load[SLIP] -= slip * self.friction * rest
        free = [i for i in range(q) if i >= MODES or (i == TURN and side) or (i == SLIP and slip)]
        inverse = np.zeros((q, q))
        inverse[np.ix_(free, free)] = np.linalg.inv(mass[np.ix_(free, free)])
        rate, rate_v, loads = np.zeros((2 * q, 2 * q)), np.zeros((2 * q, 2 * q)), np.zeros((2 * q, 3))
        rate[free, [q + i for i in free]] = 1.0
        rate[q:], rate_v[q:], loads[q:] = inverse @ force, inverse @ by_vertical, inverse @ load
        return Phase(rate, rate_v, loads, *self._guards(key), *self._powers(key))

    def _row(self, state=(), rates=(), load=(0.0, 0.0, 0.0)) -> Vector:
        row = np.zeros(4 * self.q + 3)
        for start, values in ((0, state), (3 * self.q, rates)):
            for place, value in values:
                row[start + place] = value
        row[-3:] = load
        return row

    def _guards(self, key) -> tuple[tuple, Vector]:
        side, slip, pressed = key
        over, rest = self.reaction(key)
        normal = self._row(rates=enumerate(over), load=rest)
        names, rows = [], []

        def add(name, row: Vector) -> None:
            names.append(name)
            rows.append(row)

        if side == 0:
            moment = self._row(rates=enumerate(self.masses[TURN]), load=(0.0, self.l0r, 0.0))
            add("lift right", moment + self.arm[1] * normal)
            add("lift left", self.arm[-1] * normal - moment)
        else:
            add("land", self._row([(TURN, side)]))
            add("overturn", self._row([(TURN, -side)], load=(0.5 * np.pi, 0.0, 0.0)))
        if self.friction is None:
            return tuple(names), np.array(rows)
        if slip:
            add("stop", self._row([(self.q + SLIP, slip)]))
            add("press" if not pressed else "release", normal if pressed else -normal)
        else:
            pull = self._row(rates=enumerate(self.masses[SLIP]), load=(0.0, self.m_tot, 0.0))
            add("slide", self.friction * normal + pull)
            add("slide", self.friction * normal - pull)
        return tuple(names), np.array(rows)

    def _powers(self, key) -> tuple[tuple, Vector]:
        side, slip, pressed = key
        q, over, rest = self.q, *self.reaction(key)
        one, a, a_v = self._row(load=(1, 0, 0)), self._row(load=(0, 1, 0)), self._row(load=(0, 0, 1))
        speed = {i: self._row([(q + i, 1.0)]) for i in range(q)}
        kinds, factors = [0, 0, 0], []
        factors.append((-sum(self.masses[SLIP, i] * speed[i] for i in range(q)), a, one))
        factors.append((self._row([(TURN, self.l0r)]), speed[TURN], a_v))
        factors.append((-side * self.m_tot * self.arm[side] * speed[TURN], a_v, one))
        for i in range(self.omega.size):
            row = speed[MODES + i]
            kinds.append(1)
            factors.append((2.0 * self.mass[i] * self.zeta[i] * self.omega[i] * row, row, one))
        if slip and pressed:
            kinds.append(2)
            factors.append((self.friction * self._row(rates=enumerate(over), load=rest), slip * speed[SLIP], one))
        return tuple(kinds), np.array(factors)

    def stored(self, y: Vector, side: int) -> float:
        """Kinetic energy, and that of weight and modes."""
        q, p = self.q, y[: self.q]
        weight = self.m_tot * self.gravity * self.arm[side] * abs(p[TURN])
        weight -= 0.5 * self.l0r * self.gravity * p[TURN] ** 2
        strain = 0.5 * self.mass @ (self.omega * p[MODES:]) ** 2
        return float(0.5 * y[q:] @ self.mass_matrix(side) @ y[q:] + weight + strain)

    def after(self, key, name, y: Vector, ahead):
        side, y = key[0], y.copy()
        if name == "stop":
            y[self.q + SLIP] = 0.0
        if name == "land":
            return self._landed(side, y, ahead)
        sides = (side,) if side else (0, LIFTS.get(name, 1), -LIFTS.get(name, 1))
        return self._following(sides, y, ahead), y

    def _following(self, sides, y: Vector, ahead):
        speed = y[self.q + SLIP]
        if self.friction is None:
            slips = ((0, True),)
        elif speed:
            sign = 1 if speed > 0.0 else -1
            slips = ((sign, True), (sign, False))
        else:
            slips = ((0, True), (1, True), (-1, True), (1, False), (-1, False))
        for side in sides:
            for way in slips:
                if ahead.holds((side, *way), y):
                    return (side, *way)
        msg = f"nothing can follow {y} on {sides}"
        raise RuntimeError(msg)

    def _landed(self, side: int, y: Vector, ahead):
        spin, before = y[self.q + TURN], self.stored(y, side)
        y[TURN] = 0.0
        on = y.copy()
        on[self.q + TURN] = self.restitution * spin
        on[self.q + MODES :] += self.height * (1.0 - self.restitution) * spin
        key = None
        if on[self.q + TURN]:
            key = self._following((-side,), on, ahead)
            pull = ahead.rates(key, on)[self.q + TURN]
            if pull * spin < 0.0 and 2.0 * abs(on[self.q + TURN]) < self.shortest * abs(pull):
                key = None
        if key is None:
            on[self.q + TURN] = 0.0
            on[self.q + MODES :] = y[self.q + MODES :] + self.height * spin
            key = self._following((0, 1, -1), on, ahead)
        self.lost.append(before - self.stored(on, key[0]))
        return key, on

    def energies(self, track: Track) -> dict[str, float]:
        """Energies in J of a run from rest, and the error of their balance."""
        stored = self.stored(track.y, track.key[0])
        out = dict(zip(POWERS, track.work, strict=True)) | {"impacts": sum(self.lost), "stored": stored}
        return out | {"error": 2.0 * out["input"] - sum(out.values())}

    def run(self, record, dt, vertical=None, free=0.0, *, start=None, history=False) -> Track:
        key, y = ((0, 0, True), np.zeros(2 * self.q)) if start is None else start
        self.lost.clear()
        return Run(self, key, y, history=history).over(record, dt, vertical, free)
