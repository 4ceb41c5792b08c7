"""A structure with tendons, dissipators and dampers at its base."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import BaseElement, Tendon, element_set
from rockflex.structure._based import Based, Modified, is_structure


@dataclass(frozen=True, init=False)
class Restrained(Modified):
    """A structure with elements between its base and the ground: tendons, dissipators, viscous and friction dampers.

    Unbonded post-tensioned tendons increase the resisting moment and add a restoring rotational stiffness (Silva &
    Stojadinović 2024, Section 4.1); the other elements take energy out of the rocking. The modes on a fixed base do
    not change. For a structure given only by its `RockingProperties`, set `elements` there.

    Attributes
    ----------
    structure
        Any structure: a `Frame`, a `TaperedTower`, an `Eccentric` one ...
    elements : tuple of Tendon, YieldingDissipator, ViscousDamper or FrictionDamper
        Any number of them, at any positions within the base.

    Raises
    ------
    InputError
        If an element is outside the base, or `structure` is not a structure.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> restrained = rf.Restrained(frame, rf.Tendon(initial_force=500e3, stiffness=20e6))
    >>> ratio = restrained.rocking().resisting_moment / frame.rocking().resisting_moment
    >>> round(ratio, 3)
    1.212
    """

    structure: Based
    elements: tuple[BaseElement, ...]

    def __init__(self, structure: Based, elements: BaseElement | Iterable[BaseElement]) -> None:
        if not is_structure(structure):
            raise InputError(
                f"structure must be a structure such as a Frame, but {shown(structure)} was given. RockingProperties "
                "have elements of their own: RockingProperties(..., elements=...).",
                field="structure",
            )
        vars(self).update(structure=structure, elements=element_set(elements))
        self.rocking(1)  # checks that they are within the base

    @property
    def tendons(self) -> tuple[Tendon, ...]:
        """The tendons among the elements."""
        return tuple(each for each in self.elements if isinstance(each, Tendon))

    def _changes(self) -> dict[str, Any]:
        return {"elements": self.elements}
