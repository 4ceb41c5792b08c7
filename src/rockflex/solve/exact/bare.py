"""The phases of a base that only rocks, without elements, entered into the tables by one kernel.

Most structures are of this kind. Their phases, contact and rocking about either pivot, differ only in numbers, so that
neither elements nor branches need to be put together; the result is that of `tables` to rounding.
"""

import math
from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import kernel, python_kernel
from rockflex.solve.exact.eigen import find_eigenvectors
from rockflex.solve.exact.entries import Tables
from rockflex.solve.exact.filled import fill, levels_over, terms_over
from rockflex.solve.exact.uncoupled import Pairs, enter, enter_roots, uncouple
from rockflex.solve.layout import (
    CONSTANT,
    COUPLING,
    DRAG,
    DRIVE,
    FLEXIBILITY,
    HIGH,
    INTO,
    LEVERAGE,
    LOW,
    OMEGA2,
    OUT,
    STIFFNESS,
)

CLOSED, RIGHT, LEFT = 0, 1, 2  # indices of the phases
QUARTER_TURN = 0.5 * np.pi


class Bare(NamedTuple):
    """The numbers of a structure without elements, and what its rows are."""

    modes: Array  # (4, N): m*, h*, √m* and ω
    pivots: Array  # (2, 2): inertia and distance of the right and of the left pivot
    moment: float  # L_0^r
    mass: float  # m_tot
    gravity: float
    longest_fall: float  # e-folds of the rotation within a time step
    shares: Array  # (F, 3 N + 4): `Quantities.shares`
    swings: Array  # (F, 2): `Quantities.swings`
    accelerations: Array  # (N + 1, C): work array
    steady: Array  # (3, S): work array


@python_kernel
def enter_bare(system: Tables, bare: Bare, pairs: Pairs) -> int:
    """Enter all three phases; return the terms that their power series need, or 0 if they need closer attention.

    That is the case if the coordinates cannot be told apart, something overflows, or the levels do not suffice.
    """
    if not enter_contact(system, bare, pairs):
        return 0
    if not (enter_rocking(system, bare, pairs, RIGHT) and enter_rocking(system, bare, pairs, LEFT)):
        return 0
    phases = system.phases
    return int(max(phases[CLOSED].terms, phases[RIGHT].terms, phases[LEFT].terms))


@kernel
def enter_contact(system: Tables, bare: Bare, pairs: Pairs) -> bool:
    """Enter contact (Eq. 15), which is uncoupled already; return whether it could be done."""
    n, fastest = bare.modes.shape[1], 0.0
    half, basis, steady = n + 1, system.basis[CLOSED], bare.steady
    for i in range(n):
        mass, height = bare.modes[0, i], bare.modes[1, i]
        system.border[CLOSED, COUPLING, 0, i], system.border[CLOSED, LEVERAGE, 0, i] = height, mass * height
    enter_rows(system, bare, CLOSED, 0.0)
    system.limits[CLOSED, LOW, 0] = -bare.mass * bare.gravity * bare.pivots[0, 1]
    system.limits[CLOSED, HIGH, 0] = bare.mass * bare.gravity * bare.pivots[1, 1]
    clear(steady)
    for i in range(n):
        omega, square, drag = bare.modes[3, i], system.modes[OMEGA2, i], system.modes[DRAG, i]
        enter(pairs, i, 0.0, omega, -omega, -drag)
        sigma, spread = -0.5 * drag, 0.25 * drag * drag - square
        root = math.sqrt(abs(spread))
        if spread < 0.0:
            enter_roots(pairs, i, sigma, root, sigma, -root)
            fastest = max(fastest, omega)
        else:
            enter_roots(pairs, i, sigma + root, 0.0, sigma - root, 0.0)
            fastest = max(fastest, root - sigma)
        basis[OUT, i, i] = basis[INTO, i, i] = 1.0
        basis[OUT, half + i, n + i], basis[INTO, n + i, half + i] = omega, 1.0 / omega
        steady[0, i] = steady[1, n + i] = -1.0 / square
        steady[1, i] = drag / (square * square)
    enter(pairs, n, 0.0, 0.0, 0.0, 0.0)  # rotation and θ', both zero
    enter_roots(pairs, n, 0.0, 0.0, 0.0, 0.0)
    basis[OUT, n, 2 * n] = basis[INTO, 2 * n, n] = 1.0
    basis[OUT, half + n, 2 * n + 1] = basis[INTO, 2 * n + 1, half + n] = 1.0
    if not fastest < math.inf or levels_over(fastest, system.dt) >= system.blocks.shape[1]:
        return False
    describe(system, CLOSED, 0.0, fastest, n, True)
    fill(system, CLOSED, steady, pairs.blocks, pairs.roots, system.phases[CLOSED].levels)
    return True


