"""A structure given by its matrices."""

from dataclasses import dataclass
from functools import cached_property
from typing import SupportsIndex

from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import damping_ratios, positive
from rockflex._matrices import checked_heights, checked_mass, checked_stiffness
from rockflex._values import Value
from rockflex.modal import ModalProperties, RockingProperties, modal_properties, rocking_properties


@dataclass(frozen=True, eq=False, init=False)
class LumpedStructure(Value):
    """Any linear structure with N masses above a rigid base that can rock.

    Its degrees of freedom are the horizontal displacements of the masses relative to the base (Silva & Stojadinović
    2024, Fig. 1 and Eq. 1); all others must be condensed out. Sequences become read-only arrays. The modes are
    computed once, when they are first needed.

    Attributes
    ----------
    masses : ndarray, shape (N,) or (N, N)
        Masses, or symmetric positive definite mass matrix, in kg, excluding the base.
    stiffness : ndarray, shape (N, N)
        Symmetric positive definite stiffness in N/m on a fixed base.
    heights : ndarray, shape (N,)
        Heights of the masses above the base in m, positive and strictly increasing.
    base_mass : float
        Mass m_0 of the base in kg, zero or positive.
    half_width : float
        Half-width B of the base in m.
    damping_ratio : ndarray, shape (N,)
        Damping ratio of each mode in [0, 1); a single number applies to all modes.

    Raises
    ------
    InputError
        If the shapes do not match, a value is not finite or outside its range, the heights do not increase, or a
        matrix is not symmetric positive definite.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.LumpedStructure(
    ...     masses=[20e3, 20e3], stiffness=[[8e6, -4e6], [-4e6, 4e6]], heights=[3.0, 6.0],
    ...     base_mass=20e3, half_width=0.6, damping_ratio=0.02,
    ... )
    >>> structure.modal().period.round(3)
    array([0.719, 0.275])
    >>> structure.rocking(1).effective_height.round(3)
    array([4.854])
    """

    masses: Array
    stiffness: Array
    heights: Array
    base_mass: float
    half_width: float
    damping_ratio: Array

    def __init__(
        self,
        masses: ArrayLike,
        stiffness: ArrayLike,
        heights: ArrayLike,
        *,
        base_mass: float,
        half_width: float,
        damping_ratio: ArrayLike,
    ) -> None:
        h = checked_heights(heights)
        vars(self).update(
            masses=checked_mass(masses, h.size, field="masses"),
            stiffness=checked_stiffness(stiffness, h.size),
            heights=h,
            base_mass=positive("base_mass", base_mass, "kg", zero=True),
            half_width=positive("half_width", half_width, "m"),
            damping_ratio=damping_ratios("damping_ratio", damping_ratio, h.size),
        )

    @property
    def height(self) -> float:
        """Height of the top mass above the base in m."""
        return float(self.heights[-1])

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base (default: all N).

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to N.
        """
        return self._modes if n_modes is None else self._modes.truncated(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes (default: all).

        Modes that contribute neither to the base shear nor to the base moment are left out and not counted.

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`, or one of them contributes only to the base moment.
        """
        return self._rocking if n_modes is None else self._with_modes(n_modes)

    @cached_property
    def _modes(self) -> ModalProperties:
        return modal_properties(self.masses, self.stiffness, self.heights)

    @cached_property
    def _rocking(self) -> RockingProperties:
        return self._with_modes(None)

    def _with_modes(self, n_modes: SupportsIndex | None) -> RockingProperties:
        return rocking_properties(
            self._modes,
            self.masses,
            self.heights,
            self.base_mass,
            self.half_width,
            self.damping_ratio,
            n_modes,
        )
