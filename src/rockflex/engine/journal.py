"""What a run has met: its events, and the states of its history. Declarations: `journal.pxd`."""

import cython
import numpy as np


@cython.final
@cython.cclass
class Journal:
    """Events and states of a run, in arrays that grow."""

    def __init__(self, n):
        self.n = n
        self.times, self.exits = np.zeros(64), np.zeros((64, 2), dtype=np.intc)
        self.rows, self.places = np.zeros((0, 2 + n)), np.zeros(0, dtype=np.intc)
        self.often = np.zeros(16, dtype=np.intc)
        self.begin()

    def begin(self):
        """Begin anew."""
        self.n_events = self.n_nodes = 0
        self.often[:] = 0

    def wants(self, a):
        """Whether the history does not yet end at an acceleration."""
        return self.n_nodes == 0 or self.rows[self.n_nodes - 1, 1] != a

    def keep(self, sample, a, y, place):
        """Add a state to the history."""
        k: cython.int
        if self.n_nodes == self.rows.shape[0]:
            with cython.gil:
                more = 512 + self.n_nodes
                self.rows = np.concatenate((self.rows, np.zeros((more, 2 + self.n))))
                self.places = np.concatenate((self.places, np.zeros(more, dtype=np.intc)))
        self.rows[self.n_nodes, 0], self.rows[self.n_nodes, 1] = sample, a
        for k in range(self.n):
            self.rows[self.n_nodes, 2 + k] = y[k]
        self.places[self.n_nodes] = place
        self.n_nodes += 1
        return 0

    def happen(self, time, place, event, kind):
        """Add an event of a kind."""
        if self.n_events == self.times.shape[0]:
            with cython.gil:
                self.times = np.concatenate((self.times, np.zeros(self.n_events)))
                self.exits = np.concatenate((self.exits, np.zeros((self.n_events, 2), dtype=np.intc)))
        if kind >= self.often.shape[0]:
            with cython.gil:
                self.often = np.concatenate((self.often, np.zeros(kind, dtype=np.intc)))
        self.often[kind] += 1
        self.times[self.n_events] = time
        self.exits[self.n_events, 0], self.exits[self.n_events, 1] = place, event
        self.n_events += 1
        return 0

    @property
    def events(self):
        """Times of the events, places of the phases that they ended, and their numbers there."""
        places, numbers = np.array(self.exits[: self.n_events]).T.tolist()
        return np.array(self.times[: self.n_events]).tolist(), places, numbers

    def count(self, kind):
        """How often events of a kind have happened."""
        return self.often[kind] if kind < self.often.shape[0] else 0

    @property
    def nodes(self):
        """Samples, places of phases, accelerations and states of the history."""
        rows = np.array(self.rows[: self.n_nodes])
        return rows[:, 0], np.array(self.places[: self.n_nodes]), rows[:, 1], rows[:, 2:]
