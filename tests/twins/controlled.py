"""Controlled rocking by adaptive integration with events (SciPy): dampers, fuses, tendons that yield, friction.

Equations 15 and 23-25 of Silva & Stojadinović 2024 about each pivot, with the moment -s F r of every element at the
distance r from the pivot, stretched by r |θ|. State ``[θ, θ', D, D']``. Elements change their branch at events, so the
field is linear in between. Every sample is integrated anew; with ``whole`` the solver gets the record at once, as a
user would call it.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from twins.result import Ledger, TwinResult, Vector

GRAVITY = 9.81
ELASTIC, UP, DOWN, SLACK, BROKEN = "elastic", "up", "down", "slack", "broken"
NEAR = 1e-10  # of a sample
TERMS = 14


@dataclass
class Dashpot:
    """F = c δ'."""

    coefficient: float
    position: float = 0.0

    def tangent(self) -> tuple[float, float, float]:
        return 0.0, self.coefficient, 0.0


@dataclass
class Slider:
    """F = ± F_0 in the `direction` of δ'; 0 while it sticks."""

    force: float
    position: float = 0.0
    direction: float = 0.0

    def tangent(self) -> tuple[float, float, float]:
        return 0.0, 0.0, self.direction * self.force


@dataclass
class Bar:
    """F = α k e + (1 - α) z with z' = k e' while |z| < F_y, e = δ + `stretched`; without compression if `no_push`."""

    stiffness: float
    yield_force: float
    post_yield_ratio: float = 0.0
    position: float = 0.0
    stretched: float = 0.0
    no_push: bool = False
    rupture: float = np.inf
    plastic: float = 0.0
    branch: str = ELASTIC

    def tangent(self) -> tuple[float, float, float]:
        """Stiffness, damping, and the force at δ = δ' = 0 on the branch."""
        k, a = self.stiffness, self.post_yield_ratio
        if self.branch in (SLACK, BROKEN):
            return 0.0, 0.0, 0.0
        if self.branch == ELASTIC:
            return k, 0.0, k * self.stretched - (1.0 - a) * k * self.plastic
        sign = 1.0 if self.branch == UP else -1.0
        return a * k, 0.0, a * k * self.stretched + sign * (1.0 - a) * self.yield_force

    @property
    def reach(self) -> float:
        """Stretch from zero force to the first yield."""
        return self.yield_force / self.stiffness

    def limits(self) -> tuple[float, str, float, str]:
        """Stretches δ that end an elastic or a slack branch, and what follows."""
        a, reach = self.post_yield_ratio, self.reach
        empty = (1.0 - a) * self.plastic - self.stretched
        if self.branch == BROKEN:
            return -np.inf, "", np.inf, ""
        if self.branch == SLACK:
            return -np.inf, "", empty, ELASTIC
        low, below = self.plastic - reach - self.stretched, DOWN
        if self.no_push and empty > low:
            low, below = empty, SLACK
        high = self.plastic + reach - self.stretched
        return (low, below, high, UP) if high < self.rupture else (low, below, self.rupture, BROKEN)

    def emptied(self) -> float:
        """Stretch δ at which a bar that yields downwards and cannot push is without force."""
        if self.branch != DOWN or not self.no_push or self.post_yield_ratio == 0.0:
            return -np.inf
        return (1.0 / self.post_yield_ratio - 1.0) * self.reach - self.stretched

    def slacken(self, delta: float) -> None:
        """Become slack at the stretch δ."""
        self.settle(delta)
        self.branch = SLACK

    def settle(self, delta: float) -> None:
        """Leave a yielding branch for the elastic one at the stretch δ."""
        if self.branch in (UP, DOWN):
            sign = 1.0 if self.branch == UP else -1.0
            self.plastic = delta + self.stretched - sign * self.yield_force / self.stiffness
            self.branch = ELASTIC

    def rest(self) -> None:
        """The branch while the base is closed."""
        if self.branch == BROKEN:
            return
        self.settle(0.0)
        self.branch = ELASTIC
        if self.no_push and self.tangent()[2] < 0.0:
            self.branch = SLACK


