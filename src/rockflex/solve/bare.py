"""The phases of a base that only rocks, without elements, prepared by one kernel."""

from functools import cached_property
from threading import RLock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._kernel import Entry
from rockflex.models import (
    CLOSED,
    LANDS,
    LEFT,
    LIFTS,
    OVERTURNS,
    RIGHT,
    Key,
    LinearModel,
    Quantities,
    RockingModel,
    StateLayout,
)
from rockflex.solve.exact.bare import Bare, enter_bare
from rockflex.solve.exact.entries import Tables, modes_of, tables_of
from rockflex.solve.exact.tables import LONGEST_FALL, empty_system, levels_of, size_of
from rockflex.solve.exact.uncoupled import Pairs, pairs_of
from rockflex.solve.layout import BESIDE, CHANGED, EVENT, FEWEST_TERMS, FOLLOWS, TURNED, System
from rockflex.solve.phases import MOST_LEVELS, CompiledPhases

# The tables that the kernel fills; the others have no entries, or are the same for all structures.
FILLED = tuple(name for name in Tables._fields if name not in ("dt", "modes"))
SIDES = (CLOSED, RIGHT, LEFT)  # of the phases, in their order
SMALL, LARGE = 1e-30, 1e30  # of numbers in SI units that certainly do not overflow
SIZES = 128  # kinds of empty tables kept
ALIGNED = 64  # bytes, of a line of the cache
SPARE = 4  # sets of work arrays kept for each number of modes

_enter = Entry(enter_bare)
_empty: dict[tuple[StateLayout, int, int], "Blank"] = {}
_spare: dict[int, list["Scratch"]] = {}


def is_bare(model: RockingModel) -> bool:
    """Return whether a model has three phases that differ only in numbers from those of other structures.

    Extreme numbers are left to the general phases, which say what overflows.
    """
    p = model.properties
    if type(model) is not LinearModel or not model.lifts or p.elements or p.n_modes == 0 or model.gravity != GRAVITY:
        return False
    numbers = (float(p.omega[0]), float(p.omega[-1]), p.i_theta, p.l0r, p.m_tot, p.half_width)
    return min(numbers) > SMALL and max(numbers) < LARGE


class Scratch:
    """Work arrays for the phases of a structure with N modes."""

    def __init__(self, modes: int) -> None:
        size = 2 * modes + 2
        order = [*range(modes), 2 * modes, *range(modes, 2 * modes), 2 * modes + 1]  # positions, then speeds
        self.pairs: Pairs = pairs_of(size, np.empty(size), np.array(order, dtype=np.int64))
        self.accelerations: Array = np.empty((modes + 1, size + 2))
        self.steady: Array = np.empty((3, size))


