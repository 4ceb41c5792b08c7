"""The phases of a model, compiled as they are met, and their tables for a time step."""

import numpy as np

from rockflex.models import Key, Phase, Quantities, RockingModel, lost_support_row, rows_of
from rockflex.solve.exact.basis import Basis, basis_of, with_constant
from rockflex.solve.exact.closed_form import accelerations_in
from rockflex.solve.exact.tables import check_step, empty_system, grown, levels_of, put_phase
from rockflex.solve.layout import BESIDE, FOLLOWS, Array, System

__all__ = ["CompiledPhases"]

CAPACITY = 3  # phases that there is room for at first: contact, and rocking on either side


class CompiledPhases:
    """All phases of one model that were met so far.

    Parameters
    ----------
    model
        The model.
    quantities
        What is asked of the motion.
    """

    def __init__(self, model: RockingModel, quantities: Quantities) -> None:
        self._model = model
        self._quantities = quantities
        self._phases: list[Phase] = []
        self._bases: list[Basis | None] = []
        self._rows: list[Array] = []
        self._places: dict[Key, int] = {}
        self._systems: dict[float, tuple[System, int]] = {}  # by time step, with the number of phases entered

    def place(self, key: Key) -> int:
        """Place of a phase in the tables; it is compiled if it was not met before."""
        known = self._places.get(key)
        if known is not None:
            return known
        model = self._model
        phase = model.phase(key)
        rows = np.vstack((phase.guards[0].row, rows_of(model, self._quantities, key), lost_support_row(model, key)))
        basis = None
        if phase.arrow is not None:
            accelerations = accelerations_in(model, key)
            alike = (
                basis
                for other, basis in zip(self._phases, self._bases, strict=True)
                if basis is not None and other.arrow is not None and other.arrow.alike(phase.arrow)
            )
            twin = next(alike, None)
            basis = with_constant(twin, accelerations) if twin else basis_of(model, phase.arrow, accelerations)
        self._phases.append(phase)
        self._bases.append(basis)
        self._rows.append(rows)
        self._places[key] = len(self._phases) - 1
        return self._places[key]

    def meet(self, phase: int, lacking: int) -> None:
        """Compile the phase that a run lacks: `Progress.lacking`, at a place of `beside` or, after those, `follows`."""
        known = self._phases[phase]
        if lacking < 3:
            self.place(self._beside(known, lacking))
            return
        guard = known.guards[0]
        leads = (guard.below, guard.above)[lacking - 3]
        if leads is not None:
            self.place(leads.key)

    def system(self, dt: float) -> System:
        """Tables of all phases met so far, for one time step."""
        system, entered = self._systems.get(dt, (None, 0))
        count = len(self._phases)
        if system is not None and entered == count:
            return system
        levels = max((levels_of(basis.fastest, dt) for basis in self._bases if basis is not None), default=0)
        dense = any(basis is not None and basis.dense for basis in self._bases)
        rows = self._rows[0].shape[0]
        if system is None:
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
            put_phase(system, p, self._phases[p], basis, self._rows[p], dt)
        self._link(system)
        self._systems[dt] = system, count
        return system

    @property
    def dense(self) -> bool:
        """Whether some phase met so far does not uncouple, so that its bounds are computed point by point."""
        return any(basis is not None and basis.dense for basis in self._bases)

    def _link(self, system: System) -> None:
        """Enter which phase leads to which, as far as they were met."""
        for p, phase in enumerate(self._phases):
            for place in range(3):
                system.links[p, BESIDE + place] = self._places.get(self._beside(phase, place), -1)
            for bound, leads in enumerate((phase.guards[0].below, phase.guards[0].above)):
                system.links[p, FOLLOWS + bound] = -1 if leads is None else self._places.get(leads.key, -1)

    def _beside(self, phase: Phase, place: int) -> Key:
        """The same branches, with the base in contact, on its right pivot or on its left one."""
        return ((0, 1, -1)[place], *phase.key[1:])
