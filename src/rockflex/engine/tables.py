"""The matrices of a phase for one time step, for a stack of systems at once."""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex.engine.system import Key, LinearPhase, NonlinearPhase, StepTooLongError, System, up8

AHEAD, BLOCK = 4, 16  # as in march.h
LONGEST = 2.5  # rad that a mode may turn within one power series: some thirty terms, and a digit lost
SMALL = 1e-18  # of a sum: terms that no longer change it
FINEST = 8  # halvings of h/2 between which bounds allow for the growth of motion, at most
FAST = 3.0  # rad that a mode turns within a step, from which on its amplitude bounds what it can do
POOR, LOOSE = 1e6, 30.0  # conditions of a fast mode and of others from which on their part is useless
COUPLED = 1.4  # share of |A| in A from which on bounds by its entries are useless, since these cancel each other
ROUNDING = 1e-13  # of the magnitudes of its terms: what a row cannot see of a mode
STILL = 1e-6  # of the largest root: those that are next to zero
MIRRORS = 4  # phases that may have a mirror image yet to come
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


class Mirror(NamedTuple):
    """A phase, and what its mirror image shares with it: bases that rock about their other edge."""

    A: Array
    f: Array
    c: Array
    C: Array  # of outputs and conditions
    halvings: NDArray[np.intc]
    step: Array
    bounds: tuple[Array, Array, Array, Array]  # moves, bend, sway and jolt

    def sign(self, A: Array, f: Array, c: Array, C: Array) -> int:
        """1 if this is the same motion, -1 with c reversed, and with any rows reversed; 0 if it is another one."""
        if A.shape != self.A.shape or not (np.array_equal(A, self.A) and np.array_equal(f, self.f)):
            return 0
        if C.shape != self.C.shape or not ((self.C == C).all(axis=2) | (self.C == -C).all(axis=2)).all():
            return 0
        return 1 if np.array_equal(c, self.c) else -1 if np.array_equal(c, -self.c) else 0


