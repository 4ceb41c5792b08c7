"""Advance a hybrid system: whole samples at once, power series, or polynomials of steps, where something may happen.

The march stops before a sample in which a condition may fail. There the motion is expanded in a power series, whose
polynomials give the first event to rounding; then the state jumps, and the next phase takes over the rest of the
sample. Declarations: `run.pxd`.
"""

from math import fabs, isfinite

import cython
import numpy as np

from rockflex.engine import failures
from rockflex.engine.rest import PhaseDecay
from rockflex.engine.system import NonlinearPhase, acceleration, array, checked_vertical_acceleration, up8
from rockflex.engine.tableau import START
from rockflex.foundation.errors import InputError

if cython.compiled:
    from cython.cimports.cpython.exc import PyErr_CheckSignals
    from cython.cimports.libc.math import fabs
    from cython.cimports.rockflex.engine.batch import Batch
    from cython.cimports.rockflex.engine.flow import Flow
    from cython.cimports.rockflex.engine.journal import Journal
    from cython.cimports.rockflex.engine.levels import ASKED, BLOCK, ENDS, UNKNOWN
    from cython.cimports.rockflex.engine.loops import Peaks, Phases
    from cython.cimports.rockflex.engine.rest import PhaseDecay
    from cython.cimports.rockflex.engine.series import Series
else:
    from rockflex.engine.batch import Batch
    from rockflex.engine.flow import Flow
    from rockflex.engine.journal import Journal
    from rockflex.engine.loops import ASKED, BLOCK, ENDS, UNKNOWN, Peaks, Phases, PyErr_CheckSignals
    from rockflex.engine.series import Series

