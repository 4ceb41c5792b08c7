"""A structure whose base is held down by tendons."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import SupportsIndex

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import ModalProperties, RockingProperties, Tendon, tendon_set
from rockflex.structure._based import Based, is_structure


@dataclass(frozen=True, init=False)
class Restrained:
    """A structure whose base is held down by unbonded post-tensioned tendons.

    They raise the resisting moment and give the rotation a restoring stiffness (Silva & Stojadinović 2024, Section
    4.1); modes on a fixed base stay as they are. A structure known by its `RockingProperties` alone takes `tendons`
    there.

    Attributes
    ----------
    structure
        Any structure: a `Frame`, a `TaperedTower`, an `Eccentric` one ...
    tendons : tuple of Tendon
        Where and how many you like, within the base.

    Raises
    ------
    InputError
        If a tendon stands outside the base, or `structure` is none.
    """

    structure: Based
    tendons: tuple[Tendon, ...]

    def __init__(self, structure: Based, tendons: Tendon | Iterable[Tendon]) -> None:
        if not is_structure(structure):
            raise InputError(
                f"structure must be a structure such as a Frame, but {shown(structure)} was given. RockingProperties "
                "take their tendons themselves: RockingProperties(..., tendons=...).",
                field="structure",
            )
        vars(self).update(structure=structure, tendons=tendon_set(tendons))
        self.rocking(1)  # whether they stand within the base

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base, or all of them."""
        return self.structure.modal(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes, or with all."""
        return replace(self.structure.rocking(n_modes), tendons=self.tendons)
