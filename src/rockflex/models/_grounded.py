"""Models on springs, and models that slide."""

import numpy as np

from rockflex._errors import InputError
from rockflex.modal import Ground, RockingProperties
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._linear import LinearModel
from rockflex.models._rest_on_springs import pose_at_rest
from rockflex.models._sliding import SlidingModel
from rockflex.models._springs import SpringModel


def grounded(
    label: str, kept: RockingProperties, ground: Ground, law: ImpactLaw | None, missing_mass: bool
) -> LinearModel:
    """Return the model of a structure on springs, without impact law, or of one that slides.

    Raises
    ------
    InputError
        If the structure topples on its springs under its own weight, or some but not all springs have infinite
        friction.
    """
    if ground.springs is None:
        friction = float(np.max(np.asarray(ground.friction)))
        return SlidingModel(label, kept, law=law or VVELSimplified(), missing_mass=missing_mass, friction=friction)
    friction = None
    if ground.slides:
        friction = np.broadcast_to(np.asarray(ground.friction, dtype=np.float64), ground.springs.n).copy()
        if not np.isfinite(friction).all():
            raise InputError(
                "friction must be finite for all springs or infinite for all, since a base slides on all of them at "
                f"once, but {friction.tolist()} was given.",
                field="friction",
            )
    return SpringModel(
        label,
        kept,
        missing_mass=missing_mass,
        springs=ground.springs,
        inertia=kept.translational_inertia + float(ground.base_inertia or 0.0),
        friction=friction,
        rest=pose_at_rest(label, kept, ground.springs),
    )
