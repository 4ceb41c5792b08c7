"""Reference excursions for OpenSees: rockflex's, and one with OpenSees' modal damping."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from frames import GRAVITY, N_STORIES, Prototype
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import rockflex as rf

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Reference:
    """One excursion: its start and end, and the motion in between."""

    uplift: float  # s
    impact: float  # s
    motion: Callable[[Float], tuple[Float, Float]]  # θ and u_top at given times

    @property
    def largest(self) -> tuple[float, float]:
        """Largest |θ| in rad and |u_top| in m in the excursion."""
        theta, top = self.motion(np.linspace(self.uplift, self.impact, 20_001))
        return float(np.max(np.abs(theta))), float(np.max(np.abs(top)))


def hermite(time: Float, values: Float, rates: Float, at: Float) -> Float:
    """Cubics through a history's nodes; of two nodes at the time of an event, each is used on its own side."""
    i = np.clip(np.searchsorted(time, at, side="right") - 1, 0, time.size - 2)
    h = np.where(time[i + 1] > time[i], time[i + 1] - time[i], 1.0)
    u = (at - time[i]) / h
    left = values[i] * (1.0 + 2.0 * u) + rates[i] * h * u
    right = values[i + 1] * (3.0 - 2.0 * u) - rates[i + 1] * h * (1.0 - u)
    return left * (1.0 - u) ** 2 + right * u**2


def finer(shaking: rf.GroundMotion) -> rf.GroundMotion:
    """Divide the samples of a motion to 1 ms or less, so that cubics between states are accurate."""
    parts = max(1, round(shaking.dt / 0.001))
    times = np.arange((shaking.acceleration.size - 1) * parts + 1) / parts
    fine = np.interp(times, np.arange(shaking.acceleration.size), shaking.acceleration)
    return rf.GroundMotion(fine, shaking.dt / parts)


def reference(
    structure: rf.LumpedStructure | rf.Frame | rf.YieldingStories, model: str, shaking: rf.GroundMotion
) -> Reference:
    """First excursion in rockflex."""
    response = rf.simulate(structure, finer(shaking), model)
    ordinates = structure.rocking().top_ordinate
    top, rate = response.modal_displacement @ ordinates, response.modal_velocity @ ordinates

    def motion(at: Float) -> tuple[Float, Float]:
        theta = hermite(response.time, response.rotation, response.rotation_velocity, at)
        return theta, hermite(response.time, top, rate, at)

    return Reference(float(response.uplift_times[0]), float(response.impact_times[0]), motion)


def absolute_damping(prototype: Prototype, shaking: rf.GroundMotion, ratio: float) -> Reference:
    """First excursion if modal damping acts as in OpenSees: as an external force on the floors.

    Its forces are proportional to D'_n + h*_n θ' and do not react on the base. So the base uplifts when the elastic
    moment Σ m* h* ω² D alone reaches m_tot g B, and Eq. 23 with D'' eliminated has no damping in the equation of θ.
    """
    p = prototype.frame(ratio).rocking()
    n = N_STORIES
    sampled = np.arange(shaking.acceleration.size) * shaking.dt
    arm = p.effective_mass * p.effective_height
    free = p.i_theta - float(arm @ p.effective_height)  # with all modes Σ m* h* = L_0^r

    def rates(t: float, y: Float, side: float) -> Float:
        ground = np.interp(t, sampled, shaking.acceleration)
        restoring = p.omega**2 * y[:n]
        turning = float(arm @ restoring) + p.l0r * GRAVITY * y[-2] - side * p.resisting_moment
        angular = turning / free if side != 0.0 else 0.0
        drag = 2.0 * ratio * p.omega * (y[n : 2 * n] + p.effective_height * y[-1])
        bent = -ground - drag - restoring - p.effective_height * angular
        return np.concatenate([y[n : 2 * n], bent, [y[-1], angular]])

    def lifts(_t: float, y: Float, _side: float) -> float:
        return p.resisting_moment - abs(float(arm @ (p.omega**2 * y[:n])))

    def lands(t: float, y: Float, side: float) -> float:
        return side * y[-2] if t > lift + 0.01 else 1.0

    lifts.terminal = lands.terminal = True
    given = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-13, "max_step": shaking.dt, "dense_output": True}
    contact = solve_ivp(rates, (0.0, sampled[-1]), np.zeros(2 * n + 2), events=lifts, args=(0.0,), **given)
    lift, state = float(contact.t[-1]), contact.y[:, -1]
    side = float(np.sign(arm @ (p.omega**2 * state[:n])))
    rocking = solve_ivp(rates, (lift, sampled[-1]), state, events=lands, args=(side,), **given)

    def motion(at: Float) -> tuple[Float, Float]:
        y = rocking.sol(at)
        return y[-2], p.top_ordinate @ y[:n]

    return Reference(lift, float(rocking.t[-1]), motion)
