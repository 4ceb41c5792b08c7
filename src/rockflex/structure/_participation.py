"""Rocking parameters of a structure from its modes, for any kind of degrees of freedom."""

from dataclasses import dataclass
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_damping_ratios, checked_instance, checked_mode_count, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.matrices import checked_heights, checked_mass, mass_times
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.values import Value
from rockflex.structure._analysis import FloorModes, ModalProperties, modal_properties_of_modes
from rockflex.structure._rocking import RockingProperties


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

    @explaining_overflow("The participation of the modes")
    def modal(self) -> ModalProperties:
        """Return the modes, normalised to a top ordinate of 1."""
        above = self.heights > 0.0
        stations, shapes = self.heights[above], self.ordinates[above]
        return modal_properties_of_modes(self.omega, self.shear, self.moment, self.mass, self.inertia, stations, shapes)

    @explaining_overflow("The inertia of the structure with this base")
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
        kept = excited_mode_indices(modal, n_modes)
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


def excited_mode_indices(modal: ModalProperties, n_modes: SupportsIndex | None) -> NDArray[np.intp]:
    """Return the indices of the first `n_modes` modes that are excited by the ground or the rotation.

    Raises
    ------
    InputError
        If there are fewer such modes, or one of them contributes to the base moment but not to the base shear.
    """
    take_part = np.flatnonzero(~np.isnan(modal.effective_height))
    kept = take_part[: checked_mode_count(n_modes, take_part.size)]
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


@explaining_overflow("The inertia of the structure with this base")
def rocking_properties(
    modal: ModalProperties,
    mass: ArrayLike,
    heights: ArrayLike,
    base_mass: float,
    half_width: float,
    damping_ratio: ArrayLike,
    n_modes: SupportsIndex | None = None,
) -> RockingProperties:
    """Return the parameters of the structure on a base that can rock.

    With the mass matrix M, the heights h, a vector of ones ι and the mass of the base m_0:
    I_θ = h^T M h + m_tot B², m_tot = ι^T M ι + m_0, L_0^r = ι^T M h.

    A mode that contributes neither to the base shear nor to the base moment (L_n^h = L_n^θ = 0) is excited neither
    by the ground nor by the rotation, and is left out. A mode with L_n^h = 0 and L_n^θ ≠ 0 is excited by the
    rotation but has no coordinate D_n = q_n/Γ_n, so Eq. 14 cannot represent it: this is an error.

    Parameters
    ----------
    modal : ModalProperties
        Modes of the structure on a fixed base.
    mass : array_like, shape (N,) or (N, N)
        The masses, or the mass matrix, that `modal` was computed with, in kg.
    heights : array_like, shape (N,)
        The heights that `modal` was computed with, in m.
    base_mass : float
        Mass m_0 of the base in kg, zero or positive.
    half_width : float
        Half-width B of the base in m.
    damping_ratio : array_like
        Damping ratio in [0, 1): one number for all modes, or one per mode of `modal`.
    n_modes : int, optional
        Number of modes to retain, the lowest first, not counting modes that are not excited. Default: all.

    Returns
    -------
    RockingProperties
        Properties that include `floors`.

    Raises
    ------
    InputError
        If an argument is outside its range or does not match `modal`, or a mode has no coordinate D_n.

    References
    ----------
    Silva & Stojadinović 2024, Table 2 and Eqs. 13 and 14.

    Examples
    --------
    >>> import rockflex as rf
    >>> mass, heights = [20e3, 20e3], [3.0, 6.0]
    >>> stiffness = [[8e6, -4e6], [-4e6, 4e6]]
    >>> modes = rf.modal_properties(mass, stiffness, heights)
    >>> props = rf.rocking_properties(modes, mass, heights, base_mass=20e3,
    ...     half_width=0.6, damping_ratio=0.02)
    >>> round(props.resisting_moment)
    353160
    """
    h = checked_heights(heights)
    if not np.array_equal(h, checked_instance("modal", modal, ModalProperties).heights):
        raise InputError(
            f"heights must equal the heights of the modal analysis, {modal.heights}, but {h} was given. "
            "Call modal_properties again for other heights.",
            field="heights",
        )
    m = checked_mass(mass, h.size)
    base = checked_positive("base_mass", base_mass, "kg", zero=True)
    b = checked_positive("half_width", half_width, "m")
    zeta = checked_damping_ratios("damping_ratio", damping_ratio, modal.n_modes)
    kept = excited_mode_indices(modal, n_modes)

    m_tot = float(mass_times(m, np.ones_like(h)).sum()) + base
    moved_by_rotation = mass_times(m, h)
    inertia = float(h @ moved_by_rotation)
    displacement = modal.shapes[:, kept] * modal.participation[kept]
    omega = modal.omega[kept]
    return RockingProperties(
        omega=omega,
        effective_mass=modal.effective_mass[kept],
        effective_height=modal.effective_height[kept],
        top_ordinate=displacement[-1],
        i_theta=inertia + m_tot * b**2,
        l0r=float(moved_by_rotation.sum()),
        m_tot=m_tot,
        half_width=b,
        zeta=zeta[kept],
        translational_inertia=inertia,
        floors=FloorModes(h, displacement, mass_times(m, displacement) * omega**2),
        base_mass=base,
    )
