"""The resisting moment of a base about the acting pivot: the parts of its weight and of its elements."""

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.modal import RockingProperties


def weight_resistance(properties: RockingProperties, side: NDArray[np.integer], rotation: Array) -> Array:
    """Return s m_tot g B_s - L_0^r g θ in N m for small rotations, shape (n,); zero in contact."""
    return _weight(properties, side) - properties.l0r * GRAVITY * rotation


def element_resistance(properties: RockingProperties, side: NDArray[np.integer], force: Array) -> Array:
    """Return s F r of each element in N m for small rotations, shape (n, E); zero in contact."""
    positions = np.array([each.position for each in properties.elements])
    arms = [properties.pivot(turned).arm - turned * positions for turned in (1, -1)]
    return np.array([np.zeros(positions.size), arms[0], -arms[1]])[side] * force


def large_resistance(
    properties: RockingProperties, side: NDArray[np.integer], rotation: Array, force: Array
) -> tuple[Array, Array]:
    """Return both parts for rotations of any size: s m_tot g B_s cos θ - L_0^r g sin θ, and s F r cos(θ/2)."""
    weight = _weight(properties, side) * np.cos(rotation) - properties.l0r * GRAVITY * np.sin(rotation)
    return weight, element_resistance(properties, side, force) * np.cos(0.5 * rotation)[:, None]


def _weight(properties: RockingProperties, side: NDArray[np.integer]) -> Array:
    return np.array([0.0, properties.pivot(1).weight_moment, -properties.pivot(-1).weight_moment])[side]
