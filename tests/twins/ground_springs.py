"""N modes on a base that stands on unilateral spring-dashpots, may fly, and slides where friction is given.

Freedoms: rotation θ, heave z of the base on the axis of the masses, slip x, and D_n. A spring at x_j goes down by
-z_j, z_j = z - x_j θ, and pushes with N_j = -k_j z_j - c_j z_j' where it is below the ground and this is positive:

    m_tot z'' = Σ N_j - m_tot (g + a_v)
    I_c θ'' + Σ m*_n h*_n D''_n + L x'' = L (g + a_v) θ - L a - Σ x_j N_j
    D''_n + 2 ζ_n ω_n D'_n + ω_n² D_n + h*_n θ'' + x'' = -a
    m_tot x'' + Σ m*_n D''_n + L θ'' = -m_tot a - sign(x') Σ μ_j N_j

A phase is a spring's state each (loaded, receding below the ground without force, lifted) and the slip's sign, 0 where
it sticks and None without friction. Outputs: θ, top, base moment, base shear, x, uplift of both edges.
"""

from dataclasses import dataclass, field

import numpy as np

from twins.pieces import Phase, Run, Track
from twins.result import Vector

GRAVITY = 9.81
LOADED, RECEDING, LIFTED = "loaded", "receding", "lifted"
TURN, HEAVE, SLIP, MODES = 0, 1, 2, 3
ROTATION, TOP, MOMENT, SHEAR, SLIDE, RIGHT_EDGE, LEFT_EDGE = range(7)
POWERS = ("input", "modes", "springs", "friction")


