"""The motion in a part of a sample as a power series: when a condition fails first, and how high outputs get.

Declarations: `series.pxd`.
"""

from math import fabs

import cython
import numpy as np

from rockflex.engine.system import up8

if cython.compiled:
    from cython.cimports.libc.math import fabs
    from cython.cimports.rockflex.engine.polynomials import first_fall, highest_of
else:
    from rockflex.engine.polynomials import first_fall, highest_of

TERMS = cython.declare(cython.int, 48)  # of a series, at most
ORDERS = cython.declare(cython.int, 5)  # derivatives of a condition that may vanish at the start of a phase
VANISHES = cython.declare(cython.double, 1e-12)  # of the sum of the magnitudes of its terms: a condition that is zero
SNAP = cython.declare(cython.double, 1e-13)  # of a step: an event this close to its end is left to the next one
EXPANSION = cython.declare(cython.int, 16)  # samples that a power series counts like


@cython.final
@cython.auto_pickle(False)
@cython.cclass
class Series:
    """The motion from the present state on, expanded anew at each call of `expand`."""

    def __init__(self, phases, peaks, flow, one_sided, y, sizes, h):
        self.phases, self.peaks, self.flow = phases, peaks, flow
        self.one_sided, self.y, self.sizes = one_sided, y, sizes
        self.n, self.outputs = flow.n, flow.outputs
        self.states, self.h, self.high, self.when = len(y), h, peaks.high, peaks.when
        self.workspace, self.q, self.slope = np.zeros(self.states + 8), np.zeros(TERMS), np.zeros(TERMS)
        self.term, self.v = np.zeros(self.states + 8), (0.0, 0.0)
        self.series, self.sums, self.away = np.zeros((TERMS, 0)), np.zeros((ORDERS, 0)), np.zeros(0)
        self.start, self.reach = np.zeros((2, up8(max(1, self.outputs))))

    def widen(self, conditions):
        """Make room for phases with so many conditions."""
        width = self.states + up8(conditions) + up8(self.outputs)
        if self.series.shape[1] < width:
            self.series, self.sums, self.away = np.zeros((TERMS, width)), np.zeros((ORDERS, width)), np.zeros(width)

    def expand(self, place, start, end, v, u):
        """Expand the motion from the place u of a sample, as far as a series serves; return the part of the sample.

        `start` and `end` are the accelerations at the ends of the sample, those in v the vertical ones. In a phase that
        is not linear the motion is expanded as far as a step goes; -1 if none is short enough.
        """
        self.place, self.a = place, start + (end - start) * u
        if self.phases.nonlinear(place):
            self.part = self.flow.take_step(place, start, end, v, u)
            if self.part > 0.0:
                self.terms = self.flow.fill(self.series, self.away)
            return self.part
        self.part = min(1.0 - u, 0.5 ** self.phases.halvings(place))
        while True:
            self.rise = (end - start) * self.part
            self.v = v[0] + (v[1] - v[0]) * u, (v[1] - v[0]) * self.part
            self.peaks.add_work(EXPANSION)
            self.terms = self.phases.expand(
                place, self.part * self.h, self.a, self.rise, self.v, self.y, self.series, self.away
            )
            if self.terms > 0:
                return self.part
            self.part *= 0.5

    def first_event(self):
        """Where in the part the first condition fails, from 0 to 1, and which; 1 and -1 if none does.

        At its start a condition may be zero, because the last event was its own, or due to rounding: then its first
        derivative that is not zero decides, and the zeros are divided out. Of several conditions that have failed from
        the start that of the lowest derivative, and then of the largest violation over its scale, is the first.
        """
        first_sum: cython.int = self.n - self.phases.shift(self.place, self.v)
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
        for e in range(self.phases.events(self.place)):
            row = self.states + e
            if self.series[0, row] > self.away[e]:
                continue
            zeros = 0
            while zeros < ORDERS:
                if zeros == summed:
                    self.sum_up(summed)
                    summed += 1
                if fabs(self.series[zeros, row]) > VANISHES * self.sums[zeros, first_sum + e]:
                    break
                zeros += 1
            if zeros == ORDERS:
                continue
            if self.series[zeros, row] < 0.0:
                t = -self.series[zeros, row] / self.phases.scale(self.place, e)
                if zeros < lowest or (zeros == lowest and t > worst):
                    lowest, worst, found, first = zeros, t, e, 0.0
                continue
            if first > 0.0:
                for k in range(self.terms):
                    self.q[k] = self.series[k, row]
                t = first_fall(self.q, zeros, self.terms - zeros, 0.0, first)
                if t <= 1.0 - SNAP and (t < first or found < 0):
                    first, found = t, e
        if found >= 0 and first > 0.0 and self.phases.nonlinear(self.place):
            first = self.flow.sharpened(self.series, found, first)
        return first, found

    def sum_up(self, order):
        """Sum the magnitudes of the terms of coefficients of an order: what their rounding is relative to."""
        i: cython.int
        shift: cython.int = self.phases.shift(self.place, self.v)
        if self.phases.nonlinear(self.place):
            self.flow.sum_up(order, self.series, self.sizes, self.away, self.sums)
            return
        for i in range(self.states):
            self.term[i] = self.workspace[i]
        if order == 0:
            for i in range(self.n):
                self.workspace[i] = max(fabs(self.y[i]), self.sizes[i])
        else:
            for i in range(shift):
                self.workspace[i] = self.workspace[shift + i] * self.part * self.h / order
            for i in range(shift, self.n):
                self.workspace[i] = self.sums[order - 1, i - shift] * self.part * self.h / order
        self.workspace[self.n] = fabs(self.a) if order == 0 else fabs(self.rise) if order == 1 else 0.0
        self.workspace[self.n + 1] = 1.0 if order == 0 else 0.0
        self.phases.magnitudes(self.place, self.v, order, self.term, self.workspace, self.sums[order])

    def skip(self):
        """Move the state to the end of the part."""
        self.phases.evaluate(self.series, self.terms, 1.0, self.y)

    def move(self, t):
        """Move the state to t, and note the magnitudes of the terms that it is summed from."""
        if self.phases.nonlinear(self.place):
            if t == 1.0:
                self.flow.accept()
                return
            self.flow.leave()
        self.phases.move(self.series, self.terms, t, self.y, self.sizes)

    def drop_hopeless_samples(self):
        """Drop the samples that cannot have higher peaks than those found so far; the number of the others."""
        r: cython.int
        j: cython.int
        kept: cython.int = 0
        higher: cython.bint
        rows: cython.double[:, ::1] = self.peaks.candidates
        for r in range(self.peaks.count()):
            higher = False
            for j in range(self.outputs):
                higher = higher or rows[r, 3 + self.n + j] > self.high[j]
            if higher:
                if kept < r:
                    for j in range(3 + self.n + self.outputs):
                        rows[kept, j] = rows[r, j]
                kept += 1
        self.peaks.keep(kept)
        return kept

    def candidate(self, r):
        """The number of a sample that may have higher peaks."""
        return cython.cast(cython.int, self.peaks.candidates[r, 1])

    def phase_of(self, r):
        """The place of its phase."""
        return cython.cast(cython.int, self.peaks.candidates[r, 0])

    def begin_search(self, r, a):
        """Take the state at the start of such a sample."""
        k: cython.int
        rows: cython.double[:, ::1] = self.peaks.candidates
        for k in range(self.n):
            self.y[k] = rows[r, 3 + k]
        for k in range(cython.cast(cython.int, rows[r, 2]), 0, -1):
            self.phases.advance(self.phase_of(r), a, self.candidate(r) - k, self.y)

    def search(self, r, start, end, v, sample, u):
        """Raise the peaks to those in a part of such a sample, and move the state to its end; the place of the next."""
        part: cython.double = self.expand(self.phase_of(r), start, end, v, u)
        rows: cython.double[:, ::1] = self.peaks.candidates
        self.raise_peaks(1.0, sample + u, rows[r, 3 + self.n :])
        self.skip()
        return u + part if part < 1.0 - u else 1.0

    def raise_peaks(self, stop, sample, highest):
        """Raise the peaks to those of the expanded motion up to `stop`, none of which is higher than its `highest`."""
        j: cython.int
        first: cython.double
        completed: cython.bint = self.phases.nonlinear(self.place)
        if completed:
            if self.flow.clear(stop, sample):
                return
            self.reach_of_step()
        else:
            self.phases.reach(self.place, self.v, self.terms, self.series, self.start, self.reach)
        for j in range(self.outputs):
            first = self.start[j] if self.one_sided[j] > 0.0 else fabs(self.start[j])
            if min(first + self.reach[j], highest[j]) > self.high[j]:
                if not completed:
                    self.phases.complete(self.place, self.v, self.terms, self.series)
                    completed = True
                self.raise_peak(j, stop, sample, highest[j])

    def reach_of_step(self):
        """Expand the outputs over a step, and find where they start and how far they may get from there."""
        j: cython.int
        k: cython.int
        row: cython.int = self.states + (self.phases.events(self.place) + 7) // 8 * 8
        self.flow.complete(self.series, row)
        for j in range(self.outputs):
            self.start[j], self.reach[j] = self.series[0, row + j], 0.0
            for k in range(1, self.terms):
                self.reach[j] += fabs(self.series[k, row + j])

    def raise_peak(self, j, stop, sample, highest):
        """Raise the peak of an output to that of its polynomial, which is known to be at most `highest`."""
        k: cython.int
        found: cython.double
        t: cython.double
        row: cython.int = self.states + (self.phases.events(self.place) + 7) // 8 * 8 + j
        for k in range(self.terms):
            self.q[k] = self.series[k, row]
        found, t = highest_of(self.q, self.slope, self.terms, stop, self.one_sided[j] > 0.0)
        if min(found, highest) > self.high[j]:
            self.high[j], self.when[j] = min(found, highest), sample + t * self.part
