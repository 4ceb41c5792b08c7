"""The peaks of a run, raised wherever the motion is looked at."""

from rockflex._kernel import kernel
from rockflex.solve.exact.layout import CONTACT, ROCKING, Array, Log, Scratch, System
from rockflex.solve.exact.series import bend, evaluate, first_descent

__all__ = ["raise_peak", "raise_peaks", "raise_row", "raise_to", "raise_to_state", "size_of"]

ROUNDING = 1e-16
MOST_TURNS = 64  # of a row within a unit, in which no mode turns by more than a radian


@kernel
def size_of(value: float, row: int, side: float, log: Log) -> float:
    """What the peak of a row is the largest of: the magnitude, or for the last row the loss of support."""
    return side * value if row == log.peaks.size - 1 else abs(value)


@kernel
def raise_row(row: int, value: float, side: float, time: float, log: Log) -> None:
    """Note one value of a row."""
    size = size_of(value, row, side, log)
    if size > log.peaks[row]:
        log.peaks[row] = size
        log.times[row] = time


@kernel
def raise_peaks(values: Array, side: float, time: float, log: Log) -> None:
    """Note the values at the end of a step in which nothing hid."""
    for f in range(0 if side != 0.0 else 1, values.size):
        raise_row(f, values[f], side, time, log)


@kernel
def raise_peak(polys: Array, row: int, side: float, stop: float, time: float, step: float, log: Log) -> None:
    """Raise a row's peak to the largest size of its polynomial over [0, stop]; the last polynomial is for work."""
    reach = 0.0
    for k in range(polys.shape[1]):
        reach += abs(polys[row, k])
    if reach <= log.peaks[row]:
        return
    first = size_of(polys[row, 0], row, side, log)
    last = size_of(evaluate(polys, row, stop)[0], row, side, log)
    if max(first, last) > log.peaks[row]:
        log.peaks[row] = max(first, last)
        log.times[row] = time + (step * stop if last >= first else 0.0)
    if max(first, last) + bend(polys, row, stop) * stop * stop / 8.0 <= log.peaks[row]:
        return
    # From rest a row grows like a power of time; the slope's zeros at 0 are divided out, else they are found for ever.
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
        raise_row(row, evaluate(polys, row, u)[0], side, time + step * u, log)
        direction = -direction
        u += 1e-9


@kernel
def raise_to(
    rows: Array, phase: int, row: int, acceleration: float, side: float, time: float, log: Log, room: Scratch
) -> None:
    """Raise a row's peak to its magnitude in the present state: all that a row without an inner peak needs."""
    value = rows[phase, row, room.state.size] * acceleration + rows[phase, row, room.state.size + 1] * side
    for i in range(room.state.size):
        value += rows[phase, row, i] * room.state[i]
    raise_row(row, value, side, time, log)


@kernel
def raise_to_state(system: System, side: float, acceleration: float, time: float, log: Log, room: Scratch) -> None:
    """Raise all peaks to the present state."""
    phase = ROCKING if side != 0.0 else CONTACT
    for f in range(0 if side != 0.0 else 1, log.peaks.size):
        raise_to(system.plain_rows, phase, f, acceleration, side, time, log, room)
