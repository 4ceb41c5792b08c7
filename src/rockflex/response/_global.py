"""What every run is asked for, of the structure and of its floors."""

from rockflex.models import Quantities, RockingModel, floor_quantities, quantities, rotation_by_side

GLOBAL = ("top_displacement", "base_moment", "base_shear", "total_top_displacement", "horizontal_reaction")
FLOORS = ("story_drift", "story_shear", "total_floor_displacement", "floor_acceleration")


def asked_of(model: RockingModel, *, floors: bool = False) -> Quantities:
    """Return what a run of a model is asked for: `GLOBAL`, the rotation to each side, and `FLOORS` if wanted.

    The rotations are asked for where the base is not the same to both sides. Accelerations of the floors are no
    linear functionals in large rotations, and come from the history of an integrated model.
    """
    total = quantities(model, GLOBAL)
    if not model.properties.symmetric:
        total = total + rotation_by_side(model)
    if floors and model.properties.floors is not None:
        total = total + floor_quantities(model, model.properties.floors, tracked_of_floors(model))
    return total


def tracked_of_floors(model: RockingModel) -> tuple[str, ...]:
    """Names of the floors' quantities whose peaks a run tracks."""
    return FLOORS[:-1] if model.integrated else FLOORS
