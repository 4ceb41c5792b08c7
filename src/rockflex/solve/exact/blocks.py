"""A block of samples in a linear phase: its rows at every sample at once, and the coordinates within each sample.

The start of the block is in `motion.w[BEGUN]`, with the jump of the acceleration's slope there; the coordinates are
advanced sample by sample only where they are needed.
"""

import math

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex._vectors import BLOCK, add_products, outside, row_over_block
from rockflex.solve.exact.probe import step
from rockflex.solve.layout import (
    BEGUN,
    ENDS,
    GROUNDS,
    INCLINES,
    JUMPS,
    NOW,
    VALUES,
    Motion,
    Progress,
    System,
    rows_in,
)


@kernel
def look_ahead(system: System, piece: Array, last: int, at: Progress, motion: Motion) -> None:
    """Compute the rows at the ends of the samples of a block, and how far they may leave their chords."""
    p, pairs = at.phase, motion.norms.size
    active, first, rate = system.phases[p].active, at.index, 1.0 / system.dt
    at.count = min(system.phases[p].block, last - first)
    forced, begun = system.forced[p, 1], motion.w[BEGUN]
    grounds, inclines, jumps = motion.block[GROUNDS], motion.block[INCLINES], motion.block[JUMPS]
    before, turned = at.slope, 0.0
    for m in range(at.count):
        inclines[m] = (piece[first + m + 1] - piece[first + m]) * rate
        grounds[m] = piece[first + m + 1]
        jumps[m] = inclines[m] - before
        before = inclines[m]
        turned += abs(jumps[m])
    for m in range(at.count, BLOCK):
        grounds[m] = inclines[m] = jumps[m] = 0.0
    for k in range(2 * pairs):
        begun[k] = motion.w[NOW, k] - forced[k] * jumps[0]
    turned -= abs(jumps[0])
    jumps[0] = 0.0  # it is already in `begun`
    for k in range(active):
        motion.norms[k] = math.sqrt(begun[k] * begun[k] + begun[pairs + k] * begun[pairs + k])
    at.walk = -1
    for f in range(rows_in(system, p)):
        rows, offset = system.rows[p, VALUES, f], motion.offset[f]
        by_ground, by_slope = system.row_forcing[p, f, 0], system.row_forcing[p, f, 1]
        slack = system.stray[p, f] * turned
        start = offset + by_ground * piece[first] + by_slope * inclines[0]
        for k in range(active):
            slack += system.leeway[p, f, k] * motion.norms[k]
            start += rows[k] * begun[k] + rows[pairs + k] * begun[pairs + k]
        motion.slack[f], motion.begins[f] = slack, start
        row_over_block(
            motion.told[f],
            offset,
            by_ground,
            by_slope,
            motion.block,
            system.ahead[p, f],
            begun,
            active,
            system.kicked[p, f],
        )


@kernel
def leaving(row: int, lower: float, upper: float, at: Progress, motion: Motion) -> int:
    """Return the samples of the block, as bits, at one of whose ends a row lies outside its limits."""
    samples = (1 << at.count) - 1
    ends = outside(motion.told[row], lower, upper) & samples
    first = 1 if motion.begins[row] < lower or motion.begins[row] > upper else 0
    return (ends | ends << 1 | first) & samples


@kernel
def walk_to(system: System, m: int, at: Progress, motion: Motion) -> None:
    """Set `motion.w[NOW]` to the coordinates within sample `m` of the block, at its start."""
    if at.walk < 0 or at.walk > m:
        for k in range(motion.w.shape[1]):
            motion.w[NOW, k] = motion.w[BEGUN, k]
        at.walk = 0
    while at.walk < m:
        step(system, at.phase, 0, motion)
        walk_on(system, at, motion)


@kernel
def walk_on(system: System, at: Progress, motion: Motion) -> None:
    """Continue from the end of the present sample of the block, where `motion.w[ENDS]` is, into the next one."""
    at.walk += 1
    jump = motion.block[JUMPS, at.walk] if at.walk < BLOCK else 0.0
    for k in range(motion.w.shape[1]):
        motion.w[NOW, k] = motion.w[ENDS, k] - system.forced[at.phase, 1, k] * jump


@kernel
def pass_block(system: System, at: Progress, stops: bool, motion: Motion) -> None:
    """Move `motion.w[NOW]` to the end of the block; if it `stops` at an event, to the start of the sample of it."""
    p, pairs, count = at.phase, motion.norms.size, at.count
    if stops:
        walk_to(system, count, at, motion)
        at.slope = motion.block[INCLINES, count]
    elif count < system.phases[p].block or system.phases[p].dense:
        walk_to(system, count - 1, at, motion)
        step(system, p, 0, motion)
        walk_on(system, at, motion)
        at.slope = motion.block[INCLINES, count - 1]
    else:
        begun, beyond, leap = motion.w[BEGUN], motion.beyond, system.leap[p]
        for k in range(pairs):
            beyond[k] = leap[0, k] * begun[k] + leap[1, k] * begun[pairs + k]
            beyond[pairs + k] = leap[2, k] * begun[k] + leap[3, k] * begun[pairs + k]
        add_products(beyond, system.pushed[p], motion.block[JUMPS])
        for k in range(2 * pairs):
            motion.w[NOW, k] = beyond[k]
        at.slope = motion.block[INCLINES, count - 1]
