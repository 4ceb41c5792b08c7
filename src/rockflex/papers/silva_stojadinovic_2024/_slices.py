"""Modes of the chimney by two coarser methods, to find where the printed values may come from (Section 4.1.1)."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex.papers.silva_stojadinovic_2024._structures import TOWER

FUNCTIONS = 5  # of Eq. 36


def ritz_of_slices(slices: int) -> dict[str, Array]:
    """Return ω (rad/s), m* (10⁶ kg), h* (m) and Γ of a Ritz solution with sums over slices instead of integrals.

    The functions are those of Eq. 36. What the stiffness matrix integrates, EI φ_i'' φ_j'', is taken at the upper end
    of each slice, and what the mass matrix does by the trapezoidal rule.
    """
    from scipy.linalg import eigh

    z = np.linspace(0.0, TOWER.height, slices + 1)
    width = np.full(z.size, TOWER.height / slices)
    ends = width.copy()
    ends[[0, -1]] *= 0.5
    turn = math.pi / (2.0 * TOWER.height) * (1.0 + 2.0 * np.arange(FUNCTIONS))[:, None]
    shape, bend = 1.0 - np.cos(turn * z), turn**2 * np.cos(turn * z[1:])
    weight = _mass(z) * ends
    mass = (shape * weight) @ shape.T
    squares, modes = eigh((bend * (_stiffness(z[1:]) * width[1:])) @ bend.T, mass)
    share = modes.T @ shape @ weight
    return {
        "ω": np.sqrt(squares),
        "m*": share**2 / 1e6,
        "h*": (modes.T @ shape @ (weight * z)) / share,
        "Γ": share * (modes.T @ shape[:, -1]),
    }


def first_frequency(elements: int, place: float) -> float:
    """Return ω_1 in rad/s by cubic elements, with dense matrices and without precautions against rounding.

    Parameters
    ----------
    elements
        Number of elements of equal length.
    place
        Where in an element its stiffness is sampled: 0 at its lower end, 1 at its upper end. Mass is sampled halfway.
    """
    from scipy.linalg import eigh

    a = TOWER.height / elements
    low: Array = a * np.arange(elements, dtype=float)
    k = np.array([[12, 6 * a, -12, 6 * a], [6 * a, 4 * a**2, -6 * a, 2 * a**2],
                  [-12, -6 * a, 12, -6 * a], [6 * a, 2 * a**2, -6 * a, 4 * a**2]]) / a**3  # fmt: skip
    m = np.array([[156, 22 * a, 54, -13 * a], [22 * a, 4 * a**2, 13 * a, -3 * a**2],
                  [54, 13 * a, 156, -22 * a], [-13 * a, -3 * a**2, -22 * a, 4 * a**2]]) * a / 420  # fmt: skip
    stiffness, mass = (np.zeros((2 * elements + 2, 2 * elements + 2)) for _ in range(2))
    for e, (ei, mu) in enumerate(zip(_stiffness(low + place * a), _mass(low + 0.5 * a), strict=True)):
        own = slice(2 * e, 2 * e + 4)
        stiffness[own, own] += ei * k
        mass[own, own] += mu * m
    least = eigh(stiffness[2:, 2:], mass[2:, 2:], eigvals_only=True, subset_by_index=(0, 0))
    return float(np.sqrt(np.abs(least[0])))


def _radii(z: Array) -> tuple[Array, Array]:
    outer = TOWER.base_radius - (TOWER.base_radius - TOWER.top_radius) * z / TOWER.height
    return outer, outer - TOWER.wall


def _stiffness(z: Array) -> Array:
    """Return EI in N m²."""
    outer, inner = _radii(z)
    return TOWER.elastic_modulus * 0.25 * math.pi * (outer**4 - inner**4)


def _mass(z: Array) -> Array:
    """Return the mass per length in kg/m."""
    outer, inner = _radii(z)
    return TOWER.density * math.pi * (outer**2 - inner**2)
