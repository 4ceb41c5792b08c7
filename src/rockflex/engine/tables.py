"""What the tables of a phase are made from and laid into, and matrix exponentials in NumPy."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.engine.system import Event, LinearPhase, NonlinearPhase, Rest, up8
from rockflex.foundation.arrays import Array

AHEAD = 4  # as in march.h
DENSE = -2.0  # as in march.h
SLOTS = 8  # of each row, in a table for the ends of AHEAD samples
LONGEST = 2.5  # rad that a mode may turn within one power series: some thirty terms, and a digit lost
FEWEST = 10  # terms of a series, of which none is looked at: that they end earlier is rare
SMALL = 1e-18  # of a sum: terms that no longer change it
PARTED = 2.0  # rad that a mode turns within a step, from which on the modes of a phase bound what it can do
FAST = 4.0  # rad from which on it is their amplitude alone that does
VAGUE = 1e300  # a bound that is as good as none, and does not overflow


def rates_of(phase: LinearPhase) -> Array:
    """[A f c]."""
    return np.concatenate((phase.A, phase.f[..., None], phase.c[..., None]), axis=2)


def rows_of(phase: LinearPhase | NonlinearPhase) -> Array:
    """[C d e] of outputs and conditions."""
    S, m, n = phase.C.shape
    rows = np.zeros((S, m + len(phase.events), n + 2))
    rows[:, :m, :n], rows[:, :m, n], rows[:, :m, n + 1] = phase.C, phase.d, phase.e
    for j, event in enumerate(phase.events, m):
        rows[:, j, :n], rows[:, j, n], rows[:, j, n + 1] = event.row, event.direct, event.constant
    return rows


def steps_of(rates: Array, h: float, halvings: int) -> Array:
    """The changes of the states in one sample, from y, the accelerations at its ends, and 1."""
    S, n, _ = rates.shape
    G = np.zeros((S, n + 3, n + 3))  # of y, a, its rise, and 1
    G[:, :n, :n], G[:, :n, n], G[:, :n, n + 2] = rates[..., :n] * h, rates[..., n] * h, rates[..., n + 1] * h
    G[:, n, n + 1] = 1.0
    step = exponentials_less_identity(G, halvings)[0][:, :n]
    step[..., n] -= step[..., n + 1]
    return step


def tables_of_nonlinear_phase(rows: Array, m: int) -> list[Array]:
    """Return the tables of a phase that is not linear, from its rows, of which m are outputs."""
    now, outs, none = padded(rows[:, m:]), padded(rows[:, :m]), np.zeros((1, 0, 1))
    return [none] * 3 + [now, outs] + [none] * 7 + [np.abs(now), np.abs(outs), DENSE * np.eye(8, 1)[None]]


def shift_of(rates: Array) -> int:
    """The number of first states whose rates are as many states after them, as positions before their velocities."""
    _, n, columns = rates.shape
    shift = int(rates[0, 0, : n // 2 + 1].argmax()) if n else 0  # the first rate could be no other state
    return shift if (rates[:, :shift] == np.eye(shift, columns, shift)).all() else 0


def halvings_of(turn: Any, longest: float | Array) -> Any:
    """How often a step must be halved so that no mode turns by more than `longest`, in rad."""
    return np.maximum(0, np.ceil(np.log2(np.clip(turn / longest, 1e-300, 1e300)))).astype(int)


def spectral_radius_bound(A: Array) -> Array:
    """A close upper estimate of the spectral radius of each matrix."""
    power = A
    for _ in range(4):
        power = power @ power
    return np.asarray(np.sqrt((power * power).sum(axis=(1, 2))) ** (1.0 / 16.0))


@np.errstate(over="ignore", invalid="ignore")  # of a step that is too long, which is refused later
def exponentials_less_identity(G: Array, halvings: int) -> list[Array]:
    """exp(G/2^k) - 1 for k = 0, 1, .., by the Taylor series of the last one, and squaring.

    Without the 1 its rounding is relative to the change of a step, so that many steps do not add up the same error, and
    squaring costs slow modes no digits beside fast ones.
    """
    X = G / 2.0**halvings
    total = term = X
    for k in range(2, 60):
        term = term @ X / k
        if k >= FEWEST:
            ends = (np.abs(term) <= SMALL * np.abs(total)).all(axis=(1, 2))
            term[ends] = 0.0  # so that no number of terms depends on the other matrices
            if ends.all():
                break
        total = total + term
    found = [total]
    for _ in range(halvings):
        found.append(2.0 * found[-1] + found[-1] @ found[-1])
    return found[::-1]


def tables_in_row_groups(tables: Array, most: int) -> Array:
    """The tables column after column, in groups of at most so many rows, of nearly the same size."""
    count, rows, _ = tables.shape
    if rows <= most:
        return tables.transpose(0, 2, 1).reshape(count, -1)
    parts, first = list[Array](), 0
    while first < rows:  # the last two groups are of nearly the same size
        left = (rows - first) // 8
        last = first + 8 * min(left if left <= most // 8 else (left + 1) // 2, most // 8)
        parts.append(tables[:, first:last].transpose(0, 2, 1).reshape(count, -1))
        first = last
    return np.concatenate(parts, axis=1)


def parts_of_events(
    events: Sequence[Event], systems: int, group: int
) -> tuple[list[Event | Rest | None], list[Array | None], list[Rest | None], list[Array]]:
    """What follows each event, or instead of it; of each the jump, if it is a matrix; of each event what is instead.

    Last the scales of the events, and these jumps and conditions, each with a row for every system.
    """
    outcomes = [outcome for event in events for outcome in (event, event.rest)]
    given: list[Any] = [None if outcome is None else outcome.jump for outcome in outcomes]
    jumps: list[Array | None] = [jump if isinstance(jump, np.ndarray) else None for jump in given]
    rests = [event.rest for event in events]
    scales = np.array([event.scale for event in events]).reshape(len(events), systems).T
    tables = [jump_table(jump, group) for jump in jumps if jump is not None]
    return outcomes, jumps, rests, [scales, *tables, *(conditions_of(rest) for rest in rests if rest is not None)]


def conditions_of(rest: Rest) -> Array:
    """What follows instead of an event: columns y, a, 1, then what a_v multiplies: y, 1."""
    more = np.zeros_like(rest.row) if rest.row_v is None else rest.row_v
    return np.column_stack((rest.row, rest.direct, rest.constant, more, rest.direct_v))


def laid(tables: Iterable[Array], group: int, more: Sequence[Array] = ()) -> tuple[Array, NDArray[np.intp]]:
    """Tables in groups of at most so many rows, and more parts, in one array; and where they begin."""
    parts = [*(tables_in_row_groups(each, group) for each in tables), *more]
    content, places = room_for([part.shape[1] for part in parts], len(parts[0]))
    fill(content, places, parts)
    return content, places


def room_for(sizes: Iterable[int], systems: int) -> tuple[Array, NDArray[np.intp]]:
    """An array with room for parts of these sizes of every system, each from a line of the cache on; their places."""
    places = np.cumsum([0, *map(up8, sizes)], dtype=np.intp)
    room = np.zeros(systems * int(places[-1]) + 8)
    first = -(room.ctypes.data // 8) % 8
    return room[first : first + systems * int(places[-1])].reshape(systems, -1), places


def fill(content: Array, places: NDArray[np.intp], parts: Iterable[Array]) -> None:
    """Put the parts at their places."""
    for part, place in zip(parts, places, strict=False):
        content[:, place : place + part.shape[1]] = part


def room_of_tables(
    systems: int, n: int, outputs: int, rows: int, shift: int, parts: int, capped: int, more: Sequence[Array]
) -> tuple[Array, NDArray[np.intp]]:
    """An array with room for the tables of a linear phase, as in `march.h`, and with more parts; and their places."""
    later, bounds, looked_at = n + AHEAD + 2, parts + 2, n - shift + rows - outputs
    now = max(up8(looked_at) * (n + 2), (looked_at - shift) * up8(n + 2))
    fast, outs, slopes = capped, up8(outputs) * (n + 2), SLOTS * rows * later
    block = (up8(AHEAD * rows) + up8(n)) * later
    bounded = up8(rows) * bounds
    sizes = [block, up8(n) * (n + 3), up8(parts) * (n + 2), now, outs, slopes]
    sizes += [bounded, bounded * fast, slopes * fast, bounded, up8(rows - outputs) * bounds, up8(rows), now, outs]
    sizes += [8 + 10 * up8(shift)]
    content, places = room_for([*sizes, *(part.shape[1] for part in more)], systems)
    fill(content, places[len(sizes) :], more)
    return content, places


def roots_and_vectors(A: Array) -> tuple[Array, Array]:
    """All roots, real parts and then imaginary ones, and vectors: of two conjugate ones the real and imaginary part."""
    roots, columns = (np.asarray(each, dtype=np.complex128) for each in np.linalg.eig(A))
    vectors = np.where(roots.imag[:, None] < 0.0, -columns.imag, columns.real)
    return np.concatenate((roots.real, roots.imag), axis=1), np.ascontiguousarray(vectors)


def jump_table(jump: Array, most: int) -> Array:
    """A matrix J and |J|, one after the other, in groups of rows."""
    table = tables_in_row_groups(padded(jump), most)
    return np.concatenate((table, np.abs(table)), axis=1)


def padded(table: NDArray[Any]) -> NDArray[Any]:
    """The tables with zeros below, to a multiple of 8 rows."""
    *stack, rows, columns = table.shape
    if rows == up8(rows):
        return table
    full = np.zeros((*stack, up8(rows), columns), table.dtype)
    full[..., :rows, :] = table
    return full


def by_rows(rows: NDArray[Any], matrix: NDArray[Any]) -> NDArray[Any]:
    """The product of rows and a matrix, in which no row depends on how many there are.

    BLAS takes some rows at a time, and sums those that are left over in another order.
    """
    return np.asarray(padded(rows) @ matrix)[..., : rows.shape[-2], :]
