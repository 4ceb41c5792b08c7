"""The fast path: one linear phase carried over whole samples, as long as nothing can hide in them."""

import math

from rockflex._kernel import kernel
from rockflex.solve.exact.probe import NOTHING, examine, probe, set_limits
from rockflex.solve.history import keep
from rockflex.solve.layout import SAG, ZERO, Array, Log, Motion, Progress, System
from rockflex.solve.peaks import raise_peaks

__all__ = ["march", "to_coordinates", "to_state"]

WHOLE = ZERO  # the level of a whole sample


@kernel
def to_state(system: System, at: Progress, ground: float, motion: Motion) -> None:
    """State from the coordinates of the present phase."""
    p, size = at.phase, motion.w.size
    for i in range(size):
        motion.state[i] = 0.0
    for k in range(size):
        forced = system.forced[p, 0, k] * ground + system.forced[p, 1, k] * at.slope
        value = motion.w[k] + forced + system.forced[p, 2, k]
        for i in range(size):
            motion.state[i] += system.basis[p, k, i] * value


@kernel
def to_coordinates(system: System, at: Progress, ground: float, motion: Motion) -> None:
    """Coordinates of the present phase from the state."""
    p, size = at.phase, motion.w.size
    for k in range(size):
        forced = system.forced[p, 0, k] * ground + system.forced[p, 1, k] * at.slope
        motion.w[k] = -forced - system.forced[p, 2, k]
    for i in range(size):
        for k in range(size):
            motion.w[k] += system.inverse[p, i, k] * motion.state[i]


@kernel
def march(system: System, piece: Array, dt: float, most: int, at: Progress, log: Log, motion: Motion) -> None:
    """Carry `motion.w` over at most so many samples of a piece; stop before one that needs a closer look.

    That sample is left examined in `motion`, and `at.finding` says what it may hide.
    """
    p = at.phase
    pairs = motion.norms.size
    active = pairs if system.phases[p].side != 0.0 else system.layout.modes
    uncoupled = not system.phases[p].dense
    rate = 1.0 / dt
    at.finding = NOTHING
    started, slope, first = at.started, at.slope, at.index
    last = min(first + most, piece.size - 1)
    set_limits(system, p, log, motion)
    for i in range(first, last):
        here, there = piece[i], piece[i + 1]
        incline = (there - here) * rate
        for k in range(2 * pairs):
            motion.w[k] -= system.forced[p, 1, k] * (incline - slope)
        slope = incline
        if started and uncoupled:
            for k in range(active):
                x, y = motion.w[k], motion.w[pairs + k]
                motion.norms[k] = math.sqrt(x * x + y * y)
                motion.w_end[k] = system.blocks[p, 0, 0, k] * x + system.blocks[p, 0, 1, k] * y
                motion.w_end[pairs + k] = system.blocks[p, 0, 2, k] * x + system.blocks[p, 0, 3, k] * y
            for f in range(motion.start.size):
                value = system.row_forcing[p, f, 0] * there + system.row_forcing[p, f, 1] * slope
                value += system.row_forcing[p, f, 2]
                for k in range(active):
                    value += system.rows[p, f, k] * motion.w_end[k]
                    value += system.rows[p, f, pairs + k] * motion.w_end[pairs + k]
                motion.start[f] = motion.end[f]
                motion.end[f] = value
        else:
            examine(system, p, WHOLE, here, there, slope, motion)
            started = True
        safe = True
        for f in range(motion.start.size):
            sag = 0.0
            for k in range(active):
                sag += system.bounds[p, SAG, 0, f, k] * motion.norms[k]
            low, high = min(motion.start[f], motion.end[f]), max(motion.start[f], motion.end[f])
            safe = safe and low - sag >= motion.lower[f] and high + sag <= motion.upper[f]
        if not safe:
            at.finding = probe(system, p, WHOLE, slope, motion)
            if at.finding != NOTHING:
                at.stated = at.stated and i == first
                at.slope, at.index, at.started = slope, i, False
                return
            raise_peaks(motion.end, system.phases[p].side, (at.offset + i + 1) * dt, log)
            set_limits(system, p, log, motion)
        for k in range(2 * pairs):
            motion.w[k] = motion.w_end[k]
        if log.history.shape[0] > 0:
            at.slope = slope
            to_state(system, at, there, motion)
            keep(log, (at.offset + i + 1) * dt, system.phases[p].side, there, motion.state)
    at.stated = at.stated and last == first
    at.slope, at.index, at.started = slope, last, started
