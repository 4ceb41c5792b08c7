"""The compiled loops of `march.c` as methods; `loops_twin` has the same in NumPy. Declarations: `loops.pxd`."""

import os

import cython
import numpy as np

from rockflex.engine.system import up8

LEVELS = ("", "baseline", "v3", "v4")


def chosen_level():
    """Return the level asked for by the environment variable ROCKFLEX_SIMD; empty for the best one."""
    asked = os.environ.get("ROCKFLEX_SIMD", "")
    if asked not in LEVELS or rockflex_loops(asked.encode()) == cython.NULL:
        raise ImportError(
            f"ROCKFLEX_SIMD={asked!r} is not a level of vector instructions that this processor has. Give 'baseline', "
            "'v3' (AVX2) or 'v4' (AVX-512), or leave it out for the best one."
        )
    return asked.encode()


LOOPS = cython.declare(cython.pointer(cython.const[Loops]), rockflex_loops(chosen_level()))
LEVEL = LOOPS.level.decode()


@cython.cclass
class Peaks:
    """Highest values of the outputs, the samples at which they were reached, and samples that may have higher ones."""

    def __init__(self, one_sided, states, room):
        outputs = one_sided.shape[0]
        self.high, self.when = np.where(one_sided > 0.0, -np.inf, 0.0), np.zeros(outputs)
        self.rows = np.zeros(MAX_ROWS)
        self.candidates = np.zeros((room + 1, 2 + states + outputs))
        high: cython.double[::1] = self.high
        when: cython.double[::1] = self.when
        rows: cython.double[::1] = self.rows
        self.log.high, self.log.when = cython.address(high[0]), cython.address(when[0])
        self.log.rows, self.log.resumes = cython.address(rows[0]), 0
        self.log.candidates = cython.address(self.candidates[0, 0])
        self.log.count, self.log.room, self.log.width = 0, room, 2 + states + outputs

    @property
    def count(self):
        """Number of samples that may have higher values."""
        return self.log.count

    @count.setter
    def count(self, value):
        self.log.count = value

    @property
    def passed(self):
        """Number of samples before the first of the present acceleration."""
        return self.log.passed

    @passed.setter
    def passed(self, value):
        self.log.passed = value

    @property
    def looks(self):
        """Whether the march has stopped before a sample in which a condition may fail."""
        return self.log.looks != 0


@cython.cclass
class PhaseLoops:
    """The loops over the tables of one phase."""

    def __init__(self, tables, one_sided, h):
        views: list = [tables.step, tables.now, tables.slope, tables.bend, tables.sway, tables.magnitude, one_sided]
        at: cython.const[cython.double][::1]
        places: cython.p_const_double[7]
        k: cython.int
        for k in range(7):
            at = views[k]
            places[k] = cython.address(at[0])
        t: cython.pointer(Tables) = cython.address(self.tables)
        t.n, t.outputs, t.conditions, t.h = tables.n, tables.outputs, tables.conditions, h
        t.step, t.now, t.slope, t.bend, t.sway, t.magnitude, t.one_sided = (
            places[0],
            places[1],
            places[2],
            places[3],
            places[4],
            places[5],
            places[6],
        )
        self.kept, self.states = tuple(views), up8(tables.n)

    def march(self, phase, a, i, last, y, peaks, states):
        """Advance whole samples from i up to `last` as far as nothing happens; the number of the sample reached."""
        log: cython.pointer(Log) = cython.address(peaks.log)
        log.states = cython.address(states[0, 0]) if states.shape[0] > 1 else cython.NULL
        with cython.nogil:
            i = LOOPS.march(
                cython.address(self.tables), phase, cython.address(a[0]), i, last, cython.address(y[0]), log
            )
        return i

    def expand(self, h, a, rise, y, series, away):
        """Expand the motion; the number of terms, 0 if too many, and how far each row may get from its start."""
        width: cython.int = series.shape[1]
        terms: cython.int = LOOPS.expand(
            cython.address(self.tables),
            h,
            a,
            rise,
            cython.address(y[0]),
            series.shape[0],
            width,
            cython.address(series[0, 0]),
        )
        LOOPS.spread(
            self.tables.outputs + self.tables.conditions,
            terms,
            width,
            cython.address(series[0, self.states]),
            cython.address(away[0]),
        )
        return terms

    def evaluate(self, series, terms, t, out):
        """Sum the series of the states at t."""
        LOOPS.evaluate(self.states, terms, series.shape[1], cython.address(series[0, 0]), t, cython.address(out[0]))

    def magnitudes(self, x, out):
        """Multiply the magnitudes of the matrices by those of the states, of the acceleration and of 1."""
        rows: cython.int = self.states + self.tables.outputs + self.tables.conditions
        x0: cython.p_double = cython.address(x[0])
        LOOPS.product(self.tables.n + 2, rows, rows, self.tables.magnitude, x0, cython.address(out[0]))
