"""What a phase has under vertical acceleration, for a stack of systems at once."""

from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex.engine.system import LinearPhase, NonlinearPhase
from rockflex.engine.tables import padded, shift_of


class ShakenTables(NamedTuple):
    """Fields as in `march.h`, each with a first axis for the systems."""

    places: list[int]
    shift: int
    now: Array
    outs: Array
    magnitude: Array
    most: Array


class Terms(NamedTuple):
    """What a phase is summed from, its outputs and conditions in one; without the columns that a_v leaves alone."""

    places: list[int]  # of the P states that a_v multiplies
    rates: Array  # (S, n, n + 3 + P): columns y, a, 1, a_v, and a_v times those states
    rows: Array  # (S, R, n + 3 + P)


def terms_of(phase: LinearPhase | NonlinearPhase) -> Terms | None:
    """The terms of a phase; None if the vertical acceleration does not act in its rows, or in linear rates."""
    (S, m, n), k = phase.C.shape, len(phase.events)
    A_v, f_v = (phase.A_v, phase.f_v) if isinstance(phase, LinearPhase) else (None, None)
    rates, rows = np.zeros((S, n, n + 3)), np.zeros((S, m + k, n + 3))
    if isinstance(phase, LinearPhase):
        rates[..., :n], rates[..., n], rates[..., n + 1] = phase.A, phase.f, phase.c
    rows[:, :m, :n], rows[:, :m, n], rows[:, :m, n + 1] = phase.C, phase.d, phase.e
    fed = np.zeros((S, n + m + k, n))
    for given, place in ((A_v, slice(n)), (phase.C_v, slice(n, n + m))):
        if given is not None:
            fed[:, place] = given
    for given, found in ((f_v, rates), (phase.d_v, rows[:, :m])):
        if given is not None:
            found[..., n + 2] = given
    for j, event in enumerate(phase.events):
        rows[:, m + j] = np.column_stack((event.row, event.direct, event.constant, event.direct_v))
        if event.row_v is not None:
            fed[:, n + m + j] = event.row_v
    places = np.flatnonzero(fed.any(axis=(0, 1))).tolist()
    if not (places or rates[..., n + 2].any() or rows[..., n + 2].any()):
        return None
    more = fed[..., places]
    return Terms(places, np.concatenate((rates, more[:, :n]), axis=2), np.concatenate((rows, more[:, n:]), axis=2))


def shaken_of(phase: LinearPhase | NonlinearPhase, h: float) -> ShakenTables | None:  # noqa: ARG001
    """Compute what a stack of phases has for steps of h; None if the vertical acceleration does not act in them."""
    terms = terms_of(phase)
    if terms is None:
        return None
    m = phase.d.shape[1]
    shift = shift_of(terms.rates) if isinstance(phase, LinearPhase) else phase.C.shape[2]
    now, outs = padded(np.concatenate((terms.rates[:, shift:], terms.rows[:, m:]), axis=1)), padded(terms.rows[:, :m])
    return ShakenTables(places=terms.places, shift=shift, now=now, outs=outs, magnitude=np.abs(now), most=np.abs(outs))
