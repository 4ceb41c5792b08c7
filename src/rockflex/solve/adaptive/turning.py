"""A hysteretic spring turns where its velocity changes its sign, and its law its branch: there a step ends."""

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.adaptive.layout import TERMS, Flow, Stages
from rockflex.solve.adaptive.step import expand_nested
from rockflex.solve.polynomials import first_descent

BARELY = 1e-300  # m/s: what a velocity is set to where it turns, for its sign


@kernel
def turning(flow: Flow, stages: Stages) -> float:
    """Where the velocity of the hysteretic spring changes its sign, and its law its branch; inf where it does not."""
    n = flow.field.modes.shape[1]  # the place of D'_1
    work = stages.polys.shape[0] - 1
    for j in range(TERMS - 1):
        stages.polys[work, j] = stages.at.branch * stages.bends[j, n]
    expand_nested(stages.polys, work)
    size = 0.0
    for k in range(TERMS):
        size += abs(stages.polys[work, k])
    if size == 0.0:
        return np.inf  # at rest
    stages.polys[work, 0] = abs(stages.motion[n])
    if abs(stages.motion[n]) <= BARELY:  # it has just turned; that zero is divided out
        for k in range(TERMS - 1):
            stages.polys[work, k] = stages.polys[work, k + 1]
        stages.polys[work, TERMS - 1] = 0.0
    return first_descent(stages.polys, work, 0.0, 1.0)
