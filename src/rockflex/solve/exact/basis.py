"""Uncoupling a phase: coordinates in which its exact propagator is block diagonal.

Contact is already uncoupled (Eq. 15): each mode has its energy coordinates (D, D'/ω), whose norm never grows,
at any damping ratio. Rocking (Eq. 23) is not classically damped. Its complex eigenvectors, taken as real pairs,
uncouple it; if they are (nearly) defective, the phase is treated as dense. The pair of real roots p₁ > 0 > p₂, which
describes the fall of the base, is represented by a position and a speed. With its eigenvectors, an acceleration of
slope a' would give two displacements of a'/p³ in opposite directions, whose cancellation would hide a small rotation.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Complex
from rockflex.models import Arrow, RockingModel

WORST_CONDITION = 1e5  # of the eigenvectors in energy scale: beyond it five digits are lost


@dataclass(frozen=True, slots=True, eq=False)
class Basis:
    """The part of a phase that depends neither on the time step nor on rows: x' = B x + ..., state = basis · x."""

    basis: Array  # (2K, 2K), K = N + b; coordinates k and K + k form pair k
    inverse: Array  # (2K, 2K)
    matrix: Array  # (2K, 2K): B; block diagonal in the pairs unless `dense`
    pairs: Array  # (K, 2, 2): the blocks of B
    roots: Complex  # (K, 2): their eigenvalues, the one with the larger real part first
    steady: Array  # (3 + M, 2K): coefficients of a, a', 1 and the memories in the forced solution, as states
    dense: bool
    fastest: float  # largest eigenvalue magnitude, rad/s
    moving: int  # number of pairs that may move; the others come last


class Drift(NamedTuple):
    """A phase in which some freedom of the base has no stiffness: it is carried by power series only."""

    roots: Complex  # (2K,): eigenvalues, rad/s

    @property
    def fastest(self) -> float:
        """Largest eigenvalue magnitude, rad/s."""
        return float(np.abs(self.roots).max())


def drift_of(model: RockingModel, arrow: Arrow, accelerations: Array) -> Drift:
    """Return what the power series of a phase need to know; `accelerations` as in `basis_of`."""
    matrix, _, _ = _first_order(accelerations, model.layout.freedoms)
    scale = _energy_scale(model.properties.effective_mass, model.properties.omega**2, arrow)
    scale = scale[_positions_and_speeds(accelerations.shape[0], model.layout.freedoms)]
    return Drift(np.linalg.eigvals(matrix * (scale[:, None] / scale)).astype(np.complex128))


def basis_of(model: RockingModel, arrow: Arrow, accelerations: Array) -> Basis:
    """Return the uncoupled coordinates of a phase; `accelerations`: rows of D'' and q'', shape (K, 2K + 2)."""
    p = model.properties
    omega2, damping = p.omega**2, 2.0 * p.zeta * p.omega
    if not arrow.free:
        return _contact_basis(omega2, damping, accelerations.shape[0])
    scale = _energy_scale(p.effective_mass, omega2, arrow)
    if arrow.freed.all():
        return _rocking_basis(accelerations, scale, arrow.freed.size)
    return _with_held(accelerations, scale, arrow)


def with_constant(known: Basis, arrow: Arrow) -> Basis:
    """Return the basis of a phase whose arrow differs from a known one only in constant forces and memories."""
    steady = np.zeros((3 + arrow.recall.shape[1], known.steady.shape[1]))
    steady[:2] = known.steady[:2]
    if not arrow.free:
        return replace(known, steady=steady)
    modes = known.steady.shape[1] // 2 - arrow.constant.size
    # At rest the modes are zero, and the stiffness of the base balances the constant forces.
    free = np.flatnonzero(arrow.freed)
    forces = np.column_stack((arrow.constant, arrow.recall))[free]
    steady[2:, 2 * (modes + free)] = np.linalg.solve(arrow.stiffness[np.ix_(free, free)], forces).T
    return replace(known, steady=steady)


def _with_held(accelerations: Array, energy_scale: Array, arrow: Arrow) -> Basis:
    """Return the uncoupled coordinates of a base with some freedoms held; their pairs come last and do not move."""
    count, b = accelerations.shape[0], arrow.freed.size
    modes, free, held = count - b, np.flatnonzero(arrow.freed), np.flatnonzero(~arrow.freed)
    kept = np.concatenate((np.arange(2 * modes), np.sort(np.concatenate((2 * (modes + free), 2 * (modes + free) + 1)))))
    rows = np.concatenate((np.arange(modes), modes + free))
    part = _rocking_basis(accelerations[rows][:, [*kept, -2, -1]], energy_scale[kept], free.size)
    moving = part.moving
    pairs, roots = np.zeros((count, 2, 2)), np.zeros((count, 2), dtype=np.complex128)
    pairs[:moving], roots[:moving] = part.pairs, part.roots
    columns = np.concatenate((np.arange(moving), count + np.arange(moving)))
    basis, inverse, matrix = (np.zeros((2 * count, 2 * count)) for _ in range(3))
    basis[np.ix_(kept, columns)], inverse[np.ix_(columns, kept)] = part.basis, part.inverse
    matrix[np.ix_(columns, columns)] = part.matrix
    for k, j in enumerate(held):
        for speed in range(2):
            place, column = 2 * (modes + j) + speed, moving + k + speed * count
            basis[place, column] = inverse[column, place] = 1.0
    steady = np.zeros((3, 2 * count))
    steady[:, kept] = part.steady
    return Basis(basis, inverse, matrix, pairs, roots, steady, part.dense, part.fastest, moving)


