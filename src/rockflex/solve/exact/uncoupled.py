"""Uncoupling in kernels: real pairs of coordinates from eigenvectors, as `basis` describes them."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex.solve.exact.basis import WORST_CONDITION
from rockflex.solve.exact.eigen import Eigen, eigen_of


class Pairs(NamedTuple):
    """The coordinates of one phase with K pairs, S = 2 K: coordinates k and K + k form pair k."""

    eigen: Eigen
    scale: Array  # (S,): of the state, to square roots of energies
    places: NDArray[np.int64]  # (S,): indices in the state of positions, then of speeds
    columns: Array  # (S, S): the eigenvectors as real columns; positions first, then speeds
    inverse: Array  # (S, S)
    used: Array  # (2, S): work arrays
    blocks: Array  # (K, 4): B, row by row
    roots: Array  # (K, 4): real and imaginary part of both eigenvalues, the one with the larger real part first


def pairs_of(size: int, scale: Array, places: NDArray[np.int64]) -> Pairs:
    """Return the arrays for a phase with `size` coordinates."""
    squares = np.empty((2, size, size))
    halves = np.zeros((2, size // 2, 4))
    return Pairs(eigen_of(size), scale, places, squares[0], squares[1], np.empty((2, size)), halves[0], halves[1])


@kernel
def uncouple(pairs: Pairs, rotation: int) -> bool:
    """Find the coordinates of the matrix in `pairs.eigen`, in energy scale; False if they cannot be told apart.

    `rotation` is the place of the rotation among the positions.
    """
    if not find_pairs(pairs):
        return False
    to_position_and_speed(pairs, rotation)
    return inverted(pairs)


@kernel
def find_pairs(pairs: Pairs) -> bool:
    """Enter the eigenvectors as real columns: those of complex pairs first, then the real ones, the largest first."""
    from_solver = pairs.eigen
    size = from_solver.real.size
    half, k = size // 2, 0
    real, imaginary = from_solver.real, from_solver.imaginary
    for j in range(size):
        if imaginary[j] > 0.0:
            for i in range(size):
                pairs.columns[i, k] = from_solver.vectors[j, i]
                pairs.columns[i, half + k] = from_solver.vectors[j + 1, i]
            enter(pairs, k, real[j], imaginary[j], -imaginary[j], real[j])
            enter_roots(pairs, k, real[j], imaginary[j], real[j], -imaginary[j])
            k += 1
    last = math.inf
    while k < half:
        for turn in range(2):
            largest = -1
            for j in range(size):
                fits = imaginary[j] == 0.0 and not math.isnan(real[j])
                if fits and (largest < 0 or real[j] > real[largest]):
                    largest = j
            if largest < 0:
                return False
            column = k + turn * half
            for i in range(size):
                pairs.columns[i, column] = from_solver.vectors[largest, i]
            if turn == 1:
                enter(pairs, k, last, 0.0, 0.0, real[largest])
                enter_roots(pairs, k, last, 0.0, real[largest], 0.0)
            last = real[largest]
            real[largest] = math.nan  # taken
        k += 1
    return True


@kernel
def enter(pairs: Pairs, k: int, a: float, b: float, c: float, d: float) -> None:
    """Enter the block of one pair."""
    block = pairs.blocks[k]
    block[0], block[1], block[2], block[3] = a, b, c, d


@kernel
def enter_roots(pairs: Pairs, k: int, first: float, turn: float, second: float, back: float) -> None:
    """Enter the eigenvalues of one pair."""
    roots = pairs.roots[k]
    roots[0], roots[1], roots[2], roots[3] = first, turn, second, back


@kernel
def to_position_and_speed(pairs: Pairs, rotation: int) -> None:
    """Replace the eigenvectors of the roots p₁ > 0 > p₂ by q and y: q' = p y, y' = p q + (p₁ + p₂) y, p² = -p₁ p₂."""
    half, pair, columns = pairs.roots.shape[0], 0, pairs.columns
    for k in range(half):
        if pairs.roots[k, 0] > pairs.roots[pair, 0]:
            pair = k
    one, two = pairs.roots[pair, 0], pairs.roots[pair, 2]
    if not one > 0.0 > two:
        return
    p, a, b = math.sqrt(-one * two), columns[rotation, pair], columns[rotation, half + pair]
    places = speeds = 0.0
    for i in range(2 * half):
        first, second = columns[i, pair] / a, columns[i, half + pair] / b
        place, speed = (one * second - two * first) / (one - two), p * (first - second) / (one - two)
        columns[i, pair], columns[i, half + pair] = place, speed
        places += place * place
        speeds += speed * speed
    # For θ = 1 the modes of a narrow base are large: scale both to the size of the other columns, by a power of two.
    size = 0.5 ** math.frexp(math.sqrt(max(places, speeds)))[1]
    for i in range(2 * half):
        columns[i, pair] *= size
        columns[i, half + pair] *= size
    enter(pairs, pair, 0.0, p, p, one + two)


@kernel
def inverted(pairs: Pairs) -> bool:
    """Enter the inverse of the columns, by Gauss-Jordan elimination; False if their condition is bad."""
    inverse, size = pairs.inverse, pairs.columns.shape[0]
    rest = pairs.eigen.matrix  # no longer needed
    for i in range(size):
        for j in range(size):
            rest[i, j] = pairs.columns[i, j]
            inverse[i, j] = 1.0 if i == j else 0.0
    for j in range(size):
        pivot = j
        for i in range(j + 1, size):
            if abs(rest[i, j]) > abs(rest[pivot, j]):
                pivot = i
        if not abs(rest[pivot, j]) > 0.0:
            return False
        if pivot != j:
            for c in range(size):
                rest[pivot, c], rest[j, c] = rest[j, c], rest[pivot, c]
                inverse[pivot, c], inverse[j, c] = inverse[j, c], inverse[pivot, c]
        factor = 1.0 / rest[j, j]
        for c in range(size):
            rest[j, c] *= factor
            inverse[j, c] *= factor
        for i in range(size):
            factor = rest[i, j]
            if i != j and factor != 0.0:
                for c in range(size):
                    rest[i, c] -= factor * rest[j, c]
                    inverse[i, c] -= factor * inverse[j, c]
    return widest(pairs.columns) * widest(inverse) <= WORST_CONDITION


@kernel
def widest(matrix: Array) -> float:
    """Return the 1-norm of a matrix."""
    largest = 0.0
    for j in range(matrix.shape[1]):
        total = 0.0
        for i in range(matrix.shape[0]):
            total += abs(matrix[i, j])
        if not total <= largest:
            largest = total
    return largest
