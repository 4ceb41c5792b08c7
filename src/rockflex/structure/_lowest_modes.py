"""Lowest modes of a statically determinate beam with arbitrary masses."""

import math
from collections.abc import Callable

import numpy as np
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import ArpackError, ArpackNoConvergence, LinearOperator, eigsh, splu

from rockflex._arrays import Array

_MISFIT = 1e-6
_SPREAD = 1e6  # of ω² in one search: rounding in the lowest mode then leaves ten digits of the highest
_RESTARTS = 100  # modes of a light beam that are below the rounding of a heavy body never converge
_REMOVALS = 4  # each leaves 1e-16 of the removed part: enough for any beam that `finite_element_modes` accepts


def lowest_modes(root: csc_array, mass: csc_array, height: float, n_modes: int) -> tuple[Array, Array]:
    """Return ω (n,) and mass-normalised shapes (F, n) of the lowest modes, from the stiffness A^T A and the mass.

    `root` is A (F, F); the degrees of freedom are alternating deflections and rotations, from the base up.

    Raises
    ------
    LinAlgError
        If A is singular, or a mode does not satisfy its equation.
    """
    # Scaled by height, stiffness and mass of the beam, so that the given units do not matter.
    unit = diags_array(np.tile([1.0, 1.0 / height], mass.shape[0] // 2))
    root, mass = csc_array(root @ unit), csc_array(unit @ mass @ unit)
    stiff, heavy = float(abs(root).max()), float(mass.diagonal().max())
    root, mass = csc_array(root / stiff), csc_array(mass / heavy)
    try:
        upper, lower = splu(root), splu(csc_array(root.T))
    except RuntimeError as error:
        raise np.linalg.LinAlgError(str(error)) from error

    def flexibility(force: Array) -> Array:
        return upper.solve(lower.solve(np.ravel(force)))

    stiffness = csc_array(root.T @ root)
    vectors = np.empty((mass.shape[0], 0))
    while vectors.shape[1] < n_modes:
        further = _beside(vectors, stiffness, mass, flexibility, n_modes - vectors.shape[1])
        vectors = np.column_stack([vectors, further])
    omega = np.linalg.norm(root @ vectors, axis=0)
    order = np.argsort(omega)
    omega, vectors = omega[order], vectors[:, order]
    moved = mass @ vectors
    bent = np.column_stack([flexibility(force) for force in moved.T])
    misfits = omega**2 * np.einsum("in,in->n", moved, bent) - 1.0  # zero for modes, else positive
    if not (misfits < _MISFIT).all():
        raise np.linalg.LinAlgError(f"a mode has a relative residual of {misfits.max():.1g}")
    return omega * (stiff / math.sqrt(heavy)), unit @ vectors / math.sqrt(heavy)


def _beside(
    known: Array, stiffness: csc_array, mass: csc_array, flexibility: Callable[[Array], Array], wanted: int
) -> Array:
    """Return the lowest modes other than the known ones: as many as wanted, or only the first if they lie far apart.

    A heavy body on a light column gives a first mode so flexible that its rounding error exceeds the flexibility of all
    other modes. These are found afterwards, by removing the first mode from every vector.
    """
    moved = mass @ known

    def without_known(shape: Array) -> Array:
        for _ in range(_REMOVALS):
            shape = shape - known @ (moved.T @ shape)
        return shape

    def bent(force: Array) -> Array:
        force = np.ravel(force)
        for _ in range(_REMOVALS):
            force = force - moved @ (known.T @ force)
        return without_known(flexibility(force))

    size = mass.shape[0]
    inverse = LinearOperator(mass.shape, matvec=bent, dtype=np.float64)
    start = without_known(np.ones(size))  # fixed, for reproducible digits
    directions = min(size - known.shape[1], max(2 * wanted + 1, 20))
    try:
        squares, shapes = eigsh(
            stiffness, k=wanted, M=mass, sigma=0.0, OPinv=inverse, v0=start, ncv=directions, maxiter=_RESTARTS
        )
    except ArpackNoConvergence as error:
        squares, shapes = error.eigenvalues.real, error.eigenvectors.real
    except ArpackError as error:
        raise np.linalg.LinAlgError(str(error)) from error
    lowest = squares[squares > 0.0].min(initial=np.inf)
    if not np.isfinite(lowest):
        raise np.linalg.LinAlgError("no mode was found")
    kept: Array = shapes[:, (squares > 0.0) & (squares <= _SPREAD * lowest)]
    return kept / np.sqrt(np.einsum("in,in->n", kept, np.asarray(mass @ kept)))
