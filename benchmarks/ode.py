"""The alternative for a user: the one-mode nonlinear models with SciPy's ODE solver and its events.

Plain floats in the right-hand side, which for two degrees of freedom is faster than arrays.
"""

import math
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import rockflex as rf

GRAVITY = 9.81


def peak_rotation(
    p: rf.RockingProperties,
    motion: rf.GroundMotion,
    rtol: float,
    *,
    complete: bool,
    lifts: bool = True,
    bouc_wen: rf.BoucWen | None = None,
    scaled: bool = False,
) -> tuple[float, float]:
    """Largest |θ| and |D| of one run of LSODA with events and steps of at most dt."""
    w2, drag, h, m = p.omega[0] ** 2, 2.0 * p.zeta[0] * p.omega[0], p.effective_height[0], p.effective_mass[0]
    inertia, arm, total, width = p.i_theta, p.l0r, p.m_tot, p.half_width
    record, dt = motion.acceleration.tolist(), motion.dt
    last = len(record) - 2
    b = bouc_wen

    def ground(t: float) -> float:
        i = min(int(t / dt), last)
        return record[i] + (record[i + 1] - record[i]) * (t / dt - i)

    def restoring(d: float, z: float) -> float:
        if b is None:
            return w2 * d
        return w2 * (b.post_yield_ratio * d + b.yield_displacement * (1.0 - b.post_yield_ratio) * z)

    def slip(v: float, z: float) -> float:
        if b is None:
            return 0.0
        power = abs(z) ** b.exponent
        turn = math.copysign(power, z) * abs(v)
        return (v - b.gamma * turn - b.beta * v * power) / b.yield_displacement

    def contact(t: float, y: Any) -> list[float]:
        d, v, z = y[0], y[1], y[4]
        return [v, -restoring(d, z) - drag * v - ground(t), 0.0, 0.0, slip(v, z)]

    def rocking(t: float, y: Any, s: float) -> list[float]:
        d, v, theta, spin, z = y
        a = ground(t)
        if complete:
            sine, cosine = math.sin(theta), math.cos(theta)
            rest = -restoring(d, z) - drag * v - a * cosine + GRAVITY * sine - spin * spin * (s * width - d)
            moment = m * h * rest + 2.0 * spin * v * m * (d - s * width)
            moment += GRAVITY * (s * total * width * cosine - arm * sine - m * d * cosine)
            moment += a * (s * total * width * sine + arm * cosine - m * d * sine)
            angular = -moment / (inertia - m * h * h + m * d * (d - 2.0 * s * width))
        else:
            rest = -restoring(d, z) - drag * v - a
            moment = m * h * rest + GRAVITY * (s * total * width - arm * theta) + a * arm
            angular = -moment / (inertia - m * h * h)
        return [v, rest - h * angular, spin, angular, slip(v, z)]

    def moment_of(t: float, y: Any) -> float:
        value = -m * h * (restoring(y[0], y[4]) + drag * y[1]) + (arm - m * h) * ground(t)
        return value - (m * GRAVITY * y[0] if complete else 0.0)

    resistance = total * GRAVITY * width if lifts else math.inf
    end, t, side = motion.duration, 0.0, 0.0
    y = np.zeros(5)
    rotation = displacement = 0.0
    atol = np.array([1e-3, 1e-2, 1e-4, 1e-3, 1.0]) * rtol
    while t < end:
        moment = moment_of(t, y)
        if side == 0.0 and abs(moment) >= resistance * (1.0 - 1e-13):
            side = -1.0 if moment > 0.0 else 1.0
        turn = _event(lambda _t, y, *_: y[1], terminal=False)
        if side == 0.0:
            events = [turn]
            if lifts:
                events += [
                    _event(lambda t, y: moment_of(t, y) - resistance),
                    _event(lambda t, y: moment_of(t, y) + resistance),
                ]
            run = solve_ivp(contact, (t, end), y, method="LSODA", rtol=rtol, atol=atol, max_step=dt, events=events)
        else:
            s = side
            # Leave the ground first: at θ = 0 the event would trigger at once; the solver's interpolant straddles it.
            off = solve_ivp(rocking, (t, t + 1e-4), y, method="LSODA", rtol=rtol, atol=atol, args=(s,))
            t, y = off.t[-1], off.y[:, -1]
            back = _event(lambda _t, y, s: s * y[2], direction=-1.0)
            events = [turn, back, _event(lambda _t, y, _s: y[3], terminal=False)]
            run = solve_ivp(
                rocking, (t, end), y, method="LSODA", rtol=rtol, atol=atol, max_step=dt, events=events, args=(s,)
            )
            rotation = max(rotation, np.abs(run.y[2]).max(), *(abs(e[2]) for e in run.y_events[2]))
        displacement = max(displacement, np.abs(run.y[0]).max(), *(abs(e[0]) for e in run.y_events[0]))
        t, y = run.t[-1], run.y[:, -1].copy()
        if run.status != 1:
            break
        if side != 0.0:
            v = y[1] + h * y[3]
            if scaled and v != 0.0:
                v *= math.sqrt(1.0 + (p.translational_inertia - m * h * h) * y[3] ** 2 / (m * v * v))
            y[1], y[2], y[3] = v, 0.0, 0.0
            side = 0.0
        else:
            y[2] = y[3] = 0.0
            side = -1.0 if moment_of(t, y) > 0.0 else 1.0
    return float(rotation), float(displacement)


def _event(function: Any, *, terminal: bool = True, direction: float = 0.0) -> Any:
    def event(*arguments: Any) -> Any:
        return function(*arguments)

    event.terminal = terminal
    event.direction = direction
    return event
