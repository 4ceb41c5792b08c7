"""The quantities computed in every run, for the structure and its floors."""

from rockflex.models import Quantities, RockingModel, floor_quantities, quantities, rotation_by_side

GLOBAL = ("top_displacement", "base_moment", "base_shear", "total_top_displacement", "horizontal_reaction")
FLOORS = ("story_drift", "story_shear", "total_floor_displacement", "floor_acceleration")


def asked_of(model: RockingModel, *, floors: bool = False) -> Quantities:
    """Return the quantities for a run of a model: `GLOBAL`, the rotation to each side, and optionally `FLOORS`.

    The rotations to each side are included if the base is not symmetric. Floor accelerations are not linear functionals
    of the state for large rotations, so for an integrated model they are computed from its history.
    """
    total = quantities(model, GLOBAL)
    if not model.properties.symmetric:
        total = total + rotation_by_side(model)
    if floors and model.properties.floors is not None:
        total = total + floor_quantities(model, model.properties.floors, tracked_of_floors(model))
    return total


def tracked_of_floors(model: RockingModel) -> tuple[str, ...]:
    """Return the names of the floor quantities whose peaks are tracked during a run."""
    return FLOORS[:-1] if model.integrated else FLOORS
