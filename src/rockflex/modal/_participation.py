"""Modal and rocking properties from mass-normalised modes, for any kind of degrees of freedom."""

from dataclasses import dataclass
from typing import SupportsIndex

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._checks import mode_count
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.modal._analysis import ModalProperties, participating
from rockflex.modal._floors import FloorModes
from rockflex.modal._rocking import RockingProperties


@dataclass(frozen=True, eq=False)
class MassNormalisedModes(Value):
    """Modes with φ_n^T M φ_n = 1, and the inertia of the structure as a rigid body.

    Here ι are the displacements due to a unit translation of the base, and r those due to a unit rotation (the
    height for a horizontal degree of freedom, 1 for a rotation). With them the sums of Silva & Stojadinović 2024,
    Section 2.1, apply to any structure, with lumped or distributed mass.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        Circular frequencies in rad/s, in ascending order.
    shear : ndarray, shape (n,)
        L_n^h = ι^T M φ_n in √kg.
    moment : ndarray, shape (n,)
        L_n^θ = r^T M φ_n in √kg m.
    heights : ndarray, shape (S,)
        Heights of the stations above the base in m, strictly increasing; the last one is the top.
    ordinates : ndarray, shape (S, n)
        φ_n at the stations.
    forces : ndarray, shape (S, n), or None
        Forces at the stations that are statically equivalent to M φ_n; None if they are not known.
    mass : float
        ι^T M ι in kg, excluding the base.
    first_moment : float
        L_0^r = r^T M ι in kg m.
    inertia : float
        r^T M r in kg m².
    rotary : float
        Rotary inertia in kg m² that rotates with the base but is not included in the modes.
    """

    omega: Array
    shear: Array
    moment: Array
    heights: Array
    ordinates: Array
    forces: Array | None
    mass: float
    first_moment: float
    inertia: float
    rotary: float = 0.0

    @computable("The participation of the modes")
    def modal(self) -> ModalProperties:
        """Return the modes, normalised to a top ordinate of 1."""
        above = self.heights > 0.0
        stations, shapes = self.heights[above], self.ordinates[above]
        return participating(self.omega, self.shear, self.moment, self.mass, self.inertia, stations, shapes)

    @computable("The inertia of the structure with this base")
    def rocking(
        self, base_mass: float, half_width: float, zeta: Array, n_modes: SupportsIndex | None
    ) -> RockingProperties:
        """Return the parameters on a base that can rock; `zeta` contains one damping ratio per mode.

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`, or one of them contributes only to the base moment.
        """
        modal = self.modal()
        kept = modes_that_take_part(modal, n_modes)
        shear, omega = self.shear[kept], self.omega[kept]
        displacement = self.ordinates[:, kept] * shear
        floors = None
        if self.forces is not None:
            floors = FloorModes(self.heights, displacement, self.forces[:, kept] * shear * omega**2)
        m_tot = self.mass + base_mass
        return RockingProperties(
            omega=omega,
            effective_mass=modal.effective_mass[kept],
            effective_height=modal.effective_height[kept],
            top_ordinate=displacement[-1],
            i_theta=self.inertia + self.rotary + m_tot * half_width**2,
            l0r=self.first_moment,
            m_tot=m_tot,
            half_width=half_width,
            zeta=zeta[kept],
            translational_inertia=self.inertia,
            floors=floors,
            top_height=float(self.heights[-1]),
            base_mass=base_mass,
        )


def modes_that_take_part(modal: ModalProperties, n_modes: SupportsIndex | None) -> NDArray[np.intp]:
    """Return the indices of the first `n_modes` modes that are excited by the ground or the rotation.

    Raises
    ------
    InputError
        If there are fewer such modes, or one of them contributes to the base moment but not to the base shear.
    """
    take_part = np.flatnonzero(~np.isnan(modal.effective_height))
    kept = take_part[: mode_count(n_modes, take_part.size)]
    rotation_only = kept[np.isinf(modal.effective_height[kept])]
    if rotation_only.size:
        mode = int(rotation_only[0])
        below = int(np.sum(kept < mode))
        remedy = f", or keep only the modes below it (n_modes={below})." if below else "."
        raise InputError(
            f"Mode {mode + 1} ({modal.omega[mode]:.6g} rad/s) contributes to the base moment but not to the "
            "base shear, so it has no modal coordinate D_n. Change a mass or a stiffness slightly"
            f"{remedy}"
        )
    return kept
