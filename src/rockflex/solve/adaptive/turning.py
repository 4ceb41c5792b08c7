"""Reversals of the hysteretic spring: a step ends where its velocity, and so the branch of its law, changes sign."""

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.adaptive.layout import TERMS, Flow, Stages
from rockflex.solve.adaptive.step import expand_nested
from rockflex.solve.polynomials import first_descent

BARELY = 1e-300  # m/s: velocity assigned at a reversal, to define its sign


@kernel
def turning(flow: Flow, stages: Stages) -> float:
    """Return where the velocity of the hysteretic spring changes sign; inf if it does not."""
    n = flow.field.modes.shape[1]  # index of D'_1
    work = stages.polys.shape[0] - 1
    for j in range(TERMS - 1):
        stages.polys[work, j] = stages.at.branch * stages.bends[j, n]
    expand_nested(stages.polys, work)
    stages.polys[work, TERMS] = 0.0
    size = 0.0
    for k in range(TERMS):
        size += abs(stages.polys[work, k])
    if size == 0.0:
        return np.inf  # at rest
    stages.polys[work, 0] = abs(stages.motion[n])
    if abs(stages.motion[n]) <= BARELY:  # just after a reversal, whose zero is divided out
        for k in range(TERMS - 1):
            stages.polys[work, k] = stages.polys[work, k + 1]
        stages.polys[work, TERMS - 1] = 0.0
    return first_descent(stages.polys, work, 0.0, 1.0)
