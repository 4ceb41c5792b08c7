"""Move the state of a phase and its tangents over samples and parts of them. Declarations: `tangent_steps.pxd`.

The state y is in x = [y, a, a', 1], its tangents in s, one parameter after another. A table of a level has the change
of x over 2^(level - whole) samples, column after column; `slopes` has the derivatives of these changes.
"""

from math import ceil

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.libc.math import ceil

TURN = cython.declare(cython.double, 1.5)  # rad of the fastest motion in one power series, at most
LEFT_OUT = cython.declare(cython.double, 1e-18)  # of a power series
SPARE = cython.declare(cython.int, 3)  # terms more than that, for motions that first grow before they turn


def add(table, first, x, at, count, factor, out, to, width):
    """Add to a part of `out` the sum of rows of a table, from `first` on, times numbers of x, from `at` on."""
    c: cython.int
    i: cython.int
    z: cython.double
    for c in range(count):
        z = factor * x[at + c]
        if z != 0.0:
            for i in range(width):
                out[to + i] += z * table[first + c, i]


@cython.final
@cython.auto_pickle(False)
@cython.cclass
class Motion:
    """A phase with its derivatives with respect to P parameters, and the tables of its steps.

    Parameters
    ----------
    rates, rows : ndarray, shape (n, n + 2) and (m + e, n + 2)
        [A f c], and of the outputs and then of the conditions [C d e].
    rates_v, rows_v : ndarray, shape (n, n + 1) and (m + e, n + 1)
        The same for the vertical acceleration, [A_v f_v] and [C_v d_v].
    d_rates, d_rows, d_rates_v, d_rows_v : ndarray
        Their derivatives, with a first axis for the parameters.
    scales : ndarray, shape (e,)
        Of the events.
    tables, slopes : ndarray, shape (L, n + 3, n) and (L, n + 3, P, n)
        Changes over steps of every level, and their derivatives; these may be left out, with L = 0.
    whole
        The level of a sample.
    h, speed
        The time step, and how fast the motion may turn or grow, 1/s.
    """

    def __init__(
        self,
        rates,
        rows,
        rates_v,
        rows_v,
        d_rates,
        d_rows,
        d_rates_v,
        d_rows_v,
        scales,
        tables,
        slopes,
        whole,
        h,
        speed,
    ):
        self.n, self.P, self.whole, self.h, self.speed = len(rates), len(d_rates), whole, h, speed
        self.outputs, self.levels, self.scales = len(rows) - len(scales), len(tables), scales
        self.rows, self.rows_v, self.d_rows, self.d_rows_v = rows, rows_v, d_rows, d_rows_v
        n, width = self.n, self.n * self.P
        self.rates, self.rates_v = (np.ascontiguousarray(each.T) for each in (rates, rates_v))
        self.d_rates, self.d_rates_v = (
            np.ascontiguousarray(each.transpose(2, 0, 1)).reshape(each.shape[2], width) for each in (d_rates, d_rates_v)
        )
        self.tables, self.slopes = tables.reshape(-1, n), slopes.reshape(-1, width)
        self.shakes = bool(rates_v.any() or d_rates_v.any())
        self.out, self.more = np.zeros(n), np.zeros(width)
        self.term, self.before, self.tangent, self.passed = np.zeros(n), np.zeros(n), np.zeros(width), np.zeros(width)

    def step(self, level, x, s, tangents):
        """Move x, and the tangents if they are asked for, over a step of a level."""
        n: cython.int = self.n
        width: cython.int = self.n * self.P
        first: cython.int = level * (n + 3)
        i: cython.int
        p: cython.int
        out: cython.double[::1] = self.out
        more: cython.double[::1] = self.more
        for i in range(n):
            out[i] = 0.0
        add(self.tables, first, x, 0, n + 3, 1.0, out, 0, n)
        if tangents:
            for i in range(width):
                more[i] = 0.0
            add(self.slopes, first, x, 0, n + 3, 1.0, more, 0, width)
            for p in range(self.P):
                add(self.tables, first, s, p * n, n, 1.0, more, p * n, n)
            for i in range(width):
                s[i] += more[i]
        for i in range(n):
            x[i] += out[i]
        return 0

    def expand(self, x, s, tangents, v, climb, length):
        """Move them over a length by power series, under a vertical acceleration that grows by `climb` a second."""
        pieces: cython.int = (
            1 if self.speed * length <= TURN else cython.cast(cython.int, ceil(self.speed * length / TURN))
        )
        tau: cython.double = length / pieces
        terms: cython.int = 1
        left: cython.double = 1.0
        while left > LEFT_OUT:
            left *= self.speed * tau / terms
            terms += 1
        for _ in range(pieces):
            self.expand_piece(x, s, tangents, v, climb * tau, tau, terms + SPARE)
            x[self.n] += x[self.n + 1] * tau
            v += climb * tau
        return 0

    def expand_piece(self, x, s, tangents, v, climb, tau, terms):
        """The same over a piece that a series of so many terms covers; the acceleration stays."""
        n: cython.int = self.n
        width: cython.int = self.n * self.P if tangents else 0
        parts: cython.int = self.P if tangents else 0
        i: cython.int
        k: cython.int
        p: cython.int
        size: cython.double
        out: cython.double[::1] = self.out
        more: cython.double[::1] = self.more
        term: cython.double[::1] = self.term
        before: cython.double[::1] = self.before
        tangent: cython.double[::1] = self.tangent
        passed: cython.double[::1] = self.passed
        shakes: cython.bint = self.shakes and (v != 0.0 or climb != 0.0)
        for i in range(n):
            term[i], before[i] = x[i], 0.0
        for i in range(width):
            tangent[i], passed[i] = s[i], 0.0
        for k in range(terms):
            for i in range(n):
                out[i] = 0.0
            for i in range(width):
                more[i] = 0.0
            add(self.rates, 0, term, 0, n, 1.0, out, 0, n)
            for p in range(parts):
                add(self.rates, 0, tangent, p * n, n, 1.0, more, p * n, n)
            if parts:
                add(self.d_rates, 0, term, 0, n, 1.0, more, 0, width)
            if k == 0:
                for i in range(n):
                    out[i] += self.rates[n, i] * x[n] + self.rates[n + 1, i]
                for i in range(width):
                    more[i] += self.d_rates[n, i] * x[n] + self.d_rates[n + 1, i]
            elif k == 1:
                for i in range(n):
                    out[i] += self.rates[n, i] * x[n + 1] * tau
                for i in range(width):
                    more[i] += self.d_rates[n, i] * x[n + 1] * tau
            if shakes:
                add(self.rates_v, 0, term, 0, n, v, out, 0, n)
                add(self.rates_v, 0, before, 0, n, climb, out, 0, n)
                for p in range(parts):
                    add(self.rates_v, 0, tangent, p * n, n, v, more, p * n, n)
                    add(self.rates_v, 0, passed, p * n, n, climb, more, p * n, n)
                if parts:
                    add(self.d_rates_v, 0, term, 0, n, v, more, 0, width)
                    add(self.d_rates_v, 0, before, 0, n, climb, more, 0, width)
                if k < 2:
                    size = v if k == 0 else climb
                    for i in range(n):
                        out[i] += size * self.rates_v[n, i]
                    for i in range(width):
                        more[i] += size * self.d_rates_v[n, i]
            size = tau / (k + 1)
            for i in range(n):
                before[i], term[i] = term[i], out[i] * size
                x[i] += term[i]
            for i in range(width):
                passed[i], tangent[i] = tangent[i], more[i] * size
                s[i] += tangent[i]
        return 0

    def advance_freely(self, x, s, tangents, length):
        """Move them over some samples without acceleration."""
        level: cython.int = self.levels - 1
        size: cython.double = 2.0 ** (level - self.whole)
        x[self.n] = x[self.n + 1] = 0.0
        while level >= 0:
            if length >= size:
                self.step(level, x, s, tangents)
                length -= size
            else:
                level -= 1
                size *= 0.5
        if length > 0.0:
            self.expand(x, s, tangents, 0.0, 0.0, length * self.h)
        return 0

    def advance_in_sample(self, x, s, tangents, v, climb, part):
        """Move them over a part of a sample; x has the acceleration, `climb` is the vertical one's growth a second."""
        level: cython.int = self.whole
        size: cython.double = 1.0
        if self.shakes and (v != 0.0 or climb != 0.0):
            self.expand(x, s, tangents, v, climb, part * self.h)
            return 0
        while level >= 0:
            if part >= size:
                self.step(level, x, s, tangents)
                x[self.n] += x[self.n + 1] * size * self.h
                part -= size
            level -= 1
            size *= 0.5
        if part > 0.0:
            self.expand(x, s, tangents, 0.0, 0.0, part * self.h)
        return 0

    def rates_at(self, y, a, v, out):
        """Compute y'."""
        i: cython.int
        for i in range(self.n):
            out[i] = self.rates[self.n, i] * a + self.rates[self.n + 1, i]
            if v != 0.0:
                out[i] += v * self.rates_v[self.n, i]
        add(self.rates, 0, y, 0, self.n, 1.0, out, 0, self.n)
        if v != 0.0:
            add(self.rates_v, 0, y, 0, self.n, v, out, 0, self.n)
        return 0

    def value(self, row, y, a, v):
        """An output or a condition."""
        i: cython.int
        n: cython.int = self.n
        found: cython.double = self.rows[row, n] * a + self.rows[row, n + 1]
        for i in range(n):
            found += self.rows[row, i] * y[i]
        if v != 0.0:
            found += v * self.rows_v[row, n]
            for i in range(n):
                found += v * self.rows_v[row, i] * y[i]
        return found

    def slope(self, row, p, y, s, a, v):
        """Its derivative with respect to a parameter, at a given time."""
        i: cython.int
        n: cython.int = self.n
        found: cython.double = self.d_rows[p, row, n] * a + self.d_rows[p, row, n + 1]
        for i in range(n):
            found += self.rows[row, i] * s[p * n + i] + self.d_rows[p, row, i] * y[i]
        if v != 0.0:
            found += v * self.d_rows_v[p, row, n]
            for i in range(n):
                found += v * (self.rows_v[row, i] * s[p * n + i] + self.d_rows_v[p, row, i] * y[i])
        return found

    def rate(self, row, y, rates, grows, v, climbs):
        """Its rate, from y' and how much both accelerations grow in a second."""
        i: cython.int
        n: cython.int = self.n
        found: cython.double = self.rows[row, n] * grows
        for i in range(n):
            found += self.rows[row, i] * rates[i]
        if v != 0.0 or climbs != 0.0:
            found += climbs * self.rows_v[row, n]
            for i in range(n):
                found += self.rows_v[row, i] * (v * rates[i] + climbs * y[i])
        return found
