"""Advance a hybrid system of linear phases: whole samples at once, power series where something may happen.

The march stops before a sample in which a condition may fail. There the motion is expanded in a power series, whose
polynomials give the first event to rounding; then the state jumps, and the next phase takes over the rest of the
sample. Peaks never decide how the state advances, so that what is asked of a run does not change it.
"""

from math import fabs, isfinite

import cython
import numpy as np

from rockflex._errors import InputError, SolverError
from rockflex.engine.rest import decay_of, time_to_rest
from rockflex.engine.system import StepTooLongError, acceleration, array, up8
from rockflex.engine.tables import tables_of

if cython.compiled:
    from cython.cimports.cpython.exc import PyErr_CheckSignals
    from cython.cimports.libc.math import fabs, isfinite
    from cython.cimports.rockflex.engine.journal import Journal
    from cython.cimports.rockflex.engine.loops import ASKED, ENDS, UNKNOWN, Peaks, Phases
    from cython.cimports.rockflex.engine.polynomials import first_fall, highest
else:
    from rockflex.engine.journal import Journal
    from rockflex.engine.loops_twin import ASKED, ENDS, UNKNOWN, Peaks, Phases, PyErr_CheckSignals
    from rockflex.engine.polynomials import first_fall, highest

TERMS = cython.declare(cython.int, 48)  # of a series, at most
ORDERS = cython.declare(cython.int, 5)  # derivatives of a condition that may vanish at the start of a phase
VANISHES = cython.declare(cython.double, 1e-12)  # of the sum of the magnitudes of its terms: a condition that is zero
SNAP = cython.declare(cython.double, 1e-13)  # of a step: an event this close to its end is left to the next one
AT_ONCE = cython.declare(cython.int, 100)  # events at one instant, at most
IN_SAMPLE = cython.declare(cython.int, 20000)  # events in one sample, at most
CANDIDATES = cython.declare(cython.int, 64)  # samples that are kept for a closer look at their peaks
STRETCH = cython.declare(cython.int, 65536)  # samples, or what counts like them, without a look at Ctrl-C
SHORT = cython.declare(cython.int, 60000)  # samples times states that are run under the interpreter's lock
QUIET = cython.declare(cython.int, 64)  # samples without excitation before it is asked whether all is at rest
EXPANSION = cython.declare(cython.int, 16)  # samples that a power series counts like