@kernel
def enter_rocking(system: Tables, bare: Bare, pairs: Pairs, p: int) -> bool:
    """Enter rocking about one pivot (Eq. 23); return whether it could be done."""
    n = bare.modes.shape[1]
    pivot, side = p - RIGHT, 1.0 if p == RIGHT else -1.0
    inertia, arm = bare.pivots[pivot, 0], bare.pivots[pivot, 1]
    free, lever = inertia, 0.0
    for i in range(n):
        mass, height = bare.modes[0, i], bare.modes[1, i]
        system.border[p, COUPLING, 0, i], system.border[p, LEVERAGE, 0, i] = height, mass * height
        free -= mass * height * height
        lever += mass * height
    flexibility, weight = 1.0 / free, bare.mass * bare.gravity * arm
    system.base[p, FLEXIBILITY, 0, 0] = flexibility
    system.base[p, STIFFNESS, 0, 0] = -bare.moment * bare.gravity
    system.push[p, CONSTANT, 0], system.push[p, DRIVE, 0] = -side * weight, lever - bare.moment
    system.limits[p, LOW, 0], system.limits[p, HIGH, 0] = (0.0, QUARTER_TURN) if p == RIGHT else (-QUARTER_TURN, 0.0)
    enter_rows(system, bare, p, side)
    if not free > 0.0:
        return False
    if (p == RIGHT or bare.pivots[0, 0] != bare.pivots[1, 0]) and not uncouple_rocking(bare, pairs, flexibility):
        return False
    enter_basis(system, p, pairs)
    clear(bare.steady)
    for i in range(n):
        square = system.modes[OMEGA2, i]
        bare.steady[0, i] = bare.steady[1, n + i] = -1.0 / square
        bare.steady[1, i] = system.modes[DRAG, i] / (square * square)
    # At rest the modes are zero, and the weight is balanced.
    bare.steady[0, 2 * n] = bare.steady[1, 2 * n + 1] = 1.0 / bare.gravity
    bare.steady[2, 2 * n] = side * weight / (bare.moment * bare.gravity)
    fastest, largest = 0.0, -math.inf
    for k in range(n + 1):
        roots = pairs.roots[k]
        fastest = max(fastest, math.hypot(roots[0], roots[1]), math.hypot(roots[2], roots[3]))
        largest = max(largest, roots[0])
    if not largest * system.dt <= bare.longest_fall or levels_over(fastest, system.dt) >= system.blocks.shape[1]:
        return False
    describe(system, p, side, fastest, n + 1, largest < 0.0)
    fill(system, p, bare.steady, pairs.blocks, pairs.roots, system.phases[p].levels)
    return True


@kernel
def uncouple_rocking(bare: Bare, pairs: Pairs, flexibility: float) -> bool:
    """Find the coordinates of rocking, from the accelerations last entered."""
    n, scale, matrix = bare.modes.shape[1], pairs.scale, pairs.eigen.matrix
    half, spin = n + 1, 1.0 / math.sqrt(flexibility)
    for i in range(n):
        scale[i], scale[half + i] = bare.modes[2, i] * bare.modes[3, i], bare.modes[2, i]
    scale[n], scale[half + n] = spin * bare.modes[3, 0], spin
    for i in range(half):
        for j in range(2 * half):
            matrix[j, i] = scale[i] / scale[j] if j == half + i else 0.0
            matrix[j, half + i] = bare.accelerations[i, pairs.places[j]] * (scale[half + i] / scale[j])
    return find_eigenvectors(pairs.eigen) and uncouple(pairs, n)


