"""Whether anything can still happen in a phase without excitation."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex.engine.system import LinearPhase

SOON = 1e-9  # s, or a share that is next to nothing
ROUNDING = 1e-12  # of the sum of the magnitudes of its terms: a motion that is nothing but rounding


class Decay(NamedTuple):
    """The motion of a phase with a = 0 in its modes: y' = Σ V_k w_k e^{λ_k t}."""

    phase: LinearPhase
    rows: Array  # outputs and conditions, (R, n)
    constants: Array  # (R,)
    roots: NDArray[np.complex128]  # (n,)
    vectors: NDArray[np.complex128]
    inverse: NDArray[np.complex128] | None  # None if the modes are not independent
    swings: bool  # whether all roots that are not zero are complex
    fastest: float  # largest rate at which a mode fades, 1/s
    held: NDArray[np.intp]  # places of modes with λ_k = 0, and of those that grow
    grows: NDArray[np.intp]
    seen: NDArray[np.complex128]  # C V_k/λ_k, (R, n), zero where held


def decay_of(phase: LinearPhase) -> Decay:
    """Find the modes of a phase."""
    roots, vectors = (np.asarray(each, dtype=np.complex128) for each in np.linalg.eig(phase.A))
    try:
        inverse = np.asarray(np.linalg.inv(vectors), dtype=np.complex128)
    except np.linalg.LinAlgError:
        inverse = None
    rows = np.concatenate((phase.C, np.array([event.row for event in phase.events]).reshape(-1, len(roots))))
    constants = np.concatenate((phase.e, np.array([event.constant for event in phase.events], dtype=float)))
    still = np.abs(roots) <= ROUNDING * np.abs(roots).max(initial=1e-300)
    seen = np.where(still, 0.0, (rows @ vectors) / np.where(still, 1.0, roots))
    grows = ~still & (np.real(roots) > ROUNDING * np.abs(roots))
    swings = bool((still | (np.imag(roots) != 0.0)).all())
    return Decay(
        phase,
        rows,
        constants,
        roots,
        vectors,
        inverse,
        swings,
        float(-np.real(roots).min()),
        np.flatnonzero(still),
        np.flatnonzero(grows),
        seen,
    )


def moving(decay: Decay, parts: NDArray[np.complex128], scale: Array, some: NDArray[np.intp]) -> Bools:
    """Which of some modes move by more than rounding."""
    sizes = np.abs(decay.vectors[:, some]) * np.abs(parts[some])
    return np.asarray((sizes > ROUNDING * scale[:, None]).any(axis=0))


def time_to_rest(decay: Decay, state: Array, high: Array, one_sided: Array) -> float:
    """Return 0 at rest: no condition can fail any more, and no output exceed its highest value, with a = 0.

    Otherwise a time in which that cannot come, unless another phase does; a tiny one if nothing is known.
    Every row approaches C (y - Σ V_k w_k/λ_k) + e, and never gets further away from it than Σ |C V_k w_k/λ_k|; parts
    that do not oscillate stay on their side. States that are held have λ_k = 0 and w_k = 0.
    """
    phase, rows, m = decay.phase, decay.rows, len(decay.phase.d)
    if decay.inverse is None:
        return np.inf
    rate = phase.A @ state + phase.c
    parts = decay.inverse @ rate
    scale = np.abs(phase.A) @ np.abs(state) + np.abs(phase.c)  # of which the rates are sums
    if decay.grows.size and moving(decay, parts, scale, decay.grows).any():
        return SOON
    strays = decay.seen * parts
    end = rows @ state - np.real(strays.sum(axis=1)) + decay.constants
    rounding = ROUNDING * (np.abs(rows) @ np.abs(state) + np.abs(decay.constants))
    least = end - np.abs(strays).sum(axis=1) + rounding
    if decay.swings and bool((least[m:] < 0.0).any()):
        within, limit = (end - least + rounding)[m:], (end + rounding)[m:]
        ratio = float((within / np.maximum(limit, SOON * within))[least[m:] < 0.0].max())
        return math.log(ratio) / max(decay.fastest, SOON) if ratio < 1.0 / SOON else SOON
    steady = np.imag(decay.roots) == 0.0
    if moving(decay, parts, scale, decay.held).any():
        return SOON
    below, above = (
        np.where(steady, np.maximum(side * np.real(strays), 0.0), np.abs(strays)).sum(axis=1) for side in (-1.0, 1.0)
    )
    if (np.where(below <= rounding, end + rounding, end - below)[m:] < 0.0).any():
        return SOON
    highest = np.where(one_sided > 0.0, (end + above)[:m], np.maximum(end + above, below - end)[:m])
    return 0.0 if ((np.maximum(below, above) <= rounding)[:m] | (highest <= high + rounding[:m])).all() else SOON
