"""The motion in a phase that is not linear: steps of a Runge-Kutta pair, and whether something may happen in one.

A step ends with its sample at the latest. In one that the error control accepts no mode turns by much more than a
radian, so that a row deviates from the cubic through its values and slopes at both ends by a few hundredths of the
cubic's curvature (a harmonic that turns by x: x²/48); a fifth is allowed for. Declarations: `flow.pxd`.
"""

from math import fabs, isfinite, sqrt

import cython
import numpy as np

from rockflex.engine.system import up8
from rockflex.engine.tableau import STAGES, C

if cython.compiled:
    from cython.cimports.libc.math import INFINITY, fabs, isfinite, sqrt
else:
    INFINITY = float("inf")

TOLERANCE = cython.declare(cython.double, 1e-10)  # relative error of a step
SHORTEST = cython.declare(cython.double, 1e-13)  # s
SAFETY = cython.declare(cython.double, 0.9)  # of the error control
LEAST = cython.declare(cython.double, 0.2)
MOST = cython.declare(cython.double, 4.0)
WORK = cython.declare(cython.int, 12)  # samples that a step counts like
STRETCH = cython.declare(cython.longlong, 1 << 22)  # of work, after which a march pauses
OFTEN = cython.declare(cython.int, 64)  # steps in a sample, after which it is traversed instead
NEAR = cython.declare(cython.double, 0.75)  # of its peak: an output below that at both ends of a step does not reach it
STRAY = cython.declare(cython.double, 0.2)  # of a cubic's curvature, by which a row may deviate from it
VANISHES = cython.declare(cython.double, 1e-12)  # as in `series`
CALM = cython.declare(cython.double, 1e-8)  # 1/s: of its largest value, the rate of a state that is at rest
TERMS = cython.declare(cython.int, 8)  # of the polynomial over a step
CURVED = cython.declare(cython.int, 10)  # of that of an output that is not linear
TRIAL = cython.declare(cython.int, STAGES)  # rows of `work`, as in `loops`
PLACE = cython.declare(cython.int, STAGES + 7)
PLACE_RATES = cython.declare(cython.int, STAGES + 8)
ROOM = STAGES + 9
LAST = cython.declare(cython.int, 12)
EARLY = cython.declare(cython.int, 7)  # stages near the thirds of a step
LATE = cython.declare(cython.int, 8)
EARLY_AT = cython.declare(cython.double, C[7])
LATE_AT = cython.declare(cython.double, C[8])

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
    root: cython.double
    q: cython.double
    t: cython.double
    k: cython.int
    if before * after > 0.0 and min(fabs(before), fabs(after)) > 8.0 * slack:  # it is monotonic
        return low, high
    root = b * b - 3.0 * before * c
    if root > 0.0:
        q = -b - (sqrt(root) if b > 0.0 else -sqrt(root))
        for k in range(2):
            if k == 0 and fabs(3.0 * c) <= fabs(q):
                continue
            if k == 1 and fabs(before) >= fabs(q):
                continue
            t = q / (3.0 * c) if k == 0 else before / q  # where it is level
            if t > 0.0:
                t = first + t * (before + t * (b + t * c))
                low, high = min(low, t), max(high, t)
    return low - slack, high + slack


