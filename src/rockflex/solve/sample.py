"""The closer look: one sample traversed on a dyadic grid, in the largest steps without hidden events or peaks."""

from rockflex._kernel import inlined_kernel, kernel
from rockflex.models import Impact
from rockflex.solve.adaptive.layout import Integrator
from rockflex.solve.events import CROSSED, PAUSED, cross
from rockflex.solve.exact.coordinates import to_coordinates, to_state
from rockflex.solve.exact.grid import largest_step
from rockflex.solve.exact.probe import EVENT, PEAK, examine, probe
from rockflex.solve.exact.survey import survey
from rockflex.solve.history import keep
from rockflex.solve.layout import ENDS, FINAL, LEFT, LOOK, NOW, Log, Motion, Progress, Span, System, is_shaken, unit_of
from rockflex.solve.passages import start_crossing
from rockflex.solve.peaks import raise_peaks


@inlined_kernel
def cross_sample(
    system: System,
    steps: Integrator | None,
    impact: Impact,
    sample: Span,
    last: float,
    at: Progress,
    log: Log,
    motion: Motion,
) -> int:
    """Advance the motion over the rest of a sample, at the end of which the ground acceleration is `last`.

    In a linear phase `motion.w` contains the motion at `at.place` of the grid. If `at.stated` is true, the state is at
    least as accurate as `w`: a rotation that has just left zero is far below the rounding error of a modal sum. The
    steps depend only on the guard, not on which peaks are requested, and so does the motion.
    """
    while at.begun < sample.length:
        p = at.phase
        if at.crossing or not can_march(system, p, sample):
            if not at.crossing:
                if system.phases[p].linear and not at.stated:
                    to_state(system, at, sample.ground + sample.slope * at.begun, motion)
                    at.stated = True
                at.tuned = False
                start_crossing(at, True)
            status = cross(system, steps, impact, sample, at, log, motion)
            if status != CROSSED:
                return status
            at.level, at.probed = largest_step(at.place, system.phases[at.phase].levels), False
            continue
        levels = system.phases[p].levels
        grid, stride = 1 << levels, 1 << (levels - at.level)
        unit = unit_of(system, levels)
        here = sample.ground + sample.slope * unit * at.place
        now = sample.time + unit * at.place
        step = Span(now, sample.until, here, sample.slope, unit * stride, 0.0, 0.0)
        if not at.searching:
            if log.work[LEFT] < 0.0:
                return PAUSED
            log.work[LEFT] -= log.work[LOOK]
            if not at.probed:
                if not at.tuned:
                    to_coordinates(system, at, here, motion)
                    at.tuned = True
                examine(system, p, at.level, here, here + sample.slope * unit * stride, sample.slope, motion)
                at.finding = probe(system, p, at.level, sample.slope, log, motion)
            at.probed = False
            if at.finding == EVENT and at.level < levels:
                at.level += 1
                continue
            if at.finding == EVENT:
                if not at.stated:
                    to_state(system, at, here, motion)
                at.begun, at.stated, at.tuned = unit * at.place, True, False
                start_crossing(at, False)
                continue
            raise_peaks(motion.values[FINAL], system.phases[p].free, now + unit * stride, log)
        if at.finding == PEAK and not survey(system, at, step, log, motion):
            return PAUSED
        for k in range(motion.w.shape[1]):
            motion.w[NOW, k] = motion.w[ENDS, k]
        at.stated = False
        at.place += stride
        at.begun = sample.length if at.place == grid else unit * at.place
        at.level = largest_step(at.place, levels)
    if can_march(system, at.phase, sample):
        if not at.tuned:
            to_coordinates(system, at, last, motion)
            at.tuned = True
        if not at.stated and log.history.shape[0] > 0:
            to_state(system, at, last, motion)
    rise = sample.rise + sample.rise_slope * sample.length
    keep(log, sample.until, system.phases[at.phase].side, last, rise, motion.state)
    return CROSSED


@kernel
def can_march(system: System, phase: int, sample: Span) -> bool:
    """Return whether the motion over a sample has a closed form: its equations have constant coefficients."""
    return system.phases[phase].marches and not is_shaken(sample)
