"""One run of a nonlinear model: linear contact marches as in the exact engine, all else is crossed sample by sample."""

import numpy as np

from rockflex._kernel import kernel
from rockflex.models import Impact, field_rates
from rockflex.solve.adaptive.cross import cross
from rockflex.solve.adaptive.curves import is_curved, tell
from rockflex.solve.adaptive.glide import glide
from rockflex.solve.adaptive.layout import Flow, Stages
from rockflex.solve.adaptive.step import choose_branch
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import CARRY, CONTACT, LEFT, ROCKING, ZERO, Array, Log, Scratch, System
from rockflex.solve.exact.march import march, to_coordinates, to_state
from rockflex.solve.exact.peaks import raise_row
from rockflex.solve.exact.probe import EVENT
from rockflex.solve.exact.run import SETTLED, UNSETTLED, settled
from rockflex.solve.exact.sample import cross_sample
from rockflex.solve.exact.unit import CROSSED, SPENT

__all__ = ["run"]

IN_CONTACT = ZERO  # a bare CONTACT would have its callees compiled once more


@kernel
def run(
    system: System,
    flow: Flow,
    impact: Impact,
    record: Array,
    quiet: Array,
    dt: float,
    free: int,
    settle: bool,
    side: float,
    log: Log,
    room: Scratch,
    stages: Stages,
    nodes: Array,
) -> tuple[int, int, int]:
    """Carry `stages.motion` through the record and at most `free` samples after it; return status, samples, count.

    `system` has the contact phase, where that is linear. `room.state` is the front of `stages.motion`.
    """
    piece, offset, count, last = record, ZERO, ZERO, np.nan
    while True:
        if offset > 0 and settle and side == 0.0 and not flow.field.hysteretic:
            to_coordinates(system, IN_CONTACT, piece[0], 0.0, side, room)
            if settled(system, room, log):
                return SETTLED, offset, count
        if piece[0] != last:  # the start, or a jump of the acceleration at the record's end
            count = append(nodes, count, offset * dt, side, piece[0], stages.motion)
            stages.known[0] = False
            raise_to_motion(flow, side, piece[0], offset * dt, log, stages)
        status, reached, side, count = cross_piece(
            system, flow, impact, piece, dt, offset, side, log, room, stages, nodes, count
        )
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
    flow: Flow,
    impact: Impact,
    piece: Array,
    dt: float,
    offset: int,
    side: float,
    log: Log,
    room: Scratch,
    stages: Stages,
    nodes: Array,
    count: int,
) -> tuple[int, int, float, int]:
    """Carry the motion through one stretch of acceleration; return status, samples, side and the count of nodes."""
    i, last = ZERO, piece.size - 1
    rate = 1.0 / dt
    slope, tuned = 0.0, False  # tuned: `room.w` holds the motion, in contact
    while i < last:
        finding, begun = EVENT, 0.0
        if side == 0.0 and not flow.field.hysteretic:
            if not tuned:
                slope = 0.0
                to_coordinates(system, IN_CONTACT, piece[i], slope, side, room)
            before = i
            i, slope, finding, count = march(system, piece, dt, i, offset, side, slope, log, room, nodes, count)
            # A motion that was not marched is truer than its coordinates.
            if i > before or tuned:
                to_state(system, IN_CONTACT, piece[i], slope, side, room)
            tuned = True
        else:
            i, begun, count = glide(flow, piece, dt, i, offset, side, log, stages, nodes, count)
        if i == last:
            break
        time, until = (offset + i) * dt, (offset + i + 1) * dt
        if finding == EVENT:
            incline = (piece[i + 1] - piece[i]) * rate
            status, side, count = cross(
                system,
                flow,
                impact,
                side,
                piece[i],
                piece[i + 1],
                incline,
                begun,
                dt,
                time,
                until,
                log,
                room,
                stages,
                nodes,
                count,
            )
            tuned = False
            if status != CROSSED:
                return status, i + 1, side, count
        else:
            status, side, _, count = cross_sample(
                system,
                impact,
                side,
                not tuned,
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
            if status != CROSSED:
                return status, i + 1, side, count
            to_state(system, IN_CONTACT, piece[i + 1], slope, side, room)
        i += 1
    return CROSSED, last, side, count


@kernel
def raise_to_motion(flow: Flow, side: float, acceleration: float, time: float, log: Log, stages: Stages) -> None:
    """Raise all peaks to the present motion."""
    phase = ROCKING if side != 0.0 else CONTACT
    n = flow.rows.shape[2] - 2
    if flow.field.hysteretic:
        choose_branch(flow, side, acceleration, stages)
    field_rates(flow.field, side, stages.branch[0], acceleration, stages.motion, stages.rates[0])
    if side != 0.0 and flow.field.complete:
        tell(flow, side, acceleration, stages.motion, stages.rates[0], stages.values)
    for f in range(0 if side != 0.0 else 1, log.peaks.size):
        if is_curved(flow, f, side):
            value = stages.values[f]
        else:
            value = flow.rows[phase, f, n] * acceleration + flow.rows[phase, f, n + 1] * side
            for i in range(n):
                value += flow.rows[phase, f, i] * stages.motion[i]
        raise_row(f, value, side, time, log)
