"""The arrays that the kernels pass around.

The state is that of `rockflex.models.StateLayout`. A *row* is a linear functional of its moving entries, the ground
acceleration and 1; each phase has its own rows. Row 0 of each phase is its guard; while the base rocks it is also the
rotation. Then come the quantities whose peaks are computed. Of the last of them, from `Log.signed` on, only the largest
value matters, not the magnitude; the very last is the loss of support of the base. The fences of the phase follow:
rows that end it where they become negative.

Each linear phase is uncoupled into K pairs of coordinates w, where state = basis · (w + forced part); pair k is
``(w[k], w[K + k])``. Under an acceleration that is linear in time, w moves without forcing, ``w(t + h) = exp(B h)
w(t)``, and it jumps by ``-forced[1] Δa'`` where the acceleration's slope a' changes.
"""

from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex._kernel import kernel
from rockflex._numba_vectors import padded
from rockflex._vectors import BLOCK
from rockflex.models import PULLS, SUMS, StateLayout
from rockflex.solve.records import DEFERRED

Progress = Any  # a record of `rockflex.solve.progress`

# Indices in `Log.work`: the work left in this slice, and the price of each kind of work in s, see `solve._pace`.
LEFT, CARRY, LOOK, SERIES, STEP = 0, 1, 2, 3, 4

# Indices in `Log.tally`; EVENTS counts those of the present sample, KEPT the states in the history.
UPLIFTS, IMPACTS, EVENTS, KEPT = 0, 1, 2, 3

# Indices in `System.modes`, `border`, `base` and `push`
OMEGA2, DRAG, DRIVEN = 0, 1, 2
COUPLING, LEVERAGE = 0, 1
FLEXIBILITY, DAMPING, STIFFNESS = 0, 1, 2
CONSTANT, DRIVE = 0, 1

# Indices in `Motion.push`
FORCES, TURNS = 0, 1

# Indices in `System.links`, for two limits each: the event there, and the phase that follows; -1 for none, or for a
# phase not yet compiled. Then the same branches with the base in contact, on its right pivot and on its left pivot.
# Next the phase that follows where an element that yields turns back, and those that follow the `System.changes`; from
# `System.fenced` on, those that follow the fences.
EVENT, FOLLOWS, BESIDE, TURNED, CHANGED = 0, 2, 4, 7, 8

# `Progress.lacking`: first the offsets from `BESIDE`, then those from `FOLLOWS`, then those from `TURNED`.
FOLLOWING, TURNING = 3, 5

# Indices in `System.limits` and `Motion.limits`; in `System.changes`, `change_kinds` and `turnings`
LOW, HIGH = 0, 1
PLACE, RECALL = 0, 1
OUTER, MEMORY = 0, 1
ARM, OFFSET = 0, 1

# Indices in `System.fence_kinds`: the event, and the memory that is set; -1 for none
KIND, SETS = 0, 1

# Indices in `System.basis` and `System.rows`
OUT, INTO = 0, 1
VALUES, SLOPES = 0, 1

# Indices in `Motion.w`, `Motion.values` and `Motion.flags`
NOW, ENDS, HELD, BEGUN = 0, 1, 2, 3
LOWER, UPPER, FIRST, FINAL, BEFORE, AFTER, SAGS, SWINGS, RIPPLES = 0, 1, 2, 3, 4, 5, 6, 7, 8
DOUBT, ASKED = 0, 1

# Indices in `Motion.beyond`
TOTALS, PARTS = 0, 1

# Indices in `Motion.block`: the acceleration at the end of each sample, its slope within it, and the jump of the slope
# at its start
GROUNDS, INCLINES, JUMPS = 0, 1, 2

# Indices in `Motion.reach`: of a coordinate and of its rate, and how far either moves away from its start. Then work
# rows: restoring forces, values and rates, and the weights of both in a row.
SIZE, RATE, MOVES, TURNS_BY, RESTORING, PLACES, SPEEDS, WEIGHTS = 0, 1, 2, 3, 4, 5, 6, 7

# Indices in `System.bounds`: largest deviation over a step of a row from its chord, of its slope from the chord of the
# slope, and of the row from the cubic through the values and slopes at both ends.
SAG, SWING, RIPPLE = 0, 1, 2


MOST_DEFERRED = 16  # blocks; any further one is searched at once

# A literal 0 has its own type in numba, for which every callee would be compiled again.
ZERO = cast("int", np.int64(0))
GUARD = ZERO  # the row of the guard
FEWEST_TERMS = 4  # of a power series


