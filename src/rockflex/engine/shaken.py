"""What a phase has under vertical acceleration, for a stack of systems at once.

Only some states are multiplied by a_v, most often one. In a sample p = a_v y of each of them is an input like a, the
polynomial through its values at Gauss nodes. These are a fixed point, p = a_v (y without p + what p adds), which is
found in a few turns. What the polynomial leaves out is orthogonal to those of lower degree, so that the change of the
state is far more exact than the polynomial. The tables know up to which |a_v| that is rounding; samples with more, and
phases with fast modes, are left to power series.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from rockflex.engine.system import LinearPhase, NonlinearPhase, up8
from rockflex.engine.tables import (
    VAGUE,
    by_rows,
    halvings_of,
    padded,
    shift_of,
    spectral_radius_bound,
    steps_of,
)
from rockflex.foundation.arrays import Array, Bools

MAX_FED = 4  # as in march.h
NODES = 8, 16  # of the polynomials: the second number where the first is not exact
FINE = 24  # nodes for the integrals themselves
TERMS = 40  # of power series over a part of a step in which no mode turns by more than `LONGEST`
LONGEST = 2.5
MARCHED = 12.0  # rad that a mode turns within a step, up to which the nodes may be exact, and bounds of use
USUAL = 30.0  # a vertical acceleration for which the first number of nodes must do, in the user's unit: as in m/s²
EXACT = 1e-14  # of what p adds in a sample, or of the change of the state: an error that is rounding
CONTRACTS = 0.05  # by how much each turn of the fixed point must contract at least


class ShakenTables(NamedTuple):
    """Fields as in `march.h`, each with a first axis for the systems."""

    places: list[int]
    shift: int
    nodes: int
    now: Array
    outs: Array
    magnitude: Array
    most: Array
    limit: Array
    times: Array
    known: Array
    given: Array
    feedback: Array
    rows: Array
    speeds: Array
    slope: Array
    direct: Array
    moves: Array
    bend: Array
    sway: Array
    jolt: Array
    loop: Array
    swell1: Array
    swell2: Array
    swell3: Array
    swell4: Array


BOUNDS = ShakenTables._fields[ShakenTables._fields.index("moves") :]


class Terms(NamedTuple):
    """What a phase is summed from, its outputs and conditions in one; without the columns that a_v leaves alone."""

    places: list[int]  # of the P states that a_v multiplies
    rates: Array  # (S, n, n + 3 + P): columns y, a, 1, a_v, and a_v times those states
    rows: Array  # (S, R, n + 3 + P)


def terms_of(phase: LinearPhase | NonlinearPhase) -> Terms | None:
    """The terms of a phase; None if the vertical acceleration does not act in its rows, or in linear rates."""
    (S, m, n), k = phase.C.shape, len(phase.events)
    A_v, f_v = (phase.A_v, phase.f_v) if isinstance(phase, LinearPhase) else (None, None)
    rates, rows = np.zeros((S, n, n + 3)), np.zeros((S, m + k, n + 3))
    if isinstance(phase, LinearPhase):
        rates[..., :n], rates[..., n], rates[..., n + 1] = phase.A, phase.f, phase.c
    rows[:, :m, :n], rows[:, :m, n], rows[:, :m, n + 1] = phase.C, phase.d, phase.e
    fed = np.zeros((S, n + m + k, n))
    for given, place in ((A_v, slice(n)), (phase.C_v, slice(n, n + m))):
        if given is not None:
            fed[:, place] = given
    for given, found in ((f_v, rates), (phase.d_v, rows[:, :m])):
        if given is not None:
            found[..., n + 2] = given
    for j, event in enumerate(phase.events):
        rows[:, m + j] = np.column_stack((event.row, event.direct, event.constant, event.direct_v))
        if event.row_v is not None:
            fed[:, n + m + j] = event.row_v
    places = np.flatnonzero(fed.any(axis=(0, 1))).tolist()
    if not (places or rates[..., n + 2].any() or rows[..., n + 2].any()):
        return None
    more = fed[..., places]
    return Terms(places, np.concatenate((rates, more[:, :n]), axis=2), np.concatenate((rows, more[:, n:]), axis=2))


Bounds = Callable[[Array, Array, Array, int, float], tuple[Array, Array]]


def shaken_of(phase: LinearPhase | NonlinearPhase, h: float, bounds: Bounds) -> ShakenTables | None:
    """Compute what a stack of phases has for steps of h; None if the vertical acceleration does not act in them.

    The function finds `bounds`, as in `loops`.
    """
    terms = terms_of(phase)
    if terms is None:
        return None
    if isinstance(phase, NonlinearPhase):
        return shaken_rows(phase, terms)
    m, (S, n, columns), fed = phase.d.shape[1], terms.rates.shape, len(terms.places)
    shift, rates, rows = shift_of(terms.rates), terms.rates, terms.rows
    now, outs = padded(np.concatenate((rates[:, shift:], rows[:, m:]), axis=1)), padded(rows[:, :m])
    C, speeds = rows[..., :n], rates[:, terms.places]
    fast, marches = spectral_radius_bound(phase.A * h), fed <= MAX_FED
    pieces = np.where((fast <= MARCHED) & marches, 2 ** np.clip(halvings_of(fast, LONGEST), 0, 30), 0)
    turns = halvings_of(fast, 1.0)
    step = np.concatenate([steps_of(rates[k : k + 1, :, : n + 2], h, int(turns[k])) for k in range(S)])
    found = marched_of(terms, h, step, pieces)
    found |= (
        shaken_bound_factors(phase.A, terms, h, m, bounds) if marches else dict.fromkeys(BOUNDS, np.zeros((S, 0, 1)))
    )
    slope = np.concatenate((by_rows(C, rates), np.zeros((S, rows.shape[1], fed))), axis=2)
    slope[..., columns:] = rows[..., n + 3 :]
    return ShakenTables(
        places=terms.places,
        shift=shift,
        nodes=found["times"].shape[1],
        now=now,
        outs=outs,
        magnitude=np.abs(now),
        most=np.abs(outs),
        rows=padded(rows),
        speeds=padded(speeds),
        slope=padded(slope),
        direct=padded(rows[..., n + 2, None]),
        **{name: padded(each) for name, each in found.items()},
    )


def shaken_rows(phase: NonlinearPhase, terms: Terms) -> ShakenTables:
    """What a phase that is not linear has: the terms of its outputs and conditions."""
    m, n = phase.d.shape[1], phase.C.shape[2]
    now, outs = padded(terms.rows[:, m:]), padded(terms.rows[:, :m])
    known = {"now": now, "outs": outs, "magnitude": np.abs(now), "most": np.abs(outs)}
    empty = dict.fromkeys(set(ShakenTables._fields[3:]) - set(known), np.zeros((1, 0, 1)))
    return ShakenTables(places=terms.places, shift=n, nodes=NODES[0], **known, **empty)


@lru_cache
def gauss(count: int) -> tuple[Array, Array]:
    """Nodes and weights for integrals from 0 to 1."""
    places, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 + 0.5 * places, 0.5 * weights


def lagrange_polynomials(count: int, times: Array) -> Array:
    """The polynomials that are 1 at one of so many Gauss nodes and 0 at the others, at these times: (count, times)."""
    nodes, weights = gauss(count)
    degrees = np.arange(count)
    at_nodes, here = (np.polynomial.legendre.legvander(2.0 * t - 1.0, count - 1) for t in (nodes, times))
    return np.asarray(weights[:, None] * (at_nodes * (2 * degrees + 1)) @ here.T)


@lru_cache
def convolutions(count: int) -> Array:
    """The integrals of l(t_j - s) k(s) from 0 to the node t_j, for two such polynomials: shape (l, j, k)."""
    nodes, weights = gauss(count)
    found = np.zeros((count, count, count))
    for j, t in enumerate(nodes):
        there = lagrange_polynomials(count, t * nodes)
        found[:, j] = (lagrange_polynomials(count, t * (1.0 - nodes)) * (t * weights)) @ there.T
    return found


def matrix_exponential_times(G: Array, X: Array, times: Array, pieces: int) -> Array:
    """e^{G t} X at these times from 0 to 1, in ascending order: shape (S, times, n, columns)."""
    (S, n, k), found, start = X.shape, list[Array](), X
    for piece in range(pieces):
        terms = [start]
        for order in range(1, TERMS):
            terms.append(G @ terms[-1] / (order * pieces))
        series = np.stack(terms, axis=1).reshape(S, TERMS, n * k)
        here = times[(times * pieces >= piece) & (times * pieces < piece + 1)] * pieces - piece
        there = np.append(here, 1.0)[:, None] ** np.arange(TERMS) @ series
        found.append(there[:, :-1])
        start = there[:, -1].reshape(S, n, k)
    return np.concatenate(found, axis=1).reshape(S, times.size, n, k)


def marched_of(terms: Terms, h: float, step: Array, pieces: Array) -> dict[str, Array]:
    """What a sample needs, for the systems that have a number of pieces; the others have the limit 0."""
    (S, n, _), fed, rows = terms.rates.shape, len(terms.places), list[tuple[int, int, dict[str, Array]]]()
    for count in {*pieces[pieces > 0].tolist()}:
        some = np.flatnonzero(pieces == count)
        flow = flow_of(terms.rates[some], terms.places, h, count)
        for q in NODES:
            tables = collocation_tables(flow, q, step[some])
            done = (tables["limit"][:, 0, 0] >= USUAL) | (q == NODES[-1])
            for k in np.flatnonzero(done).tolist():
                rows.append((int(some[k]), q, {name: each[k] for name, each in tables.items()}))
            some, flow = some[~done], flow.of(~done)
            if not some.size:
                break
    width, wide, fed = max((q for _, q, _ in rows), default=NODES[0]), up8(n), fed if rows else 0
    found = {
        "limit": np.zeros((S, 1, 1)),
        "times": np.zeros((S, width, 1)),
        "known": np.zeros((S, wide + fed * width, n + 5)),
        "given": np.zeros((S, n, fed * width)),
        "feedback": np.zeros((S, fed * width, fed * width)),
    }
    for place, q, each in rows:
        nodes = (np.arange(fed)[:, None] * width + np.arange(q)).ravel()
        found["limit"][place], found["times"][place, :q] = each["limit"], each["times"]
        found["known"][place, :n], found["known"][place, wide + nodes] = each["changes"], each["nodes"]
        found["given"][place][:, nodes] = each["given"]
        found["feedback"][place][np.ix_(nodes, nodes)] = each["feedback"]
    return found


class Flow(NamedTuple):
    """The motion within a sample, at finely spaced nodes and at those of the polynomials."""

    ends: Array  # e^{A (1 - t)} times the columns of A_v and f_v, at the fine nodes: (S, FINE, n, P + 1)
    seen: dict[int, Array]  # the states that a_v multiplies, from y, a0, a1, 1, a_v0 and a_v1: (S, nodes, P, n + 5)
    kernels: dict[int, Array]  # what they get from p of an instant: (S, nodes, P, P)

    def of(self, some: Bools) -> "Flow":
        """That of some systems."""
        seen, kernels = ({q: each[some] for q, each in part.items()} for part in (self.seen, self.kernels))
        return Flow(self.ends[some], seen, kernels)


def flow_of(rates: Array, places: list[int], h: float, pieces: int) -> Flow:
    """Carry the columns of p forwards, and the rows of the states that it is made of backwards."""
    (S, n, columns), counts = rates.shape, (*NODES, FINE)
    pushes = np.concatenate((rates[..., n + 3 :], rates[..., n + 2, None]), axis=2) * h
    ends = matrix_exponential_times(rates[..., :n] * h, pushes, gauss(FINE)[0], pieces)[:, ::-1]
    G = np.zeros((S, n + 5, n + 5))  # of y, a, its rise, 1, a_v and its rise
    G[:, :n, :n], G[:, :n, n], G[:, n, n + 1] = rates[..., :n] * h, rates[..., n] * h, 1.0
    G[:, :n, n + 2], G[:, :n, n + 3], G[:, n + 3, n + 4] = rates[..., n + 1] * h, rates[..., n + 2] * h, 1.0
    rows = np.zeros((S, n + 5, columns - n - 3))
    rows[:, places, range(len(places))] = 1.0
    times = np.concatenate([gauss(count)[0] for count in counts])
    order = np.argsort(times, kind="stable")
    found = np.empty((S, times.size, len(places), n + 5))
    found[:, order] = matrix_exponential_times(G.swapaxes(1, 2), rows, times[order], pieces).swapaxes(2, 3)
    known = found.copy()
    known[..., n], known[..., n + 1] = found[..., n] - found[..., n + 1], found[..., n + 1]
    known[..., n + 3], known[..., n + 4] = found[..., n + 3] - found[..., n + 4], found[..., n + 4]
    bounds_ = np.cumsum((0, *counts))
    parts = {q: slice(a, b) for q, a, b in zip(counts, bounds_[:-1], bounds_[1:], strict=True)}
    seen = {q: known[:, part] for q, part in parts.items()}
    return Flow(ends, seen, {q: each[..., :n] @ pushes[:, None, :, :-1] for q, each in seen.items()})


def collocation_tables(flow: Flow, q: int, step: Array) -> dict[str, Array]:
    """The tables for so many nodes, and the largest |a_v| for which they are exact."""
    S, _, n, fed = flow.ends.shape[0], *flow.ends.shape[1:3], flow.ends.shape[3] - 1
    times, fine, weights = gauss(q)[0], *gauss(FINE)
    seen = lagrange_polynomials(q, fine) * weights
    given = np.zeros((S, fed, q, n))
    for i in range(fed):
        given[:, i] = seen @ flow.ends[..., i]
    rise = np.stack([flow.ends[..., -1].swapaxes(1, 2) @ (weights * t) for t in (1.0 - fine, fine)], axis=2)
    integrals = convolutions(q)
    feedback = np.zeros((S, fed, q, fed, q))
    for kernel, integral in zip(flow.kernels[q].swapaxes(0, 1), integrals, strict=True):
        feedback += kernel[:, :, None, :, None] * integral[:, None, :]
    changes = np.concatenate((step, rise), axis=2)
    return {
        "limit": vertical_acceleration_limit(flow, q, given, feedback, step)[:, None, None],
        "times": np.tile(times[:, None], (S, 1, 1)),
        "changes": changes,
        "nodes": flow.seen[q].swapaxes(1, 2).reshape(S, fed * q, n + 5),
        "given": given.reshape(S, fed * q, n).swapaxes(1, 2),
        "feedback": feedback.reshape(S, fed * q, fed * q),
    }


def vertical_acceleration_limit(flow: Flow, q: int, given: Array, feedback: Array, step: Array) -> Array:
    """The largest |a_v| for which what the polynomials leave out is rounding, and the fixed point is found fast."""
    (S, fed, _, n), (fine, weights), size = given.shape, gauss(FINE), np.abs(step)
    size = size + size[..., :n] @ size  # of what the state changes by: an entry that is zero has others on its way
    found = CONTRACTS / np.maximum(spectral_radius_bound(np.abs(feedback.reshape(S, fed * q, fed * q))), 1e-300)
    for i in range(fed):
        for slope in (0.0, 1.0):
            factor, factors = (2.0 * t - 1.0 if slope else np.ones_like(t) for t in (fine, gauss(q)[0]))
            ends, start = flow.ends[..., i].swapaxes(1, 2), flow.seen[FINE][:, :, i, : n + 3]
            exact, most = (
                ends @ ((weights * factor)[:, None] * start),
                np.abs(ends) @ (weights[:, None] * np.abs(start)),
            )
            rough = given[:, i].swapaxes(1, 2) @ (factors[:, None] * flow.seen[q][:, :, i, : n + 3])
            wrong = np.maximum(np.abs(exact - rough) - EXACT * most, 0.0)
            ratio = EXACT * size / np.maximum(wrong, 1e-300)
            found = np.minimum(found, np.where(wrong > 0.0, ratio, np.inf).min(axis=(1, 2)))
    return np.minimum(np.nan_to_num(found, nan=0.0), VAGUE)


def shaken_bound_factors(A: Array, terms: Terms, h: float, m: int, bounds: Bounds) -> dict[str, Array]:
    """Factors in bounds of the rows and of the states that a_v multiplies.

    With a_v and each p as more inputs, they are those of `prepare.h`. But p is not linear in a sample: r'' has the term
    C_v p'', r''' those C A_v p'' + C_v p''', and r'''' those C A A_v p'' + C A_v p''' + C_v p''''.
    """
    (S, n, _), R, fed = terms.rates.shape, terms.rows.shape[1], len(terms.places)
    unit, more, direct = np.zeros((S, fed, n)), terms.rates[..., n + 3 :], np.zeros((S, R + fed, fed))
    unit[:, range(fed), terms.places], direct[:, :R] = 1.0, terms.rows[..., n + 3 :]
    C = np.concatenate((terms.rows[..., :n], unit), axis=1)
    moves, found = bounds(A, terms.rates, C, m, h)
    inputs, count = 4 + 2 * fed, R + fed
    seen = np.zeros((S, found.shape[1], 3, fed))  # of p'', p''' and p''''
    seen[:, :count, 0] = h**2 / 8.0 * np.abs(direct)
    once, twice = (np.abs(by_rows(rows, more)) for rows in (C, by_rows(C, A)))
    seen[:, count : 2 * count, 0], seen[:, count : 2 * count, 1] = h**3 / 96.0 * once, h**3 / 96.0 * np.abs(direct)
    for k, part in enumerate((twice, once, np.abs(direct))):
        seen[:, 2 * count : 3 * count - m, k] = h**4 / 384.0 * part[:, m:]
    loop = found[:, 3 * count - m :, 4:inputs:2]
    rows = seen.reshape(S, found.shape[1], 3 * fed)
    found = np.concatenate((found[..., :inputs], rows, found[..., inputs:]), axis=2)
    bend, sway, jolt, first = np.split(found, (count, 2 * count, 3 * count - m), axis=1)
    swells = first, bend[:, R:] * (8.0 / h**2), sway[:, R:] * (96.0 / h**3), jolt[:, R - m :] * (384.0 / h**4)
    known = {"moves": moves, "bend": bend[:, :R], "sway": sway[:, :R], "jolt": jolt[:, : R - m], "loop": loop}
    return known | {f"swell{order}": each for order, each in enumerate(swells, 1)}
