"""Storing the states of a history: at every sample, and before and after every jump."""

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex._vectors import BLOCK
from rockflex.models import GROUND, HEADER, RISE, SIDE, TIME
from rockflex.solve.layout import KEPT, Log

MARGIN = 8 + BLOCK  # largest number of states added between two pauses: at events, and over a block of samples


@kernel
def keep(log: Log, time: float, side: float, ground: float, rise: float, state: Array) -> None:
    """Add a state to the history, if there is one."""
    if log.history.shape[0] == 0:
        return
    k = log.tally[KEPT]
    log.history[k, TIME] = time
    log.history[k, SIDE] = side
    log.history[k, GROUND] = ground
    log.history[k, RISE] = rise
    for i in range(state.size):
        log.history[k, HEADER + i] = state[i]
    log.tally[KEPT] = k + 1


@kernel
def drop_passing(log: Log, time: float) -> None:
    """Remove the states of phases that have begun and ended at the present instant with the base on the same side.

    A base that turns back, or lands and lifts at once, is held by friction for no time at all, and its acceleration
    then is no part of the motion. What follows is kept next.
    """
    last = log.tally[KEPT] - 1
    while last > 0 and log.history[last - 1, TIME] == time and log.history[last - 1, SIDE] == log.history[last, SIDE]:
        last -= 1
        log.tally[KEPT] = last + 1
    if last > 0 and log.history[last, TIME] == time and log.history[last - 1, TIME] == time:  # it began there, too
        log.tally[KEPT] = last


@kernel
def room_left(log: Log) -> int:
    """Return how many more states can be stored before the history must be enlarged."""
    if log.history.shape[0] == 0:
        return MARGIN
    return log.history.shape[0] - log.tally[KEPT] - MARGIN
