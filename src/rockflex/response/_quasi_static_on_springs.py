"""The quasi-static moment of a base on springs along a prescribed path of its rotation."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex._constants import GRAVITY
from rockflex._shown import number_with_noun
from rockflex.modal import Springs
from rockflex.models import BROKEN, Element, SpringModel, stored_energy
from rockflex.response._history import History, pressure_of
from rockflex.response._quasi_static import (
    ElementState,
    StaticPath,
    at_rest,
    next_branch,
    next_branch_change,
    plastic_stretch,
    start_moving,
    tension,
)

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, repr=False)
class MomentRotationOnSprings(StaticPath):
    """The quasi-static moment of a base on springs over a path of its rotation, with the forces and the settlement.

    Between adjacent points everything is linear: a point stands wherever a spring becomes empty or is met again, and
    wherever an element changes its branch. `moment_rotation` returns such paths.

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
        Elongation δ from the base at rest on its springs, in m.
    plastic_stretch : ndarray, shape (n, E)
        Plastic part of the elongation in m of fuses and tendons that yield, NaN once they are broken; zero for others.
    element_losses : ndarray, shape (n, E)
        Energy that each element has dissipated so far, in J. A rupture dissipates what the element had stored, and the
        work of its force while it vanishes.
    springs : Springs
        The springs under the base.
    heave : ndarray, shape (n,)
        Rise z of the base at the axis of the masses in m, from the level at which the springs are unloaded.
    spring_force : ndarray, shape (n, S)
        Force of each spring on the base in N, upwards.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.3, half_diagonal=4.0, mass=80e3)
    >>> b = block.half_width
    >>> ground = rf.Ground(springs=rf.Springs([-b, b], stiffness=50e6), base_inertia=1e5)
    >>> curve = rf.moment_rotation(block, [0.02], ground=ground)
    >>> (curve.uplift_rotations * 1e3).round(2), (curve.uplift_moments / 1e3).round(1)
    (array([6.64]), array([907.8]))
    >>> (curve.edge_uplift[-1] * 1e3).round(1)  # left and right, in mm
    array([ 31.6, -15.7])
    """

    springs: Springs
    heave: Array
    spring_force: Array

    def __repr__(self) -> str:
        largest, peak = (float(np.max(np.abs(values))) for values in (self.rotation, self.moment))
        return (
            f"MomentRotationOnSprings({self.rotation.size} points, {number_with_noun(self.springs.n, 'spring')}, "
            f"{number_with_noun(len(self.elements), 'element')}, |θ| up to {largest:.4g} rad, |M| up to {peak:.4g} N m)"
        )

    @cached_property
    def moment(self) -> Array:
        """Moment M in N m that turns the base, shape (n,); zero at rest.

        It is a couple: in vertical equilibrium the weight, the springs and the elements have the same moment about any
        axis.
        """
        return self.spring_moment + self.weight_moment + self.element_moment.sum(axis=1) + 0.0  # no -0.0

    @property
    def spring_moment(self) -> Array:
        """Contribution Σ x N of the springs in N m about the axis of the masses, shape (n,)."""
        return self.spring_force @ self.springs.positions

    @property
    def element_moment(self) -> Array:
        """Contribution -x F of each element in N m about the axis of the masses, shape (n, E)."""
        return -self.element_force * np.array([each.position for each in self.elements])

    @property
    def weight_moment(self) -> Array:
        """Contribution -L_0^r g θ of the weight in N m about the axis of the masses, shape (n,)."""
        return -self.properties.l0r * GRAVITY * self.rotation

    @property
    def edge_uplift(self) -> Array:
        """Rise of the left and of the right edge of the base in m, negative where it settles, shape (n, 2)."""
        return self.heave[:, None] - self._edges * self.rotation[:, None]

    @property
    def contact_length(self) -> Array:
        """Length of the base in m below the level at which the springs are unloaded, shape (n,)."""
        left, right = self.edge_uplift.T
        width = 2.0 * self.properties.half_width
        across = np.abs(right - left)
        down = -np.minimum(left, right)
        share = np.divide(down, across, out=np.where(down > 0.0, 1.0, 0.0), where=across > 0.0)
        return width * np.clip(share, 0.0, 1.0)

    @property
    def soil_pressure(self) -> Array:
        """Pressure under the base at each spring in Pa, shape (n, S).

        Raises
        ------
        InputError
            If the springs have no `area`.
        """
        return pressure_of(self.spring_force, self.springs)

    @property
    def uplift_rotations(self) -> Array:
        """Rotations θ in rad at which the outermost spring of either side becomes empty, shape (n_uplifts,)."""
        return self.rotation[self._uplifts]

    @property
    def uplift_moments(self) -> Array:
        """Moments in N m at which the outermost spring of either side becomes empty, shape (n_uplifts,)."""
        return self.moment[self._uplifts]

    def to_frame(self) -> "pd.DataFrame":
        """Return the path as a table, one row a point.

        Returns
        -------
        pandas.DataFrame
            `rotation` (rad), `moment` (N m), `heave`, `left_uplift`, `right_uplift`, `contact_length` (m), `given`, for
            every spring `spring_force_1` (N), and for every element, counted from 1, `element_force_1` (N),
            `element_elongation_1`, `plastic_stretch_1` (m) and `element_losses_1` (J).
        """
        table = self._frame("rotation", "moment", "heave", "contact_length", "given")
        for place, name in enumerate(("left_uplift", "right_uplift")):
            table.insert(3 + place, name, self.edge_uplift[:, place])
        for place in range(self.springs.n):
            table.insert(7 + place, f"spring_force_{place + 1}", self.spring_force[:, place])
        return table

    @property
    def _edges(self) -> Array:
        p = self.properties
        return np.array([-p.pivot(-1).arm, p.pivot(1).arm])

    @property
    def _uplifts(self) -> NDArray[np.int64]:
        """Points at which an outermost spring becomes empty."""
        loaded = self.spring_force[:, [0, -1]] > 0.0
        leaves = loaded[:-2] & ~loaded[1:-1] & ~loaded[2:]
        return 1 + np.flatnonzero(leaves.any(axis=1))


TOLERANCE = 1e-12  # relative: changes this close to each other happen at once


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A position in equilibrium.

    Attributes
    ----------
    rotation, heave
        θ in rad and z in m.
    pressed, empty
        Which springs are compressed, and which are just at their length, shape (S,).
    places
        Where the elements are.
    carried
        Force in N that each element still carries while it breaks, shape (E,).
    """

    rotation: float
    heave: float
    pressed: Bools
    empty: Bools
    places: tuple[ElementState, ...]
    carried: Array