def _contact_basis(omega2: Array, damping: Array, pairs_in_all: int) -> Basis:
    """Return the uncoupled coordinates of a base at rest (Eq. 15); the last pairs are its rotation and θ' = 0."""
    n, count = omega2.size, pairs_in_all
    omega = np.sqrt(omega2)
    modes = np.arange(n)
    speeds = modes + count  # the second coordinate of each pair
    pairs = np.zeros((count, 2, 2))
    pairs[:n, 0, 1] = omega
    pairs[:n, 1, 0] = -omega
    pairs[:n, 1, 1] = -damping
    half = -0.5 * damping + 0j
    spread = np.sqrt(half * half - omega2)
    roots = np.zeros((count, 2), dtype=np.complex128)
    roots[:n, 0] = half + spread
    roots[:n, 1] = half - spread
    basis = np.zeros((2 * count, 2 * count))
    basis[modes, modes] = 1.0
    basis[n + modes, speeds] = omega
    places = np.arange(n, count)
    base = 2 * places  # index of the position in the state
    basis[base, places] = basis[base + 1, places + count] = 1.0
    inverse = np.zeros((2 * count, 2 * count))
    inverse[modes, modes] = 1.0
    inverse[speeds, n + modes] = 1.0 / omega
    inverse[places, base] = inverse[places + count, base + 1] = 1.0
    steady = np.zeros((3, 2 * count))
    steady[0, :n] = -1.0 / omega2
    steady[1, :n] = damping / omega2**2
    steady[1, n : 2 * n] = steady[0, :n]
    return replace(_basis(basis, inverse, pairs, roots, steady), moving=n)


def _rocking_basis(accelerations: Array, energy_scale: Array, freedoms: int) -> Basis:
    """Return the uncoupled coordinates of rocking (Eq. 23), or of another motion of the base with its freedoms."""
    order = _positions_and_speeds(accelerations.shape[0], freedoms)
    matrix, by_acceleration, constant = _first_order(accelerations, freedoms)
    scale = energy_scale[order]
    scaled = matrix * (scale[:, None] / scale)
    values, vectors = np.linalg.eig(scaled)
    columns, pairs, roots = _real_pairs(values, vectors)
    _to_position_and_speed(columns, pairs, roots, accelerations.shape[0] - freedoms)
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
    steady = np.zeros((3, size))
    found = -np.linalg.solve(matrix, np.stack((by_acceleration, constant), axis=1))
    steady[0, order] = found[:, 0]
    steady[1, order] = np.linalg.solve(matrix, found[:, 0])
    steady[2, order] = found[:, 1]
    return _basis(basis, back, pairs, roots, steady, scaled if dense else None)


def _basis(
    basis: Array, inverse: Array, pairs: Array, roots: Complex, steady: Array, dense: Array | None = None
) -> Basis:
    return Basis(
        basis=basis,
        inverse=inverse,
        matrix=_block_diagonal(pairs) if dense is None else dense,
        pairs=pairs,
        roots=roots,
        steady=steady,
        dense=dense is not None,
        fastest=float(np.abs(roots).max()),
        moving=pairs.shape[0],
    )


def _first_order(accelerations: Array, freedoms: int) -> tuple[Array, Array, Array]:
    """Return Eq. 23 as y' = A y + f a + g with y = [D, q, D', q'], from the rows of D'' and q''."""
    half = accelerations.shape[0]
    order = _positions_and_speeds(half, freedoms)
    matrix = np.zeros((2 * half, 2 * half))
    matrix[:half, half:] = np.eye(half)
    matrix[half:] = accelerations[:, order]
    rest = np.zeros((2 * half, 2))
    rest[half:] = accelerations[:, -2:]
    return matrix, rest[:, 0], rest[:, 1]


def _positions_and_speeds(pairs: int, freedoms: int) -> NDArray[np.intp]:
    """Return the indices of [D, q, D', q'] in the state [D, D', q_1, q'_1, ..]."""
    n, base = pairs - freedoms, 2 * np.arange(freedoms)
    modes = np.arange(n)
    return np.concatenate((modes, 2 * n + base, n + modes, 2 * n + base + 1)).astype(np.intp)


def _energy_scale(mass: Array, omega2: Array, arrow: Arrow) -> Array:
    """Return factors that scale the state to square roots of energies, which makes eigenvectors nearly orthogonal."""
    speed, omega = np.sqrt(mass), np.sqrt(omega2)
    free = np.diag(arrow.flexibility) > 0.0
    spin = 1.0 / np.sqrt(np.where(free, np.diag(arrow.flexibility), 1.0))
    stiffness = np.where(free, np.abs(np.diag(arrow.stiffness)), 1.0)
    slowest = np.full(spin.size, omega[0]) if omega.size else np.sqrt(np.where(stiffness > 0.0, stiffness, 1.0)) / spin
    return np.concatenate((speed * omega, speed, np.column_stack((spin * slowest, spin)).ravel()))


def _real_pairs(values: Complex, vectors: Complex) -> tuple[Array, Array, Complex]:
    """Return real column pairs, their 2 x 2 blocks and eigenvalues, from the eigenpairs of a real matrix."""
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


def _to_position_and_speed(columns: Array, pairs: Array, roots: Complex, rotation: int) -> None:
    """Replace the eigenvectors of the roots p₁ > 0 > p₂ by q and y: q' = p y, y' = p q + (p₁ + p₂) y, p² = -p₁ p₂."""
    pair = int(np.argmax(roots[:, 0].real))
    one, two = roots[pair].real
    if not one > 0.0 > two:
        return
    p = math.sqrt(-one * two)
    count = pairs.shape[0]
    first, second = (columns[:, k] / columns[rotation, k] for k in (pair, count + pair))
    place = (one * second - two * first) / (one - two)
    speed = p * (first - second) / (one - two)
    # For θ = 1 the modes of a narrow base are large: scale both to the size of the other columns, by a power of two.
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
