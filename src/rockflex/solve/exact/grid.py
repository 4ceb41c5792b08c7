"""The dyadic grid of a sample: 2^J units, and steps of 2^j units that start at their multiples."""

from rockflex._kernel import kernel


@kernel
def largest_step(place: int, levels: int) -> int:
    """Return the level of the largest step of the grid that starts at `place`."""
    level = levels
    while level > 0 and place % (1 << (levels - level + 1)) == 0:
        level -= 1
    return level
