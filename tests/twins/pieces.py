"""Systems that are linear between events, carried by the power series of their solutions.

State ``y``, horizontal ground acceleration a and vertical one b, both linear in time within a sample:

    y' = (A + b A_v) y + F [1, a, b].

A phase lasts while all its guards, rows over ``w = [y, y', 1, a, b]``, are positive. They are polynomials in time
within a step of less than 1/|λ| of the fastest eigenvalue, so that their first root is found on the solution itself.
"""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from scipy.optimize import brentq

from twins.result import Vector

TERMS = 20
ROOT = {"xtol": 1e-300, "rtol": 8.9e-16, "maxiter": 500}
EARLY = 1e-10  # s: after an event a phase has to hold this long
FULL = np.linspace(0.0, 1.0, 9)
POINTS = FULL[:, None] ** np.arange(TERMS)
NODES, WEIGHTS = (lambda x, w: (0.5 * (x + 1.0), 0.5 * w))(*np.polynomial.legendre.leggauss(16))
NODES = NODES[:, None] ** np.arange(TERMS)


@dataclass(frozen=True)
class Phase:
    """The field of a phase, the rows that stay positive in it, and the factors of the powers.

    The product of the three rows ``powers[i]`` over w adds to the work number ``kinds[i]``.
    """

    rate: Vector
    by_vertical: Vector
    load: Vector
    names: tuple
    guards: Vector
    kinds: tuple
    powers: Vector
    fastest: float = field(init=False)
    series: Vector = field(init=False)

    def __post_init__(self) -> None:
        n = self.rate.shape[0]
        z = np.zeros((n + 5, n + 5))
        z[:n, :n], z[:n, [n, n + 1, n + 3]] = self.rate, self.load
        z[n + 1, n + 2] = z[n + 3, n + 4] = 1.0
        terms = [np.eye(n + 5)]
        for k in range(1, TERMS + 1):
            terms.append(z @ terms[-1] / k)
        object.__setattr__(self, "series", np.array(terms)[:, :n])
        object.__setattr__(self, "fastest", float(abs(np.linalg.eigvals(self.rate)).max()))


class System(Protocol):
    outputs: Vector  # rows over y whose peaks are wanted
    n_powers: int

    def phase(self, key) -> Phase: ...

    def after(self, key, name, y: Vector, ahead: "Ahead") -> tuple[object, Vector]:
        """Phase and state after the guard `name` of the phase `key` has reached zero."""
        ...


@dataclass(frozen=True)
class Ahead:
    """What would follow an instant in one phase or another."""

    system: System
    shaking: Vector

    def rates(self, key, y: Vector) -> Vector:
        return coefficients(self.system.phase(key), y, self.shaking)[1]

    def holds(self, key, y: Vector) -> bool:
        """Whether no guard of the phase is negative just after the instant."""
        phase = self.system.phase(key)
        w = observed(coefficients(phase, y, self.shaking), self.shaking)
        return bool((phase.guards @ (EARLY ** np.arange(TERMS) @ w) >= 0.0).all())


@dataclass
class Track:
    """What happened in a run; an event is (time, key before, name, key after)."""

    highs: Vector  # of the outputs, then of their negatives
    times: Vector
    work: Vector
    events: list = field(default_factory=list)
    history: list = field(default_factory=list)
    keys: list = field(default_factory=list)
    time: float = 0.0
    y: Vector | None = None
    key: object = None

    @property
    def peaks(self) -> Vector:
        return self.highs.reshape(2, -1).max(axis=0)


def polynomial(c, t: float) -> float:
    total = 0.0
    for each in c[::-1]:
        total = total * t + each
    return total


def root(c: Vector, low: float, high: float) -> float:
    """Where the polynomial changes its sign; by rounding it may be at an end."""
    ends = polynomial(c, low), polynomial(c, high)
    if ends[0] * ends[1] >= 0.0:
        return low if abs(ends[0]) < abs(ends[1]) else high
    return float(brentq(lambda t: polynomial(c, t), low, high, **ROOT))


