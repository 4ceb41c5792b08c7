"""The branches of many elements as a few numbers, which a state keeps as memories."""

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array

BASE, DIGITS = 8, 17  # a double holds 17 octal digits exactly
SHIFT = 1  # the lowest branch is -1


def codes_for(size: int) -> int:
    """Return how many numbers hold the branches of `size` elements."""
    return -(-size // DIGITS)


def code_of(branches: tuple[int, ...]) -> tuple[float, ...]:
    """Return the numbers that stand for branches from -1 to 6."""
    parts = (branches[first : first + DIGITS] for first in range(0, len(branches), DIGITS))
    return tuple(float(sum((branch + SHIFT) * BASE**k for k, branch in enumerate(part))) for part in parts)


def decoded(codes: Array, size: int) -> NDArray[np.int64]:
    """Return the branches of `size` elements from their numbers, (n, codes_for(size)), as (n, size)."""
    whole = codes.astype(np.int64)
    columns = [whole[:, k // DIGITS] // BASE ** (k % DIGITS) % BASE - SHIFT for k in range(size)]
    return np.stack(columns, axis=1)
