"""The loops of `march.c` in NumPy: slow, easy to follow, and an independent check of the compiled ones."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rockflex.engine.field import Field
from rockflex.engine.shaken import ShakenTables
from rockflex.engine.steps_twin import Steps
from rockflex.engine.system import Event, LinearPhase, NonlinearPhase, up8
from rockflex.engine.tables import AHEAD, BLOCK, SLOTS, Tables, tables_of, tables_of_nonlinear_phase
from rockflex.foundation.arrays import Array

UNKNOWN, ENDS, ASKED = -1, -2, -3
Climb = tuple[float, float]  # the vertical acceleration at the start of a series, and its change


def PyErr_CheckSignals() -> None:  # noqa: N802
    """Do nothing: the interpreter looks at Ctrl-C by itself."""


def lowest_of(r0: float, change: float, first: float, last: float) -> float:
    """The least value of r0 + change t + t (1 - t) ((1 - t) first - t last) for t from 0 to 1."""
    row = np.polynomial.Polynomial((r0, change + first, -2.0 * first - last, first + last))
    level = [t.real for t in row.deriv().roots() if 0.0 < t.real < 1.0 and t.imag == 0.0]
    return float(min(row(t) for t in (0.0, 1.0, *level)))


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
    """The tables and the outcomes of one phase."""

    def __init__(self, tables: Tables, events: Sequence[Event], h: float) -> None:
        self.tables, self.h, self.events = tables, h, events
        self.shaken: ShakenTables | None = None
        self.field: Field | None = None
        self.outcomes: list[Any] = [outcome for event in events for outcome in (event, event.rest)]
        self.following = [
            UNKNOWN if each is None else ASKED if callable(each.jump) else ENDS if each.target is None else UNKNOWN
            for each in self.outcomes
        ]


class Phases(Steps):
    """The phases that a run has met, each with the loops over its tables."""

    def __init__(self, one_sided: Array, states: int) -> None:
        super().__init__(states, one_sided.size)
        self.one_sided, self.which = one_sided > 0.0, 0
        self.phases: list[PhaseLoops] = []
        self.known: list[int] = []  # of each phase: 0 if its tables are forgotten, 2 if it has those when shaken

    def add(self, place: int, found: LinearPhase | NonlinearPhase, h: float) -> int:
        """Prepare a phase; of each of its events it is not known yet what follows, or known to be the end, or asked."""
        tables = tables_of(found, h) if isinstance(found, LinearPhase) else tables_of_nonlinear_phase(found)
        self.phases[place : place + 1] = [PhaseLoops(tables, found.events, h)]
        self.known[place : place + 1] = [1]
        return sum(each.nbytes for each in tables[4:])

    def drop(self, place: int) -> int:
        """Forget the tables of a phase; the memory that this frees, in bytes."""
        size = sum(each.nbytes for each in self.phases[place].tables[4:])
        self.known[place] = 0
        return size

    def has_tables(self, place: int, shakes: bool) -> bool:
        """Whether there are tables of a phase, and if it shakes, those for vertical acceleration."""
        return self.known[place] > shakes

    def set_vertical_tables(self, place: int, which: int, shaken: ShakenTables | None) -> int:
        """Take what a phase has under vertical acceleration; None if it has none."""
        del which
        self.phases[place].shaken, self.known[place] = shaken, 2
        return 0

    def parts(self, place: int) -> int:
        """Number of parts of y', whose magnitudes bound the rows."""
        return self.phases[place].tables.bend.shape[2] - 2

    def acts(self, place: int, v: Climb) -> ShakenTables | None:
        """What a phase has under a vertical acceleration and its change; None if that does not act."""
        return self.phases[place].shaken if any(v) else None

    def term(self, place: int, v: Climb, k: int, before: Array, x: Array) -> Array:
        """A term of a series: y, a, 1 and, if a vertical acceleration acts, that and what it multiplies."""
        shaken = self.acts(place, v)
        if shaken is None:
            return np.asarray(x[: self.n + 2])
        fed = v[0] * np.asarray(x)[shaken.places] + (v[1] * np.asarray(before)[shaken.places] if k else 0.0)
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
        return int(self.phases[place].tables.halvings[self.which])

    def shift(self, place: int, v: Climb) -> int:
        """Number of first states whose rates are as many states after them."""
        return (self.acts(place, v) or self.phases[place].tables).shift

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
        """Advance whole samples from i up to `last` as far as nothing happens; the number of the sample reached.

        All samples with vertical acceleration are left to power series.
        """
        end = last
        if len(v) and self.phases[place].shaken is not None:
            last = next((k for k in range(i, end) if v[k] or v[k + 1]), end)
        i = self._march(place, a, float(v[i]) if len(v) else 0.0, i, last, y, peaks, states)
        peaks.stopped = peaks.stopped or i == last < end
        return i

    def _march(
        self, place: int, a: Array, rise: float, i: int, last: int, y: Array, peaks: Peaks, states: Array
    ) -> int:
        p, k, x = self.phases[place].tables, self.which, np.array(y[: self.n])
        m, n, h, rows = p.outputs, self.n, self.phases[place].h, p.rows
        seen = self.acts(place, (rise, 0.0)) or p
        start, rates = np.array((*x, a[i], 1.0)), n - seen.shift
        start = self.term(place, (rise, 0.0), 0, start, start)
        old = np.concatenate(((seen.outs[k] @ start)[:m], (seen.now[k] @ start)[rates : rates + rows - m]))
        bend = cap = sway = jolt = np.zeros(rows)
        peaks.stopped = False

        def at_start(table: Array, y: Array, b: float) -> Array:
            return table[: rows * SLOTS : SLOTS, : n + 1] @ np.array((*y, b)) + table[: rows * SLOTS : SLOTS, -1]

        self._raise(peaks, old[:m], i)
        first, ahead, final = i, np.zeros(0), x
        while i < last:
            if (i - first) % BLOCK == 0:
                if peaks.kept + BLOCK > peaks.room or peaks.done >= peaks.pauses:
                    break
                changes = np.abs(np.diff(a[i : min(i + BLOCK, last) + 1]))
                parts = np.abs(p.moves[k][: p.bend.shape[2] - 2] @ np.array((*x, a[i], 1.0)))
                moves = np.array((*parts[:n], changes.sum(), changes.max() / h, *parts[n:]))
                bend, cap, sway, jolt = (each[k][:rows] @ moves for each in (p.bend, p.cap, p.sway, p.jolt))
            if (i - first) % AHEAD == 0:
                ground = np.array(a[i : min(i + AHEAD, last) + 1])
                ground = np.concatenate((ground, np.zeros(AHEAD + 1 - ground.size)))
                ahead = p.block[k] @ np.array((*x, *ground, 1.0))
                final = x + ahead[up8(AHEAD * rows) : up8(AHEAD * rows) + n]
            which = (i - first) % AHEAD
            new = ahead[which : AHEAD * rows : AHEAD]
            after = x + p.step[k][:n] @ np.array((*x, a[i], a[i + 1], 1.0))
            slopes = [at_start(p.slope[k], z, b) for z, b in ((x, a[i]), (after, a[i + 1]))]
            turns = np.maximum(4.0 * bend - np.abs(new - old), 0.0)
            excess = turns * (turns / np.maximum(16.0 * bend, 1e-300)) + cap
            beyond = np.minimum(excess, np.abs(slopes[1] - slopes[0]) * (h / 8.0) + sway)
            lowest, highest = np.minimum(old, new) - beyond, np.maximum(old, new) + beyond
            if p.bend.shape[2] - 2 > n:
                ends = [at_start(p.centre[k], z, b) for z, b in ((x, a[i]), (after, a[i + 1]))]
                lowest = np.maximum(lowest, np.minimum(*ends) - 0.5 * cap - bend)
                highest = np.minimum(highest, np.maximum(*ends) + 0.5 * cap + bend)
            ends = [each * h - (new - old - p.direct[k][:rows, 0] * (a[i + 1] - a[i])) for each in slopes]
            if any(
                lowest[j] <= 0.0 and lowest_of(old[j], new[j] - old[j], ends[0][j], ends[1][j]) <= jolt[j - m]
                for j in range(m, rows)
            ):
                peaks.stopped = True
                break
            above = np.maximum(self._counted(lowest[:m]), self._counted(highest[:m]))
            if (above > np.maximum(peaks.high[:m], self._counted(new[:m]))).any():
                peaks.candidates[peaks.kept, : 3 + n + m] = (place, i, 0, *x, *above)
                peaks.kept += 1
            x, old, i = final if which == AHEAD - 1 else after, new, i + 1
            peaks.done += 1
            self._raise(peaks, old[:m], i)
            if len(states) > 1:
                states[i] = x
        y[:n] = x
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
        p, count, first = self.acts(place, v) or self.phases[place].tables, self.events(place), self.states
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
        m, p = self.phases[place].tables.outputs, self.acts(place, v) or self.phases[place].tables
        rows = np.array([self.term(place, v, k, series[k - 1], series[k]) for k in range(terms)])
        start[:m] = (p.outs[self.which] @ rows[0])[:m]
        away[:m] = (p.most[self.which] @ np.abs(rows[1:]).sum(axis=0))[:m]

    def complete(self, place: int, v: Climb, terms: int, series: Array) -> None:
        """Expand the outputs, too."""
        m, first = self.phases[place].tables.outputs, self.states + up8(self.events(place))
        p = self.acts(place, v) or self.phases[place].tables
        for k in range(terms):
            row = self.term(place, v, k, series[k - 1], series[k])
            series[k, first : first + m] = (p.outs[self.which] @ row)[:m]

    def evaluate(self, series: Array, terms: int, t: float, out: Array) -> None:
        """Sum the series of the states at t."""
        out[: self.n] = np.polynomial.polynomial.polyval(t, series[:terms, : self.n])

    def move(self, series: Array, terms: int, t: float, out: Array, sizes: Array) -> None:
        """The same, and sum the magnitudes of their terms."""
        self.evaluate(series, terms, t, out)
        self.evaluate(np.abs(series), terms, t, sizes)

    def advance(self, place: int, a: Array, i: int, y: Array) -> None:
        """Do nothing: the states of samples that may have higher peaks are those at their starts."""

    def magnitudes(self, place: int, v: Climb, order: int, before: Array, x: Array, out: Array) -> None:
        """Multiply the magnitudes of the matrices by those of a term: of the states, of the accelerations and of 1."""
        magnitude = (self.acts(place, v) or self.phases[place].tables).magnitude[self.which]
        out[: len(magnitude)] = magnitude @ self.term(place, (abs(v[0]), abs(v[1])), order, before, x)
