"""Damping of the vibration about one pivot, from complex eigenvalues."""

import numpy as np

from rockflex._arrays import Array


def uplifted_damping(squares: Array, damping: Array) -> Array:
    """Return ζ* (n,) of the vibrations of q'' + C q' + Λ q = 0, without the rotation.

    Parameters
    ----------
    squares : ndarray, shape (n + 1,)
        Λ: the eigenvalues ω² of the undamped system in rad²/s², in ascending order; the first is the rotation.
    damping : ndarray, shape (n + 1, n + 1)
        C in 1/s, in the undamped modes with unit modal mass; symmetric, positive semidefinite.

    Notes
    -----
    The roots λ come in pairs: two conjugates, or two real roots of an overdamped motion (if there are more, the slowest
    is paired with the fastest). The pair of the rotation is the growing root and the slowest decaying real root;
    without a growing root, it is the pair with the smallest product. The other pairs are sorted by √(λ_a λ_b), which is
    ω* without damping, and have ζ* = -(λ_a + λ_b)/(2 √(λ_a λ_b)).
    """
    size = squares.size
    # Displacements are scaled by ω: without damping the matrix is then skew-symmetric except for the rotation, and so
    # well conditioned.
    scale = np.sqrt(np.abs(squares))
    scale[scale == 0.0] = 1.0
    matrix = np.zeros((2 * size, 2 * size))
    matrix[:size, size:] = np.diag(scale)
    matrix[size:, :size] = np.diag(-squares / scale)
    matrix[size:, size:] = -damping
    roots = np.linalg.eigvals(matrix)
    turning = roots[roots.imag > 0.0]
    still = roots.real[roots.imag == 0.0]
    still = still[np.argsort(np.abs(still))]
    grows = bool(squares[0] < 0.0)
    if grows:
        still = np.delete(still, np.argmax(still))[1:]
    slow, fast = still[: still.size // 2], still[::-1][: still.size // 2]
    total = np.concatenate([2.0 * turning.real, slow + fast])
    product = np.concatenate([np.abs(turning) ** 2, np.abs(slow * fast)])
    order = np.argsort(product)[0 if grows else 1 :]
    return -total[order] / (2.0 * np.sqrt(product[order]))
