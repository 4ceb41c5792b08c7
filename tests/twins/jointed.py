"""A structure with joints in floor coordinates, without modes: DOP853 from event to event, for a few seconds."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
G = 9.81


class JointedTwin:
    """Masses at heights over a base of some mass, with a stiffness K and damping C; joints are (height, half width)."""

    def __init__(
        self, m: Array, z: Array, K: Array, C: Array, base_mass: float, joints: Sequence[tuple[float, float]]
    ) -> None:
        self.m, self.K, self.C, self.n, self.J = m, K, C, len(m), len(joints)
        Z, self.B = np.array(joints).T
        self.lever = np.maximum(z[:, None] - Z, 0.0)
        self.W = np.array([m[z >= each].sum() for each in Z])
        self.W[0] += base_mass
        ends = np.append(Z[1:], np.inf)
        segments = np.clip(z[:, None], Z, ends) - Z  # of each mass, the lengths of the segments below it
        segments[z[:, None] < Z] = 0.0
        sums = np.tril(np.ones((self.J, self.J)))
        self.lean = G * sum(mass * sums.T @ np.diag(each) @ sums for mass, each in zip(m, segments, strict=True))

    def mass(self, s: Array) -> Array:
        lift = s * self.B
        below = self.m[:, None] * self.lever
        rotary = self.lever.T @ below + np.outer(lift, lift) * np.minimum(self.W[:, None], self.W)
        return np.block([[np.diag(self.m), below], [below.T, rotary]])

    def forces(self, y: Array, a: float, s: Array) -> Array:
        n, q, v = self.n, y[: self.n + self.J], y[self.n + self.J :]
        floors = -self.K @ q[:n] - self.C @ v[:n] - self.m * a
        turns = -self.lever.T @ (self.m * a) + self.lean @ q[n:] - G * s * self.B * self.W
        return np.concatenate((floors, turns))

    def accelerations(self, y: Array, a: float, s: Array) -> Array:
        free = np.append(np.ones(self.n, bool), s != 0.0)
        found = np.zeros(free.size)
        found[free] = np.linalg.solve(self.mass(s)[np.ix_(free, free)], self.forces(y, a, s)[free])
        return found

    def excess(self, y: Array, a: float, s: Array, j: int, side: float) -> float:
        """Moment that would open a closed joint to a side, over that of the weight."""
        opened = s.copy()
        opened[j] = side
        lacking = self.forces(y, a, opened) - self.mass(opened) @ self.accelerations(y, a, s)
        return side * lacking[self.n + j] / (G * self.B[j] * self.W[j])

    def run(self, acceleration: Array, dt: float) -> tuple[Array, list[int]]:
        """The last state, and which joints opened, in their order; the acceleration is linear between samples."""
        y, s, opened = np.zeros(2 * (self.n + self.J)), np.zeros(self.J), list[int]()
        for k in range(acceleration.size - 1):
            t, slope = 0.0, (acceleration[k + 1] - acceleration[k]) / dt
            while t < dt:
                s = self.settled(y, acceleration[k] + slope * t, s, opened)
                y, t, j = self.until_event(y, s, t, dt, acceleration[k], slope)
                if j is None:
                    continue
                if s[j] != 0.0:
                    y, s = self.land(y, s, j)
                else:  # its excess is zero but for rounding
                    s = self.opened(y, acceleration[k] + slope * t, s, j)
                    opened.append(j)
        return y, opened

    def settled(self, y: Array, a: float, s: Array, opened: list[int]) -> Array:
        while True:
            found = [
                (self.excess(y, a, s, j, side), j, side) for j in range(self.J) if s[j] == 0.0 for side in (1.0, -1.0)
            ]
            most = max(found, default=(0.0, 0, 0.0))
            if most[0] <= 0.0:
                return s
            s = s.copy()
            s[most[1]] = most[2]
            opened.append(most[1])

    def opened(self, y: Array, a: float, s: Array, j: int) -> Array:
        s = s.copy()
        s[j] = max((1.0, -1.0), key=lambda side: self.excess(y, a, s, j, side))
        return s

    def land(self, y: Array, s: Array, j: int) -> tuple[Array, Array]:
        free = np.append(np.ones(self.n, bool), s != 0.0)
        kick, after, place = np.zeros(free.size), y.copy(), self.n + j
        kick[free] = np.linalg.solve(self.mass(s)[np.ix_(free, free)], np.eye(free.size)[place][free])
        after[free.size :] -= kick * y[free.size + place] / kick[place]
        after[[place, free.size + place]] = 0.0
        closed = s.copy()
        closed[j] = 0.0
        return after, closed

    def until_event(
        self, y: Array, s: Array, t: float, dt: float, a: float, slope: float
    ) -> tuple[Array, float, int | None]:
        """The state and the time at which a joint lands or opens, and which; None at the end of the interval."""
        size = self.n + self.J

        def rates(time: float, y: Array) -> Array:
            return np.concatenate((y[size:], self.accelerations(y, a + slope * time, s)))

        events, joints = list[Callable[[float, Array], float]](), list[int]()
        for j in range(self.J):
            if s[j] != 0.0:
                events.append(lambda time, y, j=j: s[j] * y[self.n + j] + (1e-300 if time <= t else 0.0))
                joints.append(j)
                continue
            for side in (1.0, -1.0):
                events.append(lambda time, y, j=j, side=side: -self.excess(y, a + slope * time, s, j, side))
                joints.append(j)
        for each in events:
            each.terminal, each.direction = True, -1.0  # pyright: ignore[reportFunctionMemberAccess]
        found = solve_ivp(rates, (t, dt), y, "DOP853", events=events, rtol=1e-12, atol=1e-15)
        if found.status != 1:
            return found.y[:, -1], dt, None
        first = next(j for j, times in zip(joints, found.t_events, strict=True) if times.size)
        return found.y[:, -1], float(np.nextafter(found.t[-1], np.inf)), first