@kernel
def enter_basis(system: Tables, p: int, pairs: Pairs) -> None:
    """Enter the coordinates, which are those of positions, then speeds, in the scale of energies."""
    basis, size = system.basis[p], pairs.scale.size
    for i in range(size):
        place, scale = pairs.places[i], pairs.scale[i]
        for k in range(size):
            basis[OUT, k, place] = pairs.columns[i, k] / scale
            basis[INTO, place, k] = pairs.inverse[k, i] * scale


@kernel
def describe(system: Tables, p: int, side: float, fastest: float, active: int, decays: bool) -> None:
    """Enter what a phase is."""
    phase = system.phases[p]
    phase.side, phase.free, phase.decays = side, p != CLOSED, decays
    phase.active, phase.marches, phase.linear = active, True, True
    phase.fastest = fastest
    phase.levels, phase.terms = levels_over(fastest, system.dt), terms_over(fastest, system.dt)


@kernel
def enter_rows(system: Tables, bare: Bare, p: int, side: float) -> None:
    """Enter the rows of a phase, and the accelerations that they contain, as `models` defines them."""
    n, rows, accelerations = bare.modes.shape[1], system.plain_rows[p], bare.accelerations
    columns = rows.shape[1]
    ground, one, turn = columns - 2, columns - 1, accelerations[n]
    clear(accelerations)
    turn[ground] = bare.moment
    for i in range(n):  # first the overturning moment, Eq. 24
        lever = bare.modes[0, i] * bare.modes[1, i]
        turn[i], turn[n + i] = -lever * system.modes[OMEGA2, i], -lever * system.modes[DRAG, i]
        turn[ground] -= lever
    last = rows.shape[0] - 1
    if p == CLOSED:
        for c in range(columns):
            rows[0, c], rows[last, c], turn[c] = turn[c], 0.0, 0.0
    else:
        arm = bare.pivots[p - RIGHT, 1]
        for c in range(columns):
            turn[c] = -turn[c]
        turn[2 * n] += bare.moment * bare.gravity
        turn[one] -= side * bare.mass * bare.gravity * arm
        flexibility = system.base[p, FLEXIBILITY, 0, 0]
        for c in range(columns):
            turn[c] *= flexibility
            rows[0, c], rows[last, c] = 0.0, -side * bare.mass * arm * turn[c]
        rows[0, 2 * n] = 1.0
    for i in range(n):
        for c in range(columns):
            accelerations[i, c] = -bare.modes[1, i] * turn[c]
        accelerations[i, i] -= system.modes[OMEGA2, i]
        accelerations[i, n + i] -= system.modes[DRAG, i]
        accelerations[i, ground] -= 1.0
    for f in range(bare.shares.shape[0]):
        enter_quantity(system, bare, f, rows[1 + f], side)


@kernel
def enter_quantity(system: Tables, bare: Bare, f: int, row: Array, side: float) -> None:
    """Enter the row of one quantity."""
    n, shares, columns = bare.modes.shape[1], bare.shares[f], row.size
    for c in range(columns):
        row[c] = shares[3 * n + 2] * bare.accelerations[n, c]
    for i in range(n):
        share = shares[2 * n + i]
        if share != 0.0:
            for c in range(columns):
                row[c] += share * bare.accelerations[i, c]
        row[i] += shares[i] + shares[n + i] * system.modes[OMEGA2, i]
    row[2 * n] += shares[3 * n]
    row[columns - 2] += shares[3 * n + 3]
    if side > 0.0:
        row[2 * n] += shares[3 * n + 1]
        row[2 * n + 1] += bare.swings[f, 1]
    if side != 0.0:
        row[2 * n + 1] += bare.swings[f, 0]


@kernel
def clear(matrix: Array) -> None:
    """Make every entry zero."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            matrix[i, j] = 0.0