AT_ONCE = cython.declare(cython.int, 100)  # events at one instant, at most
IN_SAMPLE = cython.declare(cython.int, 20000)  # events in one sample, at most
CANDIDATES = cython.declare(cython.int, 64)  # samples that are kept for a closer look at their peaks
STRETCH = cython.declare(cython.longlong, 1 << 25)  # between two looks at Ctrl-C, some 50 ms: what samples take is
PER_SAMPLE = cython.declare(cython.longlong, 64)  # this and a quarter of the entries of its products
MEMORY = cython.declare(cython.longlong, 64_000_000)  # bytes of tables in a run, if it does not say otherwise
IMMENSE = cython.declare(cython.double, 1e290)  # in any unit: no motion is as large
KEPT = cython.declare(cython.longlong, 1_000_000)  # bytes of room that are kept for the next history
QUIET = cython.declare(cython.int, 64)  # samples without excitation before it is asked whether all is at rest


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
    size
        Memory that the run holds, in bytes: phases and their tables, a history, and room.
    memory
        Limit of the memory of phases: those unused for longest are forgotten, and prepared again if met again.
    ended
        Whether an event without a next phase has happened; otherwise the run stands at the end of a sample.
    failure : str
        Why the run has failed: "accumulation" of events, "growth" without bound, "work" beyond the limit; or empty.
    watch : callable
        Called now and then, some ten times a second; it may end a run by an exception.
    limit : int
        The `work` that the run may take.
    marks : bool
        Whether states beside events, and at the ends of accelerations, are kept.
    """

    def __init__(self, system, h, state=None, key=None, which: cython.int = 0):
        if not (h > 0.0 and isfinite(h)):
            raise InputError(f"The time step must be a positive number, but {h!r} was given.")
        self.system, self.h, self.met, self.places = system, h, [], {}
        self.used, self.clock, self.memory = np.zeros(16, dtype=np.int64), 0, MEMORY
        self.n, self.outputs, self.states = system.layout.size, len(system.outputs), up8(system.layout.size + 2)
        self.stretch = STRETCH
        one_sided = np.zeros(up8(max(1, self.outputs)))
        one_sided[[list(system.outputs).index(name) for name in system.one_sided]] = 1.0
        self.one_sided, self.phases = one_sided, Phases(one_sided, self.n)
        self.peaks_ = Peaks(one_sided, self.n, CANDIDATES)
        self.high, self.when = self.peaks_.high, self.peaks_.when
        self.y, self.sizes, self.before = self.phases.rows[START], np.zeros(self.states), np.zeros(self.states)
        self.flow = Flow(self.phases, self.peaks_, one_sided, self.outputs, h)
        self.series = Series(self.phases, self.peaks_, self.flow, one_sided, self.y, self.sizes, h)
        self.start, self.workspace, self.quiet = np.zeros(self.n), np.zeros(self.n), np.zeros(QUIET + 1)
        self.journal, self.still = Journal(self.n), np.zeros(0)
        self.scratch = self.unkept = np.zeros((1, self.n))
        self.unbounded = np.full(up8(max(1, self.outputs)), np.inf)
        self.watch, self.limit, self.which, self.failure, self.marks = None, 2**62, 0, "", False
        self.phase_bytes, self.failed, self.first, self.decay, self.shakes = 0, False, 0, PhaseDecay(), False
        self.restart(state, key, which)

    def restart(self, state=None, key=None, which: cython.int = 0):
        """Begin anew at time 0, with the phases met so far."""
        if not 0 <= which < self.system.count:
            raise InputError(f"There are {self.system.count} systems in the stack, but number {which} was asked for.")
        self.choose(which)
        self.start = np.zeros(self.n) if state is None else array("the state", state, (self.n,))
        self.begin()
        self.now = self.first = self.enter(self.system.start if key is None else key)

    def choose(self, which):
        """Take another system of the stack."""
        if which != self.which:
            self.which = which
            self.phases.select(which)

    def begin(self):
        """Begin anew from the same state."""
        self.peaks_.pause_at(min(self.limit + 1, max(self.peaks_.pause() - self.peaks_.work(), 0)))
        if self.failed:
            with cython.gil:
                self.failure = ""
        self.peaks_.begin(self.one_sided)
        self.y[: self.n] = self.start
        self.sizes[: self.n] = 0.0
        self.ended = self.failed = False
        self.passed = self.reached = self.n_searched = 0
        self.end, self.now = 0.0, self.first
        self.journal.begin()
        self.flow.begin()

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
        return [(t, self.met[place][0], name) for t, place, name in zip(*self.journal.events, strict=True)]

    def tally(self, *names):
        """Numbers of events of these names."""
        return [self.journal.count(self.journal.kind(name)) for name in names]

    @property
    def work(self):
        """Samples so far, and power series, each of which counts like 16 samples: the same on every machine."""
        return self.peaks_.work()

    @property
    def counts(self):
        """Numbers of phases, and of samples expanded for peaks."""
        return len(self.met), self.n_searched

    @property
    def history(self):
        """Times, places of phases, accelerations, states, vertical accelerations, at samples and beside events."""
        samples, *others = self.journal.nodes
        return samples * self.h, *others

    @property
    def keys(self):
        """Keys of the phases met so far, by their places."""
        return [key for key, _ in self.met]

    @property
    def size(self):
        """Memory of phases, history and room, bytes."""
        room = [self.scratch, self.phases.rows, self.phases.found, self.series.series]
        return self.phase_bytes + self.journal.size() + self.peaks_.size + sum([each.nbytes for each in room])

    def trim(self):
        """Give back the room of a long history, which must have been read; that of a short one serves the next run."""
        if 8 * self.n * self.scratch.shape[0] > KEPT:
            self.scratch = self.unkept
        if self.journal.size() > KEPT:
            self.journal.clear()

    def enter(self, key):
        """Return the place of the phase of a key."""
        place: cython.int = self.place_of(key)
        self.load(place)
        return place

    def place_of(self, key):
        """Return the place of the phase of a key, and prepare it if it has not been met."""
        failures.check_key(key)
        place: cython.int = self.places.get(key, -1)
        return self.prepare(key, len(self.met)) if place < 0 else place

    def load(self, place):
        """Use a phase that has been met, and prepare it if it was forgotten."""
        self.clock += 1
        self.used[place] = self.clock
        if not self.phases.has_tables(place, self.shakes):
            with cython.gil:
                self.renew(place)
        if self.phases.halvings(place) < 0:  # of this system; others of the stack may have such a phase
            with cython.gil:
                self.refuse_step(place)
        return 0

    def renew(self, place):
        """Prepare a phase, or what it lacks for vertical acceleration."""
        if not self.phases.has_tables(place, False):
            self.prepare(self.met[place][0], place)
        if self.shakes:
            self.phase_bytes += self.phases.shake(place, self.which, self.met[place][1], self.h)
        return 0

    def prepare(self, key, place):
        """Prepare a phase, and return its place."""
        phase = self.system.checked(key)
        if self.phase_bytes > self.memory:
            self.forget()
        self.phase_bytes += self.phases.add(place, phase, self.h) + phase.nbytes
        if isinstance(phase, NonlinearPhase):
            self.phases.set_field(place, phase.field, phase.scale, phase.counted)
            self.flow.know(phase, place)
        self.phases.bind_system(place, self.which)
        self.met[place : place + 1] = [(key, phase)]
        self.places[key] = place
        if place == self.used.shape[0]:
            self.used = np.concatenate((self.used, np.zeros(place, dtype=np.int64)))
        self.series.widen(len(phase.events))
        rows = self.outputs + len(phase.events)
        self.peaks_.widen(rows)
        self.stretch = min(self.stretch, STRETCH // (PER_SAMPLE + self.n * (self.n + rows) // 4))
        self.journal.register_phase(place, phase.events)
        return place

    def forget(self):
        """Forget the phases that were not used for longest, all but a half of the memory that they may take."""
        place: cython.int
        for place in np.argsort(self.used[: len(self.met)]).tolist():
            if place != self.now and self.phases.has_tables(place, False) and not self.phases.nonlinear(place):
                self.phase_bytes -= self.phases.drop(place) + self.met[place][1].nbytes + self.decay.drop(place)
                self.met[place] = self.met[place][0], None
            if self.phase_bytes <= self.memory // 2:
                break

    def advance(self, a, vertical=None, history: cython.bint = False):
        """Advance over the samples of an acceleration, of which the first is that of the present time.

        `vertical` has the vertical acceleration at the same samples.

        Raises
        ------
        InputError
            If an acceleration is empty or not finite, or they differ in length.
        SolverError
            If the run has failed, as `failure` says, or had failed before.
        """
        ground: cython.const[cython.double][::1] = acceleration(a)
        rise: cython.const[cython.double][::1] = (
            self.still if vertical is None else checked_vertical_acceleration(vertical, ground)
        )
        with cython.nogil:
            self.proceed(ground, rise, history)

    def follow(self, batch: Batch, history: cython.bint = False):
        """Do the runs of a batch, or go on with them.

        Raises
        ------
        InputError, SolverError
            As `advance`, for the run `batch.place`; with 1 added to that, the next call goes on with the others.
        """
        number: cython.int
        batch.first[:] = -1
        for number, name in enumerate(batch.names):
            batch.kinds[number] = self.journal.kind(name)
        with cython.nogil:
            self.follow_all(batch, history)

    def follow_all(self, batch, history):
        """Do the runs of a batch."""
        i: cython.int
        run: cython.int
        rested: cython.bint
        outcome: cython.int
        end: cython.double
        while batch.place < batch.count:
            run = batch.place
            self.choose(batch.which[run])
            if batch.first[batch.phase[run]] < 0:
                with cython.gil:
                    self.meet_first(batch)
            self.first = batch.first[batch.phase[run]]
            for i in range(self.n):
                self.start[i] = batch.starts[run, i]
            self.begin()
            self.proceed(batch.scaled(), batch.scaled_vertical(), history)
            rested = False
            if batch.settles:
                rested = self.settle_over(batch.free[run], history)
                if rested and not self.phases.nonlinear(self.now):
                    self.decay.decay.bring_to_rest(self.y)
            else:
                self.coast_over(batch.free[run], history)
            outcome, end = 1 if self.ended else 2 if rested else 0, self.end if self.ended else self.passed * self.h
            batch.close(outcome, self.now, end, self.h, self.high, self.when, self.y, self.journal)
        return 0

    def proceed(self, ground, rise, history):
        """Advance over the samples of an acceleration that has been checked."""
        i: cython.int
        last: cython.int = ground.shape[0] - 1
        if self.failed:
            with cython.gil:
                raise failures.broken_off_run_error()
        self.failed = True
        self.shakes = rise.shape[0] > 0
        self.load(self.now)
        self.peaks_.set_sample_offset(self.passed)
        if history and not self.ended:
            if self.scratch.shape[0] <= max(last, 1):
                with cython.gil:
                    self.scratch = np.zeros((last + 2, self.n))
            i = self.advance_over(ground, rise, self.scratch)
        else:
            i = self.advance_over(ground, rise, self.unkept)
        self.passed, self.reached = self.passed + i, 0
        if self.overflows():
            with cython.gil:
                self.failure = "growth"
                raise failures.growth(self.key, self.time)
        self.failed = False
        return 0

    def overflows(self):
        """Whether a state or a peak is so large that bounds of rows may not be numbers."""
        k: cython.int
        for k in range(max(self.n, self.outputs)):
            if (k < self.n and not fabs(self.y[k]) < IMMENSE) or (k < self.outputs and not self.high[k] < IMMENSE):
                return True
        return False

    def coast(self, samples: int, *, history: bool = False) -> None:
        """Advance without excitation over so many samples, in the same pieces as `settle`."""
        self.coast_over(min(samples, 2**62), history)

    def coast_over(self, samples, history):
        """Advance without excitation."""
        while samples > 0 and not self.ended:
            self.proceed(self.quiet[: min(samples, QUIET) + 1], self.still, history)
            samples -= QUIET
        return 0

    def advance_over(self, a, v, states):
        """Advance over samples, with a history if there is room for their states; return how many have passed."""
        history: cython.bint = states.shape[0] > 1
        i: cython.int = 0
        j: cython.int
        start: cython.int
        last: cython.int = a.shape[0] - 1
        self.flow.resume(history)
        if (history or self.marks) and self.journal.wants(a[0], self.rise_at(v, 0)):
            self.journal.keep(self.passed, a[0], self.rise_at(v, 0), self.y, self.now)
        while i < last and not self.ended:
            start = i
            if self.phases.nonlinear(self.now):
                i = self.flow.march(self.now, a, v, i, last, states)
            else:
                i = self.phases.march(self.now, a, v, i, last, self.y, self.peaks_, states)
            if i > start:
                self.sizes[:] = 0.0
            if history:
                for j in range(start + 1, i + 1):
                    self.journal.keep(self.passed + j, a[j], self.rise_at(v, j), states[j], self.now)
            self.reached = i
            if self.peaks_.looks():
                self.advance_sample(i, a[i], a[i + 1], (self.rise_at(v, i), self.rise_at(v, i + 1)), history)
                i += 1
            elif i < last and self.peaks_.count() + BLOCK > CANDIDATES and not self.phases.nonlinear(self.now):
                self.search(a, v, False)  # otherwise it has paused to look up, which must not change what is counted
            self.check_stop_request()
        self.search(a, v, True)
        if self.marks and not history and not self.ended:
            self.journal.keep(self.passed + i, a[i], self.rise_at(v, i), self.y, self.now)
        return i

    def rise_at(self, v, i):
        """The vertical acceleration at a sample."""
        return v[i] if v.shape[0] > 0 else 0.0

    def check_stop_request(self):
        """After a stretch of work, see whether the run must end."""
        if self.peaks_.work() >= self.peaks_.pause():
            with cython.gil:
                PyErr_CheckSignals()
                if self.watch is not None:
                    self.watch()
                if self.peaks_.work() > self.limit:
                    self.failure = "work"
                    raise failures.limit(self.limit)
                self.peaks_.pause_at(min(self.limit + 1, self.peaks_.work() + self.stretch))
        return 0

    def settle(self, most: int = 1_000_000, *, history: bool = False) -> bool:
        """Advance until no condition can fail, and no output exceed its peak; whether that was so in `most` samples."""
        return bool(self.settle_over(min(most, 2**62), history))

    def settle_over(self, most, history):
        """Advance without excitation until nothing can follow: 1, or 0 after `most` samples."""
        start: cython.Py_ssize_t = self.passed
        n_events: cython.int = -1
        asks: cython.double = 0.0
        wait: cython.double
        while not self.ended:
            if self.journal.n_events > n_events or self.passed * self.h >= asks:
                n_events = self.journal.n_events
                if self.phases.nonlinear(self.now):
                    wait = self.flow.time_to_rest(self.now)
                else:
                    if self.decay.place != self.now or self.decay.which != self.which:
                        with cython.gil:
                            self.phase_bytes += self.decay.prepare_phase(self.met[self.now][1], self.now, self.which)
                    wait = self.decay.decay.time_to_rest(self.y, self.high, self.one_sided)
                if wait == 0.0:
                    return 1
                asks = self.passed * self.h + wait
            if self.passed - start >= most:
                break
            self.proceed(self.quiet, self.still, history)
        return 0

    def advance_sample(self, i, start, end, v, history):
        """Advance over a sample in which something may happen."""
        u: cython.double = self.flow.reached if self.phases.nonlinear(self.now) else 0.0  # the part that has passed
        a: cython.double
        rise: cython.double
        part: cython.double
        moves: cython.bint
        t: cython.double
        event: cython.int
        at_once: cython.int = 0
        in_sample: cython.int = 0
        while u < 1.0:
            self.check_stop_request()
            moves = self.phases.nonlinear(self.now) and not self.flow.tried
            if moves and self.flow.cross(self.now, start, end, v, u, self.passed + i) > u:
                u, at_once = self.flow.reached, 0
                continue
            part = self.series.expand(self.now, start, end, v, u)
            if part < 0.0:
                with cython.gil:
                    self.raise_step_too_small(self.passed + i + u)
            t, event = self.series.first_event()
            if t > 0.0:
                self.series.raise_peaks(t, self.passed + i + u, self.unbounded)
                self.series.move(t)
                at_once = 0
            if event < 0:
                u = u + part if part < 1.0 - u else 1.0
                continue
            u += t * part
            at_once += 1
            in_sample += 1
            if at_once > AT_ONCE or in_sample > IN_SAMPLE:
                with cython.gil:
                    self.refuse(event, self.passed + i + u)
            a, rise = start + (end - start) * u, v[0] + (v[1] - v[0]) * u
            if at_once == 1 and (history or self.marks):
                self.journal.keep(self.passed + i + u, a, rise, self.y, self.now)
            self.leave(event, self.passed + i + u, a, rise)
            if self.ended:
                return 0
            if history or self.marks:
                self.journal.keep(self.passed + i + u, a, rise, self.y, self.now)
        if history:
            self.journal.keep(self.passed + i + 1, end, v[1], self.y, self.now)
        return 0

    def leave(self, event, sample, a, v):
        """Jump to the phase that follows an event."""
        outcome: cython.int = 2 * event
        chosen: cython.int = self.phases.leap(self.now, event, self.y, a, v)
        self.flow.forget()
        self.end = sample * self.h
        self.journal.happen(self.end, self.now, event)
        if self.phases.following(self.now, outcome) == ASKED:
            with cython.gil:
                self.call_jump_function(event, a, v)
            return 0
        if chosen >= 0:
            outcome += chosen & 1
            if chosen & 2:
                self.journal.note(self.now, event)
            self.flow.enlarge(self.sizes)
        elif chosen == -1:
            with cython.gil:
                raise self.met[self.now][1].events[event].jump.error()
        else:
            self.apply_jump_matrix(outcome)
            if self.phases.rests(self.now, event, self.y, a, v):
                outcome += 1
                self.apply_jump_matrix(outcome)
        following: cython.int = self.phases.following(self.now, outcome)
        if following == UNKNOWN:
            with cython.gil:
                following = self.resolve_next_phase(event, outcome)
        if following == ENDS:
            self.ended = True
        else:
            self.load(following)
            self.now = following
        return 0

    # What needs the interpreter's lock stands apart: a function with Python objects of its own takes it when it ends.

    def meet_first(self, batch):
        """Note the place of the first phase of the present run of a batch."""
        number: cython.int = batch.phase[batch.place]
        batch.first[number] = self.place_of(batch.keys[number])
        return 0

    def refuse_step(self, place):
        """Raise the error of a motion that overflows within a step."""
        raise failures.endless(*self.met[place], self.which, self.h)

    def resolve_next_phase(self, event, outcome):
        """Return the place of the phase that follows an outcome for the first time."""
        left = self.met[self.now][1].events[event]
        other = left.other if left.rest is None else left.rest.target
        following: cython.int = self.enter(left.target if outcome == 2 * event else other)
        self.phases.set_next_phase(self.now, outcome, following)
        return following

    def refuse(self, event, sample):
        """Raise the error of events that accumulate."""
        self.failure = "accumulation"
        raise failures.accumulation(*self.met[self.now], event, sample * self.h)

    def apply_jump_matrix(self, outcome):
        """Multiply the state by the matrix of an outcome."""
        if self.phases.jump(self.now, outcome, False, self.y, self.workspace):
            self.phases.jump(self.now, outcome, True, self.sizes, self.workspace)

    def raise_step_too_small(self, sample):
        """Raise the error of a motion for which no step is short enough."""
        self.failure = "stall"
        raise failures.step_too_small(*self.met[self.now], sample * self.h)

    def call_jump_function(self, event, a, v):
        """Let a function say what follows an event."""
        y, sizes = np.asarray(self.y)[: self.n], np.asarray(self.sizes)[: self.n]
        y[:], target = self.met[self.now][1].events[event].apply_jump(y, a, v)
        np.maximum(sizes, np.abs(y), out=sizes)
        if target is None:
            self.ended = True
        else:
            self.now = self.enter(target)

    def search(self, a, v, finish):
        """Search the samples that may have higher peaks: at the end, or if there is no room for more."""
        r: cython.int
        i: cython.int
        u: cython.double
        kept: cython.int = self.series.drop_hopeless_samples()
        if kept == 0 or (not finish and kept <= CANDIDATES // 2):
            return 0
        self.before[:] = self.y
        for r in range(kept):
            i = self.series.candidate(r)
            self.load(self.series.phase_of(r))
            self.n_searched += 1
            self.series.begin_search(r, a)
            u = 0.0
            while u < 1.0:
                self.check_stop_request()
                u = self.series.search(
                    r, a[i], a[i + 1], (self.rise_at(v, i), self.rise_at(v, i + 1)), self.passed + i, u
                )
        self.y[:] = self.before
        self.peaks_.keep(0)
        return 0