@np.errstate(over="ignore", invalid="ignore")
def tables_of(phase: LinearPhase, h: float, mirrors: list[Mirror]) -> Tables:
    """Compute the tables of a stack of phases for steps of h. Those of one system do not depend on the others.

    `mirrors` are some earlier phases for the same h; this one is added.
    """
    A, f, c = phase.A, phase.f, phase.c
    (S, n), m, k = f.shape, phase.d.shape[1], len(phase.events)
    rates = np.concatenate((A, f[..., None], c[..., None]), axis=2)
    rows = np.zeros((S, m + k, n + 2))
    rows[:, :m, :n], rows[:, :m, n], rows[:, :m, n + 1] = phase.C, phase.d, phase.e
    for row, event in zip(rows[:, m:].swapaxes(0, 1), phase.events, strict=True):
        row[:, :n], row[:, n], row[:, n + 1] = event.row, event.direct, event.constant
    C, centre, most = rows[..., :n], rows.copy(), 0
    mirror, sign = next(((each, sign) for each in mirrors if (sign := each.sign(A, f, c, C))), (None, 0))
    if mirror is not None:
        halvings, step, (moves, bend, sway, jolt) = mirror.halvings, mirror.step.copy(), mirror.bounds
        step[..., -1] *= sign
        cap = np.zeros_like(bend)
    else:
        turn, tangle = radius(A * h), radius(np.abs(A) * h)
        modal = {
            place: found
            for place in np.flatnonzero((turn > FAST) | (tangle > COUPLED * turn)).tolist()
            if (found := modal_bounds(A[place], f[place], C[place], m, h)) is not None
        }
        most = max((len(each.moves) - n for each in modal.values()), default=0)
        moves, (bend, cap, sway) = np.zeros((S, n + most, n)), np.zeros((3, S, m + k, n + 2 + most))
        jolt, halvings = np.full((S, k, n + 2 + most), VAGUE), halvings_of(turn, LONGEST)
        moves[:, :n] = np.eye(n)
        for place, each in modal.items():
            end = len(each.moves) + 2
            halvings[place], moves[place, : end - 2] = halvings_of(each.fastest * h, LONGEST), each.moves
            for table, found in ((bend, each.bend), (cap, each.cap), (sway, each.sway), (jolt, each.jolt)):
                table[place, :, :end] = found
            centre[place] -= by_rows(each.swing, rates[place])
        G = np.zeros((S, n + 3, n + 3))  # of y, a, its rise, and 1
        G[:, :n, :n], G[:, :n, n], G[:, :n, n + 2], G[:, n, n + 1] = A * h, f * h, c * h, 1.0
        step = np.empty((S, n, n + 3))
        squared = halvings_of(turn, 1.0)
        fine = np.minimum(halvings_of(tangle, 1.0), FINEST)
        fine[[*modal]] = -1
        for kind in {*zip(squared.tolist(), fine.tolist(), strict=True)}:
            some = np.flatnonzero((squared == kind[0]) & (fine == kind[1]))
            changes = changes_of(G[some], max(kind[0], kind[1] + 1))
            whole = changes[0][:, :n]
            step[some, :, :n], step[some, :, n:] = whole[..., :n], whole[..., n:]
            step[some, :, n] -= whole[..., n + 1]
            if kind[1] >= 0:
                of_states = [each[:, :n, :n] for each in changes[1 : kind[1] + 2]]
                found = bounds(A[some], f[some], C[some], m, of_states, h)
                bend[some, :, : n + 2], sway[some, :, : n + 2], jolt[some, :, : n + 2] = found
                jolt[some, :, n + 2 :] = 0.0
        if not most:
            mirrors[:] = [*mirrors[1 - MIRRORS :], Mirror(A, f, c, C, halvings, step, (moves, bend, sway, jolt))]
    changes = changes_ahead(step)
    shift = shift_of(rates)
    now, outs = padded(np.concatenate((rates[:, shift:], rows[:, m:]), axis=1)), padded(rows[:, :m])
    return Tables(
        outputs=m,
        rows=m + k,
        shift=shift,
        halvings=halvings.astype(np.intc),
        block=np.concatenate((seen_ahead(rows, changes, 1), padded(changes[-1])), axis=1),
        step=padded(step),
        moves=padded(moves @ rates),
        now=now,
        outs=outs,
        slope=seen_ahead(by_rows(C, rates), changes, 0),
        bend=padded(bend),
        cap=padded(cap),
        centre=seen_ahead(centre, changes if most else changes[:1], 0),
        sway=padded(sway),
        jolt=padded(jolt),
        direct=padded(rows[:, :, n, None]),
        magnitude=np.abs(now),
        most=np.abs(outs),
    )


def prepared(system: System, key: Key, h: float, mirrors: list[Mirror]) -> tuple[LinearPhase | NonlinearPhase, Tables]:
    """Return the phase of a key, and its tables for steps of h.

    Raises
    ------
    StepTooLongError
        If a linear motion overflows within a step.
    """
    phase = system.checked(key)
    if isinstance(phase, NonlinearPhase):
        return phase, tables_of_rows(phase)
    tables = tables_of(phase, h, mirrors)
    if not np.isfinite(tables.step).all():
        words = f"phase {key!r}: the motion grows without bound within one time step of {h:.9g}."
        raise StepTooLongError(words, float(np.linalg.eigvals(phase.A).real.max()))
    return phase, tables


