"""The tables of a phase for blocks of samples: what coordinates and jumps of the slope mean for the rows later on.

Between events the rows at all samples of a block are one product of a matrix with the coordinates at its start, and one
with the jumps of the acceleration's slope. One bound of the curvature holds for the whole block, because the
coordinates grow at most exponentially.
"""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import Entry, kernel, python_kernel
from rockflex._vectors import BLOCK
from rockflex.solve.exact.entries import Tables, tables_of
from rockflex.solve.layout import SAG, VALUES, ZERO, System

WHOLE = ZERO  # the level of a whole sample
MOST_GROWTH = 20.0  # e-folds of a pair within a block; beyond it, a block is shorter


def put_powers(system: System, p: int) -> None:
    """Enter the tables of a phase for blocks of samples, from its other tables."""
    if system.phases[p]["dense"]:
        step = system.propagator[p, WHOLE]
        _coupled(tables_of(system), p, step, np.zeros((2, *step.shape)))
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
        for f in range(tables.rows.shape[2]):
            tables.leeway[p, f, k] = tables.bounds[p, SAG, WHOLE, f, k] * growth
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
    for f in range(tables.rows.shape[2]):
        ahead, kicked, row = tables.ahead[p, f], tables.kicked[p, f], tables.rows[p, VALUES, f]
        for m in range(length):
            kicked[BLOCK + m] = 0.0
        for k in range(pairs):
            a, b = tables.blocks[p, WHOLE, 0, k], tables.blocks[p, WHOLE, 1, k]
            c, d = tables.blocks[p, WHOLE, 2, k], tables.blocks[p, WHOLE, 3, k]
            x, y = row[k], row[pairs + k]
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
    for f in range(tables.rows.shape[2]):
        stray = 0.0
        for k in range(pairs):
            x, y = tables.forced[p, 1, k], tables.forced[p, 1, pairs + k]
            stray += tables.leeway[p, f, k] * math.sqrt(x * x + y * y)
        tables.stray[p, f] = stray


@python_kernel
def put_coupled_powers(tables: Tables, p: int, step: Array, work: Array) -> None:
    """Enter the same tables of a phase that cannot be uncoupled; `step` (S, S) is its propagator over a sample.

    `work` has shape (2, S, S). The coordinates at the end of a block are computed sample by sample.
    """
    size = step.shape[0]
    tables.phases[p].block = BLOCK
    for f in range(tables.rows.shape[2]):
        for m in range(BLOCK):
            kick = 0.0
            for k in range(size):
                value = 0.0
                for i in range(size):
                    before = tables.rows[p, VALUES, f, i] if m == 0 else tables.ahead[p, f, i, m - 1]
                    value += before * step[i, k]
                tables.ahead[p, f, k, m] = value
                kick -= value * tables.forced[p, 1, k]
            tables.kicked[p, f, BLOCK + m] = kick
    enter_coupled_leeway(tables, p, step, work)
    enter_stray(tables, p)


@kernel
def enter_coupled_leeway(tables: Tables, p: int, step: Array, work: Array) -> None:
    """Enter bounds of the deviation from the chords, from what the norms of the pairs may come to within the block."""
    pairs, size, power, next_power = step.shape[0] // 2, step.shape[0], work[0], work[1]
    for i in range(size):
        for j in range(size):
            power[i, j] = 1.0 if i == j else 0.0
    for _ in range(BLOCK):
        for f in range(tables.rows.shape[2]):
            for k in range(pairs):
                bound = 0.0
                for j in range(pairs):
                    bound += tables.bounds[p, SAG, WHOLE, f, j] * block_norm(power, j, k)
                tables.leeway[p, f, k] = max(tables.leeway[p, f, k], bound)
        for i in range(size):
            for j in range(size):
                next_power[i, j] = 0.0
                for m in range(size):
                    next_power[i, j] += power[i, m] * step[m, j]
        power, next_power = next_power, power


@kernel
def block_norm(matrix: Array, i: int, j: int) -> float:
    """Return the Frobenius norm of what pair j contributes to pair i."""
    pairs = matrix.shape[0] // 2
    squares = matrix[i, j] ** 2 + matrix[i, pairs + j] ** 2
    return math.sqrt(squares + matrix[pairs + i, j] ** 2 + matrix[pairs + i, pairs + j] ** 2)


_uncoupled, _coupled = Entry(put_uncoupled_powers), Entry(put_coupled_powers)  # their argument types never differ
