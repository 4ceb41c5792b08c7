"""Models on springs, and models that slide: what they are made of, and what they demand of the ground."""

import numpy as np

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._elements import elements_of
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._rocking_model import Pose, RockingModel
from rockflex.models._sliding import SlidingModel
from rockflex.models._spring_model import SpringModel
from rockflex.structure._ground import Ground, Springs
from rockflex.structure._rocking import RockingProperties

TURNS = 20  # in which the lever arms of a tilted base are found
STABLE = 1e-9  # relative: least stiffness of a base against toppling
SAME = 1e-9  # relative to the half width: positions at the edges may be rounded


def model_on_ground(
    label: str,
    kept: RockingProperties,
    ground: Ground,
    law: ImpactLaw | None,
    missing_mass: bool,
    *,
    complete: bool = False,
    bouc_wen: BoucWen | None = None,
) -> RockingModel:
    """Return the model of a structure on springs, without impact law, or of one that slides.

    It is nonlinear if it is `complete`, or has the hysteresis `bouc_wen`.

    Raises
    ------
    InputError
        If the structure topples on its springs under its own weight, or some but not all springs have infinite
        friction.
    """
    if ground.springs is None:
        friction = float(np.max(np.asarray(ground.friction)))
        return SlidingModel(
            label,
            kept,
            law=law or VVELSimplified(),
            missing_mass=missing_mass,
            friction=friction,
            complete=complete,
            bouc_wen=bouc_wen,
        )
    friction = None
    if ground.slides:
        friction = np.broadcast_to(np.asarray(ground.friction, dtype=np.float64), ground.springs.n).copy()
        if not np.isfinite(friction).all():
            raise InputError(
                "friction must be finite for all springs or infinite for all, since a base slides on all of them at "
                f"once, but {friction.tolist()} was given.",
                field="friction",
            )
    if ground.springs.capacity is not None and (complete or bouc_wen is not None):
        raise InputError(
            f"{label} has no springs that yield, which simplified, elastic models have. Use MDOF-S or another of "
            "these, or leave the capacity out.",
            field="capacity",
        )
    rest = pose_at_rest(label, kept, ground.springs, complete=complete)
    _check_elastic_at_rest(ground.springs, rest)
    return SpringModel(
        label,
        kept,
        missing_mass=missing_mass,
        springs=ground.springs,
        inertia=kept.translational_inertia + float(ground.base_inertia or 0.0),
        friction=friction,
        rest=rest,
        complete=complete,
        bouc_wen=bouc_wen,
    )


def _check_elastic_at_rest(springs: Springs, rest: Pose) -> None:
    if springs.capacity is None:
        return
    force = np.maximum(springs.stiffness * (springs.positions * rest.rotation - rest.heave), 0.0)
    worst = int(np.argmax(force / springs.capacity))
    if not force[worst] < springs.capacity[worst]:
        raise InputError(
            f"capacity must exceed the forces at rest, but the spring at {springs.positions[worst]:g} m carries "
            f"{force[worst]:.6g} N under the weight, and its capacity is {springs.capacity[worst]:.6g} N. Give a "
            "larger one, or check its unit, N.",
            field="capacity",
        )


def pose_at_rest(label: str, properties: RockingProperties, springs: Springs, *, complete: bool = False) -> Pose:
    """Return rotation and heave of a base on springs under its weight and the initial tensions of its elements.

    In a complete model the tilted structure also bends under its weight, and moments are those of lever arms x cos θ.

    Raises
    ------
    InputError
        If it topples.
    """
    weight, bent = properties.l0r * GRAVITY, 0.0
    if complete:
        bent = float(np.sum(properties.effective_mass / properties.omega**2)) * GRAVITY**2
    pose = _pose_at_rest_on_springs(label, properties, springs, weight + bent)
    for _ in range(TURNS if pose.rotation and complete else 0):
        level = float(np.cos(pose.rotation))
        lean, heave = _pose_at_rest_on_springs(label, properties, springs, weight / level + bent)
        pose = Pose(float(np.arcsin(lean)), heave)
    return pose