def tables_of_rows(phase: NonlinearPhase) -> Tables:
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
    for shift in range(n // 2, 0, -1):
        if (rates[:, :shift] == np.eye(shift, columns, shift)).all():
            return shift
    return 0


class ModalBounds(NamedTuple):
    """Bounds of rows by the modes of y': y' = Σ V w + Q z with w' = λ w + W f a' and z' = A_q z + f_q a'.

    z has what is left by modes that are ill-conditioned, as the place of a base that slides. What fast modes add to a
    row never gets further from its chord in a sample than 2 |C V/λ| |w|.
    """

    fastest: float  # largest |λ|, 1/s
    moves: Array  # from y': real and imaginary parts of slow w, z, and the same parts of fast w; (n + F, n)
    bend: Array  # as those of `bounds`, (R, n + 2 + F)
    cap: Array  # of the fast modes
    sway: Array
    jolt: Array
    swing: Array  # what fast modes add to every row beside what changes linearly in a sample, from y', (R, n)


def modal_bounds(A: Array, f: Array, C: Array, m: int, h: float) -> ModalBounds | None:
    """Bounds by modes, of m outputs and of the conditions after them; None if there are no modes.

    They serve the search alone: poor ones cost time, not digits.
    """
    (R, n), modes = C.shape, modes_of(A, h)
    if modes is None:
        return None
    root, V, W, fast, fastest = modes
    both = np.where(root.imag > 0.0, 2.0, 1.0)  # of a pair of conjugate modes
    seen = by_rows(C, V)
    seen[np.abs(seen) <= ROUNDING * by_rows(np.abs(C), np.abs(V))] = 0.0  # so that a row at rest is not looked at
    slow, size = ~fast, both * np.abs(seen) * np.exp(np.maximum(root.real, 0.0) * BLOCK * h)
    # By how much w may grow within a block, for the variation of a and for |a'|.
    push, fades = np.abs(W @ f), np.maximum(-root.real, 0.0)
    soon = fades * BLOCK * h > 1.0
    grown = np.column_stack((np.where(soon, 0.0, push), np.where(soon, push / np.maximum(fades, 1e-300), 0.0)))
    share = np.real((V * both) @ W)
    places = np.concatenate((np.flatnonzero(slow), np.flatnonzero(slow & (root.imag > 0.0))))
    count, F = len(places), 2 * int(fast.sum())
    moves, (bend, cap, sway, jolt) = np.zeros((n + F, n)), np.zeros((4, R, n + 2 + F))
    moves[:count] = np.concatenate((W[slow].real, W[slow & (root.imag > 0.0)].imag))
    moves[n:] = np.concatenate((W[fast].real, W[fast].imag))
    factors = h**2 / 8.0, h**3 / 96.0, h**4 / 384.0
    for order, (table, factor) in enumerate(zip((bend, sway, jolt), factors, strict=True), 1):
        part = factor * size * np.abs(root) ** order
        pushed = np.real(by_rows(seen[:, slow] * (both * root ** (order - 1))[slow], (W[slow] @ f)[:, None]))[:, 0]
        table[:, :count], table[:, n : n + 2] = part[:, places], by_rows(part[:, slow], grown[slow])
        table[:, n + 1] += factor * np.abs(pushed)
    left = n - count - int((both[fast]).sum())
    if left:
        last = slice(count, count + left), slice(n, n + 2)
        found, moves[last[0]] = bounds_of_rest(A, f, C, m, np.eye(n) - share, left, h)
        for table, more in zip((bend, sway, jolt[m:]), found, strict=True):
            table[:, last[0]] = more[:, :left]
            table[:, last[1]] += more[:, left:]
    if F:
        bent = size[:, fast] * np.abs(root[fast]) ** 2 * factors[1]
        cap[:, n + 2 :], sway[:, n + 2 :] = np.tile(2.0 * size[:, fast] / np.abs(root[fast]), 2), np.tile(bent, 2)
        cap[:, n : n + 2] = by_rows(2.0 * size[:, fast] / np.abs(root[fast]), grown[fast])
        sway[:, n : n + 2] += by_rows(bent, grown[fast])
        sway[:, n + 1] += by_rows(bent / np.abs(root[fast]), push[fast, None])[:, 0]
        jolt[:] = VAGUE
    swing = np.real(by_rows(seen[:, fast] * (both[fast] / root[fast]), W[fast]))
    bend, cap, sway, jolt = (np.minimum(np.nan_to_num(each, nan=VAGUE), VAGUE) for each in (bend, cap, sway, jolt[m:]))
    return ModalBounds(fastest, moves, bend, cap, sway, jolt, swing)


def modes_of(A: Array, h: float) -> tuple[Array, Array, Array, NDArray[np.bool_], float] | None:
    """The roots λ of A with Im λ >= 0, V, W, which are fast, and the largest |λ|; without ill-conditioned modes."""
    n, within = len(A), np.ones(len(A), dtype=bool)
    while (still := within & ~A[within].any(axis=0)).any():  # states on which no others depend, as the place of a base
        within &= ~still
    core, others = np.flatnonzero(within), np.flatnonzero(~within)
    roots, vectors = (np.asarray(each, dtype=complex) for each in np.linalg.eig(A[np.ix_(core, core)]))
    V, W = np.zeros((n, len(core)), dtype=complex), np.zeros((len(core), n), dtype=complex)
    try:
        V[core], W[:, core] = vectors, np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        return None
    large = np.abs(roots) > STILL * np.abs(roots).max(initial=0.0)
    for _ in others:
        V[others] = A[others] @ V / np.where(large, roots, 1.0)
    fast = np.abs(roots) * h > FAST
    good = (np.abs(W.T) * np.abs(V)).sum(axis=0) < np.where(fast, POOR, LOOSE)
    good &= (np.imag(roots) >= 0.0) & (large | (others.size == 0))
    return roots[good], V[:, good], W[good], fast[good], float(np.abs(roots).max(initial=0.0))


def bounds_of_rest(
    A: Array, f: Array, C: Array, m: int, rest: Array, count: int, h: float
) -> tuple[list[Array], Array]:
    """Bounds by what is left of y' beside the modes, rest y', of a rank `count`; and its coordinates from y'."""
    apart = np.flatnonzero((rest == np.eye(len(rest))).all(axis=1))
    Q = np.eye(len(rest))[:, apart] if len(apart) == count else np.linalg.svd(rest)[0][:, :count]
    own = (Q.T @ A @ Q)[None]
    fine = min(int(halvings_of(radius(np.abs(own) * h), 1.0)[0]), FINEST)
    found = bounds(own, (Q.T @ rest @ f)[None], by_rows(C, Q)[None], m, changes_of(own * h, fine + 1)[1:], h)
    return [each[0] for each in found], Q.T @ rest


def changes_ahead(step: Array) -> list[Array]:
    """The changes of the states after 0, 1, .. samples, from y, the accelerations at the samples, and 1."""
    S, n, _ = step.shape
    found = [np.zeros((S, n, n + AHEAD + 2))]
    for k in range(AHEAD):
        change = found[-1] + step[..., :n] @ found[-1]
        change[..., :n] += step[..., :n]
        change[..., n + k] += step[..., n]
        change[..., n + k + 1] += step[..., n + 1]
        change[..., -1] += step[..., n + 2]
        found.append(change)
    return found


def seen_ahead(rows: Array, changes: list[Array], first: int) -> Array:
    """The rows at the samples from the first on, one sample after another, from the same."""
    (S, R, _), n = rows.shape, changes[0].shape[1]
    found = np.zeros((S, up8((len(changes) - first) * R), changes[0].shape[2]))
    for k in range(first, len(changes)):
        seen = found[:, (k - first) * R : (k - first + 1) * R]
        seen[...] = by_rows(rows[..., :n], changes[k])
        seen[..., :n] += rows[..., :n]
        seen[..., n + k] += rows[..., n]
        seen[..., -1] += rows[..., n + 1]
    return found


def bounds(A: Array, f: Array, C: Array, m: int, changes: list[Array], h: float) -> tuple[Array, Array, Array]:
    """Factors of |y'|, of the variation of a and of |a'| in bounds of rows' derivatives within a block.

    They are those of h²/8 |r''| and h³/96 |r'''| of all rows and, from row m on, of h⁴/384 |r''''|. With v = y' and
    v' = A v + f a' these are r'' = C A v + C f a', r''' = C A² v + C A f a' and so on, at most |C A e^{At}| |v(0)| and
    so on; between the places of a grid of h/2 the matrices grow at most by `growth`, entry by entry. `changes` are
    those of A in h/2, h/4, .. For several inputs, whose f has a last axis more, all variations come before the slopes.
    """
    S, rows, n = C.shape
    ends = np.cumsum((rows, rows, rows - m))
    f = f.reshape(S, n, -1)
    if rows == 0:
        empty = np.zeros((S, 0, n + 2 * f.shape[2]))
        return empty, empty, empty
    once = by_rows(C, A)
    before = np.concatenate((C, once, by_rows(once[:, m:], A)), axis=1)
    most, direct = most_of(by_rows(before, A), A, changes, h), np.abs(by_rows(before, f))
    found = np.concatenate((most, by_rows(most, np.abs(f)), direct), axis=2)
    parts = np.split(found, ends[:2], axis=1)
    scaled = (part * factor for part, factor in zip(parts, (h**2 / 8.0, h**3 / 96.0, h**4 / 384.0), strict=True))
    bend, sway, jolt = (np.minimum(np.nan_to_num(part, nan=VAGUE), VAGUE) for part in scaled)
    return bend, sway, jolt


def most_of(rows: Array, A: Array, changes: list[Array], h: float) -> Array:
    """Bounds of the entries of rows · e^{At} within a block."""
    count, rows = rows.shape[1], padded(rows)
    here, most = rows, np.abs(rows)
    for _ in range(2 * BLOCK - 1):  # one place after another: a whole grid would not fit into the cache
        here = here + here @ changes[0]
        np.maximum(most, np.abs(here), out=most)
    return np.asarray(most @ growth(0.5 * h * A, changes))[:, :count]


def growth(G: Array, changes: list[Array]) -> Array:
    """Bounds of the entries of e^{Gt} for all t in [0, 1], from the changes in 1, 1/2, .. 1/2^k.

    Between the places of a grid of 1/2^k it is at most e^B with B = |G|/2^k, itself at most 1 + B + B² + ...
    """
    S, n, _ = G.shape
    grid = np.tile(np.eye(n), (S, 1, 1))
    for step in reversed(changes[1:]):
        grid = np.concatenate((grid, grid + grid @ step), axis=1)
    most, between = np.abs(grid).reshape(S, -1, n, n).max(axis=1), np.abs(G) / 2.0 ** (len(changes) - 1)
    found, turn = most.copy(), radius(between)
    near, far = np.flatnonzero(turn <= 0.5), np.flatnonzero(~(turn <= 0.5))
    if near.size:
        found[near] = most[near] @ np.linalg.inv(np.eye(n) - between[near])
    for each in far:
        found[each] += most[each] @ changes_of(between[None, each], int(halvings_of(turn[each], 1.0)) + 1)[0][0]
    return found


def halvings_of(turn: Any, longest: float) -> Any:
    """How often a step must be halved so that no mode turns by more than `longest`, in rad."""
    return np.maximum(0, np.ceil(np.log2(np.clip(turn / longest, 1e-300, 1e300)))).astype(int)


def radius(A: Array) -> Array:
    """A close upper estimate of the spectral radius of each matrix."""
    power = A
    for _ in range(4):
        power = power @ power
    return np.asarray(np.sqrt((power * power).sum(axis=(1, 2))) ** (1.0 / 16.0))


def changes_of(G: Array, halvings: int) -> list[Array]:
    """exp(G/2^k) - 1 for k = 0, 1, .., by the Taylor series of the last one, and squaring.

    Without the 1 its rounding is relative to the change of a step, so that many steps do not add up the same error, and
    squaring costs slow modes no digits beside fast ones.
    """
    X = G / 2.0**halvings
    total = term = X
    for k in range(2, 60):
        term = term @ X / k
        ends = (np.abs(term) <= SMALL * np.abs(total)).all(axis=(1, 2))
        term[ends] = 0.0  # so that no number of terms depends on the other matrices
        total = total + term
        if ends.all():
            break
    found = [total]
    for _ in range(halvings):
        found.append(2.0 * found[-1] + found[-1] @ found[-1])
    return found[::-1]


def grouped(tables: Array, most: int) -> Array:
    """The tables column after column, in groups of at most so many rows, of nearly the same size."""
    count, rows, _ = tables.shape
    groups = -(-rows // most)
    if groups == 0:
        return np.zeros((count, 0))
    bounds = [rows // 8 * g // groups * 8 for g in range(groups + 1)]
    parts = [tables[:, a:b].transpose(0, 2, 1).reshape(count, -1) for a, b in pairwise(bounds)]
    return np.concatenate(parts, axis=1)


def jump_table(jump: Array, most: int) -> Array:
    """A matrix J and |J|, one after the other, in groups of rows."""
    return np.concatenate([grouped(padded(each), most) for each in (jump, np.abs(jump))], axis=1)


def padded(table: NDArray[Any]) -> NDArray[Any]:
    """The tables with zeros below, to a multiple of 8 rows."""
    *stack, rows, columns = table.shape
    full = np.zeros((*stack, up8(rows), columns), table.dtype)
    full[..., :rows, :] = table
    return full


def by_rows(rows: NDArray[Any], matrix: NDArray[Any]) -> NDArray[Any]:
    """The product of rows and a matrix, in which no row depends on how many there are.

    BLAS takes some rows at a time, and sums those that are left over in another order.
    """
    return np.asarray(padded(rows) @ matrix)[..., : rows.shape[-2], :]