def springs_path(model: SpringModel, rotations: Array) -> MomentRotationOnSprings:
    """Return the quasi-static moment along a path from rest through the rotations in rad, shape (m,), m > 0."""
    elements, springs = model.elements, model.springs
    found = list(_points(model, rotations))
    equilibria = [state for state, _ in found]
    rotation, heave = np.array([(state.rotation, state.heave) for state in equilibria]).T
    loaded = np.array([state.pressed & ~state.empty for state in equilibria])
    depth = heave[:, None] - springs.positions * rotation[:, None]
    values = np.array(
        [
            (tension(each, place) + carried, place.elongation, plastic_stretch(each, place))
            for state in equilibria
            for each, place, carried in zip(elements, state.places, state.carried, strict=True)
        ]
    )
    shape = len(equilibria), len(elements)
    force, elongation, plastic = values.reshape(*shape, 3).transpose(2, 0, 1)
    losses = np.zeros(shape)
    losses[1:] = np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(elongation, axis=0), axis=0)
    for k, each in enumerate(elements):
        losses[:, k] -= stored_energy(each, elongation[:, k], force[:, k], plastic[:, k])
    return MomentRotationOnSprings(
        properties=model.properties,
        springs=springs,
        rotation=rotation + 0.0,  # no -0.0
        heave=heave,
        spring_force=np.where(loaded, np.maximum(-springs.stiffness * depth, 0.0), 0.0),
        given=np.array([given for _, given in found]),
        element_force=force,
        element_elongation=elongation,
        plastic_stretch=plastic,
        element_losses=losses,
    )


def _points(model: SpringModel, rotations: Array) -> Iterator[tuple[Equilibrium, bool]]:
    """Yield the points of the path, from rest, and whether their rotation was prescribed."""
    rotation, heave = model.rest
    pressed = heave - model.springs.positions * rotation < 0.0
    places = tuple(at_rest(each) for each in model.elements)
    state = Equilibrium(rotation, heave, pressed, np.zeros_like(pressed), places, np.zeros(len(places)))
    starts = bool(rotations[0] == rotation)
    yield state, starts
    for target in rotations[int(starts) :].tolist():
        while state.rotation != target or state.carried.any():
            before = state
            state = _settled(model, state) if state.carried.any() else _turned(model, state, target)
            if state.rotation != target and (state.rotation != before.rotation or before.carried.any()):
                yield state, False
        yield state, True


def _turned(model: SpringModel, state: Equilibrium, target: float) -> Equilibrium:
    """Return the state where something changes next, or at the target."""
    length = abs(target - state.rotation)
    moved, path = _moved(model, state, math.copysign(1.0, target - state.rotation), 0.0, length)
    return replace(moved, rotation=target) if path == length else moved


def _settled(model: SpringModel, state: Equilibrium) -> Equilibrium:
    """Return the state where something changes next while an element that breaks lets its force go, or without it."""
    place = int(np.flatnonzero(state.carried)[0])
    force = float(state.carried[place])
    moved, path = _moved(model, state, 0.0, math.copysign(1.0, force), abs(force))
    carried = moved.carried.copy()
    carried[place] = 0.0 if path == abs(force) else force - math.copysign(path, force)
    return replace(moved, carried=carried)