@cython.final
@cython.cclass
class Flow:
    """Steps from the present state on."""

    def __init__(self, phases, peaks, one_sided, y, outputs, h):
        self.phases, self.peaks, self.one_sided, self.y, self.h = phases, peaks, one_sided, y, h
        self.n, self.outputs = phases.n, outputs
        self.states, self.high, self.when = len(y), peaks.high, peaks.when
        self.largest, self.shaking, self.work = np.zeros(self.states), np.zeros(4), np.zeros((ROOM, self.states))
        self.first, self.last, self.end = self.work[0], self.work[LAST], self.work[TRIAL]
        self.spot, self.spot_rates = self.work[PLACE], self.work[PLACE_RATES]
        self.nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(CURVED) / (CURVED - 1))
        self.fits = np.linalg.inv(np.vander(np.asarray(self.nodes), increasing=True))
        self.tilts = np.array([[0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 2.0, 3.0]]) @ CUBIC
        self.kept, self.vector, self.term = np.zeros(3 * self.states), np.zeros(self.states), np.zeros(self.states)
        self.facts = []
        self.curved, self.velocities = np.zeros((1, 1), dtype=np.intc), np.zeros((1, self.n), dtype=np.intc)
        self.least = np.zeros((1, 1))
        self.exact, self.terms = np.zeros((1, 1), dtype=np.intc), TERMS
        self.outs, self.ends, self.early, self.late = np.zeros((4, up8(max(1, self.outputs))))
        self.widen(0)
        self.doubt = np.zeros(max(1, self.outputs), dtype=np.intc)
        self.place, self.counts, self.part = -1, False, 0.0
        self.begin()

    def widen(self, conditions):
        """Make room for phases with so many conditions."""
        wide = up8(max(1, conditions))
        self.more, self.below, self.beyond = np.zeros((3, wide))
        self.slopes, self.bends = np.zeros((2, max(wide, up8(max(1, self.outputs)))))

    def know(self, phase, place):
        """Take a phase: its outputs that are not linear, and which states are rates of others."""
        n, m = self.n, self.outputs
        velocities, curved, least = np.full(n, -1, dtype=np.intc), np.zeros(m + 1, dtype=np.intc), np.zeros(m + 1)
        velocities[list(phase.velocities)] = list(phase.velocities.values())
        count = len(phase.curved)
        curved[0], curved[1 : 1 + count], least[1 : 1 + count] = count, list(phase.curved), list(phase.curved.values())
        if len(phase.events) > self.more.shape[0]:
            self.widen(len(phase.events))
        exact = [int(not event.row[0][velocities < 0].any()) for event in phase.events]
        nothing = np.zeros(m + 1, dtype=np.intc), np.zeros(m + 1), np.full(n, -1, dtype=np.intc), []
        self.facts += [nothing] * (place + 1 - len(self.facts))
        self.facts[place] = curved, least, velocities, exact
        known = list(zip(*self.facts, strict=True))
        self.curved, self.least, self.velocities = np.array(known[0]), np.array(known[1]), np.array(known[2])
        most = max(1, *map(len, known[3]))
        self.exact = np.array([each + [0] * (most - len(each)) for each in known[3]], dtype=np.intc)

    def begin(self):
        """Begin a run anew."""
        self.largest[:] = 0.0
        self.work[:, :] = 0.0
        self.step = INFINITY
        self.forget()

    def resume(self, counts):
        """Go on with another acceleration, and with or without the states on which nothing depends."""
        self.counts = counts
        self.forget()

    def forget(self):
        """Note that the state has changed, or the phase."""
        self.known = self.entered = self.tried = False

    def enter(self, place):
        """Note what the constant states add to the conditions of a phase."""
        k: cython.int
        self.place, self.entered, self.known = place, True, False
        for k in range(self.more.shape[0]):
            self.more[k] = 0.0
        self.phases.begin(place, self.y, self.more)

    def take(self, place, start, end, v, u):
        """Take a step from the place u of a sample; return the part of the sample, -1 if none is short enough."""
        longest: cython.double = 1.0 - u
        part: cython.double = min(self.step, longest)
        most: cython.double = MOST
        error: cython.double
        if self.tried:
            self.tried = False
            return self.part
        if not self.entered or self.place != place:
            self.enter(place)
        self.shaking[0], self.shaking[2] = start + (end - start) * u, v[0] + (v[1] - v[0]) * u
        if not self.known:
            self.phases.rates(place, self.shaking[0], self.shaking[2], self.y, self.first, self.counts)
            self.known = True
        while True:
            self.peaks.add_work(WORK)
            self.shaking[1], self.shaking[3] = (end - start) * part, (v[1] - v[0]) * part
            error = self.phases.attempt(
                place, part * self.h, self.shaking, self.y, self.largest, self.work, self.counts
            )
            error = error / TOLERANCE if isfinite(error) else INFINITY
            if error <= 1.0:
                # A step that a sample or an event has shortened says little about the next one.
                if part < longest:
                    self.step = part * grown(most, error)
                elif self.step < part * most:
                    self.step = max(part * grown(most, error), self.step)
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
        for k in range(self.n):
            self.y[k] = self.end[k]
            self.first[k] = self.last[k]
        for k in range(self.phases.moving(self.place)):
            self.largest[k] = max(self.largest[k], fabs(self.y[k]))

    def leave(self):
        """Note that the state has moved to a place within the step."""
        self.known = self.tried = False

    def enlarge(self, sizes):
        """After a jump the magnitudes of what the state is summed from are not below those of the state."""
        k: cython.int
        for k in range(self.n):
            sizes[k] = max(sizes[k], fabs(self.y[k]))

    def march(self, place, a, v, i, last, states):
        """Advance whole samples from i up to `last` as far as nothing happens; the number of the sample reached."""
        k: cython.int
        steps: cython.int
        u: cython.double
        part: cython.double
        rise: cython.double = v[i] if v.shape[0] > 0 else 0.0
        risen: cython.double = rise
        before: cython.double = self.peaks.before()
        until: cython.longlong = self.peaks.work() + STRETCH
        self.peaks.look(False)
        if not self.entered or self.place != place:
            self.enter(place)
        if not self.known:
            self.phases.rates(place, a[i], rise, self.y, self.first, self.counts)
            self.known = True
        self.y[self.n], self.y[self.n + 1] = a[i], 1.0
        self.look(place, a[i], rise, self.y, self.first, self.outs)
        self.raise_to(self.outs, before + i)
        self.phases.rows_of(place, False, self.y, self.y, (rise, 0.0, rise), self.below)
        while i < last and self.peaks.work() < until:
            u, steps, self.kept_step = 0.0, 0, self.step
            if v.shape[0] > 0:
                rise, risen = v[i], v[i + 1]
            while u < 1.0:
                part = self.take(place, a[i], a[i + 1], (rise, risen), u)
                if part > 0.0 and steps < OFTEN and not self.conditions_hide(place):
                    self.look_ahead(place)
                    if not self.peaks_hide(place) and not self.curves_hide(place):
                        if steps == 0 and part < 1.0:
                            self.keep()
                        u = u + part if part < 1.0 - u else 1.0
                        steps += 1
                        self.accept()
                        self.raise_to(self.ends, before + i + u)
                        self.outs[:], self.below[:] = self.ends, self.beyond
                        continue
                if steps > 0:
                    self.restore()
                self.tried = steps == 0 and part > 0.0
                self.peaks.look(True)
                return i
            i += 1
            self.peaks.add_work(1)
            if states.shape[0] > 1:
                for k in range(self.n):
                    states[i, k] = self.y[k]
        return i

    def keep(self):
        """Keep the start of a sample that takes several steps."""
        k: cython.int
        for k in range(self.states):
            self.kept[k], self.kept[self.states + k] = self.y[k], self.largest[k]
            self.kept[2 * self.states + k] = self.first[k]

    def restore(self):
        """Go back to the start of the sample."""
        k: cython.int
        for k in range(self.states):
            self.y[k], self.largest[k] = self.kept[k], self.kept[self.states + k]
            self.first[k] = self.kept[2 * self.states + k]
        self.step, self.known = self.kept_step, True

    def look(self, place, a, v, y, rates, outs):
        """Compute the outputs under both accelerations."""
        self.phases.rows_of(place, True, y, y, (v, 0.0, v), outs)
        if self.curved[place, 0] > 0:
            self.phases.observe(place, a, v, y, rates, outs)

    def look_ahead(self, place):
        """Compute the outputs at the end of the step."""
        a: cython.double = self.shaking[0] + self.shaking[1]
        self.look(place, a, self.shaking[2] + self.shaking[3], self.end, self.last, self.ends)

    def counted(self, j, value):
        """What counts of an output."""
        return value if self.one_sided[j] > 0.0 else fabs(value)

    def raise_to(self, outs, sample):
        """Raise the peaks to outputs."""
        j: cython.int
        value: cython.double
        for j in range(self.outputs):
            value = self.counted(j, outs[j])
            if value > self.high[j]:
                self.high[j], self.when[j] = value, sample

    def slopes_of(self, outputs, place):
        """Compute the rates of conditions or outputs over a step, at both of its ends."""
        k: cython.int
        v: cython.double = self.shaking[2]
        for k in range(self.n):
            self.vector[k] = self.first[k] * self.part * self.h
        self.vector[self.n], self.vector[self.n + 1] = self.shaking[1], 0.0
        self.phases.rows_of(place, outputs, self.vector, self.y, (v, self.shaking[3], self.shaking[3]), self.slopes)
        v += self.shaking[3]
        for k in range(self.n):
            self.vector[k] = self.last[k] * self.part * self.h
        self.phases.rows_of(place, outputs, self.vector, self.end, (v, self.shaking[3], self.shaking[3]), self.bends)

    def conditions_hide(self, place):
        """Whether a condition may fail within the step or at its end."""
        e: cython.int
        low: cython.double
        high: cython.double
        v: cython.double = self.shaking[2] + self.shaking[3]
        self.phases.rows_of(place, False, self.end, self.end, (v, 0.0, v), self.beyond)
        self.slopes_of(False, place)
        for e in range(self.phases.events(place)):
            low, high = range_of(
                self.below[e] + self.more[e], self.beyond[e] + self.more[e], self.slopes[e], self.bends[e]
            )
            if min(low, high) <= 0.0:
                return True
        return False

    def peaks_hide(self, place):
        """Whether a linear output may have a new peak within the step, and not at its ends."""
        j: cython.int
        k: cython.int
        low: cython.double
        high: cython.double
        most: cython.double
        sloped: cython.bint = False
        for j in range(self.outputs):
            self.doubt[j] = 1
        for k in range(self.curved[place, 0]):
            self.doubt[self.curved[place, 1 + k]] = 0
        for j in range(self.outputs):
            if self.doubt[j] == 0 or max(fabs(self.outs[j]), fabs(self.ends[j])) <= NEAR * self.high[j]:
                continue
            if not sloped:
                self.slopes_of(True, place)
                sloped = True
            low, high = range_of(self.outs[j], self.ends[j], self.slopes[j], self.bends[j])
            most = max(self.counted(j, self.outs[j]), self.counted(j, self.ends[j]))
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
        before: cython.double
        after: cython.double
        told: cython.bint = False
        for k in range(self.curved[place, 0]):
            j = self.curved[place, 1 + k]
            most = max(self.counted(j, self.outs[j]), self.counted(j, self.ends[j]))
            low = max(fabs(self.high[j]), self.least[place, 1 + k])
            if most <= self.high[j] - (1.0 - NEAR) * low:
                continue
            if not told:
                self.look_within(place, EARLY, EARLY_AT, self.early)
                self.look_within(place, LATE, LATE_AT, self.late)
                told = True
            before = self.tilts[0, 0] * self.outs[j] + self.tilts[0, 1] * self.early[j]
            before += self.tilts[0, 2] * self.late[j] + self.tilts[0, 3] * self.ends[j]
            after = self.tilts[1, 0] * self.outs[j] + self.tilts[1, 1] * self.early[j]
            after += self.tilts[1, 2] * self.late[j] + self.tilts[1, 3] * self.ends[j]
            low, high = range_of(self.outs[j], self.ends[j], before, after)
            if max(self.counted(j, low), self.counted(j, high)) > max(self.high[j], most):
                return True
        return False

    def look_within(self, place, stage, t, outs):
        """Compute the outputs at a stage of the step."""
        a: cython.double = self.shaking[0] + t * self.shaking[1]
        self.phases.within(place, stage, self.part * self.h, self.y, self.work, self.spot)
        self.spot[self.n], self.spot[self.n + 1] = a, 1.0
        self.look(place, a, self.shaking[2] + t * self.shaking[3], self.spot, self.work[stage], outs)

    def clear(self, t, sample):
        """Raise the peaks over the step up to t if none may be within; return whether that was all."""
        j: cython.int
        self.y[self.n], self.y[self.n + 1] = self.shaking[0], 1.0
        self.look(self.place, self.shaking[0], self.shaking[2], self.y, self.first, self.outs)
        self.raise_to(self.outs, sample)
        self.look_ahead(self.place)
        if t < 1.0:
            for j in range(self.outputs):
                if self.counted(j, self.ends[j]) > self.high[j]:
                    return False
        if self.peaks_hide(self.place) or self.curves_hide(self.place):
            return False
        if t == 1.0:
            self.raise_to(self.ends, sample + self.part)
        return True

    def fill(self, series, away):
        """Fill a series with the polynomials of states and conditions; return the number of terms."""
        k: cython.int
        e: cython.int
        i: cython.int
        events: cython.int = self.phases.events(self.place)
        v: cython.double = self.shaking[2]
        rise: cython.double = self.shaking[3]
        first: cython.double
        self.terms = CURVED if self.curved[self.place, 0] > 0 else TERMS if v == 0.0 and rise == 0.0 else TERMS + 1
        self.phases.bend(self.place, self.part * self.h, self.shaking, self.y, self.work, series, self.counts)
        for k in range(TERMS, self.terms):
            for i in range(self.states):
                series[k, i] = 0.0
        for e in range(events):
            away[e] = 0.0
        for k in range(self.terms):
            first = v if k == 0 else rise if k == 1 else 0.0
            self.phases.rows_of(
                self.place, False, series[k], series[max(k - 1, 0)], (v, rise if k > 0 else 0.0, first), self.beyond
            )
            for e in range(events):
                series[k, self.states + e] = self.beyond[e] + (self.more[e] if k == 0 else 0.0)
                away[e] += fabs(self.beyond[e]) if k > 0 else 0.0
        return self.terms

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
            self.phases.evaluate(series, TERMS, t, self.spot)
            self.spot[self.n], self.spot[self.n + 1] = a, 1.0
            self.phases.rates(self.place, a, v, self.spot, self.spot_rates, False)
            self.look(self.place, a, v, self.spot, self.spot_rates, self.early)
            for k in range(self.curved[self.place, 0]):
                j = self.curved[self.place, 1 + k]
                for i in range(CURVED):
                    series[i, first + j] += self.fits[i, r] * self.early[j]

    def sum_up(self, order, series, sizes, away, sums):
        """Sum the magnitudes of the terms of the conditions' coefficients, as far as they are known.

        Two coefficients are exact, and a third one where the rates of the states are states: it is put in where those
        before it are zero, as after an uplift.
        """
        i: cython.int
        e: cython.int
        v: cython.int
        rise: cython.double
        length: cython.double = self.part * self.h
        events: cython.int = self.phases.events(self.place)
        for i in range(self.n):
            self.term[i] = self.vector[i]
        if order == 0:
            for i in range(self.n):
                self.vector[i] = max(fabs(self.y[i]), sizes[i])
        elif order <= 2:
            self.phases.terms_of_rates(self.place, self.shaking[0], self.shaking[2], self.y, self.spot_rates)
            for i in range(self.n):
                v = i if order == 1 else self.velocities[self.place, i]
                self.vector[i] = 0.0 if v < 0 else self.spot_rates[v]
                self.vector[i] *= length if order == 1 else 0.5 * length * length
        if order <= 2:
            self.vector[self.n] = fabs(self.shaking[order]) if order < 2 else 0.0
            self.vector[self.n + 1] = 1.0 if order == 0 else 0.0
            self.phases.magnitudes(
                self.place, (self.shaking[2], self.shaking[3]), order, self.term, self.vector, sums[order]
            )
        for e in range(events):
            if order == 0:
                sums[0, e] += fabs(self.more[e])
            elif order > 2 or (order == 2 and self.exact[self.place, e] == 0):
                sums[order, e] = away[e]
        if order == 2:
            for i in range(self.n):
                v = self.velocities[self.place, i]
                self.vector[i] = 0.0 if v < 0 else self.first[v] * 0.5 * length * length
                self.term[i] = self.first[i] * length
            self.vector[self.n] = self.vector[self.n + 1] = 0.0
            rise = self.shaking[3]
            self.phases.rows_of(self.place, False, self.vector, self.term, (self.shaking[2], rise, 0.0), self.beyond)
            for e in range(events):
                if self.exact[self.place, e] == 0 or fabs(series[0, self.states + e]) > VANISHES * sums[0, e]:
                    continue
                if fabs(series[1, self.states + e]) <= VANISHES * sums[1, e]:
                    series[2, self.states + e] = self.beyond[e]

    def time_to_rest(self, place):
        """Return 0 at rest, where all rates are tiny next to the largest states; otherwise a time to wait."""
        i: cython.int
        worst: cython.double = 0.0
        self.phases.rates(place, 0.0, 0.0, self.y, self.spot_rates, False)
        for i in range(self.phases.moving(place)):
            worst = max(worst, fabs(self.spot_rates[i]) - CALM * self.largest[i])
        return 0.0 if worst <= 0.0 else self.h


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def grown(most: cython.double, error: cython.double) -> cython.double:
    """By how much the next step may be longer."""
    return most if error == 0.0 else min(most, SAFETY / sqrt(sqrt(sqrt(error))))
