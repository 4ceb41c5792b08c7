"""The tables of a phase for blocks of samples: what coordinates and jumps of the slope mean for the rows later on.

Between events the rows at all samples of a block are one product of a matrix with the coordinates at its start, and one
with the jumps of the acceleration's slope. One bound of the curvature holds for the whole block, because the
coordinates grow at most exponentially.
"""

import math

from rockflex._arrays import Array
from rockflex._kernel import kernel, python_kernel
from rockflex._vectors import BLOCK
from rockflex.solve.layout import SAG, VALUES, ZERO, System

WHOLE = ZERO  # the level of a whole sample
MOST_GROWTH = 20.0  # e-folds of a pair within a block; beyond it, a block is shorter


@python_kernel
def put_powers(system: System, p: int, work: Array) -> None:
    """Enter the tables of a phase for blocks of samples, from its other tables; `work` (2, S, S) if it is dense."""
    size, slopes = 2 * system.blocks.shape[3], system.forced[p, 1]
    fastest = 0.0
    for k in range(system.blocks.shape[3]):
        fastest = max(fastest, math.log(growth_of(system, p, k)))
    length = BLOCK if fastest * BLOCK <= MOST_GROWTH else max(int(MOST_GROWTH / fastest), 1)
    system.phases[p].block = length
    for f in range(system.rows.shape[2]):
        for m in range(length):
            before = system.rows[p, VALUES, f] if m == 0 else system.ahead[p, f, :, m - 1]
            kick = 0.0
            for k in range(size):
                value = a_sample_before(system, p, before, k)
                system.ahead[p, f, k, m] = value
                kick -= value * slopes[k]
            system.kicked[p, f, BLOCK + m] = kick
    if not system.phases[p].dense:
        put_leap(system, p, length)
    put_leeway(system, p, length, work)


@kernel
def growth_of(system: System, p: int, k: int) -> float:
    """Return the largest factor, at least one, by which the norm of a pair grows in a sample."""
    if system.phases[p].dense:
        return 1.0
    step = system.blocks[p, WHOLE, :, k]
    squares = 0.5 * (step[0] * step[0] + step[1] * step[1] + step[2] * step[2] + step[3] * step[3])
    volume = step[0] * step[3] - step[1] * step[2]
    largest = squares + math.sqrt(max(squares * squares - volume * volume, 0.0))
    return math.sqrt(max(largest, 1.0))


@kernel
def a_sample_before(system: System, p: int, row: Array, k: int) -> float:
    """Return the k-th entry of a row, if it is taken over the coordinates one sample earlier."""
    pairs = system.blocks.shape[3]
    if system.phases[p].dense:
        total = 0.0
        for i in range(2 * pairs):
            total += row[i] * system.propagator[p, WHOLE, i, k]
        return total
    pair, column = k % pairs, 0 if k < pairs else 1
    step = system.blocks[p, WHOLE, :, pair]
    return row[pair] * step[column] + row[pairs + pair] * step[2 + column]


@kernel
def put_leap(system: System, p: int, length: int) -> None:
    """Enter what a block makes of its first coordinates, and of the jumps of the slope before each of its samples."""
    pairs = system.blocks.shape[3]
    for k in range(pairs):
        step, leap = system.blocks[p, WHOLE, :, k], system.leap[p, :, k]
        leap[0] = leap[3] = 1.0
        leap[1] = leap[2] = 0.0
        x, y = -system.forced[p, 1, k], -system.forced[p, 1, pairs + k]
        for m in range(length):
            x, y = step[0] * x + step[1] * y, step[2] * x + step[3] * y
            system.pushed[p, length - 1 - m, k] = x
            system.pushed[p, length - 1 - m, pairs + k] = y
            one, two = leap[0], leap[1]
            leap[0], leap[2] = step[0] * one + step[1] * leap[2], step[2] * one + step[3] * leap[2]
            leap[1], leap[3] = step[0] * two + step[1] * leap[3], step[2] * two + step[3] * leap[3]


@kernel
def put_leeway(system: System, p: int, length: int, work: Array) -> None:
    """Enter bounds of the deviation of each row from its chords over a block, and of what the jumps add to them."""
    pairs, dense = system.blocks.shape[3], system.phases[p].dense
    for f in range(system.rows.shape[2]):
        for k in range(pairs):
            growth = growth_of(system, p, k) ** (length - 1)
            system.leeway[p, f, k] = system.bounds[p, SAG, WHOLE, f, k] * growth
    if dense:
        raise_coupled_leeway(system, p, length, work)
    for f in range(system.rows.shape[2]):
        stray = 0.0
        for k in range(pairs):
            stray += system.leeway[p, f, k] * math.hypot(system.forced[p, 1, k], system.forced[p, 1, pairs + k])
        system.stray[p, f] = stray


@kernel
def raise_coupled_leeway(system: System, p: int, length: int, work: Array) -> None:
    """Raise the leeway of coupled pairs to what their norms may come to within the block."""
    pairs, step, power, next_power = system.blocks.shape[3], system.propagator[p, WHOLE], work[0], work[1]
    for i in range(2 * pairs):
        for j in range(2 * pairs):
            power[i, j] = step[i, j]
    for _ in range(1, length):
        for f in range(system.rows.shape[2]):
            for k in range(pairs):
                bound = 0.0
                for j in range(pairs):
                    bound += system.bounds[p, SAG, WHOLE, f, j] * block_norm(power, j, k, pairs)
                system.leeway[p, f, k] = max(system.leeway[p, f, k], bound)
        for i in range(2 * pairs):
            for j in range(2 * pairs):
                next_power[i, j] = 0.0
                for m in range(2 * pairs):
                    next_power[i, j] += power[i, m] * step[m, j]
        power, next_power = next_power, power


@kernel
def block_norm(matrix: Array, i: int, j: int, pairs: int) -> float:
    """Return the norm of what pair j contributes to pair i."""
    squares = matrix[i, j] ** 2 + matrix[i, pairs + j] ** 2
    return math.sqrt(squares + matrix[pairs + i, j] ** 2 + matrix[pairs + i, pairs + j] ** 2)
