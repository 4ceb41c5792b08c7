"""The motion in a part of a sample as a power series: when a condition fails first, and how high outputs get.

Declarations: `series.pxd`.
"""

from math import fabs

import cython
import numpy as np

from rockflex.engine.system import up8

if cython.compiled:
    from cython.cimports.libc.math import fabs
    from cython.cimports.rockflex.engine.polynomials import first_fall, highest
else:
    from rockflex.engine.polynomials import first_fall, highest

TERMS = cython.declare(cython.int, 48)  # of a series, at most
ORDERS = cython.declare(cython.int, 5)  # derivatives of a condition that may vanish at the start of a phase
VANISHES = cython.declare(cython.double, 1e-12)  # of the sum of the magnitudes of its terms: a condition that is zero
SNAP = cython.declare(cython.double, 1e-13)  # of a step: an event this close to its end is left to the next one
EXPANSION = cython.declare(cython.int, 16)  # samples that a power series counts like


@cython.final
@cython.cclass
class Series:
    """The motion from the present state on, expanded anew at each call of `expand`."""

    def __init__(self, phases, peaks, one_sided, y, sizes, counts, h):
        self.phases, self.peaks, self.one_sided, self.y, self.sizes = phases, peaks, one_sided, y, sizes
        self.n, self.outputs = counts
        self.states, self.h, self.high, self.when = len(y), h, peaks.high, peaks.when
        self.workspace, self.q, self.slope = np.zeros(self.states + 8), np.zeros(TERMS), np.zeros(TERMS)
        self.series, self.sums, self.away = np.zeros((TERMS, 0)), np.zeros((ORDERS, 0)), np.zeros(0)

    def widen(self, rows):
        """Make room for phases with so many outputs and conditions."""
        width = self.states + up8(rows)
        if self.series.shape[1] < width:
            self.series, self.sums, self.away = np.zeros((TERMS, width)), np.zeros((ORDERS, width)), np.zeros(width)

    def expand(self, place, start, end, u):
        """Expand the motion from the place u of a sample, as far as a series serves: the part of it, and the terms."""
        part: cython.double = min(1.0 - u, 0.5 ** self.phases.halvings(place))
        terms: cython.int = 0
        while True:
            self.peaks.add_work(EXPANSION)
            terms = self.phases.expand(
                place, part * self.h, start + (end - start) * u, (end - start) * part, self.y, self.series, self.away
            )
            if terms > 0:
                return part, terms
            part *= 0.5

    def first_event(self, place, terms, h, a, rise):
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
        for e in range(self.phases.events(place)):
            row = first_row + e
            if self.series[0, row] > self.away[self.outputs + e]:
                continue
            zeros = 0
            while zeros < ORDERS:
                if zeros == summed:
                    self.sum_up(place, summed, h, a, rise)
                    summed += 1
                if fabs(self.series[zeros, row]) > VANISHES * self.sums[zeros, row]:
                    break
                zeros += 1
            if zeros == ORDERS:
                continue
            if self.series[zeros, row] < 0.0:
                t = -self.series[zeros, row] / self.phases.scale(place, e)
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

    def sum_up(self, place, order, h, a, rise):
        """Sum the magnitudes of the terms of coefficients of an order: what their rounding is relative to."""
        i: cython.int
        for i in range(self.n):
            self.workspace[i] = (
                max(fabs(self.y[i]), self.sizes[i]) if order == 0 else self.sums[order - 1, i] * h / order
            )
        self.workspace[self.n] = fabs(a) if order == 0 else fabs(rise) if order == 1 else 0.0
        self.workspace[self.n + 1] = 1.0 if order == 0 else 0.0
        self.phases.magnitudes(place, self.workspace, self.sums[order])

    def jump_to_end(self, terms):
        """Move the state to the end of what was expanded."""
        self.phases.evaluate(self.series, terms, 1.0, self.y)

    def move(self, terms, t):
        """Move the state to t, and note the magnitudes of the terms that it is summed from."""
        self.phases.amounts(self.series, terms, t, self.sizes)
        self.phases.evaluate(self.series, terms, t, self.y)

    def raise_peaks(self, terms, stop, sample, part):
        """Raise the peaks to those of the expanded motion."""
        j: cython.int
        start: cython.double
        for j in range(self.outputs):
            start = self.series[0, self.states + j]
            if (start if self.one_sided[j] > 0.0 else fabs(start)) + self.away[j] > self.high[j]:
                self.raise_peak(j, terms, stop, 1e300, sample, part)

    def raise_peak(self, j, terms, stop, bound, sample, part):
        """Raise the peak of an output to that of its polynomial, which is known to be at most `bound`."""
        k: cython.int
        found: cython.double
        t: cython.double
        for k in range(terms):
            self.q[k] = self.series[k, self.states + j]
        found, t = highest(self.q, self.slope, terms, 0.0 if self.away[j] == 0.0 else stop, self.one_sided[j] > 0.0)
        if min(found, bound) > self.high[j]:
            self.high[j], self.when[j] = min(found, bound), sample + t * part