@dataclass
class SpringTwin:
    """The model; `inertia` is I_c, the edges of the base lie at ``edges`` = (right, left)."""

    omega: Vector
    mass: Vector
    height: Vector
    top: Vector
    zeta: Vector
    inertia: float
    l0r: float
    m_tot: float
    positions: Vector
    stiffness: Vector
    damping: Vector
    edges: tuple[float, float]
    friction: Vector | None = None
    gravity: float = GRAVITY
    outputs: Vector = field(init=False)
    n_powers: int = len(POWERS)

    def __post_init__(self) -> None:
        self.positions = np.atleast_1d(np.asarray(self.positions, float))
        count = self.positions.size
        self.stiffness = np.broadcast_to(np.asarray(self.stiffness, float), count)
        self.damping = np.broadcast_to(np.asarray(self.damping, float), count)
        if self.friction is not None:
            self.friction = np.broadcast_to(np.asarray(self.friction, float), count)
        self.q = MODES + self.omega.size
        self.known = {}
        d = slice(MODES, self.q)
        self.outputs = np.zeros((7, 2 * self.q))
        self.outputs[ROTATION, TURN] = 1.0
        self.outputs[TOP, d] = self.top
        self.outputs[MOMENT, d] = self.mass * self.height * self.omega**2
        self.outputs[SHEAR, d] = self.mass * self.omega**2
        self.outputs[SLIDE, SLIP] = 1.0
        for row, edge in zip((RIGHT_EDGE, LEFT_EDGE), self.edges, strict=True):
            self.outputs[row, [HEAVE, TURN]] = 1.0, -edge
        self.mass_matrix = M = np.zeros((self.q, self.q))
        M[TURN, TURN], M[HEAVE, HEAVE], M[SLIP, SLIP] = self.inertia, self.m_tot, self.m_tot
        M[TURN, SLIP] = M[SLIP, TURN] = self.l0r
        M[TURN, d] = M[d, TURN] = self.mass * self.height
        M[SLIP, d] = M[d, SLIP] = self.mass
        M[d, d] = np.diag(self.mass)

    @classmethod
    def of(cls, p, positions, stiffness, damping, base_inertia: float, **more) -> "SpringTwin":
        """The twin of a structure with the properties p."""
        modes = (p.omega, p.effective_mass, p.effective_height, p.top_ordinate, p.zeta)
        edges = (p.half_width - p.eccentricity, -p.half_width - p.eccentricity)
        inertia = p.translational_inertia + base_inertia
        return cls(*modes, inertia, p.l0r, p.m_tot, positions, stiffness, damping, edges, **more)

    def below(self, j: int) -> tuple[Vector, Vector]:
        """Rows over y of z_j and of the force -k z_j - c z_j'."""
        z, force = np.zeros(2 * self.q), np.zeros(2 * self.q)
        z[HEAVE], z[TURN] = 1.0, -self.positions[j]
        force[: self.q] = -self.stiffness[j] * z[: self.q]
        force[self.q :] = -self.damping[j] * z[: self.q]
        return z, force

    def pressed(self, key) -> tuple[Vector, Vector, Vector]:
        """Rows of Σ N_j, Σ x_j N_j and Σ μ_j N_j."""
        total, moment, grip = np.zeros((3, 2 * self.q))
        for j, state in enumerate(key[0]):
            if state == LOADED:
                force = self.below(j)[1]
                total += force
                moment += self.positions[j] * force
                if self.friction is not None:
                    grip += self.friction[j] * force
        return total, moment, grip

    def phase(self, key) -> Phase:
        if key not in self.known:
            self.known[key] = self._phase(key)
        return self.known[key]

    def _phase(self, key) -> Phase:
        q, d = self.q, slice(MODES, self.q)
        total, moment, grip = self.pressed(key)
        force, by_vertical, load = np.zeros((q, 2 * q)), np.zeros((q, 2 * q)), np.zeros((q, 3))
        force[TURN] = -moment
        force[TURN, TURN] += self.l0r * self.gravity
        by_vertical[TURN, TURN] = self.l0r
        force[HEAVE] = total
        force[d, d] = -np.diag(self.mass * self.omega**2)
        force[d, q + MODES :] = -np.diag(2.0 * self.mass * self.zeta * self.omega)
        load[TURN, 1], load[HEAVE], load[SLIP, 1] = (
            -self.l0r,
            (-self.m_tot * self.gravity, 0.0, -self.m_tot),
            -self.m_tot,
        )
        load[d, 1] = -self.mass
        slip = key[1]
        if slip:
            force[SLIP] -= slip * grip
        free = [i for i in range(q) if i != SLIP or slip]
        inverse = np.zeros((q, q))
        inverse[np.ix_(free, free)] = np.linalg.inv(self.mass_matrix[np.ix_(free, free)])
        rate, rate_v, loads = np.zeros((2 * q, 2 * q)), np.zeros((2 * q, 2 * q)), np.zeros((2 * q, 3))
        rate[free, [q + i for i in free]] = 1.0
        rate[q:], rate_v[q:], loads[q:] = inverse @ force, inverse @ by_vertical, inverse @ load
        names, guards = self._guards(key, grip)
        return Phase(rate, rate_v, loads, names, guards, *self._powers(key, grip))

    def _guards(self, key, grip: Vector) -> tuple[tuple, Vector]:
        names, rows = [], []

        def add(name, over_y: Vector, over_rate: Vector | None = None, load=(0.0, 0.0, 0.0)) -> None:
            names.append(name)
            rows.append(np.concatenate((over_y, np.zeros(2 * self.q) if over_rate is None else over_rate, load)))

        for j, state in enumerate(key[0]):
            z, force = self.below(j)
            if state == LOADED:
                add(("empty", j), force)
            elif state == LIFTED:
                add(("land", j), z)
            else:
                add(("leave", j), -z)
                add(("load", j), -force)
        for side in (1.0, -1.0):
            add("overturn", -side * np.eye(2 * self.q)[TURN], load=(0.5 * np.pi, 0.0, 0.0))
        if key[1]:
            moving = np.zeros(2 * self.q)
            moving[self.q + SLIP] = key[1]
            add("stop", moving)
        elif key[1] == 0:
            hold = np.zeros(2 * self.q)
            hold[self.q :] = self.mass_matrix[SLIP]
            add("slide", grip, hold, (0.0, self.m_tot, 0.0))
            add("slide", grip, -hold, (0.0, -self.m_tot, 0.0))
        return tuple(names), np.array(rows).reshape(len(rows), 4 * self.q + 3)

    def _powers(self, key, grip: Vector) -> tuple[tuple, Vector]:
        """Which of `POWERS` the product of three rows over w adds to, and these rows."""
        q, kinds, factors = self.q, [], []
        one, a, a_v = np.eye(4 * q + 3)[-3:]

        def over(values: Vector, start: int) -> Vector:
            row = np.zeros(4 * q + 3)
            row[start : start + values.size] = values
            return row

        def add(name, *rows: Vector) -> None:
            kinds.append(POWERS.index(name))
            factors.append([*rows, one][:3])

        unit = np.eye(q)
        add("input", over(-self.mass_matrix[SLIP], q), a)
        add("input", over(-self.m_tot * unit[HEAVE], q), a_v)
        add("input", over(self.l0r * unit[TURN], 0), over(unit[TURN], q), a_v)
        for i, c in enumerate(2.0 * self.mass * self.zeta * self.omega):
            add("modes", over(c * unit[MODES + i], q), over(unit[MODES + i], q))
        for j, state in enumerate(key[0]):
            z = self.below(j)[0][:q]
            if state == LOADED:
                add("springs", over(self.damping[j] * z, q), over(z, q))
            elif state == RECEDING:
                add("springs", over(-self.stiffness[j] * z, 0), over(z, q))
        if key[1]:
            add("friction", over(grip, 0), over(key[1] * unit[SLIP], q))
        return tuple(kinds), np.array(factors)

    def stored(self, y: Vector) -> float:
        """Kinetic energy, and that of weight, modes and springs; zero with the base on the ground without load."""
        q, p = self.q, y[: self.q]
        sunk = np.minimum(p[HEAVE] - self.positions * p[TURN], 0.0)
        weight = self.m_tot * self.gravity * p[HEAVE] - 0.5 * self.l0r * self.gravity * p[TURN] ** 2
        strain = 0.5 * self.mass @ (self.omega * p[MODES:]) ** 2 + 0.5 * self.stiffness @ sunk**2
        return float(0.5 * y[q:] @ self.mass_matrix @ y[q:] + weight + strain)

    def after(self, key, name, y: Vector, ahead):
        springs, slip = list(key[0]), key[1]
        if isinstance(name, tuple):
            what, j = name
            after = {
                "empty": RECEDING if self.damping[j] > 0.0 else LIFTED,
                "land": LOADED,
                "leave": LIFTED,
                "load": LOADED,
            }
            springs[j] = after[what]
            return (tuple(springs), slip), y
        y = y.copy()
        y[self.q + SLIP] = 0.0
        for way in (0, 1, -1):
            if ahead.holds((key[0], way), y):
                return (key[0], way), y
        return (key[0], -slip if name == "stop" else 0), y

    def standing(self) -> tuple[tuple, Vector]:
        """Static equilibrium under gravity: which springs carry, and the state."""
        carries = np.ones(self.positions.size, bool)
        for _ in range(100):
            k, x = self.stiffness * carries, self.positions
            matrix = np.array([[k.sum(), -(k @ x)], [-(k @ x), k @ x**2 - self.l0r * self.gravity]])
            heave, turn = np.linalg.solve(matrix, [-self.m_tot * self.gravity, 0.0])
            below = heave - x * turn < 0.0
            if np.array_equal(below, carries):
                break
            carries = below
        else:
            msg = "no static equilibrium"
            raise RuntimeError(msg)
        y = np.zeros(2 * self.q)
        y[TURN], y[HEAVE] = turn, heave
        springs = tuple(LOADED if each else LIFTED for each in carries)
        return (springs, None if self.friction is None else 0), y

    def energies(self, track: Track, start: float) -> dict[str, float]:
        """Energies in J of a run that began with `start` stored, and the error of their balance."""
        out = dict(zip(POWERS, track.work, strict=True)) | {"stored": self.stored(track.y) - start}
        return out | {"error": 2.0 * out["input"] - sum(out.values())}

    def run(self, record, dt, vertical=None, free=0.0, *, start=None, history=False) -> Track:
        key, y = self.standing() if start is None else start
        return Run(self, key, y, history=history).over(record, dt, vertical, free)
