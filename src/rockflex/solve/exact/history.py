"""The nodes of a history: every sample, and both sides of every jump."""

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.layout import Array

__all__ = ["HEADER", "append"]

HEADER = 3  # columns before the state: time, side, ground acceleration


@kernel
def append(
    nodes: Array, count: int, time: float, side: float, acceleration: float, state: Array
) -> tuple[Array, int]:
    """Add a node, doubling the array where it is full; an array without rows keeps nothing."""
    capacity = nodes.shape[0]
    if capacity == 0:
        return nodes, count
    if count == capacity:
        larger = np.empty((2 * capacity, nodes.shape[1]))
        larger[:capacity] = nodes
        nodes = larger
    nodes[count, 0] = time
    nodes[count, 1] = side
    nodes[count, 2] = acceleration
    nodes[count, HEADER:] = state
    return nodes, count + 1
