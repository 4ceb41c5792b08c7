"""A structure placed off the middle of its base."""

from dataclasses import dataclass
from typing import Any

from rockflex._checks import finite
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.structure._based import Based, Modified, is_structure


@dataclass(frozen=True, init=False)
class Eccentric(Modified):
    """A structure whose masses lie on a vertical axis off the middle of its base.

    It rotates about the right edge of the base, at a distance B - e from the axis, or about the left edge, at B + e.
    Inertia and resisting moment differ between the two sides, and the base lifts sooner about the nearer edge. The
    modes on a fixed base do not change. For a structure given only by its `RockingProperties`, set `eccentricity`
    there.

    Attributes
    ----------
    structure
        Any structure: a `Frame`, a `TaperedTower`, a `Restrained` one ...
    eccentricity : float
        Distance e of the axis to the right of the middle of the base in m; negative to the left. Its magnitude is
        smaller than B.

    Raises
    ------
    InputError
        If the eccentricity is not a number or not within the base, or `structure` is not a structure.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> props = rf.Eccentric(frame, eccentricity=0.2).rocking()
    >>> round(props.pivot(1).arm, 3), round(props.pivot(-1).arm, 3)
    (1.118, 1.518)
    """

    structure: Based
    eccentricity: float

    def __init__(self, structure: Based, eccentricity: float) -> None:
        if not is_structure(structure):
            raise InputError(
                f"structure must be a structure such as a Frame, but {shown(structure)} was given. RockingProperties "
                "have an eccentricity of their own: RockingProperties(..., eccentricity=...).",
                field="structure",
            )
        vars(self).update(structure=structure, eccentricity=finite("eccentricity", eccentricity, "m"))
        self.rocking(1)  # checks that the axis and the tendons are within the base

    def _changes(self) -> dict[str, Any]:
        return {"eccentricity": self.eccentricity}
