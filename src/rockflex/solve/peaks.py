"""The peaks of a run, updated wherever the motion is examined."""

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex.solve.layout import GUARD, Log, Motion, Span, System
from rockflex.solve.polynomials import bend, evaluate, first_descent

ROUNDING = 1e-16
NEAR = 0.75  # fraction of its peak that a row must reach at either end of a step to exceed it in between
MOST_TURNS = 64  # extremes of a row within a unit, in which the phase of no mode advances by more than a radian


@kernel
def size_of(value: float, row: int, log: Log) -> float:
    """Return the size whose largest value is the peak: the magnitude, or the value itself."""
    return value if row >= log.signed else abs(value)


@kernel
def is_far(first: float, last: float, row: int, log: Log) -> bool:
    """Return whether a row is so far from its peak at both ends of a step that it does not reach it in between."""
    return max(abs(first), abs(last)) <= NEAR * log.peaks[row]


@kernel
def raise_row(row: int, value: float, time: float, log: Log) -> None:
    """Update the peak of a row with one value."""
    size = size_of(value, row, log)
    if size > log.peaks[row]:
        log.peaks[row] = size
        log.times[row] = time


@kernel
def raise_peaks(values: Array, free: bool, time: float, log: Log) -> None:
    """Update the peaks with the values at the end of a step without hidden peaks."""
    for f in range(0 if free else 1, log.peaks.size):
        raise_row(f, values[f], time, log)


@kernel
def raise_peak(polys: Array, row: int, stop: float, span: Span, log: Log) -> None:
    """Update the peak of a row from its polynomial over [0, stop]; the last polynomial is a work array."""
    time, step = span.time, span.length
    reach = 0.0
    for k in range(polys.shape[1]):
        reach += abs(polys[row, k])
    if reach <= log.peaks[row]:
        return
    first = size_of(polys[row, 0], row, log)
    last = size_of(evaluate(polys, row, stop)[0], row, log)
    if max(first, last) > log.peaks[row]:
        log.peaks[row] = max(first, last)
        log.times[row] = time + (step * stop if last >= first else 0.0)
    if max(first, last) + bend(polys, row, stop) * stop * stop / 8.0 <= log.peaks[row]:
        return
    # From rest a row grows like a power of time; zeros of the slope at 0 are divided out, or they would be found again.
    work, terms, zeros = polys.shape[0] - 1, polys.shape[1], 1
    while zeros < terms - 1 and abs(polys[row, zeros]) <= ROUNDING * reach:
        zeros += 1
    direction = 1.0 if polys[row, zeros] >= 0.0 else -1.0
    u = 0.0
    for _ in range(MOST_TURNS):
        for k in range(terms):
            polys[work, k] = direction * (k + zeros) * polys[row, k + zeros] if k + zeros < terms else 0.0
        u = first_descent(polys, work, u, stop)
        if u >= stop:
            return
        raise_row(row, evaluate(polys, row, u)[0], time + step * u, log)
        direction = -direction
        u += 1e-9


@kernel
def raise_to(
    system: System, phase: int, row: int, ground: float, rise: float, time: float, log: Log, motion: Motion
) -> None:
    """Update the peak of a row with the present state, which is sufficient without a peak inside the stretch."""
    value = row_at(system.plain_rows, phase, row, ground, motion.state)
    if rise != 0.0:
        value += rise * row_at(system.heavier_rows, phase, row, ground, motion.state)
    raise_row(row, value, time, log)


@kernel
def row_at(rows: Array, phase: int, row: int, ground: float, state: Array) -> float:
    """Return the value of a row at a state."""
    moving = rows.shape[2] - 2
    value = rows[phase, row, moving] * ground + rows[phase, row, moving + 1]
    for i in range(moving):
        value += rows[phase, row, i] * state[i]
    return value


@kernel
def raise_to_state(
    system: System, phase: int, ground: float, rise: float, time: float, log: Log, motion: Motion
) -> None:
    """Update all peaks with the present state."""
    for f in range(GUARD if system.phases[phase].free else 1, log.peaks.size):
        raise_to(system, phase, f, ground, rise, time, log, motion)
