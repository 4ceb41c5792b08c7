"""The quasi-static moment of a base on rigid ground along a prescribed path of its rotation."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex._constants import GRAVITY
from rockflex._shown import number_with_noun
from rockflex._values import Value
from rockflex.modal import BaseElement, RockingProperties
from rockflex.models import BROKEN, CLOSED, LEFT, RIGHT, Bar, Element, Slider, arm_of, elements_of, stored_energy

if TYPE_CHECKING:
    import pandas as pd


_OF_ELEMENTS = ("element_force", "element_elongation", "plastic_stretch", "element_losses")


@dataclass(frozen=True, eq=False, repr=False)
class StaticPath(Value, ABC):
    """What paths on rigid ground and on springs have in common; between adjacent points everything is linear."""

    properties: RockingProperties
    rotation: Array
    given: Bools
    element_force: Array
    element_elongation: Array
    plastic_stretch: Array
    element_losses: Array

    @cached_property
    @abstractmethod
    def moment(self) -> Array:
        """Moment M in N m, shape (n,)."""

    @property
    def elements(self) -> tuple[BaseElement, ...]:
        """The elements, in their order."""
        return self.properties.elements

    @property
    def work(self) -> Array:
        """Work of the moment up to each point in J, shape (n,)."""
        steps = 0.5 * (self.moment[1:] + self.moment[:-1]) * np.diff(self.rotation)
        return np.concatenate(([0.0], np.cumsum(steps)))

    @property
    def element_energy(self) -> Array:
        """Energy that each element has dissipated along the whole path in J, shape (E,)."""
        return self.element_losses[-1]

    @property
    def dissipated_energy(self) -> Array:
        """Energy that all elements have dissipated up to each point in J, shape (n,)."""
        return self.element_losses.sum(axis=1)

    def _frame(self, *names: str) -> "pd.DataFrame":
        """Return these quantities and those of the elements, counted from 1, as a table."""
        import pandas as pd

        columns = {name: getattr(self, name) for name in names}
        for place in range(len(self.elements)):
            columns |= {f"{name}_{place + 1}": getattr(self, name)[:, place] for name in _OF_ELEMENTS}
        return pd.DataFrame(columns)


def weight_resistance(properties: RockingProperties, side: NDArray[np.integer], rotation: Array) -> Array:
    """Return s m_tot g B_s - L_0^r g θ in N m for small rotations, shape (n,); zero in contact."""
    return _weight(properties, side) - properties.l0r * GRAVITY * rotation


def element_resistance(properties: RockingProperties, side: NDArray[np.integer], force: Array) -> Array:
    """Return s F r of each element in N m for small rotations, shape (n, E); zero in contact."""
    positions = np.array([each.position for each in properties.elements])
    arms = [properties.pivot(turned).arm - turned * positions for turned in (1, -1)]
    return np.array([np.zeros(positions.size), arms[0], -arms[1]])[side] * force


def large_resistance(
    properties: RockingProperties, side: NDArray[np.integer], rotation: Array, force: Array
) -> tuple[Array, Array]:
    """Return both parts for rotations of any size: s m_tot g B_s cos θ - L_0^r g sin θ, and s F r cos(θ/2)."""
    weight = _weight(properties, side) * np.cos(rotation) - properties.l0r * GRAVITY * np.sin(rotation)
    return weight, element_resistance(properties, side, force) * np.cos(0.5 * rotation)[:, None]


def _weight(properties: RockingProperties, side: NDArray[np.integer]) -> Array:
    return np.array([0.0, properties.pivot(1).weight_moment, -properties.pivot(-1).weight_moment])[side]


@dataclass(frozen=True, eq=False, repr=False)
class MomentRotation(StaticPath):
    """The quasi-static moment of a base over a path of its rotation, with the forces of its elements.

    Between adjacent points everything is linear: a point stands wherever an element changes its branch, and two of them
    where a force or the moment jumps at a constant rotation. `moment_rotation` returns such paths.

    An *excursion* is the part of a path from one lift-off to the next.

    Parameters
    ----------
    properties : RockingProperties
        The structure, with its elements.
    rotation : ndarray, shape (n,)
        θ in rad.
    given : ndarray of bool, shape (n,)
        True where a rotation was prescribed, and False at points in between.
    element_force : ndarray, shape (n, E)
        Tension F of each element in N, in the order of `RockingProperties.elements`.
    element_elongation : ndarray, shape (n, E)
        Elongation δ from the base in contact, in m.
    plastic_stretch : ndarray, shape (n, E)
        Plastic part of the elongation in m of fuses and tendons that yield, NaN once they are broken; zero for others.
    element_losses : ndarray, shape (n, E)
        Energy that each element has dissipated so far, in J. A rupture dissipates what the element had stored.
    side : ndarray of int, shape (n,)
        1 about the right pivot, -1 about the left pivot, 0 at the start, at rest and without load.

    Examples
    --------
    >>> import rockflex as rf
    >>> wall = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e9, base_mass=10e3, half_width=1.5, damping_ratio=0.02
    ... )
    >>> fuse = rf.YieldingDissipator(stiffness=60e6, yield_force=150e3)
    >>> held = rf.Restrained(wall, [rf.Tendon(initial_force=300e3, stiffness=8e6), fuse])
    >>> curve = rf.moment_rotation(held, [0.02, -0.02, 0.0])
    >>> (curve.uplift_moments / 1e3).round(1)
    array([ 1332.9, -1107.9])
    >>> curve.loop_energies.round(), curve.self_centring
    (array([7875., 7500.]), True)
    """

    side: NDArray[np.int64]

    def __repr__(self) -> str:
        largest, peak = (float(np.max(np.abs(values))) for values in (self.rotation, self.moment))
        return (
            f"MomentRotation({self.rotation.size} points, {number_with_noun(len(self.elements), 'element')}, "
            f"|θ| up to {largest:.4g} rad, |M| up to {peak:.4g} N m, {self.dissipated_energy[-1]:.4g} J dissipated)"
        )

    @cached_property
    def moment(self) -> Array:
        """Moment M in N m about the pivot about which the base rotates, shape (n,).

        Of the sign of θ where the base resists the rotation. Zero at the start.
        """
        return self.weight_moment + self.element_moment.sum(axis=1)

    @property
    def element_moment(self) -> Array:
        """Contribution s F r of each element to the moment in N m, shape (n, E); it is zero at rest."""
        return element_resistance(self.properties, self.side, self.element_force)

    @property
    def weight_moment(self) -> Array:
        """Contribution s m_tot g B_s - L_0^r g θ of the weight to the moment in N m, shape (n,)."""
        return weight_resistance(self.properties, self.side, self.rotation)

    @property
    def uplift_moments(self) -> Array:
        """Moment in N m at which the base lifts off, shape (n_excursions,).

        Elements that have yielded shift the later ones.
        """
        return self.moment[self._lift_offs]

    @property
    def loop_energies(self) -> Array:
        """Energy dissipated in each excursion in J, shape (n_excursions,)."""
        known = self.dissipated_energy
        return np.diff(known[self._lift_offs], append=known[-1])

    @property
    def residual_rotations(self) -> Array:
        """Rotation θ in rad at which each excursion comes to rest if it is unloaded, shape (n_excursions,).

        The moment vanishes there on the last way back to contact; zero if the base closes under its own weight and
        tendons. NaN for an excursion that does not return to contact.
        """
        starts = self._lift_offs
        ends = [*starts[1:], self.rotation.size - 1][: starts.size]
        return np.array([self._at_rest(first, last) for first, last in zip(starts, ends, strict=True)], dtype=float)

    @property
    def self_centring(self) -> bool:
        """Whether every excursion that returns to contact does so when it is unloaded, without a residual rotation."""
        found = self.residual_rotations
        return not np.any(found[~np.isnan(found)] != 0.0)

    def to_frame(self) -> "pd.DataFrame":
        """Return the path as a table, one row a point.

        Returns
        -------
        pandas.DataFrame
            `rotation` (rad), `moment` (N m), `side`, `given`, and for every element, counted from 1,
            `element_force_1` (N), `element_elongation_1`, `plastic_stretch_1` (m) and `element_losses_1` (J).
        """
        return self._frame("rotation", "moment", "side", "given")

    @property
    def _lift_offs(self) -> NDArray[np.int64]:
        """Points from which the base leaves contact."""
        return np.flatnonzero((self.rotation[:-1] == 0.0) & (self.rotation[1:] != 0.0))

    def _at_rest(self, first: int, last: int) -> float:
        """Rotation at rest after the excursion between two points."""
        theta, resisting = self.rotation[first : last + 1], self.moment[first : last + 1]
        landed = np.flatnonzero(theta[1:] == 0.0)
        if not landed.size:
            return np.nan
        theta, resisting = theta[: landed[0] + 2], (np.sign(theta[1]) * resisting)[: landed[0] + 2]
        outward = np.flatnonzero(np.abs(theta[1:]) > np.abs(theta[:-1]))
        for k in range(int(outward[-1]) + 1, theta.size - 1):
            if resisting[k] >= 0.0 > resisting[k + 1]:
                share = resisting[k] / (resisting[k] - resisting[k + 1])
                return float(theta[k] + share * (theta[k + 1] - theta[k]))
        return 0.0


class ElementState(NamedTuple):
    """The branch of an element, its memory at the start of the branch, and its elongation δ in m."""

    branch: int
    memory: float
    elongation: float


def at_rest(element: Element) -> ElementState:
    """Return the place at which every path starts."""
    return ElementState(element.branches[0], 0.0, 0.0)


def tension(element: Element, place: ElementState) -> float:
    """Return the force in N while the elongation changes slowly."""
    pull = element.pull(place.branch)
    return pull.stiffness * place.elongation + pull.force + pull.recall * place.memory


def memory_at(element: Element, place: ElementState) -> float:
    """Return the memory if the branch ended here: on a branch that yields it follows the elongation."""
    offset = element.turning(place.branch)
    return place.memory if offset is None else place.elongation - offset


def start_moving(element: Element, place: ElementState, direction: int) -> ElementState:
    """Return the place as the elongation begins to change, with the sign of δ'; 0 if it does not change."""
    if element.direction(place.branch) == direction:
        return place
    branch = element.moving(element.stopped(place.branch), direction)
    return ElementState(branch, memory_at(element, place), place.elongation)


