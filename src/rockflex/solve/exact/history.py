"""The nodes of a history: every sample, and both sides of every jump."""

from rockflex._kernel import kernel
from rockflex.solve.exact.layout import Array

__all__ = ["HEADER", "append"]

HEADER = 3  # columns before the state: time, side, ground acceleration


@kernel
def append(nodes: Array, count: int, time: float, side: float, acceleration: float, state: Array) -> int:
    """Add a node where there is room for it; return how many there would be."""
    if count < nodes.shape[0]:
        nodes[count, 0] = time
        nodes[count, 1] = side
        nodes[count, 2] = acceleration
        for i in range(state.size):
            nodes[count, HEADER + i] = state[i]
    return count + 1
