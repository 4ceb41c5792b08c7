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
        drift = drift_of(model, arrow, accelerations)
        self.roots, self._fastest = drift.roots, drift.fastest

        n, places = self._layout.modes, self._layout.rotation + 2 * np.arange(self._layout.freedoms)
        self._where = np.concatenate((np.arange(n), places))
        self._speeds = np.concatenate((n + np.arange(n), places + 1))

    def moved(self, start: Array, shaking: Shaking, steps: Array) -> Array:
        """Return the states after steps in s, (n,), from states of shape (n, S')."""
        parts = self.parts_of(steps)
        step, states = steps / parts, start
        for k in range(parts):
            states = self.along(states, self.series(states, shaking.later(k * step), step), step, 1.0)
        return states

    def parts_of(self, steps: Array) -> int:
        """Return the number of equal parts in which steps are to be taken, so that the series converge."""
        return max(math.ceil(self._fastest * float(steps.max(initial=0.0)) / TURN), 1)

    def along(self, states: Array, series: Array, h: Array, fraction: float) -> Array:
        """Return the states at a fraction of a step h that begins with `states`, from its series."""
        terms = np.arange(TERMS)
        after, moving = states.copy(), h > 0.0
        after[:, self._where] = np.tensordot(fraction**terms, series, axes=1)
        rates = np.tensordot(terms[1:] * fraction ** terms[:-1], series[1:], axes=1)
        after[np.ix_(np.flatnonzero(moving), self._speeds)] = rates[moving] / h[moving, None]
        return after

    def series(self, states: Array, shaking: Shaking, h: Array) -> Array:
        """Return the terms of the modes and freedoms over a step h, shape (TERMS, n, N + b)."""
        layout, arrow = self._layout, self._arrow
        n, b = layout.modes, layout.freedoms
        series = np.zeros((TERMS, states.shape[0], n + b))
        series[0], series[1] = states[:, self._where], states[:, self._speeds] * h[:, None]
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
        return series


class Course:
    """The motion over all intervals of one phase, at one fraction of them after the other.

    The series of the part of the intervals that was asked for last are kept, so that rising fractions cost one
    development of each part.

    Parameters
    ----------
    motion
        The phase.
    start
        States at the start of the intervals, shape (n, S').
    shaking, steps
        The ground over the intervals, and their lengths in s, shape (n,).
    """

    def __init__(self, motion: Developed, start: Array, shaking: Shaking, steps: Array) -> None:
        self._motion, self._start, self._shaking = motion, start, shaking
        self._parts = motion.parts_of(steps)
        self._step = steps / self._parts
        self._begin(0, start)

    def _begin(self, part: int, states: Array) -> None:
        self._part, self._states = part, states
        self._series = self._motion.series(states, self._shaking.later(part * self._step), self._step)

    def at(self, fraction: float) -> Array:
        """Return the states at a fraction of every interval, 0 to 1, shape (n, S')."""
        wanted = min(int(fraction * self._parts), self._parts - 1)
        if wanted < self._part:
            self._begin(0, self._start)
        while self._part < wanted:
            self._begin(self._part + 1, self._motion.along(self._states, self._series, self._step, 1.0))
        return self._motion.along(self._states, self._series, self._step, fraction * self._parts - wanted)
