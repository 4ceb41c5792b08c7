"""The phases of a model, compiled as they are needed, and their tables for a time step."""

from collections.abc import Iterator
from functools import cached_property
from threading import RLock

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex.models import (
    Arrow,
    Key,
    Phase,
    Quantities,
    RockingModel,
    lost_support_row,
    rows_of,
    turning_row,
    under_more_gravity,
)
from rockflex.solve.exact.basis import Basis, Drift, basis_of, drift_of, with_constant
from rockflex.solve.exact.entries import grown
from rockflex.solve.exact.tables import check_step, empty_system, levels_of, put_heavier, put_phase, size_of
from rockflex.solve.layout import BESIDE, CHANGED, EVENT, FEWEST_TERMS, FOLLOWING, FOLLOWS, TURNED, TURNING, System

MOST_LEVELS = 8  # largest number of levels allocated in advance
CAPACITY = 3  # initial number of phases: contact, and rocking on either side


class CompiledPhases:
    """All phases of one model that were needed so far.

    Threads may share the phases: a phase is entered under a lock, at an index that no run uses before the entry is
    complete.

    Parameters
    ----------
    model
        The model.
    quantities
        Quantities whose peaks are computed.
    extremes
        Quantities of which only the largest value matters.
    """

    def __init__(self, model: RockingModel, quantities: Quantities, extremes: Quantities) -> None:
        self.terms = FEWEST_TERMS  # of the power series of all phases, over every time step
        self._lock = RLock()
        self._model = model
        self._quantities = quantities
        self._extremes = extremes
        self._phases: list[Phase] = []
        self._bases: list[Basis | Drift | None] = []
        self._rows: list[Array] = []
        self._twins: list[int] = []  # index of a phase that differs only in constant forces; -1
        self._places: dict[Key, int] = {}
        self._likes: dict[bytes, int] = {}  # the first phase with the eigenvectors of an arrow
        self._leading: dict[Key, list[tuple[int, int]]] = {}  # the places in the links from which a phase follows
        self._linked = np.zeros((0, 0), dtype=np.int64), 0  # the last links, and how many phases they know
        # By time step, and whether the ground moves vertically; with the number of phases entered.
        self._systems: dict[tuple[float, bool], tuple[System, int]] = {}

    def at(self, _dt: float, _fastest: float, *, shaken: bool) -> "CompiledPhases":
        """Return the phases for a time step: these."""
        del shaken
        return self

    def place(self, key: Key) -> int:
        """Return the index of a phase in the tables; it is compiled if necessary."""
        known = self._places.get(key)
        if known is not None:
            return known
        with self._lock:
            return self._places[key] if key in self._places else self._compiled(key)

    def _compiled(self, key: Key) -> int:
        model = self._model
        phase = model.phase(key)
        rows = self._rows_of(model, phase)
        basis, twin = None, -1
        if phase.arrow is not None and phase.arrow.drifts:
            basis = drift_of(model, phase.arrow, model.accelerations(key))
        elif phase.arrow is not None:
            twin = self._alike(phase.arrow)
            known = None if twin < 0 else self._bases[twin]
            if not isinstance(known, Basis):
                known = basis_of(model, phase.arrow, model.accelerations(key))
            # All phases include constant forces in the same way, so that the order of compilation does not affect bits.
            basis = with_constant(known, phase.arrow)
        self._phases.append(phase)
        self._bases.append(basis)
        self._rows.append(rows)
        self._twins.append(twin)
        self._places[key] = len(self._phases) - 1
        if phase.arrow is not None:
            self._likes.setdefault(phase.arrow.likeness, self._places[key])
        return self._places[key]

    def _rows_of(self, model: RockingModel, phase: Phase) -> Array:
        """Return all rows of a phase; the missing fences are zero."""
        key = phase.key
        parts = [phase.guard.row, rows_of(model, self._quantities, key)]
        if model.turning:
            parts.append(turning_row(model))
        parts += [rows_of(model, self._extremes, key), lost_support_row(model, key)]
        parts += [fence.row for fence in phase.fences]
        parts.append(np.zeros((model.most_fences - len(phase.fences), model.layout.columns)))
        return np.vstack(parts)

    def knows(self, key: Key) -> bool:
        """Return whether a phase is already compiled."""
        return key in self._places

    def meet(self, phase: int, lacking: int) -> None:
        """Compile the phase that a run needs, given by `Progress.lacking`: an offset from `BESIDE` or `FOLLOWS`.

        If two phases can follow, both are compiled: a base that lifts on one side usually lifts on the other.
        """
        known = self._phases[phase]
        if lacking < FOLLOWING:
            self.place(known.beside[lacking])
            return
        if lacking >= TURNING:
            self.place(known.turned if lacking == TURNING else self._beyond(known, lacking - TURNING - 1))
            return
        for leads in (known.guard.below, known.guard.above):
            if leads is not None:
                self.place(leads.key)

    def _beyond(self, phase: Phase, place: int) -> Key:
        """Return the phase after a change of an element or, counted on from there, beyond a fence."""
        changes = self._model.most_changes
        return phase.changes[place].key if place < changes else phase.fences[place - changes].key

    def known_system(self, dt: float, *, shaken: bool = False) -> System | None:
        """Return the tables of all phases compiled so far, for one time step; None if they are not ready.

        `shaken` means that the ground moves vertically as well.
        """
        system, entered = self._systems.get((dt, shaken), (None, 0))
        return system if entered == len(self._phases) else None

    def system(self, dt: float, fastest: float, *, shaken: bool = False) -> System:
        """Return the tables of all phases compiled so far, for one time step.

        `fastest` is a bound for the frequencies of later phases in rad/s; if it is too low, the tables are enlarged.
        """
        with self._lock:
            known = self.known_system(dt, shaken=shaken)
            return self._entered(dt, fastest, shaken) if known is None else known

    def _entered(self, dt: float, fastest: float, shaken: bool) -> System:
        system, entered = self._systems.get((dt, shaken), (None, 0))
        count = len(self._phases)
        levels = max((levels_of(basis.fastest, dt) for basis in self._bases if basis is not None), default=0)
        dense = self.dense
        rows = self._rows[0].shape[0]
        if system is None:
            levels = max(levels, min(levels_of(fastest, dt), MOST_LEVELS))
            system = empty_system(self._model, rows, dt, max(CAPACITY, count), levels, dense=dense, shaken=shaken)
        else:
            capacity, had = system.links.shape[0], system.blocks.shape[1] - 1
            if count > capacity or levels > had or dense > (system.propagator.size > 0):
                capacity = capacity if count <= capacity else 2 * count
                larger = empty_system(self._model, rows, dt, capacity, max(levels, had), dense=dense, shaken=shaken)
                system = grown(system, larger)
        for p in range(entered, count):
            basis = self._bases[p]
            if isinstance(basis, Basis):
                check_step(basis, dt)
            put_phase(system, p, self._phases[p], basis, self._rows[p], self._twins[p])
            if shaken:
                heavier = self._heavier.phase(self._phases[p].key)
                put_heavier(system, p, self._phases[p], heavier, self._rows_of(self._heavier, heavier))
        # Runs that continue with the previous tables must not reach a phase for which they have no room.
        system = system._replace(links=self._links(system.links.shape[0]))
        self.terms = max(self.terms, int(system.phases["terms"].max()))
        self._systems[dt, shaken] = system, count
        return system

    def _alike(self, arrow: Arrow) -> int:
        """Return the index of a phase that differs only in constant forces; -1 if there is none."""
        return self._likes.get(arrow.likeness, -1)

    @cached_property
    def _heavier(self) -> RockingModel:
        """The model under a gravity that is greater by 1 m/s²; all forces are linear in gravity."""
        return under_more_gravity(self._model)

    @property
    def dense(self) -> bool:
        """Whether some phase so far cannot be uncoupled, so that its bounds are computed point by point."""
        return any(basis.dense for basis in self._bases if isinstance(basis, Basis))

    @property
    def size(self) -> int:
        """Memory of all tables so far in bytes."""
        return sum(size_of(system) for system, _ in self._systems.values())

    @property
    def fastest(self) -> float:
        """Largest eigenvalue magnitude of the linear phases so far, rad/s."""
        return max((basis.fastest for basis in self._bases if basis is not None), default=0.0)

    def _links(self, capacity: int) -> NDArray[np.int64]:
        """Return the events at the limits of every phase, and the phases that follow, as far as they are compiled.

        The array is a new one, because runs keep using those that they were given.
        """
        model, (known, count) = self._model, self._linked
        links = np.full((capacity, CHANGED + model.most_changes + model.most_fences), -1, dtype=np.int64)
        if count:
            links[:count] = known[:count]
        for p in range(count, len(self._phases)):
            for column, key in _following(self._phases[p], model.most_changes):
                self._leading.setdefault(key, []).append((p, column))
                links[p, column] = self._places.get(key, -1)
            for bound, leads in enumerate((self._phases[p].guard.below, self._phases[p].guard.above)):
                if leads is not None:
                    links[p, EVENT + bound] = leads.event
        for p in range(count, len(self._phases)):
            for place, column in self._leading.get(self._phases[p].key, ()):
                links[place, column] = p
        self._linked = links, len(self._phases)
        return links


def _following(phase: Phase, changes: int) -> Iterator[tuple[int, Key]]:
    """Yield the phases that may follow one, with their columns in the links."""
    for place in range(3):
        yield BESIDE + place, phase.beside[place]
    for bound, leads in enumerate((phase.guard.below, phase.guard.above)):
        if leads is not None:
            yield FOLLOWS + bound, leads.key
    yield TURNED, phase.turned
    for x, change in enumerate(phase.changes):
        yield CHANGED + x, change.key
    for e, fence in enumerate(phase.fences):
        yield CHANGED + changes + e, fence.key
