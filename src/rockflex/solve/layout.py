"""The arrays that the kernels pass around.

The state is that of `rockflex.models.StateLayout`. A *row* is a linear functional of its moving entries, the ground
acceleration and 1, one set of rows a phase. Row 0 of each phase is its guard; while the base rocks it is the rotation
as well. The last row is what the base has lost of its support: it has a largest value and no least. The rows between
are the quantities whose peaks are wanted.

Each linear phase is uncoupled into K pairs of coordinates w, where state = basis · (w + forced part); pair k is
``(w[k], w[K + k])``. Under an acceleration that is linear in time, w moves without forcing, ``w(t + h) = exp(B h)
w(t)``, and it jumps by ``-forced[1] Δa'`` where the acceleration's slope a' changes.
"""

from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from rockflex._kernel import kernel
from rockflex.models import StateLayout

Array = NDArray[np.float64]
Progress = Any  # a record of `_PROGRESS`

# Places in `Log.work`: what is left of this slice, and what each kind of work takes, in s of `solve.pace`.
LEFT, CARRY, LOOK, SERIES, STEP = 0, 1, 2, 3, 4

# Places in `Log.tally`; EVENTS counts those of the present sample, KEPT the states of the history.
UPLIFTS, IMPACTS, EVENTS, KEPT = 0, 1, 2, 3

# Places in `System.modes`, `border`, `base` and `push`
OMEGA2, DRAG = 0, 1
COUPLING, LEVERAGE = 0, 1
FLEXIBILITY, DAMPING, STIFFNESS = 0, 1, 2
CONSTANT, DRIVE = 0, 1

# Places in `System.links`, of two limits each: what happens there, and which phase follows; -1 for none, or for one
# that was not met yet. Then the same branches with the base in contact, on its right pivot and on its left one.
EVENT, FOLLOWS, BESIDE, LINKS = 0, 2, 4, 7

# `Progress.lacking`: first the places of `BESIDE`, then those of `FOLLOWS`.
FOLLOWING = 3

# Places in `System.basis` and `System.rows`
OUT, INTO = 0, 1
VALUES, SLOPES = 0, 1

# Places in `Motion.w`, `Motion.values` and `Motion.flags`
NOW, ENDS, HELD = 0, 1, 2
LOWER, UPPER, FIRST, FINAL = 0, 1, 2, 3
DOUBT, ASKED = 0, 1

# Places in `System.bounds`: how far a row may lie from its chord over a step, its slope from its own chord, and the row
# from the cubic through the values and slopes at both ends.
SAG, SWING, RIPPLE = 0, 1, 2


def _record(fields: list[tuple[str, Any]]) -> np.dtype[Any]:
    """Type of records whose fields are read by name, as attributes."""
    return np.dtype((np.record, np.dtype(fields, align=True)))


PHASE = _record(
    [
        ("side", np.float64),  # about which pivot the base turns
        ("low", np.float64),  # limits of the guard
        ("high", np.float64),
        ("levels", np.int64),  # of its grid
        ("terms", np.int64),  # of the power series that converge over the finest step
        ("linear", np.bool_),  # carried in closed form
        ("dense", np.bool_),  # linear, but does not uncouple
    ]
)

# A bare 0 has a type of its own in numba, for which every callee would be compiled once more.
ZERO = cast("int", np.int64(0))
GUARD = ZERO  # the row of the guard


class System(NamedTuple):
    """A model made ready for a time step: its phases, P of them, as many as were met; level j is the step dt / 2^j."""

    layout: StateLayout
    dt: float
    modes: Array  # (2, N): ω² and 2ζω
    phases: Any  # (P,): records of `PHASE`
    links: NDArray[np.int64]  # (P, LINKS): what follows each phase
    border: Array  # (P, b, 2, N): c and m* c of `rockflex.models.Arrow`
    base: Array  # (P, 3, b, b): flexibility, damping and stiffness of the base's freedoms
    push: Array  # (P, 2, b): constant forces on them, and the factor of the ground acceleration
    # Its motion
    plain_rows: Array  # (P, F, C): the rows over the state, a and 1
    basis: Array  # (P, 2, S, S), S = 2 N + 2 b: out of the coordinates and into them, both transposed
    forced: Array  # (P, 3, S): the forced part's coefficients of a, a', 1
    rows: Array  # (P, 2, F, S): the rows over w, and their derivatives, to which `row_forcing[.., 0]` a' adds
    row_forcing: Array  # (P, F, 3): the rows' coefficients of a, a', 1
    blocks: Array  # (P, J + 1, 4, K): exp(B h) of each pair, row by row
    propagator: Array  # (P, J + 1, S, S): exp(B h) where some phase is dense; else (0, 0, 0, 0)
    bounds: Array  # (P, 3, J + 1, F, K): sag, swing and ripple of each row over a step, times |w| of the pair


class Course(NamedTuple):
    """What a run is to do."""

    record: Array  # (n,): ground acceleration
    quiet: Array  # zeros: free vibration is run in stretches of so many samples
    dt: float
    free: int  # samples after the record
    settle: bool  # whether to end as soon as nothing more can happen