def next_branch_change(element: Element, place: ElementState, direction: int) -> tuple[float, int] | None:
    """Return the elongation at which the branch ends if it keeps its direction, and the next branch; None if never."""
    ahead = [
        (max(direction * (stop.place + stop.recall * place.memory), direction * place.elongation), stop.branch)
        for stop in element.stops(place.branch)
        if stop.upper == (direction > 0)
    ]
    if direction == 0 or not ahead:
        return None
    reached, branch = min(ahead)
    return direction * reached, branch


def next_branch(element: Element, place: ElementState, branch: int) -> ElementState:
    """Return the same place on the branch that follows."""
    return ElementState(branch, memory_at(element, place), place.elongation)


def jumps(element: Element, before: ElementState, after: ElementState) -> bool:
    """Return whether the force jumps between two branches."""
    return before.branch != after.branch and (after.branch == BROKEN or isinstance(element, Slider))


def plastic_stretch(element: Element, place: ElementState) -> float:
    """Return the plastic part of the elongation in m; NaN once the element is broken."""
    if not isinstance(element, Bar):
        return 0.0
    return math.nan if place.branch == BROKEN else memory_at(element, place)


TOLERANCE = 1e-12  # relative: a change of branch this close to the end of a leg belongs to the next leg

Point = tuple[int, float, bool, tuple[ElementState, ...]]  # side, |θ|, whether it was prescribed, and the elements


