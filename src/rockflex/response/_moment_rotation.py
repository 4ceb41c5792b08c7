"""The quasi-static moment of a base over a path of its rotation."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._shown import counted
from rockflex.response._resistance import element_resistance, weight_resistance
from rockflex.response._static_path import StaticPath

if TYPE_CHECKING:
    import pandas as pd


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
            f"MomentRotation({self.rotation.size} points, {counted(len(self.elements), 'element')}, "
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
