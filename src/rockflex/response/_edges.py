"""How far the base turns, and how far its edges rise above the ground or sink into it."""

from typing import Any, NamedTuple

import numpy as np

from rockflex.modal import Springs
from rockflex.models import RockingModel, SpringModel
from rockflex.solve import Solution


class Edges(NamedTuple):
    """Largest uplift and settlement of the right and of the left edge in m, neither below zero."""

    uplift: tuple[float, float]
    settlement: tuple[float, float]


def edges_of(model: RockingModel, rotation: tuple[float, float], solution: Solution) -> Edges:
    """Return the extremes of the edges of a run, with its largest |θ| to the right and to the left in rad.

    On rigid ground an edge rises by the width of the base times the rotation about the other edge; on springs the peaks
    of `extremes_of` tell, measured from the level at which the springs are unloaded.
    """
    if isinstance(model, SpringModel):
        right_up, right_down, left_up, left_down = (max(value, 0.0) for value in solution.extremes[:4].tolist())
        return Edges((right_up, left_up), (right_down, left_down))
    width = 2.0 * model.properties.half_width
    right, left = rotation
    if model.complete:
        right, left = float(np.sin(right)), float(np.sin(left))
    return Edges((width * left, width * right), (0.0, 0.0))


def springs_of(model: RockingModel) -> Springs | None:
    """Return the springs under the base; None on rigid ground."""
    return model.springs if isinstance(model, SpringModel) else None


def tilt_at_rest(model: RockingModel) -> float:
    """Return the rotation of the base under its weight in rad: zero on rigid ground."""
    return model.rest[0] if isinstance(model, SpringModel) else 0.0


def balance_ratio(model: RockingModel, right: Any, left: Any) -> Any:
    """Return the largest |θ|/α of runs with these largest rotations in rad to the right and to the left."""
    of = model.properties.pivot
    return np.maximum(right / of(1).balance_rotation, left / of(-1).balance_rotation)
