"""Uncoupling a phase: coordinates in which its exact propagator is block diagonal.

Contact is uncoupled as it stands (Eq. 15): each mode in its energy coordinates (D, D'/ω), whose norm never grows,
at any damping ratio. Rocking (Eq. 23) is not classically damped: its complex eigenvectors, taken as real pairs,
uncouple it; where they are (nearly) defective the phase stays dense. The pair of real roots p₁ > 0 > p₂, by which the
base falls, is taken as a position and a speed: a sloping acceleration displaces its eigenvectors by a'/p³ each, in
opposite directions, which would drown a small rotation.
"""

import math
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


def rocking_basis(physics: Physics, accelerations: Array, rows: Array) -> Basis:
    """Uncoupled coordinates of rocking; rows over state, a and s: `accelerations` D'' and θ'' (Eq. 23), `rows` any."""
    order = _positions_and_speeds(physics.omega2.size)
    matrix, by_acceleration, by_side = _first_order(accelerations, order)
    scale = _energy_scale(physics)[order]
    scaled = matrix * (scale[:, None] / scale)
    values, vectors = np.linalg.eig(scaled)
    columns, pairs, roots = _real_pairs(values, vectors)
    _to_position_and_speed(columns, pairs, roots)
    try:
        inverse = np.linalg.inv(columns)
        condition = float(np.abs(columns).sum(axis=0).max() * np.abs(inverse).sum(axis=0).max())
    except (np.linalg.LinAlgError, FloatingPointError):
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


def _first_order(accelerations: Array, order: NDArray[np.intp]) -> tuple[Array, Array, Array]:
    """Eq. 23 as y' = A y + f a + g s with y = [D, θ, D', θ'], from the rows of D'' and θ''."""
    half = accelerations.shape[0]
    matrix = np.zeros((2 * half, 2 * half))
    matrix[:half, half:] = np.eye(half)
    matrix[half:] = accelerations[:, order]
    rest = np.zeros((2 * half, 2))
    rest[half:] = accelerations[:, -2:]
    return matrix, rest[:, 0], rest[:, 1]


def _positions_and_speeds(n: int) -> NDArray[np.intp]:
    """Places of [D, θ, D', θ'] in the state [D, D', θ, θ']."""
    return np.concatenate((np.arange(n), [2 * n], np.arange(n, 2 * n), [2 * n + 1])).astype(np.intp)


def _energy_scale(physics: Physics) -> Array:
    """Factors that turn the state into square roots of energies, in which the eigenvectors are nearly orthogonal."""
    speed = np.sqrt(physics.mass)
    spin = math.sqrt(physics.inertia)
    omega = np.sqrt(physics.omega2)
    slowest = omega[0] if omega.size else math.sqrt(abs(physics.gravity) / physics.inertia)
    return np.concatenate((speed * omega, speed, [spin * slowest, spin]))


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


def _to_position_and_speed(columns: Array, pairs: Array, roots: Complex) -> None:
    """Replace the eigenvectors of the roots p₁ > 0 > p₂ by q and y: q' = p y, y' = p q + (p₁ + p₂) y, p² = -p₁ p₂."""
    pair = int(np.argmax(roots[:, 0].real))
    one, two = roots[pair].real
    if not one > 0.0 > two:
        return
    p = math.sqrt(-one * two)
    count = pairs.shape[0]
    half = columns.shape[0] // 2 - 1  # the place of θ
    first, second = (columns[:, k] / columns[half, k] for k in (pair, count + pair))
    place = (one * second - two * first) / (one - two)
    speed = p * (first - second) / (one - two)
    # For θ = 1 the modes of a narrow base move far: both take the size of the other columns, by a power of two.
    size = 0.5 ** math.frexp(max(float(np.linalg.norm(place)), float(np.linalg.norm(speed))))[1]
    columns[:, pair], columns[:, count + pair] = size * place, size * speed
    pairs[pair] = [[0.0, p], [p, one + two]]


def _block_diagonal(pairs: Array) -> Array:
    count = pairs.shape[0]
    k = np.arange(count)
    matrix = np.zeros((2 * count, 2 * count))
    matrix[k, k] = pairs[:, 0, 0]
    matrix[k, count + k] = pairs[:, 0, 1]
    matrix[count + k, k] = pairs[:, 1, 0]
    matrix[count + k, count + k] = pairs[:, 1, 1]
    return matrix
