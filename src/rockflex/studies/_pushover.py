"""Pushover of a structure."""

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.checks import checked_finite_vector, checked_instance, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.models._label import Model
from rockflex.models._rocking_model import RockingModel
from rockflex.response._pushover import Pushover, pushover_path
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import RockingStructure, rocking_properties_of


def pushover(
    structure: RockingStructure | RockingProperties,
    top_displacement: float,
    *,
    lifts: bool = True,
    pattern: ArrayLike | None = None,
) -> Pushover:
    """Push the floors of a structure slowly to the right, and return its base shear, drifts and what yields when.

    The forces on the floors keep their pattern while the top moves steadily; what yields, slackens or unloads on the
    way is found exactly, since everything is linear in between. With uplift the base rotates about its right edge once
    the forces overcome the weight and the elements, as in Silva & Stojadinović 2024, Eqs. 23 and 24 without inertia.
    Viscous dampers do not act. The way ends where an element breaks.

    Parameters
    ----------
    structure
        A structure with floors, such as a `Frame`, a `YieldingStories` or a `Restrained` one, or its
        `RockingProperties`.
    top_displacement
        Displacement of the highest floor relative to the ground in m to which it is pushed, positive.
    lifts
        Whether the base may lift, as it can in every structure; False for a fixed base, as a `fit` of a superstructure
        needs.
    pattern : array_like, shape (N,), or None
        Forces on the floors, bottom to top; only their ratios matter. Default: those of the first mode, M φ_1.

    Returns
    -------
    Pushover
        Its `fit` gives the bilinear curve of equal energy, and the `BoucWen` superstructure of a 2DOF-S-BW model.

    Raises
    ------
    InputError
        If the structure has no floors, the displacement is not positive, or the pattern has no sum to the right.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=0.6, aspect_ratio=6.0, damping_ratio=0.03,
    ... )
    >>> push = rf.pushover(rf.YieldingStories(frame, [150e3, 120e3, 70e3], 0.05),
    ...     top_displacement=0.1, lifts=False)
    >>> [(each.name, round(each.base_shear / 1e3)) for each in push.events]
    [('story 2 yields', 150), ('story 1 yields', 150), ('story 3 yields', 157)]
    >>> round(push.fit().bouc_wen.yield_displacement, 4)
    0.0126
    """
    target = checked_positive("top_displacement", top_displacement, "m")
    properties = rocking_properties_of(structure)
    floors = properties.floors
    if floors is None:
        raise InputError(
            "pushover needs a structure with floors and modes, but this one has none. Give RockingProperties the "
            "floors (FloorModes), or use a structure with floors, such as a Frame.",
            field="structure",
        )
    forces = floors.force[:, 0] if pattern is None else checked_finite_vector("pattern", pattern, "N")
    if forces.size != floors.heights.size or not forces.sum() > 0.0:
        raise InputError(
            f"pattern must have one force for each of the {floors.heights.size} floors, with a positive sum, but "
            f"{shown(pattern)} was given.",
            field="pattern",
        )
    if lifts and properties.joints:
        raise InputError(
            "pushover has no joints above the base that open. Give lifts=False for the structure on a fixed base, or "
            "the structure without its joints.",
            field="structure",
        )
    held = 1 not in properties.sides  # by a wall behind it
    model = Model(lifts=checked_instance("lifts", lifts, bool) and not held).of(properties)
    assert isinstance(model, RockingModel)
    return pushover_path(model, np.asarray(forces / forces.sum()), target, floors)
