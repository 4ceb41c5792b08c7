"""Where a phase ends within a unit: the first root of its guard's polynomial, row 0 of `polys`."""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.layout import Array
from rockflex.solve.exact.probe import QUARTER_TURN
from rockflex.solve.exact.series import first_descent

__all__ = ["contact_exit", "overturning", "rocking_exit"]


@kernel
def contact_exit(polys: Array, resistance: float, start: float, span: float) -> tuple[float, float]:
    """Where the overturning moment reaches the resistance (Eq. 24), and the side it names."""
    work = polys.shape[0] - 1
    exit_at, exit_side = np.inf, 0.0
    if math.isinf(resistance):
        return exit_at, exit_side
    play = 0.0
    for k in range(1, polys.shape[1]):
        play += abs(polys[0, k])
    for side in (1.0, -1.0):
        if resistance + side * polys[0, 0] > play:
            continue
        for k in range(polys.shape[1]):
            polys[work, k] = side * polys[0, k]
        polys[work, 0] += resistance
        u = first_descent(polys, work, start, span)
        if u < exit_at:
            exit_at, exit_side = u, side
    return exit_at, exit_side


@kernel
def rocking_exit(polys: Array, side: float, zeros: int, span: float) -> float:
    """Where the rotation returns to zero; -1 where it never left. The `zeros` that it has at 0 are divided out."""
    work, terms = polys.shape[0] - 1, polys.shape[1]
    for k in range(terms):
        polys[work, k] = side * polys[0, k + zeros] if k + zeros < terms else 0.0
    if zeros > 0 and polys[work, 0] <= 0.0:
        return -1.0
    if polys[work, 0] < 0.0:
        polys[work, 0] = 0.0
    return first_descent(polys, work, 0.0, span)


@kernel
def overturning(polys: Array, side: float, span: float) -> float:
    """Where the rotation reaches a quarter turn; inf where it does not."""
    work, reach = polys.shape[0] - 1, 0.0
    for k in range(polys.shape[1]):
        reach += abs(polys[0, k])
        polys[work, k] = -side * polys[0, k]
    if reach < QUARTER_TURN:
        return np.inf
    polys[work, 0] += QUARTER_TURN
    return first_descent(polys, work, 0.0, span)
