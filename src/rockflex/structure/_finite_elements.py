"""Modes of a beam by finite elements; imported when needed, since SciPy takes half a second."""

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import ArpackError, ArpackNoConvergence, LinearOperator, eigsh, splu

from rockflex.foundation.arrays import Array
from rockflex.structure._beam_modes import N_STATIONS, beam_forces_at_stations, beam_mesh_nodes, gauss_points
from rockflex.structure._beam_sections import BeamSections
from rockflex.structure._participation import MassNormalisedModes

_MAX_RESIDUAL = 1e-6
_MAX_SQUARES_RATIO = 1e6  # of ω² in one search: rounding in the lowest mode then leaves ten digits of the highest
_MAX_RESTARTS = 100  # modes of a light beam that are below the rounding of a heavy body never converge
_N_PROJECTIONS = 4  # each leaves 1e-16 of the removed part: enough for any beam that `finite_element_modes` accepts
_ELEMENT_POINTS = 4  # exact for cubic shapes with linearly varying mass and stiffness
_MAX_MASS_RATIO = 1e40  # times the mass of the beam: for a heavier body, rounding decides whether the modes are found


def lowest_beam_modes(root: csc_array, mass: csc_array, height: float, n_modes: int) -> tuple[Array, Array]:
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
        further = _further_beam_modes(vectors, stiffness, mass, flexibility, n_modes - vectors.shape[1])
        vectors = np.column_stack([vectors, further])
    omega = np.linalg.norm(root @ vectors, axis=0)
    order = np.argsort(omega)
    omega, vectors = omega[order], vectors[:, order]
    moved = mass @ vectors
    bent = np.column_stack([flexibility(force) for force in moved.T])
    misfits = omega**2 * np.einsum("in,in->n", moved, bent) - 1.0  # zero for modes, else positive
    if not (misfits < _MAX_RESIDUAL).all():
        raise np.linalg.LinAlgError(f"a mode has a relative residual of {misfits.max():.1g}")
    return omega * (stiff / math.sqrt(heavy)), unit @ vectors / math.sqrt(heavy)


def _further_beam_modes(
    known: Array, stiffness: csc_array, mass: csc_array, flexibility: Callable[[Array], Array], wanted: int
) -> Array:
    """Return the lowest modes other than the known ones: as many as wanted, or only the first if they lie far apart.

    A heavy body on a light column gives a first mode so flexible that its rounding error exceeds the flexibility of all
    other modes. These are found afterwards, by removing the first mode from every vector.
    """
    moved, times = mass @ known, _N_PROJECTIONS if known.size else 0

    def without_known(shape: Array) -> Array:
        for _ in range(times):
            shape = shape - known @ (moved.T @ shape)
        return shape

    def bent(force: Array) -> Array:
        force = np.ravel(force)
        for _ in range(times):
            force = force - moved @ (known.T @ force)
        return without_known(flexibility(force))

    size = mass.shape[0]
    inverse = LinearOperator(mass.shape, matvec=bent, dtype=np.float64)
    start = without_known(np.ones(size))  # fixed, for reproducible digits
    directions = min(size - known.shape[1], max(2 * wanted + 1, 20))
    try:
        squares, shapes = eigsh(
            stiffness, k=wanted, M=mass, sigma=0.0, OPinv=inverse, v0=start, ncv=directions, maxiter=_MAX_RESTARTS
        )
    except ArpackNoConvergence as error:
        squares, shapes = error.eigenvalues.real, error.eigenvectors.real
    except ArpackError as error:
        raise np.linalg.LinAlgError(str(error)) from error
    lowest = squares[squares > 0.0].min(initial=np.inf)
    if not np.isfinite(lowest):
        raise np.linalg.LinAlgError("no mode was found")
    kept = np.asarray(shapes[:, (squares > 0.0) & (squares <= _MAX_SQUARES_RATIO * lowest)], np.float64)
    return kept / np.sqrt(np.einsum("in,in->n", kept, np.asarray(mass @ kept)))


@lru_cache(maxsize=64)  # bases of many widths, and what holds them, leave the modes as they are
def finite_element_modes(beam: BeamSections, n_elements: int, n_modes: int) -> MassNormalisedModes:
    """Return the first modes of the beam by two-node elements with consistent mass.

    The elements are cubic (Hermite). With shear stiffness they are Timoshenko elements with cubic deflection and
    quadratic rotation, linked so that a uniform element is exact under end forces. The error of a frequency falls with
    the fourth power of the element length; with shear stiffness it falls with the second power, because the shear
    strain of an element is constant. Elements are divided at stations, lumped masses and kinks of tables.

    The stiffness is stored as K = A^T A: a cantilever is statically determinate, so A is square. K^-1 = A^-1 A^-T
    retains the digits that factorising K would lose, which grow with the fourth power of the number of elements.

    Raises
    ------
    LinAlgError
        If a body is too heavy for the beam, or the modes cannot be found.
    """
    stations = np.linspace(0.0, beam.height, N_STATIONS)
    lumped = beam.lumped
    nodes = beam_mesh_nodes(beam.height, n_elements, stations, beam.kinks, lumped.heights)
    elements, masses, rotary = _beam_element_matrices(beam, nodes)
    _check_lumped_masses(beam, float(masses[:, ::2, ::2].sum()))
    root = _assembled_beam_factor(elements, nodes.size)[:, 2:]
    at = np.abs(nodes[:, None] - lumped.heights).argmin(axis=0)
    point = np.zeros(2 * nodes.size)
    np.add.at(point, 2 * at, lumped.masses)
    if beam.rotary_in_modes:
        np.add.at(point, 2 * at + 1, lumped.rotary)
    mass = csc_array(_assembled_beam_mass(masses, nodes.size) + diags_array(point))
    omega, vectors = lowest_beam_modes(root, csc_array(mass[2:, 2:]), beam.height, n_modes)

    full = np.vstack([np.zeros((2, n_modes)), vectors])
    moved = mass @ full
    forces, moments = moved[::2], moved[1::2]
    translation = np.tile([1.0, 0.0], nodes.size)
    rotation = np.column_stack([nodes, np.ones_like(nodes)]).ravel()
    turned = mass @ rotation
    outside = 0.0 if beam.rotary_in_modes else rotary + float(lumped.rotary.sum())
    return MassNormalisedModes(
        omega=omega,
        shear=forces.sum(axis=0),
        moment=rotation @ moved,
        heights=stations,
        ordinates=full[2 * np.searchsorted(nodes, stations - 1e-8 * beam.height)],
        forces=beam_forces_at_stations(stations, nodes, forces, moments),
        mass=float(translation @ (mass @ translation)),
        first_moment=float(translation @ turned),
        inertia=float(rotation @ turned),
        rotary=outside,
    )


