"""Advancing the motion over one stretch of time: by a power series in a linear phase, otherwise by a Runge-Kutta step.

A stretch is started, the polynomial of the guard over it is found, peaks are updated up to the point where the stretch
ends, and the motion is moved to that point. Models without a vector field (`steps` is None) are compiled with the
series only.
"""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex._kernel import inlined_kernel, kernel
from rockflex.models import field_rates, inertia_left
from rockflex.solve.adaptive.curves import is_curved, raise_curves
from rockflex.solve.adaptive.layout import END, Flow, Integrator, Stages
from rockflex.solve.adaptive.step import extend, forget, place_at, row_poly, settle_on, step_over, take_step
from rockflex.solve.adaptive.turning import BARELY
from rockflex.solve.exact.series import advance, expand, largest, margin, measure, row_series
from rockflex.solve.exits import fence_exit, phase_exit, turn_back
from rockflex.solve.layout import (
    DAMPING,
    DOUBT,
    DRAG,
    DRIVE,
    FLEXIBILITY,
    GUARD,
    LEVERAGE,
    OMEGA2,
    Log,
    Motion,
    Progress,
    Span,
    System,
    is_shaken,
    rows_in,
)
from rockflex.solve.memory import gather, load_in
from rockflex.solve.peaks import is_far, raise_peak, raise_to, row_at


@inlined_kernel
def begin(system: System, steps: Integrator | None, at: Progress, rest: Span) -> float:
    """Start a stretch over the `rest` of the unit of a linear phase, or of the sample; return its length.

    The length is `step.FAILED` if no step is short enough.
    """
    if steps is None:
        return rest.length
    if system.phases[at.phase].linear:
        return rest.length
    return take_step(steps.flow, system.phases[at.phase].side, rest, steps.room)


@inlined_kernel
def first_exit(
    system: System, steps: Integrator | None, at: Progress, span: Span, motion: Motion
) -> tuple[float, int, float]:
    """Return where the phase ends within the stretch, from the polynomial of its guard; see `phase_exit`."""
    if steps is None:
        return exit_of_series(system, at, span, motion)
    if system.phases[at.phase].linear:
        return exit_of_series(system, at, span, motion)
    return exit_of_step(system, steps.flow, at, span, motion, steps.room)


@inlined_kernel
def exit_of_series(system: System, at: Progress, span: Span, motion: Motion) -> tuple[float, int, float]:
    """Return where a linear phase ends, from the power series of its guard."""
    expand(system, at.phase, motion, span, at.lift, at.slide)
    row_series(system, at.phase, GUARD, motion, span)
    return phase_exit(system, at, span, motion, motion.polys)


@inlined_kernel
def exit_of_step(
    system: System, flow: Flow, at: Progress, span: Span, motion: Motion, room: Stages
) -> tuple[float, int, float]:
    """Return where an integrated phase ends, from the polynomial of its guard over the step."""
    p, polys = at.phase, room.polys
    extend(flow, system.phases[p].side, span, room)
    row_poly(system, p, GUARD, span, room)
    if not math.isnan(at.lift):
        # θ' starts exactly from zero, θ from zero or where it was held, and θ'' from the value given by the guard.
        polys[GUARD, 0], polys[GUARD, 1] = motion.state[system.layout.rotation], 0.0
        polys[GUARD, 2] = 0.5 * at.lift * span.length * span.length
    return phase_exit(system, at, span, motion, polys)


@inlined_kernel
def turning_exit(system: System, steps: Integrator | None, at: Progress, span: Span, motion: Motion) -> float:
    """Return the place where the rotation turns back while an element yields; inf if it does not."""
    sign = system.phases[at.phase].turns * system.phases[at.phase].side
    if sign == 0.0:
        return np.inf
    row, zeros = system.turning_row, max(at.onset - 1, 0)  # a rotation that has just begun grows like t² or t³
    if steps is None or system.phases[at.phase].linear:
        row_series(system, at.phase, row, motion, span)
        return turn_back(motion.polys, row, sign, zeros)
    row_poly(system, at.phase, row, span, steps.room)
    return turn_back(steps.room.polys, row, sign, zeros)


@inlined_kernel
def first_fence(
    system: System, steps: Integrator | None, at: Progress, span: Span, motion: Motion, stop: float
) -> tuple[float, int]:
    """Return where a fence of the phase first falls to zero before `stop`, and which one; see `fence_exit`."""
    p = at.phase
    if system.phases[p].fences == 0:
        return stop, -1
    if steps is None or system.phases[p].linear:
        measure(system, p, motion, span.length)
        for row in range(system.fences, rows_in(system, p)):
            if margin(system, p, row, motion, span) > 0.0:
                motion.polys[row, 0] = np.inf  # it cannot fall to zero
            else:
                row_series(system, p, row, motion, span)
        return fence_exit(system, at, span, motion, motion.polys, stop)
    for row in range(system.fences, rows_in(system, p)):
        row_poly(system, p, row, span, steps.room)
    return fence_exit(system, at, span, motion, steps.room.polys, stop)


