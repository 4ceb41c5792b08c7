"""Checks of the mass matrix, the stiffness matrix and the heights of a structure."""

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    check_all_positive,
    checked_finite_matrix,
    checked_finite_vector,
    number_of_dimensions,
)
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow

# Asymmetry due to condensation or printed digits, relative to the largest entry.
_SYMMETRY_TOLERANCE = 1e-9


def checked_heights(heights: ArrayLike) -> Array:
    """Return the heights of the masses above the base (N,) in m, read-only: positive, strictly increasing."""
    h = checked_finite_vector("heights", heights, "m")
    if h.size == 0:
        raise InputError("heights must contain at least one height in m, but none was given.", field="heights")
    if h[0] <= 0.0:
        raise InputError(
            f"heights must be positive, in m above the base, but heights[0] = {h[0]:g} was given. "
            "A mass at the base belongs to base_mass.",
            field="heights",
        )
    falls = np.flatnonzero(h[1:] <= h[:-1])
    if falls.size:
        i = int(falls[0])
        raise InputError(
            f"heights must increase from the base to the top, but heights[{i + 1}] = {h[i + 1]:g} m is not above "
            f"heights[{i}] = {h[i]:g} m. Sort the masses by height, with the rows and columns of the "
            "matrices, and combine masses at equal height.",
            field="heights",
        )
    return h


def checked_mass(mass: ArrayLike, size: int, *, field: str = "mass") -> Array:
    """Return the masses (N,) or the mass matrix (N, N) in kg, read-only: positive (definite).

    `field` is the name of the argument.
    """
    if number_of_dimensions(mass) == 2:
        return _symmetric_positive_definite("mass", mass, "kg", size, field)
    m = checked_finite_vector("mass", mass, "kg", field=field)
    if m.size != size:
        raise InputError(
            f"mass must contain one mass for each of the {size} heights, but {m.size} were given. "
            "Give the mass of the base as base_mass.",
            field=field,
        )
    check_all_positive("mass", m, "kg", "Condense massless floors out of the stiffness matrix first.", field=field)
    return m


def checked_stiffness(stiffness: ArrayLike, size: int) -> Array:
    """Return the stiffness matrix (N, N) in N/m, read-only: symmetric and positive definite."""
    return _symmetric_positive_definite("stiffness", stiffness, "N/m", size, "stiffness")


def mass_times(mass: Array, vectors: Array) -> Array:
    """Return M x for a diagonal (N,) or full (N, N) mass, and x of shape (N,) or (N, n)."""
    if mass.ndim == 2:
        return mass @ vectors
    return (mass * vectors.T).T


@explaining_overflow("Whether a matrix is positive definite")
def _symmetric_positive_definite(name: str, values: ArrayLike, unit: str, size: int, field: str) -> Array:
    matrix = checked_finite_matrix(name, values, unit, (size, size), field=field)
    asymmetry = np.abs(matrix - matrix.T)
    if asymmetry.max() > _SYMMETRY_TOLERANCE * np.abs(matrix).max():
        i, j = sorted(int(k) for k in np.unravel_index(np.argmax(asymmetry), asymmetry.shape))
        raise InputError(
            f"{name} must be symmetric, but {name}[{i}, {j}] = {matrix[i, j]:.9g} and "
            f"{name}[{j}, {i}] = {matrix[j, i]:.9g} {unit}. "
            "Check the assembly; an asymmetric result of condensation indicates an error.",
            field=field,
        )
    matrix = 0.5 * (matrix + matrix.T)
    eigenvalues = np.linalg.eigvalsh(matrix)
    # Below this fraction of the largest eigenvalue, the sign of the smallest is due to rounding.
    if eigenvalues[0] <= size * np.finfo(float).eps * abs(eigenvalues[-1]):
        raise InputError(
            f"{name} must be positive definite, but its smallest eigenvalue is {eigenvalues[0]:.3g} {unit} "
            f"(the largest is {eigenvalues[-1]:.3g}). {_MEND[name]}",
            field=field,
        )
    matrix.setflags(write=False)
    return matrix


_MEND = {
    "stiffness": "Fix the structure at its base, and leave out unrestrained degrees of freedom.",
    "mass": "Condense massless degrees of freedom out of both matrices first.",
}