class System(NamedTuple):
    """A model prepared for a time step, with the P phases needed so far; level j is the step dt / 2^j."""

    layout: StateLayout
    dt: float
    modes: Array  # (3, K'), K = N + b rounded up to whole vectors: ω², 2ζω, and 1; 0 for the base
    phases: Any  # (P,): records of `PHASE`
    turning_row: int  # index of the row of θ', which guards elements that yield; -1 if no element can
    chords: bool  # whether an element is stretched by 2 r sin(|θ|/2), rather than r |θ|
    fences: int  # index of the row of the first fence
    fenced: int  # index in `links` of the phase after the first fence
    links: NDArray[np.int64]  # (P, CHANGED + X + E): what follows each phase
    fence_kinds: NDArray[np.int64]  # (P, E, 2): the event at each fence, and the memory that is set there
    fence_values: Array  # (P, E, C): the row of the value that this memory takes
    limits: Array  # (P, 2, 2 + M): limits of the guard, and what the rotation and each memory add to them
    changes: Array  # (P, X, 2): limits of δ/r at which an element changes its branch: place, and factor of its memory
    change_kinds: NDArray[np.int64]  # (P, X, 2): 1 reached from below, 0 from above, -1 none; memory's index or -1
    marks: Array  # (P, M): memories with a value of their own in a phase; NaN for others
    turnings: Array  # (P, M, 2): memory = arm δ/r - offset, of an element whose yielding ends; NaN for others
    recall: Array  # (P, b, M): factors of the memories in the forces on the base
    border: Array  # (P, 2, b, K'): c and m* c of `rockflex.models.Arrow`; the base has -1 as its own c
    base: Array  # (P, 3, b, b): flexibility, damping and stiffness of the base
    push: Array  # (P, 2, b): constant forces on the base, and the factor of the ground acceleration
    pulls: Array  # (P, 7, 1 + M): sums over the elements, and what the memories add: see `rockflex.models.pulls_of`
    # Increase for each m/s² of the vertical acceleration of the ground; no entries unless it moves vertically.
    heavier_push: Array  # (P, b): of the constant forces on the base
    heavier_base: Array  # (P, b, b): of its stiffness
    heavier_limits: Array  # (P, 2, 2): of the limits of the guard, and of what the rotation adds to them
    heavier_rows: Array  # (P, F + E, C): of the rows
    # For the motion; F' and S' are F + E and S = 2 N + 2 b rounded up to whole vectors, see `rockflex._vectors`
    plain_rows: Array  # (P, F + E, C): the rows over the state, a and 1
    basis: Array  # (P, 2, S, S'): from coordinates to states and back, both transposed
    forced: Array  # (P, 3 + M, S): coefficients of a, a', 1 and the memories in the forced part
    rows: Array  # (P, 2, S, F'): the rows over w, and their derivatives, to which `row_forcing[.., 0]` a' adds
    row_forcing: Array  # (P, F + E, 3 + M): coefficients of a, a', 1 and the memories in the rows
    blocks: Array  # (P, J + 1, 4, K): exp(B h) of each pair, row by row
    propagator: Array  # (P, J + 1, S, S): exp(B h) if some phase is dense; otherwise (0, 0, 0, 0)
    bounds: Array  # (P, 3, J + 1, K, F'): sag, swing and ripple of each row over a step, times |w| of the pair
    # For blocks of L = `BLOCK` samples
    ahead: Array  # (P, F + E, S, L): the rows at the end of each sample over w at the start of the block
    kicked: Array  # (P, F + E, 2 L): the rows 1 - L to L samples after a jump of the slope; zero before it
    leap: Array  # (P, 4, K): exp(B h) of each pair over the block
    pushed: Array  # (P, L, S'): w at the end of the block over those jumps
    leeway: Array  # (P, K, F'): sag of each row over any sample of the block, times |w| of the pair at its start
    stray: Array  # (P, F + E): the same, times the magnitudes of the jumps


class Course(NamedTuple):
    """The course of a run."""

    record: Array  # (n,): horizontal acceleration of the ground
    vertical: Array  # (n,): its vertical acceleration; (0,) if there is none
    quiet: Array  # zeros, one stretch of free vibration
    dt: float
    free: int  # samples after the record
    settle: bool  # whether to end as soon as no further event or peak is possible


class Span(NamedTuple):
    """A stretch of time in which the ground acceleration is linear."""

    time: float  # of its start
    until: float  # of its end, exactly
    ground: float  # acceleration at its start
    slope: float  # of the acceleration
    length: float
    rise: float  # vertical acceleration at its start
    rise_slope: float  # of the vertical acceleration


class Log(NamedTuple):
    """The results of a run: the peak of each row (row 0: rotation) and its time, counts, work, and the history."""

    peaks: Array  # (F,): largest magnitudes, or largest values
    times: Array  # (F,)
    tally: NDArray[np.int64]  # (4,): uplifts, impacts, events within the present sample, states stored
    work: Array  # (5,): work left, and that of a sample, a look into one, a power series, an attempted step
    history: Array  # (n, 4 + S'): time, side, accelerations and state; (0, ..) without history
    signed: int  # of the rows from this one on only the largest value matters, not the magnitude


