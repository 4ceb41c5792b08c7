"""Uncoupling a phase: coordinates in which its exact propagator is block diagonal.

Contact is uncoupled as it stands (Eq. 15): each mode in its energy coordinates (D, D'/ω), whose norm never grows,
at any damping ratio. Rocking (Eq. 23) is not classically damped: its complex eigenvectors, taken as real pairs,
uncouple it; where they are (nearly) defective the phase stays dense.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockflex.solve.exact.layout import Array, Physics

__all__ = ["Basis", "contact_basis", "rocking_basis"]

WORST_CONDITION = 1e5  # of the eigenvectors in energy scale: beyond it five digits are lost

Complex = NDArray[np.complex128]


@dataclass(frozen=True, slots=True, eq=False)
class Basis:
    """Everything of a phase that does not depend on the time step: x' = B x + ..., state = basis · x."""

    basis: Array  # (2K, 2K), K = N + 1; coordinates k and K + k form pair k
    inverse: Array  # (2K, 2K)
    matrix: Array  # (2K, 2K): B; block diagonal in the pairs unless `dense`
    pairs: Array  # (K, 2, 2): the blocks of B
    roots: Complex  # (K, 2): their eigenvalues, the one with the larger real part first
    forced: Array  # (3, 2K): the forced solution's coefficients of a, a', s
    rows: Array  # (F, 2K)
    row_forcing: Array  # (F, 3): of a, a', s
    dense: bool
    fastest: float  # largest eigenvalue magnitude, rad/s


def contact_basis(physics: Physics, rows: Array) -> Basis:
    """Uncoupled coordinates of full contact (Eq. 15), the last pair empty; `rows` (F, 2N + 4) over state, a and s."""
    n = physics.omega2.size
    omega = np.sqrt(physics.omega2)
    modes = np.arange(n)
    speeds = modes + n + 1  # the second coordinate of each pair
    pairs = np.zeros((n + 1, 2, 2))
    pairs[:n, 0, 1] = omega
    pairs[:n, 1, 0] = -omega
    pairs[:n, 1, 1] = -physics.damping
    half = -0.5 * physics.damping + 0j
    spread = np.sqrt(half * half - physics.omega2)
    roots = np.zeros((n + 1, 2), dtype=np.complex128)
    roots[:n, 0] = half + spread
    roots[:n, 1] = half - spread
    basis = np.zeros((2 * n + 2, 2 * n + 2))
    basis[modes, modes] = 1.0
    basis[n + modes, speeds] = omega
    inverse = np.zeros((2 * n + 2, 2 * n + 2))
    inverse[modes, modes] = 1.0
    inverse[speeds, n + modes] = 1.0 / omega
    forced = np.zeros((3, 2 * n + 2))
    forced[0, :n] = -1.0 / physics.omega2
    forced[1, :n] = physics.damping / physics.omega2**2
    forced[1, n : 2 * n] = forced[0, :n]
    return _basis(rows, basis, inverse, pairs, roots, forced)


def rocking_basis(physics: Physics, rows: Array) -> Basis:
    """Uncoupled coordinates of rocking (Eq. 23); `rows` (F, 2N + 4) over state, a and s."""
    order = _positions_and_speeds(physics.omega2.size)
    matrix, by_acceleration, by_side = _first_order(physics)
    scale = _energy_scale(physics)[order]
    scaled = matrix * (scale[:, None] / scale)
    values, vectors = np.linalg.eig(scaled)
    columns, pairs, roots = _real_pairs(values, vectors)
    try:
        inverse = np.linalg.inv(columns)
        condition = float(np.abs(columns).sum(axis=0).max() * np.abs(inverse).sum(axis=0).max())
    except np.linalg.LinAlgError:
        inverse, condition = columns, np.inf
    dense = condition > WORST_CONDITION
    if dense:
        columns = inverse = np.eye(scale.size)
    size = scale.size
    basis = np.empty((size, size))
    basis[order] = columns / scale[:, None]
    back = np.empty((size, size))
    back[:, order] = inverse * scale
    forced = np.zeros((3, size))
    steady = -np.linalg.solve(matrix, np.stack((by_acceleration, by_side), axis=1))
    forced[0, order] = steady[:, 0]
    forced[1, order] = np.linalg.solve(matrix, steady[:, 0])
    forced[2, order] = steady[:, 1]
    return _basis(rows, basis, back, pairs, roots, forced, scaled if dense else None)


