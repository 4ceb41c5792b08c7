"""What a run has met: its events, and the states of its history. Declarations: `journal.pxd`."""

import cython
import numpy as np


@cython.final
@cython.cclass
class Journal:
    """Events and states of a run, in arrays that grow."""

    def __init__(self, n):
        self.n = n
        self.clear()
        self.often, self.names = np.zeros(16, dtype=np.intc), {}
        self.kinds = self.notes = np.zeros((0, 0), dtype=np.intc)
        self.begin()

    def kind(self, name):
        """The number of a name of events."""
        return self.names.setdefault(name, len(self.names))

    def register_phase(self, place, events):
        """Take note of the events of a phase."""
        rows, columns = np.shape(self.kinds)
        if place >= rows or len(events) > columns:
            kinds = np.zeros((2, 2 * place + 4, max(len(events), columns, 4)), dtype=np.intc)
            kinds[0, :rows, :columns], kinds[1, :rows, :columns] = self.kinds, self.notes
            self.kinds, self.notes = kinds
        number: cython.int
        for number, event in enumerate(events):
            self.kinds[place, number], self.notes[place, number] = self.kind(event.name), self.kind(event.noted)

    def begin(self):
        """Begin anew."""
        self.n_events = self.n_nodes = 0
        self.often[:] = 0

    def size(self):
        """Memory of events and history, bytes."""
        return (8 * (3 + self.n) + 4) * self.rows.shape[0] + 20 * self.times.shape[0]

    def clear(self):
        """Forget all, and give back the room."""
        self.n_events = self.n_nodes = 0
        self.times, self.exits = np.zeros(64), np.zeros((64, 3), dtype=np.intc)
        self.rows, self.places = np.zeros((0, 3 + self.n)), np.zeros(0, dtype=np.intc)

    def wants(self, a, v):
        """Whether the history does not yet end at an acceleration."""
        last: cython.Py_ssize_t = self.n_nodes - 1
        return last < 0 or self.rows[last, 1] != a or self.rows[last, 2] != v

    def keep(self, sample, a, v, y, place):
        """Add a state to the history."""
        k: cython.int
        if self.n_nodes == self.rows.shape[0]:
            with cython.gil:
                more = 512 + self.n_nodes
                self.rows = np.concatenate((self.rows, np.zeros((more, 3 + self.n))))
                self.places = np.concatenate((self.places, np.zeros(more, dtype=np.intc)))
        self.rows[self.n_nodes, 0], self.rows[self.n_nodes, 1], self.rows[self.n_nodes, 2] = sample, a, v
        for k in range(self.n):
            self.rows[self.n_nodes, 3 + k] = y[k]
        self.places[self.n_nodes] = place
        self.n_nodes += 1
        return 0

    def happen(self, time, place, event):
        """Add an event of a phase."""
        kind: cython.int = self.kinds[place, event]
        if self.n_events == self.times.shape[0]:
            with cython.gil:
                self.times = np.concatenate((self.times, np.zeros(self.n_events)))
                self.exits = np.concatenate((self.exits, np.zeros((self.n_events, 3), dtype=np.intc)))
        self.tally(kind)
        self.times[self.n_events] = time
        self.exits[self.n_events, 0], self.exits[self.n_events, 1] = place, event
        self.exits[self.n_events, 2] = self.n_nodes
        self.n_events += 1
        return 0

    def note(self, place, event):
        """Count an event of a phase under its second name, too."""
        self.tally(self.notes[place, event])
        return 0

    def tally(self, kind):
        """Count an event of a kind."""
        if kind >= self.often.shape[0]:
            with cython.gil:
                self.often = np.concatenate((self.often, np.zeros(kind, dtype=np.intc)))
        self.often[kind] += 1
        return 0

    @property
    def events(self):
        """Times of the events, places of the phases that they ended, and their names."""
        places, numbers, _ = self.turns.T
        names, kinds = list(self.names), np.asarray(self.kinds)[places, numbers]
        return np.array(self.times[: self.n_events]).tolist(), places.tolist(), [names[kind] for kind in kinds.tolist()]

    @property
    def turns(self):
        """Of every event the place of the phase that it ended, its number there, and that of the state after it."""
        return np.array(self.exits[: self.n_events])

    def count(self, kind):
        """How often events of a kind have happened."""
        return self.often[kind] if kind < self.often.shape[0] else 0

    @property
    def nodes(self):
        """Samples, places of phases, accelerations, states, and vertical accelerations of the history."""
        rows = np.array(self.rows[: self.n_nodes])
        return rows[:, 0], np.array(self.places[: self.n_nodes]), rows[:, 1], rows[:, 3:], rows[:, 2]
