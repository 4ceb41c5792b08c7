"""Propagators and curvature bounds of a phase for the steps dt, dt/2, ... dt/2^J, and their tables.

The bounds decide whether an event or a peak can occur between two instants. Over a step h a row leaves its chord by at
most h²/8 max|row''|, its slope leaves its own chord by h²/8 max|row'''|, and the row leaves the cubic through the
values and slopes at both ends by h⁴/384 max|row''''|. For one pair of coordinates |row''| ≤ |row B²| |w| exp(growth),
and so on; a pair that is too fast for the step is bounded by its amplitude instead.
"""

import math

import numpy as np
from scipy.linalg import expm

from rockflex._arrays import Array
from rockflex._numba_vectors import padded
from rockflex._vectors import BLOCK
from rockflex.models import SUMS, Phase, RockingModel
from rockflex.solve._failures import LONGEST_FALL, failure_of_step
from rockflex.solve.exact.basis import Basis, Drift
from rockflex.solve.exact.entries import modes_of
from rockflex.solve.exact.powers import put_powers
from rockflex.solve.exact.series import NEGLIGIBLE
from rockflex.solve.layout import (
    CHANGED,
    CONSTANT,
    COUPLING,
    DAMPING,
    DRIVE,
    FLEXIBILITY,
    HIGH,
    INTO,
    LEVERAGE,
    LOW,
    OUT,
    RIPPLE,
    SAG,
    SLOPES,
    STIFFNESS,
    SWING,
    VALUES,
    System,
)
from rockflex.solve.records import PHASE


def check_step(basis: Basis, dt: float) -> None:
    """Check that no rotation overflows within a time step.

    Raises
    ------
    InputError
        If a rotation overflows.
    """
    fall = float(basis.roots.real.max())
    if fall * dt > LONGEST_FALL:
        raise failure_of_step(fall, dt)


def levels_of(fastest: float, dt: float) -> int:
    """Return how often a time step is halved until the phase of no mode advances by more than one radian."""
    return max(0, math.ceil(math.log2(max(fastest * dt, 1.0))))


def terms_of(fastest: float, dt: float) -> int:
    """Return the number of terms after which a series from t³ (uplift) converges over the finest step of a phase."""
    turn = fastest * dt * 0.5 ** levels_of(fastest, dt)
    order, term = 3, 1.0
    while term > NEGLIGIBLE:
        order += 1
        term *= turn / order
    return order + 1


def empty_system(
    model: RockingModel, rows: int, dt: float, capacity: int, levels: int, *, dense: bool, shaken: bool
) -> System:
    """Return empty tables for the given numbers of phases and halvings of the time step.

    `rows` counts the fences too; `shaken` means that the ground moves vertically as well.
    """
    p, layout, b = model.properties, model.layout, model.layout.freedoms
    n, core, pairs, columns = layout.modes, layout.core, layout.core // 2, layout.columns
    whole = (capacity, levels + 1)
    memories, changes, fences = layout.remembered, model.most_changes, model.most_fences
    moved = capacity if shaken else 0
    border = np.zeros((capacity, 2, b, padded(pairs)))
    border[:, COUPLING, range(b), range(n, pairs)] = -1.0
    links = np.full((capacity, CHANGED + changes + fences), -1, dtype=np.int64)
    return System(
        layout=layout,
        dt=dt,
        modes=modes_of(p.omega, p.zeta, pairs),
        phases=np.zeros(capacity, dtype=PHASE),
        turning_row=rows - fences - 2 if model.turning else -1,
        chords=model.complete,
        fences=rows - fences,
        fenced=CHANGED + changes,
        links=links,
        fence_kinds=np.full((capacity, fences, 2), -1, dtype=np.int64),
        fence_values=np.zeros((capacity, fences, columns)),
        limits=np.zeros((capacity, 2, 2 + memories)),
        changes=np.zeros((capacity, changes, 2)),
        change_kinds=np.full((capacity, changes, 2), -1, dtype=np.int64),
        marks=np.full((capacity, memories), np.nan),
        turnings=np.full((capacity, memories, 2), np.nan),
        recall=np.zeros((capacity, b, memories)),
        border=border,
        base=np.zeros((capacity, 3, b, b)),
        push=np.zeros((capacity, 2, b)),
        pulls=np.zeros((capacity, SUMS, 1 + memories)),
        heavier_push=np.zeros((moved, b)),
        heavier_base=np.zeros((moved, b, b)),
        heavier_limits=np.zeros((moved, 2, 2)),
        heavier_rows=np.zeros((moved, rows, columns)),
        plain_rows=np.zeros((capacity, rows, columns)),
        basis=np.zeros((capacity, 2, core, padded(core))),
        forced=np.zeros((capacity, 3 + memories, core)),
        rows=np.zeros((capacity, 2, core, padded(rows))),
        row_forcing=np.zeros((capacity, rows, 3 + memories)),
        blocks=np.zeros((*whole, 4, pairs)),
        propagator=np.zeros((*whole, core, core)) if dense else np.zeros((0, 0, 0, 0)),
        bounds=np.zeros((capacity, 3, levels + 1, pairs, padded(rows))),
        ahead=np.zeros((capacity, rows, core, BLOCK)),
        kicked=np.zeros((capacity, rows, 2 * BLOCK)),
        leap=np.zeros((capacity, 4, pairs)),
        pushed=np.zeros((capacity, BLOCK, padded(core))),
        leeway=np.zeros((capacity, pairs, padded(rows))),
        stray=np.zeros((capacity, rows)),
    )


