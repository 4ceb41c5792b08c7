"""The motion in a phase that is not linear: steps of a Runge-Kutta pair, and whether something may happen in one.

A step ends with its sample at the latest. In one that the error control accepts no mode turns by much more than a
radian, so that a row deviates from the cubic through its values and slopes at both ends by a few hundredths of the
cubic's curvature (a harmonic that turns by x: x²/48); a fifth is allowed for. Declarations: `flow.pxd`.
"""

from math import ceil, fabs, isfinite, sqrt

import cython
import numpy as np

from rockflex.engine import tableau
from rockflex.engine.tableau import C

if cython.compiled:
    from cython.cimports.libc.math import INFINITY, ceil, fabs, isfinite, sqrt
    from cython.cimports.rockflex.engine.polynomials import unit_for
else:
    from rockflex.engine.polynomials import unit_for

    INFINITY = float("inf")

TOLERANCE = cython.declare(cython.double, 1e-10)  # relative error of a step
SHORTEST = cython.declare(cython.double, 1e-13)  # s
SAFETY = cython.declare(cython.double, 0.9)  # of the error control
LEAST = cython.declare(cython.double, 0.2)
MOST = cython.declare(cython.double, 4.0)
WORK = cython.declare(cython.int, 12)  # samples that a step counts like
OFTEN = cython.declare(cython.int, 64)  # steps in a sample without a look at Ctrl-C
NEAR = cython.declare(cython.double, 0.75)  # of its peak: an output below that at both ends of a step does not reach it
YOUNG = cython.declare(cython.int, 3)  # steps after a change, in which it may: one that has just begun may soon be over
STRAY = cython.declare(cython.double, 0.2)  # of a cubic's curvature, by which a row may deviate from it
VANISHES = cython.declare(cython.double, 1e-12)  # as in `series`
BLUR = cython.declare(cython.double, 1e-10)  # of its scale: a condition that is not linear and zero
FLAT = cython.declare(cython.double, 1e-9)  # of its changes: a slope of one that is zero
TURNS = cython.declare(cython.int, 3)  # of Newton's method, for the zero of one
CALM = cython.declare(cython.double, 1e-8)  # 1/s: of its largest value, the rate of a state that is at rest
TERMS = cython.declare(cython.int, 8)  # of the polynomial over a step
CURVED = cython.declare(cython.int, 10)  # of that of an output that is not linear
SWING = cython.declare(cython.double, 4.0 / 27.0)  # the highest value of the cubic t (1 - t)²
STEEPEST = cython.declare(cython.double, 64.0 / 27.0)  # and of 16 t (1 - t)²
EARLY = cython.declare(cython.int, 7)  # stages near the thirds of a step
LATE = cython.declare(cython.int, 8)
EARLY_AT = cython.declare(cython.double, C[7])
LATE_AT = cython.declare(cython.double, C[8])

# Rows, see `tableau`.
FIRST = cython.declare(cython.int, 0)  # the rates at the start of a step
LAST = cython.declare(cython.int, tableau.LAST)  # and at its end
START = cython.declare(cython.int, tableau.START)
END = cython.declare(cython.int, tableau.END)
PLACE = cython.declare(cython.int, tableau.PLACE)
PLACE_RATES = cython.declare(cython.int, tableau.PLACE_RATES)
LARGEST = cython.declare(cython.int, tableau.LARGEST)
TERM = cython.declare(cython.int, tableau.TERM)
BEFORE = cython.declare(cython.int, tableau.BEFORE)
OUTS = cython.declare(cython.int, tableau.OUTS)
ENDS = cython.declare(cython.int, tableau.ENDS)
EARLY_OUTS = cython.declare(cython.int, tableau.EARLY_OUTS)
LATE_OUTS = cython.declare(cython.int, tableau.LATE_OUTS)
BELOW = cython.declare(cython.int, tableau.BELOW)
BEYOND = cython.declare(cython.int, tableau.BEYOND)
SLOPES = cython.declare(cython.int, tableau.SLOPES)
BENDS = cython.declare(cython.int, tableau.BENDS)
MORE = cython.declare(cython.int, tableau.MORE)
EARLY_CHECKS = cython.declare(cython.int, tableau.EARLY_CHECKS)
LATE_CHECKS = cython.declare(cython.int, tableau.LATE_CHECKS)