def _check_lumped_masses(beam: BeamSections, mass: float) -> None:
    lumped = beam.lumped
    heaviest = float(lumped.masses.max(initial=0.0))
    if beam.rotary_in_modes:
        heaviest = max(heaviest, float(lumped.rotary.max(initial=0.0)) / beam.height**2)
    if heaviest > _MAX_MASS_RATIO * mass:
        raise np.linalg.LinAlgError(
            f"a body on it has {heaviest / mass:.1g} times its mass, more than {_MAX_MASS_RATIO:g} times"
        )


def _beam_element_matrices(beam: BeamSections, nodes: Array) -> tuple[Array, Array, float]:
    """Return the stiffness factors (E, 2, 4), the mass matrices (E, 4, 4), and the integral of the rotary inertia."""
    z, w = gauss_points(nodes, _ELEMENT_POINTS)
    length = np.diff(nodes)
    bending, mass, rotary = beam.bending_stiffness.at(z), beam.mass.at(z), beam.rotary_at(z)
    shear = None if beam.shear_stiffness is None else beam.shear_stiffness.at(z)
    softness = np.zeros_like(length)  # Φ = 12 EI/(GA_s l²)
    if shear is not None:
        softness = 12.0 * (w * bending).sum(axis=1) / ((w * shear).sum(axis=1) * length**2)
    x = (z - nodes[:-1, None]) / length[:, None]
    f, span, one = softness[:, None], length[:, None], np.ones_like(x)
    whole = (1.0 + f)[..., None]
    deflection = np.stack(
        [
            1.0 - 3.0 * x**2 + 2.0 * x**3 + f * (1.0 - x),
            span * (x - 2.0 * x**2 + x**3 + 0.5 * f * (x - x**2)),
            3.0 * x**2 - 2.0 * x**3 + f * x,
            span * (x**3 - x**2 + 0.5 * f * (x**2 - x)),
        ],
        axis=-1,
    ) / whole  # fmt: skip
    turn = np.stack(
        [
            6.0 / span * (x**2 - x),
            1.0 - 4.0 * x + 3.0 * x**2 + f * (1.0 - x),
            6.0 / span * (x - x**2),
            3.0 * x**2 - 2.0 * x + f * x,
        ],
        axis=-1,
    ) / whole  # fmt: skip
    # Relative to its chord an element has two independent deformations: the mean of the end rotations and their
    # difference.
    ways = np.stack([(12.0 * x - 6.0) / (1.0 + f), one], axis=-1) / span[..., None]
    natural = np.einsum("eg,egi,egj->eij", w * bending, ways, ways)
    if shear is not None:
        natural[:, 0, 0] += (w * shear).sum(axis=1) * (softness / (1.0 + softness)) ** 2
    chord = np.zeros((length.size, 2, 4))
    chord[:, 0, 0], chord[:, 0, 2] = 1.0 / length, -1.0 / length
    chord[:, 0, 1] = chord[:, 0, 3] = 0.5
    chord[:, 1, 1], chord[:, 1, 3] = -1.0, 1.0
    roots = np.linalg.cholesky(natural).transpose(0, 2, 1) @ chord
    masses = np.einsum("eg,egi,egj->eij", w * mass, deflection, deflection)
    if beam.rotary_in_modes:
        masses += np.einsum("eg,egi,egj->eij", w * rotary, turn, turn)
    return roots, masses, float((w * rotary).sum())


def _assembled_beam_factor(elements: Array, n_nodes: int) -> csc_array:
    rows = np.arange(2 * len(elements)).reshape(-1, 2, 1) + np.zeros((1, 1, 4), dtype=int)
    columns = 2 * np.arange(len(elements))[:, None, None] + np.arange(4)[None, None, :] + np.zeros((1, 2, 1), dtype=int)
    where = (rows.ravel(), columns.ravel())
    return csc_array(coo_array((elements.ravel(), where), shape=(2 * len(elements), 2 * n_nodes)))


def _assembled_beam_mass(elements: Array, n_nodes: int) -> csc_array:
    freedoms = 2 * np.arange(len(elements))[:, None] + np.arange(4)
    rows = np.repeat(freedoms, 4, axis=1).ravel()
    columns = np.tile(freedoms, (1, 4)).ravel()
    return csc_array(coo_array((elements.ravel(), (rows, columns)), shape=(2 * n_nodes, 2 * n_nodes)))
