"""Models on springs, and models that slide."""

import numpy as np

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.modal import Ground, RockingProperties, Springs
from rockflex.models._elements import elements_of
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._linear import LinearModel
from rockflex.models._sliding import SlidingModel
from rockflex.models._springs import Pose, SpringModel

STABLE = 1e-9  # relative: least stiffness of a base against toppling


def grounded(
    label: str, kept: RockingProperties, ground: Ground, law: ImpactLaw | None, missing_mass: bool
) -> LinearModel:
    """Return the model of a structure on springs, without impact law, or of one that slides.

    Raises
    ------
    InputError
        If the structure topples on its springs under its own weight, or if some but not all springs have infinite
        friction.
    """
    if ground.springs is None:
        given = VVELSimplified() if law is None else law
        if not ground.slides:
            return LinearModel(label, kept, law=given, missing_mass=missing_mass)
        friction = float(np.max(np.asarray(ground.friction)))
        return SlidingModel(label, kept, law=given, missing_mass=missing_mass, friction=friction)
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


def pose_at_rest(label: str, properties: RockingProperties, springs: Springs) -> Pose:
    """Return rotation and heave of a base on springs under its weight and the initial tensions of its elements.

    Raises
    ------
    InputError
        If it topples.
    """
    p = properties
    pulls = [(each.position, each.pull(each.branches[0]).force) for each in elements_of(p)]
    forces = np.array([sum(x * force for x, force in pulls), -p.m_tot * GRAVITY - sum(force for _, force in pulls)])
    pressed = np.ones(springs.n, dtype=bool)
    for _ in range(springs.n):
        levers = np.stack((-springs.positions, np.ones(springs.n)))[:, pressed]
        stiffness = levers * springs.stiffness[pressed] @ levers.T
        stiffness[0, 0] -= p.l0r * GRAVITY
        if not np.linalg.det(stiffness) > STABLE * stiffness[1, 1] * springs.rotational_stiffness:
            break
        rotation, heave = np.linalg.solve(stiffness, forces)
        depth = heave - springs.positions * rotation
        if ((depth < 0.0) == pressed).all():
            return float(rotation), float(heave)
        pressed = depth < 0.0
    raise InputError(
        f"{label} topples on its springs under its own weight: their rotational stiffness of "
        f"{springs.tilting_stiffness:.4g} N m/rad is too small for L_0^r g = {p.l0r * GRAVITY:.4g} N m/rad. Give "
        "stiffer springs, or springs farther from the axis of the masses.",
        field="springs",
    )
