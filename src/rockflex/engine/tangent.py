"""Derivatives of a run with respect to the scale of its record and to parameters.

The run is known: its states beside events, the phases between them, and the times of its peaks. Within a phase
y' = A y + f a + c a tangent s = dy/dp obeys s' = A s + (dA/dp) y + (df/dp) a + dc/dp. At an event it jumps.
`tangent_pass` follows several parameters side by side.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from rockflex.engine.run import Run
from rockflex.engine.system import Key
from rockflex.engine.tangent_pass import Crossing, Pass
from rockflex.engine.tangent_steps import Motion
from rockflex.foundation.arrays import Array, Bools, Integers


class Trace(NamedTuple):
    """What is known of a run whose states beside events were kept."""

    h: float
    times: Array  # (k,): of the states, in samples
    places: Integers  # (k,): of their phases among the keys
    ground: Array  # (k,): acceleration
    rise: Array  # (k,): vertical acceleration
    states: Array  # (k, n)
    keys: Sequence[Key]
    turns: Integers  # (e, 3): of each event its phase, its number, and the state after it
    high: Array  # (m,): peaks
    when: Array  # (m,): their times, in samples
    record: Array  # (samples + 1,): acceleration
    vertical: Array  # the same of the vertical one; empty if there is none

    @classmethod
    def of(cls, run: Run, acceleration: Array, vertical: Array | None) -> "Trace":
        """Return what a run has met, whose record is given."""
        times, places, ground, states, rise = run.history
        high, when = run.highest
        h, still = run.h, np.zeros(0) if vertical is None else vertical
        return cls(
            h, times / h, places, ground, rise, states, run.keys, run.journal.turns, high, when / h, acceleration, still
        )

    @property
    def shakes(self) -> bool:
        """Whether the ground moves vertically."""
        return bool(self.vertical.any())


class Tangents(NamedTuple):
    """Derivatives with respect to P parameters, and what they rest on."""

    peaks: Array  # (P, m)
    final: Array  # (P, n): of the last state
    rates: Array  # (e,): of the conditions at the events, over their scales, in 1/s; NaN where none was crossed
    times: Array  # (k,): of samples, and of events twice, in samples
    seen: Array  # (k, r): outputs that were observed, at these times
    slopes: Array  # (P, k, r): and their derivatives


def follow_tangents(
    trace: Trace,
    motion_of: Callable[[Key], Motion],
    crossing_of: Callable[[Key, int, Key | None], Crossing],
    start: Array,
    one_sided: Bools,
    *,
    free: bool = False,
    observed: Sequence[int] = (),
) -> Tangents:
    """Follow tangents through a run.

    Parameters
    ----------
    trace
        The run.
    motion_of, crossing_of
        Its phases with their derivatives, and what its events make of the state, by the key of the phase, the number of
        the event, and the key of the phase after it.
    start
        Derivatives of the first state, shape (P, n).
    one_sided
        Which peaks are largest values, and not largest magnitudes, shape (m,).
    free
        Whether to follow the motion without excitation in place of the tangent, see `Pass`.
    observed
        Numbers of the outputs whose values at all samples are wanted, too.
    """
    used = set(trace.places.tolist())
    motions = [motion_of(key) if place in used else None for place, key in enumerate(trace.keys)]
    crossings, kinds = list[Crossing](), list[int]()
    known = dict[tuple[int, int, int], int]()
    for place, event, after in trace.turns.tolist():
        then = int(trace.places[after]) if after < len(trace.places) else -1
        kind = known.get((place, event, then))
        if kind is None:
            kind = known[place, event, then] = len(crossings)
            crossings.append(Crossing() if then < 0 else crossing_of(trace.keys[place], event, trace.keys[then]))
        kinds.append(kind)
    P, n = start.shape
    made = Pass(motions, n, P, free)
    final, r = made.follow(trace, crossings, kinds, start, one_sided, observed), len(observed)
    peaks, rates, noted = made.result
    slopes = noted[:, 1 + r :].reshape(len(noted), P, r).transpose(1, 0, 2)
    return Tangents(peaks, final, rates, noted[:, 0], noted[:, 1 : 1 + r], slopes)
