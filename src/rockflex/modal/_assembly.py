"""Rocking parameters of a structure from its modes."""

from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex._checks import damping_ratios, instance, positive
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._matrices import checked_heights, checked_mass, mass_times
from rockflex.modal._analysis import ModalProperties
from rockflex.modal._floors import FloorModes
from rockflex.modal._participation import modes_that_take_part
from rockflex.modal._rocking import RockingProperties


@computable("The inertia of the structure with this base")
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
    >>> mass, stiffness, heights = [20e3, 20e3], [[8e6, -4e6], [-4e6, 4e6]], [3.0, 6.0]
    >>> modes = rf.modal_properties(mass, stiffness, heights)
    >>> props = rf.rocking_properties(modes, mass, heights, base_mass=20e3, half_width=0.6, damping_ratio=0.02)
    >>> round(props.resisting_moment)
    353160
    """
    h = checked_heights(heights)
    if not np.array_equal(h, instance("modal", modal, ModalProperties).heights):
        raise InputError(
            f"heights must be those of the modal analysis, {modal.heights}, but {h} was given. "
            "Call modal_properties again for other heights.",
            field="heights",
        )
    m = checked_mass(mass, h.size)
    base = positive("base_mass", base_mass, "kg", zero=True)
    b = positive("half_width", half_width, "m")
    zeta = damping_ratios("damping_ratio", damping_ratio, modal.n_modes)
    kept = modes_that_take_part(modal, n_modes)

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
