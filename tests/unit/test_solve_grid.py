"""The dyadic grid of a sample, and what is known of a row from both ends of a step."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rockflex.solve.exact.grid import largest_step
from rockflex.solve.exact.probe import cubic_range


@pytest.mark.parametrize("levels", [0, 1, 2, 5])
def test_largest_step(levels):
    """The largest power of two that divides the place and fits into the sample."""
    grid = 2**levels
    for place in range(grid):
        fitting = [level for level in range(levels + 1) if place % (grid >> level) == 0]
        assert largest_step(place, levels) == min(fitting)


@given(st.integers(0, 9), st.data())
def test_a_walk_in_largest_steps_ends_with_the_sample(levels, data):
    """However often a step is halved on the way, no place is left out and none is visited twice."""
    place, grid = 0, 2**levels
    while place < grid:
        level = data.draw(st.integers(largest_step(place, levels), levels))
        stride = grid >> level
        assert place % stride == 0
        place += stride
    assert place == grid


numbers = st.floats(-100.0, 100.0).map(lambda x: round(x, 3))


@given(numbers, numbers, numbers, numbers)
def test_range_of_a_cubic(first, last, before, after):
    u = np.linspace(0.0, 1.0, 401)
    value = first * (1 + 2 * u) * (1 - u) ** 2 + last * u**2 * (3 - 2 * u)
    value += before * u * (1 - u) ** 2 + after * u**2 * (u - 1)
    low, high = cubic_range(first, last, before, after)
    size = max(map(abs, (first, last, before, after)))
    between = 8.0 * size / 400.0**2  # by which a summit passes the nearest of the points
    assert value.min() - between <= low <= value.min() + 1e-12 * size
    assert value.max() - 1e-12 * size <= high <= value.max() + between
