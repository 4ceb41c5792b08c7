"""The motion between the states of a history: in closed form or, for other linear phases, by power series."""

import math
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Complex
from rockflex.models import (
    GROUND,
    HEADER,
    RISE,
    SIDE,
    TIME,
    Key,
    LinearModel,
    RockingModel,
    phases_at,
    under_more_gravity,
)
from rockflex.solve.exact.basis import Basis, basis_of, with_constant
from rockflex.solve.exact.developed import Course, Developed, Shaking
from rockflex.solve.exact.tables import propagate

LONGEST = 200.0  # phase angle of an interval up to which a series is faster than exponentials of a dense matrix
ASIDE = 1e-6  # of a step times the change of θ' in it, from the middle rotation


class ClosedForm:
    """The linear phases of a model, uncoupled.

    Parameters
    ----------
    model
        The model.
    """

    def __init__(self, model: RockingModel) -> None:
        self._model = model

    def _basis(self, key: Key) -> Basis | None:
        """Return the uncoupled coordinates of a phase; None if it is not linear."""
        if key not in self._known:
            arrow = self._model.phase(key).arrow
            if arrow is None or arrow.drifts:
                self._known[key] = None
            else:
                basis = basis_of(self._model, arrow, self._model.accelerations(key))
                self._known[key] = with_constant(basis, arrow)
        return self._known[key]

    def _developed(self, key: Key) -> Developed | None:
        """Return the power series of a phase; None if it is not linear."""
        if key not in self._developments:
            arrow, found = self._model.phase(key).arrow, None
            if arrow is not None:
                heavier = under_more_gravity(self._model).arrow(key)
                found = Developed(self._model, arrow, heavier, self._model.accelerations(key))
            self._developments[key] = found
        return self._developments[key]

    @cached_property
    def _developments(self) -> dict[Key, Developed | None]:
        return {}

    @cached_property
    def _known(self) -> dict[Key, Basis | None]:
        return {}

    @cached_property
    def _bases(self) -> dict[int, Basis]:
        found = {side: self._basis(self._model.start(side)) for side in self._model.sides}
        return {side: basis for side, basis in found.items() if basis is not None}

    @cached_property
    def fastest(self) -> float:
        """Largest eigenvalue magnitude of all phases, rad/s; integrated phases are linearised for small rotations."""
        of_bases = [basis.fastest for basis in self._bases.values()]
        integrated = [side for side in self._model.sides if side not in self._bases]
        return max([*of_bases, *(_fastest(self._model.linear, side) for side in integrated)])

    def intervals(self, states: Array) -> "Intervals":
        """Return the motion over the intervals between adjacent nodes."""
        steps = np.diff(states[:, TIME])
        # The steps differ by rounding of the times; once rounded to equal values, they share one propagator.
        steps = np.round(steps, 12 - math.ceil(math.log10(max(float(states[-1, TIME]), 1.0))))
        safe = np.where(steps > 0.0, steps, 1.0)
        slopes = np.where(steps > 0.0, np.diff(states[:, GROUND]) / safe, 0.0)
        layout, before = self._model.layout, states[:-1, HEADER:]
        memories = before[:, layout.memory : layout.memory + layout.remembered]
        start = np.column_stack((states[:-1, GROUND], slopes, np.ones(steps.size), memories))
        rise = states[:-1, RISE]
        rise_slopes = np.where(steps > 0.0, np.diff(states[:, RISE]) / safe, 0.0)
        shaken = (rise != 0.0) | (rise_slopes != 0.0)
        shaking = np.stack((states[:-1, GROUND], slopes, rise, rise_slopes))
        # The branch of an element over an interval is that in its middle, with the memory at its start. An excursion
        # may begin and end on the border of a branch: a little of its height tells on which side it is.
        rotation, spin = layout.of(states, layout.rotation), layout.of(states, layout.spin)
        middle = 0.5 * (rotation[:-1] + rotation[1:]) - ASIDE * steps * np.diff(spin)
        parts, series = list[Part](), list[SeriesPart]()
        for found, key in phases_at(self._model, states[:-1, SIDE], middle, states[:-1]):
            basis, chosen = self._basis(key), found
            if basis is not None and basis.dense and basis.fastest * float(steps[found].max()) <= LONGEST:
                basis = None
            if basis is None or shaken[found].any():
                chosen = found & ~shaken if basis is not None else np.zeros_like(found)
                rest = found & ~chosen
                developed = self._developed(key)
                if developed is not None:
                    rows = np.flatnonzero(rest)
                    series.append(SeriesPart(rows, developed, before[rest], Shaking(*shaking[:, rest]), steps[rest]))
            if basis is not None and chosen.any():
                forced = basis.steady @ basis.inverse.T
                w = before[chosen][:, : layout.core] @ basis.inverse.T - start[chosen] @ forced
                parts.append(Part(np.flatnonzero(chosen), basis, forced, w, start[chosen], steps[chosen]))
        return Intervals(before, parts, series)


