"""One run: the record, then free vibration for as long as it is asked for, or until nothing more can happen."""

import numpy as np

from rockflex._kernel import kernel
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import Array, Log, Phase, Scratch, System, scratch
from rockflex.solve.exact.march import march, to_coordinates, to_state
from rockflex.solve.exact.probe import amplitudes
from rockflex.solve.exact.sample import cross_sample
from rockflex.solve.exact.series import ORDER
from rockflex.solve.exact.unit import CROSSED

__all__ = ["SETTLED", "UNSETTLED", "run"]

SETTLED, UNSETTLED = 2, -2
STRETCH = 64  # samples of free vibration between two looks at whether it has settled


@kernel
def settled(phase: Phase, resistance: float, w: Array, norms: Array, peaks: Array) -> bool:
    """True where free vibration in contact can neither lift the base again nor raise a peak."""
    amplitudes(w, norms)
    for f in range(peaks.size):
        bound = 0.0
        for k in range(w.size // 2):
            bound += phase.hold[f, k] * norms[k]
        if bound > (resistance if f == 0 else peaks[f]):
            return False
    return True


@kernel
def run(
    system: System,
    record: Array,
    dt: float,
    free: int,
    settle: bool,
    side: float,
    state: Array,
    log: Log,
    nodes: Array,
) -> tuple[int, int, Array, int]:
    """Carry `state` through the record and at most `free` samples after it; return status, samples, nodes, count.

    With `settle` the run ends as soon as nothing more can happen, and it is an error if `free` samples pass first.
    """
    room = scratch(state, log.peaks.size, ORDER)
    quiet = np.zeros(STRETCH + 1)
    piece, offset, count, last = record, 0, 0, np.nan
    while True:
        phase = system.rocking if side != 0.0 else system.contact
        w = room.w[: phase.rows.shape[1]]
        to_coordinates(phase, state, piece[0], 0.0, side, w)
        if offset > 0 and settle and side == 0.0:
            if settled(phase, system.physics.resistance, w, room.norms, log.peaks):
                return SETTLED, offset, nodes, count
        if piece[0] != last:
            nodes, count = append(nodes, count, offset * dt, side, piece[0], state)
        status, side, nodes, count = cross_piece(system, piece, dt, offset, side, log, room, nodes, count)
        if status != CROSSED:
            return status, offset, nodes, count
        offset += piece.size - 1
        last = piece[piece.size - 1]
        remaining = free + record.size - 1 - offset
        if remaining == 0:
            return (UNSETTLED if settle else CROSSED), offset, nodes, count
        piece = quiet[: min(STRETCH, remaining) + 1]


@kernel
def cross_piece(
    system: System,
    piece: Array,
    dt: float,
    offset: int,
    side: float,
    log: Log,
    room: Scratch,
    nodes: Array,
    count: int,
) -> tuple[int, float, Array, int]:
    """Carry the motion through one stretch of acceleration; return status, side, nodes and their count."""
    slope, fresh, i = 0.0, True, 0
    while True:
        phase = system.rocking if side != 0.0 else system.contact
        before = i
        i, slope, nodes, count = march(
            phase, system.physics.resistance, piece, dt, i, offset, side, slope, log, room, nodes, count
        )
        fresh = fresh and i == before
        if i < piece.size - 1:
            time = (offset + i) * dt
            status, side, fresh, nodes, count = cross_sample(
                system, side, fresh, piece[i], slope, dt, time, log, room, nodes, count
            )
            i += 1
            if status != CROSSED:
                return status, side, nodes, count
        if i == piece.size - 1:
            break
    if not fresh:
        phase = system.rocking if side != 0.0 else system.contact
        to_state(phase, room.w[: phase.rows.shape[1]], piece[i], slope, side, room.state)
    return CROSSED, side, nodes, count