@cython.cclass
class Run:
    """One run of a system from an initial state; its phases are obtained as they are met.

    Parameters
    ----------
    system, h
        The system, and the time step.
    state, key
        State, shape (n,), and key of the phase at time 0; zero, and that of the system, by default.
    which
        Which system of a stack.

    Attributes
    ----------
    ended
        Whether an event without a next phase has happened; otherwise the run stands at the end of a sample.
    failure : str
        Why the run has failed: "accumulation" of events, "growth" without bound, "work" beyond the limit; or empty.
    watch : callable
        Called now and then during a run; it may end the run by an exception.
    limit : int
        The `work` that the run may take.
    """

    system = cython.declare(object, visibility="readonly")
    h = cython.declare(cython.double, visibility="readonly")
    which = cython.declare(cython.int, visibility="readonly")
    ended = cython.declare(cython.bint, visibility="readonly")
    watch = cython.declare(object, visibility="public")
    limit = cython.declare(cython.longlong, visibility="public")
    pause: cython.longlong  # the work at which the run looks up next
    failure = cython.declare(str, visibility="readonly")
    failed: cython.bint
    reached: cython.Py_ssize_t  # samples of this call of `advance` that have passed
    met: list  # phases met so far: keys and phases
    places: dict  # of the phases, by their keys
    decays: dict  # of the phases in which a free vibration has been asked for its end, by place and system
    phases: Phases
    now: cython.int  # place of the present phase
    n: cython.int
    states: cython.int  # rows of the states in tables and series, a multiple of 8
    outputs: cython.int
    y: cython.double[::1]  # and zeros, to a multiple of 8; so in `sizes` and `before`
    one_sided: cython.double[::1]
    peaks_: Peaks
    high: cython.double[::1]
    when: cython.double[::1]
    series: cython.double[:, ::1]  # a row of coefficients for each power: states, outputs, conditions
    sums: cython.double[:, ::1]  # the same for the first powers: magnitudes of the terms of a coefficient
    away: cython.double[::1]  # of outputs and conditions: how far the expanded motion may get from its start
    sizes: cython.double[::1]  # of the states: magnitudes of the terms that they were summed from
    workspace: cython.double[::1]
    scratch: cython.double[:, ::1]  # the states of a march, if there is a history; otherwise of one row
    before: cython.double[::1]  # the state, while the motion in another sample is expanded
    q: cython.double[::1]  # polynomials
    slope: cython.double[::1]
    passed: cython.Py_ssize_t  # samples, before this call of `advance`
    end: cython.double  # time of the last event
    journal: Journal
    n_looks: cython.int  # samples expanded for events, and for peaks
    n_searched: cython.int

    def __init__(self, system, h, state=None, key=None, which: cython.int = 0):
        if not (h > 0.0 and isfinite(h)):
            raise InputError(f"The time step must be a positive number, but {h!r} was given.")
        self.system, self.h, self.met, self.places, self.decays = system, h, [], {}, {}
        self.n, self.outputs = system.layout.size, len(system.outputs)
        self.states = up8(self.n)
        one_sided = np.zeros(up8(max(1, self.outputs)))
        one_sided[[list(system.outputs).index(name) for name in system.one_sided]] = 1.0
        self.one_sided, self.phases = one_sided, Phases(one_sided, self.n)
        self.peaks_ = Peaks(one_sided, self.n, CANDIDATES)
        self.high, self.when = self.peaks_.high, self.peaks_.when
        self.series, self.sums, self.away = np.zeros((TERMS, 0)), np.zeros((ORDERS, 0)), np.zeros(0)
        self.y, self.sizes, self.before = np.zeros(self.states), np.zeros(self.states), np.zeros(self.states)
        self.workspace, self.q, self.slope = np.zeros(self.states + 8), np.zeros(TERMS), np.zeros(TERMS)
        self.journal, self.scratch = Journal(self.n), np.zeros((1, self.n))
        self.watch, self.limit, self.which = None, 2**62, 0
        self.restart(state, key, which)

    def restart(self, state=None, key=None, which: cython.int = 0):
        """Begin anew at time 0, with the phases met so far."""
        i: cython.int
        if not 0 <= which < self.system.count:
            raise InputError(f"There are {self.system.count} systems in the stack, but number {which} was asked for.")
        if which != self.which:
            self.which = which
            self.phases.select(which)
        self.peaks_.begin(self.one_sided)
        given: cython.double[::1] = self.before
        if state is not None:
            given = array("the state", state, (self.n,))
        for i in range(self.n):
            self.y[i] = given[i] if state is not None else 0.0
            self.sizes[i] = 0.0
        self.ended, self.failed, self.failure, self.passed, self.end, self.pause = False, False, "", 0, 0.0, 0
        self.reached = 0
        self.journal.begin()
        self.n_looks = self.n_searched = 0
        self.now = self.enter(self.system.start if key is None else key)

    @property
    def key(self):
        """Key of the present phase."""
        return self.met[self.now][0]

    @property
    def time(self):
        """Present time."""
        return self.end if self.ended else (self.passed + self.reached) * self.h

    @property
    def state(self):
        """A copy of the present state, shape (n,)."""
        return np.array(self.y[: self.n])

    @property
    def highest(self):
        """Highest value of every output, and its time: two rows, shape (2, m)."""
        found = np.array((self.high, self.when))[:, : self.outputs]
        found[1] *= self.h
        return found

    @property
    def peaks(self):
        """Highest value of every output and its time, by name."""
        return dict(zip(self.system.outputs, zip(*self.highest.tolist(), strict=True), strict=True))

    @property
    def events(self):
        """Time, key of the phase that it ended, and name of every event."""
        times, places, numbers = self.journal.events
        met = [self.met[place] for place in places]
        return [(t, m[0], m[1].events[e].name) for t, m, e in zip(times, met, numbers, strict=True)]

    def tally(self, *names):
        """Numbers of events of these names."""
        found = dict.fromkeys(names, 0)
        for place, event, often in self.journal.tally():
            name = self.met[place][1].events[event].name
            if name in found:
                found[name] += often
        return [found[name] for name in names]

    @property
    def work(self):
        """Samples so far, and power series, each of which counts like 16 samples: the same on every machine."""
        return self.peaks_.work()

    @property
    def counts(self):
        """Numbers of phases, of samples expanded for events, and of samples expanded for peaks."""
        return len(self.met), self.n_looks, self.n_searched

    @property
    def history(self):
        """Times, keys, accelerations and states at samples and on both sides of every event, if they were kept."""
        samples, places, accelerations, states = self.journal.nodes
        return samples * self.h, [self.met[place][0] for place in places], accelerations, states

    @cython.cfunc
    @cython.exceptval(-1)
    def enter(self, key) -> cython.int:
        """Return the place of the phase of a key."""
        try:
            hash(key)
        except TypeError as error:
            raise InputError(f"The key {key!r} of a phase must be hashable, as a tuple is.") from error
        if key in self.places:
            return self.places[key]
        phase = self.system.checked(key)
        tables = tables_of(phase, self.h)
        if not np.isfinite(tables.step).all():
            words = f"phase {key!r}: the motion grows without bound within one time step of {self.h:.9g}."
            raise StepTooLongError(words, float(np.linalg.eigvals(phase.A).real.max()))
        place: cython.int = len(self.met)
        self.phases.add(tables, phase.events, self.h)
        self.phases.point(place, self.which)
        self.met.append((key, phase))
        self.places[key] = place
        width: cython.int = self.states + up8(tables.rows)
        if self.series.shape[1] < width:
            self.series, self.sums, self.away = np.zeros((TERMS, width)), np.zeros((ORDERS, width)), np.zeros(width)
        return place

    def advance(self, a, history: cython.bint = False):
        """Advance over the samples of an acceleration, of which the first is that of the present time.

        Raises
        ------
        InputError
            If the acceleration is empty or not finite.
        SolverError
            If the run has failed, as `failure` says, or had failed before.
        """
        self.proceed(acceleration(a), history)

    @cython.cfunc
    def proceed(self, ground: cython.const[cython.double][::1], history: cython.bint):
        """Advance over the samples of an acceleration that has been checked."""
        if self.failed:
            raise SolverError("This run has been broken off by an error; begin it anew by `restart`.")
        self.failed = True
        self.peaks_.passed = self.passed
        i: cython.int
        k: cython.int
        last: cython.int = ground.shape[0] - 1
        keeps: cython.bint = history and not self.ended
        rows: cython.int = last + 1 if keeps and last > 0 else 1
        if self.scratch.shape[0] < rows or (rows == 1 and self.scratch.shape[0] > 1):
            self.scratch = np.zeros((rows, self.n))
        if last * self.n < SHORT:  # giving the lock away and waiting for it would take longer
            i = self.advance_over(ground, keeps, self.scratch)
        else:
            with cython.nogil:
                i = self.advance_over(ground, keeps, self.scratch)
        self.passed += i
        self.reached = 0
        for k in range(self.n):
            if not isfinite(self.y[k]):
                self.failure = "growth"
                raise SolverError(
                    f"The motion in the phase {self.key!r} grows without bound before t = {self.time:.9g}."
                )
        self.failed = False

    def coast(self, samples: int, *, history: bool = False) -> None:
        """Advance without excitation over so many samples, in the same pieces as `settle`."""
        quiet: cython.const[cython.double][::1] = np.zeros(QUIET + 1)
        while samples > 0 and not self.ended:
            self.proceed(quiet[: min(samples, QUIET) + 1], history)
            samples -= QUIET

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def advance_over(
        self, a: cython.const[cython.double][::1], history: cython.bint, states: cython.double[:, ::1]
    ) -> cython.int:
        """Advance over samples; return how many have passed."""
        i: cython.int = 0
        j: cython.int
        start: cython.int
        stop: cython.int
        last: cython.int = a.shape[0] - 1
        if history and self.journal.wants(a[0]):
            self.journal.keep(self.passed, a[0], self.y, self.now)
        while i < last and not self.ended:
            start, stop = i, min(last, (i // STRETCH + 1) * STRETCH)
            i = self.phases.march(self.now, a, i, stop, self.y, self.peaks_, states)
            if i > start:
                self.sizes[:] = 0.0
            if history:
                for j in range(start + 1, i + 1):
                    self.journal.keep(self.passed + j, a[j], states[j], self.now)
            self.reached = i
            if self.peaks_.looks():
                self.traverse(i, a[i], a[i + 1], history)
                i += 1
            elif i < stop:
                self.search(a, False)
            self.look_up()
        self.search(a, True)
        return i

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def look_up(self) -> cython.int:
        """After a stretch of work, see whether the run must end."""
        if self.peaks_.work() >= self.pause:
            with cython.gil:
                PyErr_CheckSignals()
                if self.watch is not None:
                    self.watch()
                if self.peaks_.work() > self.limit:
                    self.failure = "work"
                    raise SolverError(f"The run has reached the limit of its work, {self.limit} samples.")
                self.pause = min(self.limit + 1, self.peaks_.work() + STRETCH)
        return 0

    def settle(self, most: int = 1_000_000, *, history: bool = False) -> bool:
        """Advance without excitation until nothing can follow, and return whether that was so after `most` samples.

        At rest no condition can fail any more, and no output exceed its peak.
        """
        quiet: cython.const[cython.double][::1] = np.zeros(QUIET + 1)
        start: cython.Py_ssize_t = self.passed
        n_events: cython.int = -1
        outputs, asks = slice(0, self.outputs), 0.0
        while not self.ended:
            if self.journal.n_events > n_events or self.passed * self.h >= asks:
                n_events = self.journal.n_events
                if (self.now, self.which) not in self.decays:
                    self.decays[self.now, self.which] = decay_of(self.met[self.now][1].of(self.which))
                y, high, one_sided = np.asarray(self.y), np.asarray(self.high), np.asarray(self.one_sided)
                wait = time_to_rest(self.decays[self.now, self.which], y[: self.n], high[outputs], one_sided[outputs])
                if wait == 0.0:
                    return True
                asks = self.passed * self.h + wait
            if self.passed - start >= most:
                break
            self.proceed(quiet, history)
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def expand(self, start: cython.double, end: cython.double, u: cython.double) -> tuple[cython.double, cython.int]:
        """Expand the motion from the place u of a sample, as far as a series serves: the part of it, and the terms."""
        part: cython.double = min(1.0 - u, 0.5 ** self.phases.halvings(self.now))
        terms: cython.int = 0
        while True:
            self.peaks_.add_work(EXPANSION)
            terms = self.phases.expand(
                self.now, part * self.h, start + (end - start) * u, (end - start) * part, self.y, self.series, self.away
            )
            if terms > 0:
                return part, terms
            part *= 0.5

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def traverse(self, i: cython.int, start: cython.double, end: cython.double, history: cython.bint) -> cython.int:
        """Advance over a sample in which something may happen."""
        u: cython.double = 0.0  # the part of the sample that has passed
        part: cython.double
        t: cython.double
        terms: cython.int
        event: cython.int
        at_once: cython.int = 0
        in_sample: cython.int = 0
        self.n_looks += 1
        while u < 1.0:
            self.look_up()
            part, terms = self.expand(start, end, u)
            t, event = self.first_event(terms, part * self.h, start + (end - start) * u, (end - start) * part)
            if t > 0.0:
                self.raise_peaks(terms, t, self.passed + i + u, part)
                self.phases.amounts(self.series, terms, t, self.sizes)
                self.phases.evaluate(self.series, terms, t, self.y)
                at_once = 0
            if event < 0:
                u = u + part if part < 1.0 - u else 1.0
                continue
            u += t * part
            at_once += 1
            in_sample += 1
            if at_once > AT_ONCE or in_sample > IN_SAMPLE:
                with cython.gil:
                    key, phase = self.met[self.now]
                    self.failure = "accumulation"
                    raise SolverError(
                        f"Events of the phase {key!r}, such as {phase.events[event].name!r}, accumulate without end at "
                        f"t = {(self.passed + i + u) * self.h:.9g}."
                    )
            if history and at_once == 1:
                self.journal.keep(self.passed + i + u, start + (end - start) * u, self.y, self.now)
            self.leave(event, self.passed + i + u, start + (end - start) * u)
            if self.ended:
                return 0
            if history:
                self.journal.keep(self.passed + i + u, start + (end - start) * u, self.y, self.now)
        if history:
            self.journal.keep(self.passed + i + 1, end, self.y, self.now)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def first_event(
        self, terms: cython.int, h: cython.double, a: cython.double, rise: cython.double
    ) -> tuple[cython.double, cython.int]:
        """Where in the step the first condition fails, and which; 1 and -1 if none does.

        At its start a condition may be zero, because the last event was its own, or due to rounding: then its first
        derivative that is not zero decides, and the zeros are divided out. Of several conditions that have failed from
        the start that of the lowest derivative, and then of the largest violation over its scale, is the first.
        """
        first_row: cython.int = self.states + self.outputs
        e: cython.int
        k: cython.int
        row: cython.int
        zeros: cython.int
        summed: cython.int = 0
        lowest: cython.int = ORDERS
        found: cython.int = -1
        worst: cython.double = 0.0
        first: cython.double = 1.0
        t: cython.double
        for e in range(self.phases.events(self.now)):
            row = first_row + e
            if self.series[0, row] > self.away[self.outputs + e]:
                continue
            zeros = 0
            while zeros < ORDERS:
                if zeros == summed:
                    self.sum_up(summed, h, a, rise)
                    summed += 1
                if fabs(self.series[zeros, row]) > VANISHES * self.sums[zeros, row]:
                    break
                zeros += 1
            if zeros == ORDERS:
                continue
            if self.series[zeros, row] < 0.0:
                t = -self.series[zeros, row] / self.phases.scale(self.now, e)
                if zeros < lowest or (zeros == lowest and t > worst):
                    lowest, worst, found, first = zeros, t, e, 0.0
                continue
            if first > 0.0:
                for k in range(terms):
                    self.q[k] = self.series[k, row]
                t = first_fall(self.q, zeros, terms - zeros, 0.0, first)
                if t <= 1.0 - SNAP and (t < first or found < 0):
                    first, found = t, e
        return first, found

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def sum_up(self, order: cython.int, h: cython.double, a: cython.double, rise: cython.double) -> cython.void:
        """Sum the magnitudes of the terms of coefficients of an order: what their rounding is relative to."""
        i: cython.int
        for i in range(self.n):
            self.workspace[i] = (
                max(fabs(self.y[i]), self.sizes[i]) if order == 0 else self.sums[order - 1, i] * h / order
            )
        self.workspace[self.n] = fabs(a) if order == 0 else fabs(rise) if order == 1 else 0.0
        self.workspace[self.n + 1] = 1.0 if order == 0 else 0.0
        self.phases.magnitudes(self.now, self.workspace, self.sums[order])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def leave(self, event: cython.int, sample: cython.double, a: cython.double) -> cython.int:
        """Jump to the phase that follows an event."""
        outcome: cython.int = 2 * event
        self.end = sample * self.h
        self.journal.happen(self.end, self.now, event)
        if self.phases.following(self.now, outcome) == ASKED:
            with cython.gil:
                self.ask(event, a)
            return 0
        self.take(outcome)
        if self.phases.rests(self.now, event, self.y, a):
            outcome += 1
            self.take(outcome)
        following: cython.int = self.phases.following(self.now, outcome)
        if following == UNKNOWN:
            with cython.gil:
                left = self.met[self.now][1].events[event]
                following = self.enter(left.target if outcome == 2 * event else left.rest.target)
                self.phases.lead(self.now, outcome, following)
        if following == ENDS:
            self.ended = True
        else:
            self.now = following
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def take(self, outcome: cython.int) -> cython.void:
        """Multiply the state by the matrix of an outcome."""
        if self.phases.jump(self.now, outcome, False, self.y, self.workspace):
            self.phases.jump(self.now, outcome, True, self.sizes, self.workspace)

    @cython.cfunc
    def ask(self, event: cython.int, a: cython.double):
        """Let a function say what follows an event."""
        y, sizes = np.asarray(self.y)[: self.n], np.asarray(self.sizes)[: self.n]
        y[:], target = self.met[self.now][1].events[event].ask(y, a)
        np.maximum(sizes, np.abs(y), out=sizes)
        if target is None:
            self.ended = True
        else:
            self.now = self.enter(target)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def raise_peaks(
        self, terms: cython.int, stop: cython.double, sample: cython.double, part: cython.double
    ) -> cython.void:
        """Raise the peaks to those of the expanded motion."""
        j: cython.int
        start: cython.double
        for j in range(self.outputs):
            start = self.series[0, self.states + j]
            if (start if self.one_sided[j] > 0.0 else fabs(start)) + self.away[j] > self.high[j]:
                self.raise_peak(j, terms, stop, 1e300, sample, part)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def raise_peak(
        self,
        j: cython.int,
        terms: cython.int,
        stop: cython.double,
        bound: cython.double,
        sample: cython.double,
        part: cython.double,
    ) -> cython.void:
        """Raise the peak of an output to that of its polynomial, which is known to be at most `bound`."""
        k: cython.int
        found: cython.double
        t: cython.double
        for k in range(terms):
            self.q[k] = self.series[k, self.states + j]
        found, t = highest(self.q, self.slope, terms, 0.0 if self.away[j] == 0.0 else stop, self.one_sided[j] > 0.0)
        if min(found, bound) > self.high[j]:
            self.high[j], self.when[j] = min(found, bound), sample + t * part

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def search(self, a: cython.const[cython.double][::1], finish: cython.bint) -> cython.int:
        """Drop candidates below the peaks found so far; search the others at the end, or if there is no room."""
        r: cython.int
        j: cython.int
        i: cython.int
        kept: cython.int = 0
        terms: cython.int
        higher: cython.bint
        u: cython.double
        part: cython.double
        rows: cython.double[:, ::1] = self.peaks_.candidates
        for r in range(self.peaks_.count()):
            higher = False
            for j in range(self.outputs):
                higher = higher or rows[r, 2 + self.n + j] > self.high[j]
            if higher:
                rows[kept, :] = rows[r, :]
                kept += 1
        self.peaks_.keep(kept)
        if kept == 0 or (not finish and kept <= CANDIDATES // 2):
            return 0
        now: cython.int = self.now
        self.before[:] = self.y
        for r in range(kept):
            self.now, i = cython.cast(cython.int, rows[r, 0]), cython.cast(cython.int, rows[r, 1])
            self.y[: self.n] = rows[r, 2 : 2 + self.n]
            self.n_searched += 1
            u = 0.0
            while u < 1.0:
                self.look_up()
                part, terms = self.expand(a[i], a[i + 1], u)
                for j in range(self.outputs):
                    if rows[r, 2 + self.n + j] > self.high[j]:
                        self.raise_peak(j, terms, 1.0, rows[r, 2 + self.n + j], self.passed + i + u, part)
                self.phases.evaluate(self.series, terms, 1.0, self.y)
                u = u + part if part < 1.0 - u else 1.0
        self.now = now
        self.y[:] = self.before
        self.peaks_.keep(0)
        return 0
