"""Sums of stages: the places at which the field is evaluated."""

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel
from rockflex._weighted import place_by
from rockflex.engine.tableau import STAGES, A

# The first stage after 0 with a weight in each stage.
FROM = np.array([0, *(1 + int(np.flatnonzero(A[stage, 1:])[0]) if stage > 1 else 1 for stage in range(1, STAGES))])


@inlined_kernel
def place_stage(stage: int, step: float, start: Array, rates: Array, out: Array, moving: int) -> None:
    """Compute the state at which a stage is evaluated, `start` + step Σ A rates; stage 12 is the end of the step.

    Only the first `moving` entries are needed, on which the rates depend.
    """
    newest = stage - 1
    place_by(out, start, step, A, stage, rates, FROM[stage], newest, moving)
    if newest > 0:
        # One by one, as they were written: a vector could not be loaded before all of it is in the cache.
        weight = step * A[stage, newest]
        for i in range(moving):
            out[i] += weight * rates[newest, i]


@inlined_kernel
def place_others(step: float, start: Array, rates: Array, out: Array, moving: int, counted: int) -> None:
    """Compute the other entries at the end of the step: up to `counted` they have rates, the rest is constant."""
    for i in range(moving, counted):
        total = A[12, 0] * rates[0, i]
        for k in range(5, 12):
            total += A[12, k] * rates[k, i]
        out[i] = start[i] + step * total
    for i in range(counted, start.size):
        out[i] = start[i]
