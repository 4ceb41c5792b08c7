"""The fast path of the integrated phases: step by step, sample by sample, while no event or peak can occur inside."""

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel
from rockflex.solve.adaptive.check import nothing_hides
from rockflex.solve.adaptive.layout import Flow, Stages
from rockflex.solve.adaptive.step import FAILED, step_over, take_step
from rockflex.solve.history import keep, room_left
from rockflex.solve.layout import CARRY, LEFT, Log, Progress, Span, System


@inlined_kernel
def step_through(
    system: System,
    flow: Flow,
    piece: Array,
    vertical: Array,
    dt: float,
    limits: Array,
    at: Progress,
    log: Log,
    stages: Stages,
) -> bool:
    """Integrate the motion over samples, starting `at.begun` s into the sample `at.index`.

    Returns True before a step that needs a closer look. Returns False when the work or the memory for the history is
    used up, or at the end of the piece.
    """
    rate, side = 1.0 / dt, system.phases[at.phase].side
    for i in range(at.index, piece.size - 1):
        slope, rise, rise_slope = (piece[i + 1] - piece[i]) * rate, 0.0, 0.0
        if vertical.size > 0:
            rise, rise_slope = vertical[i], (vertical[i + 1] - vertical[i]) * rate
        time, until = (at.offset + i) * dt, (at.offset + i + 1) * dt
        while at.begun < dt:
            if log.work[LEFT] < 0.0 or room_left(log) < 0:
                return False
            longest = dt - at.begun
            rest = Span(
                time + at.begun,
                until,
                piece[i] + slope * at.begun,
                slope,
                longest,
                rise + rise_slope * at.begun,
                rise_slope,
            )
            step = take_step(flow, side, rest, stages)
            if step == FAILED:
                return True
            span = Span(rest.time, until, rest.ground, slope, step, rest.rise, rise_slope)
            if not nothing_hides(system, flow, at.phase, span, limits, log, stages):
                at.tried, at.length = True, step  # the closer look continues with this step
                return True
            step_over(stages)
            at.begun = dt if step == longest else at.begun + step
        log.work[LEFT] -= log.work[CARRY]
        at.index, at.begun = i + 1, 0.0
        keep(log, until, side, piece[i + 1], rise + rise_slope * dt, stages.motion)
    return False