def coefficients(phase: Phase, y: Vector, shaking: Vector) -> Vector:
    """Power series of y in time, shape (TERMS + 1, n), for ``shaking = [a, a', b, b']``."""
    a, da, b, db = shaking
    if (b == 0.0 and db == 0.0) or not phase.by_vertical.any():
        return phase.series @ np.concatenate((y, (1.0, a, da, b, db)))
    c = np.zeros((TERMS + 1, y.size))
    c[0] = y
    matrix, slope = phase.rate + b * phase.by_vertical, db * phase.by_vertical
    loads = {0: phase.load @ (1.0, a, b), 1: phase.load @ (0.0, da, db)}
    for k in range(TERMS):
        rate = matrix @ c[k] + loads.get(k, 0.0)
        if k:
            rate += slope @ c[k - 1]
        c[k + 1] = rate / (k + 1)
    return c


def observed(c: Vector, shaking: Vector) -> Vector:
    """Series of ``w = [y, y', 1, a, b]``, shape (TERMS, 2 n + 3)."""
    n = c.shape[1]
    w = np.zeros((TERMS, 2 * n + 3))
    w[:, :n] = c[:-1]
    w[:, n : 2 * n] = c[1:] * np.arange(1.0, TERMS + 1)[:, None]
    a, da, b, db = shaking
    w[0, 2 * n :] = 1.0, a, b
    w[1, 2 * n :] = 0.0, da, db
    return w


def first_root(values: Vector, slopes: Vector, c: Vector, start: float) -> float | None:
    """First root in (start, 1] of the polynomial c, which is positive at `start`; None if there is none."""
    rate = c[1:] * np.arange(1, c.size)
    step = FULL[1]
    for i in range(FULL.size - 1):
        low, high = max(FULL[i], start), FULL[i + 1]
        if low >= high:
            continue
        if values[i + 1] < 0.0:
            if polynomial(c, low) <= 0.0:
                return low
            return root(c, low, high)
        if slopes[i] < 0.0 < slopes[i + 1] and min(values[i], values[i + 1]) < step * max(-slopes[i], slopes[i + 1]):
            if polynomial(rate, low) >= 0.0:
                continue
            dip = root(rate, low, high)
            if polynomial(c, dip) < 0.0:
                if polynomial(c, low) <= 0.0:
                    return low
                return root(c, low, dip)
    return None


