"""A structure known by its modes."""

from dataclasses import dataclass
from typing import SupportsIndex

from rockflex._arrays import Array
from rockflex._values import Value
from rockflex.modal import MassNormalisedModes, ModalProperties, RockingProperties


@dataclass(frozen=True, eq=False)
class ModalStructure(Value):
    """A structure given by its modes, as returned by `from_matrices` and `from_modes`.

    Attributes
    ----------
    modes : MassNormalisedModes
        Its modes, except those excited neither by the ground nor by the rotation of the base.
    base_mass : float
        Mass m_0 of the base in kg.
    half_width : float
        Half-width B of the base in m.
    damping_ratio : ndarray, shape (n,)
        Damping ratio of each mode.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.from_matrices(
    ...     mass=[20e3], stiffness=[[4e6]], heights=[3.0], base_mass=20e3, half_width=0.6, damping_ratio=0.02
    ... )
    >>> isinstance(structure, rf.ModalStructure)
    True
    >>> structure.modes.omega.round(3)
    array([14.142])
    """

    modes: MassNormalisedModes
    base_mass: float
    half_width: float
    damping_ratio: Array

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base (default: all).

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the structure's number of modes.
        """
        modes = self.modes.modal()
        return modes if n_modes is None else modes.truncated(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes (default: all).

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`.
        """
        return self.modes.rocking(self.base_mass, self.half_width, self.damping_ratio, n_modes)
