"""The quantities computed in every run, for the structure and its floors."""

from rockflex._arrays import Array
from rockflex.modal import ViscousDamper
from rockflex.models import (
    Quantities,
    RockingModel,
    floor_quantities,
    quantities,
    rotation_by_side,
    swing_by_side,
    values_of,
)

GLOBAL = ("top_displacement", "base_moment", "base_shear", "total_top_displacement", "horizontal_reaction")
FLOORS = ("story_drift", "story_shear", "total_floor_displacement", "floor_acceleration")


def asked_of(model: RockingModel, *, floors: bool = False) -> Quantities:
    """Return the quantities for a run of a model: `GLOBAL`, those of the elements, and optionally `FLOORS`.

    The elements need the rotations to each side if the sides differ, and viscous dampers the velocities. Floor
    accelerations are not linear functionals of the state for large rotations, so for an integrated model they are
    computed from its history.
    """
    total = quantities(model, GLOBAL)
    if is_sided(model):
        total = total + rotation_by_side(model)
    if is_damped(model):
        total = total + swing_by_side(model)
    if floors and model.properties.floors is not None:
        total = total + floor_quantities(model, model.properties.floors, tracked_of_floors(model))
    return total


def global_histories(model: RockingModel, states: Array) -> Array:
    """Return the values of `GLOBAL` at the states of a history: read-only, shape (n_states, 5)."""
    values = values_of(model, quantities(model, GLOBAL), states)
    values.setflags(write=False)
    return values


def is_sided(model: RockingModel) -> bool:
    """Return whether the largest rotation to each side matters, rather than the larger of both."""
    return not model.properties.symmetric or any(each.position != 0.0 for each in model.properties.elements)


def is_damped(model: RockingModel) -> bool:
    """Return whether viscous dampers act on a base that can lift."""
    return model.lifts and any(isinstance(each, ViscousDamper) for each in model.properties.elements)


def tracked_of_floors(model: RockingModel) -> tuple[str, ...]:
    """Return the names of the floor quantities whose peaks are tracked during a run."""
    return FLOORS[:-1] if model.integrated else FLOORS
