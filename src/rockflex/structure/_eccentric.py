"""A structure that does not stand in the middle of its base."""

from dataclasses import dataclass, replace
from typing import SupportsIndex

from rockflex._checks import finite
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import ModalProperties, RockingProperties
from rockflex.structure._based import Based, is_structure


@dataclass(frozen=True, init=False)
class Eccentric:
    """A structure whose masses lie on an axis beside the middle of its base.

    It turns about the right edge of the base at the distance B - e from the axis, and about the left one at B + e:
    inertia and resisting moment differ from side to side, and the base lifts sooner where it is short of weight. The
    modes on a fixed base stay as they are. A structure known by its `RockingProperties` alone takes its `eccentricity`
    there.

    Attributes
    ----------
    structure
        Any structure: a `Frame`, a `TaperedTower`, a `Restrained` one ...
    eccentricity : float
        How far the axis stands to the right of the middle of the base, in m; smaller than half its width, to either
        side.

    Raises
    ------
    InputError
        If the eccentricity is no number or not within the base, or `structure` is none.
    """

    structure: Based
    eccentricity: float

    def __init__(self, structure: Based, eccentricity: float) -> None:
        if not is_structure(structure):
            raise InputError(
                f"structure must be a structure such as a Frame, but {shown(structure)} was given. RockingProperties "
                "take their eccentricity themselves: RockingProperties(..., eccentricity=...).",
                field="structure",
            )
        vars(self).update(structure=structure, eccentricity=finite("eccentricity", eccentricity, "m"))
        self.rocking(1)  # whether the axis stands within the base, and tendons do

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base, or all of them."""
        return self.structure.modal(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes, or with all."""
        return replace(self.structure.rocking(n_modes), eccentricity=self.eccentricity)