@inlined_kernel
def move(
    system: System,
    steps: Integrator | None,
    at: Progress,
    span: Span,
    stop: float,
    turns: bool,
    log: Log,
    motion: Motion,
) -> None:
    """Move the motion to the fraction `stop` of the stretch, and update the peaks up to there.

    `turns` means that a hysteretic spring reverses there.
    """
    if steps is None or system.phases[at.phase].linear:
        move_by_series(system, at, span, stop, log, motion)
    else:
        move_by_step(system, steps.flow, at, span, stop, log, steps.room)
        if turns:
            motion.state[system.layout.modes] = -steps.room.at.branch * BARELY


@inlined_kernel
def move_by_series(system: System, at: Progress, span: Span, stop: float, log: Log, motion: Motion) -> None:
    """Move the motion to `stop` by its power series."""
    p = at.phase
    if system.phases[p].free:
        raise_peak(motion.polys, GUARD, stop, span, log)
    advance(system, motion, stop, span.length)
    time, ground = span.time + span.length * stop, span.ground + span.slope * span.length * stop
    rise = span.rise + span.rise_slope * span.length * stop
    measured = at.fresh_rows and system.phases[p].fences > 0
    if at.fresh_rows and not measured:
        measure(system, p, motion, span.length)
    for f in range(1, log.peaks.size):
        if at.fresh_rows and largest(system, p, f, motion, span) <= log.peaks[f]:
            continue
        if at.fresh_rows or motion.flags[DOUBT, f]:
            row_series(system, p, f, motion, span)
            raise_peak(motion.polys, f, stop, span, log)
        else:
            raise_to(system, p, f, ground, rise, time, log, motion)


@inlined_kernel
def move_by_step(system: System, flow: Flow, at: Progress, span: Span, stop: float, log: Log, room: Stages) -> None:
    """Move the motion to `stop` by the polynomials of the step."""
    p = at.phase
    side = system.phases[p].side
    if system.phases[p].free:
        raise_peak(room.polys, GUARD, stop, span, log)
        if flow.field.complete:
            raise_curves(system, flow, p, span, stop, log, room)
    end, there = room.vectors[END], span.ground + span.slope * span.length * stop
    place_at(stop, room, end)
    for f in range(1, log.peaks.size):
        if not is_curved(flow, f, side):
            first, last = (
                row_at(system.plain_rows, p, f, span.ground, room.motion),
                row_at(system.plain_rows, p, f, there, end),
            )
            if not is_shaken(span) and is_far(first, last, f, log):
                continue
            row_poly(system, p, f, span, room)
            raise_peak(room.polys, f, stop, span, log)
    if stop == 1.0:
        step_over(room)
    else:
        settle_on(stop, room)


@kernel
def free_inertia(system: System, steps: Integrator | None, phase: int, state: Array) -> float:
    """Return the inertia of the rotation with free modes: I_θ - Σ m* h*², in complete models plus terms of D."""
    if steps is None:
        return 1.0 / system.base[phase, FLEXIBILITY, 0, 0]
    return inertia_left(steps.flow.field, system.phases[phase].side, state)


@kernel
def turning_rate(
    system: System, steps: Integrator | None, phase: int, ground: float, rise: float, motion: Motion
) -> float:
    """Return θ'' at θ = 0 in a phase in which the motion may continue."""
    if steps is None:
        n, rate = system.layout.modes, 0.0
        for j in range(motion.push.shape[1]):
            force = load_in(system, phase, j, motion.state) + system.push[phase, DRIVE, j] * ground
            force -= system.base[phase, DAMPING, j, 0] * motion.state[system.layout.spin]
            if rise != 0.0:
                force += system.heavier_push[phase, j] * rise
            for i in range(n):
                restoring = system.modes[DRAG, i] * motion.state[n + i] + system.modes[OMEGA2, i] * motion.state[i]
                force += system.border[phase, LEVERAGE, j, i] * restoring
            rate += force * system.base[phase, FLEXIBILITY, 0, j]
        return rate
    forget(steps.room)
    gather(system, phase, motion)
    field_rates(steps.flow.field, system.phases[phase].side, 1.0, ground, rise, motion.state, steps.room.rates[0])
    return steps.room.rates[0, system.layout.spin]
