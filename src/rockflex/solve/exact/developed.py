"""Linear phases without closed form over many intervals at once: by power series.

A base that slides or flies has no steady state, and under vertical acceleration the stiffness of the base varies. The
equations are those of `rockflex.solve.exact.series`, here for all intervals of a history together.
"""

import math
from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex.models import Arrow, RockingModel
from rockflex.solve.exact.basis import drift_of

TURN = 2.0  # largest phase angle over which a series is used
TERMS = 28  # after which a series converges over `TURN`


class Shaking(NamedTuple):
    """Accelerations of the ground over intervals, linear in time; each of shape (n,)."""

    ground: Array
    slope: Array
    rise: Array
    rise_slope: Array

    def later(self, time: Array) -> "Shaking":
        """Return the same after a time."""
        ground, rise = self.ground + self.slope * time, self.rise + self.rise_slope * time
        return Shaking(ground, self.slope, rise, self.rise_slope)


class Developed:
    """The motion over intervals of one phase.

    Parameters
    ----------
    model, arrow
        The model, and its equations of motion in the phase.
    heavier
        The same under a gravity greater by 1 m/s².
    accelerations
        Rows of D'' and q'' in the phase, shape (N + b, C).
    """

    def __init__(self, model: RockingModel, arrow: Arrow, heavier: Arrow, accelerations: Array) -> None:
        p = model.properties
        self._layout = model.layout
        self._arrow = arrow
        self._omega2, self._drag = p.omega**2, 2.0 * p.zeta * p.omega
        self._more_stiffness, self._more_force = heavier.stiffness - arrow.stiffness, heavier.constant - arrow.constant
        self._fastest = drift_of(model, arrow, accelerations).fastest

    def moved(self, start: Array, shaking: Shaking, steps: Array) -> Array:
        """Return the states after steps in s, (n,), from states of shape (n, S')."""
        parts = max(math.ceil(self._fastest * float(steps.max(initial=0.0)) / TURN), 1)
        step, states = steps / parts, start.copy()
        for k in range(parts):
            self._advance(states, shaking.later(k * step), step)
        return states

    def _advance(self, states: Array, shaking: Shaking, h: Array) -> None:
        layout, arrow = self._layout, self._arrow
        n, b = layout.modes, layout.freedoms
        places = layout.rotation + 2 * np.arange(b)
        modes = np.arange(n)
        where, speeds = np.concatenate((modes, places)), np.concatenate((n + modes, places + 1))
        series = np.zeros((TERMS, states.shape[0], n + b))
        series[0], series[1] = states[:, where], states[:, speeds] * h[:, None]
        memory = states[:, layout.memory : layout.memory + layout.remembered]
        still = arrow.constant + memory @ arrow.recall.T
        square = (h * h)[:, None]
        for k in range(TERMS - 2):
            q, d = series[k, :, n:], series[k, :, :n]
            restoring = self._omega2 * d * square + self._drag * (k + 1) * series[k + 1, :, :n] * h[:, None]
            force = restoring @ arrow.leverage.T - square * (q @ arrow.stiffness.T)
            force -= (k + 1) * h[:, None] * (series[k + 1, :, n:] @ arrow.damping.T)
            force -= square * shaking.rise[:, None] * (q @ self._more_stiffness.T)
            if k > 0:
                climb = square * (shaking.rise_slope * h)[:, None]
                force -= climb * (series[k - 1, :, n:] @ self._more_stiffness.T)
            drive = np.zeros((h.size, 1))
            if k == 0:
                drive = square * shaking.ground[:, None]
                force += square * (still + shaking.rise[:, None] * self._more_force)
            elif k == 1:
                drive = square * (h * shaking.slope)[:, None]
                force += square * (h * shaking.rise_slope)[:, None] * self._more_force
            force += drive * arrow.drive
            turn = force @ arrow.flexibility.T
            pair = (k + 1.0) * (k + 2.0)
            series[k + 2, :, n:] = turn / pair
            series[k + 2, :, :n] = (-restoring - drive - turn @ arrow.coupling) / pair
        states[:, where] = series.sum(axis=0)
        rates = np.tensordot(np.arange(TERMS, dtype=np.float64), series, axes=1)
        moving = h > 0.0
        states[np.ix_(np.flatnonzero(moving), speeds)] = rates[moving] / h[moving, None]