CUBIC = np.linalg.inv(np.vander((0.0, C[7], C[8], 1.0), increasing=True))  # through values at the start, early, ..


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def range_of(
    first: cython.double, last: cython.double, before: cython.double, after: cython.double
) -> tuple[cython.double, cython.double]:
    """Bounds of a smooth function over [0, 1] from its values and slopes at both ends."""
    chord: cython.double = last - first
    slack: cython.double = STRAY * (fabs(chord - before) + fabs(chord - after))
    low: cython.double = min(first, last)
    high: cython.double = max(first, last)
    b: cython.double = 3.0 * chord - 2.0 * before - after
    c: cython.double = before + after - 2.0 * chord
    unit: cython.double = 1.0
    root: cython.double
    q: cython.double
    t: cython.double
    k: cython.int
    if (before > 0.0) == (after > 0.0) and min(fabs(before), fabs(after)) > 8.0 * slack:  # it is monotonic
        return low, high
    root = b * b - 3.0 * before * c
    if not 1e-240 < fabs(root) < 1e280:  # squares that vanish or overflow
        unit = unit_for(fabs(before) + fabs(b) + fabs(c) + 1e-305)
        root = (unit * b) * (unit * b) - 3.0 * (unit * before) * (unit * c)
    if root > 0.0:
        q = -unit * b - (sqrt(root) if b > 0.0 else -sqrt(root))
        for k in range(2):
            if k == 0 and fabs(3.0 * unit * c) <= fabs(q):
                continue
            if k == 1 and fabs(unit * before) >= fabs(q):
                continue
            t = q / (3.0 * unit * c) if k == 0 else unit * before / q  # where it is level
            if t > 0.0:
                t = first + t * (before + t * (b + t * c))
                low, high = min(low, t), max(high, t)
    return low - slack, high + slack


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def falls(first: cython.double, last: cython.double, before: cython.double, after: cython.double) -> cython.bint:
    """Whether a smooth function, which starts at zero or above, may reach zero later in [0, 1]."""
    low: cython.double = min(first, last)
    high: cython.double
    slack: cython.double = STRAY * (fabs(last - first - before) + fabs(last - first - after))
    if low > SWING * (fabs(before) + fabs(after)) + slack:
        return False
    if first == 0.0:  # divided by t, as is a deviation of 16 t² (1 - t)² times the slack
        low = min(before, last)
        high = 3.0 * last - 2.0 * before - after
        after += before - 2.0 * last
        if after > 0.0 and -2.0 * after < high < 0.0:
            low = before - 0.25 * high * (high / after)
        return low <= STEEPEST * slack
    low, high = range_of(first, last, before, after)
    return min(low, high) <= 0.0


