"""Propagators and curvature bounds of both phases for the steps dt, dt/2, ... dt/2^J.

The bounds say where an event or a peak can hide between two instants. Over a step h a row leaves its chord by at
most h²/8 max|row''|, its slope leaves its own chord by h²/8 max|row'''|, and the row leaves the cubic through the
values and slopes at both ends by h⁴/384 max|row''''|. For one pair of coordinates |row''| ≤ |row B²| |w| exp(growth),
and so on; a pair that turns more than once in the step is bounded by its amplitude instead.
"""

import math

import numpy as np
from scipy.linalg import expm

from rockflex._errors import InputError
from rockflex.solve.exact.basis import Basis
from rockflex.solve.exact.layout import Array, Physics, System

__all__ = ["propagate", "tabulate"]

LONGEST_FALL = 300.0  # e-folds of the rotation within a time step: beyond it numbers overflow
NONE = np.empty((0, 0, 0))


def tabulate(physics: Physics, plain_rows: Array, contact: Basis, rocking: Basis, dt: float) -> System:
    """A system for one time step; `plain_rows` (2, F, 2K + 2).

    Raises
    ------
    InputError
        If the time step is so long that a rotation grows beyond all numbers within it.
    """
    fall = float(rocking.roots.real.max())
    if fall * dt > LONGEST_FALL:
        message = (
            f"The time step of {dt:g} s is too long: a rocking rotation of this structure grows e-fold in "
            f"{1.0 / fall:.3g} s. Give the motion at a step of at most {LONGEST_FALL / fall:.3g} s."
        )
        raise InputError(message)
    fastest = max(contact.fastest, rocking.fastest)
    halvings = max(0, math.ceil(math.log2(max(fastest * dt, 1.0))))  # then no mode turns by more than one radian
    steps: Array = dt * 0.5 ** np.arange(halvings + 1, dtype=np.float64)
    sag, swing, ripple = zip(*(_bounds(basis, steps) for basis in (contact, rocking)), strict=True)
    return System(
        physics=physics,
        plain_rows=plain_rows,
        basis=np.ascontiguousarray(np.stack((contact.basis.T, rocking.basis.T))),
        inverse=np.ascontiguousarray(np.stack((contact.inverse.T, rocking.inverse.T))),
        forced=np.stack((contact.forced, rocking.forced)),
        rows=np.stack((contact.rows, rocking.rows)),
        row_forcing=np.stack((contact.row_forcing, rocking.row_forcing)),
        slope_rows=np.stack((contact.rows @ contact.matrix, rocking.rows @ rocking.matrix)),
        blocks=np.stack((_blocks(contact, steps), _blocks(rocking, steps))),
        dense=np.stack([expm(rocking.matrix * h) for h in steps]) if rocking.dense else NONE,
        sag=np.stack(sag),
        swing=np.stack(swing),
        ripple=np.stack(ripple),
        steps=steps,
        hold=_pair_norm(contact.rows),
        order=_series_order(fastest * float(steps[-1])),
    )


def _series_order(turn: float) -> int:
    """Order at which a series that starts at t³, as at an uplift, has converged for a mode that turns by `turn`."""
    order, term = 3, 1.0
    while term > 1e-17:
        order += 1
        term *= turn / order
    return order


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


def _bounds(basis: Basis, steps: Array) -> tuple[Array, Array, Array]:
    """Sag, swing and ripple of every row over every step, (J + 1, F, K) each."""
    if basis.dense:
        return _dense_bounds(basis, steps)
    h = steps[:, None, None]
    growth = np.exp(np.maximum(basis.roots.real.max(axis=1), 0.0) * h)
    first = basis.rows @ basis.matrix
    second = first @ basis.matrix
    third = second @ basis.matrix
    fourth = third @ basis.matrix
    sag = np.minimum(_pair_norm(second) * h**2 / 8.0, 2.0 * _pair_norm(basis.rows)) * growth
    swing = np.minimum(_pair_norm(third) * h**2 / 8.0, 2.0 * _pair_norm(first)) * growth
    return sag, swing, _pair_norm(fourth) * h**4 / 384.0 * growth


def _dense_bounds(basis: Basis, steps: Array) -> tuple[Array, Array, Array]:
    """The same from |row B² exp(B t)| on the finest grid, and a norm bound between its points."""
    finest, between = expm(basis.matrix * steps[-1]), expm(np.abs(basis.matrix) * steps[-1])
    second = basis.rows @ basis.matrix @ basis.matrix
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
    """Coordinates after steps of any length, one a row of `w` (n, 2K)."""
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
