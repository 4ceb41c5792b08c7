"""The arrays that the Runge-Kutta steps need, beside those of `rockflex.solve.layout`.

The state of an integrated model is [D.., D'.., θ, θ', z, E_damped, E_input, E_hysteretic].
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex.models import Field
from rockflex.solve.adaptive.tableau import STAGES
from rockflex.solve.layout import Array, Progress

TERMS = 8  # of the polynomial across a step

# Places in `Stages.vectors`: the state at the end of the step, within it, and where a stretch of it ends, with the
# rates of the latter two; and in `Stages.rows`: at the start of the step and at its end, a little after each, and
# within it.
TRIAL, PLACE, PLACE_RATES, END, END_RATES = 0, 1, 2, 3, 4
AT_STARTS, AT_ENDS, AT_STARTS_AHEAD, AT_ENDS_AHEAD, TOLD = 0, 1, 2, 3, 4


class Flow(NamedTuple):
    """The phases of a model that no closed form carries."""

    field: Field
    kinds: NDArray[np.int64]  # (F,): what becomes of the rows while rocking, see `rockflex.models.observe`
    levers: Array  # (F, 2): of those that are no linear functionals
    rest: float  # vertical reaction at rest
    scale: Array  # (2N + 3,): sizes below which a component's error does not matter
    tolerance: float  # relative, for each step


class Stages(NamedTuple):
    """Room for one step."""

    motion: Array  # (S',): at the start of the step; `Motion.state`
    vectors: Array  # (5, S'): states and rates beside it, at the places above
    rates: Array  # (16, S')
    bends: Array  # (7, S'): the continuous extension
    polys: Array  # (F + 1, 8)
    rows: Array  # (5, F): values of the rows, at the places above
    doubt: NDArray[np.bool_]  # (F,): curved rows that may hide a peak
    size: Array  # (2N + 3,): largest magnitude of each moving entry so far
    work: Array  # (5,): `Log.work`
    at: Progress


def stages_of(motion: Array, moving: int, rows: int, work: Array, at: Progress) -> Stages:
    """Room for one run that starts from `motion`, whose first `moving` entries count in the errors.

    `work` is that of its log.
    """
    n = motion.size
    return Stages(
        motion,
        np.zeros((5, n)),
        np.zeros((STAGES, n)),
        np.zeros((TERMS - 1, n)),
        np.zeros((rows + 1, TERMS)),
        np.zeros((5, rows)),
        np.zeros(rows, dtype=np.bool_),
        np.zeros(moving),
        work,
        at,
    )


class Integrator(NamedTuple):
    """What carries a phase that is not linear."""

    flow: Flow
    room: Stages
