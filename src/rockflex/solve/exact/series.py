"""Local power series: the motion about one instant.

Between events the motion is analytic, so about any instant it is a power series whose coefficients follow recursively
from the equations of motion (Eqs. 15 and 23). There is no modal sum and so no cancellation: a rotation that grows like
t² or t³ from zero retains its full relative precision.
"""

import math

from rockflex._arrays import Array
from rockflex._kernel import kernel
from rockflex._series_vectors import dot, set_oscillators, set_polynomial, set_reach, set_values
from rockflex._vectors import add_products
from rockflex.solve.layout import (
    COUPLING,
    DAMPING,
    DRIVE,
    FLEXIBILITY,
    FORCES,
    LEVERAGE,
    MOVES,
    PLACES,
    RESTORING,
    SIZE,
    SPEEDS,
    STIFFNESS,
    TURNS,
    WEIGHTS,
    Motion,
    Span,
    System,
    is_shaken,
    slip_in,
)
from rockflex.solve.peaks import row_at

NEGLIGIBLE = 1e-17  # of the first term of a series


@kernel
def expand(system: System, phase: int, motion: Motion, span: Span, lift: float, slide: float) -> None:
    """Compute the Taylor coefficients of D and q in `motion.series` (order + 1, N + b), with time in units of the span.

    `lift` is θ'' at the instant of uplift if it is known more accurately than from the equation of motion (zero for a
    condition that is satisfied continuously); NaN otherwise. `slide` is the same for the acceleration of a slip.
    """
    shaken = is_shaken(span)
    slipping = slip_in(system)
    n, freedoms, step, series = system.layout.modes, motion.push.shape[1], span.length, motion.series
    moves = system.phases[phase].free or freedoms > 1  # otherwise the base is at rest
    forces, turns, restoring = motion.push[FORCES], motion.push[TURNS], motion.reach[RESTORING]
    leverage, coupling = system.border[phase, LEVERAGE], system.border[phase, COUPLING]
    for i in range(n):
        series[0, i] = motion.state[i]
        series[1, i] = motion.state[n + i] * step
    for j in range(freedoms):
        series[0, n + j] = motion.state[2 * n + 2 * j]
        series[1, n + j] = motion.state[2 * n + 2 * j + 1] * step
    square, terms = step * step, terms_over(system, phase, step)
    for k in range(terms, series.shape[0]):
        for i in range(series.shape[1]):
            series[k, i] = 0.0
    for k in range(terms - 2):
        drive = 0.0
        if k == 0:
            drive = square * span.ground
        elif k == 1:
            drive = square * step * span.slope
        pair = 1.0 / ((k + 2.0) * (k + 1.0))
        set_oscillators(restoring, series, k, system.modes, square, step * (k + 1.0), drive, pair)
        if not moves:
            continue
        for j in range(freedoms):
            force = system.push[phase, DRIVE, j] * drive
            for m in range(freedoms):
                force -= system.base[phase, STIFFNESS, j, m] * square * series[k, n + m]
                force -= system.base[phase, DAMPING, j, m] * step * (k + 1.0) * series[k + 1, n + m]
            if k == 0:
                force += motion.load[j] * square
            if shaken:
                force += heavier(system, phase, j, k, span, series)
            forces[j] = dot(leverage[j], restoring) + force
        for j in range(freedoms):
            turn = 0.0
            for m in range(freedoms):
                turn += system.base[phase, FLEXIBILITY, j, m] * forces[m]
            if k == 0 and j == 0 and not math.isnan(lift):
                turn = square * lift
            if k == 0 and j == slipping and not math.isnan(slide):
                turn = square * slide
            turns[j] = -turn * pair
        add_products(series[k + 2], coupling, turns, freedoms, 1)


@kernel
def terms_over(system: System, phase: int, step: float) -> int:
    """Return the number of terms after which a series from t³ (uplift) converges over a step, as in `tables.terms_of`.

    It is at most that over the finest step of the phase.
    """
    turn, order, term = system.phases[phase].fastest * step, 3, 1.0
    while term > NEGLIGIBLE and order + 1 < system.phases[phase].terms:
        order += 1
        term *= turn / order
    return order + 1


@kernel
def heavier(system: System, phase: int, freedom: int, k: int, span: Span, series: Array) -> float:
    """Return the k-th coefficient of the force on a degree of freedom of the base due to vertical acceleration."""
    n, step = system.layout.modes, span.length
    force = 0.0
    if k < 2:
        force += system.heavier_push[phase, freedom] * (span.rise if k == 0 else span.rise_slope * step)
    for m in range(system.heavier_push.shape[1]):
        stiffness = system.heavier_base[phase, freedom, m]
        if stiffness != 0.0:
            moved = span.rise * series[k, n + m]
            if k > 0:
                moved += span.rise_slope * step * series[k - 1, n + m]
            force -= stiffness * moved
    return force * step * step


