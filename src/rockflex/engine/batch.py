"""Runs from one state, each under a record of its own, and what has become of them. Declarations: `batch.pxd`."""

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

    Attributes
    ----------
    place : int
        The present run; so many have ended.
    ended, rested : ndarray, shape (R,)
        Whether an event without a next phase has happened, and whether nothing could happen any more.
    times : ndarray, shape (R,)
        Times of the ends.
    counts : ndarray, shape (R, names)
        Numbers of events.
    high, when : ndarray, shape (R, m)
        Highest value of every output, and its time.
    states : ndarray, shape (R, n)
        The last ones.
    """

    def __init__(self, system, records, scales=None, free=0, settles=False, names=()):
        places, distinct, first = {}, [], 0
        for each in records:
            if id(each) not in places:
                distinct.append(acceleration(each))
                places[id(each)] = first, first + distinct[-1].size, np.abs(distinct[-1]).max()
                first += distinct[-1].size
        scales = np.ones(len(records)) if scales is None else np.array(scales, dtype=float)
        if scales.shape != (len(records),):
            raise InputError(f"There are {len(records)} records, but scales of shape {scales.shape}.")
        for each, scale in zip(records, scales, strict=True):
            if not np.isfinite(scale * places[id(each)][2]):
                raise InputError(f"An acceleration times its scale must be finite, but the scale is {scale}.")
        self.count, self.place, self.names = len(records), 0, tuple(names)
        self.samples, self.scales = np.concatenate([np.zeros(1), *distinct])[1:], scales
        self.bounds = np.array([places[id(each)][:2] for each in records], dtype=np.intp).reshape(-1, 2)
        self.record = np.zeros(max((each.size for each in distinct), default=0))
        self.free, self.settles, self.outputs, self.n = (
            min(free, 2**62),
            settles,
            len(system.outputs),
            system.layout.size,
        )
        self.ended_, self.rested_ = np.zeros((2, self.count), dtype=np.uint8)
        self.times_, self.counts_ = np.zeros(self.count), np.zeros((self.count, len(self.names)), dtype=np.intc)
        self.high_, self.when_ = np.zeros((2, self.count, self.outputs))
        self.states_, self.kinds = np.zeros((self.count, self.n)), np.zeros(len(self.names), dtype=np.intc)

    @property
    def ended(self):
        """Whether each run has met an event without a next phase."""
        return np.asarray(self.ended_) > 0

    @property
    def rested(self):
        """Whether nothing could happen any more at its end."""
        return np.asarray(self.rested_) > 0

    @property
    def times(self):
        """Its time."""
        return np.asarray(self.times_)

    @property
    def counts(self):
        """How often the events of each name have happened."""
        return np.asarray(self.counts_)

    @property
    def high(self):
        """Highest value of every output."""
        return np.asarray(self.high_)

    @property
    def when(self):
        """Its time."""
        return np.asarray(self.when_)

    @property
    def states(self):
        """The last states."""
        return np.asarray(self.states_)

    def scaled(self):
        """The acceleration of the present run."""
        i: cython.Py_ssize_t
        first: cython.Py_ssize_t = self.bounds[self.place, 0]
        size: cython.Py_ssize_t = self.bounds[self.place, 1] - first
        for i in range(size):
            self.record[i] = self.samples[first + i] * self.scales[self.place]
        return self.record[:size]

    def close(self, rested, time, h, high, when, y):
        """Note how the present run has ended, but for its events, and go on to the next one."""
        k: cython.int
        r: cython.int = self.place
        self.rested_[r], self.times_[r] = rested, time
        for k in range(self.outputs):
            self.high_[r, k], self.when_[r, k] = high[k], when[k] * h
        for k in range(self.n):
            self.states_[r, k] = y[k]
        self.place += 1
