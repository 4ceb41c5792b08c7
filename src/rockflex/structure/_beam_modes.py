"""Modes of a beam by Rayleigh-Ritz, and the stations, points and forces that finite elements use, too."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive, checked_whole_number
from rockflex.foundation.constants import MOST_MODES
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.values import Value
from rockflex.structure._beam_sections import BeamSections
from rockflex.structure._participation import MassNormalisedModes

N_STATIONS = 21
"""Number of stations of a structure with distributed mass, including base and top."""

_MIN_NODE_DISTANCE = 1e-9  # of the height: nodes closer than this are merged
_N_PANELS, _N_POINTS = 64, 8
_SHAPE_TOLERANCE = 1e-6  # of the largest ordinate
_MIN_EIGENVALUE = 1e-13  # smallest eigenvalue of the mass matrix of shapes of unit mass


def beam_mesh_nodes(height: float, n_elements: int, *others: Array) -> Array:
    """Return the nodes in m of `n_elements` equal elements from 0 to `height`, divided at the other heights too."""
    nodes = np.unique(np.concatenate([np.linspace(0.0, height, n_elements + 1), *others]))
    nodes = nodes[(nodes >= 0.0) & (nodes <= height)]
    apart = np.append(True, np.diff(nodes) > _MIN_NODE_DISTANCE * height)
    nodes = nodes[apart]
    nodes[-1] = height
    return nodes


def gauss_points(nodes: Array, n_points: int) -> tuple[Array, Array]:
    """Return points and weights of Gauss quadrature in each element, shape (n_elements, n_points)."""
    x, w = np.polynomial.legendre.leggauss(n_points)
    length = np.diff(nodes)[:, None]
    return nodes[:-1, None] + 0.5 * length * (1.0 + x), 0.5 * length * w


def beam_forces_at_stations(stations: Array, z: Array, forces: Array, moments: Array) -> Array:
    """Return forces at the stations (S, n) statically equivalent to forces and moments (P, n) at heights z (P,).

    A force is distributed to the two adjacent stations like the reactions of a simply supported beam, and a moment
    becomes a couple there, so the sum of the forces and the sum of their moments about the base do not change.
    """
    panel = np.clip(np.searchsorted(stations, z, side="right") - 1, 0, stations.size - 2)
    length = np.diff(stations)[panel][:, None]
    upper = forces * (z - stations[panel])[:, None] / length + moments / length
    result = np.zeros((stations.size, forces.shape[1]))
    np.add.at(result, panel, forces - upper)
    np.add.at(result, panel + 1, upper)
    return result


@dataclass(frozen=True, eq=False)
class RitzShapes(Value):
    """Shape functions ψ_j(z) of a cantilever with their first two derivatives.

    Each attribute is a function of heights (P,) in m that returns an array (P, n), one column per shape. A shape and
    its slope vanish at the base; it need not satisfy the force conditions at the top.

    Attributes
    ----------
    value, slope, curvature : callable
        ψ_j, ψ_j' and ψ_j''.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> parabola = rf.RitzShapes(
    ...     value=lambda z: z[:, None] ** 2,
    ...     slope=lambda z: 2.0 * z[:, None],
    ...     curvature=lambda z: np.full((z.size, 1), 2.0),
    ... )
    >>> beam = rf.Beam(
    ...     height=20.0, mass=500.0, bending_stiffness=2e9, half_width=1.0,
    ...     damping_ratio=0.02,
    ...     method="ritz", shapes=parabola, n_modes=1,
    ... )
    >>> beam.modal().period.round(3)
    array([0.281])
    """

    value: Callable[[Array], ArrayLike]
    slope: Callable[[Array], ArrayLike]
    curvature: Callable[[Array], ArrayLike]

    def at(self, z: Array) -> tuple[Array, Array, Array]:
        """Return ψ, ψ' and ψ'' at heights (P,), each of shape (P, n).

        Raises
        ------
        InputError
            If a function does not return such an array of finite numbers.
        """
        rows: list[Array] = []
        for name in ("value", "slope", "curvature"):
            with np.errstate(all="ignore"):  # values that are not finite are rejected below
                array = np.ma.asarray(getattr(self, name)(z), dtype=np.float64).filled(np.nan)
            if array.ndim != 2 or array.shape[0] != z.size or (rows and array.shape != rows[0].shape):
                expected = rows[0].shape if rows else f"({z.size}, n_shapes)"
                raise InputError(
                    f"shapes.{name} must return one row per height and one column per shape, {expected}, but it "
                    f"returned an array of shape {array.shape}.",
                    field="shapes",
                )
            if not np.isfinite(array).all():
                raise InputError(f"shapes.{name} must be finite along the height, but it is not.", field="shapes")
            rows.append(array)
        return rows[0], rows[1], rows[2]

    def check(self, height: float) -> int:
        """Check the shapes and return their number.

        Raises
        ------
        InputError
            If a shape is not zero or not horizontal at the base, or the derivatives do not belong to it.
        """
        ends = np.array([0.0, height])
        z, w = gauss_points(np.linspace(0.0, height, _N_PANELS + 1), _N_POINTS)
        value, slope, _ = self.at(ends)
        _, slopes, curvatures = self.at(z.ravel())
        weights = w.ravel()
        size = np.abs(value[1]) + height * np.abs(slope[1])
        tests = (
            (value[0], "must vanish at the base, where the structure is clamped"),
            (height * slope[0], "must have no slope at the base, where the structure is clamped"),
            (value[1] - value[0] - weights @ slopes, "is not the integral of its slope: check shapes.slope"),
            (height * (slope[1] - slope[0] - weights @ curvatures), "has a slope that is not the integral of its "
             "curvature: check shapes.curvature"),
        )  # fmt: skip
        for misses, words in tests:
            bad = np.flatnonzero(
                np.abs(misses) > _SHAPE_TOLERANCE * np.maximum(size, np.abs(misses).max() * _SHAPE_TOLERANCE)
            )
            if bad.size:
                raise InputError(f"Shape {bad[0] + 1} {words}.")
        return value.shape[1]


@dataclass(frozen=True, eq=False)
class CosineShapes(Value):
    """1 - cos(r z) at heights (P,), one column per rate r in rad/m."""

    rates: Array

    def __call__(self, z: Array) -> Array:
        return 1.0 - np.cos(np.outer(z, self.rates))


class CosineSlopes(CosineShapes):
    """The first derivative of `CosineShapes`."""

    def __call__(self, z: Array) -> Array:
        return self.rates * np.sin(np.outer(z, self.rates))


class CosineCurvatures(CosineShapes):
    """The second derivative of `CosineShapes`."""

    def __call__(self, z: Array) -> Array:
        return self.rates**2 * np.cos(np.outer(z, self.rates))


def cosine_shapes(height: float, n_shapes: int) -> RitzShapes:
    """Return the shapes 1 - cos((2j - 1) π z/(2 H)), j = 1..n (Silva & Stojadinović 2024, Eq. 36).

    Raises
    ------
    InputError
        If the height or the number of shapes is not positive.

    Examples
    --------
    >>> import rockflex as rf
    >>> shapes = rf.cosine_shapes(height=20.0, n_shapes=3)
    >>> beam = rf.Beam(
    ...     height=20.0, mass=500.0, bending_stiffness=2e9, half_width=1.0,
    ...     damping_ratio=0.02,
    ...     method="ritz", shapes=shapes, n_modes=1,
    ... )
    >>> beam.modal().period.round(3)
    array([0.357])
    """
    h = checked_positive("height", height, "m")
    numbers = np.arange(1, checked_whole_number("n_shapes", n_shapes, 1, MOST_MODES) + 1, dtype=np.float64)
    with explaining_overflow(f"The shapes of a structure {h:g} m high"):
        rates = (2.0 * numbers - 1.0) * math.pi / (2.0 * h)
    return RitzShapes(CosineShapes(rates), CosineSlopes(rates), CosineCurvatures(rates))


def ritz_modes(beam: BeamSections, shapes: RitzShapes, n_modes: int) -> MassNormalisedModes:
    """Return the first Rayleigh-Ritz modes of the beam, integrated by Gauss quadrature.

    Raises
    ------
    InputError
        If the shapes are linearly dependent.
    """
    from scipy.linalg import eigh

    stations = np.linspace(0.0, beam.height, N_STATIONS)
    lumped = beam.lumped
    points, weights = gauss_points(beam_mesh_nodes(beam.height, _N_PANELS, beam.kinks), _N_POINTS)
    z, w = points.ravel(), weights.ravel()
    value, slope, curvature = shapes.at(z)
    stiffness = curvature.T @ ((w * beam.bending_stiffness.at(z))[:, None] * curvature)
    # Lumped masses are additional points.
    at_lumped, slope_lumped, _ = shapes.at(lumped.heights)
    z_all = np.concatenate([z, lumped.heights])
    value, slope = np.vstack([value, at_lumped]), np.vstack([slope, slope_lumped])
    masses = np.concatenate([w * beam.mass.at(z), lumped.masses])
    rotary = np.concatenate([w * beam.rotary_at(z), lumped.rotary])
    in_modes = rotary if beam.rotary_in_modes else np.zeros_like(rotary)
    mass = value.T @ (masses[:, None] * value) + slope.T @ (in_modes[:, None] * slope)
    _check_independent_shapes(mass)
    squares, vectors = eigh(stiffness, mass)
    vectors = vectors[:, :n_modes]
    phi, turn = value @ vectors, slope @ vectors
    forces, moments = masses[:, None] * phi, in_modes[:, None] * turn
    return MassNormalisedModes(
        omega=np.sqrt(squares[:n_modes]),
        shear=forces.sum(axis=0),
        moment=z_all @ forces + moments.sum(axis=0),
        heights=stations,
        ordinates=shapes.at(stations)[0] @ vectors,
        forces=beam_forces_at_stations(stations, z_all, forces, moments),
        mass=float(masses.sum()),
        first_moment=float(masses @ z_all),
        inertia=float(masses @ z_all**2 + in_modes.sum()),
        rotary=float(rotary.sum() - in_modes.sum()),
    )


def _check_independent_shapes(mass: Array) -> None:
    size = np.sqrt(np.diag(mass))
    smallest = float(np.linalg.eigvalsh(mass / np.outer(size, size))[0]) if size.all() else 0.0
    if smallest < _MIN_EIGENVALUE:
        raise InputError(
            f"The {size.size} Ritz shapes are linearly dependent (smallest eigenvalue of their mass matrix, each "
            f"scaled to unit mass: {smallest:.2g}). Leave out combinations of other shapes, or choose more distinct "
            "ones."
        )
