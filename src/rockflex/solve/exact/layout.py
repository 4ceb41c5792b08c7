"""The arrays that the exact engine's kernels pass around.

The state is ``[D_1..D_N, D'_1..D'_N, θ, θ']`` in both phases. A *row* is a linear functional of the state, the
ground acceleration and the side of rocking: ``[D.., D'.., θ, θ', a, s]``. Row 0 of each phase is its guard: the
overturning moment in contact (Eq. 24), the rotation while rocking. The other rows are the responses whose peaks
are wanted.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._kernel import kernel

__all__ = ["Array", "Log", "Phase", "Physics", "Scratch", "System", "scratch"]

Array = NDArray[np.float64]


class Physics(NamedTuple):
    """Coefficients of Eqs. 15 and 23, one entry a mode; θ'' is eliminated from the coupled rows."""

    omega2: Array  # ω²
    damping: Array  # 2ζω
    height: Array  # h*
    mass: Array  # m*
    moment_arm: Array  # m* h*
    inertia: float  # I_θ - Σ m* h*²
    gravity: float  # L_0^r g
    resistance: float  # m_tot g B; infinite on a fixed base
    drive_arm: float  # Σ m* h* - L_0^r


class Phase(NamedTuple):
    """One phase, uncoupled into K pairs of coordinates w: state = basis · (w + particular solution).

    Under an acceleration that is linear in time, w moves without forcing: ``w(t + h) = exp(B h) w(t)``, and it
    jumps by ``-particular[1] · Δa'`` where the slope a' of the acceleration changes. The tables have one entry for
    each of the levels j = 0..J of step dt/2^j.
    """

    basis: Array  # (2N + 2, 2K)
    inverse: Array  # (2K, 2N + 2)
    particular: Array  # (3, 2K): of a, a', s
    rows: Array  # (F, 2K)
    row_forcing: Array  # (F, 3): of a, a', s
    slope_rows: Array  # (F, 2K): of the rows' time derivatives
    slope_forcing: Array  # (F,): of a'
    blocks: Array  # (J + 1, 4, K): exp(B h) of each pair, row by row
    dense: Array  # (J + 1, 2K, 2K) where the pairs do not uncouple, else (0, 0, 0)
    sag: Array  # (J + 1, F, K): bound of |row - its chord| over a step, times |w| of the pair
    swing: Array  # (J + 1, F, K): bound of |row' - its value at an end|, times |w| of the pair
    hold: Array  # (F, K): bound of |row| for ever after, times |w| of the pair (contact only)


class System(NamedTuple):
    """A model, ready for a time step."""

    physics: Physics
    contact: Phase
    rocking: Phase
    contact_rows: Array  # (F, 2N + 4): the rows over state, a and s
    rocking_rows: Array


class Log(NamedTuple):
    """What every run leaves: the peak of each row (row 0: of the rotation), when, and the count of events."""

    peaks: Array  # (F,)
    times: Array  # (F,)
    tally: NDArray[np.int64]  # uplifts, impacts, events within the present sample


class Scratch(NamedTuple):
    """The motion as it is carried, and room for the kernels' intermediate values."""

    state: Array  # (2N + 2,)
    w: Array  # (2N + 2,); the first 2K hold the coordinates of the present phase
    w_end: Array
    norms: Array  # (K,)
    lower: Array  # (F,)
    upper: Array
    start: Array
    end: Array
    series: Array  # (order + 1, N + 1)
    polys: Array  # (F, order + 1)
    work: Array  # (order + 1,)


@kernel
def scratch(state: Array, rows: int, order: int) -> Scratch:
    """Room for one run that starts from `state`."""
    size = state.size
    return Scratch(
        state,
        np.zeros(size),
        np.zeros(size),
        np.zeros(size // 2),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros((order + 1, size // 2)),
        np.zeros((rows, order + 1)),
        np.zeros(order + 1),
    )
