"""The loops of `march.c` in NumPy: no table of a time step, no bound, and every sample in power series.

So they are slow, easy to follow, and a check of the compiled ones: that these see all events and peaks.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from engine.steps_twin import Steps
from rockflex.engine.field import Field
from rockflex.engine.shaken import terms_of
from rockflex.engine.system import LinearPhase, NonlinearPhase, up8
from rockflex.engine.tables import (
    LONGEST,
    halvings_of,
    padded,
    rates_of,
    rows_of,
    shift_of,
    spectral_radius_bound,
    steps_of,
)
from rockflex.foundation.arrays import Array

BLOCK = 16
UNKNOWN, ENDS, ASKED = -1, -2, -3
Climb = tuple[float, float]  # the vertical acceleration at the start of a series, and its change


LOOPS = None  # in `oscillator`, where tests replace the two functions that call it
TOGETHER = 8
UU, UV, U0, U1, VU, VV, V0, V1, SQUARE, DRAG, SWAY, SPREAD, SD, SV, FACTORS = range(15)


def PyErr_CheckSignals() -> None:  # noqa: N802
    """Do nothing: the interpreter looks at Ctrl-C by itself."""


class Content(NamedTuple):
    """What a stack of phases is summed from: outputs, and the rates that are no states with the conditions."""

    shift: int
    outs: Array
    now: Array
    places: list[int]  # of the states that a_v multiplies

    @classmethod
    def of(cls, rates: Array | None, rows: Array, m: int, n: int, places: Sequence[int] = ()) -> "Content":
        """From rates, if there are any, and rows."""
        shift = n if rates is None else shift_of(rates)
        some = rows[:, :0] if rates is None else rates[:, shift:]
        return cls(shift, padded(rows[:, :m]), padded(np.concatenate((some, rows[:, m:]), axis=1)), list(places))


class Peaks:
    """Highest values of the outputs, the samples at which they were reached, and samples that may have higher ones."""

    def __init__(self, one_sided: Array, states: int, room: int) -> None:
        self.high, self.when, self.room = np.zeros(one_sided.size), np.zeros(one_sided.size), room
        self.candidates, self.pauses = np.zeros((room + 1, 3 + states + one_sided.size)), 0
        self.begin(one_sided)

    def widen(self, rows: int) -> None:
        """Make room for phases with so many outputs and conditions."""

    @property
    def size(self) -> int:
        """Memory of the room, bytes."""
        return self.candidates.nbytes

    def begin(self, one_sided: Array) -> None:
        """Begin anew."""
        self.high[:], self.when[:] = np.where(one_sided > 0.0, -np.inf, 0.0), 0.0
        self.kept = self.done = 0
        self.stopped, self.passed = False, 0.0

    def set_sample_offset(self, samples: float) -> None:
        """Say how many samples come before the first of the present acceleration."""
        self.passed = samples

    def looks(self) -> bool:
        """Whether the march has stopped before a sample in which a condition may fail."""
        return self.stopped

    def count(self) -> int:
        """Number of samples that may have higher values."""
        return self.kept

    def keep(self, count: int) -> None:
        """Keep so many of them, the first ones."""
        self.kept = count

    def work(self) -> int:
        """Samples so far, and what counts like them."""
        return self.done

    def pause(self) -> int:
        """The work from which on the run looks up."""
        return self.pauses

    def pause_at(self, work: int) -> None:
        """Set that."""
        self.pauses = work

    def add_work(self, more: int) -> None:
        """Count more."""
        self.done += more

    def look(self, looks: bool) -> None:
        """Say whether the march has stopped before a sample in which something may happen."""
        self.stopped = looks

    def before(self) -> float:
        """Samples before the first of the present acceleration."""
        return self.passed


class PhaseLoops:
    """The content and the outcomes of one phase."""

    def __init__(self, found: LinearPhase | NonlinearPhase, h: float) -> None:
        n, self.outputs, self.events, self.halvings = found.C.shape[2], found.d.shape[1], found.events, np.zeros(1)
        rates, rows, terms = None, rows_of(found), terms_of(found)
        if isinstance(found, LinearPhase):
            rates, turn = rates_of(found), spectral_radius_bound(found.A * h)
            ends = [np.isfinite(steps_of(rates[k, None], h, halvings_of(t, 1.0))).all() for k, t in enumerate(turn)]
            self.halvings = np.where(ends, halvings_of(turn, LONGEST), -1)
        self.plain, self.shaken = Content.of(rates, rows, self.outputs, n), None
        if terms is not None:
            some = None if rates is None else terms.rates
            self.shaken = Content.of(some, terms.rows, self.outputs, n, terms.places)
        self.field: Field | None = None
        self.outcomes: list[Any] = [outcome for event in self.events for outcome in (event, event.rest)]
        self.following = [
            UNKNOWN if each is None else ASKED if callable(each.jump) else ENDS if each.target is None else UNKNOWN
            for each in self.outcomes
        ]


class Phases(Steps):
    """The phases that a run has met, each with the loops over its content."""

    def __init__(self, one_sided: Array, states: int) -> None:
        super().__init__(states, one_sided.size)
        self.one_sided, self.which = one_sided > 0.0, 0
        self.phases: list[PhaseLoops] = []
        self.known: list[bool] = []  # of each phase: whether it is forgotten

    def add(self, place: int, found: LinearPhase | NonlinearPhase, h: float) -> int:
        """Prepare a phase; of each of its events it is not known yet what follows, or known to be the end, or asked."""
        self.phases[place : place + 1], self.known[place : place + 1] = [PhaseLoops(found, h)], [True]
        return self._size(place)

    def _size(self, place: int) -> int:
        return self.phases[place].plain.now.nbytes + self.phases[place].plain.outs.nbytes

    def drop(self, place: int) -> int:
        """Forget a phase; the memory that this frees, in bytes."""
        self.known[place] = False
        return self._size(place)

    def shake(self, place: int, which: int, found: LinearPhase | NonlinearPhase, h: float) -> int:
        """Know what a phase has under vertical acceleration: it does so from the first on."""
        del place, which, found, h
        return 0

    def has_tables(self, place: int, shakes: bool) -> bool:
        """Whether a phase is known, with what it has under vertical acceleration."""
        del shakes
        return self.known[place]

    def acting(self, place: int, v: Climb) -> Content:
        """What a phase has under a vertical acceleration and its change, if that acts in it."""
        found = self.phases[place]
        return found.plain if found.shaken is None or not any(v) else found.shaken

    def term(self, place: int, v: Climb, k: int, before: Array, x: Array) -> Array:
        """A term of a series: y, a, 1 and, if a vertical acceleration acts, that and what it multiplies."""
        content = self.acting(place, v)
        if content is self.phases[place].plain:
            return np.asarray(x[: self.n + 2])
        fed = v[0] * np.asarray(x)[content.places] + (v[1] * np.asarray(before)[content.places] if k else 0.0)
        return np.concatenate((x[: self.n + 2], [v[k] if k < 2 else 0.0], fed))

    def bind_system(self, place: int, which: int) -> None:
        """Take the tables of one system for one phase."""
        del place
        self.which = which

    def select(self, which: int) -> None:
        """Take the tables of one system of the stack."""
        self.which = which

    def set_next_phase(self, place: int, outcome: int, following: int) -> None:
        """Say which phase follows an outcome."""
        self.phases[place].following[outcome] = following

    def events(self, place: int) -> int:
        """Number of events of a phase."""
        return len(self.phases[place].events)

    def halvings(self, place: int) -> int:
        """How often the step must be halved so that power series converge."""
        return int(self.phases[place].halvings[self.which])

    def shift(self, place: int, v: Climb) -> int:
        """Number of first states whose rates are as many states after them."""
        return self.acting(place, v).shift

    def scale(self, place: int, event: int) -> float:
        """Size of a violation of a condition."""
        return float(np.asarray(self.phases[place].events[event].scale)[self.which])

    def following(self, place: int, outcome: int) -> int:
        """Place of the phase that follows an outcome, or UNKNOWN, ENDS or ASKED."""
        return self.phases[place].following[outcome]

    def jump(self, place: int, outcome: int, magnitudes: bool, y: Array, workspace: Array) -> bool:
        """Multiply a state by the matrix of an outcome, or magnitudes by its magnitudes; whether there is one."""
        del workspace
        found = self.phases[place].outcomes[outcome].jump
        if not isinstance(found, np.ndarray):
            return False
        matrix = found[self.which]
        y[: self.n] = (np.abs(matrix) if magnitudes else matrix) @ np.array(y[: self.n])
        return True

    def rests(self, place: int, event: int, y: Array, a: float, v: float) -> bool:
        """Whether the motion is too slow after an event."""
        rest: Any = self.phases[place].events[event].rest
        if rest is None:
            return False
        k, x = self.which, np.asarray(y[: self.n])
        more = rest.direct_v[k] + (0.0 if rest.row_v is None else rest.row_v[k] @ x)
        return bool(rest.row[k] @ x + rest.direct[k] * a + rest.constant[k] + v * more <= 0.0)

    def march(self, place: int, a: Array, v: Array, i: int, last: int, y: Array, peaks: Peaks, states: Array) -> int:
        """Advance over no sample: each is left to a power series."""
        del states
        rise = float(v[i]) if len(v) else 0.0
        start = np.array((*y[: self.n], a[i], 1.0))
        outs = self.acting(place, (rise, 0.0)).outs[self.which]
        rows = outs @ self.term(place, (rise, 0.0), 0, start, start)
        self._raise(peaks, rows[: self.phases[place].outputs], i)
        peaks.stopped = i < last
        return i

    def _counted(self, rows: Array) -> Array:
        return np.where(self.one_sided[: rows.size], rows, np.abs(rows))

    def _raise(self, peaks: Peaks, rows: Array, sample: int) -> None:
        found = self._counted(rows)
        higher = np.flatnonzero(found > peaks.high[: found.size])
        peaks.when[higher], peaks.high[higher] = peaks.passed + sample, found[higher]

    def expand(
        self, place: int, h: float, a: float, rise: float, v: Climb, y: Array, series: Array, away: Array
    ) -> int:
        """Expand states and conditions; the number of terms, 0 if too many, and how far each condition may get."""
        p, count, first = self.acting(place, v), self.events(place), self.states
        now, rates = p.now[self.which], self.n - p.shift
        x, most, calm = np.array(y[: self.n]), np.abs(y[: self.n]), 0
        for k in range(len(series)):
            series[k, : self.n], series[k, self.n : first] = x, 0.0
            series[k, self.n : self.n + 2] = (a, rise)[k] if k < 2 else 0.0, k == 0
            z = now @ self.term(place, v, k, series[k - 1], series[k])
            series[k, first : first + count] = z[rates : rates + count]
            x = np.concatenate((x[p.shift : 2 * p.shift], z[: self.n - p.shift])) * (h / (k + 1))
            most = np.maximum(most, np.abs(x))
            calm = calm + 1 if k > 1 and (np.abs(x) <= 1e-17 * most).all() else 0
            if calm == 2:
                away[:count] = np.abs(series[1 : k + 1, first : first + count]).sum(axis=0)
                return k + 1
        return 0

    def reach(self, place: int, v: Climb, terms: int, series: Array, start: Array, away: Array) -> None:
        """Outputs at the start of an expanded motion, and how far they may get from there."""
        m, outs = self.phases[place].outputs, self.acting(place, v).outs[self.which]
        rows = np.array([self.term(place, v, k, series[k - 1], series[k]) for k in range(terms)])
        start[:m], away[:m] = (outs @ rows[0])[:m], (np.abs(outs) @ np.abs(rows[1:]).sum(axis=0))[:m]

    def complete(self, place: int, v: Climb, terms: int, series: Array) -> None:
        """Expand the outputs, too."""
        m, first = self.phases[place].outputs, self.states + up8(self.events(place))
        outs = self.acting(place, v).outs[self.which]
        for k in range(terms):
            series[k, first : first + m] = (outs @ self.term(place, v, k, series[k - 1], series[k]))[:m]

    def evaluate(self, series: Array, terms: int, t: float, out: Array) -> None:
        """Sum the series of the states at t."""
        out[: self.n] = np.polynomial.polynomial.polyval(t, series[:terms, : self.n])

    def move(self, series: Array, terms: int, t: float, out: Array, sizes: Array) -> None:
        """The same, and sum the magnitudes of their terms."""
        self.evaluate(series, terms, t, out)
        self.evaluate(np.abs(series), terms, t, sizes)

    def magnitudes(self, place: int, v: Climb, order: int, before: Array, x: Array, out: Array) -> None:
        """Multiply the magnitudes of the matrices by those of a term: of the states, of the accelerations and of 1."""
        now = np.abs(self.acting(place, v).now[self.which])
        out[: len(now)] = now @ self.term(place, (abs(v[0]), abs(v[1])), order, before, x)