def _moved(
    model: SpringModel, state: Equilibrium, turn: float, lift: float, length: float
) -> tuple[Equilibrium, float]:
    """Return the next state on the way with θ' = `turn`, and `lift` more upward force per unit, and the way to it.

    The way ends after `length`, or where a spring becomes empty or is met, or an element ends its branch.
    """
    springs, elements = model.springs, model.elements
    positions = np.array([*springs.positions, *(each.position for each in elements)])
    onward = [
        {way: _onward(each, place, way) for way in (1, -1)} for each, place in zip(elements, state.places, strict=True)
    ]
    up, down = (
        np.array([each.pull(ways[way].branch).stiffness for each, ways in zip(elements, onward, strict=True)])
        for way in (1, -1)
    )
    taken = np.where(state.pressed & ~state.empty, springs.stiffness, 0.0)
    met = np.where(state.pressed | state.empty, springs.stiffness, 0.0)
    rise = _rise(positions * turn, np.append(taken, up), np.append(met, down), lift)
    rates = rise - positions * turn
    pressed = np.where(state.empty, rates[: springs.n] < 0.0, state.pressed)
    places = [ways[-1 if rate < 0.0 else 1] for ways, rate in zip(onward, rates[springs.n :], strict=True)]
    stops = [
        next_branch_change(each, place, int(np.sign(rate)))
        for each, place, rate in zip(elements, places, rates[springs.n :], strict=True)
    ]
    depth = state.heave - springs.positions * state.rotation
    left = [at[0] - place.elongation if at else 0.0 for at, place in zip(stops, places, strict=True)]
    ends = np.array([*(pressed == (rates[: springs.n] > 0.0)), *(at is not None for at in stops)])
    ahead = np.full(positions.size, np.inf)
    np.divide(np.append(-depth, left), rates, out=ahead, where=ends & (rates != 0.0))
    np.maximum(ahead, 0.0, out=ahead)
    near = TOLERANCE * length
    ahead[ahead >= length - near] = np.inf  # it belongs to the next part of the path
    path = min(length, float(ahead.min()))
    happens = ahead <= path + near
    rotation, heave = state.rotation + turn * path, state.heave + rise * path
    carried = state.carried.copy()
    for k, (each, at) in enumerate(zip(elements, stops, strict=True)):
        stretch = heave - model.rest[1] - each.position * (rotation - model.rest[0])
        places[k] = places[k]._replace(elongation=stretch)
        if at is not None and happens[springs.n + k]:
            force = tension(each, places[k])
            places[k] = next_branch(each, places[k]._replace(elongation=at[0]), at[1])
            carried[k] = force if at[1] == BROKEN else 0.0
    empty = happens[: springs.n] | (state.empty & (path <= near))
    return Equilibrium(rotation, heave, pressed, empty, tuple(places), carried), path


def _onward(element: Element, place: ElementState, way: int) -> ElementState:
    """Return the place of an element that begins to be stretched (1) or shortened (-1)."""
    place = start_moving(element, place, way)
    while (at := next_branch_change(element, place, way)) and at[0] == place.elongation and at[1] != BROKEN:
        place = next_branch(element, place, at[1])
    return place


def _rise(meets: Array, up: Array, down: Array, lift: float) -> float:
    """Return the rate v of the heave at which Σ k (v - m) = `lift`, with k = `up` where v > m, else `down`."""
    order = np.argsort(meets, kind="stable")
    meets, up, down = meets[order], up[order], down[order]
    stiffness, force = (
        np.append(0.0, np.cumsum(above)) + np.append(np.cumsum(below[::-1])[::-1], 0.0)
        for above, below in ((up, down), (up * meets, down * meets))
    )
    ends = np.append(meets, np.inf)
    rates = ends.copy()
    np.divide(force + lift, stiffness, out=rates, where=stiffness > 0.0)
    return float(rates[np.argmax(rates <= ends)])


class SpringsResistance(NamedTuple):
    """Contributions of the springs and of the weight, shape (n,), and of each element, shape (n, E), in N m."""

    springs: Array
    weight: Array
    elements: Array

    @property
    def moment(self) -> Array:
        """Their sum, shape (n,)."""
        return self.springs + self.weight + self.elements.sum(axis=1)


def resistance_on_springs(history: History) -> SpringsResistance | None:
    """Return the resisting moment at the states of a run; None on rigid ground."""
    model, p = history.model, history.model.properties
    if not isinstance(model, SpringModel):
        return None
    gravity = GRAVITY + history.vertical_ground_acceleration
    return SpringsResistance(
        history.spring_force @ model.springs.positions,
        -p.l0r * gravity * history.rotation,
        -history.element_force * np.array([each.position for each in p.elements]),
    )


def push_on_springs(history: History, rotation: float) -> MomentRotationOnSprings | None:
    """Return the slow push of the base of a run to a rotation in rad on either side; None on rigid ground."""
    model = history.model
    return springs_path(model, np.array([rotation, -rotation])) if isinstance(model, SpringModel) else None