def _pose_at_rest_on_springs(label: str, properties: RockingProperties, springs: Springs, toppling: float) -> Pose:
    """Return the pose at rest with a moment of the weight in N m/rad."""
    p = properties
    under = [(each.position, each.tension(each.branches[0]).force) for each in elements_of(p)]
    pulls = [(position, force) for position, force in under if position is not None]
    forces = np.array([sum(x * force for x, force in pulls), -p.m_tot * GRAVITY - sum(force for _, force in pulls)])
    pressed = np.ones(springs.n, dtype=bool)
    for _ in range(springs.n):
        levers = np.stack((-springs.positions, np.ones(springs.n)))[:, pressed]
        stiffness = levers * springs.stiffness[pressed] @ levers.T
        stiffness[0, 0] -= toppling
        if not np.linalg.det(stiffness) > STABLE * stiffness[1, 1] * springs.rotational_stiffness:
            break
        rotation, heave = np.linalg.solve(stiffness, forces)
        depth = heave - springs.positions * rotation
        if ((depth < 0.0) == pressed).all():
            return Pose(float(rotation), float(heave))
        pressed = depth < 0.0
    raise InputError(
        f"{label} topples on its springs under its own weight: their rotational stiffness of "
        f"{springs.tilting_stiffness:.4g} N m/rad is too small for L_0^r g = {p.l0r * GRAVITY:.4g} N m/rad. Give "
        "stiffer springs, or springs farther from the axis of the masses.",
        field="springs",
    )


def check_base_on_ground(properties: RockingProperties, ground: Ground) -> None:
    """Check that a structure can stand on the ground.

    Raises
    ------
    InputError
        If a spring is not under the base, the springs are too soft to keep the structure upright, or friction dampers
        hold the base.
    """
    if ground.springs is not None:
        _check_under_base(properties, ground.springs)
        _check_inertia(properties, float(ground.base_inertia or 0.0))
        _check_upright(properties, ground.springs)
    if any(each.sticks for each in properties.elements):
        what = "slides" if ground.springs is None else "stands on springs"
        raise InputError(
            f"No model has friction dampers under a base that {what}. Use a YieldingDissipator with yield_force = F_0 "
            "and a stiffness far above that of the structure, or leave the ground out.",
            field="elements",
        )


def _check_under_base(properties: RockingProperties, springs: Springs) -> None:
    left, right = (side * properties.half_width - properties.eccentricity for side in (-1, 1))
    margin = SAME * properties.half_width
    if springs.positions[0] < left - margin or springs.positions[-1] > right + margin:
        raise InputError(
            f"The springs must be under the base, which reaches from {left:.6g} to {right:.6g} m from the axis of the "
            f"masses, but their positions reach from {springs.positions[0]:.6g} to {springs.positions[-1]:.6g} m. Move "
            "them, or use winkler_bed with the half_width and the eccentricity of the structure.",
            field="positions",
        )


def _check_inertia(properties: RockingProperties, base_inertia: float) -> None:
    """Raise an InputError if nothing but flexure resists the rotation of the base."""
    p = properties
    own = p.translational_inertia - float(np.sum(p.effective_mass * p.effective_height**2))
    if own + base_inertia <= SAME * p.translational_inertia:
        raise InputError(
            f"A base_inertia of {base_inertia:g} kg m² leaves the base no inertia against rotation: the structure has "
            "all its modes, and no rotary inertia of its own as a rigid_block has. Give that of base and floors; for a "
            "mat of mass m and width 2B it is m (2B)²/12.",
            field="base_inertia",
        )


def _check_upright(properties: RockingProperties, springs: Springs) -> None:
    needed = properties.l0r * GRAVITY
    if springs.tilting_stiffness <= needed:
        raise InputError(
            "The springs are too soft: the structure falls over under its own weight. Their stiffness against tilting "
            f"is {springs.tilting_stiffness:.4g} N m/rad, and must exceed L_0^r g = {needed:.4g} N m/rad. Check the "
            f"unit, N/m, and multiply the stiffness by more than {needed / springs.tilting_stiffness:.3g}.",
            field="stiffness",
        )
