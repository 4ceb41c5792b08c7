"""A polynomial of fifth degree between adjacent states."""

import numpy as np

from rockflex._arrays import Array

Motion = tuple[Array, Array, Array]


def quintic(value: Array, slope: Array, bend: Array, step: Array, place: float) -> Motion:
    """Return value, slope and second derivative between adjacent rows, from those of the rows, (n, K) each."""
    return quintic_between((value[:-1], slope[:-1], bend[:-1]), (value[1:], slope[1:], bend[1:]), step, place)


def quintic_between(before: Motion, after: Motion, step: Array, place: float | Array) -> Motion:
    """Return value, slope and second derivative between two states, from those of both, (n, K) each.

    `step` (n,) is the time between them, and `place` the part of it that has passed, for all or of shape (n, 1).
    """
    h = step[:, None]
    safe = np.where(h > 0.0, h, 1.0)
    (value, slope, bend), (next_value, next_slope, next_bend) = before, after
    start, end = slope * h, next_slope * h
    first, last = bend * h**2, next_bend * h**2
    rise = next_value - value - start - 0.5 * first
    tilt = end - start - first
    curl = last - first
    c3, c4, c5 = 10 * rise - 4 * tilt + 0.5 * curl, -15 * rise + 7 * tilt - curl, 6 * rise - 3 * tilt + 0.5 * curl
    f = place
    return (
        value + f * (start + f * (0.5 * first + f * (c3 + f * (c4 + f * c5)))),
        (start + f * (first + f * (3 * c3 + f * (4 * c4 + f * 5 * c5)))) / safe,
        (first + f * (6 * c3 + f * (12 * c4 + f * 20 * c5))) / safe**2,
    )
