"""What the ground, the base on it and the model must have in common."""

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.modal import FrictionDamper, Ground, RockingProperties, Springs

_SAME = 1e-9  # relative to the half width: positions at the edges may be rounded


def check_base(properties: RockingProperties, ground: Ground) -> None:
    """Check that a structure can stand on the ground.

    Raises
    ------
    InputError
        If a spring is not under the base, the springs are too soft to keep the structure upright, or friction dampers
        hold the base.
    """
    if ground.springs is not None:
        _check_under_base(properties, ground.springs)
        _check_upright(properties, ground.springs)
    if any(isinstance(each, FrictionDamper) and each.force > 0.0 for each in properties.elements):
        what = "slides" if ground.springs is None else "stands on springs"
        raise InputError(
            f"No model has friction dampers under a base that {what}. Use a YieldingDissipator with yield_force = F_0 "
            "and a stiffness far above that of the structure, or leave the ground out.",
            field="elements",
        )


def _check_under_base(properties: RockingProperties, springs: Springs) -> None:
    left, right = (side * properties.half_width - properties.eccentricity for side in (-1, 1))
    margin = _SAME * properties.half_width
    if springs.positions[0] < left - margin or springs.positions[-1] > right + margin:
        raise InputError(
            f"The springs must be under the base, which reaches from {left:.6g} to {right:.6g} m from the axis of the "
            f"masses, but their positions reach from {springs.positions[0]:.6g} to {springs.positions[-1]:.6g} m. Move "
            "them, or use winkler_bed with the half_width and the eccentricity of the structure.",
            field="positions",
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
