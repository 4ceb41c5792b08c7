"""One run: the record, then free vibration for as long as it is asked for, or until nothing more can happen."""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.models import Impact
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import CARRY, CONTACT, LEFT, ROCKING, ZERO, Array, Log, Scratch, System
from rockflex.solve.exact.march import march, to_coordinates, to_state
from rockflex.solve.exact.peaks import raise_to_state
from rockflex.solve.exact.sample import cross_sample
from rockflex.solve.exact.unit import CROSSED, SPENT

__all__ = ["SETTLED", "UNSETTLED", "run"]

SETTLED, UNSETTLED = 2, -2


@kernel
def settled(system: System, room: Scratch, log: Log) -> bool:
    """True where free vibration in contact can neither lift the base again nor raise a peak."""
    pairs = system.hold.shape[1]
    for f in range(log.peaks.size):
        bound = 0.0
        for k in range(pairs):
            bound += system.hold[f, k] * math.hypot(room.w[k], room.w[pairs + k])
        if bound > (system.physics.resistance if f == 0 else log.peaks[f]):
            return False
    return True


@kernel
def run(
    system: System,
    impact: Impact,
    record: Array,
    quiet: Array,
    dt: float,
    free: int,
    settle: bool,
    side: float,
    log: Log,
    room: Scratch,
    nodes: Array,
) -> tuple[int, int, int]:
    """Carry `room.state` through the record and at most `free` samples after it; return status, samples, count.

    With `settle` the run ends as soon as nothing more can happen, and it is an error if `free` samples pass first.
    """
    piece, offset, count, last = record, ZERO, ZERO, np.nan
    while True:
        to_coordinates(system, ROCKING if side != 0.0 else CONTACT, piece[0], 0.0, side, room)
        if offset > 0 and settle and side == 0.0 and settled(system, room, log):
            return SETTLED, offset, count
        if piece[0] != last:  # the start, or a jump of the acceleration at the record's end
            count = append(nodes, count, offset * dt, side, piece[0], room.state)
            raise_to_state(system, side, piece[0], offset * dt, log, room)
        status, reached, side, count = cross_piece(system, impact, piece, dt, offset, side, log, room, nodes, count)
        offset += reached
        log.work[LEFT] -= reached * log.work[CARRY]
        if status == CROSSED and log.work[LEFT] < 0.0:
            status = SPENT
        if status != CROSSED:
            return status, offset, count
        last = piece[piece.size - 1]
        remaining = free + record.size - 1 - offset
        if remaining == 0:
            return (UNSETTLED if settle else CROSSED), offset, count
        piece = quiet[: min(quiet.size - 1, remaining) + 1]


@kernel
def cross_piece(
    system: System,
    impact: Impact,
    piece: Array,
    dt: float,
    offset: int,
    side: float,
    log: Log,
    room: Scratch,
    nodes: Array,
    count: int,
) -> tuple[int, int, float, int]:
    """Carry the motion through one stretch of acceleration; return status, samples, side and the count of nodes."""
    slope, fresh, i, last = 0.0, True, ZERO, piece.size - 1
    while True:
        before = i
        i, slope, finding, count = march(system, piece, dt, i, offset, side, slope, log, room, nodes, count)
        fresh = fresh and i == before
        if i < last:
            time, until = (offset + i) * dt, (offset + i + 1) * dt
            status, side, fresh, count = cross_sample(
                system,
                impact,
                side,
                fresh,
                finding,
                piece[i],
                piece[i + 1],
                slope,
                time,
                until,
                log,
                room,
                nodes,
                count,
            )
            i += 1
            if status != CROSSED:
                return status, i, side, count
        if i == last:
            break
    if not fresh:
        to_state(system, ROCKING if side != 0.0 else CONTACT, piece[last], slope, side, room)
    return CROSSED, last, side, count
