"""The tables of a phase for blocks of samples: what coordinates and jumps of the slope mean for the rows later on.

Between events the rows at all samples of a block are one product of a matrix with the coordinates at its start, and one
with the jumps of the acceleration's slope. One bound of the curvature holds for the whole block, because the
coordinates grow at most exponentially.
"""

import math

import numpy as np

from rockflex._kernel import Entry, kernel, python_kernel
from rockflex._vectors import BLOCK
from rockflex.solve.exact.entries import Tables, tables_of
from rockflex.solve.layout import SAG, VALUES, ZERO, System

WHOLE = ZERO  # the level of a whole sample
MOST_GROWTH = 20.0  # e-folds of a pair within a block; beyond it, a block is shorter


def put_powers(system: System, p: int) -> None:
    """Enter the tables of a phase for blocks of samples, from its other tables."""
    if system.phases[p]["dense"]:
        put_coupled_powers(system, p)
    else:
        _uncoupled(tables_of(system), p)


@python_kernel
def put_uncoupled_powers(tables: Tables, p: int) -> None:
    """Enter the tables of an uncoupled phase."""
    enter_powers(tables, p)


@kernel
def enter_powers(tables: Tables, p: int) -> None:
    """Enter the tables of an uncoupled phase, in other kernels."""
    fastest = 0.0
    for k in range(tables.blocks.shape[3]):
        fastest = max(fastest, math.log(growth_of(tables, p, k)))
    length = BLOCK if fastest * BLOCK <= MOST_GROWTH else max(int(MOST_GROWTH / fastest), 1)
    tables.phases[p].block = length
    enter_rows_ahead(tables, p, length)
    enter_leap(tables, p, length)
    for k in range(tables.blocks.shape[3]):
        growth = growth_of(tables, p, k) ** (length - 1)
        for f in range(tables.stray.shape[1]):
            tables.leeway[p, k, f] = tables.bounds[p, SAG, WHOLE, k, f] * growth
    enter_stray(tables, p)


@kernel
def growth_of(tables: Tables, p: int, k: int) -> float:
    """Return the largest factor, at least one, by which the norm of a pair grows in a sample."""
    step = tables.blocks[p, WHOLE, :, k]
    squares = 0.5 * (step[0] * step[0] + step[1] * step[1] + step[2] * step[2] + step[3] * step[3])
    volume = step[0] * step[3] - step[1] * step[2]
    largest = squares + math.sqrt(max(squares * squares - volume * volume, 0.0))
    return math.sqrt(max(largest, 1.0))


@kernel
def enter_rows_ahead(tables: Tables, p: int, length: int) -> None:
    """Enter the rows at later samples over the present coordinates, and over a present jump of the slope."""
    pairs = tables.blocks.shape[3]
    for f in range(tables.stray.shape[1]):
        ahead, kicked, rows = tables.ahead[p, f], tables.kicked[p, f], tables.rows[p, VALUES]
        for m in range(length):
            kicked[BLOCK + m] = 0.0
        for k in range(pairs):
            a, b = tables.blocks[p, WHOLE, 0, k], tables.blocks[p, WHOLE, 1, k]
            c, d = tables.blocks[p, WHOLE, 2, k], tables.blocks[p, WHOLE, 3, k]
            x, y = rows[k, f], rows[pairs + k, f]
            forced, forced_rate = tables.forced[p, 1, k], tables.forced[p, 1, pairs + k]
            for m in range(length):
                x, y = x * a + y * c, x * b + y * d
                ahead[k, m], ahead[pairs + k, m] = x, y
                kicked[BLOCK + m] -= x * forced + y * forced_rate


@kernel
def enter_leap(tables: Tables, p: int, length: int) -> None:
    """Enter what a block makes of its first coordinates, and of the jumps of the slope before each of its samples."""
    pairs = tables.blocks.shape[3]
    for k in range(pairs):
        step, leap = tables.blocks[p, WHOLE, :, k], tables.leap[p, :, k]
        leap[0] = leap[3] = 1.0
        leap[1] = leap[2] = 0.0
        x, y = -tables.forced[p, 1, k], -tables.forced[p, 1, pairs + k]
        for m in range(length):
            x, y = step[0] * x + step[1] * y, step[2] * x + step[3] * y
            tables.pushed[p, length - 1 - m, k] = x
            tables.pushed[p, length - 1 - m, pairs + k] = y
            one, two = leap[0], leap[1]
            leap[0], leap[2] = step[0] * one + step[1] * leap[2], step[2] * one + step[3] * leap[2]
            leap[1], leap[3] = step[0] * two + step[1] * leap[3], step[2] * two + step[3] * leap[3]


@kernel
def enter_stray(tables: Tables, p: int) -> None:
    """Enter what jumps of the slope within a block add to the deviation of the rows from their chords."""
    pairs = tables.blocks.shape[3]
    for f in range(tables.stray.shape[1]):
        stray = 0.0
        for k in range(pairs):
            x, y = tables.forced[p, 1, k], tables.forced[p, 1, pairs + k]
            stray += tables.leeway[p, k, f] * math.sqrt(x * x + y * y)
        tables.stray[p, f] = stray


def put_coupled_powers(system: System, p: int) -> None:
    """Enter the same tables of a phase that cannot be uncoupled: w at the end of a block is computed step by step."""
    step, slopes, count = system.propagator[p, WHOLE], system.forced[p, 1], system.stray.shape[1]
    rows, leeway = system.rows[p, VALUES, :, :count].T, system.leeway[p, :, :count]
    pairs, sag, power = step.shape[0] // 2, system.bounds[p, SAG, WHOLE, :, :count], np.eye(step.shape[0])
    system.phases[p]["block"] = BLOCK
    for m in range(BLOCK):
        # The norms of the pairs are bounded by those of the blocks of the power.
        norms = np.sqrt((power.reshape(2, pairs, 2, pairs) ** 2).sum(axis=(0, 2)))
        leeway[...] = np.maximum(leeway, norms.T @ sag)
        power = step @ power
        system.ahead[p, :, :, m] = rows @ power
        system.kicked[p, :, BLOCK + m] = -system.ahead[p, :, :, m] @ slopes
    system.stray[p] = np.hypot(slopes[:pairs], slopes[pairs:]) @ leeway


_uncoupled = Entry(put_uncoupled_powers)  # its argument types never differ
