"""Structures from the matrices or the modes of any finite element program."""

from collections.abc import Sequence
from dataclasses import replace
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import damping_ratios, dimensions, finite_matrix, finite_vector, positive
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._matrices import checked_mass, checked_stiffness
from rockflex.modal import MassNormalisedModes, modes_that_take_part
from rockflex.structure._freedoms import Freedoms, Heights
from rockflex.structure._matrix_files import Given, numbers
from rockflex.structure._modal_structure import ModalStructure

_ORTHOGONAL = 1e-5  # tolerance for values with few printed digits


def from_matrices(
    mass: Given,
    stiffness: Given,
    heights: Heights,
    *,
    rotations: Sequence[SupportsIndex] = (),
    base_mass: float,
    half_width: float,
    damping_ratio: ArrayLike,
    n_modes: SupportsIndex | None = None,
) -> ModalStructure:
    """Return a structure from its mass and stiffness matrices on a fixed base.

    A unit rotation of the base displaces a horizontal degree of freedom at height h by h, and a rotational one by 1;
    the ground displaces only the horizontal ones. Neither affects the others, such as out-of-plane degrees of freedom
    or vertical ones on the axis. Massless degrees of freedom are condensed out exactly.

    Parameters
    ----------
    mass : array_like (N,) or (N, N), or path
        Masses or mass matrix in kg (kg m² for rotations), excluding the base; rows of zeros are allowed.
    stiffness : array_like (N, N), or path
        Symmetric positive definite stiffness in N/m (N m/rad for rotations).
    heights : array_like (N,), path, or mapping
        Height of each degree of freedom above the base in m, NaN for one that does not translate horizontally, or a
        map ``{index: height}`` of those that do. The highest one with mass is the top.
    rotations : sequence of int
        Indices of the rotations in the plane, which need no height, with the sign of the base rotation: a positive
        rotation displaces the structure above it in the direction of the positive translations.
    base_mass, half_width : float
        Mass m_0 of the base in kg, zero or positive, and its half-width B in m.
    damping_ratio : array_like
        Damping ratio in [0, 1): one number for all modes, or one per retained mode.
    n_modes : int, optional
        Number of modes to retain, the lowest first, not counting modes that are not excited. Default: all.

    Returns
    -------
    ModalStructure
        Its properties include `floors` if no rotation has mass.

    Raises
    ------
    InputError
        If a file cannot be read, the shapes do not match, a matrix is not symmetric positive (definite), or a mode has
        no coordinate D_n.

    Notes
    -----
    Paths end in ``.npz`` (an array with the name of the argument), ``.mtx`` or ``.csv``. The matrices are treated as
    dense. Mass that couples a degree of freedom to the base itself, as consistent mass matrices have in the lowest
    elements, is missing from the matrices of a fixed base: use lumped masses, or short elements at the base.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.from_matrices(
    ...     mass=[20e3, 20e3], stiffness=[[8e6, -4e6], [-4e6, 4e6]], heights=[3.0, 6.0],
    ...     base_mass=20e3, half_width=0.6, damping_ratio=0.02,
    ... )
    >>> structure.modal().period.round(3)
    array([0.719, 0.275])
    """
    k_given = numbers("stiffness", stiffness)
    size = np.shape(k_given)[0] if dimensions(k_given) == 2 else 1
    k = checked_stiffness(k_given, size)
    m_given = numbers("mass", mass)
    m = _mass_matrix(m_given, size)
    freedoms = Freedoms.of(heights, rotations, size)
    keep = np.asarray(m.any(axis=1))
    freedoms = freedoms.kept(keep)
    m = checked_mass(m[np.ix_(keep, keep)], freedoms.size)
    with computable("The modes of the given mass and stiffness matrices"):
        if not keep.all():
            tie = k[np.ix_(keep, ~keep)]
            k = k[np.ix_(keep, keep)] - tie @ np.linalg.solve(k[np.ix_(~keep, ~keep)], tie.T)
            k = 0.5 * (k + k.T)
        modes = freedoms.modes(*_modes(k, m), m)
    return _structure(modes, base_mass, half_width, damping_ratio, n_modes)


