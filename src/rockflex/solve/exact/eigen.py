"""The eigenvectors of a small real matrix in kernels, by LAPACK."""

import ctypes
from collections.abc import Callable
from functools import cache
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex._numba import address_in_cython

_DGEEV = ctypes.CFUNCTYPE(None, *[ctypes.c_size_t] * 14)
ROOM = 34  # doubles of work a row: enough for the fastest of LAPACK's methods

Solver = Callable[..., None]  # dgeev, with the addresses of its arguments


class Eigen(NamedTuple):
    """The arguments of dgeev, for matrices with S rows."""

    solver: Solver
    letters: NDArray[np.uint8]  # (2,): no left and all right eigenvectors
    sizes: NDArray[np.int32]  # (4,): S, 1, the size of the work array, and the outcome
    matrix: Array  # (S, S): transposed; destroyed
    real: Array  # (S,): real parts of the eigenvalues
    imaginary: Array  # (S,)
    vectors: Array  # (S, S): transposed: one row for each vector, or real and imaginary part of a pair in two
    work: Array


@cache
def solver() -> Solver:
    """Return LAPACK's dgeev as a function that kernels can call."""
    return cast("Solver", _DGEEV(address_in_cython("scipy.linalg.cython_lapack", "dgeev")))


def eigen_of(size: int) -> Eigen:
    """Return the arguments for matrices with `size` rows."""
    return Eigen(
        solver=solver(),
        letters=np.array([ord("N"), ord("V")], dtype=np.uint8),
        sizes=np.array([size, 1, ROOM * size, 0], dtype=np.int32),
        matrix=np.empty((size, size)),
        real=np.empty(size),
        imaginary=np.empty(size),
        vectors=np.empty((size, size)),
        work=np.empty(ROOM * size),
    )


@kernel
def find_eigenvectors(eigen: Eigen) -> bool:
    """Replace eigenvalues and eigenvectors by those of `eigen.matrix`; return whether they were found."""
    letters, sizes = eigen.letters.ctypes.data, eigen.sizes.ctypes.data
    vectors = eigen.vectors.ctypes.data
    eigen.solver(
        letters,
        letters + 1,
        sizes,
        eigen.matrix.ctypes.data,
        sizes,
        eigen.real.ctypes.data,
        eigen.imaginary.ctypes.data,
        vectors,
        sizes + 4,
        vectors,
        sizes,
        eigen.work.ctypes.data,
        sizes + 8,
        sizes + 12,
    )
    return bool(eigen.sizes[3] == 0)
