"""The quasi-static moment of a base over its rotation: results of a slow push, and the parts of the moment."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.shown import number_with_noun
from rockflex.foundation.values import Value
from rockflex.response._history import History, soil_pressure
from rockflex.structure._base_element import BaseElement
from rockflex.structure._ground import Springs
from rockflex.structure._rocking import RockingProperties

if TYPE_CHECKING:
    import pandas as pd


_OF_ELEMENTS = ("element_force", "element_elongation", "plastic_stretch", "element_losses")


@dataclass(frozen=True, eq=False, repr=False)
class MomentRotationPath(Value, ABC):
    """A path on rigid ground or on springs; between adjacent points everything is linear."""

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


@dataclass(frozen=True, eq=False, repr=False)
class MomentRotation(MomentRotationPath):
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
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e9, base_mass=10e3,
    ...     half_width=1.5, damping_ratio=0.02
    ... )
    >>> fuse = rf.YieldingDissipator(stiffness=60e6, yield_force=150e3)
    >>> held = rf.Restrained(wall,
    ...     [rf.Tendon(initial_force=300e3, stiffness=8e6), fuse])
    >>> curve = rf.moment_rotation(held, [0.02, -0.02, 0.0])
    >>> (curve.uplift_moments / 1e3).round(1)
    array([ 1332.9, -1107.9])
    >>> curve.loop_energies.round(), curve.self_centring
    (array([7875., 7500.]), True)
    """

    side: NDArray[np.int64]
    spring_moment = edge_uplift = None  # on rigid ground

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


@dataclass(frozen=True, eq=False, repr=False)
class MomentRotationOnSprings(MomentRotationPath):
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
    >>> ground = rf.Ground(springs=rf.Springs([-b, b], stiffness=50e6),
    ...     base_inertia=1e5)
    >>> curve = rf.moment_rotation(block, [0.02], ground=ground)
    >>> (curve.uplift_rotations * 1e3).round(2), (
    ...     curve.uplift_moments / 1e3).round(1)
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
        return contact_length(self.edge_uplift, 2.0 * self.properties.half_width)

    @property
    def soil_pressure(self) -> Array:
        """Pressure under the base at each spring in Pa, shape (n, S).

        Raises
        ------
        InputError
            If the springs have no `area`.
        """
        return soil_pressure(self.spring_force, self.springs)

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


def weight_resistance(properties: RockingProperties, side: NDArray[np.integer], rotation: Array) -> Array:
    """Return s m_tot g B_s - L_0^r g θ in N m for small rotations, shape (n,); zero in contact."""
    return _weight(properties, side) - properties.l0r * GRAVITY * rotation


def element_resistance(properties: RockingProperties, side: NDArray[np.integer], force: Array) -> Array:
    """Return s F r of each element in N m for small rotations, shape (n, E); zero in contact, but for ties."""
    arms = [np.array([each.arm(properties.pivot(way).arm, way) for each in properties.elements]) for way in (1, -1)]
    ties = np.array([each.cosine * (each.height or 0.0) for each in properties.elements])
    return np.array([ties, ties + arms[0], ties - arms[1]])[side] * force


def large_resistance(
    properties: RockingProperties, side: NDArray[np.integer], rotation: Array, force: Array
) -> tuple[Array, Array]:
    """Return both parts for rotations of any size: s m_tot g B_s cos θ - L_0^r g sin θ, and s F r cos(θ/2)."""
    weight = _weight(properties, side) * np.cos(rotation) - properties.l0r * GRAVITY * np.sin(rotation)
    return weight, element_resistance(properties, side, force) * np.cos(0.5 * rotation)[:, None]


def _weight(properties: RockingProperties, side: NDArray[np.integer]) -> Array:
    return np.array([0.0, properties.pivot(1).weight_moment, -properties.pivot(-1).weight_moment])[side]


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
    if model.springs is None:
        return None
    gravity = GRAVITY + history.vertical_ground_acceleration
    level = np.cos(history.rotation) if model.complete else np.ones(history.rotation.size)  # of the lever arms
    return SpringsResistance(
        level * (history.spring_force @ model.springs.positions),
        -p.l0r * gravity * model.turned(history.rotation),
        history.element_force
        * (np.array([(each.height or 0.0) * each.cosine - each.position for each in p.elements]))
        * level[:, None],
    )


def contact_length(edge_uplift: Array, width: float) -> Array:
    """Return the length in m of a base of a `width` in m below the level of unloaded springs, shape (n,).

    `edge_uplift` is the rise of its left and right edge above this level in m, shape (n, 2).
    """
    left, right = edge_uplift.T
    across = np.abs(right - left)
    down = -np.minimum(left, right)
    share = np.divide(down, across, out=np.where(down > 0.0, 1.0, 0.0), where=across > 0.0)
    return width * np.clip(share, 0.0, 1.0)
