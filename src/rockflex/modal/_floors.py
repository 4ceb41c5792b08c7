"""Displacement and force of each mode at each floor."""

from dataclasses import dataclass
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import dimensions, finite_matrix, finite_vector, mode_count
from rockflex._values import Value, changed


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
        h = finite_vector("floors.heights", heights, "m")
        columns = np.shape(displacement)[1] if dimensions(displacement) == 2 else 1
        u = finite_matrix("floors.displacement", displacement, "m/m", (h.size, columns))
        f = finite_matrix("floors.force", force, "N/m", u.shape)
        u.setflags(write=False)
        f.setflags(write=False)
        vars(self).update(heights=h, displacement=u, force=f)

    @property
    def n_modes(self) -> int:
        """Number of modes n."""
        return self.displacement.shape[1]

    def truncated(self, n_modes: SupportsIndex) -> "FloorModes":
        """Return only the first `n_modes` modes.

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`.
        """
        k = mode_count(n_modes, self.n_modes)
        return changed(self, displacement=self.displacement[:, :k].copy(), force=self.force[:, :k].copy())