class Span(NamedTuple):
    """A stretch of time in which the ground acceleration is linear."""

    time: float  # of its start
    until: float  # of its end, to which no rounding adds
    ground: float  # acceleration at its start
    slope: float  # of the acceleration
    length: float


class Log(NamedTuple):
    """What every run leaves: the peak of each row (row 0: of the rotation), when, counts, work, and the history."""

    peaks: Array  # (F,): largest magnitudes, but of the last row
    times: Array  # (F,)
    tally: NDArray[np.int64]  # (4,): uplifts, impacts, events within the present sample, states kept
    work: Array  # (5,): what is left, and that of a sample, a look into one, a power series, a tried step
    history: Array  # (n, 3 + S'): room for states, with time, side and acceleration before each; (0, ..) without


class Motion(NamedTuple):
    """The motion as it is carried, with room for intermediate values."""

    state: Array  # (S',)
    w: Array  # (3, S): now, after the step under examination, and the same while peaks are searched inside that step
    norms: Array  # (K,)
    values: (
        Array  # (4, F): lower and upper limits of the rows, and their values at the start and at the end of the step
    )
    flags: NDArray[np.bool_]  # (2, F): rows that may leave their limits inside the step, and rows that are looked at
    clear: NDArray[np.int64]  # (F,): up to which place on the grid the search for peaks is done
    series: Array  # (N + b, terms)
    polys: Array  # (F + 1, terms): polynomials of the rows, and one to work on
    push: Array  # (b,): forces on the base's freedoms, coefficient by coefficient


# Where a run stands. All that a kernel must know to go on, bit for bit, after it has returned in between.
_PROGRESS = _record(
    [
        ("stage", np.int64),  # of `driver.run`
        ("phase", np.int64),
        ("offset", np.int64),  # samples before the present stretch of acceleration
        ("index", np.int64),  # sample within it
        ("last", np.float64),  # acceleration at the end of the stretch before; NaN at first
        ("slope", np.float64),  # of the acceleration, to which w refers
        ("stated", np.bool_),  # whether the state is up to date, and no less true than w
        ("tuned", np.bool_),  # whether w is up to date
        ("started", np.bool_),  # whether the rows at the start of the sample are known from the end of the one before
        ("begun", np.float64),  # s of the present sample that are done
        ("place", np.int64),  # on the grid of the present sample
        ("level", np.int64),  # of the step tried next
        ("probed", np.bool_),  # whether that step has been examined
        ("finding", np.int64),  # what the examination found
        ("searching", np.bool_),  # for peaks inside that step
        ("search_place", np.int64),
        ("search_level", np.int64),
        ("search_probed", np.bool_),
        ("crossing", np.bool_),  # event by event, up to the next place on the grid
        ("onset", np.int64),  # how the rotation leaves zero
        ("lift", np.float64),  # θ'' at the instant of uplift, where it is known
        ("resume", np.float64),  # where contact is searched again after a guard that was touched but not passed
        ("fresh_rows", np.bool_),  # whether `doubt` no longer speaks of the motion ahead
        ("step", np.float64),  # length that the error control proposes
        ("branch", np.float64),  # sign of the hysteretic spring's velocity
        ("known", np.bool_),  # whether the first stage of a step is the last one of the step before
        ("told", np.bool_),  # whether the curved rows at the start of a step are known
        ("lacking", np.int64),  # place in `follows` or `beside` of the phase that is needed; -1
    ]
)


def progress_at_start(phase: int, *, stated: bool) -> Progress:
    """Return the progress of a run that is to begin in a phase."""
    at = np.frombuffer(bytearray(_AT_START), dtype=_PROGRESS)[0]  # in no time, where a copy goes field by field
    at["phase"], at["stated"] = phase, stated
    return at


def _at_start() -> bytes:
    at = np.zeros(1, dtype=_PROGRESS)
    at["last"] = at["lift"] = np.nan
    at["lacking"], at["step"], at["branch"] = -1, np.inf, 1.0
    return at.tobytes()


_AT_START = _at_start()


def motion_of(state: Array, core: int, rows: int, terms: int, freedoms: int) -> Motion:
    """Room for a motion that starts from `state`, of which the first `core` entries are carried in closed form."""
    pairs = core // 2
    flags = np.zeros((2, rows), dtype=np.bool_)
    flags[ASKED] = True
    return Motion(
        state=state,
        w=np.zeros((3, core)),
        norms=np.zeros(pairs),
        values=np.zeros((4, rows)),
        flags=flags,
        clear=np.zeros(rows, dtype=np.int64),
        series=np.zeros((pairs, terms)),
        polys=np.zeros((rows + 1, terms)),
        push=np.zeros(freedoms),
    )


@kernel
def unit_of(system: System, level: int) -> float:
    """Length of a step of one level, dt / 2^level, in s."""
    return system.dt / (1 << level)