@cython.final
@cython.cclass
class Flow:
    """Steps from the present state on."""

    def __init__(self, phases, peaks, one_sided, outputs, h):
        self.phases, self.peaks, self.one_sided, self.h = phases, peaks, one_sided, h
        self.n, self.states, self.outputs = phases.n, phases.states, outputs
        self.high, self.when = peaks.high, peaks.when
        self.rows, self.found, self.shaking = phases.rows, phases.found, np.zeros(4)
        self.nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(CURVED) / (CURVED - 1))
        self.fits = np.linalg.inv(np.vander(np.asarray(self.nodes), increasing=True))
        self.tilts = np.array([[0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 2.0, 3.0]]) @ CUBIC
        self.facts = []
        self.curved, self.velocities = np.zeros((1, 1), dtype=np.intc), np.zeros((1, self.n), dtype=np.intc)
        self.least = np.zeros((1, 1))
        self.exact, self.terms = np.zeros((1, 1), dtype=np.intc), TERMS
        self.straight = np.zeros((1, 1), dtype=np.intc)
        self.checked, self.slopes = np.zeros((1, 1), dtype=np.intc), np.zeros(2)
        self.place, self.counts, self.part, self.reached, self.young = -1, False, 0.0, 0.0, YOUNG
        self.begin()

    def know(self, phase, place):
        """Take a phase: its outputs and conditions that are not linear, and which states are rates of others."""
        n, m = self.n, self.outputs
        velocities, curved, least = np.full(n, -1, dtype=np.intc), np.zeros(m + 1, dtype=np.intc), np.zeros(m + 1)
        velocities[list(phase.velocities)] = list(phase.velocities.values())
        count = len(phase.curved)
        curved[0], curved[1 : 1 + count], least[1 : 1 + count] = count, list(phase.curved), list(phase.curved.values())
        self.found = self.phases.found
        exact = [int(not event.row[0][velocities < 0].any()) for event in phase.events]
        for e in phase.curved_events:
            exact[e] = 0
        straight = np.ones(m + 1, dtype=np.intc)
        straight[list(phase.curved)] = 0
        nothing = np.zeros(m + 1, dtype=np.intc), np.zeros(m + 1), np.full(n, -1, dtype=np.intc), straight, [], ()
        self.facts += [nothing] * (place + 1 - len(self.facts))
        self.facts[place] = curved, least, velocities, straight, exact, tuple(phase.curved_events)
        known = list(zip(*self.facts, strict=True))
        self.curved, self.least, self.velocities, self.straight = map(np.array, known[:4])
        most = max(1, *map(len, known[4]))
        self.exact = np.array([each + [0] * (most - len(each)) for each in known[4]], dtype=np.intc)
        most = 1 + max(map(len, known[5]))
        self.checked = np.array([[len(each), *each] + [0] * (most - 1 - len(each)) for each in known[5]], dtype=np.intc)

    def begin(self):
        """Begin a run anew."""
        k: cython.int
        for k in range(self.states):
            self.rows[LARGEST, k] = 0.0
        self.step = INFINITY
        self.forget()

    def resume(self, counts):
        """Go on with another acceleration, and with or without the states on which nothing depends."""
        self.counts = counts
        self.forget()

    def forget(self):
        """Note that the state has changed, or the phase."""
        self.known = self.told = self.entered = self.tried = False
        self.young = YOUNG

    def enter(self, place):
        """Note what the constant states add to the conditions of a phase."""
        e: cython.int
        self.place, self.entered, self.known, self.told = place, True, False, False
        for e in range(self.phases.events(place)):
            self.found[MORE, e] = 0.0
        self.phases.begin(place)

    def arrive(self, place, a, v):
        """Compute what is not known yet of the start of a step."""
        if not self.entered or self.place != place:
            self.enter(place)
        if not self.known:
            self.phases.rates(place, a, v, START, FIRST, self.counts)
            self.known = True

    def take_step(self, place, start, end, v, u):
        """Take a step from the place u of a sample; return the part of the sample, -1 if none is short enough."""
        longest: cython.double = 1.0 - u
        # Of steps as long as allowed the last one would be short, and the others err most; equal ones are as many.
        part: cython.double = longest if self.step >= longest else longest / ceil(longest / self.step)
        most: cython.double = MOST
        error: cython.double
        if self.tried:
            self.tried = False
            return self.part
        self.shaking[0], self.shaking[2] = start + (end - start) * u, v[0] + (v[1] - v[0]) * u
        self.arrive(place, self.shaking[0], self.shaking[2])
        while True:
            self.peaks.add_work(WORK)
            self.shaking[1], self.shaking[3] = (end - start) * part, (v[1] - v[0]) * part
            error = self.phases.attempt(
                place,
                part * self.h,
                self.shaking[0],
                self.shaking[1],
                self.shaking[2],
                self.shaking[3],
                self.counts,
            )
            error = error / TOLERANCE if isfinite(error) else INFINITY
            if error <= 1.0:
                if part < longest:  # one that a sample or an event has shortened says little about the next one
                    self.step = part * grown(most, error)
                self.part = part
                return part
            most = 1.0
            part *= max(LEAST, SAFETY / sqrt(sqrt(sqrt(error)))) if isfinite(error) else LEAST
            self.step = part
            if not part * self.h > SHORTEST:
                return -1.0

    def accept(self):
        """Move the state to the end of the step."""
        k: cython.int
        self.told = self.tried = False
        self.young = max(self.young - 1, 0)
        for k in range(self.n):
            self.rows[START, k], self.rows[FIRST, k] = self.rows[END, k], self.rows[LAST, k]
        for k in range(self.phases.moving(self.place)):
            self.rows[LARGEST, k] = max(self.rows[LARGEST, k], fabs(self.rows[START, k]))

    def leave(self):
        """Note that the state has moved to a place within the step."""
        self.known = self.told = self.tried = False

    def enlarge(self, sizes):
        """After a jump the magnitudes of what the state is summed from are not below those of the state."""
        k: cython.int
        for k in range(self.n):
            sizes[k] = max(sizes[k], fabs(self.rows[START, k]))

    def march(self, place, a, v, i, last, states):
        """Advance whole samples from i up to `last` as far as nothing happens; the number of the sample reached.

        Where something may happen, `reached` is the part of that sample that has passed.
        """
        k: cython.int
        rise: cython.double = 0.0
        risen: cython.double = 0.0
        before: cython.double = self.peaks.before()
        until: cython.longlong = self.peaks.pause()
        self.peaks.look(False)
        while i < last and self.peaks.work() < until:
            if v.shape[0] > 0:
                rise, risen = v[i], v[i + 1]
            if self.cross(place, a[i], a[i + 1], (rise, risen), 0.0, before + i) < 1.0:
                self.peaks.look(True)
                return i
            i += 1
            self.peaks.add_work(1)
            if states.shape[0] > 1:
                for k in range(self.n):
                    states[i, k] = self.rows[START, k]
        return i

    def cross(self, place, start, end, v, u, sample):
        """Advance from the place u of a sample as far as nothing happens; the place `reached`, 1 at its end.

        The step in which something may happen is kept.
        """
        k: cython.int
        _steps: cython.int
        part: cython.double
        a: cython.double = start + (end - start) * u
        rise: cython.double = v[0] + (v[1] - v[0]) * u
        fresh: cython.bint = not self.told
        self.reached = u
        if fresh:
            self.arrive(place, a, rise)
            self.look(place, a, rise, START, FIRST, OUTS)
            self.check(place, a, rise, START, FIRST, BELOW)
            self.told = True
        for _steps in range(OFTEN):
            part = self.take_step(place, start, end, v, u)
            if part < 0.0:
                return u
            self.tried = True
            if self.may_fail_within_step(place):
                return u
            if fresh:
                self.raise_to(OUTS, sample + u)
                fresh = False
            self.look_ahead(place)
            if self.may_have_interior_peak(place) or self.curves_hide(place):
                return u
            u = self.reached = u + part if part < 1.0 - u else 1.0
            self.accept()
            self.raise_to(ENDS, sample + u)
            for k in range(self.found.shape[1]):
                self.found[OUTS, k], self.found[BELOW, k] = self.found[ENDS, k], self.found[BEYOND, k]
            self.told = True
            if u == 1.0:
                break
        return u

    def look(self, place, a, v, at, rates, to):
        """Compute the outputs of a state under both accelerations."""
        self.rows[at, self.n], self.rows[at, self.n + 1] = a, 1.0
        self.phases.look(place, True, (v, 0.0), 0, at, at, to)
        if self.curved[place, 0] > 0:
            self.phases.observe(place, a, v, at, rates, to)

    def check(self, place, a, v, at, rates, to):
        """Compute the conditions of a state under both accelerations."""
        self.phases.look(place, False, (v, 0.0), 0, at, at, to)
        if self.checked[place, 0] > 0:
            self.phases.check(place, a, v, at, rates, to)

    def look_ahead(self, place):
        """Compute the outputs at the end of the step."""
        a: cython.double = self.shaking[0] + self.shaking[1]
        self.look(place, a, self.shaking[2] + self.shaking[3], END, LAST, ENDS)

    def counted(self, j, value):
        """What counts of an output."""
        return value if self.one_sided[j] > 0.0 else fabs(value)

    def raise_to(self, outs, sample):
        """Raise the peaks to a row of outputs."""
        j: cython.int
        value: cython.double
        for j in range(self.outputs):
            value = self.counted(j, self.found[outs, j])
            if value > self.high[j]:
                self.high[j], self.when[j] = value, sample

    def slopes_of(self, outputs, place):
        """Compute the rates of conditions or outputs at both ends of a step."""
        climb: cython.double = self.shaking[3] / (self.part * self.h)
        self.rows[FIRST, self.n] = self.rows[LAST, self.n] = self.shaking[1] / (self.part * self.h)
        self.phases.look(place, outputs, (self.shaking[2], climb), 1, START, FIRST, SLOPES)
        self.phases.look(place, outputs, (self.shaking[2] + self.shaking[3], climb), 1, END, LAST, BENDS)

    def may_fail_within_step(self, place):
        """Whether a condition may fail within the step or at its end."""
        e: cython.int
        k: cython.int
        more: cython.double
        length: cython.double = self.part * self.h
        self.check(place, self.shaking[0] + self.shaking[1], self.shaking[2] + self.shaking[3], END, LAST, BEYOND)
        self.slopes_of(False, place)
        if self.checked[place, 0] > 0:
            self.check_within(place, EARLY, EARLY_AT, EARLY_CHECKS)
            self.check_within(place, LATE, LATE_AT, LATE_CHECKS)
        for k in range(self.checked[place, 0]):
            e = self.checked[place, 1 + k]
            self.tilt(BELOW, EARLY_CHECKS, LATE_CHECKS, BEYOND, e)
            self.found[SLOPES, e], self.found[BENDS, e] = self.slopes[0] / length, self.slopes[1] / length
        for e in range(self.phases.events(place)):
            more = self.found[MORE, e]
            if falls(
                self.found[BELOW, e] + more,
                self.found[BEYOND, e] + more,
                length * self.found[SLOPES, e],
                length * self.found[BENDS, e],
            ):
                return True
        return False

    def may_have_interior_peak(self, place):
        """Whether a linear output may have a new peak within the step, and not at its ends."""
        j: cython.int
        low: cython.double
        high: cython.double
        most: cython.double
        sloped: cython.bint = False
        length: cython.double = self.part * self.h
        for j in range(self.outputs):
            if self.straight[place, j] == 0 or (
                max(fabs(self.found[OUTS, j]), fabs(self.found[ENDS, j])) <= NEAR * self.high[j] and self.young == 0
            ):
                continue
            if not sloped:
                self.slopes_of(True, place)
                sloped = True
            low, high = range_of(
                self.found[OUTS, j],
                self.found[ENDS, j],
                length * self.found[SLOPES, j],
                length * self.found[BENDS, j],
            )
            most = max(self.counted(j, self.found[OUTS, j]), self.counted(j, self.found[ENDS, j]))
            if max(self.counted(j, low), self.counted(j, high)) > max(self.high[j], most):
                return True
        return False

    def curves_hide(self, place):
        """Whether an output that is not linear may have a new peak within the step, and not at its ends."""
        j: cython.int
        k: cython.int
        low: cython.double
        high: cython.double
        most: cython.double
        first: cython.double
        last: cython.double
        told: cython.bint = False
        for k in range(self.curved[place, 0]):
            j = self.curved[place, 1 + k]
            first, last = self.found[OUTS, j], self.found[ENDS, j]
            most = max(self.counted(j, first), self.counted(j, last))
            low = max(fabs(self.high[j]), self.least[place, 1 + k])
            if most <= self.high[j] - (1.0 - NEAR) * low and self.young == 0:
                continue
            if not told:
                self.look_within(place, EARLY, EARLY_AT, EARLY_OUTS)
                self.look_within(place, LATE, LATE_AT, LATE_OUTS)
                told = True
            self.tilt(OUTS, EARLY_OUTS, LATE_OUTS, ENDS, j)
            low, high = range_of(first, last, self.slopes[0], self.slopes[1])
            if max(self.counted(j, low), self.counted(j, high)) > max(self.high[j], most):
                return True
        return False

    def tilt(self, first, early, late, last, j):
        """Compute the slopes at both ends of the cubic through what was found at four places of the step."""
        k: cython.int
        for k in range(2):
            self.slopes[k] = self.tilts[k, 0] * self.found[first, j] + self.tilts[k, 1] * self.found[early, j]
            self.slopes[k] += self.tilts[k, 2] * self.found[late, j] + self.tilts[k, 3] * self.found[last, j]

    def check_within(self, place, stage, t, to):
        """Compute the conditions at a stage of the step."""
        a: cython.double = self.shaking[0] + t * self.shaking[1]
        self.phases.within(place, stage)
        self.rows[PLACE, self.n], self.rows[PLACE, self.n + 1] = a, 1.0
        self.check(place, a, self.shaking[2] + t * self.shaking[3], PLACE, stage, to)

    def look_within(self, place, stage, t, outs):
        """Compute the outputs at a stage of the step."""
        a: cython.double = self.shaking[0] + t * self.shaking[1]
        self.phases.within(place, stage)
        self.look(place, a, self.shaking[2] + t * self.shaking[3], PLACE, stage, outs)

    def clear(self, t, sample):
        """Raise the peaks over the step up to t if none may be within; return whether that was all."""
        j: cython.int
        self.look(self.place, self.shaking[0], self.shaking[2], START, FIRST, OUTS)
        self.raise_to(OUTS, sample)
        self.look_ahead(self.place)
        if t < 1.0:
            for j in range(self.outputs):
                if self.counted(j, self.found[ENDS, j]) > self.high[j]:
                    return False
        if self.may_have_interior_peak(self.place) or self.curves_hide(self.place):
            return False
        if t == 1.0:
            self.raise_to(ENDS, sample + self.part)
        return True

    def fill(self, series, away):
        """Fill a series with the polynomials of states and conditions; return the number of terms."""
        k: cython.int
        e: cython.int
        i: cython.int
        events: cython.int = self.phases.events(self.place)
        v: cython.double = self.shaking[2]
        rise: cython.double = self.shaking[3]
        self.terms = TERMS if v == 0.0 and rise == 0.0 else TERMS + 1
        if self.curved[self.place, 0] + self.checked[self.place, 0] > 0:
            self.terms = CURVED
        self.phases.bend(self.place, self.counts, series)
        for k in range(TERMS, self.terms):
            for i in range(self.states):
                series[k, i] = 0.0
        for e in range(events):
            away[e] = 0.0
        for k in range(self.terms):
            for i in range(self.n + 2):
                self.rows[BEFORE, i], self.rows[TERM, i] = self.rows[TERM, i], series[k, i]
            self.phases.look(self.place, False, (v, rise), k, BEFORE, TERM, BEYOND)
            for e in range(events):
                series[k, self.states + e] = self.found[BEYOND, e] + (self.found[MORE, e] if k == 0 else 0.0)
                away[e] += fabs(self.found[BEYOND, e]) if k > 0 else 0.0
        if self.checked[self.place, 0] > 0:
            self.fit(series, away)
        return self.terms

    def fit(self, series, away):
        """Put polynomials in the place of the conditions that are not linear."""
        k: cython.int
        r: cython.int
        i: cython.int
        row: cython.int
        for k in range(self.checked[self.place, 0]):
            row = self.states + self.checked[self.place, 1 + k]
            for r in range(CURVED):
                series[r, row] = 0.0
        for r in range(CURVED):
            self.check_at(series, self.nodes[r])
            for k in range(self.checked[self.place, 0]):
                row = self.checked[self.place, 1 + k]
                for i in range(CURVED):
                    series[i, self.states + row] += self.fits[i, r] * (self.found[BEYOND, row] + self.found[MORE, row])
        for k in range(self.checked[self.place, 0]):
            row = self.checked[self.place, 1 + k]
            away[row] = 0.0
            for r in range(1, CURVED):
                away[row] += fabs(series[r, self.states + row])

    def check_at(self, series, t):
        """Compute the conditions at a place of the step, from the polynomials of the states."""
        a: cython.double = self.shaking[0] + t * self.shaking[1]
        v: cython.double = self.shaking[2] + t * self.shaking[3]
        self.phases.evaluate(series, TERMS, t, self.rows[PLACE])
        self.phases.rates(self.place, a, v, PLACE, PLACE_RATES, False)
        self.check(self.place, a, v, PLACE, PLACE_RATES, BEYOND)

    def sharpened(self, series, e, t):
        """The place at which a condition fails, to rounding if it is not linear, from that of its polynomial."""
        k: cython.int
        i: cython.int
        _turn: cython.int
        value: cython.double
        slope: cython.double
        for k in range(self.checked[self.place, 0]):
            if self.checked[self.place, 1 + k] != e:
                continue
            for _turn in range(TURNS):
                self.check_at(series, t)
                value, slope = self.found[BEYOND, e] + self.found[MORE, e], 0.0
                for i in range(CURVED - 1, 0, -1):
                    slope = slope * t + i * series[i, self.states + e]
                if not slope < 0.0 or not fabs(value) < -1e-3 * slope:
                    break
                t = min(max(t - value / slope, 0.0), 1.0)
        return t

    def complete(self, series, first):
        """Fill the series with the polynomials of the outputs, too, from a column on."""
        j: cython.int
        k: cython.int
        r: cython.int
        a: cython.double
        v: cython.double
        t: cython.double
        self.phases.complete(self.place, (self.shaking[2], self.shaking[3]), self.terms, series)
        if self.curved[self.place, 0] == 0:
            return
        for k in range(self.curved[self.place, 0]):
            for r in range(CURVED):
                series[r, first + self.curved[self.place, 1 + k]] = 0.0
        for r in range(CURVED):
            t = self.nodes[r]
            a, v = self.shaking[0] + t * self.shaking[1], self.shaking[2] + t * self.shaking[3]
            self.phases.evaluate(series, TERMS, t, self.rows[PLACE])
            self.phases.rates(self.place, a, v, PLACE, PLACE_RATES, False)
            self.look(self.place, a, v, PLACE, PLACE_RATES, EARLY_OUTS)
            for k in range(self.curved[self.place, 0]):
                j = self.curved[self.place, 1 + k]
                for i in range(CURVED):
                    series[i, first + j] += self.fits[i, r] * self.found[EARLY_OUTS, j]

    def sum_up(self, order, series, sizes, away, sums):
        """Sum the magnitudes of the terms of the conditions' coefficients, as far as they are known.

        Two coefficients are exact, and a third one where the rates of the states are states: it is put in where those
        before it are zero, as after an uplift.
        """
        i: cython.int
        e: cython.int
        v: cython.int
        rise: cython.double = self.shaking[2]
        risen: cython.double = self.shaking[3]
        length: cython.double = self.part * self.h
        events: cython.int = self.phases.events(self.place)
        for i in range(self.n):
            self.rows[BEFORE, i] = self.rows[TERM, i]
        if order == 0:
            for i in range(self.n):
                self.rows[TERM, i] = max(fabs(self.rows[START, i]), sizes[i])
        elif order <= 2:
            self.phases.terms_of_rates(self.place, self.shaking[0], self.shaking[2], START, PLACE_RATES)
            for i in range(self.n):
                v = i if order == 1 else self.velocities[self.place, i]
                self.rows[TERM, i] = 0.0 if v < 0 else self.rows[PLACE_RATES, v]
                self.rows[TERM, i] *= length if order == 1 else 0.5 * length * length
        if order <= 2:
            self.rows[TERM, self.n] = fabs(self.shaking[order]) if order < 2 else 0.0
            self.rows[TERM, self.n + 1] = 1.0 if order == 0 else 0.0
            self.phases.magnitudes(self.place, (rise, risen), order, self.rows[BEFORE], self.rows[TERM], sums[order])
        for e in range(events):
            if order == 0:
                sums[0, e] += fabs(self.found[MORE, e])
            elif order > 2 or (order == 2 and self.exact[self.place, e] == 0):
                sums[order, e] = away[e]
        for i in range(self.checked[self.place, 0]):
            e = self.checked[self.place, 1 + i]
            if order == 0:
                sums[0, e] = BLUR / VANISHES * self.phases.scale(self.place, e)
            else:
                # The polynomial goes through values that are rounded, which counts in a short step.
                sums[order, e] = FLAT / VANISHES * away[e] + self.phases.scale(self.place, e)
        if order == 2:
            for i in range(self.n):
                v = self.velocities[self.place, i]
                self.rows[TERM, i] = 0.0 if v < 0 else self.rows[FIRST, v] * 0.5 * length * length
                self.rows[BEFORE, i] = self.rows[FIRST, i] * length
            self.rows[TERM, self.n] = self.rows[TERM, self.n + 1] = 0.0
            self.phases.look(self.place, False, (rise, risen), 2, BEFORE, TERM, BEYOND)
            for e in range(events):
                if self.exact[self.place, e] == 0 or fabs(series[0, self.states + e]) > VANISHES * sums[0, e]:
                    continue
                if fabs(series[1, self.states + e]) <= VANISHES * sums[1, e]:
                    series[2, self.states + e] = self.found[BEYOND, e]

    def time_to_rest(self, place):
        """Return 0 at rest, where all rates are tiny next to the largest states; otherwise a time to wait."""
        i: cython.int
        worst: cython.double = 0.0
        self.phases.rates(place, 0.0, 0.0, START, PLACE_RATES, False)
        for i in range(self.phases.moving(place)):
            worst = max(worst, fabs(self.rows[PLACE_RATES, i]) - CALM * self.rows[LARGEST, i])
        return 0.0 if worst <= 0.0 else self.h


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def grown(most: cython.double, error: cython.double) -> cython.double:
    """By how much the next step may be longer."""
    return most if error == 0.0 else min(most, SAFETY / sqrt(sqrt(sqrt(error))))
