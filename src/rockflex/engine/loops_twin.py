"""The loops of `march.c` in NumPy: slow, easy to follow, and an independent check of the compiled ones."""

import numpy as np

from rockflex._arrays import Array
from rockflex.engine.system import up8
from rockflex.engine.tables import BLOCK, ROWS, Tables


def PyErr_CheckSignals() -> None:  # noqa: N802
    """Do nothing: the interpreter looks at Ctrl-C by itself."""


def unpacked(table: Array, rows: int, columns: int) -> Array:
    """Return the rows of a table that `tables.packed` has packed."""
    return np.concatenate(
        [part.reshape(columns, -1).T for part in np.split(table, range(columns * ROWS, columns * rows, columns * ROWS))]
    )


class Peaks:
    """Highest values of the outputs, the samples at which they were reached, and samples that may have higher ones."""

    def __init__(self, one_sided: Array, states: int, room: int) -> None:
        self.high, self.when = np.where(one_sided > 0.0, -np.inf, 0.0), np.zeros(one_sided.size)
        self.candidates = np.zeros((room + 1, 2 + states + one_sided.size))
        self.count, self.room, self.looks, self.passed = 0, room, False, 0.0


class PhaseLoops:
    """The loops over the tables of one phase."""

    def __init__(self, tables: Tables, one_sided: Array, h: float) -> None:
        self.n, self.states, self.m, self.h = tables.n, up8(tables.n), tables.outputs, h
        rows, columns = self.m + tables.conditions, tables.n + 2
        self.rows = self.states + rows
        self.step = unpacked(tables.step, self.rows, columns + 1)
        self.now, self.magnitude = (unpacked(each, self.rows, columns) for each in (tables.now, tables.magnitude))
        self.slope, self.bend, self.sway = (
            unpacked(each, rows, columns) for each in (tables.slope, tables.bend, tables.sway)
        )
        self.one_sided = one_sided > 0.0

    def march(self, phase: int, a: Array, i: int, last: int, y: Array, peaks: Peaks, states: Array) -> int:
        """Advance whole samples from i up to `last` as far as nothing happens; the number of the sample reached."""
        n, m, x = self.n, self.m, np.array(y)
        old = (self.now @ np.array((*x, a[i], 1.0)))[self.states :]
        bend = sway = np.zeros(old.size)
        peaks.looks, begins = False, True
        self._raise(peaks, old, i)
        while i < last:
            if begins:
                if peaks.count + BLOCK > peaks.room:
                    break
                changes = np.abs(np.diff(a[i : min(i - i % BLOCK + BLOCK, last) + 1]))
                rates = np.abs(self.now[:n] @ np.array((*x, a[i], 1.0)))
                moves = np.array((*rates, changes.sum(), changes.max() / self.h))
                bend, sway = self.bend @ moves, self.sway @ moves
            new = self.step @ np.array((*x, a[i], a[i + 1], 1.0))
            new[:n] += x
            rows = new[self.states :]
            before, after = (self.slope @ np.array((*z, b, 1.0)) for z, b in ((x, a[i]), (new[:n], a[i + 1])))
            turns = np.maximum(4.0 * bend - np.abs(rows - old), 0.0)
            beyond = np.minimum(
                turns**2 / np.maximum(16.0 * bend, 1e-300), np.abs(after - before) * (self.h / 8.0) + sway
            )
            if (np.minimum(old, rows)[m:] <= beyond[m:]).any():
                peaks.looks = True
                break
            above = np.maximum(self._counted(old), self._counted(rows)) + beyond[:m]
            if (above > np.maximum(peaks.high, self._counted(rows))).any():
                peaks.candidates[peaks.count] = (phase, i, *x, *above)
                peaks.count += 1
            x, old, i = new[:n], rows, i + 1
            self._raise(peaks, old, i)
            if len(states) > 1:
                states[i] = x
            begins = i % BLOCK == 0
        y[:] = x
        return i

    def _counted(self, rows: Array) -> Array:
        return np.where(self.one_sided, rows[: self.m], np.abs(rows[: self.m]))

    def _raise(self, peaks: Peaks, rows: Array, sample: int) -> None:
        found = self._counted(rows)
        peaks.when[found > peaks.high] = peaks.passed + sample
        np.maximum(peaks.high, found, out=peaks.high)

    def expand(self, h: float, a: float, rise: float, y: Array, series: Array, away: Array) -> int:
        """Expand the motion; the number of terms, 0 if too many, and how far each row may get from its start."""
        x, most, calm = np.array(y), np.abs(y), 0
        for k in range(len(series)):
            z = self.now @ np.array((*x, (a, rise)[k] if k < 2 else 0.0, k == 0))
            series[k, : self.n], series[k, self.states : self.rows] = x, z[self.states :]
            x = z[: self.n] * (h / (k + 1))
            most = np.maximum(most, np.abs(x))
            calm = calm + 1 if k > 1 and (np.abs(x) <= 1e-17 * most).all() else 0
            if calm == 2:
                away[: self.rows - self.states] = np.abs(series[1 : k + 1, self.states : self.rows]).sum(axis=0)
                return k + 1
        return 0

    def evaluate(self, series: Array, terms: int, t: float, out: Array) -> None:
        """Sum the series of the states at t."""
        out[: self.n] = np.polynomial.polynomial.polyval(t, series[:terms, : self.n])

    def magnitudes(self, x: Array, out: Array) -> None:
        """Multiply the magnitudes of the matrices by those of the states, of the acceleration and of 1."""
        out[: self.rows] = self.magnitude @ x[: self.n + 2]
