"""The matrices of a phase for one time step, for a stack of systems at once."""

from itertools import pairwise
from threading import RLock
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools, Integers
from rockflex.engine.system import Key, LinearPhase, NonlinearPhase, StepTooLongError, System, up8

AHEAD, BLOCK = 4, 16  # as in march.h
LONGEST = 2.5  # rad that a mode may turn within one power series: some thirty terms, and a digit lost
LOOK = 3  # terms of a series between two looks at whether it has ended, which take longer than the terms; some
FEWEST = 12  # fifteen are needed, and never fewer than these
SMALL = 1e-18  # of a sum: terms that no longer change it
FINEST = 8  # halvings of h/2 between which bounds allow for the growth of motion, at most
FAST = 3.0  # rad that a mode turns within a step, from which on its amplitude bounds what it can do
POOR = 1e6  # condition of a mode from which on its part is useless
PLACES = 8  # of a block whose matrices are kept: with more, these take longer than the rows
KEPT = 2**16  # numbers in the grids of earlier phases that a run keeps, but for its last two phases
# Two threads that prepare at once pass the interpreter's lock to and fro, in every second call of NumPy.
PREPARING = RLock()
AT_ONCE = 2**14  # numbers that fit into the cache
VAGUE = 1e100  # a bound that is as good as none, and does not overflow


class Tables(NamedTuple):
    """Fields as in `march.h`, each with a first axis for the systems."""

    outputs: int
    rows: int
    shift: int
    halvings: NDArray[np.intc]  # of the step, so that its power series converge
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


class Reach(NamedTuple):
    """Places within a block that bounds look at, h/2 apart."""

    grid: Array  # e^{At} at the first of them, (S, n, places, n)
    leap: Array  # e^{At} - 1 from there to as many others
    growth: Array  # bounds of its entries between two places


class Motion(NamedTuple):
    """What phases share that differ in constants and rows alone, as where a bar yields one way or the other."""

    key: bytes  # A, f, and which rates have a constant
    halvings: Integers
    splits: list["Split | None"]
    slow: Array  # A and f without fast modes
    driven: Array
    free: Array  # change of the states in a step, from themselves and the accelerations at its ends
    pushed: Array  # and from the constants of their rates
    reach: Reach
    C: Array  # of outputs and conditions of the last phase
    bounds: tuple[Array, Array, Array]  # of them: bend, sway and jolt

    def bounds_of(self, C: Array, m: int, h: float) -> tuple[Array, Array, Array]:
        """Those of other rows; a mirror image, as of a base that rocks about its other edge, has some reversed."""
        if C.shape == self.C.shape and ((self.C == C).all(axis=2) | (self.C == -C).all(axis=2)).all():
            return self.bounds
        return derivative_bound_factors(self.slow, self.driven, C, m, self.reach, h)


def motion_of(A: Array, f: Array, steady: Bools, h: float, key: bytes) -> Motion:
    """Compute what does not depend on rows, and of constants only on where there are `steady` ones."""
    (S, n), (places,) = f.shape, np.nonzero(steady)
    turn = spectral_radius_bound(A * h)
    halvings, squared = halvings_of(turn, np.array([[LONGEST], [1.0]]))
    splits = [split_fast_modes(A[place], f[place], h) if turn[place] > FAST else None for place in range(S)]
    slow, driven = A.copy(), f.copy()
    for place, each in enumerate(splits):
        if each is not None:
            slow[place], driven[place] = each.slow, each.driven
    parted = np.array([each is not None for each in splits])
    fine = np.minimum(halvings_of(spectral_radius_bound(np.abs(slow) * h), 1.0), FINEST)
    G = np.zeros((S, n + 1, n + 2 + places.size))  # of y and a; their columns, a rise of a, and constant rates
    G[:, :n, :n], G[:, :n, n], G[:, n, n + 1], G[:, places, n + 2 + np.arange(places.size)] = A * h, f * h, 1.0, h
    whole, found = np.empty((S, n, G.shape[2])), list[tuple[Any, Reach]]()
    kinds = {*zip(squared.tolist(), fine.tolist(), parted.tolist(), strict=True)}
    for kind in kinds:
        alike = (squared == kind[0]) & (fine == kind[1]) & (parted == kind[2])
        some: Any = np.flatnonzero(alike) if len(kinds) > 1 else slice(None)
        changes = exponentials_less_identity(G[some], kind[0] if kind[2] else max(kind[0], kind[1]) + 1)
        whole[some] = changes[0][:, :n]
        of_states = (
            exponentials_less_identity(slow[some] * h, kind[1] + 1)
            if kind[2]
            else [each[:, :n, :n] for each in changes]
        )
        found.append((some, reach_of(slow[some], of_states[1 : kind[1] + 2], h)))
    reach = found[0][1]
    if len(found) > 1:
        reach = Reach(*(np.empty((S, *each.shape[1:])) for each in reach))
        for some, each in found:
            for into, part in zip(reach, each, strict=True):
                into[some] = part
    free = whole[..., : n + 2].copy()
    free[..., n] -= free[..., n + 1]
    by_constants, none = np.zeros((S, n, n)), np.zeros((S, 0, n + 2))
    by_constants[..., places] = whole[..., n + 2 :]
    return Motion(key, halvings, splits, slow, driven, free, by_constants, reach, none[..., :n], (none, none, none))


