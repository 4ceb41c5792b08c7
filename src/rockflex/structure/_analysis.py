"""Vibration modes of a structure on a fixed base, with displacements and forces at its floors."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    checked_finite_matrix,
    checked_finite_vector,
    checked_mode_count,
    number_of_dimensions,
)
from rockflex.foundation.errors import InputError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.matrices import checked_heights, checked_mass, checked_stiffness, mass_times
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.values import Value, with_changed_fields

# A participation below this fraction of the largest possible one is rounding error of the eigenvectors.
NO_PARTICIPATION = 1e-10
_NO_TOP_ORDINATE = 1e-8


@dataclass(frozen=True, eq=False, init=False)
class FloorModes(Value):
    """Displacement and elastic force at every floor per unit of each modal coordinate D_n.

    With q_n = Γ_n D_n (Silva & Stojadinović 2024, Section 2.1) the displacement of floor i relative to the
    base is u_i = Σ_n displacement_in D_n, and the elastic force on it is f_i = Σ_n force_in D_n; the base
    shear is Σ_i f_i, the base moment Σ_i h_i f_i. The arrays are read-only.

    Attributes
    ----------
    heights : ndarray, shape (N,)
        Heights of the floors above the base in m.
    displacement : ndarray, shape (N, n)
        Γ_n φ_in, dimensionless.
    force : ndarray, shape (N, n)
        (M φ_n)_i Γ_n ω_n² in N/m.

    Raises
    ------
    InputError
        If a value is not finite, or the shapes do not match.
    """

    heights: Array
    displacement: Array
    force: Array

    def __init__(self, heights: ArrayLike, displacement: ArrayLike, force: ArrayLike) -> None:
        h = checked_finite_vector("floors.heights", heights, "m")
        columns = np.shape(displacement)[1] if number_of_dimensions(displacement) == 2 else 1
        u = checked_finite_matrix("floors.displacement", displacement, "m/m", (h.size, columns))
        f = checked_finite_matrix("floors.force", force, "N/m", u.shape)
        u.setflags(write=False)
        f.setflags(write=False)
        vars(self).update(heights=h, displacement=u, force=f)

    @property
    def n_modes(self) -> int:
        """Number of modes n."""
        return self.displacement.shape[1]

    @property
    def story_heights(self) -> Array:
        """Heights of the floors above those below them, (N,) in m; positive where they stand one above another."""
        return np.diff(self.heights, prepend=0.0)

    def truncated(self, n_modes: SupportsIndex) -> "FloorModes":
        """Return only the first `n_modes` modes.

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`.
        """
        k = checked_mode_count(n_modes, self.n_modes)
        return with_changed_fields(self, displacement=self.displacement[:, :k].copy(), force=self.force[:, :k].copy())


@dataclass(frozen=True, eq=False)
class ModalProperties(HtmlTable, Value):
    """Vibration modes of a structure on a fixed base, in ascending order of frequency.

    The quantities are defined in Silva & Stojadinović 2024, Section 2.1 (after Eq. 12), with
    L_n^h = ι^T M φ_n, L_n^θ = h^T M φ_n and M_n = φ_n^T M φ_n. The arrays are read-only.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        Circular frequencies ω_n in rad/s.
    effective_mass : ndarray, shape (n,)
        m*_n = (L_n^h)²/M_n in kg; zero for a mode without horizontal participation.
    effective_height : ndarray, shape (n,)
        h*_n = L_n^θ/L_n^h in m, negative if base shear and base moment have opposite signs. Without
        horizontal participation (L_n^h = 0) it is infinite if L_n^θ ≠ 0, and NaN if L_n^θ = 0 as well.
    participation : ndarray, shape (n,)
        Γ_n = L_n^h/M_n for the normalisation of `shapes`.
    shapes : ndarray, shape (N, n)
        Mode shapes φ_n as columns. The top ordinate is 1; if the top does not move (less than 1e-8 of
        the largest ordinate), the largest ordinate is 1.
    heights : ndarray, shape (N,)
        Heights of the masses above the base in m.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> modes = frame.modal()
    >>> modes.omega.round(2)
    array([ 6.28, 18.34, 28.91, 37.14, 42.36])
    >>> modes.truncated(2).effective_height.round(2)
    array([10.54, -3.61])
    """

    omega: Array
    effective_mass: Array
    effective_height: Array
    participation: Array
    shapes: Array
    heights: Array

    def _shown_as(self) -> Mapping[str, Any]:
        columns = ("period", "omega", "effective_mass", "effective_height", "participation")
        return {"n_modes": self.n_modes, **{name: getattr(self, name) for name in columns}}

    @property
    def n_modes(self) -> int:
        """Number of modes n."""
        return self.omega.size

    @property
    def period(self) -> Array:
        """Natural periods T_n = 2π/ω_n in s, shape (n,)."""
        return 2.0 * np.pi / self.omega

    def truncated(self, n_modes: SupportsIndex) -> "ModalProperties":
        """Return only the first `n_modes` modes.

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`.
        """
        k = checked_mode_count(n_modes, self.n_modes)
        return replace(
            self,
            omega=self.omega[:k],
            effective_mass=self.effective_mass[:k],
            effective_height=self.effective_height[:k],
            participation=self.participation[:k],
            shapes=self.shapes[:, :k],
        )


@explaining_overflow("The modes of the given mass and stiffness")
def modal_properties(
    mass: ArrayLike, stiffness: ArrayLike, heights: ArrayLike, n_modes: SupportsIndex | None = None
) -> ModalProperties:
    """Return the modes K φ_n = ω_n² M φ_n and their participation in base shear and base moment.

    With K = C C^T and M = L L^T (Cholesky) the frequencies are the singular values of C^T L^-T. This preserves
    their accuracy if light and heavy masses are mixed, unlike the eigenvalues of the product.

    Parameters
    ----------
    mass : array_like, shape (N,) or (N, N)
        Masses, or symmetric positive definite mass matrix M, in kg, excluding the base.
    stiffness : array_like, shape (N, N)
        Symmetric positive definite lateral stiffness K in N/m on a fixed base.
    heights : array_like, shape (N,)
        Heights h of the masses above the base in m, strictly increasing; the last one is the top.
    n_modes : int, optional
        Number of modes to return, the lowest first. Default: all N.

    Returns
    -------
    ModalProperties

    Raises
    ------
    InputError
        If the shapes do not match, the heights do not increase, a matrix is not symmetric positive definite, a value
        is not finite, or `n_modes` is not from 1 to N.

    References
    ----------
    Silva & Stojadinović 2024, Section 2.1: the definitions after Eq. 12.

    Examples
    --------
    >>> import rockflex as rf
    >>> modes = rf.modal_properties(mass=[20e3, 20e3],
    ...     stiffness=[[8e6, -4e6], [-4e6, 4e6]], heights=[3.0, 6.0])
    >>> modes.period.round(3)
    array([0.719, 0.275])
    >>> modes.effective_mass.round()
    array([37889.,  2111.])
    """
    h = checked_heights(heights)
    m = checked_mass(mass, h.size)
    k = checked_stiffness(stiffness, h.size)
    n = checked_mode_count(n_modes, h.size)

    omega, shapes = _mass_normalised_modes(m, k)
    omega, shapes = omega[:n], shapes[:, :n]
    moved = mass_times(m, shapes)
    total, inertia = float(mass_times(m, np.ones_like(h)).sum()), float(h @ mass_times(m, h))
    return modal_properties_of_modes(omega, moved.sum(axis=0), h @ moved, total, inertia, h, shapes)


def modal_properties_of_modes(
    omega: Array, shear: Array, moment: Array, mass: float, inertia: float, heights: Array, shapes: Array
) -> ModalProperties:
    """Return mass-normalised modes with a top ordinate of 1; arguments as in `MassNormalisedModes`."""
    no_shear = np.abs(shear) <= NO_PARTICIPATION * np.sqrt(mass)
    no_moment = np.abs(moment) <= NO_PARTICIPATION * np.sqrt(inertia)
    shear = np.where(no_shear, 0.0, shear)
    height = np.where(no_moment, np.nan, np.copysign(np.inf, moment))
    np.divide(moment, shear, out=height, where=~no_shear)

    scale = _normalising_ordinates(shapes)
    return ModalProperties(
        omega=omega,
        effective_mass=shear**2,
        effective_height=height,
        participation=shear * scale,
        shapes=shapes / scale,
        heights=heights,
    )


def _mass_normalised_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    factor = np.linalg.cholesky(stiffness).T
    if mass.ndim == 1:
        root = np.sqrt(mass)
        _, omega, vectors = np.linalg.svd(factor / root)
        shapes: Array = vectors.T / root[:, None]
    else:
        root = np.linalg.cholesky(mass)
        _, omega, vectors = np.linalg.svd(np.linalg.solve(root, factor.T).T)
        shapes = np.asarray(np.linalg.solve(root.T, vectors.T), dtype=np.float64)
    if not omega[-1] > omega.size * np.finfo(float).eps * omega[0]:
        raise InputError(
            f"The frequencies span too wide a range for a modal analysis: {omega[-1]:.3g} to {omega[0]:.3g} "
            "rad/s. Condense nearly massless floors out of the matrices first."
        )
    return omega[::-1].copy(), shapes[:, ::-1]


def _normalising_ordinates(shapes: Array) -> Array:
    """Return the divisor of each mode: its top ordinate, or its largest ordinate if the top hardly moves."""
    magnitude = np.abs(shapes)
    largest = shapes[magnitude.argmax(axis=0), np.arange(shapes.shape[1])]
    scale = np.where(magnitude[-1] > _NO_TOP_ORDINATE * np.abs(largest), shapes[-1], largest)
    return np.where(scale == 0.0, 1.0, scale)  # a mode may displace no station
