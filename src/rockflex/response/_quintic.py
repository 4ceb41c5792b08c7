"""A polynomial of fifth degree between adjacent states."""

import numpy as np

from rockflex._arrays import Array


def quintic(value: Array, slope: Array, bend: Array, step: Array, place: float) -> tuple[Array, Array, Array]:
    """Return value, slope and second derivative between adjacent rows, from those of the rows, (n, K) each."""
    h = step[:, None]
    safe = np.where(h > 0.0, h, 1.0)
    start, end = slope[:-1] * h, slope[1:] * h
    first, last = bend[:-1] * h**2, bend[1:] * h**2
    rise = value[1:] - value[:-1] - start - 0.5 * first
    tilt = end - start - first
    curl = last - first
    c3, c4, c5 = 10 * rise - 4 * tilt + 0.5 * curl, -15 * rise + 7 * tilt - curl, 6 * rise - 3 * tilt + 0.5 * curl
    f = place
    return (
        value[:-1] + f * (start + f * (0.5 * first + f * (c3 + f * (c4 + f * c5)))),
        (start + f * (first + f * (3 * c3 + f * (4 * c4 + f * 5 * c5)))) / safe,
        (first + f * (6 * c3 + f * (12 * c4 + f * 20 * c5))) / safe**2,
    )
