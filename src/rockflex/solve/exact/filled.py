"""Propagators and curvature bounds in kernels, as `tables` describes them, for a phase that is uncoupled."""

import math

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex.solve.exact.entries import Tables
from rockflex.solve.exact.powers import enter_powers
from rockflex.solve.exact.series import NEGLIGIBLE
from rockflex.solve.layout import INTO, OUT, RIPPLE, SAG, SLOPES, SWING, VALUES


@kernel
def levels_over(fastest: float, dt: float) -> int:
    """Return how often a time step is halved until the phase of no mode advances by more than one radian."""
    return max(0, math.ceil(math.log2(max(fastest * dt, 1.0))))


@kernel
def terms_over(fastest: float, dt: float) -> int:
    """Return the number of terms after which a series from t³ (uplift) converges over the finest step of a phase."""
    turn = fastest * dt * 0.5 ** levels_over(fastest, dt)
    order, term = 3, 1.0
    while term > NEGLIGIBLE:
        order += 1
        term *= turn / order
    return order + 1


@kernel
def fill(system: Tables, p: int, steady: Array, blocks: Array, roots: Array, levels: int) -> None:
    """Enter the tables of a phase whose rows and basis are entered.

    `steady` (3, S) is the forced solution as states; `blocks` and `roots` (K, 4) describe the pairs.
    """
    fill_rows(system, p, blocks)
    fill_forcing(system, p, steady)
    length = system.dt
    for level in range(levels + 1):
        for k in range(roots.shape[0]):
            step_pair(system.blocks[p, level], k, blocks[k], roots[k], length)
        bound_rows(system, p, level, blocks, roots, length)
        length *= 0.5
    enter_powers(system, p)


@kernel
def fill_rows(system: Tables, p: int, blocks: Array) -> None:
    """Enter the rows over the coordinates, and their derivatives."""
    plain, basis, rows = system.plain_rows[p], system.basis[p, OUT], system.rows[p]
    size, half = basis.shape[0], blocks.shape[0]
    for r in range(plain.shape[0]):
        for k in range(size):
            total = 0.0
            for i in range(size):
                total += plain[r, i] * basis[k, i]
            rows[VALUES, k, r] = total
        for k in range(half):
            one, two = rows[VALUES, k, r], rows[VALUES, half + k, r]
            rows[SLOPES, k, r] = one * blocks[k, 0] + two * blocks[k, 2]
            rows[SLOPES, half + k, r] = one * blocks[k, 1] + two * blocks[k, 3]


@kernel
def fill_forcing(system: Tables, p: int, steady: Array) -> None:
    """Enter the forced motion in coordinates and in the rows."""
    plain, back, size = system.plain_rows[p], system.basis[p, INTO], steady.shape[1]
    for f in range(steady.shape[0]):
        for k in range(size):
            total = 0.0
            for i in range(size):
                total += steady[f, i] * back[i, k]
            system.forced[p, f, k] = total
        for r in range(plain.shape[0]):
            total = 0.0
            for i in range(size):
                total += plain[r, i] * steady[f, i]
            if f == 0:
                total += plain[r, plain.shape[1] - 2]
            elif f == 2:
                total += plain[r, plain.shape[1] - 1]
            system.row_forcing[p, r, f] = total


@kernel
def step_pair(out: Array, k: int, block: Array, roots: Array, h: float) -> None:
    """Enter exp(B h) of a pair: e^{λ₁h} I + (e^{λ₁h} - e^{λ₂h})/(λ₁ - λ₂) (B - λ₁ I); λ = σ ± iω in real numbers."""
    growth = math.exp(roots[0] * h)
    if roots[1] != 0.0:
        turn = roots[1] * h
        mixed, own = growth * math.sin(turn) / roots[1], growth * math.cos(turn)
    else:
        gap = (roots[0] - roots[2]) * h
        mixed = growth * h * (-math.expm1(-gap) / gap if gap != 0.0 else 1.0)
        own = growth
    out[0, k] = own + mixed * (block[0] - roots[0])
    out[1, k] = mixed * block[1]
    out[2, k] = mixed * block[2]
    out[3, k] = own + mixed * (block[3] - roots[0])


@kernel
def bound_rows(system: Tables, p: int, level: int, blocks: Array, roots: Array, h: float) -> None:
    """Enter sag, swing and ripple of every row over a step."""
    rows, half = system.rows[p], blocks.shape[0]
    for k in range(half):
        a, b, c, d = blocks[k, 0], blocks[k, 1], blocks[k, 2], blocks[k, 3]
        growth = math.exp(max(roots[k, 0], 0.0) * h)
        for r in range(system.stray.shape[1]):
            value = norm(rows[VALUES, k, r], rows[VALUES, half + k, r])
            x, y = rows[SLOPES, k, r], rows[SLOPES, half + k, r]
            slope = norm(x, y)
            x, y = x * a + y * c, x * b + y * d
            second = norm(x, y)
            x, y = x * a + y * c, x * b + y * d
            third = norm(x, y)
            x, y = x * a + y * c, x * b + y * d
            system.bounds[p, SAG, level, k, r] = min(second * h * h / 8.0, 2.0 * value) * growth
            system.bounds[p, SWING, level, k, r] = min(third * h * h / 8.0, 2.0 * slope) * growth
            system.bounds[p, RIPPLE, level, k, r] = norm(x, y) * (h * h) * (h * h) / 384.0 * growth


@kernel
def norm(x: float, y: float) -> float:
    """Return the length of a vector."""
    return math.sqrt(x * x + y * y)
