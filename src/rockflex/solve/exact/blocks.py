"""A block of samples in a linear phase: its rows at every sample at once, and the coordinates within each sample.

The start of the block is in `motion.w[BEGUN]`, with the jump of the acceleration's slope there; the coordinates are
advanced sample by sample only where they are needed.
"""

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex._vectors import BLOCK, outside, row_over_block, set_less, set_norms, set_products, step_pairs
from rockflex.solve.exact.probe import set_over_pairs, step
from rockflex.solve.layout import (
    BEGUN,
    ENDS,
    GROUNDS,
    INCLINES,
    JUMPS,
    NOW,
    TOTALS,
    VALUES,
    Motion,
    Progress,
    System,
    rows_in,
)


@inlined_kernel
def look_ahead(system: System, piece: Array, last: int, at: Progress, motion: Motion) -> None:
    """Compute the rows at the ends of the samples of a block, and how far they may leave their chords."""
    p = at.phase
    active, first, rate = system.phases[p].active, at.index, 1.0 / system.dt
    at.count = min(system.phases[p].block, last - first)
    forced, begun = system.forced[p, 1], motion.w[BEGUN]
    grounds, inclines, jumps = motion.block[GROUNDS], motion.block[INCLINES], motion.block[JUMPS]
    before, turned = at.slope, 0.0
    ground = piece[first]
    for m, after in enumerate(piece[first + 1 : first + 1 + at.count]):
        incline = (after - ground) * rate
        grounds[m], inclines[m], jumps[m] = after, incline, incline - before
        turned += abs(incline - before)
        ground, before = after, incline
    for m in range(at.count, BLOCK):
        grounds[m] = inclines[m] = jumps[m] = 0.0
    jump = jumps[0]
    set_less(begun, motion.w[NOW], forced, jump)
    turned -= abs(jump)
    jumps[0] = 0.0  # it is already in `begun`
    set_norms(motion.norms, begun, active)
    at.walk = -1
    forcing, ground, slope = system.row_forcing[p], piece[first], inclines[0]
    slack, begins = motion.slack, motion.begins
    set_products(slack, system.leeway[p], motion.norms, active, 1)
    set_over_pairs(begins, system.rows[p, VALUES], begun, active)
    for f in range(rows_in(system, p)):
        slack[f] += system.stray[p, f] * turned
        begins[f] += motion.offset[f] + forcing[f, 0] * ground + forcing[f, 1] * slope
        row_over_block(
            motion.told[f],
            motion.offset[f],
            forcing[f, 0],
            forcing[f, 1],
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
    set_less(motion.w[NOW], motion.w[ENDS], system.forced[at.phase, 1], jump)


@inlined_kernel
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
        begun, beyond, now = motion.w[BEGUN], motion.beyond[TOTALS], motion.w[NOW]
        set_products(beyond, system.pushed[p], motion.block[JUMPS], BLOCK, 1)
        step_pairs(now, system.leap[p], begun, pairs)
        for k in range(2 * pairs):
            now[k] += beyond[k]
        at.slope = motion.block[INCLINES, count - 1]
