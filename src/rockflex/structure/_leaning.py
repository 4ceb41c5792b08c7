"""Structures some of whose mass stands on other columns: weight apart from mass."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite_vector
from rockflex.foundation.descriptions import Described, one_for_each
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.structure._analysis import ModalProperties
from rockflex.structure._frames import LumpedStructure
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import AssembledStructure, InFile, ModifiedStructure, Structure, is_structure


@dataclass(frozen=True, eq=False, init=False)
class Leaning(ModifiedStructure, Value):
    """A structure with leaning mass: floors' mass whose weight stands on other columns, which are hinged.

    A rocking frame, wall or braced bay inside a building carries the inertia of whole floors, but only a part of their
    weight. The leaning mass l_i moves with floor i: it is in the modes on a fixed base, in L_0^r, in Σ m_i h_i² and in
    the destabilising moment L_0^r g θ, since the columns lean as the frame rotates. It is neither in the weight m_tot g
    that resists uplift nor in the vertical inertia: M_r = g B Σ m_i and I_θ = Σ (m_i + l_i) h_i² + B² Σ m_i, with the
    mass of the base in the sums. The push l_i g θ of the columns on the floors themselves is neglected, as m_i g θ is
    in Eq. 23; where l_i exceeds m_i by far, a model with P-Δ of the floors is needed.

    Attributes
    ----------
    structure
        A `Frame`, a `FishBone` or a `LumpedStructure`. Elements and an eccentricity come afterwards:
        ``Restrained(Leaning(frame, masses), elements)``.
    masses : ndarray, shape (N,)
        l_i in kg by floor, bottom to top, zero or positive; a single number applies to all floors.

    Raises
    ------
    InputError
        If `structure` is another one, or the masses are negative or not one for each floor.

    Notes
    -----
    Complete models have no leaning mass: its columns are hinged at the base, and only rotations to first order are
    consistent with that. `RockingProperties.weight_share` is the share of the weight that stands on the base.

    Examples
    --------
    >>> import rockflex as rf
    >>> wall = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=0.0,
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> props = rf.Leaning(wall, masses=60e3).rocking()
    >>> round(props.weight_share, 3), round(
    ...     props.resisting_moment / wall.rocking().resisting_moment, 12)
    (0.444, 1.0)
    """

    in_file = InFile(
        key="leaning_masses",
        words=Described("the mass of each floor that stands on other columns", "kg", form=one_for_each("floor")),
        value=float | list[float],
        argument="masses",
        floors=True,
    )

    structure: Structure
    masses: Array

    def __init__(self, structure: Structure, masses: ArrayLike) -> None:
        lumped = lumped_structure_of(structure)
        count = lumped.heights.size
        given = np.full(count, masses, dtype=float) if np.ndim(masses) == 0 else masses
        found = checked_finite_vector("masses", given, "kg")
        if found.size != count or (found < 0.0).any():
            raise InputError(
                f"masses must be one number in kg, zero or positive, for each of the {count} floors from the bottom to "
                f"the top, but {shown(masses)} was given. Give 0.0 for a floor without leaning mass.",
                field="masses",
            )
        vars(self).update(structure=structure, masses=found)

    def __getstate__(self) -> dict[str, object]:
        return {"structure": self.structure, "masses": self.masses}

    @cached_property
    def _moving(self) -> LumpedStructure:
        """The structure with all mass that moves horizontally."""
        lumped = lumped_structure_of(self.structure)
        mass = lumped.masses + self.masses if lumped.masses.ndim == 1 else lumped.masses + np.diag(self.masses)
        return replace(lumped, masses=mass)

    @cached_property
    def _rocking(self) -> RockingProperties:
        return self._standing(self._moving.rocking())

    def _standing(self, moving: RockingProperties) -> RockingProperties:
        """Take the leaning mass out of what stands on the base."""
        leaning = float(self.masses.sum())
        return replace(
            moving,
            m_tot=moving.m_tot - leaning,
            i_theta=moving.i_theta - leaning * moving.half_width**2,
            leaning_mass=leaning,
        )

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base, with the leaning mass (default: all)."""
        return self._moving.modal(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes (default: all)."""
        return self._rocking if n_modes is None else self._standing(self._moving.rocking(n_modes))


def lumped_structure_of(structure: object) -> LumpedStructure:
    """Return the masses at the floors and the stiffness of a structure."""
    found = structure
    while isinstance(found, AssembledStructure):
        found = found.assembled
    if isinstance(found, LumpedStructure):
        return found
    message = f"structure must be a Frame, a FishBone or a LumpedStructure, but {shown(structure)} was given."
    if isinstance(structure, ModifiedStructure):
        message += " Put leaning mass in first: Restrained(Leaning(frame, masses), elements)."
    elif is_structure(structure):
        message += " Give its condensed stiffness and its masses at the floors to LumpedStructure."
    raise InputError(message, field="structure")
