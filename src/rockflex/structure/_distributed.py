"""Integrals along the height, and distributed forces lumped at stations."""

import numpy as np

from rockflex._arrays import Array

N_STATIONS = 21
"""Number of stations of a structure with distributed mass, including base and top."""

_APART = 1e-9  # of the height: nodes closer than this are merged


def mesh(height: float, n_elements: int, *others: Array) -> Array:
    """Return the nodes in m of `n_elements` equal elements from 0 to `height`, divided at the other heights too."""
    nodes = np.unique(np.concatenate([np.linspace(0.0, height, n_elements + 1), *others]))
    nodes = nodes[(nodes >= 0.0) & (nodes <= height)]
    apart = np.append(True, np.diff(nodes) > _APART * height)
    nodes = nodes[apart]
    nodes[-1] = height
    return nodes


def gauss(nodes: Array, n_points: int) -> tuple[Array, Array]:
    """Return points and weights of Gauss quadrature in each element, shape (n_elements, n_points)."""
    x, w = np.polynomial.legendre.leggauss(n_points)
    length = np.diff(nodes)[:, None]
    return nodes[:-1, None] + 0.5 * length * (1.0 + x), 0.5 * length * w


def gathered(stations: Array, z: Array, forces: Array, moments: Array) -> Array:
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
