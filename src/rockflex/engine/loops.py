"""The compiled loops of `march.c` as methods. Declarations: `loops.pxd`."""

import cython
import numpy as np
from cython.cimports.libc.math import INFINITY
from cython.cimports.libc.stdlib import calloc, free, malloc, realloc
from cython.cimports.rockflex.engine.field import Field, Jump
from cython.cimports.rockflex.engine.levels import ASKED, ENDS, LOOPS, MAX_ROWS, UNKNOWN, Climb, Phase, Shaken, Tables

from rockflex.engine import levels, tableau
from rockflex.engine import tables as preparing
from rockflex.engine.preparation import bounds_of, tables_of_phase
from rockflex.engine.shaken import shaken_of
from rockflex.engine.system import up8

LEVEL, GROUP = levels.LEVEL, levels.GROUP

NODES = cython.declare(cython.double[::1], tableau.C)
WEIGHTS = cython.declare(cython.double[:, ::1], tableau.SUMS)
MORE = cython.declare(cython.int, tableau.MORE)


@cython.cclass
class Peaks:
    """Highest values of the outputs, the samples at which they were reached, and samples that may have higher ones."""

    def __init__(self, one_sided, states, room):
        outputs: cython.int = one_sided.shape[0]
        self.high_, self.when_ = np.zeros(outputs), np.zeros(outputs)
        self.seen, self.candidates = np.zeros(MAX_ROWS + 8), np.zeros((room + 1, 3 + states + outputs))
        self.log.high, self.log.when = cython.address(self.high_[0]), cython.address(self.when_[0])
        self.log.seen, self.log.candidates = cython.address(self.seen[0]), cython.address(self.candidates[0, 0])
        self.log.room, self.log.width = room, 3 + states + outputs
        self.begin(one_sided)

    def __dealloc__(self):
        free(self.log.workspace)

    def widen(self, rows):
        """Make room for phases with so many outputs and conditions."""
        space: cython.size_t = LOOPS.workspace(rows)
        if space > self.space:
            free(self.log.workspace)
            self.log.workspace, self.space = malloc(space), space
            if self.log.workspace == cython.NULL:
                self.space = 0
                raise MemoryError
        return 0

    @property
    def size(self):
        """Memory of the room, bytes."""
        return self.space + self.candidates.nbytes + self.seen.nbytes

    def begin(self, one_sided):
        """Begin anew."""
        j: cython.int
        for j in range(one_sided.shape[0]):
            self.high_[j], self.when_[j] = -INFINITY if one_sided[j] > 0.0 else 0.0, 0.0
        self.log.resumes = self.log.count = self.log.looks = 0
        self.log.passed, self.log.work = 0.0, 0

    @property
    def high(self):
        """Highest value of every output."""
        return np.asarray(self.high_)

    @property
    def when(self):
        """The sample at which it was reached."""
        return np.asarray(self.when_)

    def set_sample_offset(self, samples):
        """Say how many samples come before the first of the present acceleration."""
        self.log.passed = samples

    def looks(self):
        """Whether the march has stopped before a sample in which a condition may fail."""
        return self.log.looks

    def count(self):
        """Number of samples that may have higher values."""
        return self.log.count

    def keep(self, count):
        """Keep so many of them, the first ones."""
        self.log.count = count

    def work(self):
        """Samples so far, and what counts like them."""
        return self.log.work

    def pause(self):
        """The work from which on the run looks up."""
        return self.log.pause

    def pause_at(self, work):
        """Set that."""
        self.log.pause = work

    def add_work(self, more):
        """Count more."""
        self.log.work += more

    def look(self, looks):
        """Say whether the march has stopped before a sample in which something may happen."""
        self.log.looks = looks

    def before(self):
        """Samples before the first of the present acceleration."""
        return self.log.passed