def _basis(
    rows: Array,
    basis: Array,
    inverse: Array,
    pairs: Array,
    roots: Complex,
    forced: Array,
    dense: Array | None = None,
) -> Basis:
    size = rows.shape[1] - 2
    forcing = rows[:, :size] @ forced.T
    forcing[:, 0] += rows[:, size]
    forcing[:, 2] += rows[:, size + 1]
    return Basis(
        basis=basis,
        inverse=inverse,
        matrix=_block_diagonal(pairs) if dense is None else dense,
        pairs=pairs,
        roots=roots,
        forced=forced @ inverse.T,
        rows=rows[:, :size] @ basis,
        row_forcing=forcing,
        dense=dense is not None,
        fastest=float(np.abs(roots).max()),
    )


def _first_order(physics: Physics) -> tuple[Array, Array, Array]:
    """Eq. 23 solved for the accelerations: y' = A y + f a + g s with y = [D, θ, D', θ']."""
    n = physics.omega2.size
    by_acceleration = np.zeros(2 * n + 2)
    by_side = np.zeros(2 * n + 2)
    matrix = np.zeros((2 * n + 2, 2 * n + 2))
    matrix[: n + 1, n + 1 :] = np.eye(n + 1)
    angular = np.empty(2 * n + 2)
    arm = physics.mass * physics.height
    angular[:n] = arm * physics.omega2
    angular[n] = physics.gravity
    angular[n + 1 : -1] = arm * physics.damping
    angular[-1] = 0.0
    angular /= physics.inertia
    matrix[n + 1 : -1] = -physics.height[:, None] * angular
    matrix[-1] = angular
    diagonal = np.arange(n)
    matrix[n + 1 + diagonal, diagonal] -= physics.omega2
    matrix[n + 1 + diagonal, n + 1 + diagonal] -= physics.damping
    by_acceleration[-1] = physics.drive_arm / physics.inertia
    by_acceleration[n + 1 : -1] = -1.0 - physics.height * by_acceleration[-1]
    by_side[-1] = -physics.resistance / physics.inertia
    by_side[n + 1 : -1] = -physics.height * by_side[-1]
    return matrix, by_acceleration, by_side


def _positions_and_speeds(n: int) -> NDArray[np.intp]:
    """Places of [D, θ, D', θ'] in the state [D, D', θ, θ']."""
    return np.concatenate((np.arange(n), [2 * n], np.arange(n, 2 * n), [2 * n + 1])).astype(np.intp)


def _energy_scale(physics: Physics) -> Array:
    """Factors that turn the state into square roots of energies, in which the eigenvectors are nearly orthogonal."""
    speed = np.sqrt(physics.mass)
    spin = np.sqrt(physics.inertia)
    omega = np.sqrt(physics.omega2)
    return np.concatenate((speed * omega, speed, [spin * omega[0], spin]))


def _real_pairs(values: Complex, vectors: Complex) -> tuple[Array, Array, Complex]:
    """Real column pairs, their 2 x 2 blocks and eigenvalues, from the eigenpairs of a real matrix."""
    turning = np.flatnonzero(values.imag > 0.0)
    still = np.flatnonzero(values.imag == 0.0)
    still = still[np.argsort(-values.real[still])]
    first, second = still[::2], still[1::2]
    v = vectors[:, turning]
    columns = np.concatenate((v.real, vectors[:, first].real, v.imag, vectors[:, second].real), axis=1)
    t, s = turning.size, first.size
    pairs = np.zeros((t + s, 2, 2))
    lam = values[turning]
    pairs[:t, 0, 0] = pairs[:t, 1, 1] = lam.real
    pairs[:t, 0, 1] = lam.imag
    pairs[:t, 1, 0] = -lam.imag
    pairs[t:, 0, 0] = values.real[first]
    pairs[t:, 1, 1] = values.real[second]
    roots = np.concatenate(
        (np.stack((lam, lam.conj()), axis=1), np.stack((values[first], values[second]), axis=1)), axis=0
    )
    return columns, pairs, roots.astype(np.complex128)


def _block_diagonal(pairs: Array) -> Array:
    count = pairs.shape[0]
    k = np.arange(count)
    matrix = np.zeros((2 * count, 2 * count))
    matrix[k, k] = pairs[:, 0, 0]
    matrix[k, count + k] = pairs[:, 0, 1]
    matrix[count + k, k] = pairs[:, 1, 0]
    matrix[count + k, count + k] = pairs[:, 1, 1]
    return matrix