class Run:
    """One run of a system."""

    def __init__(self, system: System, key, y: Vector, *, history: bool = False) -> None:
        self.system, self.key, self.y, self.keep = system, key, np.array(y, float), history
        self.rows = np.concatenate((system.outputs, -system.outputs))
        highs = self.rows @ self.y
        self.track = Track(highs, np.zeros(highs.size), np.zeros(system.n_powers))
        self.at, self.fresh, self.stuck, self.stopped = 0.0, True, 0, False

    def over(self, record: Vector, dt: float, vertical: Vector | None = None, free: float = 0.0) -> Track:
        record = np.asarray(record, float)
        up = np.zeros(record.size) if vertical is None else np.asarray(vertical, float)
        rest = int(np.ceil(free / dt - 1e-9))
        pairs = [(record[k], record[k + 1], up[k], up[k + 1]) for k in range(record.size - 1)]
        pairs += [(0.0, 0.0, 0.0, 0.0)] * rest
        self._keep()
        for k, (a, a_next, b, b_next) in enumerate(pairs):
            if k == record.size - 1:
                self.fresh = True  # the excitation stops at once
            self._sample(k * dt, dt, np.array([a, (a_next - a) / dt, b, (b_next - b) / dt]))
            if self.stopped:
                break
            self._keep()
        else:
            self.track.time = len(pairs) * dt
        self.track.y, self.track.key = self.y, self.key
        return self.track

    def _keep(self) -> None:
        if self.keep:
            self.track.history.append(self.y)
            self.track.keys.append(self.key)

    def _sample(self, start: float, dt: float, shaking: Vector) -> None:
        tau, calls = 0.0, 0
        while dt - tau > 1e-13 * dt and not self.stopped:
            tau = self._step(start, dt, tau, shaking)
            calls += 1
            if calls > 20000:
                msg = f"no progress at t = {start + tau} s in {self.key}"
                raise RuntimeError(msg)

    def _step(self, start: float, dt: float, tau: float, shaking: Vector) -> float:
        phase = self.system.phase(self.key)
        now = np.array([shaking[0] + shaking[1] * tau, shaking[1], shaking[2] + shaking[3] * tau, shaking[3]])
        parts = max(1, int(np.ceil(phase.fastest * dt)))
        end = min(dt, (int(tau / dt * parts + 1e-9) + 1) * dt / parts)
        h = end - tau
        scale = h ** np.arange(TERMS + 1)
        c = coefficients(phase, self.y, now) * scale[:, None]
        w = observed(c / scale[:, None], now) * scale[:TERMS, None]
        g = w @ phase.guards.T
        values = POINTS @ g
        slopes = POINTS[:, :-1] @ (g[1:] * np.arange(1.0, TERMS)[:, None])
        early = min(EARLY / h, 0.5) if self.fresh else 0.0
        found, which = 1.0, None
        threat = (values[1:] < 0.0).any(axis=0) | ((slopes[:-1] < 0.0) & (slopes[1:] > 0.0)).any(axis=0)
        for i in np.flatnonzero(threat | (values[0] < 0.0)):
            at = 0.0 if polynomial(g[:, i], early) < 0.0 else first_root(values[:, i], slopes[:, i], g[:, i], early)
            if at is not None and (which is None or at < found):
                found, which = at, i
        self.fresh = False
        if found > 0.0:
            self._watch(start + tau, h, c, w, phase, found)
            self.stuck = 0
        powers = found ** np.arange(TERMS + 1)
        self.y = powers @ c
        if which is None:
            return end
        tau += found * h
        self._event(phase.names[which], start + tau, dt - tau, shaking, tau)
        return tau

    def _event(self, name, time: float, left: float, shaking: Vector, tau: float) -> None:
        now = np.array([shaking[0] + shaking[1] * tau, shaking[1], shaking[2] + shaking[3] * tau, shaking[3]])
        self.stuck += 1
        if self.stuck > 60:
            msg = f"events without end at t = {time} s in {self.key}"
            raise RuntimeError(msg)
        if name == "overturn":
            self.track.events.append((time, self.key, name, self.key))
            self.stopped, self.track.time = True, time
            return

        before = self.key
        self.key, self.y = self.system.after(before, name, self.y, Ahead(self.system, now))
        self.track.events.append((time, before, name, self.key))
        self.fresh = True

    def _watch(self, time: float, h: float, c: Vector, w: Vector, phase: Phase, found: float) -> None:
        """Peaks and work of the part of a step before `found`."""
        track = self.track
        if found < 1.0:
            c, w = c * found ** np.arange(TERMS + 1)[:, None], w * found ** np.arange(TERMS)[:, None]
        o = c[:TERMS] @ self.rows.T
        rate = o[1:] * np.arange(1.0, TERMS)[:, None]
        values, slopes = POINTS @ o, POINTS[:, :-1] @ rate
        best = values.argmax(axis=0)
        for q in np.flatnonzero(values[best, range(best.size)] > track.highs):
            track.highs[q], track.times[q] = values[best[q], q], time + FULL[best[q]] * found * h
        reach = np.maximum(values[1:], values[:-1]) + FULL[1] * np.maximum(abs(slopes[1:]), abs(slopes[:-1]))
        for i, q in np.argwhere((slopes[:-1] > 0.0) & (slopes[1:] < 0.0) & (reach > track.highs)):
            top = root(rate[:, q], FULL[i], FULL[i + 1])
            value = polynomial(o[:, q], top)
            if value > track.highs[q]:
                track.highs[q], track.times[q] = value, time + top * found * h
        if phase.kinds:
            power = np.einsum("tw,pfw->tpf", NODES @ w, phase.powers).prod(axis=2)
            np.add.at(track.work, list(phase.kinds), found * h * (WEIGHTS @ power))
