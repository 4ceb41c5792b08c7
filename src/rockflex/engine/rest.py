"""Whether anything can still happen in a phase without excitation."""

import numpy as np

from rockflex._arrays import Array
from rockflex.engine.system import LinearPhase

ROUNDING = 1e-12  # of the sum of the magnitudes of its terms: a motion that is nothing but rounding


def at_rest(phase: LinearPhase, state: Array, high: Array, one_sided: Array) -> bool:
    """Return whether no condition can fail any more and no output exceed its highest value, with a = 0.

    With v = y' = Σ V_k w_k e^{λ_k t} every row approaches C (y - Σ V_k w_k/λ_k) + e, and never gets further away from
    it than Σ |C V_k w_k/λ_k|; parts that do not oscillate stay on their side. States that are held have λ_k = 0 and
    w_k = 0.
    """
    A, n, m = phase.A, state.size, len(phase.d)
    rate = A @ state + phase.c
    roots, vectors = (np.asarray(each, dtype=np.complex128) for each in np.linalg.eig(A))
    try:
        parts = np.linalg.solve(vectors, rate.astype(np.complex128))
    except np.linalg.LinAlgError:
        return False
    sizes = np.abs(vectors) * np.abs(parts)
    scale = np.abs(A) @ np.abs(state) + np.abs(phase.c)  # of which the rates are sums
    held = np.abs(roots) <= ROUNDING * np.abs(roots).max(initial=1e-300)
    moving = ~held & (sizes > ROUNDING * scale[:, None]).any(axis=0)
    if (sizes[:, held] > ROUNDING * scale[:, None]).any() or (
        np.real(roots[moving]) > ROUNDING * np.abs(roots[moving])
    ).any():
        return False
    rows = np.concatenate((phase.C, np.array([event.row for event in phase.events]).reshape(-1, n)))
    constants = np.concatenate((phase.e, np.array([event.constant for event in phase.events], dtype=float)))
    ahead = np.where(held, 0.0, parts / np.where(held, 1.0, roots))
    strays = ((rows @ vectors) * ahead)[:, ~held]
    steady = np.imag(roots[~held]) == 0.0
    below, above = (
        np.where(steady, np.maximum(side * np.real(strays), 0.0), np.abs(strays)).sum(axis=1) for side in (-1.0, 1.0)
    )
    end = rows @ (state - np.real(vectors @ ahead)) + constants
    rounding = ROUNDING * (np.abs(rows) @ np.abs(state) + np.abs(constants))
    if (np.where(below <= rounding, end + rounding, end - below)[m:] < 0.0).any():
        return False
    highest = np.where(one_sided[:m] > 0.0, end[:m] + above[:m], np.maximum(end + above, below - end)[:m])
    return bool(((np.maximum(below, above) <= rounding)[:m] | (highest <= high[:m] + rounding[:m])).all())
