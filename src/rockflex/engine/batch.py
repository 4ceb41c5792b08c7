"""Runs from one state, each under a record of its own, and what has become of them. Declarations: `batch.pxd`."""

from math import isfinite

import cython
import numpy as np

from rockflex._errors import InputError
from rockflex.engine.system import acceleration


@cython.final
@cython.cclass
class Batch:
    """What R runs of a system are shaken by; `Run.follow` runs them, and notes here how each has ended.

    Parameters
    ----------
    system : System
    records : sequence of ndarray
        Acceleration of each run; the same one may be given many times.
    scales : sequence of float, optional
        Its factors.
    free : int
        Samples without excitation after each record.
    settles : bool
        Whether a run ends before that once nothing can happen any more, as in `Run.settle`.
    names : sequence of str
        Names of the events that are counted.
    verticals : sequence of ndarray, optional
        Vertical accelerations, one for each record and as long, or None for none; they have the same factor.

    Attributes
    ----------
    place : int
        The present run; so many have ended.
    outcomes : ndarray of int, shape (R,)
        How each run has ended: 0 after all samples, 1 at an event without a next phase, 2 because nothing could happen
        any more.
    times : ndarray, shape (R,)
        Times of the ends.
    counts : ndarray, shape (R, names)
        Numbers of events.
    high, when : ndarray, shape (R, m)
        Highest value of every output, and its time.
    states : ndarray, shape (R, n)
        The last ones.
    """

    def __init__(self, system, records, scales=None, free=0, settles=False, names=(), verticals=None):
        count, places, distinct, first = len(records), {}, [], 0
        verticals = [None] * count if verticals is None else list(verticals)
        if len(verticals) != count:
            raise InputError(f"There are {count} records, but {len(verticals)} vertical accelerations.")
        for each in (*records, *verticals):
            if each is not None and id(each) not in places:
                distinct.append(acceleration(each))
                places[id(each)] = first, first + distinct[-1].size, float(np.abs(distinct[-1]).max())
                first += distinct[-1].size
        scales = np.ones(count) if scales is None else np.array(scales, dtype=float)
        if scales.shape != (count,):
            raise InputError(f"There are {count} records, but scales of shape {scales.shape}.")
        places[id(None)] = 0, 0, 0.0
        for each, other in zip(records, verticals, strict=True):
            if other is not None and len(each) != len(other):
                raise InputError(f"A vertical acceleration has {len(other)} samples, and its record {len(each)}.")
        for scale, each, other in zip(scales.tolist(), records, verticals, strict=True):
            if not isfinite(scale * max(places[id(each)][2], places[id(other)][2])):
                raise InputError(f"An acceleration times its scale must be finite, but the scale is {scale}.")
        self.count, self.place, self.names, self.scales = count, 0, tuple(names), scales
        self.samples = np.concatenate([np.zeros(1), *distinct])[1:]
        pairs = zip(records, verticals, strict=True)
        bounds = [(*places[id(each)][:2], *places[id(other)][:2]) for each, other in pairs]
        self.bounds = np.array(bounds, dtype=np.intp).reshape(-1, 4)
        self.record, self.rise = np.zeros((2, max([each.size for each in distinct], default=0)))
        self.free, self.settles, self.outputs, self.n = (
            min(free, 2**62),
            settles,
            len(system.outputs),
            system.layout.size,
        )
        self.numbers = np.zeros((count, 1 + len(self.names)), dtype=np.intc)
        self.values = np.zeros((count, 1 + 2 * self.outputs + self.n))
        self.kinds = np.zeros(len(self.names), dtype=np.intc)

    @property
    def outcomes(self):
        """How each run has ended: 0 after all samples, 1 at an event without a next phase, 2 at rest."""
        return np.asarray(self.numbers)[:, 0]

    @property
    def times(self):
        """Times of the ends."""
        return np.asarray(self.values)[:, 0]

    @property
    def counts(self):
        """How often the events of each name have happened."""
        return np.asarray(self.numbers)[:, 1:]

    @property
    def high(self):
        """Highest value of every output."""
        return np.asarray(self.values)[:, 1 : 1 + self.outputs]

    @property
    def when(self):
        """Its time."""
        return np.asarray(self.values)[:, 1 + self.outputs : 1 + 2 * self.outputs]

    @property
    def states(self):
        """The last states."""
        return np.asarray(self.values)[:, 1 + 2 * self.outputs :]

    def scaled(self):
        """The acceleration of the present run."""
        i: cython.Py_ssize_t
        first: cython.Py_ssize_t = self.bounds[self.place, 0]
        size: cython.Py_ssize_t = self.bounds[self.place, 1] - first
        for i in range(size):
            self.record[i] = self.samples[first + i] * self.scales[self.place]
        return self.record[:size]

    def scaled_vertical(self):
        """Its vertical acceleration, empty if there is none."""
        i: cython.Py_ssize_t
        first: cython.Py_ssize_t = self.bounds[self.place, 2]
        size: cython.Py_ssize_t = self.bounds[self.place, 3] - first
        for i in range(size):
            self.rise[i] = self.samples[first + i] * self.scales[self.place]
        return self.rise[:size]

    def close(self, outcome, time, h, high, when, y, journal):
        """Note how the present run has ended, and go on to the next one."""
        k: cython.int
        m: cython.int = self.outputs
        r: cython.int = self.place
        self.numbers[r, 0], self.values[r, 0] = outcome, time
        for k in range(self.kinds.shape[0]):
            self.numbers[r, 1 + k] = journal.count(self.kinds[k])
        for k in range(m):
            self.values[r, 1 + k], self.values[r, 1 + m + k] = high[k], when[k] * h
        for k in range(self.n):
            self.values[r, 1 + 2 * m + k] = y[k]
        self.place += 1
