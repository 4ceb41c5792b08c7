"""Complete models with friction dampers, slip, springs and vertical motion, by SciPy's DOP853 with events.

Nothing here knows body axes, rows or bordered systems. A mode is a particle of mass m* at the height h*, which moves
by D across the axis of the base; what the modes leave over is a rigid body on that axis. Positions are those in the
axes of the ground, the mass matrix and the inertia forces follow from their Jacobians, and reactions are multipliers
of constraints.
"""

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.81
AT_ONCE = 1e-9  # of a sample
RTOL = 1e-11


@dataclass
class Bar:
    """An elastoplastic bar with kinematic hardening; `way` is 1 or -1 while it yields up or down."""

    stiffness: float
    yield_force: float = np.inf
    ratio: float = 0.0
    position: float = 0.0
    initial: float = 0.0
    plastic: float = 0.0
    way: int = 0
    offset: float = 0.0  # of its elongation, at which it is as built

    def force(self, stretch: float) -> float:
        elastic = stretch + self.initial / self.stiffness
        inner = self.stiffness * (elastic - self.plastic) if self.way == 0 else self.way * self.yield_force
        return self.ratio * self.stiffness * elastic + (1.0 - self.ratio) * inner

    def inner(self, stretch: float) -> float:
        return self.stiffness * (stretch + self.initial / self.stiffness - self.plastic)


@dataclass
class Dashpot:
    coefficient: float
    position: float = 0.0


@dataclass
class Slider:
    limit: float
    position: float = 0.0


@dataclass(frozen=True)
class Phase:
    side: int = 0
    slip: int = 0  # 1, -1: it slides; 2, -2: so without pressure
    held: bool = False
    way: int = 0  # of θ' while friction dampers slide
    loaded: tuple[bool, ...] = ()