def base_path(properties: RockingProperties, rotations: Array) -> MomentRotation:
    """Return the quasi-static moment along a path from rest through the rotations in rad, shape (m,), m > 0."""
    elements = elements_of(properties)
    points = list(_points(properties, elements, rotations))
    side = np.array([point[0] for point in points])
    shape = len(points), len(elements)
    values = np.array(
        [
            (tension(each, place), place.elongation, plastic_stretch(each, place))
            for *_, places in points
            for each, place in zip(elements, places, strict=True)
        ]
    )
    force, elongation, plastic = values.reshape(*shape, 3).transpose(2, 0, 1)
    stored = np.zeros(shape)
    for k, each in enumerate(elements):
        stored[:, k] = stored_energy(each, elongation[:, k], force[:, k], plastic[:, k])
    work = np.zeros(shape)
    np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(elongation, axis=0), axis=0, out=work[1:])
    return MomentRotation(
        properties=properties,
        rotation=side * np.array([point[1] for point in points]) + 0.0,  # no -0.0
        side=side,
        given=np.array([point[2] for point in points]),
        element_force=force,
        element_elongation=elongation,
        plastic_stretch=plastic,
        element_losses=work - stored,
    )


def _points(properties: RockingProperties, elements: tuple[Element, ...], rotations: Array) -> Iterator[Point]:
    """Yield the points of the path, from rest."""
    places = tuple(at_rest(each) for each in elements)
    arms = {side: tuple(arm_of(properties, each, side) for each in elements) for side in (RIGHT, LEFT)}
    yield CLOSED, 0.0, bool(rotations[0] == 0.0), places
    before = CLOSED
    for side, start, end, given in _legs(rotations):
        leg = _leg(elements, arms[side], places, start, end, lifts=side != before) if side != CLOSED else []
        for reached, places in leg[:-1]:
            yield side, reached, False, places
        places = leg[-1][1] if leg else places
        yield side, end, given, places
        before = side