def size_of(system: System) -> int:
    """Return the memory of all tables in bytes."""
    return sum(table.nbytes for table in system if isinstance(table, np.ndarray))


def put_phase(system: System, p: int, phase: Phase, basis: Basis | Drift | None, plain_rows: Array, twin: int) -> None:
    """Enter one phase at index `p`; `plain_rows` (F + E, C). A phase that is not linear has no basis.

    `twin` is the index of a phase that differs only in constant forces, or -1; the common tables are copied.
    """
    guard, arrow, dt = phase.guard, phase.arrow, system.dt
    system.plain_rows[p] = plain_rows
    system.pulls[p] = phase.pulls
    for bound, limit in ((LOW, guard.low), (HIGH, guard.high)):
        system.limits[p, bound] = limit, guard.turn, *guard.recall[bound]
    for x, change in enumerate(phase.changes):
        system.changes[p, x] = change.place, change.recall
        system.change_kinds[p, x] = change.outer, change.memory
    for memory, mark in phase.marks:
        system.marks[p, memory] = mark
    for turning in phase.turnings:
        system.turnings[p, turning.memory] = turning.arm, turning.offset
    for e, fence in enumerate(phase.fences):
        system.fence_kinds[p, e] = fence.event, fence.memory
        if fence.value is not None:
            system.fence_values[p, e] = fence.value
    count = len(phase.fences)
    if basis is None or arrow is None:
        system.phases[p] = phase.side, phase.free, False, phase.turns, 0, count, False, 0, 0, False, False, 0, 0.0
        return
    levels = levels_of(basis.fastest, dt)
    terms = terms_of(basis.fastest, dt)
    marches = isinstance(basis, Basis)
    # A freedom that is held, such as the slip of a base that sticks, does not move: its roots, zero, do not count.
    falls = marches and phase.free and (basis.dense or bool((basis.roots[: basis.moving].real >= 0.0).any()))
    decays = marches and not falls
    pairs = arrow.coupling.shape[0] + arrow.coupling.shape[1]
    at_rest = phase.side == 0 and not phase.free  # then the rotation is not only held, but zero
    active = 0 if not marches else basis.moving if phase.free or at_rest else pairs
    dense = marches and basis.dense
    course = active, count, marches, levels, terms
    system.phases[p] = phase.side, phase.free, decays, phase.turns, *course, True, dense, 0, basis.fastest
    n = arrow.coupling.shape[1]
    system.border[p, COUPLING, :, :n], system.border[p, LEVERAGE, :, :n] = arrow.coupling, arrow.leverage
    system.base[p, FLEXIBILITY], system.base[p, DAMPING] = arrow.flexibility, arrow.damping
    system.base[p, STIFFNESS] = arrow.stiffness
    system.push[p, CONSTANT], system.push[p, DRIVE] = arrow.constant, arrow.drive
    system.recall[p] = arrow.recall
    if not marches:
        return
    core, own, memory = basis.basis.shape[0], slice(levels + 1), system.layout.memory
    moving = plain_rows[:, :core]
    rows = moving @ basis.basis
    first = rows @ basis.matrix
    forcing = moving @ basis.steady.T
    forcing[:, 0] += plain_rows[:, -2]
    forcing[:, 2] += plain_rows[:, -1]
    forcing[:, 3:] += plain_rows[:, memory : memory + system.layout.remembered]
    count = plain_rows.shape[0]
    system.basis[p, OUT, :, :core], system.basis[p, INTO, :, :core] = basis.basis.T, basis.inverse.T
    system.forced[p] = basis.steady @ basis.inverse.T
    system.rows[p, VALUES, :, :count], system.rows[p, SLOPES, :, :count] = rows.T, first.T
    system.row_forcing[p] = forcing
    if twin >= 0 and np.array_equal(np.abs(moving), np.abs(system.plain_rows[twin, :, :core])):
        system.blocks[p], system.bounds[p] = system.blocks[twin], system.bounds[twin]
        if basis.dense:
            system.propagator[p] = system.propagator[twin]
        put_powers(system, p)
        return
    steps: Array = dt * 0.5 ** np.arange(levels + 1, dtype=np.float64)
    system.blocks[p, own] = _blocks(basis, steps)
    if basis.dense:
        system.propagator[p, own] = np.stack([expm(basis.matrix * h) for h in steps])
        bounds = _dense_bounds(basis, rows, steps)
    else:
        bounds = _bounds(basis, rows, first, steps)
    for which, bound in zip((SAG, SWING, RIPPLE), bounds, strict=True):
        system.bounds[p, which, own, :, :count] = bound.transpose(0, 2, 1)
    put_powers(system, p)


