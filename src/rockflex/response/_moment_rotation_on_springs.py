"""The quasi-static moment of a base on springs over a path of its rotation."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._shown import counted
from rockflex.modal import Springs
from rockflex.response._pressure import pressure_of
from rockflex.response._static_path import StaticPath

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
            f"MomentRotationOnSprings({self.rotation.size} points, {counted(self.springs.n, 'spring')}, "
            f"{counted(len(self.elements), 'element')}, |θ| up to {largest:.4g} rad, |M| up to {peak:.4g} N m)"
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
