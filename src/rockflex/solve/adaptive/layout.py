"""The arrays for the Runge-Kutta steps, in addition to those of `rockflex.solve.layout`.

The state of an integrated model is [D.., D'.., θ, θ', z, E_damped, E_input, E_hysteretic].
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._weighted import aligned, whole_vectors
from rockflex.engine.tableau import STAGES
from rockflex.models import Field
from rockflex.solve.layout import Progress

TERMS = 8  # of the polynomial over a step
ROW_TERMS = TERMS + 1  # of a row, which may be multiplied by the vertical acceleration of the ground

# Indices in `Stages.vectors`: the state at the end of the step, the state and its rates within the step, and the state
# and its rates at the end of a part of the step. Indices in `Stages.rows`: at the start and the end of the step, at the
# two places between them, and anywhere.
TRIAL, PLACE, PLACE_RATES, END, END_RATES = 0, 1, 2, 3, 4
AT_STARTS, AT_ENDS, AT_EARLY, AT_LATE, TOLD = 0, 1, 2, 3, 4


class Flow(NamedTuple):
    """The integrated phases of a model."""

    field: Field
    kinds: NDArray[np.int64]  # (F,): kinds of the rows while rocking, see `rockflex.models.observe`
    levers: Array  # (F, 2): coefficients of the nonlinear rows
    rest: float  # vertical reaction at rest
    scale: Array  # (2N + 3,): sizes below which the error of a component does not matter
    tolerance: float  # relative, for each step
    moving: int  # entries of the state on which its rates depend
    counted: int  # entries that are integrated: those, or the energies, too


class Stages(NamedTuple):
    """Work arrays for one step; S'' is the size S' of the state rounded up to whole vectors."""

    motion: Array  # (S',): at the start of the step; `Motion.state`
    vectors: Array  # (5, S''): other states and rates, at the indices above
    rates: Array  # (16, S'')
    bends: Array  # (7, S''): the continuous extension
    polys: Array  # (F + 1, 9)
    rows: Array  # (5, F): values of the rows, at the indices above
    doubt: NDArray[np.bool_]  # (F,): curved rows that may have a peak
    size: Array  # (2N + 3,): largest magnitude of each moving entry so far
    work: Array  # (5,): `Log.work`
    at: Progress


def stages_of(motion: Array, moving: int, rows: int, work: Array, at: Progress) -> Stages:
    """Return the work arrays for a run that starts from `motion`; its first `moving` entries enter the error norm.

    `work` is that of the log of the run.
    """
    n = whole_vectors(motion.size)
    return Stages(
        motion,
        aligned(5, n),
        aligned(STAGES, n),
        aligned(TERMS - 1, n),
        np.zeros((rows + 1, ROW_TERMS)),
        np.zeros((5, rows)),
        np.zeros(rows, dtype=np.bool_),
        np.zeros(moving),
        work,
        at,
    )


class Integrator(NamedTuple):
    """The integrator of a nonlinear phase."""

    flow: Flow
    room: Stages
