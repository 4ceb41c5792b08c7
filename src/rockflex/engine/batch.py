"""Runs of the systems of a stack, each under a record of its own, and how they end. Declarations: `batch.pxd`."""

from math import isfinite

import cython
import numpy as np

from rockflex.engine.failures import check_key
from rockflex.engine.system import acceleration, array
from rockflex.foundation.errors import InputError


@cython.final
@cython.cclass
class Batch:
    """What R runs are shaken by, and from which state; `Run.follow` runs them, and notes here how each has ended.

    Parameters
    ----------
    system : System
    records : sequence of ndarray
        Acceleration of each run; the same one may be given many times.
    scales : sequence of float, optional
        Its factors.
    free : int, or sequence of int
        Samples without excitation after each record.
    settles : bool
        Whether a run ends before that once nothing can happen any more, as in `Run.settle`.
    names : sequence of str
        Names of the events that are counted.
    verticals : sequence of ndarray, optional
        Vertical accelerations, one for each record and as long, or None for none; they have the same factor.
    start : ndarray, optional
        States at time 0, shape (R, n), or (n,) for all runs; zero by default.
    keys : sequence, optional
        Key of the first phase of every run; by default that of the system.
    which : sequence of int, optional
        Which system of the stack each run is of; by default the first.

    Attributes
    ----------
    place : int
        The present run; so many have ended.
    outcomes : ndarray of int, shape (R,)
        How each run has ended: 0 after all samples, 1 at an event without a next phase, 2 because nothing could happen
        any more.
    places : ndarray of int, shape (R,)
        Place of the phase in which each run has ended, in `Run.keys`.
    times : ndarray, shape (R,)
        Times of the ends.
    counts : ndarray, shape (R, names)
        Numbers of events.
    high, when : ndarray, shape (R, m)
        Highest value of every output, and its time.
    states : ndarray, shape (R, n)
        The last ones; of runs that have come to rest, those that they approach.
    """

    def __init__(
        self,
        system,
        records,
        scales=None,
        free=0,
        settles=False,
        names=(),
        verticals=None,
        start=None,
        keys=None,
        which=None,
    ):
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
        self.settles, self.outputs, self.n = settles, len(system.outputs), system.layout.size
        self.free = np.broadcast_to(np.minimum(np.array(free, dtype=float), 2.0**62).astype(np.int64), count)
        start, rows = np.zeros(self.n) if start is None else np.asarray(start, dtype=float), (count, self.n)
        self.starts = np.broadcast_to(array("the state", start, rows if start.ndim > 1 else rows[1:]), rows)
        keys = [system.start] * count if keys is None else list(keys)
        for key in keys:
            check_key(key)
        self.keys = tuple(dict.fromkeys(keys))
        phases = {key: place for place, key in enumerate(self.keys)}
        self.phase = np.array([phases[key] for key in keys], dtype=np.intc)
        self.first = np.zeros(len(self.keys), dtype=np.intc)
        which = np.zeros(count, dtype=np.intc) if which is None else np.array(which, dtype=np.intc)
        if which.shape != (count,) or len(keys) != count:
            raise InputError(f"There are {count} records, but {which.size} systems and {len(keys)} first phases.")
        if not ((which >= 0) & (which < system.count)).all():
            raise InputError(f"There are {system.count} systems in the stack, but number {which.max()} was asked for.")
        self.which = which
        self.numbers = np.zeros((count, 2 + len(self.names)), dtype=np.intc)
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
        return np.asarray(self.numbers)[:, 2:]

    @property
    def places(self):
        """Place of the phase in which each run has ended, in `Run.keys`."""
        return np.asarray(self.numbers)[:, 1]

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

    def close(self, outcome, place, time, h, high, when, y, journal):
        """Note how the present run has ended, and go on to the next one."""
        k: cython.int
        m: cython.int = self.outputs
        r: cython.int = self.place
        self.numbers[r, 0], self.numbers[r, 1], self.values[r, 0] = outcome, place, time
        for k in range(self.kinds.shape[0]):
            self.numbers[r, 2 + k] = journal.count(self.kinds[k])
        for k in range(m):
            self.values[r, 1 + k], self.values[r, 1 + m + k] = high[k], when[k] * h
        for k in range(self.n):
            self.values[r, 1 + 2 * m + k] = y[k]
        self.place += 1
