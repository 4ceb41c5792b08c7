"""The quantities computed in every run, for the structure and its floors."""

import numpy as np

from rockflex._arrays import Array
from rockflex.modal import ViscousDamper
from rockflex.models import (
    Quantities,
    RockingModel,
    SpringModel,
    element_moves,
    element_speeds,
    floor_quantities,
    quantities,
    rotation_by_side,
    swing_by_side,
    values_of,
)

GLOBAL = ("top_displacement", "base_moment", "base_shear", "total_top_displacement", "horizontal_reaction")
EDGES = ("right_uplift", "right_settlement", "left_uplift", "left_settlement", "right_rotation", "left_rotation")
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
    if model.layout.slip >= 0:
        total = total + quantities(model, ("slip",))
    if isinstance(model, SpringModel):
        total = total + element_speeds(model)
    if floors and model.properties.floors is not None:
        total = total + floor_quantities(model, model.properties.floors, tracked_of_floors(model))
    return total


def extremes_of(model: RockingModel) -> Quantities | None:
    """Return the quantities of which only the largest value matters: `EDGES` of a base on springs, and its elements.

    Those are the elongation of each element and its negative.
    """
    if not isinstance(model, SpringModel):
        return None
    p = model.properties
    edges = p.pivot(1).arm, -p.pivot(-1).arm
    signs = np.array([1.0, -1.0, 1.0, -1.0, 0.0, 0.0])
    turns = [-edges[0], edges[0], -edges[1], edges[1], 1.0, -1.0]
    of_edges = Quantities.of(len(EDGES), p.n_modes, heave=signs, rotation=turns)
    return of_edges + element_moves(model)


def global_histories(model: RockingModel, states: Array) -> Array:
    """Return the values of `GLOBAL` at the states of a history: read-only, shape (n_states, 5)."""
    values = values_of(model, quantities(model, GLOBAL), states)
    values.setflags(write=False)
    return values


def is_sided(model: RockingModel) -> bool:
    """Return whether the largest rotation to each side matters on rigid ground, rather than the larger of both."""
    if isinstance(model, SpringModel):
        return False
    return not model.properties.symmetric or any(each.position != 0.0 for each in model.properties.elements)


def is_damped(model: RockingModel) -> bool:
    """Return whether viscous dampers act on a base that can lift."""
    return (
        not isinstance(model, SpringModel)
        and model.lifts
        and any(isinstance(each, ViscousDamper) for each in model.properties.elements)
    )


def tracked_of_floors(model: RockingModel) -> tuple[str, ...]:
    """Return the names of the floor quantities whose peaks are tracked during a run."""
    return FLOORS[:-1] if model.integrated else FLOORS