class Motion(NamedTuple):
    """The present motion, with work arrays."""

    state: Array  # (S',)
    w: Array  # (4, S): now, after the step examined, the same during the search inside it, at the start of the block
    norms: Array  # (K,)
    # (9, F + E rounded up to whole vectors): lower and upper limits of the rows, their values and their slopes at both
    # ends of the step, and their sag, swing and ripple over it
    values: Array
    flags: Bools  # (2, F + E): rows that may leave their limits inside the step, and rows to examine
    block: Array  # (3, L): the acceleration of the ground over a block of samples
    begins: Array  # (F + E rounded up,): rows at the start of the block
    told: Array  # (F + E, L): rows at the end of each of its samples
    slack: Array  # (F + E rounded up,): how far they may leave the chords between these values
    beyond: Array  # (2, S rounded up): work arrays: sums of products, and their factors
    deferred: Any  # (Q,): records of `DEFERRED`; the last one keeps the present while these blocks are searched
    states: Array  # (Q, S'): their states
    coordinates: Array  # (Q, S): w at their starts
    highest: Array  # (Q, F): bounds of the peaks in them
    clear: NDArray[np.int64]  # (F + E,): point of the grid up to which the search for peaks is done
    series: Array  # (terms, N + b rounded up to whole vectors)
    reach: Array  # (9, N + b rounded up): how far the series reach, see `series.measure`, and work rows
    polys: Array  # (F + E + 1, terms): polynomials of the rows, and one for work
    push: Array  # (2, b): forces on the base and its accelerations, coefficient by coefficient
    # Of the present phase, with the memories as they are: see `memory.recollect`
    limits: Array  # (2,): of the guard
    owners: NDArray[np.int64]  # (2,): the change of an element at each limit; -1 if it is the base's own
    load: Array  # (b,): constant forces on the base
    still: Array  # (S,): constant part of the forced motion
    offset: Array  # (F + E,): constant part of the rows
    pivots: Array  # (2, 9): `Field.pivots`, with the sums over the elements


def motion_of(state: Array, layout: StateLayout, rows: int, terms: int) -> Motion:
    """Return the motion that starts from `state`; `rows` counts the fences too."""
    core, freedoms = layout.core, layout.freedoms
    pairs = core // 2
    flags = np.zeros((2, rows), dtype=np.bool_)
    flags[ASKED] = True
    return Motion(
        state=state,
        w=np.zeros((4, core)),
        norms=np.zeros(pairs),
        values=np.zeros((9, padded(rows))),
        flags=flags,
        block=np.zeros((3, BLOCK)),
        begins=np.zeros(padded(rows)),
        told=np.zeros((rows, BLOCK)),
        slack=np.zeros(padded(rows)),
        beyond=np.zeros((2, padded(core))),
        deferred=np.zeros(MOST_DEFERRED + 1, dtype=DEFERRED),
        states=np.zeros((MOST_DEFERRED + 1, state.size)),
        coordinates=np.zeros((MOST_DEFERRED + 1, core)),
        highest=np.zeros((MOST_DEFERRED + 1, rows)),
        clear=np.zeros(rows, dtype=np.int64),
        series=np.zeros((terms, padded(pairs))),
        reach=np.zeros((9, padded(pairs))),
        polys=np.zeros((rows + 1, terms)),
        push=np.zeros((2, freedoms)),
        limits=np.zeros(2),
        owners=np.full(2, -1, dtype=np.int64),
        load=np.zeros(freedoms),
        still=np.zeros(core),
        offset=np.zeros(rows),
        pivots=np.zeros((2, PULLS + SUMS)),
    )


@kernel
def part_of(span: Span, time: float, begun: float, length: float) -> Span:
    """Return a part of a stretch, from `begun` s after its start at a given time."""
    ground, rise = span.ground + span.slope * begun, span.rise + span.rise_slope * begun
    return Span(time, span.until, ground, span.slope, length, rise, span.rise_slope)


@kernel
def is_shaken(span: Span) -> bool:
    """Return whether the ground moves vertically."""
    return span.rise != 0.0 or span.rise_slope != 0.0


@kernel
def rows_in(system: System, phase: int) -> int:
    """Return the number of rows of a phase, with its fences."""
    return int(system.fences + system.phases[phase].fences)


@kernel
def may_end_phase(system: System, row: int) -> bool:
    """Return whether a row ends its phase at a limit: the guard, the row of θ', and the fences."""
    return row == GUARD or row == system.turning_row or row >= system.fences


@kernel
def heavier_limits(system: System, phase: int, state: Array) -> tuple[float, float]:
    """Return what the limits of the guard gain for each m/s² of vertical acceleration."""
    more, rotation = system.heavier_limits, state[system.layout.rotation]
    return (
        more[phase, LOW, 0] + more[phase, LOW, 1] * rotation,
        more[phase, HIGH, 0] + more[phase, HIGH, 1] * rotation,
    )


@kernel
def slip_in(system: System) -> int:
    """Return the number of the slip among the degrees of freedom of the base; -1 if it cannot slide."""
    return system.layout.slip // 2 - system.layout.modes if system.layout.slip >= 0 else -1


@kernel
def unit_of(system: System, level: int) -> float:
    """Return the length of a step of one level, dt / 2^level, in s."""
    return system.dt / (1 << level)
