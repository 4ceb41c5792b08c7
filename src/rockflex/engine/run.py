"""Advance a hybrid system of linear phases: whole samples at once, power series where something may happen.

The march stops before a sample in which a condition may fail. There the motion is expanded in a power series, whose
polynomials give the first event to rounding; then the state jumps, and the next phase takes over the rest of the
sample. Peaks never decide how the state advances, so that what is asked of a run does not change it.
"""

from math import fabs, isfinite

import cython
import numpy as np

from rockflex._errors import InputError, SolverError
from rockflex.engine.rest import at_rest
from rockflex.engine.system import acceleration, array, up8
from rockflex.engine.tables import tables_of

if cython.compiled:
    from cython.cimports.cpython.exc import PyErr_CheckSignals
    from cython.cimports.libc.math import fabs, isfinite
    from cython.cimports.rockflex.engine.loops import Peaks, PhaseLoops
    from cython.cimports.rockflex.engine.polynomials import first_fall, value
else:
    from rockflex.engine.loops_twin import Peaks, PhaseLoops, PyErr_CheckSignals
    from rockflex.engine.polynomials import first_fall, value

TERMS = cython.declare(cython.int, 48)  # of a series, at most
ORDERS = cython.declare(cython.int, 5)  # derivatives of a condition that may vanish at the start of a phase
VANISHES = cython.declare(cython.double, 1e-12)  # of the sum of the magnitudes of its terms: a condition that is zero
SNAP = cython.declare(cython.double, 1e-13)  # of a step: an event this close to its end is left to the next one
APART = cython.declare(cython.double, 1e-9)  # of a step: between two peaks of a polynomial
AT_ONCE = cython.declare(cython.int, 100)  # events at one instant, at most
IN_SAMPLE = cython.declare(cython.int, 20000)  # events in one sample, at most
CANDIDATES = cython.declare(cython.int, 64)  # samples that are kept for a closer look at their peaks
STRETCH = cython.declare(cython.int, 65536)  # samples without a look at Ctrl-C
QUIET = cython.declare(cython.int, 64)  # samples without excitation before it is asked whether all is at rest
LEADS = cython.declare(cython.int, 0)  # kinds of events: to a known phase, to the end, or to be asked what follows
ENDS = cython.declare(cython.int, 1)
ASKED = cython.declare(cython.int, 2)


@cython.cclass
class PhaseAtStep:
    """A phase for one time step."""

    key = cython.declare(object, visibility="readonly")
    phase = cython.declare(object, visibility="readonly")
    events = cython.declare(tuple, visibility="readonly")
    loops: PhaseLoops
    halvings: cython.int
    n_events: cython.int
    first: cython.int  # row of the first condition, after the states and outputs
    rows: cython.int
    scale: cython.double[::1]
    jump: cython.double[:, :, ::1]  # of every event, and its magnitudes
    jump_size: cython.double[:, :, ::1]
    kind: cython.int[::1]  # of every event: LEADS, ENDS, ASKED
    following: list  # place of the phase that follows every event, as far as it is known

    def __init__(self, key, phase, h, one_sided):
        tables = tables_of(phase, h)
        if not np.isfinite(tables.step).all():
            raise InputError(f"phase {key!r}: the motion grows without bound within one time step of {h:.9g}.")
        self.key, self.phase, self.events, self.halvings = key, phase, tuple(phase.events), tables.halvings
        self.loops = PhaseLoops(tables, one_sided, h)
        self.n_events, self.first = len(self.events), up8(tables.n) + tables.outputs
        self.rows = self.first + tables.conditions
        self.scale = np.array([event.scale for event in self.events], dtype=float)
        kinds, jumps = np.zeros(self.n_events, dtype=np.intc), np.tile(np.eye(tables.n), (self.n_events, 1, 1))
        for e, event in enumerate(self.events):
            if callable(event.jump) or event.rest is not None:
                kinds[e] = ASKED
                continue
            kinds[e] = ENDS if event.target is None else LEADS
            if event.jump is not None:
                jumps[e] = event.jump
        self.kind, self.jump, self.jump_size = kinds, jumps, np.abs(jumps)
        self.following = [None] * self.n_events