@dataclass
class Twin:
    """A base of properties `p`, on rigid ground or on springs at `places` with stiffnesses `k` and dashpots `c`."""

    p: object
    friction: float | None = None
    places: np.ndarray | None = None
    k: np.ndarray | None = None
    c: np.ndarray | None = None
    base_inertia: float = 0.0
    bars: list = field(default_factory=list)
    dashpots: list = field(default_factory=list)
    sliders: list = field(default_factory=list)
    restitution: float = 0.0

    def __post_init__(self):
        p = self.p
        self.n = p.n_modes
        self.m, self.h = np.array(p.effective_mass), np.array(p.effective_height)
        self.w, self.zeta = np.array(p.omega), np.array(p.zeta)
        self.sprung = self.places is not None
        self.rest_mass = p.m_tot - self.m.sum()
        self.rest_height = (p.l0r - self.m @ self.h) / self.rest_mass
        about_axis = p.i_theta - p.m_tot * p.half_width**2  # `i_theta` is about a pivot at the distance B
        if self.sprung:
            about_axis = p.translational_inertia + self.base_inertia
        self.rest_inertia = about_axis - self.m @ self.h**2 - self.rest_mass * self.rest_height**2
        self.count = self.n + 3
        self.peaks = np.zeros(4)
        self.counts = {"uplift": 0, "impact": 0}
        self.track = []

    def arm(self, side):
        return side * self.p.half_width - self.p.eccentricity if side else 0.0

    def bodies(self, q, phase):
        """Mass, inertia, position across the axis, its place in q or -1, height."""
        o = 0.0 if self.sprung else self.arm(phase.side)
        found = [(self.m[i], 0.0, q[i] - o, i, self.h[i]) for i in range(self.n)]
        return [*found, (self.rest_mass, self.rest_inertia, -o, -1, self.rest_height)]

    def mass_and_bias(self, q, v, phase):
        n = self.n
        turn, spin = q[n], v[n]
        s, c = np.sin(turn), np.cos(turn)
        M, bias, first = np.zeros((self.count, self.count)), np.zeros(self.count), np.zeros((2, self.count))
        for mass, inertia, across, place, height in self.bodies(q, phase):
            J = np.zeros((2, self.count))
            J[0, n + 1] = J[1, n + 2] = 1.0
            J[:, n] = -across * s + height * c, -across * c - height * s
            sideways = 0.0
            if place >= 0:
                J[:, place], sideways = (c, -s), v[place]
            curve = np.array(
                [
                    -2.0 * sideways * spin * s - (across * c + height * s) * spin**2,
                    -2.0 * sideways * spin * c + (across * s - height * c) * spin**2,
                ]
            )
            M += mass * J.T @ J
            M[n, n] += inertia
            bias += mass * J.T @ curve
            first += mass * J
        return M, bias, first

    def stretch(self, x, q, phase):
        n = self.n
        if self.sprung:
            return q[n + 2] - x * np.sin(q[n]) - (self.at_rest[1] - x * np.sin(self.at_rest[0]))
        if phase.side == 0:
            return 0.0
        return (
            abs(self.arm(phase.side) - x)
            * 2.0
            * np.sin(0.5 * abs(q[n]))
            * np.sign(phase.side * (self.arm(phase.side) - x))
        )

    def gradient(self, x, q, phase):
        """Of the elongation: dδ/dθ, and dδ/dZ."""
        n = self.n
        if self.sprung:
            return -x * np.cos(q[n]), 1.0
        if phase.side == 0:
            return 0.0, 1.0
        return (self.arm(phase.side) - x) * np.cos(0.5 * q[n]), np.cos(0.5 * q[n])

    def depth(self, q):
        return q[self.n + 2] - self.places * np.sin(q[self.n])

    def push(self, q, v):
        return -self.k * self.depth(q) - self.c * (v[self.n + 2] - self.places * np.cos(q[self.n]) * v[self.n])

    def solve(self, q, v, a, a_v, phase):
        """Accelerations and multipliers of θ, X, Z."""
        n, count = self.n, self.count
        M, bias, first = self.mass_and_bias(q, v, phase)
        Q = -bias - a * first[0] - (GRAVITY + a_v) * first[1]
        Q[:n] -= self.m * (self.w**2 * q[:n] + 2.0 * self.zeta * self.w * v[:n])
        for each in (*self.bars, *self.dashpots, *self.sliders):
            turn, rise = self.gradient(each.position, q, phase)
            if isinstance(each, Bar):
                force = each.force(self.stretch(each.position, q, phase))
            elif isinstance(each, Dashpot):
                force = each.coefficient * (turn * v[n] + (v[n + 2] if self.sprung else 0.0))
            else:
                force = 0.0 if phase.held or not phase.side else each.limit * np.sign(turn * phase.way)
            Q[n] -= force * turn
            Q[n + 2] -= force * rise
        grip = 0.0
        if self.sprung:
            push = np.where(phase.loaded, self.push(q, v), 0.0)
            Q[n + 2] += push.sum()
            Q[n] -= (push * self.places).sum() * np.cos(q[n])
            grip = self.friction * push.sum() if self.friction is not None else 0.0
        fixed = [bool((phase.side == 0 and not self.sprung) or phase.held), phase.slip == 0, not self.sprung]
        A, b = np.zeros((count + 3, count + 3)), np.zeros(count + 3)
        A[:count, :count], b[:count] = M, Q
        for k in range(3):
            if fixed[k]:
                A[n + k, count + k] = -1.0
                A[count + k, n + k] = 1.0
            else:
                A[count + k, count + k] = 1.0
        if phase.slip and self.sprung:
            b[n + 1] -= np.sign(phase.slip) * grip
        elif abs(phase.slip) == 1:
            A[n + 1, count + 2] += phase.slip * self.friction
        x = np.linalg.solve(A, b)
        return x[:count], x[count:], grip

    def rates(self, t, y, phase, ground):
        q, v = y[: self.count], y[self.count :]
        return np.concatenate((v, self.solve(q, v, *ground(t), phase)[0]))

    def conditions(self, phase):
        """Name, function of time and state that is positive while the phase lasts, and the phase that follows."""
        n, count, found = self.n, self.count, []

        def part(place, factor):
            return lambda t, y, ground: factor * y[place]

        side = phase.side
        if not self.sprung:
            if side == 0 or phase.held:
                for turn in (1, -1):
                    free = replace(phase, side=side or turn, held=False, way=turn)
                    found.append(("uplift" if side == 0 else "release", self.uplifts(phase, free, turn), free))
            else:
                found.append(("impact", part(n, float(side)), replace(phase, side=0, held=False, way=0)))
                if self.sliders:
                    found.append(("turn", part(count + n, float(phase.way)), replace(phase, held=True, way=0)))
        else:
            for j, loaded in enumerate(phase.loaded):
                other = tuple(not each if k == j else each for k, each in enumerate(phase.loaded))
                after = replace(phase, loaded=other)
                if loaded:
                    found.append(("empty", lambda t, y, g, j=j: self.push(y[:count], y[count:])[j], after))
                else:

                    def gap(t, y, g, j=j):
                        return max(self.depth(y[:count])[j], -self.push(y[:count], y[count:])[j] / self.k[j])

                    found.append(("fill", gap, after))
        if self.friction is not None:
            found += self.slips(phase)
        for k, bar in enumerate(self.bars):
            if not (side or self.sprung) or not np.isfinite(bar.yield_force):
                continue
            if bar.way == 0:
                for way in (1, -1):

                    def room(t, y, g, bar=bar, way=way):
                        inner = bar.inner(self.stretch(bar.position, y[:count], phase))
                        return 1.0 - way * inner / bar.yield_force

                    found.append(("yield", room, (k, way)))
            else:

                def speed(t, y, g, bar=bar):
                    turn, rise = self.gradient(bar.position, y[:count], phase)
                    return bar.way * (turn * y[count + n] + (rise * y[count + n + 2] if self.sprung else 0.0))

                found.append(("back", speed, (k, 0)))
        return found

    def uplifts(self, phase, free, turn):
        count = self.count
        still = replace(free, held=True)

        def value(t, y, ground):
            # The moment about the pivot that would keep θ'' = 0 with the elements of the phase that follows.
            kept = self.sliders
            _, forces, _ = self.solve(y[:count], y[count:], *ground(t), still)
            moment = forces[0]
            for each in kept:
                grad, _ = self.gradient(each.position, y[:count], free)
                moment += each.limit * np.sign(grad * turn) * grad
            return turn * moment

        return value

    def slips(self, phase):
        count, n, found = self.count, self.n, []

        def demand(t, y, ground):
            _, forces, grip = self.solve(y[:count], y[count:], *ground(t), phase)
            return forces[1], grip if self.sprung else self.friction * forces[2], forces[2]

        if phase.slip == 0:
            for way in (1, -1):  # the ground pushes against the motion that follows

                def value(t, y, ground, way=way):
                    held, most, _ = demand(t, y, ground)
                    return most + way * held

                found.append(("slip", value, replace(phase, slip=way)))
            return found
        way = 1 if phase.slip > 0 else -1
        found.append(("stick", lambda t, y, g: way * y[count + n + 1], replace(phase, slip=0)))
        if not self.sprung:
            sign = 1.0 if abs(phase.slip) == 1 else -1.0
            after = replace(phase, slip=way * (2 if sign > 0.0 else 1))
            found.append(("pressure", lambda t, y, g: sign * demand(t, y, g)[2], after))
        return found

    def leave(self, name, after, y, phase):
        n, count = self.n, self.count
        y = y.copy()
        if name in self.counts:
            self.counts[name] += 1
        if name == "impact":
            y[count : count + n] += (1.0 - self.restitution) * self.h * y[count + n]
            y[count + n] *= self.restitution
            y[n] = 0.0
            for bar in self.bars:
                self.hold(bar, y, phase)
        elif name == "turn":
            y[count + n] = 0.0
        elif name == "stick":
            y[count + n + 1] = 0.0
        elif name in ("yield", "back"):
            k, way = after
            if way == 0:
                self.hold(self.bars[k], y, phase)
            self.bars[k].way = way
            return y, phase
        return y, after

    def hold(self, bar, y, phase):
        """A bar that yields becomes elastic, and keeps its plastic stretch."""
        if bar.way:
            stretch = self.stretch(bar.position, y[: self.count], phase) + bar.initial / bar.stiffness
            bar.plastic, bar.way = stretch - bar.way * bar.yield_force / bar.stiffness, 0

    def run(self, acceleration, dt, vertical=None, start=None):
        n, count = self.n, self.count
        rise = np.zeros(len(acceleration)) if vertical is None else np.asarray(vertical)
        y, phase = np.zeros(2 * count), Phase()
        self.last_depth = np.full(2, -1.0)
        fresh = True  # what begins at a border may soon come back to it
        self.at_rest = (0.0, 0.0)
        if self.sprung:
            pull = sum(each.initial for each in self.bars)
            y[n + 2] = -(self.p.m_tot * GRAVITY + pull) / self.k.sum()
            self.at_rest = (0.0, y[n + 2])
            phase = replace(phase, loaded=(True,) * len(self.places))
        if start is not None:
            y, phase = start(self, y, phase)
        size = 1e-3 * np.concatenate((np.ones(n), [1e-1, 1.0, 1.0], 10.0 * np.ones(n), [1.0, 10.0, 10.0]))
        for i in range(len(acceleration) - 1):
            t, end = i * dt, (i + 1) * dt

            def ground(time, i=i):
                u = time / dt - i
                return (
                    acceleration[i] + u * (acceleration[i + 1] - acceleration[i]),
                    rise[i] + u * (rise[i + 1] - rise[i]),
                )

            again = begun = 0
            while t < end:
                begun += 1
                if begun > 500:
                    msg = f"events accumulate at {t} s: {self.track[-6:]}"
                    raise RuntimeError(msg)
                known = self.conditions(phase)
                failed = [(each(t, y, ground) / self.size(name), name, after) for name, each, after in known]
                failed = [each for each in failed if each[0] < -1e-9]
                if failed and again < 30:
                    _, name, after = min(failed, key=lambda each: each[0])
                    y, phase = self.leave(name, after, y, phase)
                    again, fresh = again + 1, True
                    continue
                events = []
                for _, each, _ in known:

                    def event(time, state, each=each, ground=ground):
                        return each(time, state, ground)

                    event.terminal, event.direction = True, -1.0
                    events.append(event)
                until = min(t + 0.05 * dt, end) if fresh else end
                found = solve_ivp(
                    lambda time, state, phase=phase, ground=ground: self.rates(time, state, phase, ground),
                    (t, until), y, "DOP853", events=events, rtol=RTOL, atol=10.0 * RTOL * size, dense_output=True,
                    max_step=(0.01 if fresh else 0.5) * dt,
                )  # fmt: skip
                self.note(found, phase)
                t, y, fresh = found.t[-1], found.y[:, -1], found.status == 1
                if found.status == 1:
                    which = next(k for k, each in enumerate(found.t_events) if each.size)
                    name, _, after = known[which]
                    self.track.append((t, name))
                    y, phase = self.leave(name, after, y, phase)
                    again = 0
                    if end - t < AT_ONCE * dt:
                        break
        return y, phase

    def size(self, name):
        weight, turning = self.p.m_tot * GRAVITY, self.p.m_tot * GRAVITY * self.p.half_width
        known = {"pressure": weight, "empty": weight, "uplift": turning, "release": turning}
        return known.get(name, 1.0) if name != "slip" else float(np.max(self.friction)) * weight

    def note(self, found, phase):
        """Raise the peaks of |θ|, of the first D and of the slip."""
        n = self.n
        places = [n, 0, n + 1] if n else [0, 0, 1]
        times = np.linspace(found.t[0], found.t[-1], 24)
        if self.sprung:
            depths = np.array([self.depth(y[: self.count])[[0, -1]] for y in found.sol(times).T])
            depths = np.vstack((self.last_depth, depths))
            self.counts["uplift"] += int(((depths[:-1] < 0.0) & (depths[1:] >= 0.0)).sum())
            self.counts["impact"] += int(((depths[:-1] >= 0.0) & (depths[1:] < 0.0)).sum())
            self.last_depth = depths[-1]
        values = np.abs(found.sol(times)[places])
        for row, of_row in enumerate(values):
            k = int(np.argmax(of_row))
            best = of_row[k]
            if 0 < k < len(times) - 1:
                low, high = times[k - 1], times[k + 1]
                for _ in range(3):
                    grid = np.linspace(low, high, 41)
                    of_grid = np.abs(found.sol(grid)[places[row]])
                    j = int(np.argmax(of_grid))
                    best = max(best, of_grid[j])
                    low, high = grid[max(j - 1, 0)], grid[min(j + 1, 40)]
            self.peaks[row] = max(self.peaks[row], best)