class Blank:
    """Tables without entries, which are the same for all structures with as many modes, rows and levels.

    Those that the kernel fills are parts of one array, which is faster to copy than each by itself.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self._places = list[tuple[str, tuple[int, ...], np.dtype[Any], int]]()
        size = 0
        for name in FILLED:
            table: NDArray[Any] = getattr(system, name)
            self._places.append((name, table.shape, table.dtype, size))
            size += -(-table.nbytes // ALIGNED) * ALIGNED
        self._content = np.zeros(size, dtype=np.uint8)
        for name, table in self._parts(self._content).items():
            table[...] = getattr(system, name)

    def copied(self, dt: float, modes: Array) -> System:
        """Return tables to be filled; arrays without entries and those that the kernel leaves alone are shared."""
        return self.system._replace(dt=dt, modes=modes, **self._parts(self._content.copy()))

    def _parts(self, content: NDArray[np.uint8]) -> dict[str, NDArray[Any]]:
        return {name: np.ndarray(shape, kind, content, place) for name, shape, kind, place in self._places}


class BarePhases:
    """The phases of a model for which `is_bare` is true, with the methods of `CompiledPhases`.

    Contact and rocking about both pivots are entered together. What the kernel leaves alone is left to
    `CompiledPhases`: steps under which a phase cannot be uncoupled or overflows, and vertical motion of the ground.

    Parameters
    ----------
    model
        The model.
    quantities
        Quantities whose peaks are computed.
    """

    def __init__(self, model: RockingModel, quantities: Quantities) -> None:
        self._model = model
        self._quantities = quantities
        self._lock = RLock()
        self._systems: dict[float, System | None] = {}
        self.terms = FEWEST_TERMS

    @property
    def dense(self) -> bool:
        """Whether some phase so far cannot be uncoupled."""
        return "others" in vars(self) and self.others.dense

    @property
    def fastest(self) -> float:
        """Largest eigenvalue magnitude of the phases that were compiled one by one, rad/s."""
        return self.others.fastest

    @property
    def size(self) -> int:
        """Memory of all tables so far in bytes."""
        others = self.others.size if "others" in vars(self) else 0
        return others + sum(size_of(system) for system in self._systems.values() if system is not None)

    def at(self, dt: float, fastest: float, *, shaken: bool) -> "BarePhases | CompiledPhases":
        """Return the phases for a time step: these, if they can be entered together."""
        if shaken:
            return self.others
        if dt not in self._systems:
            with self._lock:
                if dt not in self._systems:
                    self._systems[dt] = self._entered(dt, fastest)
        return self.others if self._systems[dt] is None else self

    @cached_property
    def others(self) -> CompiledPhases:
        """The phases one by one, for what the kernel leaves alone."""
        return CompiledPhases(self._model, self._quantities, Quantities.none(self._model.layout.modes))

    def _empty(self, rows: int, levels: int) -> Blank:
        key = (self._model.layout, rows, levels)
        if key not in _empty:
            if len(_empty) >= SIZES:
                _empty.clear()
            system = empty_system(self._model, rows, 0.0, len(SIDES), levels, dense=False, shaken=False)
            system.links[...] = _links()
            _empty[key] = Blank(system)
        return _empty[key]

    def knows(self, key: Key) -> bool:
        """Return whether a phase is already compiled: all are."""
        return key[0] in SIDES

    def place(self, key: Key) -> int:
        """Return the index of a phase in the tables."""
        return SIDES.index(key[0])

    def meet(self, phase: int, lacking: int) -> None:
        """Compile the phase that a run needs: all are there."""

    def known_system(self, dt: float, *, shaken: bool = False) -> System | None:
        """Return the tables for one time step; None if they are not ready."""
        return None if shaken else self._systems.get(dt)

    def system(self, dt: float, fastest: float, *, shaken: bool = False) -> System:
        """Return the tables for one time step; `fastest` bounds the frequencies of all phases in rad/s."""
        phases = self.at(dt, fastest, shaken=shaken)
        known = phases.known_system(dt, shaken=shaken)
        return phases.system(dt, fastest, shaken=shaken) if known is None else known

    def _entered(self, dt: float, fastest: float) -> System | None:
        p = self._model.properties
        rows = 2 + len(self._quantities)
        levels = min(levels_of(fastest, dt), MOST_LEVELS)
        system = self._empty(rows, levels).copied(dt, modes_of(p.omega, p.zeta, p.n_modes + 1))
        right, left = p.pivot(RIGHT), p.pivot(LEFT)
        spare = _spare.setdefault(p.n_modes, [])
        try:
            scratch = spare.pop()
        except IndexError:
            scratch = Scratch(p.n_modes)
        bare = Bare(
            modes=np.array((p.effective_mass, p.effective_height, np.sqrt(p.effective_mass), p.omega)),
            pivots=np.array(((right.i_theta, right.arm), (left.i_theta, left.arm))),
            moment=p.l0r,
            mass=p.m_tot,
            gravity=GRAVITY,
            longest_fall=LONGEST_FALL,
            shares=self._quantities.shares,
            swings=self._quantities.swings,
            accelerations=scratch.accelerations,
            steady=scratch.steady,
        )
        terms = _enter(tables_of(system), bare, scratch.pairs)
        if len(spare) < SPARE:
            spare.append(scratch)
        self.terms = max(self.terms, terms)
        return system if terms > 0 else None


def _links() -> NDArray[np.int64]:
    """Return the events at the limits of the three phases, and the phases that follow."""
    links = np.full((len(SIDES), CHANGED), -1, dtype=np.int64)
    contact, right, left = range(len(SIDES))
    links[:, BESIDE : BESIDE + 3] = contact, right, left
    links[:, TURNED] = contact, right, left
    links[:, EVENT : EVENT + 2] = (LIFTS, LIFTS), (LANDS, OVERTURNS), (OVERTURNS, LANDS)
    links[:, FOLLOWS : FOLLOWS + 2] = (right, left), (contact, right), (left, contact)
    return links
