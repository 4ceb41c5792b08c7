"""The matrices of a phase for one time step, in the order in which the march reads them."""

import math
from typing import Any, NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex.engine.system import LinearPhase, up8

ROWS, BLOCK = 32, 8  # as in march.h
LONGEST = 2.5  # rad that a mode may turn within one power series: some thirty terms, and a digit lost
SMALL = 1e-18  # of a sum: terms that no longer change it
FINEST = 8  # halvings of h/2 between which bounds allow for the growth of motion, at most
VAGUE = 1e100  # a bound that is as good as none, and does not overflow


class Tables(NamedTuple):
    """Fields as in `March`; the flat ones packed."""

    n: int
    outputs: int
    conditions: int
    halvings: int  # of the step, so that its power series converge
    step: Array
    now: Array
    slope: Array
    bend: Array
    sway: Array
    magnitude: Array


@np.errstate(over="ignore", invalid="ignore")
def tables_of(phase: LinearPhase, h: float) -> Tables:
    """Compute the tables of a phase for steps of h."""
    A, n, m, k = phase.A, len(phase.f), len(phase.d), len(phase.events)
    outputs, conditions = up8(max(1, m)), up8(k)
    rates = np.column_stack((A, phase.f, phase.c))
    rows = np.zeros((outputs + conditions, n + 2))
    rows[:m] = np.column_stack((phase.C, phase.d, phase.e))
    rows[outputs + k :, -1] = 1.0  # conditions that are none
    for row, event in zip(rows[outputs:], phase.events, strict=False):
        row[:n], row[n], row[n + 1] = event.row, event.direct, event.constant
    C = rows[:, :n]

    turn, fine = radius(A * h), min(halvings_of(radius(np.abs(A) * h), 1.0), FINEST)
    halvings = halvings_of(turn, LONGEST)
    G = np.zeros((n + 3, n + 3))  # of y, a, its rise, and 1
    G[:n, :n], G[:n, n], G[:n, n + 2], G[n, n + 1] = A * h, phase.f * h, phase.c * h, 1.0
    changes = changes_of(G, max(halvings_of(turn, 1.0), fine) + 1)
    whole = changes[0]
    after = np.column_stack((whole[:n, :n], whole[:n, n] - whole[:n, n + 1], whole[:n, n + 1], whole[:n, n + 2]))
    seen = C @ after
    seen[:, :n] += C
    seen[:, n + 1] += rows[:, n]
    seen[:, n + 2] += rows[:, n + 1]

    now = np.concatenate((padded(rates), rows))
    bend, sway = bounds(A, phase.f, C, [each[:n, :n] for each in changes[1 : fine + 2]], h)
    step = np.concatenate((padded(after), seen))
    flat = (packed(each) for each in (step, now, C @ rates, bend, sway, np.abs(now)))
    return Tables(n, outputs, conditions, halvings, *flat)


def bounds(A: Array, f: Array, C: Array, changes: list[Array], h: float) -> tuple[Array, Array]:
    """Factors of |y'|, of the variation of a and of |a'| in bounds of h²/8 |r''| and h³/96 |r'''| within a block.

    r'' = C A v + C f a' and r''' = C A² v + C A f a' with v = y' and v' = A v + f a'. So they are at most |C A e^{At}|
    |v(0)| and so on; between the places of a grid of h/2 the matrices grow at most by `growth`, entry by entry.
    `changes` are those of A in h/2, h/4, ..
    """
    rows, n = C.shape
    grid, step = np.concatenate((C @ A, C @ A @ A)), changes[0]
    direct = np.abs(np.concatenate((C, C @ A)) @ f)
    for _ in range(int(math.log2(2 * BLOCK))):
        grid, step = np.concatenate((grid, grid + grid @ step)), 2.0 * step + step @ step
    most = np.abs(grid).reshape(-1, 2 * rows, n).max(axis=0) @ growth(0.5 * h * A, changes)
    found = np.column_stack((most, most @ np.abs(f), direct))
    found[:rows] *= h**2 / 8.0
    found[rows:] *= h**3 / 96.0
    found = np.minimum(np.nan_to_num(found, nan=VAGUE), VAGUE)
    return found[:rows], found[rows:]


def growth(G: Array, changes: list[Array]) -> Array:
    """Bounds of the entries of e^{Gt} for all t in [0, 1], from the changes in 1, 1/2, .. 1/2^k.

    Between the places of a grid of 1/2^k it is at most e^B with B = |G|/2^k, itself at most 1 + B + B² + ...
    """
    grid = np.eye(len(G))[None]
    for step in reversed(changes[1:]):
        grid = np.concatenate((grid, grid + grid @ step))
    most, between = np.abs(grid).max(axis=0), np.abs(G) / 2.0 ** (len(changes) - 1)
    turn = radius(between)
    if turn <= 0.5:
        return most @ np.linalg.inv(np.eye(len(G)) - between)
    return most + most @ changes_of(between, halvings_of(turn, 1.0) + 1)[0]


def halvings_of(turn: float, longest: float) -> int:
    """How often a step must be halved so that no mode turns by more than `longest`, in rad."""
    return max(0, math.ceil(math.log2(min(max(turn / longest, 1e-300), 1e300))))


def radius(A: Array) -> float:
    """A close upper estimate of the spectral radius."""
    power = A
    for _ in range(4):
        power = power @ power
    return float(np.linalg.norm(power)) ** (1.0 / 16.0)


def changes_of(G: Array, halvings: int) -> list[Array]:
    """exp(G/2^k) - 1 for k = 0, 1, .., by the Taylor series of the last one, and squaring.

    Without the 1 its rounding is relative to the change of a step, so that many steps do not add up the same error, and
    squaring costs slow modes no digits beside fast ones.
    """
    X = G / 2.0**halvings
    total = term = X
    for k in range(2, 60):
        term = term @ X / k
        total = total + term
        if (np.abs(term) <= SMALL * np.abs(total)).all():
            break
    found = [total]
    for _ in range(halvings):
        found.append(2.0 * found[-1] + found[-1] @ found[-1])
    return found[::-1]


def padded(table: Array) -> Array:
    """The table with zeros below, to a multiple of 8 rows."""
    full = np.zeros((up8(len(table)), *table.shape[1:]))
    full[: len(table)] = table
    return full


def packed(table: Array) -> Array:
    """Column after column, in groups of 32 rows or, at the end, fewer."""
    return aligned(np.concatenate([table[g : g + ROWS].T.ravel() for g in range(0, len(table), ROWS)]))


def aligned(values: Any) -> Array:
    """A copy that begins where a cache line does."""
    room = np.empty(values.size + 8)
    first = -(room.ctypes.data // 8) % 8
    room[first : first + values.size] = values
    return room[first : first + values.size]
