"""The arrays that the exact engine's kernels pass around.

The state is ``[D_1..D_N, D'_1..D'_N, θ, θ']``. A *row* is a linear functional of state, ground acceleration and side
of rocking, ``[D.., D'.., θ, θ', a, s]``. Row 0 of each phase is its guard: the overturning moment in contact
(Eq. 24), the rotation while rocking. The last row, times the side, is what the base has lost of its support: it has a
largest value and no least. The rows between are the responses whose peaks are wanted.

Each phase is uncoupled into pairs of coordinates w, where state = basis · (w + forced part): N pairs in contact,
K = N + 1 while rocking; pair k is ``(w[k], w[K + k])``. Under an acceleration that is linear in time, w moves without
forcing, ``w(t + h) = exp(B h) w(t)``, and it jumps by ``-forced[1] Δa'`` where the acceleration's slope a' changes.
"""

from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CARRY",
    "CONTACT",
    "LEFT",
    "LOOK",
    "ROCKING",
    "SERIES",
    "STEP",
    "ZERO",
    "Array",
    "Log",
    "Physics",
    "Scratch",
    "System",
    "scratch",
]

CONTACT, ROCKING = 0, 1  # the phases, which lead the arrays of `System`

# Places in `Log.work`: what is left of the limit, and what each kind of work takes, in s of `solve.pace`.
LEFT, CARRY, LOOK, SERIES, STEP = 0, 1, 2, 3, 4

# A bare 0 has a type of its own in numba, for which every callee would be compiled once more.
ZERO = cast("int", np.int64(0))

Array = NDArray[np.float64]


class Physics(NamedTuple):
    """Coefficients of Eqs. 15 and 23, one entry a mode, with θ'' eliminated from the coupled rows."""

    omega2: Array  # ω²
    damping: Array  # 2ζω
    height: Array  # h*
    mass: Array  # m*
    inertia: float  # I_θ - Σ m* h*²
    gravity: float  # L_0^r g, less the stiffness of tendons
    resistance: float  # M_r; infinite on a base that cannot lift
    drive_arm: float  # Σ m* h* - L_0^r


class System(NamedTuple):
    """A model made ready for a time step; level j = 0..J stands for the step dt / 2^j."""

    physics: Physics
    plain_rows: Array  # (2, F, 2K + 2): the rows over state, a and s
    basis: Array  # (2, 2K, 2K)
    inverse: Array  # (2, 2K, 2K)
    forced: Array  # (2, 3, 2K): the forced part's coefficients of a, a', s
    rows: Array  # (2, F, 2K): the rows over w
    row_forcing: Array  # (2, F, 3): the rows' coefficients of a, a', s
    slope_rows: Array  # (2, F, 2K): the rows' time derivatives over w; `row_forcing[.., 0]` a' adds to them
    blocks: Array  # (2, J + 1, 4, K): exp(B h) of each pair, row by row
    dense: Array  # (J + 1, 2K, 2K): exp(B h) of rocking where it does not uncouple; else (0, 0, 0)
    sag: Array  # (2, J + 1, F, K): bound of |row - its chord| over a step, times |w| of the pair
    swing: Array  # (2, J + 1, F, K): bound of |row' - its chord|, likewise
    ripple: Array  # (2, J + 1, F, K): bound of |row - its cubic through both ends' values and slopes|, likewise
    steps: Array  # (J + 1,): dt / 2^j
    hold: Array  # (F, K): bound of |row| in contact for ever after, times |w| of the pair
    order: int  # of the power series that converge over the finest step


class Log(NamedTuple):
    """What every run leaves: the peak of each row (row 0: of the rotation), when, and counts of events and of work."""

    peaks: Array  # (F,): largest magnitudes, but of the last row
    times: Array  # (F,)
    tally: NDArray[np.int64]  # uplifts, impacts, events within the present sample
    work: Array  # (5,): the work that is left, and that of a sample, a look into one, a power series, a tried step


class Scratch(NamedTuple):
    """The motion as it is carried, and room for intermediate values."""

    state: Array  # (2K,)
    w: Array  # (2K,)
    w_end: Array  # (2K,): after the step under examination
    held: Array  # (2K,): the same, while peaks are searched inside that step
    norms: Array  # (K,)
    lower: Array  # (F,): limits of the rows
    upper: Array  # (F,)
    start: Array  # (F,): values of the rows
    end: Array  # (F,)
    doubt: NDArray[np.bool_]  # (F,): rows that may leave their limits inside the step
    asked: NDArray[np.bool_]  # (F,): rows that are looked at; all of them, but where peaks are searched
    clear: NDArray[np.int64]  # (F,): up to which place on the grid that search is done
    series: Array  # (K, order + 1)
    polys: Array  # (F + 1, order + 1): polynomials of the rows, and one to work on


def scratch(state: Array, rows: int, order: int) -> Scratch:
    """Room for one run that starts from `state`."""
    size = state.size
    return Scratch(
        state,
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size // 2),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows, dtype=np.bool_),
        np.ones(rows, dtype=np.bool_),
        np.zeros(rows, dtype=np.int64),
        np.zeros((size // 2, order + 1)),
        np.zeros((rows + 1, order + 1)),
    )
