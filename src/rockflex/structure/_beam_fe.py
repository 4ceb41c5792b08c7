"""Modes of a beam by finite elements."""

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array

from rockflex._arrays import Array
from rockflex.modal import MassNormalisedModes
from rockflex.structure._distributed import N_STATIONS, gathered, gauss, mesh
from rockflex.structure._lowest_modes import lowest_modes
from rockflex.structure._sections import Sections

_POINTS = 4  # exact for cubic shapes with linearly varying mass and stiffness
_HEAVIEST = 1e40  # times the mass of the beam: for a heavier body, rounding decides whether the modes are found


def finite_element_modes(beam: Sections, n_elements: int, n_modes: int) -> MassNormalisedModes:
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
    nodes = mesh(beam.height, n_elements, stations, beam.kinks, lumped.heights)
    elements, masses, rotary = _elements(beam, nodes)
    _check_bodies(beam, float(masses[:, ::2, ::2].sum()))
    root = _assembled_rows(elements, nodes.size)[:, 2:]
    at = np.abs(nodes[:, None] - lumped.heights).argmin(axis=0)
    point = np.zeros(2 * nodes.size)
    np.add.at(point, 2 * at, lumped.masses)
    if beam.rotary_in_modes:
        np.add.at(point, 2 * at + 1, lumped.rotary)
    mass = csc_array(_assembled(masses, nodes.size) + diags_array(point))
    omega, vectors = lowest_modes(root, csc_array(mass[2:, 2:]), beam.height, n_modes)

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
        forces=gathered(stations, nodes, forces, moments),
        mass=float(translation @ (mass @ translation)),
        first_moment=float(translation @ turned),
        inertia=float(rotation @ turned),
        rotary=outside,
    )


def _check_bodies(beam: Sections, mass: float) -> None:
    lumped = beam.lumped
    heaviest = float(lumped.masses.max(initial=0.0))
    if beam.rotary_in_modes:
        heaviest = max(heaviest, float(lumped.rotary.max(initial=0.0)) / beam.height**2)
    if heaviest > _HEAVIEST * mass:
        raise np.linalg.LinAlgError(
            f"a body on it has {heaviest / mass:.1g} times its mass, more than {_HEAVIEST:g} times"
        )


def _elements(beam: Sections, nodes: Array) -> tuple[Array, Array, float]:
    """Return the stiffness factors (E, 2, 4), the mass matrices (E, 4, 4), and the integral of the rotary inertia."""
    z, w = gauss(nodes, _POINTS)
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


def _assembled_rows(elements: Array, n_nodes: int) -> csc_array:
    rows = np.arange(2 * len(elements)).reshape(-1, 2, 1) + np.zeros((1, 1, 4), dtype=int)
    columns = 2 * np.arange(len(elements))[:, None, None] + np.arange(4)[None, None, :] + np.zeros((1, 2, 1), dtype=int)
    where = (rows.ravel(), columns.ravel())
    return csc_array(coo_array((elements.ravel(), where), shape=(2 * len(elements), 2 * n_nodes)))


def _assembled(elements: Array, n_nodes: int) -> csc_array:
    freedoms = 2 * np.arange(len(elements))[:, None] + np.arange(4)
    rows = np.repeat(freedoms, 4, axis=1).ravel()
    columns = np.tile(freedoms, (1, 4)).ravel()
    return csc_array(coo_array((elements.ravel(), (rows, columns)), shape=(2 * n_nodes, 2 * n_nodes)))