@dataclass
class ControlledTwin:
    """The model with its elements, and the run."""

    omega: Vector
    mass: Vector
    height: Vector
    top: Vector
    zeta: Vector
    i_theta: tuple[float, float]  # about the right pivot and the left one
    arms: tuple[float, float]  # B_r and B_l
    l0r: float
    m_tot: float
    elements: list
    rtol: float = 1e-11
    method: str = "DOP853"
    whole: bool = False
    energy: Vector = field(init=False)

    def __post_init__(self) -> None:
        n = self.n = self.omega.size
        d, v = slice(2, 2 + n), slice(2 + n, 2 + 2 * n)
        self.guard = np.zeros(2 + 2 * n)
        self.guard[d] = -self.mass * self.height * self.omega**2
        self.guard[v] = -self.mass * self.height * 2.0 * self.zeta * self.omega
        self.guard_a = self.l0r - self.mass @ self.height
        self.outputs = np.zeros((4, 2 + 2 * n))
        self.outputs[0, 0] = 1.0
        self.outputs[1, d] = self.top
        self.outputs[2, d] = self.mass * self.height * self.omega**2
        self.outputs[3, d] = self.mass * self.omega**2

    @classmethod
    def of(cls, p, elements, **more) -> "ControlledTwin":
        """The twin of a structure with the properties p."""
        arms = (p.half_width - p.eccentricity, p.half_width + p.eccentricity)
        inertia = tuple(p.i_theta + p.m_tot * (arm**2 - p.half_width**2) for arm in arms)
        modes = p.omega, p.effective_mass, p.effective_height, p.top_ordinate, np.broadcast_to(p.zeta, p.omega.shape)
        return cls(*modes, inertia, arms, p.l0r, p.m_tot, list(elements), **more)

    def arm(self, element, side: int) -> float:
        return self.arms[0] - element.position if side > 0 else self.arms[1] + element.position

    def field_of(self, side: int) -> tuple[Vector, Vector, Vector]:
        """A, the factor of a, and the constant of y' = A y + .. on the present branches."""
        n, size = self.n, 2 + 2 * self.n
        d, v = slice(2, 2 + n), slice(2 + n, 2 + 2 * n)
        A, by_a, rest = np.zeros((size, size)), np.zeros(size), np.zeros(size)
        A[d, v] = np.eye(n)
        A[v, d], A[v, v] = -np.diag(self.omega**2), -np.diag(2.0 * self.zeta * self.omega)
        by_a[v] = -1.0
        if side == 0:
            return A, by_a, rest
        place = 0 if side > 0 else 1
        inertia = self.i_theta[place] - self.mass @ self.height**2
        turn = -self.guard / inertia
        turn[0] = self.l0r * GRAVITY / inertia
        constant = -side * self.m_tot * GRAVITY * self.arms[place]
        for each in self.elements:
            r = self.arm(each, side)
            k, c, force = each.tangent()
            turn[0] -= k * r**2 / inertia
            turn[1] -= c * r**2 / inertia
            constant -= side * force * r
        A[0, 1], A[1] = 1.0, turn
        A[v] -= np.outer(self.height, turn)
        by_a[1] = -self.guard_a / inertia
        by_a[v] -= self.height * by_a[1]
        rest[1] = constant / inertia
        rest[v] = -self.height * rest[1]
        return A, by_a, rest

    def thresholds(self) -> tuple[float, float]:
        """Overturning moments below and above which the base lifts to the right and to the left."""
        weight = self.m_tot * GRAVITY
        right, left = weight * self.arms[0], weight * self.arms[1]
        for each in self.elements:
            if isinstance(each, Slider):
                right += each.force * abs(self.arm(each, 1))
                left += each.force * abs(self.arm(each, -1))
                continue
            force = each.tangent()[2]
            right += force * self.arm(each, 1)
            left += force * self.arm(each, -1)
        return -right, left

    def side_wanted(self, y: Vector, a: float) -> int:
        moment = self.guard @ y + self.guard_a * a
        low, high = self.thresholds()
        return 1 if moment < low else -1 if moment > high else 0

    def run(self, record: Vector, dt: float, free: float = 0.0) -> TwinResult:
        record = np.asarray(record, float)
        end = dt * (record.size - 1)
        segments = [(k * dt, dt, record[k : k + 2]) for k in range(record.size - 1)]
        if self.whole:
            segments = [(0.0, end, record)]
        segments += [(end + k * dt, dt, np.zeros(2)) for k in range(int(np.ceil(free / dt - 1e-9)))]
        self.dt = dt
        self.y, self.side, self.held, self.ledger = np.zeros(2 + 2 * self.n), 0, False, Ledger()
        for each in self.elements:
            if isinstance(each, Bar):
                each.rest()
        time, overturned = 0.0, False
        for start, length, self.record in segments:
            time, overturned = self._stretch(start, length)
            if overturned:
                break
        return self.ledger.close(time=time, side=self.side, state=self.y, overturned=overturned, history=None)

    def ground(self, tau: float) -> float:
        k = min(int(tau / self.dt), self.record.size - 2)
        return self.record[k] + (self.record[k + 1] - self.record[k]) * (tau / self.dt - k)

    def slope(self, tau: float) -> float:
        k = min(int(tau / self.dt), self.record.size - 2)
        return (self.record[k + 1] - self.record[k]) / self.dt

    def _stretch(self, start: float, length: float) -> tuple[float, bool]:
        tau = 0.0
        while length - tau > NEAR * self.dt:
            a = self.ground(tau)
            if self.side == 0:
                side = self.side_wanted(self.y, a)
                if side:
                    tau = self._lift(start, tau, length, side, jumped=True)
                    continue
            if self.held:
                self.held = not self._released(a)
            tau, what = self._integrate(start, tau, length)
            a = self.ground(tau)
            if what == "lift":
                if length - tau > NEAR * self.dt:
                    moment = self.guard @ self.y + self.guard_a * a
                    low, high = self.thresholds()
                    side = 1 if abs(moment - low) < abs(moment - high) else -1
                    tau = self._lift(start, tau, length, side, jumped=False)
            elif what == "land":
                self.ledger.impacts.append(start + tau)
                self.ledger.states.append(self.y)
                self.y = self.y.copy()
                self.y[2 + self.n :] += self.height * self.y[1]
                self.y[:2] = 0.0
                self.side = 0
                self._slide(0)
                for each in self.elements:
                    if isinstance(each, Bar):
                        each.rest()
            elif what == "overturn":
                return start + tau, True
        return start + length, False

    def _slide(self, turn: int) -> None:
        """Set the directions of the friction dampers, for the sign of θ'."""
        for each in self.elements:
            if isinstance(each, Slider):
                each.direction = float(np.sign(self.side * turn * self.arm(each, self.side))) if turn else 0.0

    def _held_moments(self) -> tuple[Vector, float, float]:
        """The moment that turns a held base, as a row over the state and by a and 1, and the largest that holds it."""
        A, by_a, rest = self.field_of(self.side)
        sliders = [each for each in self.elements if isinstance(each, Slider)]
        hold = sum(each.force * abs(self.arm(each, self.side)) for each in sliders)
        inertia = self.i_theta[0 if self.side > 0 else 1] - self.mass @ self.height**2
        return inertia * np.concatenate((A[1], [by_a[1], rest[1]])), hold, inertia

    def _released(self, a: float) -> bool:
        row, hold, _ = self._held_moments()
        moment = row @ np.concatenate((self.y, [a, 1.0]))
        if abs(moment) < hold * (1.0 - 1e-13):
            return False
        self._slide(1 if moment > 0.0 else -1)
        return True

    def _lift(self, start, tau, length, side, *, jumped: bool) -> float:
        """Leave the ground by a short step of the Taylor series, in which the rotation grows."""
        self.ledger.uplifts.append(start + tau)
        a, slope = self.ground(tau), self.slope(tau)
        self.side = side
        self._slide(side)
        A, by_a, rest = self.field_of(side)
        terms = [self.y, A @ self.y + by_a * a + rest]
        if not jumped:
            terms[1][1] = 0.0
        terms.append((A @ terms[1] + by_a * slope) / 2.0)
        for k in range(3, TERMS + 1):
            terms.append(A @ terms[-1] / k)
        rate = np.array([side * k * terms[k][0] for k in range(2, TERMS + 1)])
        kink = min(length, (int(tau / self.dt) + 1) * self.dt) - tau
        step = min(0.02 / np.sqrt(abs(np.linalg.eigvals(A @ A)).max()), 0.5 * kink or NEAR * self.dt)
        grid = np.linspace(0.0, 1.0, 33)[1:]
        while np.polynomial.polynomial.polyval(step * grid, rate).min() <= 0.0:
            step *= 0.5
            if step < 1e-15:
                msg = f"uplift at t = {start + tau} s cannot be resolved"
                raise RuntimeError(msg)
        for each in self.elements:  # no branch ends in so short a step
            if isinstance(each, Bar):
                while True:
                    delta = self.arm(each, side) * abs(np.polynomial.polynomial.polyval(step, np.array(terms))[0])
                    low, _, high, _ = each.limits()
                    if low < delta < high or not low < 0.0 < high:
                        break
                    step *= 0.5
        self.y = np.polynomial.polynomial.polyval(step, np.array(terms))
        self._offer(start, np.array([tau + step]), self.y[:, None])
        return tau + step

    def _events(self):
        s, found = self.side, []

        def add(what, function, direction) -> None:
            function.terminal, function.direction = True, direction
            found.append((what, function))

        if s == 0:
            low, high = self.thresholds()
            add("lift", lambda t, y: self.guard @ y + self.guard_a * self.ground(t) - low, -1.0)
            add("lift", lambda t, y: self.guard @ y + self.guard_a * self.ground(t) - high, 1.0)
            return found
        if self.held:
            row, hold, _ = self._held_moments()
            n = row.size - 2
            for sign in (1.0, -1.0):
                add(
                    "release",
                    lambda t, y, g=sign: g * (row[:n] @ y + row[n] * self.ground(t) + row[n + 1]) - hold,
                    1.0,
                )
            return found
        add("land", lambda t, y: s * y[0], -1.0)
        add("overturn", lambda t, y: s * y[0] - 0.5 * np.pi, 1.0)
        for each in self.elements:
            r = self.arm(each, s)
            if r == 0.0 or isinstance(each, Dashpot):
                continue
            if isinstance(each, Slider):
                add((each, ELASTIC), lambda t, y, r=r: r * s * y[1], -each.direction)
                continue
            if each.branch in (UP, DOWN):
                up = each.branch == UP
                add((each, ELASTIC), lambda t, y, r=r: r * s * y[1], -1.0 if up else 1.0)
                if up and np.isfinite(each.rupture):
                    add((each, BROKEN), lambda t, y, r=r, at=each.rupture: r * s * y[0] - at, 1.0)
                low = each.emptied()
                if np.isfinite(low):
                    add((each, SLACK), lambda t, y, r=r, low=low: r * s * y[0] - low, -1.0)
                continue
            low, below, high, above = each.limits()
            if np.isfinite(low):
                add((each, below), lambda t, y, r=r, low=low: r * s * y[0] - low, -1.0)
            if np.isfinite(high):
                add((each, above), lambda t, y, r=r, high=high: r * s * y[0] - high, 1.0)
        return found

    def _overdue(self) -> bool:
        """Change at once what is past its limit and still moves outward."""
        s = self.side
        for each in self.elements:
            if not isinstance(each, Bar) or s == 0 or self.held or each.branch in (UP, DOWN):
                continue
            r = self.arm(each, s)
            delta, rate = r * s * self.y[0], r * s * self.y[1]
            low, below, high, above = each.limits()
            if delta >= high and rate > 0.0:
                each.branch = above
                return True
            if delta <= low and rate < 0.0 and delta != 0.0:
                each.branch = below
                return True
        return False

    def _integrate(self, start, tau, length):
        while self._overdue():
            pass
        A, by_a, rest = self.field_of(0 if self.held else self.side)
        events = self._events()
        sol = solve_ivp(
            lambda t, y: A @ y + by_a * self.ground(t) + rest,
            (tau, length),
            self.y,
            method=self.method,
            max_step=self.dt,
            rtol=self.rtol,
            atol=1e-3 * self.rtol * self._scale(),
            events=[each for _, each in events],
            dense_output=True,
        )
        if not sol.success:
            raise RuntimeError(sol.message)
        a = np.array([self.ground(t) for t in sol.t])
        rates = self.outputs @ (A @ sol.y + by_a[:, None] * a + rest[:, None])
        self._offer(start, sol.t, sol.y)
        for q in range(4):
            for k in np.flatnonzero(rates[q, :-1] * rates[q, 1:] < 0.0):
                low, high = sol.t[k], sol.t[k + 1]
                sign = np.sign(rates[q, k])
                for _ in range(60):
                    middle = 0.5 * (low + high)
                    y = sol.sol(middle)
                    rate = self.outputs[q] @ (A @ y + by_a * self.ground(middle) + rest)
                    low, high = (middle, high) if rate * sign > 0.0 else (low, middle)
                self.ledger.offer(q, float(self.outputs[q] @ sol.sol(low)), start + low)
        self.y = sol.y[:, -1].copy()
        if sol.status != 1:
            return length, "end"
        which = next(i for i, times in enumerate(sol.t_events) if times.size)
        what = events[which][0]
        self.y = sol.y_events[which][0].copy()
        now = float(sol.t_events[which][0])
        if isinstance(what, str):
            if what == "land":
                self.y[0] = 0.0
            return now, what
        each, branch = what
        if isinstance(each, Slider) or (branch == ELASTIC and each.branch in (UP, DOWN)):
            for other in self.elements:  # all of them turn together
                if isinstance(other, Bar):
                    other.settle(self.arm(other, self.side) * abs(self.y[0]))
            self.y[1] = 0.0
            self._slide(0)
            self.held = any(isinstance(other, Slider) and self.arm(other, self.side) != 0.0 for other in self.elements)
        elif branch == SLACK:
            each.slacken(self.arm(each, self.side) * abs(self.y[0]))
        else:
            each.branch = branch
        return now, "branch"

    def _scale(self) -> Vector:
        slender = self.m_tot * max(self.arms) / self.l0r
        d = GRAVITY * slender / self.omega**2
        return np.concatenate([slender * np.array([1.0, self.omega[0]]), d, d * self.omega])

    def _offer(self, start: float, times: Vector, states: Vector) -> None:
        values = self.outputs @ states
        for q in range(4):
            k = int(np.argmax(abs(values[q])))
            self.ledger.offer(q, values[q, k], start + times[k])