def put_heavier(system: System, p: int, phase: Phase, heavier: Phase, rows: Array) -> None:
    """Enter what a vertical acceleration of 1 m/s² adds to a phase, from that under as much more gravity.

    `rows` are the rows under that gravity.
    """
    system.heavier_rows[p] = rows - system.plain_rows[p]
    if phase.arrow is not None and heavier.arrow is not None:
        system.heavier_push[p] = heavier.arrow.constant - phase.arrow.constant
        system.heavier_base[p] = heavier.arrow.stiffness - phase.arrow.stiffness
    for bound, (more, limit) in enumerate(
        ((heavier.guard.low, phase.guard.low), (heavier.guard.high, phase.guard.high))
    ):
        change = more - limit if math.isfinite(limit) else 0.0
        system.heavier_limits[p, bound] = change, heavier.guard.turn - phase.guard.turn


def _blocks(basis: Basis, steps: Array) -> Array:
    """Return exp(B h) of every pair: exp(λ₁h) I + (exp(λ₁h) - exp(λ₂h))/(λ₁ - λ₂) (B - λ₁ I)."""
    one, two = basis.roots[:, 0], basis.roots[:, 1]
    h = steps[:, None]
    gap = (one - two) * h
    safe = np.where(gap == 0.0, 1.0, gap)
    growth = np.exp(one * h)
    quotient = growth * h * np.where(gap == 0.0, 1.0, -np.expm1(-safe) / safe)
    out = np.empty((steps.size, 4, one.size))
    out[:, 0] = (growth + quotient * (basis.pairs[:, 0, 0] - one)).real
    out[:, 1] = (quotient * basis.pairs[:, 0, 1]).real
    out[:, 2] = (quotient * basis.pairs[:, 1, 0]).real
    out[:, 3] = (growth + quotient * (basis.pairs[:, 1, 1] - one)).real
    return out


def _pair_norm(rows: Array) -> Array:
    """Return the norm of each row over each pair of coordinates (k, K + k)."""
    half = rows.shape[-1] // 2
    return np.sqrt(rows[..., :half] ** 2 + rows[..., half:] ** 2)


def _bounds(basis: Basis, rows: Array, first: Array, steps: Array) -> tuple[Array, Array, Array]:
    """Return sag, swing and ripple of every row over every step, each of shape (J + 1, F, K)."""
    h = steps[:, None, None]
    growth = np.exp(np.maximum(basis.roots.real.max(axis=1), 0.0) * h)
    second = first @ basis.matrix
    third = second @ basis.matrix
    fourth = third @ basis.matrix
    sag = np.minimum(_pair_norm(second) * h**2 / 8.0, 2.0 * _pair_norm(rows)) * growth
    swing = np.minimum(_pair_norm(third) * h**2 / 8.0, 2.0 * _pair_norm(first)) * growth
    return sag, swing, _pair_norm(fourth) * h**4 / 384.0 * growth


def _dense_bounds(basis: Basis, rows: Array, steps: Array) -> tuple[Array, Array, Array]:
    """Return the same from |row B² exp(B t)| on the finest grid, with a norm bound between its points."""
    finest, between = expm(basis.matrix * steps[-1]), expm(np.abs(basis.matrix) * steps[-1])
    second = rows @ basis.matrix @ basis.matrix
    third = second @ basis.matrix
    moving = np.stack((second, third, third @ basis.matrix))
    worst = np.abs(moving) @ between
    bounds = np.empty((3, steps.size, second.shape[0], second.shape[1] // 2))
    for level in range(steps.size - 1, -1, -1):
        for _ in range(1 << (steps.size - 1 - level) >> 1):
            moving = moving @ finest
            worst = np.maximum(worst, np.abs(moving) @ between)
        bounds[:, level] = _pair_norm(worst)
    h = steps[:, None, None]
    return bounds[0] * h**2 / 8.0, bounds[1] * h**2 / 8.0, bounds[2] * h**4 / 384.0


def propagate(basis: Basis, w: Array, steps: Array) -> Array:
    """Return the coordinates after steps of any length, one per row of `w` (n, 2K)."""
    lengths, which = np.unique(steps, return_inverse=True)
    if basis.dense:
        propagators = np.stack([expm(basis.matrix * length) for length in lengths])
        return np.einsum("nij,nj->ni", propagators[which], w)
    half = w.shape[1] // 2
    blocks = _blocks(basis, lengths)[which]
    first, second = w[:, :half], w[:, half:]
    return np.concatenate(
        (blocks[:, 0] * first + blocks[:, 1] * second, blocks[:, 2] * first + blocks[:, 3] * second), axis=1
    )