@kernel
def measure(system: System, phase: int, motion: Motion, step: float) -> None:
    """Set bounds of D and q and of their rates over the stretch of the series, and of how much they change."""
    set_reach(motion.reach, motion.series, system.phases[phase].terms, step)


@kernel
def largest(system: System, phase: int, row: int, motion: Motion, span: Span) -> float:
    """Return a bound of a row over the measured stretch."""
    rise = max(abs(span.rise), abs(span.rise + span.rise_slope * span.length))
    size = bound_of(system, system.plain_rows, phase, row, SIZE, motion, span)
    if rise > 0.0:
        size += rise * bound_of(system, system.heavier_rows, phase, row, SIZE, motion, span)
    return size


@kernel
def margin(system: System, phase: int, row: int, motion: Motion, span: Span) -> float:
    """Return a lower bound of a row over the measured stretch: its value at the start less what it may change."""
    value = row_at(system.plain_rows, phase, row, span.ground, motion.state)
    value -= bound_of(system, system.plain_rows, phase, row, MOVES, motion, span)
    if is_shaken(span):
        rise = max(abs(span.rise), abs(span.rise + span.rise_slope * span.length))
        value += span.rise * row_at(system.heavier_rows, phase, row, span.ground, motion.state)
        value -= rise * bound_of(system, system.heavier_rows, phase, row, MOVES, motion, span)
        value -= (
            abs(span.rise_slope) * span.length * abs(row_at(system.heavier_rows, phase, row, span.ground, motion.state))
        )
    return value


@kernel
def bound_of(system: System, rows: Array, phase: int, row: int, which: int, motion: Motion, span: Span) -> float:
    """Return a bound of a row (`which` is `SIZE`) or of its change (`MOVES`) over the measured stretch."""
    n, moving = system.layout.modes, rows.shape[2] - 2
    size = abs(rows[phase, row, moving]) * abs(span.slope) * span.length
    if which == SIZE:
        size += abs(rows[phase, row, moving] * span.ground) + abs(rows[phase, row, moving + 1])
        for i in range(system.layout.memory, system.layout.memory + system.layout.remembered):
            size += abs(rows[phase, row, i] * motion.state[i])
    for i in range(motion.w.shape[1] // 2):
        place, speed = (i, n + i) if i < n else (2 * i, 2 * i + 1)
        size += abs(rows[phase, row, place]) * motion.reach[which, i]
        size += abs(rows[phase, row, speed]) * motion.reach[which + 1, i]
    return size


@kernel
def row_series(system: System, phase: int, row: int, motion: Motion, span: Span) -> None:
    """Compute the Taylor coefficients of one row of a phase in `motion.polys[row]`."""
    develop_row(system, system.plain_rows, phase, row, row, motion, span)
    if not is_shaken(span):
        return
    polys, work = motion.polys, motion.polys.shape[0] - 1
    develop_row(system, system.heavier_rows, phase, row, work, motion, span)
    for k in range(polys.shape[1] - 1, 0, -1):
        polys[row, k] += span.rise * polys[work, k] + span.rise_slope * span.length * polys[work, k - 1]
    polys[row, 0] += span.rise * polys[work, 0]


@kernel
def develop_row(system: System, rows: Array, phase: int, row: int, place: int, motion: Motion, span: Span) -> None:
    """Compute the Taylor coefficients of one of `rows` in `motion.polys[place]`, without vertical acceleration."""
    n, pairs, terms = system.layout.modes, motion.w.shape[1] // 2, system.phases[phase].terms
    polys, weights, step = motion.polys, motion.reach[WEIGHTS : WEIGHTS + 2], span.length
    ground = rows.shape[2] - 2
    for i in range(n):
        weights[0, i] = rows[phase, row, i]
        weights[1, i] = rows[phase, row, n + i] / step
    for i in range(n, pairs):
        weights[0, i] = rows[phase, row, 2 * i]
        weights[1, i] = rows[phase, row, 2 * i + 1] / step
    set_polynomial(polys[place], motion.series, weights, terms)
    for k in range(terms, polys.shape[1]):
        polys[place, k] = 0.0
    polys[place, 0] += rows[phase, row, ground] * span.ground + rows[phase, row, ground + 1]
    for i in range(system.layout.memory, system.layout.memory + system.layout.remembered):
        polys[place, 0] += rows[phase, row, i] * motion.state[i]
    polys[place, 1] += rows[phase, row, ground] * span.slope * step


@kernel
def advance(system: System, motion: Motion, u: float, step: float) -> None:
    """Replace the state at the start of `step` by that at its fraction `u`, from the series."""
    n, places, speeds = system.layout.modes, motion.reach[PLACES], motion.reach[SPEEDS]
    set_values(places, speeds, motion.series, u)
    for i in range(motion.w.shape[1] // 2):
        motion.state[i if i < n else 2 * i] = places[i]
        motion.state[n + i if i < n else 2 * i + 1] = speeds[i] / step