@np.errstate(over="ignore", invalid="ignore")
def tables_of(phase: LinearPhase, h: float, motions: list[Motion]) -> Tables:
    """Compute the tables of a stack of phases for steps of h. Those of one system do not depend on the others.

    `motions` are those of some earlier phases for the same h; this one is added.
    """
    A, f, c = phase.A, phase.f, phase.c
    (S, n), m, k = f.shape, phase.d.shape[1], len(phase.events)
    rates = np.concatenate((A, f[..., None], c[..., None]), axis=2)
    rows = np.zeros((S, m + k, n + 2))
    rows[:, :m, :n], rows[:, :m, n], rows[:, :m, n + 1] = phase.C, phase.d, phase.e
    for row, event in zip(rows[:, m:].swapaxes(0, 1), phase.events, strict=True):
        row[:, :n], row[:, n], row[:, n + 1] = event.row, event.direct, event.constant
    C = rows[..., :n]

    steady = np.asarray(c.any(axis=0))
    key = A.tobytes() + f.tobytes() + steady.tobytes()
    motion = next((each for each in motions if each.key == key), None) or motion_of(A, f, steady, h, key)
    bounds = motion.bounds_of(C, m, h)
    others = [each for each in motions if each.key != key]
    motions[:] = [*others, motion._replace(C=C, bounds=bounds)][-max(2, KEPT // max(1, motion.reach.grid.size)) :]
    bend, sway, jolt = bounds
    most = max((len(each.parts) for each in motion.splits if each is not None), default=0)
    moves, cap, centre = np.zeros((S, n + most, n)), np.zeros((S, m + k, n + 2 + most)), rows
    moves[:, :n] = np.eye(n)
    if most:
        bend, sway, jolt = (np.concatenate((each, np.zeros((*each.shape[:2], most))), axis=2) for each in bounds)
        centre = rows.copy()
    for place, each in enumerate(motion.splits):
        if each is not None:
            end, seen = n + len(each.parts), rows_of_fast_modes(each, C[place], h)
            moves[place, :n], moves[place, n:end] = each.rest, each.parts
            cap[place, :, n : n + 2], cap[place, :, n + 2 : end + 2] = by_rows(seen.cap, each.push), seen.cap
            sway[place, :, n : n + 2] += by_rows(seen.sway, each.push)
            sway[place, :, n + 2 : end + 2] = seen.sway
            sway[place, :, n + 1] += seen.jerk
            jolt[place] = VAGUE
            centre[place] -= by_rows(seen.swing, rates[place])
    step = np.concatenate((motion.free, motion.pushed @ c[..., None]), axis=2)
    changes = state_changes_at_samples(step)
    shift = shift_of(rates)
    now, outs = padded(np.concatenate((rates[:, shift:], rows[:, m:]), axis=1)), padded(rows[:, :m])
    return Tables(
        outputs=m,
        rows=m + k,
        shift=shift,
        halvings=motion.halvings.astype(np.intc),
        block=np.concatenate((rows_at_samples(rows, changes, 1), padded(changes[:, -1])), axis=1),
        step=padded(step),
        moves=padded(moves @ rates),
        now=now,
        outs=outs,
        slope=rows_at_samples(by_rows(C, rates), changes, 0),
        bend=padded(bend),
        cap=padded(cap),
        centre=rows_at_samples(centre, changes if most else changes[:, :1], 0),
        sway=padded(sway),
        jolt=padded(jolt),
        direct=padded(rows[:, :, n, None]),
        magnitude=np.abs(now),
        most=np.abs(outs),
    )


def prepared_phase_and_tables(
    system: System, key: Key, h: float, motions: list[Motion]
) -> tuple[LinearPhase | NonlinearPhase, Tables]:
    """Return the phase of a key, and its tables for steps of h.

    Raises
    ------
    StepTooLongError
        If a linear motion overflows within a step.
    """
    with PREPARING:
        phase = system.checked(key)
        if isinstance(phase, NonlinearPhase):
            return phase, tables_of_nonlinear_phase(phase)
        tables = tables_of(phase, h, motions)
    if not np.isfinite(tables.step).all():
        words = f"phase {key!r}: the motion grows without bound within one time step of {h:.9g}."
        raise StepTooLongError(words, float(np.linalg.eigvals(phase.A).real.max()))
    return phase, tables


def tables_of_nonlinear_phase(phase: NonlinearPhase) -> Tables:
    """Return the tables of a phase that is not linear: those of its outputs and conditions."""
    (_, m, n), k = phase.C.shape, len(phase.events)
    outs, now = np.zeros((1, m, n + 2)), np.zeros((1, k, n + 2))
    outs[..., :n], outs[..., n], outs[..., n + 1] = phase.C, phase.d, phase.e
    for row, event in zip(now.swapaxes(0, 1), phase.events, strict=True):
        row[:, :n], row[:, n], row[:, n + 1] = event.row, event.direct, event.constant
    tables = {"now": now, "outs": outs, "magnitude": np.abs(now), "most": np.abs(outs)}
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
    pushed: Array  # |W f|
    root: NDArray[np.complex128]  # λ
    both: Array  # 2 of a pair of conjugate modes, 1 of a mode that does not oscillate
    V: NDArray[Any]
    W: NDArray[Any]


def split_fast_modes(A: Array, f: Array, h: float) -> Split | None:
    """Part the fast modes from the others; None if that is ill-conditioned. It serves the bounds alone."""
    roots, vectors = (np.asarray(each, dtype=np.complex128) for each in np.linalg.eig(A))
    try:
        inverse = np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        return None
    fast = (np.abs(roots) * h > FAST) & (roots.imag >= 0.0)
    V, W, root = vectors[:, fast], inverse[fast], roots[fast]
    both = np.where(root.imag > 0.0, 2.0, 1.0)
    if not fast.any() or not (np.abs(W.T) * np.abs(V)).sum(axis=0).max() < POOR:
        return None
    share = np.real((V * both) @ W)
    push, fades = np.abs(W @ f), np.maximum(-root.real, 0.0)
    soon = fades * BLOCK * h > 1.0
    grown = np.column_stack((np.where(soon, 0.0, push), np.where(soon, push / np.maximum(fades, 1e-300), 0.0)))
    return Split(
        slow=A - np.real((V * (both * root)) @ W),
        driven=f - share @ f,
        rest=np.eye(len(A)) - share,
        parts=np.asarray(np.concatenate((W.real, W.imag)), dtype=float),
        push=np.concatenate((grown, np.zeros_like(grown))),
        pushed=push,
        root=root,
        both=both,
        V=V,
        W=W,
    )


class FastRows(NamedTuple):
    """What fast modes do to every row."""

    cap: Array  # factors of the magnitudes of `parts` in a bound of the distance from the chord, (R, F)
    sway: Array  # the same for h³/96 times the third derivative
    jerk: Array  # and its factor of |a'|, (R,)
    swing: Array  # what they add beside what changes linearly in a sample, from y', (R, n)


def rows_of_fast_modes(split: Split, C: Array, h: float) -> FastRows:
    """Compute what fast modes do to rows."""
    root = split.root
    seen = by_rows(C, split.V)
    size = split.both * np.abs(seen) * np.exp(np.maximum(root.real, 0.0) * BLOCK * h)
    bent = size * np.abs(root) ** 2 * (h**3 / 96.0)
    return FastRows(
        cap=np.tile(2.0 * size / np.abs(root), 2),
        sway=np.tile(bent, 2),
        jerk=by_rows(bent / np.abs(root), split.pushed[:, None])[:, 0],
        swing=np.real(by_rows(seen * (split.both / root), split.W)),
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


def rows_at_samples(rows: Array, changes: Array, first: int) -> Array:
    """The rows at the samples from the first on, one sample after another, from the same."""
    S, K, n, columns = changes.shape
    seen = by_rows(rows[:, None, :, :n], changes[:, first:])
    seen[..., :n] += rows[:, None, :, :n]
    of_acceleration = np.einsum("skrk->skr", seen[..., n + first : n + K])  # a view
    of_acceleration += rows[:, None, :, n]
    seen[..., -1] += rows[:, None, :, n + 1]
    return padded(seen.reshape(S, -1, columns))


def derivative_bound_factors(
    A: Array, f: Array, C: Array, m: int, reach: Reach, h: float
) -> tuple[Array, Array, Array]:
    """Factors of |y'|, of the variation of a and of |a'| in bounds of rows' derivatives within a block.

    They are those of h²/8 |r''| and h³/96 |r'''| of all rows and, from row m on, of h⁴/384 |r''''|. With v = y' and
    v' = A v + f a' these are r'' = C A v + C f a', r''' = C A² v + C A f a' and so on, at most |C A e^{At}| |v(0)| and
    so on; between the places of a grid of h/2 the matrices grow at most by `growth`, entry by entry. For several
    inputs, whose f has a last axis more, all variations come before the slopes.
    """
    S, rows, n = C.shape
    counts = rows, rows, rows - m
    f = f.reshape(S, n, -1)
    if rows == 0:
        empty = np.zeros((S, 0, n + 2 * f.shape[2]))
        return empty, empty, empty
    once = by_rows(C, A)
    before = np.concatenate((C, once, by_rows(once[:, m:], A)), axis=1)
    most, direct = most_of(by_rows(before, A), reach), np.abs(by_rows(before, f))
    found = np.concatenate((most, by_rows(most, np.abs(f)), direct), axis=2)
    found *= np.repeat((h**2 / 8.0, h**3 / 96.0, h**4 / 384.0), counts)[:, None]
    found = np.where(found < VAGUE, found, VAGUE)  # NaN is vague, too
    return found[:, :rows], found[:, rows : 2 * rows], found[:, 2 * rows :]


def reach_of(A: Array, changes: list[Array], h: float) -> Reach:
    """Compute the places of a block from the changes in h/2, h/4, .."""
    S, n, _ = A.shape
    grid, leap, places = np.eye(n)[None, None].repeat(S, axis=0), changes[0], 1
    while places < PLACES and places * n * n <= AT_ONCE:
        grid = np.concatenate((grid, grid + grid @ leap[:, None]), axis=1)
        leap, places = 2.0 * leap + leap @ leap, 2 * places
    return Reach(np.ascontiguousarray(grid.swapaxes(1, 2)), leap, growth(0.5 * h * A, changes))


def most_of(rows: Array, reach: Reach) -> Array:
    """Bounds of the entries of rows · e^{At} within a block."""
    (S, n, places, _), count, here = reach.grid.shape, rows.shape[1], padded(rows)
    grid, most = reach.grid.reshape(S, n, places * n), np.abs(here)
    some = max(8, AT_ONCE // (S * places * n) // 8 * 8)
    for passed in range(0, 2 * BLOCK, places):
        here = here + here @ reach.leap if passed else here
        for first in range(0, here.shape[1], some):
            there = np.abs(here[:, first : first + some] @ grid)
            while (half := there.shape[2] // 2) >= n:  # far faster than `max` over an axis within
                there = np.maximum(there[..., :half], there[..., half:])
            np.maximum(most[:, first : first + some], there, out=most[:, first : first + some])
    return np.asarray(most @ reach.growth)[:, :count]


def growth(G: Array, changes: list[Array]) -> Array:
    """Bounds of the entries of e^{Gt} for all t in [0, 1], from the changes in 1, 1/2, .. 1/2^k.

    Between the places of a grid of 1/2^k it is at most e^B with B = |G|/2^k, itself at most 1 + B + B² + ...
    """
    S, n, _ = G.shape
    grid = np.eye(n)[None].repeat(S, axis=0)
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
    return np.ceil(np.log2(np.clip(turn / longest, 1.0, 1e300))).astype(int)


def spectral_radius_bound(A: Array) -> Array:
    """A close upper estimate of the spectral radius of each matrix."""
    power = A
    for _ in range(4):
        power = power @ power
    return np.asarray(np.sqrt((power * power).sum(axis=(1, 2))) ** (1.0 / 16.0))


def exponentials_less_identity(G: Array, halvings: int) -> list[Array]:
    """exp(G/2^k) - 1 for k = 0, 1, .., by the Taylor series of the last one, and squaring.

    Without the 1 its rounding is relative to the change of a step, so that many steps do not add up the same error, and
    squaring costs slow modes no digits beside fast ones. Rows that G lacks are zero.
    """
    n = G.shape[1]
    X = G / 2.0**halvings
    total = term = X
    for k in range(2, 60):
        term = term[..., :n] @ X / k
        if k >= FEWEST and k % LOOK == 0:
            ends = (np.abs(term) <= SMALL * np.abs(total)).all(axis=(1, 2))
            term[ends] = 0.0  # so that no number of terms depends on the other matrices
            if ends.all():
                break
        total = total + term
    found = [total]
    for _ in range(halvings):
        found.append(2.0 * found[-1] + found[-1][..., :n] @ found[-1])
    return found[::-1]


def tables_in_row_groups(tables: Array, most: int) -> Array:
    """The tables column after column, in groups of at most so many rows, of nearly the same size."""
    count, rows, _ = tables.shape
    groups = -(-rows // most)
    if groups < 2:
        return tables.transpose(0, 2, 1).reshape(count, -1)
    bounds = [rows // 8 * g // groups * 8 for g in range(groups + 1)]
    parts = [tables[:, a:b].transpose(0, 2, 1).reshape(count, -1) for a, b in pairwise(bounds)]
    return np.concatenate(parts, axis=1)


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