@cython.cfunc
@cython.exceptval(check=False)
def row_times(
    matrices: cython.double[:, :, ::1], place: cython.int, row: cython.int, x: cython.double[::1], n: cython.int
) -> cython.double:
    """One row of a matrix times a vector."""
    total: cython.double = 0.0
    j: cython.int
    for j in range(n):
        total += matrices[place, row, j] * x[j]
    return total


@cython.cclass
class Run:
    """One run of a system from an initial state; its phases are obtained as they are met.

    Parameters
    ----------
    system
        The system.
    h
        Time step.
    state : array_like, shape (n,)
        State at time 0; zero by default.
    key
        Key of the phase at time 0; that of the system by default.

    Attributes
    ----------
    system, h
        As given.
    ended
        Whether an event without a next phase has happened; otherwise the run stands at the end of a sample.
    """

    system = cython.declare(object, visibility="readonly")
    h = cython.declare(cython.double, visibility="readonly")
    ended = cython.declare(cython.bint, visibility="readonly")
    failed: cython.bint
    phases: list  # met so far
    places: dict  # of the phases, by their keys
    present: PhaseAtStep
    place: cython.int  # of the present phase
    n: cython.int
    states: cython.int  # rows of the states and of the outputs in tables and series, multiples of 8
    outputs: cython.int
    y: cython.double[::1]
    one_sided: cython.double[::1]
    peaks_: Peaks
    series: cython.double[:, ::1]  # a row of coefficients for each power: states, outputs, conditions
    sums: cython.double[:, ::1]  # the same for the first powers: magnitudes of the terms of a coefficient
    away: cython.double[::1]  # of outputs and conditions: how far the expanded motion may get from its start
    sizes: cython.double[::1]  # of the states: magnitudes of the terms that they were summed from
    old_sizes: cython.double[::1]
    workspace: cython.double[::1]
    q: cython.double[::1]  # polynomials
    slope: cython.double[::1]
    passed: cython.Py_ssize_t  # samples, before this call of `advance`
    end: cython.double  # time of the last event
    log: list  # events
    nodes: list  # parts of the history
    n_looks: cython.int
    n_searched: cython.int

    def __init__(self, system, h, state=None, key=None):
        if not (h > 0.0 and isfinite(h)):
            raise InputError(f"The time step must be a positive number, but {h!r} was given.")
        self.system, self.h, self.phases, self.places = system, h, [], {}
        self.n, self.outputs = system.layout.size, up8(max(1, len(system.outputs)))
        self.states = up8(self.n)
        one_sided = np.zeros(self.outputs)
        one_sided[[list(system.outputs).index(name) for name in system.one_sided]] = 1.0
        self.one_sided = one_sided
        self.series, self.sums, self.away = np.zeros((TERMS, 0)), np.zeros((ORDERS, 0)), np.zeros(0)
        self.restart(state, key)

    def restart(self, state=None, key=None):
        """Begin anew at time 0, with the phases met so far."""
        self.peaks_ = Peaks(np.asarray(self.one_sided), self.n, CANDIDATES)
        self.y = np.zeros(self.n) if state is None else array("the state", state, (self.n,))
        self.sizes, self.old_sizes, self.workspace = np.zeros(self.n), np.zeros(self.n), np.zeros(self.states + 2)
        self.q, self.slope = np.zeros(TERMS), np.zeros(TERMS)
        self.log, self.nodes, self.ended, self.failed, self.passed, self.end = [], [], False, False, 0, 0.0
        self.n_looks = self.n_searched = 0
        self.enter(self.system.start if key is None else key)

    @property
    def key(self):
        """Key of the present phase."""
        return self.present.key

    @property
    def time(self):
        """Present time."""
        return self.end if self.ended else self.passed * self.h

    @property
    def state(self):
        """A copy of the present state, shape (n,)."""
        return np.array(self.y)

    @property
    def peaks(self):
        """Highest value of every output and its time, by name."""
        pairs = zip(self.peaks_.high.tolist(), (self.peaks_.when * self.h).tolist(), strict=True)
        return dict(zip(self.system.outputs, pairs, strict=False))

    @property
    def events(self):
        """Time, key of the phase that it ended, and name of every event."""
        return [(t, self.phases[k].key, self.phases[k].events[e].name) for t, k, e in self.log]

    @property
    def counts(self):
        """Numbers of phases, of samples expanded for events, and of samples expanded for peaks."""
        return len(self.phases), self.n_looks, self.n_searched

    @property
    def history(self):
        """Times, keys, accelerations and states at samples and on both sides of every event, if they were kept."""
        if not self.nodes:
            return np.zeros(0), [], np.zeros(0), np.zeros((0, self.n))
        samples, places, a, states = zip(*self.nodes, strict=True)
        keys = [self.phases[k].key for k, some in zip(places, samples, strict=True) for _ in some]
        return np.concatenate(samples) * self.h, keys, np.concatenate(a), np.concatenate(states)

    @cython.cfunc
    def enter(self, key):
        """Go on with the phase of a key."""
        try:
            hash(key)
        except TypeError as error:
            raise InputError(f"The key {key!r} of a phase must be hashable, as a tuple is.") from error
        if key not in self.places:
            found = PhaseAtStep(key, self.system.checked(key), self.h, np.asarray(self.one_sided))
            self.places[key] = len(self.phases)
            self.phases.append(found)
        self.place = self.places[key]
        self.present = self.phases[self.place]
        width: cython.int = self.present.rows + 32  # loops write whole groups of rows
        if self.series.shape[1] < width:
            self.series, self.sums, self.away = np.zeros((TERMS, width)), np.zeros((ORDERS, width)), np.zeros(width)

    def advance(self, a, history: cython.bint = False):
        """Advance over the samples of an acceleration, of which the first is that of the present time.

        Raises
        ------
        InputError
            If the acceleration is empty or not finite.
        SolverError
            If events accumulate without end, the motion grows without bound, or the run has failed before.
        """
        checked = acceleration(a)
        if self.failed:
            raise SolverError("This run has been broken off by an error; begin it anew by `restart`.")
        self.failed = True
        self.peaks_.passed = self.passed
        self.passed += self.advance_over(checked, history and not self.ended)
        if not np.isfinite(self.y).all():
            raise SolverError(f"The motion in the phase {self.key!r} grows without bound before t = {self.time:.9g}.")
        self.failed = False

    @cython.cfunc
    def advance_over(self, a: cython.const[cython.double][::1], history: cython.bint):
        """Advance over samples; return how many have passed."""
        i: cython.int = 0
        start: cython.int
        stop: cython.int
        last: cython.int = a.shape[0] - 1
        states: cython.double[:, ::1] = np.zeros((last + 1 if history and last > 0 else 1, self.n))
        if history and (not self.nodes or self.nodes[-1][2][-1] != a[0]):
            self.keep(0, 0.0, a[0])
        while i < last and not self.ended:
            start, stop = i, min(last, (i // STRETCH + 1) * STRETCH)
            i = self.present.loops.march(self.place, a, i, stop, self.y, self.peaks_, states)
            if i > start:
                self.sizes[:] = 0.0
            if history and i > start:
                numbers = np.arange(start + 1, i + 1) + float(self.passed)
                accelerations, passed = np.array(a[start + 1 : i + 1]), np.array(states[start + 1 : i + 1])
                self.nodes.append((numbers, self.place, accelerations, passed))
            if self.peaks_.looks:
                self.traverse(i, a[i], a[i + 1], history)
                i += 1
            elif i < stop:
                self.search(a, False)
            PyErr_CheckSignals()
        self.search(a, True)
        return i

    def settle(self, most: int = 1_000_000, *, history: bool = False) -> bool:
        """Advance without excitation until nothing can follow, and return whether that was so after `most` samples.

        At rest no condition can fail any more, and no output exceed its peak.
        """
        quiet = np.zeros(QUIET + 1)
        start: cython.Py_ssize_t = self.passed
        while not self.ended:
            y, one_sided = np.asarray(self.y), np.asarray(self.one_sided)
            if at_rest(self.present.phase, y, self.peaks_.high, one_sided):
                return True
            if self.passed - start >= most:
                break
            self.advance(quiet, history)
        return False

    @cython.cfunc
    def keep(self, i: cython.int, u: cython.double, a: cython.double):
        """Add the present state to the history."""
        self.nodes.append((np.array([self.passed + i + u]), self.place, np.array([a]), np.array(self.y)[None, :]))

    @cython.cfunc
    def expand(self, start: cython.double, end: cython.double, u: cython.double) -> tuple[cython.double, cython.int]:
        """Expand the motion from the place u of a sample, as far as a series serves: the part of it, and the terms."""
        part: cython.double = min(1.0 - u, 0.5**self.present.halvings)
        terms: cython.int = 0
        while True:
            terms = self.present.loops.expand(
                part * self.h, start + (end - start) * u, (end - start) * part, self.y, self.series, self.away
            )
            if terms > 0:
                return part, terms
            part *= 0.5

    @cython.cfunc
    def traverse(self, i: cython.int, start: cython.double, end: cython.double, history: cython.bint):
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
            PyErr_CheckSignals()
            part, terms = self.expand(start, end, u)
            t, event = self.first_event(terms, part * self.h, start + (end - start) * u, (end - start) * part)
            if t > 0.0:
                self.raise_peaks(terms, t, self.passed + i + u, part)
                self.take_sizes(terms, t)
                self.move(terms, t)
                at_once = 0
            if event < 0:
                u = u + part if part < 1.0 - u else 1.0
                continue
            u += t * part
            at_once += 1
            in_sample += 1
            if at_once > AT_ONCE or in_sample > IN_SAMPLE:
                raise SolverError(
                    f"Events of the phase {self.key!r}, such as {self.present.events[event].name!r}, accumulate "
                    f"without end at t = {(self.passed + i + u) * self.h:.9g}."
                )
            if history and at_once == 1:
                self.keep(i, u, start + (end - start) * u)
            elif history:  # what lay between two events at one instant is no part of the motion
                self.nodes.pop()
            self.leave(event, self.passed + i + u, start + (end - start) * u)
            if self.ended:
                return
            if history:
                self.keep(i, u, start + (end - start) * u)
        if history:
            self.keep(i + 1, 0.0, end)

    @cython.cfunc
    def first_event(
        self, terms: cython.int, h: cython.double, a: cython.double, rise: cython.double
    ) -> tuple[cython.double, cython.int]:
        """Where in the step the first condition fails, and which; 1 and -1 if none does.

        At its start a condition may be zero, because the last event was its own, or due to rounding: then its first
        derivative that is not zero decides, and the zeros are divided out. Of several conditions that have failed from
        the start that of the lowest derivative, and then of the largest violation over its scale, is the first.
        """
        phase: PhaseAtStep = self.present
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
        for e in range(phase.n_events):
            row = phase.first + e
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
                t = -self.series[zeros, row] / phase.scale[e]
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
    def sum_up(self, order: cython.int, h: cython.double, a: cython.double, rise: cython.double):
        """Sum the magnitudes of the terms of coefficients of an order: what their rounding is relative to."""
        i: cython.int
        for i in range(self.n):
            self.workspace[i] = (
                max(fabs(self.y[i]), self.sizes[i]) if order == 0 else self.sums[order - 1, i] * h / order
            )
        self.workspace[self.n] = fabs(a) if order == 0 else fabs(rise) if order == 1 else 0.0
        self.workspace[self.n + 1] = 1.0 if order == 0 else 0.0
        self.present.loops.magnitudes(self.workspace, self.sums[order])

    @cython.cfunc
    def take_sizes(self, terms: cython.int, t: cython.double):
        """Take the magnitudes of the terms that make up the state at t, to which its rounding is relative."""
        i: cython.int
        k: cython.int
        total: cython.double
        for i in range(self.n):
            total = 0.0
            for k in range(terms - 1, -1, -1):
                total = total * t + fabs(self.series[k, i])
            self.sizes[i] = total

    @cython.cfunc
    def move(self, terms: cython.int, t: cython.double):
        """Set the state to that of the expanded motion at t."""
        i: cython.int
        self.present.loops.evaluate(self.series, terms, t, self.workspace)
        for i in range(self.n):
            self.y[i] = self.workspace[i]

    @cython.cfunc
    def leave(self, event: cython.int, sample: cython.double, a: cython.double):
        """Jump to the phase that follows an event."""
        phase: PhaseAtStep = self.present
        kind: cython.int = phase.kind[event]
        i: cython.int
        self.end = sample * self.h
        self.log.append((self.end, self.place, event))
        if kind == ASKED:
            self.ask(phase.events[event], a)
            return
        for i in range(self.n):
            self.workspace[i] = self.y[i]
            self.old_sizes[i] = self.sizes[i]
        for i in range(self.n):
            self.y[i] = row_times(phase.jump, event, i, self.workspace, self.n)
            self.sizes[i] = row_times(phase.jump_size, event, i, self.old_sizes, self.n)
        if kind == ENDS:
            self.ended = True
        elif phase.following[event] is None:
            self.enter(phase.events[event].target)
            phase.following[event] = self.place
        else:
            self.place = phase.following[event]
            self.present = self.phases[self.place]

    @cython.cfunc
    def ask(self, event, a: cython.double):
        """Let an event in Python say what follows."""
        y, sizes = np.asarray(self.y), np.asarray(self.sizes)
        y[:], target = event.follow(y, a)
        np.maximum(sizes, np.abs(y), out=sizes)
        if target is None:
            self.ended = True
        else:
            self.enter(target)

    @cython.cfunc
    def raise_peaks(self, terms: cython.int, stop: cython.double, sample: cython.double, part: cython.double):
        """Raise the peaks to those of the expanded motion."""
        j: cython.int
        start: cython.double
        high: cython.double[::1] = self.peaks_.high
        for j in range(self.outputs):
            start = self.series[0, self.states + j]
            if (start if self.one_sided[j] > 0.0 else fabs(start)) + self.away[j] > high[j]:
                self.raise_peak(j, terms, stop, 1e300, sample, part)

    @cython.cfunc
    def raise_peak(
        self,
        j: cython.int,
        terms: cython.int,
        stop: cython.double,
        bound: cython.double,
        sample: cython.double,
        part: cython.double,
    ):
        """Raise the peak of an output to that of its polynomial, which is known to be at most `bound`."""
        k: cython.int
        sign: cython.double
        t: cython.double = 0.0
        found: cython.double = self.series[0, self.states + j]
        one_sided: cython.bint = self.one_sided[j] > 0.0
        high: cython.double[::1] = self.peaks_.high
        when: cython.double[::1] = self.peaks_.when
        for k in range(terms):
            self.q[k] = self.series[k, self.states + j]
        while True:
            found = min(found if one_sided else fabs(found), bound)
            if found > high[j]:
                high[j], when[j] = found, sample + t * part
            if t >= stop or self.away[j] == 0.0:
                return
            sign = 0.0
            for k in range(terms - 1, 0, -1):
                sign = sign * t + k * self.q[k]
            sign = 1.0 if sign >= 0.0 else -1.0
            for k in range(1, terms):
                self.slope[k - 1] = sign * k * self.q[k]
            t = min(first_fall(self.slope, 0, terms - 1, t + APART, stop), stop)
            found = value(self.q, terms, t)

    @cython.cfunc
    def search(self, a: cython.const[cython.double][::1], finish: cython.bint):
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
        high: cython.double[::1] = self.peaks_.high
        for r in range(self.peaks_.count):
            higher = False
            for j in range(self.outputs):
                higher = higher or rows[r, 2 + self.n + j] > high[j]
            if higher:
                rows[kept, :] = rows[r, :]
                kept += 1
        self.peaks_.count = kept
        if kept == 0 or (not finish and kept <= CANDIDATES // 2):
            return
        y, present, place = np.array(self.y), self.present, self.place
        for r in range(kept):
            self.place, i = int(rows[r, 0]), int(rows[r, 1])
            self.present = self.phases[self.place]
            self.y[:] = rows[r, 2 : 2 + self.n]
            self.n_searched += 1
            u = 0.0
            while u < 1.0:
                PyErr_CheckSignals()
                part, terms = self.expand(a[i], a[i + 1], u)
                for j in range(self.outputs):
                    if rows[r, 2 + self.n + j] > high[j]:
                        self.raise_peak(j, terms, 1.0, rows[r, 2 + self.n + j], self.passed + i + u, part)
                self.move(terms, 1.0)
                u = u + part if part < 1.0 - u else 1.0
        self.present, self.place, self.peaks_.count = present, place, 0
        np.asarray(self.y)[:] = y