@cython.cclass
class Phases:
    """The phases that a run has met, each with the loops over its tables."""

    def __init__(self, one_sided, states):
        self.one_sided, self.n, self.states = one_sided, states, up8(states + 2)
        self.contents, self.offsets, self.shaken, self.count = [], [], [], 0
        self.fields, self.known = [], np.zeros(16, dtype=np.intc)
        self.rows, self.found = np.zeros((tableau.ROWS, self.states)), np.zeros((tableau.FOUND, one_sided.shape[0]))
        self.step.width, self.step.rates = self.states, cython.address(self.rows[0, 0])
        self.step.start, self.step.end = self.row(tableau.START), self.row(tableau.END)
        self.step.place, self.step.largest = self.row(tableau.PLACE), self.row(tableau.LARGEST)
        self.step.weights, self.step.nodes = cython.address(WEIGHTS[0, 0]), cython.address(NODES[0])

    def __dealloc__(self):
        k: cython.int
        for k in range(self.count):
            self.release(k)
        free(self.phases)

    def release(self, place):
        """Free the arrays of a phase."""
        phase: cython.pointer(Phase) = cython.address(self.phases[place])
        free(phase.jump)
        free(phase.rest)
        free(phase.following)
        free(phase.leaps)
        phase.jump = phase.rest = phase.following = phase.leaps = cython.NULL

    def drop(self, place: cython.int):
        """Forget the tables of a phase; the memory that this frees, in bytes."""
        size = self.contents[place][0].nbytes + (self.shaken[place][0].nbytes if self.shaken[place] else 0)
        self.contents[place] = self.offsets[place] = self.shaken[place] = None
        self.known[place] = 0
        self.release(place)
        return size

    def content(self, place: cython.int):
        """The tables of a phase, each system's in a row, and where each begins."""
        return self.contents[place][0], self.offsets[place]

    def has_tables(self, place, shakes):
        """Whether there are tables of a phase, and if it shakes, those for vertical acceleration."""
        return self.known[place] > shakes

    def add(self, place: cython.int, found, h):
        """Prepare a phase; of each of its events it is not known yet what follows, or known to be the end, or asked.

        Returns the memory of its tables in bytes.
        """
        size: cython.Py_ssize_t = (place + 1) * cython.sizeof(Phase)
        events = found.events
        count: cython.int = len(events)
        systems = len(found.C)
        outcomes, jumps, rests, more = preparing.parts_of_events(events, systems, GROUP)
        content, offsets, halvings, shape = tables_of_phase(found, h, more)
        if place == self.count:
            self.phases = cython.cast(cython.pointer(Phase), realloc(self.phases, size))
            self.contents.append(None)
            self.offsets.append(None)
            self.shaken.append(None)
            if place == self.known.shape[0]:
                self.known = np.concatenate((self.known, np.zeros(place, dtype=np.intc)))
            self.count += 1
        phase: cython.pointer(Phase) = cython.address(self.phases[place])
        phase.tables.n, phase.tables.outputs, phase.tables.h = self.n, len(found.d[0]), h
        phase.tables.rows, phase.tables.shift, phase.tables.parts, phase.tables.capped = shape
        phase.tables.shaken.now = cython.NULL
        phase.events = count
        phase.jump = cython.cast(
            cython.pointer(cython.p_const_double), calloc(2 * count + 1, cython.sizeof(cython.p_void))
        )
        phase.rest = cython.cast(cython.pointer(cython.p_const_double), calloc(count + 1, cython.sizeof(cython.p_void)))
        phase.following = cython.cast(cython.p_int, calloc(2 * count + 1, cython.sizeof(cython.int)))
        k: cython.int
        for k in range(2 * count):
            outcome = outcomes[k]
            phase.following[k] = (
                ASKED
                if outcome is not None and callable(outcome.jump)
                else ENDS
                if outcome is not None and outcome.target is None
                else UNKNOWN
            )
        phase.field = cython.NULL
        phase.leaps = cython.cast(cython.pointer(cython.p_void), calloc(count + 1, cython.sizeof(cython.p_void)))
        for k in range(count):
            if isinstance(events[k].jump, Jump):
                phase.leaps[k] = cython.cast(cython.p_void, events[k].jump)
        self.contents[place], self.offsets[place] = (content, halvings, jumps, rests, events), offsets
        self.known[place] = 1
        return content.nbytes

    def shake(self, place: cython.int, which, found, h):
        """Prepare what a phase has under vertical acceleration, and point to what one system has.

        Returns its memory in bytes.
        """
        shaken = shaken_of(found, h, bounds_of)
        self.known[place] = 2
        if shaken is None:
            return 0
        content, offsets = preparing.laid(shaken[3:], GROUP)
        self.shaken[place] = content, offsets, np.array([*shaken.places, shaken.shift, shaken.nodes], dtype=np.intc)
        self.bind_system(place, which)
        return content.nbytes

    def select(self, which):
        """Take the tables of one system of the stack."""
        place: cython.int
        for place in range(self.count):
            if self.known[place]:
                self.switch_system(place, which)

    def switch_system(self, place, which):
        """Take the tables of another system for one phase: they are as far away in every stack of tables."""
        phase: cython.pointer(Phase) = cython.address(self.phases[place])
        tables: cython.pointer(cython.p_const_double) = cython.address(phase.tables.block)
        others: cython.pointer(cython.p_const_double) = cython.address(phase.tables.shaken.now)
        more: cython.Py_ssize_t = (which - phase.which) * phase.stride
        k: cython.int
        for k in range(15):
            tables[k] += more
        phase.scale += more
        for k in range(2 * phase.events):
            if phase.jump[k] != cython.NULL:
                phase.jump[k] += more
        for k in range(phase.events):
            if phase.rest[k] != cython.NULL:
                phase.rest[k] += more
        phase.halvings, more = phase.halvings_of[which], (which - phase.which) * phase.shaken_stride
        phase.which = which
        if phase.tables.shaken.now != cython.NULL:
            for k in range(4):
                others[k] += more
            others = cython.address(phase.tables.shaken.limit)
            for k in range(18):
                others[k] += more

    def bind_system(self, place: cython.int, which: cython.int):
        """Take the tables of one system for one phase: those of the first, and then as `switch_system` does."""
        content, halvings, jumps, rests, _ = self.contents[place]
        offsets: cython.Py_ssize_t[::1] = self.offsets[place]
        row: cython.double[::1] = content[0]
        first: cython.p_double = cython.address(row[0])
        phase: cython.pointer(Phase) = cython.address(self.phases[place])
        tables: cython.pointer(cython.p_const_double) = cython.address(phase.tables.block)
        number: cython.const[cython.int][::1] = halvings
        k: cython.int
        for k in range(15):  # from `block` to `border`, as in `march.h`
            tables[k] = first + offsets[k]
        phase.tables.one_sided = cython.address(self.one_sided[0])
        phase.scale, phase.halvings_of = first + offsets[15], cython.address(number[0])
        phase.which, phase.stride = 0, row.shape[0]
        part: cython.int = 16
        for k in range(2 * phase.events):
            if jumps[k] is not None:
                phase.jump[k] = first + offsets[part]
                part += 1
        for k in range(phase.events):
            if rests[k] is not None:
                phase.rest[k] = first + offsets[part]
                part += 1
        if self.shaken[place] is not None:
            self.point_shaken(place)
        self.switch_system(place, which)

    def point_shaken(self, place: cython.int):
        """Take what the first system has under vertical acceleration in one phase."""
        content, bounds, numbers = self.shaken[place]
        offsets: cython.Py_ssize_t[::1] = bounds
        row: cython.double[::1] = content[0]
        places: cython.int[::1] = numbers
        first: cython.p_double = cython.address(row[0])
        s: cython.pointer(Shaken) = cython.address(self.phases[place].tables.shaken)
        s.fed, s.places = places.shape[0] - 2, cython.address(places[0])
        s.shift, s.nodes = places[s.fed], places[s.fed + 1]
        self.phases[place].shaken_stride = row.shape[0]
        tables: cython.pointer(cython.p_const_double) = cython.address(s.now)
        others: cython.pointer(cython.p_const_double) = cython.address(s.limit)
        k: cython.int
        for k in range(4):  # from `now` to `most`, as in `march.h`
            tables[k] = first + offsets[k]
        for k in range(4, 22):  # from `limit` to the last of `swell`
            others[k - 4] = first + offsets[k]

    def set_next_phase(self, place, outcome, following):
        """Say which phase follows an outcome."""
        self.phases[place].following[outcome] = following

    def events(self, place):
        """Number of events of a phase."""
        return self.phases[place].events

    def halvings(self, place):
        """How often the step must be halved so that power series converge."""
        return self.phases[place].halvings

    def shift(self, place, v):
        """Number of first states whose rates are as many states after them."""
        tables: cython.pointer(Tables) = cython.address(self.phases[place].tables)
        if tables.shaken.now != cython.NULL and (v[0] != 0.0 or v[1] != 0.0):
            return tables.shaken.shift
        return tables.shift

    def scale(self, place, event):
        """Size of a violation of a condition."""
        return self.phases[place].scale[event]

    def following(self, place, outcome):
        """Place of the phase that follows an outcome, or UNKNOWN, ENDS or ASKED."""
        return self.phases[place].following[outcome]

    def jump(self, place, outcome, magnitudes, y, workspace):
        """Multiply a state by the matrix of an outcome, or magnitudes by its magnitudes; whether there is one."""
        table: cython.p_const_double = self.phases[place].jump[outcome]
        wide: cython.int = (self.n + 7) // 8 * 8
        i: cython.int
        if table == cython.NULL:
            return 0
        for i in range(self.n):
            workspace[i] = y[i]
        if magnitudes:
            table += self.n * wide
        LOOPS.product(self.n, wide, table, cython.address(workspace[0]), cython.address(y[0]))
        return 1

    def rests(self, place, event, y, a, v):
        """Whether the motion is too slow after an event."""
        row: cython.p_const_double = self.phases[place].rest[event]
        k: cython.int
        total: cython.double
        if row == cython.NULL:
            return 0
        total = row[self.n] * a + row[self.n + 1]
        for k in range(self.n):
            total += row[k] * y[k]
        if v != 0.0:
            row += self.n + 2
            total += v * row[self.n]
            for k in range(self.n):
                total += v * row[k] * y[k]
        return total <= 0.0

    def march(self, place, a, v, i, last, y, peaks, states):
        """Advance whole samples from i up to `last` as far as nothing happens; the number of the sample reached."""
        log: cython.pointer(Log) = cython.address(peaks.log)
        log.states = cython.address(states[0, 0]) if states.shape[0] > 1 else cython.NULL
        vertical: cython.p_const_double = cython.address(v[0]) if v.shape[0] > 0 else cython.NULL
        tables: cython.pointer(Tables) = cython.address(self.phases[place].tables)
        return LOOPS.march(tables, place, cython.address(a[0]), vertical, i, last, cython.address(y[0]), log)

    def advance(self, place, a, i, y):
        """Advance over the sample i, without vertical acceleration and whatever happens."""
        first: cython.p_double = cython.address(y[0])
        LOOPS.advance(cython.address(self.phases[place].tables), cython.address(a[i]), first, first)

    def expand(self, place, h, a, rise, v, y, series, away):
        """Expand states and conditions; the number of terms, 0 if too many, and how far each condition may get."""
        width: cython.int = series.shape[1]
        tables: cython.pointer(Tables) = cython.address(self.phases[place].tables)
        first: cython.p_double = cython.address(series[0, 0])
        room: cython.int = series.shape[0]
        terms: cython.int = LOOPS.expand(tables, h, a, rise, climb(v), cython.address(y[0]), room, width, first)
        LOOPS.spread(tables.rows - tables.outputs, terms, width, first + self.states, cython.address(away[0]))
        return terms

    def reach(self, place, v, terms, series, start, away):
        """Outputs at the start of an expanded motion, and how far they may get from there."""
        tables: cython.pointer(Tables) = cython.address(self.phases[place].tables)
        first: cython.p_double = cython.address(series[0, 0])
        LOOPS.reach(tables, climb(v), terms, series.shape[1], first, cython.address(start[0]), cython.address(away[0]))

    def complete(self, place, v, terms, series):
        """Expand the outputs, too."""
        tables: cython.pointer(Tables) = cython.address(self.phases[place].tables)
        LOOPS.complete(tables, climb(v), terms, series.shape[1], cython.address(series[0, 0]))

    def evaluate(self, series, terms, t, out):
        """Sum the series of the states at t."""
        LOOPS.evaluate(self.states, terms, series.shape[1], cython.address(series[0, 0]), t, cython.address(out[0]))

    def move(self, series, terms, t, out, sizes):
        """The same, and sum the magnitudes of their terms."""
        first: cython.p_double = cython.address(series[0, 0])
        LOOPS.move(self.states, terms, series.shape[1], first, t, cython.address(out[0]), cython.address(sizes[0]))

    def magnitudes(self, place, v, order, before, x, out):
        """Multiply the magnitudes of the matrices by those of a term: of the states, of the accelerations and of 1."""
        tables: cython.pointer(Tables) = cython.address(self.phases[place].tables)
        LOOPS.magnitudes(
            tables, climb(v), order, cython.address(before[0]), cython.address(x[0]), cython.address(out[0])
        )

    # Phases that are not linear

    def set_field(self, place: cython.int, field: Field, floor, counted: cython.int):
        """Say that a phase is not linear: its field, the least sizes of its moving states, and states with rates."""
        least = np.full(up8(self.n + 2), np.inf)
        least[: len(floor)] = floor
        known: cython.double[::1] = least
        phase: cython.pointer(Phase) = cython.address(self.phases[place])
        phase.field, phase.floor = cython.cast(cython.p_void, field), cython.address(known[0])
        phase.moving, phase.counted = len(floor), counted
        self.fields.append((field, least))
        if self.found.shape[1] < up8(phase.events):
            self.found = np.zeros((tableau.FOUND, up8(phase.events)))

    def nonlinear(self, place):
        """Whether a phase is not linear."""
        return self.phases[place].field != cython.NULL

    def moving(self, place):
        """Number of states on which the rates of a phase depend."""
        return self.phases[place].moving

    def leap(self, place, event, y, a, a_v):
        """Do what the `Jump` of an event says; -2 if it has none."""
        jump: cython.p_void = self.phases[place].leaps[event]
        if jump == cython.NULL:
            return -2
        return cython.cast(Jump, jump).apply(cython.address(y[0]), a, a_v)

    def row(self, number):
        """A row of the states of a step or of their rates, see `tableau`."""
        return cython.address(self.rows[number, 0])

    def begin(self, place):
        """Let the constant states add to the constants of the conditions."""
        cython.cast(Field, self.phases[place].field).enter(self.step.start, cython.address(self.found[MORE, 0]))

    def rates(self, place, a, a_v, at, to, counted):
        """Compute the rates of the states in a row."""
        rates_of(self.phases[place].field, self.row(at), a, a_v, self.row(to), counted)

    def terms_of_rates(self, place, a, a_v, at, to):
        """Compute the magnitudes of the terms of the rates."""
        cython.cast(Field, self.phases[place].field).sizes(self.row(at), a, a_v, self.row(to))

    def attempt(self, place, length, a, rise, v, climb, counted):
        """Take the stages of a step from the first one on; its error over the sizes of the states."""
        self.step.length, self.step.a, self.step.rise, self.step.v, self.step.climb = length, a, rise, v, climb
        return LOOPS.attempt(cython.address(self.phases[place]), cython.address(self.step), rates_of, counted)

    def within(self, place, stage):
        """Compute the state at which a stage of a step has been evaluated."""
        LOOPS.within(cython.address(self.phases[place]), cython.address(self.step), stage)

    def bend(self, place, counted, series):
        """Fill the series with the polynomials of the states over the step that was attempted."""
        phase: cython.pointer(Phase) = cython.address(self.phases[place])
        first: cython.p_double = cython.address(series[0, 0])
        LOOPS.bend(phase, cython.address(self.step), rates_of, counted, series.shape[1], first)

    def look(self, place, outputs, v, k, before, at, to):
        """Compute the outputs or conditions of a row that has y, a and 1, those that are not linear as their rows say.

        It is the term of order k of a series under the vertical acceleration v, whose term before is another row.
        """
        phase: cython.pointer(Phase) = cython.address(self.phases[place])
        found: cython.p_double = cython.address(self.found[to, 0])
        LOOPS.look(phase, outputs, climb(v), k, self.row(before), self.row(at), found)

    def observe(self, place, a, a_v, at, rates, to):
        """Replace the outputs that are not linear."""
        found: cython.p_double = cython.address(self.found[to, 0])
        cython.cast(Field, self.phases[place].field).observe(self.row(at), self.row(rates), a, a_v, found)

    def check(self, place, a, a_v, at, rates, to):
        """Replace the conditions that are not linear."""
        found: cython.p_double = cython.address(self.found[to, 0])
        cython.cast(Field, self.phases[place].field).conditions(self.row(at), self.row(rates), a, a_v, found)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def rates_of(
    field: cython.p_void,
    y: cython.p_const_double,
    a: cython.double,
    a_v: cython.double,
    out: cython.p_double,
    counted: cython.int,
) -> cython.void:
    """Compute the rates of a `Field`."""
    cython.cast(Field, field).rates(y, a, a_v, out, counted)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def climb(v: tuple[cython.double, cython.double]) -> Climb:
    """A vertical acceleration and its change, as C has them."""
    found: Climb
    found.start, found.rise = v[0], v[1]
    return found