class Part(NamedTuple):
    """The intervals of one linear phase."""

    rows: NDArray[np.intp]  # (n,)
    basis: Basis
    forced: Array  # (3 + M, S): coefficients of a, a', 1 and the memories in the forced part
    w: Array  # (n, S): coordinates at the start
    start: Array  # (n, 3 + M): a, a', 1 and the memories at the start
    steps: Array  # (n,): lengths, s


class SeriesPart(NamedTuple):
    """The intervals of one linear phase that has no closed form, or in which the ground moves vertically."""

    rows: NDArray[np.intp]  # (n,)
    motion: Developed
    start: Array  # (n, S'): states at the start
    shaking: Shaking
    steps: Array  # (n,): lengths, s

    def course(self) -> Course:
        """Return the motion at one fraction after the other."""
        return Course(self.motion, self.start, self.shaking, self.steps)


class Intervals(NamedTuple):
    """The motion between adjacent nodes, each linear phase in its own coordinates or by power series."""

    before: Array  # (n - 1, S'): states at the start
    parts: list[Part]
    series: list[SeriesPart]

    def at(self, fraction: float) -> Array:
        """Return the states at a fraction of every interval, shape (n - 1, S').

        In phases that are not linear these are the states at the start of the interval.
        """
        return next(self.along([fraction]))

    @property
    def roots(self) -> Complex:
        """Eigenvalues of the linear phases that occur, in rad/s, shape (n,)."""
        met = {id(part.basis): part.basis.roots for part in self.parts}
        met |= {id(part.motion): part.motion.roots for part in self.series}
        return np.concatenate([np.zeros(1, np.complex128), *(each.ravel() for each in met.values())])

    def along(self, fractions: Iterable[float]) -> Iterator[Array]:
        """Yield the states as `at` does, at rising fractions, with less work than one after the other."""
        courses = [(part.rows, part.course()) for part in self.series]
        for fraction in fractions:
            moved = self.before.copy()
            for part in self.parts:
                _move(moved, part.rows, part, slice(None), fraction * part.steps)
            for rows, course in courses:
                moved[rows] = course.at(float(fraction))
            yield moved

    def after(self, which: NDArray[np.intp], elapsed: Array) -> Array:
        """Return the states `elapsed` (m,) seconds after the start of some intervals, shape (m, S').

        In phases that are not linear these are the states at the start of the interval.
        """
        moved = self.before[which]
        for part in (*self.parts, *self.series):
            place = np.full(self.before.shape[0], -1)
            place[part.rows] = np.arange(part.rows.size)
            chosen = np.flatnonzero(place[which] >= 0)
            if chosen.size:
                _move(moved, chosen, part, place[which[chosen]], elapsed[chosen])
        return moved


def _move(
    moved: Array, rows: NDArray[np.intp], part: Part | SeriesPart, which: NDArray[np.intp] | slice, elapsed: Array
) -> None:
    """Replace rows by the states some time after the start of intervals of one part."""
    if isinstance(part, SeriesPart):
        shaking = Shaking(*(each[which] for each in part.shaking))
        moved[rows] = part.motion.moved(part.start[which], shaking, elapsed)
        return
    end = part.start[which].copy()
    end[:, 0] += elapsed * end[:, 1]
    carried = propagate(part.basis, part.w[which], elapsed) + end @ part.forced
    moved[rows, : carried.shape[1]] = carried @ part.basis.basis.T


def _fastest(model: LinearModel, side: int) -> float:
    """Return the largest eigenvalue magnitude of one phase; it exists even if tendons balance the weight."""
    size, layout = model.layout.core, model.layout
    places = [*range(layout.modes), layout.rotation]
    speeds = [*range(layout.modes, 2 * layout.modes), layout.spin]
    matrix = np.zeros((size, size))
    matrix[places, speeds] = 1.0
    matrix[speeds] = model.accelerations(model.start(side))[:, :size]
    return float(np.abs(np.linalg.eigvals(matrix)).max())
