"""The phases of a model, compiled as they are met, and their tables for a time step."""

from threading import RLock

import numpy as np
from numpy.typing import NDArray

from rockflex.models import Arrow, Key, Phase, Quantities, RockingModel, lost_support_row, rows_of
from rockflex.solve.exact.basis import Basis, basis_of, with_constant
from rockflex.solve.exact.tables import check_step, empty_system, grown, levels_of, put_phase
from rockflex.solve.layout import BESIDE, EVENT, FOLLOWING, FOLLOWS, LINKS, Array, System

MOST_LEVELS = 8  # that there is room for before they are needed
CAPACITY = 3  # phases that there is room for at first: contact, and rocking on either side


class CompiledPhases:
    """All phases of one model that were met so far.

    Threads may run on the same phases: a phase is entered under a lock, at a place that no run knows of before it is
    whole.

    Parameters
    ----------
    model
        The model.
    quantities
        What is asked of the motion.
    """

    def __init__(self, model: RockingModel, quantities: Quantities) -> None:
        self._lock = RLock()
        self._model = model
        self._quantities = quantities
        self._phases: list[Phase] = []
        self._bases: list[Basis | None] = []
        self._rows: list[Array] = []
        self._twins: list[int] = []  # place of a phase whose motion differs by constant forces alone; -1
        self._places: dict[Key, int] = {}
        self._systems: dict[float, tuple[System, int]] = {}  # by time step, with the number of phases entered

    def place(self, key: Key) -> int:
        """Place of a phase in the tables; it is compiled if it was not met before."""
        known = self._places.get(key)
        if known is not None:
            return known
        with self._lock:
            return self._places[key] if key in self._places else self._compiled(key)

    def _compiled(self, key: Key) -> int:
        model = self._model
        phase = model.phase(key)
        rows = np.vstack((phase.guards[0].row, rows_of(model, self._quantities, key), lost_support_row(model, key)))
        basis, twin = None, -1
        if phase.arrow is not None:
            twin = self._alike(phase.arrow)
            known = None if twin < 0 else self._bases[twin]
            if known is None:
                known = basis_of(model, phase.arrow, model.accelerations(key))
            # Every phase takes the constant forces in the same way: the bits must not depend on which was met first.
            basis = with_constant(known, phase.arrow) if phase.arrow.free else known
        self._phases.append(phase)
        self._bases.append(basis)
        self._rows.append(rows)
        self._twins.append(twin)
        self._places[key] = len(self._phases) - 1
        return self._places[key]

    def knows(self, key: Key) -> bool:
        """Whether a phase was met before."""
        return key in self._places

    def meet(self, phase: int, lacking: int) -> None:
        """Compile the phase that a run lacks: `Progress.lacking`, at a place of `beside` or, after those, `follows`.

        Of two that may follow both are compiled: a base that has lifted on one side will mostly lift on the other.
        """
        known = self._phases[phase]
        if lacking < FOLLOWING:
            self.place(self._beside(known, lacking))
            return
        for leads in (known.guards[0].below, known.guards[0].above):
            if leads is not None:
                self.place(leads.key)

    def known_system(self, dt: float) -> System | None:
        """Tables of all phases met so far, for one time step; None where they are not ready."""
        system, entered = self._systems.get(dt, (None, 0))
        return system if entered == len(self._phases) else None

    def system(self, dt: float, fastest: float) -> System:
        """Tables of all phases met so far, for one time step; `fastest` bounds the frequencies that are still to come.

        In rad/s; the tables only grow where the bound was too low.
        """
        with self._lock:
            known = self.known_system(dt)
            return self._entered(dt, fastest) if known is None else known

    def _entered(self, dt: float, fastest: float) -> System:
        system, entered = self._systems.get(dt, (None, 0))
        count = len(self._phases)
        levels = max((levels_of(basis.fastest, dt) for basis in self._bases if basis is not None), default=0)
        dense = any(basis is not None and basis.dense for basis in self._bases)
        rows = self._rows[0].shape[0]
        if system is None:
            levels = max(levels, min(levels_of(fastest, dt), MOST_LEVELS))
            system = empty_system(self._model, rows, dt, max(CAPACITY, count), levels, dense=dense)
        else:
            capacity, had = system.links.shape[0], system.blocks.shape[1] - 1
            if count > capacity or levels > had or dense > (system.propagator.size > 0):
                capacity = capacity if count <= capacity else 2 * count
                larger = empty_system(self._model, rows, dt, capacity, max(levels, had), dense=dense)
                system = grown(system, larger)
        for p in range(entered, count):
            basis = self._bases[p]
            if basis is not None:
                check_step(basis, dt)
            put_phase(system, p, self._phases[p], basis, self._rows[p], self._twins[p])
        # Runs that go on with the tables as they were must not come to a phase that they made no room for.
        system = system._replace(links=self._links(system.links.shape[0]))
        self._systems[dt] = system, count
        return system

    def _alike(self, arrow: Arrow) -> int:
        """Place of a phase whose motion differs by constant forces alone; -1 where there is none."""
        for place, other in enumerate(self._phases):
            if other.arrow is not None and other.arrow.alike(arrow):
                return place
        return -1

    @property
    def dense(self) -> bool:
        """Whether some phase met so far does not uncouple, so that its bounds are computed point by point."""
        return any(basis.dense for basis in self._bases if basis is not None)

    @property
    def fastest(self) -> float:
        """Largest eigenvalue magnitude of the linear phases met so far, rad/s."""
        return max((basis.fastest for basis in self._bases if basis is not None), default=0.0)

    def _links(self, capacity: int) -> NDArray[np.int64]:
        """Return what happens at the limits of every phase, and which phase leads to which, as far as they were met."""
        links = np.full((capacity, LINKS), -1, dtype=np.int64)
        for p, phase in enumerate(self._phases):
            for place in range(3):
                links[p, BESIDE + place] = self._places.get(self._beside(phase, place), -1)
            for bound, leads in enumerate((phase.guards[0].below, phase.guards[0].above)):
                if leads is not None:
                    links[p, EVENT + bound], links[p, FOLLOWS + bound] = leads.event, self._places.get(leads.key, -1)
        return links

    def _beside(self, phase: Phase, place: int) -> Key:
        """The same branches, with the base in contact, on its right pivot or on its left one."""
        return ((0, 1, -1)[place], *phase.key[1:])
