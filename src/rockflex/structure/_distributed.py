"""Integrals along the height, and forces gathered at stations."""

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

N_STATIONS = 21
"""Stations of a structure with distributed mass, base and top included."""

_APART = 1e-9  # of the height: closer nodes are one


def mesh(height: float, n_elements: int, *others: Float) -> Float:
    """Return `n_elements` equal elements from 0 to `height`, cut at the other heights too, as nodes in m."""
    nodes = np.unique(np.concatenate([np.linspace(0.0, height, n_elements + 1), *others]))
    nodes = nodes[(nodes >= 0.0) & (nodes <= height)]
    apart = np.append(True, np.diff(nodes) > _APART * height)
    nodes = nodes[apart]
    nodes[-1] = height
    return nodes


def gauss(nodes: Float, n_points: int) -> tuple[Float, Float]:
    """Return points and weights of Gauss quadrature in each element, shape (n_elements, n_points)."""
    x, w = np.polynomial.legendre.leggauss(n_points)
    length = np.diff(nodes)[:, None]
    return nodes[:-1, None] + 0.5 * length * (1.0 + x), 0.5 * length * w


def gathered(stations: Float, z: Float, forces: Float, moments: Float) -> Float:
    """Return forces at the stations (S, n) with the resultants of forces and moments (P, n) at heights z (P,).

    A force is shared by the stations around it as by the ends of a simple beam, and a moment becomes a couple there:
    the sum of the forces, and that of their moments about the base, stay as they were.
    """
    panel = np.clip(np.searchsorted(stations, z, side="right") - 1, 0, stations.size - 2)
    length = np.diff(stations)[panel][:, None]
    upper = forces * (z - stations[panel])[:, None] / length + moments / length
    result = np.zeros((stations.size, forces.shape[1]))
    np.add.at(result, panel, forces - upper)
    np.add.at(result, panel + 1, upper)
    return result
