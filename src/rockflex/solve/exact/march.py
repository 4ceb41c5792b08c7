"""The fast path: a linear phase advanced over whole samples, while no event or peak can occur inside them."""

import math

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex.solve.exact.probe import NOTHING, examine, probe, set_limits
from rockflex.solve.history import keep
from rockflex.solve.layout import (
    ENDS,
    FINAL,
    FIRST,
    INTO,
    LOWER,
    NOW,
    OUT,
    SAG,
    UPPER,
    VALUES,
    ZERO,
    Log,
    Motion,
    Progress,
    System,
    rows_in,
)
from rockflex.solve.peaks import raise_peaks

WHOLE = ZERO  # the level of a whole sample


@kernel
def to_state(system: System, at: Progress, ground: float, motion: Motion) -> None:
    """Compute the state from the coordinates of the present phase."""
    p, size = at.phase, motion.w.shape[1]
    for i in range(size):
        motion.state[i] = 0.0
    for k in range(size):
        forced = system.forced[p, 0, k] * ground + system.forced[p, 1, k] * at.slope
        value = motion.w[NOW, k] + forced + motion.still[k]
        for i in range(size):
            motion.state[i] += system.basis[p, OUT, k, i] * value


@kernel
def to_coordinates(system: System, at: Progress, ground: float, motion: Motion) -> None:
    """Compute the coordinates of the present phase from the state."""
    p, size = at.phase, motion.w.shape[1]
    for k in range(size):
        forced = system.forced[p, 0, k] * ground + system.forced[p, 1, k] * at.slope
        motion.w[NOW, k] = -forced - motion.still[k]
    for i in range(size):
        for k in range(size):
            motion.w[NOW, k] += system.basis[p, INTO, i, k] * motion.state[i]
    for k in range(size):
        motion.w[ENDS, k] = motion.w[NOW, k]  # in contact the steps leave out the base, which does not move


@kernel
def march(system: System, piece: Array, dt: float, most: int, at: Progress, log: Log, motion: Motion) -> None:
    """Advance `motion.w` over at most `most` samples of a piece; stop before one that needs a closer look.

    The result of examining that sample remains in `motion`, and `at.finding` is what may occur in it.
    """
    p = at.phase
    pairs = motion.norms.size
    active, count = system.phases[p].active, rows_in(system, p)
    uncoupled = not system.phases[p].dense
    rate = 1.0 / dt
    at.finding = NOTHING
    started, slope, first = at.started, at.slope, at.index
    last = min(first + most, piece.size - 1)
    forced, blocks, sag = system.forced[p, 1], system.blocks[p, WHOLE], system.bounds[p, SAG, WHOLE]
    rows, forcing = system.rows[p, VALUES], system.row_forcing[p]
    now, ends = motion.w[NOW], motion.w[ENDS]
    lower, upper = motion.values[LOWER], motion.values[UPPER]
    begins, closes = motion.values[FIRST], motion.values[FINAL]
    set_limits(system, p, log, motion)
    for i in range(first, last):
        here, there = piece[i], piece[i + 1]
        incline = (there - here) * rate
        for k in range(2 * pairs):
            now[k] -= forced[k] * (incline - slope)
        slope = incline
        if started and uncoupled:
            for k in range(active):
                x, y = now[k], now[pairs + k]
                motion.norms[k] = math.sqrt(x * x + y * y)
                ends[k] = blocks[0, k] * x + blocks[1, k] * y
                ends[pairs + k] = blocks[2, k] * x + blocks[3, k] * y
            for f in range(count):
                value = forcing[f, 0] * there + forcing[f, 1] * slope + motion.offset[f]
                for k in range(active):
                    value += rows[f, k] * ends[k]
                    value += rows[f, pairs + k] * ends[pairs + k]
                begins[f] = closes[f]
                closes[f] = value
        else:
            examine(system, p, WHOLE, here, there, slope, motion)
            started = True
        safe = True
        for f in range(count):
            leeway = 0.0
            for k in range(active):
                leeway += sag[f, k] * motion.norms[k]
            low, high = min(begins[f], closes[f]), max(begins[f], closes[f])
            safe = safe and low - leeway >= lower[f] and high + leeway <= upper[f]
        if not safe:
            at.finding = probe(system, p, WHOLE, slope, motion)
            if at.finding != NOTHING:
                at.stated = at.stated and i == first
                at.slope, at.index, at.started = slope, i, False
                return
            raise_peaks(closes, system.phases[p].free, (at.offset + i + 1) * dt, log)
            set_limits(system, p, log, motion)
        for k in range(2 * pairs):
            now[k] = ends[k]
        if log.history.shape[0] > 0:
            at.slope = slope
            to_state(system, at, there, motion)
            keep(log, (at.offset + i + 1) * dt, system.phases[p].side, there, 0.0, motion.state)
    at.stated = at.stated and last == first
    at.slope, at.index, at.started = slope, last, started
