"""The matrices of a phase for one time step in NumPy, as `prepare.h` makes them."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex.engine.system import Event, LinearPhase, NonlinearPhase, Rest, up8
from rockflex.foundation.arrays import Array

AHEAD, BLOCK = 4, 16  # as in march.h
DENSE = -2.0  # as in march.h
SLOTS = 8  # of each row, in a table for the ends of AHEAD samples
LONGEST = 2.5  # rad that a mode may turn within one power series: some thirty terms, and a digit lost
FEWEST = 10  # terms of a series, of which none is looked at: that they end earlier is rare
SMALL = 1e-18  # of a sum: terms that no longer change it
ENDLESS = -1  # for `halvings`: no step is short enough, as the motion overflows
FINEST = 8  # halvings of h/2 between which bounds allow for the growth of motion, at most
FAST = 3.0  # rad that a mode turns within a step, from which on its amplitude bounds what it can do
POOR = 1e6  # condition of a mode from which on its part is useless
AT_ONCE = 4096  # entries of rows at several places of a block that fit into the cache, before they are doubled
VAGUE = 1e300  # a bound that is as good as none, and does not overflow


class Tables(NamedTuple):
    """Fields as in `march.h`, each with a first axis for the systems."""

    outputs: int
    rows: int
    shift: int
    halvings: NDArray[np.intc]  # of the step, so that its power series converge; or ENDLESS
    block: Array
    step: Array
    moves: Array
    now: Array
    outs: Array
    slope: Array
    bend: Array
    cap: Array
    centre: Array
    sway: Array
    jolt: Array
    direct: Array
    magnitude: Array
    most: Array
    border: Array  # of no use here, where all rates are in `now`


def rates_and_rows(phase: LinearPhase) -> tuple[Array, Array]:
    """[A f c], and [C d e] of outputs and conditions."""
    (_, m, n), k = phase.C.shape, len(phase.events)
    rates = np.concatenate((phase.A, phase.f[..., None], phase.c[..., None]), axis=2)
    rows = np.zeros((len(rates), m + k, n + 2))
    rows[:, :m, :n], rows[:, :m, n], rows[:, :m, n + 1] = phase.C, phase.d, phase.e
    for j, event in enumerate(phase.events, m):
        rows[:, j, :n], rows[:, j, n], rows[:, j, n + 1] = event.row, event.direct, event.constant
    return rates, rows


@np.errstate(over="ignore", invalid="ignore")
def tables_of(phase: LinearPhase, h: float) -> Tables:
    """Compute the tables of a stack of phases for steps of h. Those of one system do not depend on the others."""
    rates, rows = rates_and_rows(phase)
    (S, n, _), R, m = rates.shape, rows.shape[1], phase.d.shape[1]
    A, f, C, turn = phase.A, phase.f, rows[..., :n], spectral_radius_bound(phase.A * h)
    splits = [split_fast_modes(A[place], f[place], C[place], h) if turn[place] > FAST else None for place in range(S)]
    most = max((len(each.parts) for each in splits if each is not None), default=0)
    moves, (bend, cap, sway) = np.zeros((S, n + most, n)), np.zeros((3, S, R, n + 2 + most))
    jolt, step = np.zeros((S, R - m, n + 2 + most)), np.empty((S, n, n + 3))
    moves[:, :n] = np.eye(n)
    centre = rows.copy()
    for place, each in enumerate(splits):
        one, slow, driven = slice(place, place + 1), A[place], f[place]
        if each is not None:
            end = n + len(each.parts)
            slow, driven, moves[place, :n], moves[place, n:end] = each[:4]
            cap[place, :, n : n + 2], cap[place, :, n + 2 : end + 2] = each.cap @ each.push, each.cap
            sway[place, :, n : n + 2], sway[place, :, n + 2 : end + 2] = each.sway @ each.push, each.sway
            sway[place, :, n + 1] += each.jerk
            centre[place] -= each.swing @ rates[place]
            jolt[place] = VAGUE
        fine = int(min(halvings_of(spectral_radius_bound(np.abs(slow[None]) * h)[0], 1.0), FINEST))
        step[one] = steps_of(rates[one], h, int(halvings_of(turn[place], 1.0)))
        changes = exponentials_less_identity(slow[None] * h, fine + 1)[1:]
        found = derivative_bound_factors(slow[None], driven[None], C[one], m, changes, h)
        bend[one, :, : n + 2] = found[0]
        sway[one, :, : n + 2] += found[1]
        if each is None:
            jolt[one, :, : n + 2] = found[2]
    changes, shift = state_changes_at_samples(step), shift_of(rates)
    now, outs = padded(np.concatenate((rates[:, shift:], rows[:, m:]), axis=1)), padded(rows[:, :m])
    endless = ~np.isfinite(step).all(axis=(1, 2))
    return Tables(
        outputs=m,
        rows=R,
        shift=shift,
        halvings=np.where(endless, ENDLESS, halvings_of(turn, LONGEST)).astype(np.intc),
        block=np.concatenate((rows_at_samples(rows, changes, 1, AHEAD), padded(changes[:, -1])), axis=1),
        step=padded(step),
        moves=padded(moves @ rates),
        now=now,
        outs=outs,
        slope=rows_at_samples(by_rows(C, rates), changes, 0, SLOTS),
        bend=padded(bend),
        cap=padded(cap),
        centre=rows_at_samples(centre, changes, 0, SLOTS),
        sway=padded(sway),
        jolt=padded(jolt),
        direct=padded(rows[:, :, n, None]),
        magnitude=np.abs(now),
        most=np.abs(outs),
        border=np.tile(DENSE * np.eye(8, 1), (S, 1, 1)),
    )


def steps_of(rates: Array, h: float, halvings: int) -> Array:
    """The changes of the states in one sample, from y, the accelerations at its ends, and 1."""
    S, n, _ = rates.shape
    G = np.zeros((S, n + 3, n + 3))  # of y, a, its rise, and 1
    G[:, :n, :n], G[:, :n, n], G[:, :n, n + 2] = rates[..., :n] * h, rates[..., n] * h, rates[..., n + 1] * h
    G[:, n, n + 1] = 1.0
    step = exponentials_less_identity(G, halvings)[0][:, :n]
    step[..., n] -= step[..., n + 1]
    return step


def tables_of_nonlinear_phase(phase: NonlinearPhase) -> Tables:
    """Return the tables of a phase that is not linear: those of its outputs and conditions."""
    (_, m, n), k = phase.C.shape, len(phase.events)
    outs, now = np.zeros((1, m, n + 2)), np.zeros((1, k, n + 2))
    outs[..., :n], outs[..., n], outs[..., n + 1] = phase.C, phase.d, phase.e
    for row, event in zip(now.swapaxes(0, 1), phase.events, strict=True):
        row[:, :n], row[:, n], row[:, n + 1] = event.row, event.direct, event.constant
    tables = {
        "now": now,
        "outs": outs,
        "magnitude": np.abs(now),
        "most": np.abs(outs),
        "border": DENSE * np.eye(8, 1)[None],
    }
    empty = dict.fromkeys(set(Tables._fields[4:]) - set(tables), np.zeros((1, 0, 2)))
    known = {name: padded(table) for name, table in tables.items()}
    return Tables(outputs=m, rows=m + k, shift=n, halvings=np.zeros(1, dtype=np.intc), **known, **empty)


def shift_of(rates: Array) -> int:
    """The number of first states whose rates are as many states after them, as positions before their velocities."""
    _, n, columns = rates.shape
    shift = int(rates[0, 0, : n // 2 + 1].argmax()) if n else 0  # the first rate could be no other state
    return shift if (rates[:, :shift] == np.eye(shift, columns, shift)).all() else 0


class Split(NamedTuple):
    """The fast modes of a phase parted from the others, with y' = v + Σ V w, v' = A_s v + f_s a', w' = λ w + W f a'.

    What they add to a row never gets further from its chord in a sample than 2 |C V/λ| |w|.
    """

    slow: Array  # A_s
    driven: Array  # f_s
    rest: Array  # v from y'
    parts: Array  # real and imaginary parts of all w from y', (F, n)
    push: Array  # by how much w may grow within a block, for the variation of a and for |a'|, (F, 2)
    cap: Array  # of every row, factors of those parts' magnitudes in a bound of the distance from the chord, (R, F)
    sway: Array  # the same for h³/96 times the third derivative
    jerk: Array  # and its factor of |a'|, (R,)
    swing: Array  # what they add to every row beside what changes linearly in a sample, from y', (R, n)


def split_fast_modes(A: Array, f: Array, C: Array, h: float) -> Split | None:
    """Part the fast modes from the others; None if that is ill-conditioned. It serves the bounds alone."""
    roots, vectors = (np.asarray(each, dtype=np.complex128) for each in np.linalg.eig(A))
    try:
        inverse = np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        return None
    fast = (np.abs(roots) * h > FAST) & (roots.imag >= 0.0)
    V, W, root = vectors[:, fast], inverse[fast], roots[fast]
    both = np.where(root.imag > 0.0, 2.0, 1.0)  # of a pair of conjugate modes
    if not fast.any() or not (np.abs(W.T) * np.abs(V)).sum(axis=0).max() < POOR:
        return None
    share = np.real((V * both) @ W)
    seen = by_rows(C, V)
    size = both * np.abs(seen) * np.exp(np.maximum(root.real, 0.0) * BLOCK * h)
    bent = size * np.abs(root) ** 2 * (h**3 / 96.0)
    push, fades = np.abs(W @ f), np.maximum(-root.real, 0.0)
    soon = fades * BLOCK * h > 1.0
    grown = np.column_stack((np.where(soon, 0.0, push), np.where(soon, push / np.maximum(fades, 1e-300), 0.0)))
    return Split(
        slow=A - np.real((V * (both * root)) @ W),
        driven=f - share @ f,
        rest=np.eye(len(A)) - share,
        parts=np.asarray(np.concatenate((W.real, W.imag)), dtype=float),
        push=np.concatenate((grown, np.zeros_like(grown))),
        cap=np.tile(2.0 * size / np.abs(root), 2),
        sway=np.tile(bent, 2),
        jerk=by_rows(bent / np.abs(root), push[:, None])[:, 0],
        swing=np.real(by_rows(seen * (both / root), W)),
    )


def state_changes_at_samples(step: Array) -> Array:
    """The changes of the states after 0, 1, .. samples, from y, the accelerations at the samples, and 1."""
    S, n, _ = step.shape
    found = np.zeros((S, AHEAD + 1, n, n + AHEAD + 2))
    for k in range(AHEAD):
        change = found[:, k] + step[..., :n] @ found[:, k]
        change[..., :n] += step[..., :n]
        change[..., -1] += step[..., -1]
        change[..., n + k : n + k + 2] += step[..., n : n + 2]
        found[:, k + 1] = change
    return found


def rows_at_samples(rows: Array, changes: Array, first: int, slots: int) -> Array:
    """Each row at the samples from the first on, and zeros up to so many slots, from the same."""
    S, K, n, columns = changes.shape
    seen = by_rows(rows[:, None, :, :n], changes[:, first:])
    seen[..., :n] += rows[:, None, :, :n]
    of_acceleration = np.einsum("skrk->skr", seen[..., n + first : n + K])  # a view
    of_acceleration += rows[:, None, :, n]
    seen[..., -1] += rows[:, None, :, n + 1]
    found = np.zeros((S, rows.shape[1], slots, columns))
    found[:, :, : K - first] = seen.swapaxes(1, 2)
    return padded(found.reshape(S, -1, columns))


def derivative_bound_factors(
    A: Array, f: Array, C: Array, m: int, changes: list[Array], h: float
) -> tuple[Array, Array, Array]:
    """Factors of |y'|, of the variation of a and of |a'| in bounds of rows' derivatives within a block.

    They are those of h²/8 |r''| and h³/96 |r'''| of all rows and, from row m on, of h⁴/384 |r''''|. With v = y' and
    v' = A v + f a' these are r'' = C A v + C f a', r''' = C A² v + C A f a' and so on, at most |C A e^{At}| |v(0)| and
    so on; between the places of a grid of h/2 the matrices grow at most by `growth`, entry by entry. `changes` are
    those of A in h/2, h/4, .. For several inputs, whose f has a last axis more, all variations come before the slopes.
    """
    S, rows, n = C.shape
    counts = rows, rows, rows - m
    f = f.reshape(S, n, -1)
    if rows == 0:
        empty = np.zeros((S, 0, n + 2 * f.shape[2]))
        return empty, empty, empty
    once = by_rows(C, A)
    before = np.concatenate((C, once, by_rows(once[:, m:], A)), axis=1)
    most, direct = most_of(by_rows(before, A), A, changes, h), np.abs(by_rows(before, f))
    found = np.concatenate((most, by_rows(most, np.abs(f)), direct), axis=2)
    found *= np.repeat((h**2 / 8.0, h**3 / 96.0, h**4 / 384.0), counts)[:, None]
    found = np.where(found < VAGUE, found, VAGUE)  # NaN is vague, too
    return found[:, :rows], found[:, rows : 2 * rows], found[:, 2 * rows :]


def most_of(rows: Array, A: Array, changes: list[Array], h: float) -> Array:
    """Bounds of the entries of rows · e^{At} within a block."""
    count, rows = rows.shape[1], padded(rows)
    here, change, places = rows[:, None], changes[0][:, None], 1
    while places < 2 * BLOCK and here[0].size <= AT_ONCE:
        here = np.concatenate((here, here + here @ change), axis=1)
        change, places = 2.0 * change + change @ change, 2 * places
    most = np.abs(here)
    for _ in range(2 * BLOCK // places - 1):
        here = here + here @ change
        np.maximum(most, np.abs(here), out=most)
    return np.asarray(most.max(axis=1) @ growth(0.5 * h * A, changes))[:, :count]


def growth(G: Array, changes: list[Array]) -> Array:
    """Bounds of the entries of e^{Gt} for all t in [0, 1], from the changes in 1, 1/2, .. 1/2^k.

    Between the places of a grid of 1/2^k it is at most e^B with B = |G|/2^k, itself at most 1 + B + B² + ...
    """
    S, n, _ = G.shape
    grid = np.tile(np.eye(n), (S, 1, 1))
    for step in reversed(changes[1:]):
        grid = np.concatenate((grid, grid + grid @ step), axis=1)
    most, between = np.abs(grid).reshape(S, -1, n, n).max(axis=1), np.abs(G) / 2.0 ** (len(changes) - 1)
    found, turn = most.copy(), spectral_radius_bound(between)
    near = turn <= 0.5
    found[near] = most[near] @ np.linalg.inv(np.eye(n) - between[near])
    for each in np.flatnonzero(~near):
        found[each] += (
            most[each] @ exponentials_less_identity(between[None, each], int(halvings_of(turn[each], 1.0)) + 1)[0][0]
        )
    return found


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
    systems: int, n: int, outputs: int, rows: int, shift: int, parts: int, more: Sequence[Array]
) -> tuple[Array, NDArray[np.intp]]:
    """An array with room for the tables of a linear phase, as in `march.h`, and with more parts; and their places."""
    later, bounds, looked_at = n + AHEAD + 2, parts + 2, n - shift + rows - outputs
    now = max(up8(looked_at) * (n + 2), (looked_at - shift) * up8(n + 2))
    fast, outs, slopes = int(parts > n), up8(outputs) * (n + 2), SLOTS * rows * later
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