def _legs(rotations: Array) -> Iterator[tuple[int, float, float, bool]]:
    """Yield side, first and last |θ| of every part of the path on one side, and whether its end was prescribed."""
    side, known = CLOSED, 0.0
    for rotation in rotations[int(rotations[0] == 0.0) :].tolist():
        if known * rotation < 0.0:
            yield side, abs(known), 0.0, False
            known = 0.0
        side = RIGHT if rotation > 0.0 else LEFT if rotation < 0.0 else side
        yield side, abs(known), abs(rotation), True
        known = rotation


def _leg(
    elements: tuple[Element, ...],
    arms: tuple[float, ...],
    places: tuple[ElementState, ...],
    start: float,
    end: float,
    *,
    lifts: bool,
) -> list[tuple[float, tuple[ElementState, ...]]]:
    """Return the points from one |θ| to another about one pivot; the first only if forces jump or the base lifts."""
    turn, near = int(np.sign(end - start)), TOLERANCE * max(start, end)
    if turn == 0:
        return [(end, places)]
    ways = [turn * int(np.sign(arm)) for arm in arms]
    parts = list(zip(elements, arms, ways, strict=True))
    before, places = (
        places,
        tuple(start_moving(each, place, way) for (each, _, way), place in zip(parts, places, strict=True)),
    )
    found = [(start, places)] if lifts or _jumped(elements, before, places) else []
    at = start
    while True:
        stops = [next_branch_change(each, place, way) for (each, _, way), place in zip(parts, places, strict=True)]
        ends = [end if stop is None else stop[0] / arm for stop, arm in zip(stops, arms, strict=True)]
        nearest = min(ends, key=lambda q: turn * q, default=end)
        if turn * (end - nearest) <= near:
            break
        if turn * (nearest - at) > near:
            at = nearest
            places = _moved(places, arms, at)
            found.append((at, places))
        before, places = (
            places,
            tuple(
                place if stop is None or turn * (q - at) > near else next_branch(each, place, stop[1])
                for each, place, stop, q in zip(elements, places, stops, ends, strict=True)
            ),
        )
        if _jumped(elements, before, places):
            found.append((at, places))
    found.append((end, _moved(places, arms, end)))
    return found


def _moved(places: tuple[ElementState, ...], arms: tuple[float, ...], rotation: float) -> tuple[ElementState, ...]:
    return tuple(place._replace(elongation=arm * rotation) for place, arm in zip(places, arms, strict=True))


def _jumped(elements: tuple[Element, ...], before: tuple[ElementState, ...], after: tuple[ElementState, ...]) -> bool:
    return any(map(jumps, elements, before, after))