def from_modes(
    omega: Given,
    shapes: Given,
    mass: Given,
    heights: Heights,
    *,
    rotations: Sequence[SupportsIndex] = (),
    base_mass: float,
    half_width: float,
    damping_ratio: ArrayLike,
    n_modes: SupportsIndex | None = None,
) -> ModalStructure:
    """Return a structure from its mass and its modes on a fixed base, in any normalisation.

    Parameters
    ----------
    omega : array_like, shape (n,), or path
        Circular frequencies in rad/s, in ascending order.
    shapes : array_like, shape (N, n), or path
        Mode shapes as columns, orthogonal with respect to the mass.
    mass, heights, rotations, base_mass, half_width, damping_ratio, n_modes
        As for `from_matrices`.

    Returns
    -------
    ModalStructure

    Raises
    ------
    InputError
        If a file cannot be read, the shapes do not match, the frequencies are not in ascending order, or two mode
        shapes are not orthogonal.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.from_modes(
    ...     omega=[8.74, 22.88], shapes=[[0.61803, 1.61803], [1.0, -1.0]], mass=[20e3, 20e3], heights=[3.0, 6.0],
    ...     base_mass=20e3, half_width=0.6, damping_ratio=0.02,
    ... )
    >>> structure.modal().effective_mass.round(-1)
    array([37890.,  2110.])
    """
    w = finite_vector("omega", numbers("omega", omega), "rad/s")
    falls = np.flatnonzero(np.diff(w, prepend=0.0) < 0.0)
    if w.size == 0 or w[0] <= 0.0 or falls.size:
        raise InputError(
            f"omega must contain positive frequencies in rad/s in ascending order, but {w} was given. Sort the modes.",
            field="omega",
        )
    given = numbers("shapes", shapes)
    columns = finite_vector("shapes", given, "any unit")[:, None] if dimensions(given) == 1 else given
    size = np.shape(columns)[0] if dimensions(columns) == 2 else 1
    phi = finite_matrix("shapes", columns, "any unit", (size, w.size))
    m = _mass_matrix(numbers("mass", mass), size)
    freedoms = Freedoms.of(heights, rotations, size)
    products = phi.T @ m @ phi
    own = np.diag(products)
    if not (own > 0.0).all():
        i = int(np.argmin(own))
        raise InputError(
            f"Mode shape {i + 1} moves no mass (φ^T M φ = {own[i]:.3g}). Check that both "
            "have the same order of degrees of freedom.",
            field="mass",
        )
    cosines = products / np.sqrt(np.outer(own, own)) - np.eye(w.size)
    if np.abs(cosines).max() > _ORTHOGONAL:
        i, j = sorted(int(each) for each in np.unravel_index(np.argmax(np.abs(cosines)), cosines.shape))
        raise InputError(
            f"The mode shapes must be orthogonal with respect to the mass, but φ_{i + 1}^T M φ_{j + 1} is "
            f"{cosines[i, j]:.3g} times the product of their norms. Give the mass that the modes were computed with, "
            "the degrees of freedom in the same order, and shapes with enough digits.",
            field="shapes",
        )
    return _structure(freedoms.modes(w, phi / np.sqrt(own), m), base_mass, half_width, damping_ratio, n_modes)


def _structure(
    modes: MassNormalisedModes,
    base_mass: float,
    half_width: float,
    damping_ratio: ArrayLike,
    n_modes: SupportsIndex | None,
) -> ModalStructure:
    kept = modes_that_take_part(modes.modal(), n_modes)
    taken = replace(
        modes,
        omega=modes.omega[kept],
        shear=modes.shear[kept],
        moment=modes.moment[kept],
        ordinates=modes.ordinates[:, kept],
        forces=None if modes.forces is None else modes.forces[:, kept],
    )
    return ModalStructure(
        taken,
        positive("base_mass", base_mass, "kg", zero=True),
        positive("half_width", half_width, "m"),
        damping_ratios("damping_ratio", damping_ratio, kept.size),
    )


def _mass_matrix(given: ArrayLike, size: int) -> Array:
    if dimensions(given) == 2:
        m = finite_matrix("mass", given, "kg", (size, size))
    else:
        values = finite_vector("mass", given, "kg")
        if values.size != size:
            raise InputError(
                f"mass must contain one mass for each of the {size} degrees of freedom, but {values.size} were given.",
                field="mass",
            )
        m = np.diag(values)
    own = np.diag(m)
    if own.min() < 0.0:
        i = int(np.argmin(own))
        raise InputError(f"mass must not be negative, but it is {own[i]:g} at degree of freedom {i}.", field="mass")
    return m


def _modes(stiffness: Array, mass: Array) -> tuple[Array, Array]:
    """Return the frequencies as singular values of C^T L^-T, with K = C C^T and M = L L^T, and the mode shapes."""
    root = np.linalg.cholesky(mass)
    _, omega, vectors = np.linalg.svd(np.linalg.solve(root, np.linalg.cholesky(stiffness)).T)
    return omega[::-1].copy(), np.asarray(np.linalg.solve(root.T, vectors.T)[:, ::-1], dtype=np.float64)
