"""The arrays that the Runge-Kutta steps need, beside those of `rockflex.solve.layout`.

The state of an integrated model is [D.., D'.., θ, θ', z, E_damped, E_input, E_hysteretic].
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex.models import Field
from rockflex.solve.adaptive.tableau import STAGES
from rockflex.solve.layout import Array

__all__ = ["TERMS", "Flow", "Stages", "stages_of"]

TERMS = 8  # of the polynomial across a step


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

    motion: Array  # (2N + 6,), at the start of the step: `Motion.state`
    trial: Array  # (2N + 6,)
    rates: Array  # (16, 2N + 6)
    bends: Array  # (7, 2N + 6): the continuous extension
    polys: Array  # (F + 1, 8)
    ends: Array  # (F,): the rows at the end of the step
    step: Array  # (1,): length that the error control proposes
    branch: Array  # (1,): sign of the hysteretic spring's velocity
    known: NDArray[np.bool_]  # (1,): whether the first stage is the last one of the step before
    size: Array  # (2N + 3,): largest magnitude of each component so far
    place: Array  # (2N + 6,): the motion within the step
    place_rates: Array  # (2N + 6,)
    end: Array  # (2N + 6,): the motion where the stretch under examination ends
    end_rates: Array  # (2N + 6,)
    starts: Array  # (F,): the curved rows at the start of the step
    starts_ahead: Array  # (F,): a little later
    ends_ahead: Array  # (F,): a little after its end
    values: Array  # (F,): within it
    told: NDArray[np.bool_]  # (1,): whether `starts` is filled in
    doubt: NDArray[np.bool_]  # (F,): curved rows that may hide a peak
    work: Array  # (5,): `Log.work`


def stages_of(motion: Array, moving: int, rows: int, work: Array) -> Stages:
    """Room for one run that starts from `motion`, whose first `moving` entries count in the errors.

    `work` is that of its log.
    """
    n = motion.size
    return Stages(
        motion,
        np.zeros(n),
        np.zeros((STAGES, n)),
        np.zeros((TERMS - 1, n)),
        np.zeros((rows + 1, TERMS)),
        np.zeros(rows),
        np.full(1, np.inf),
        np.ones(1),
        np.zeros(1, dtype=np.bool_),
        np.zeros(moving),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(rows),
        np.zeros(1, dtype=np.bool_),
        np.zeros(rows, dtype=np.bool_),
        work,
    )
