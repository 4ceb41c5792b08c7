"""Propagators and curvature bounds of a phase for the steps dt, dt/2, ... dt/2^J.

The bounds say where an event or a peak can hide between two instants. Over a step h a row leaves its chord by at
most h²/8 max|row''|, and for one pair of coordinates |row''| ≤ |row B²| |w| exp(growth); a pair that turns
more than once in the step is bounded by its amplitude instead.
"""

import math

import numpy as np
from scipy.linalg import expm

from rockflex.solve.exact.basis import Basis
from rockflex.solve.exact.layout import Array, Phase

__all__ = ["levels", "tabulate"]

NONE = np.empty((0, 0, 0))


def levels(fastest: float, dt: float) -> int:
    """Number J of halvings of `dt` after which no mode turns by more than one radian."""
    return max(0, math.ceil(math.log2(fastest * dt))) if fastest * dt > 0.0 else 0


def tabulate(basis: Basis, dt: float, halvings: int) -> Phase:
    """Tables of one phase for the steps dt / 2^j, j = 0..halvings."""
    steps = dt / 2.0 ** np.arange(halvings + 1)
    first = basis.rows @ basis.matrix
    second = first @ basis.matrix
    if basis.dense:
        blocks, dense = NONE, np.stack([expm(basis.matrix * h) for h in steps])
        sag, swing = _dense_bounds(basis, second, dense, steps)
    else:
        blocks, dense = _blocks(basis, steps), NONE
        sag, swing = _pair_bounds(basis, first, second, steps)
    return Phase(
        basis=np.ascontiguousarray(basis.basis),
        inverse=np.ascontiguousarray(basis.inverse),
        particular=np.ascontiguousarray(basis.particular),
        rows=np.ascontiguousarray(basis.rows),
        row_forcing=np.ascontiguousarray(basis.row_forcing),
        slope_rows=np.ascontiguousarray(first),
        slope_forcing=np.ascontiguousarray(basis.row_forcing[:, 0]),
        blocks=blocks,
        dense=dense,
        sag=sag,
        swing=swing,
        hold=_pair_norm(basis.rows),
    )


def _blocks(basis: Basis, steps: Array) -> Array:
    """exp(B h) of every pair: exp(λ₁h) I + (exp(λ₁h) - exp(λ₂h))/(λ₁ - λ₂) (B - λ₁ I)."""
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
    """Norm of each row over each pair of coordinates (k, K + k)."""
    half = rows.shape[-1] // 2
    return np.hypot(rows[..., :half], rows[..., half:])


def _pair_bounds(basis: Basis, first: Array, second: Array, steps: Array) -> tuple[Array, Array]:
    h = steps[:, None, None]
    growth = np.exp(np.maximum(basis.roots.real.max(axis=1), 0.0) * h)
    level, slope, curvature = _pair_norm(basis.rows), _pair_norm(first), _pair_norm(second)
    sag = np.minimum(curvature * h**2 / 8.0, 2.0 * level) * growth
    swing = np.minimum(curvature * h, 2.0 * slope) * growth
    return sag, swing


def _dense_bounds(basis: Basis, second: Array, dense: Array, steps: Array) -> tuple[Array, Array]:
    """Suprema of |row B² exp(B t)| over each step, from the finest grid and a norm bound between its points."""
    finest, between = dense[-1], expm(np.abs(basis.matrix) * steps[-1])
    moving, worst = second, np.abs(second) @ between
    curvature = np.empty((steps.size, second.shape[0], second.shape[1] // 2))
    for level in range(steps.size - 1, -1, -1):
        points = 1 << (steps.size - 1 - level)
        for _ in range(points >> 1):
            moving = moving @ finest
            worst = np.maximum(worst, np.abs(moving) @ between)
        curvature[level] = _pair_norm(worst)
    h = steps[:, None, None]
    return curvature * h**2 / 8.0, curvature * h
