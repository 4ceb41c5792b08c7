"""The forces of the tendons that hold a base down."""

import math

import numpy as np
from numpy.typing import NDArray

from rockflex.models import NonlinearModel, RockingModel

__all__ = ["largest_tendon_force", "stretch_per_arm", "tendon_forces"]

Array = NDArray[np.float64]


def stretch_per_arm(model: RockingModel, turn: Array) -> Array:
    """Elongation over the distance from the pivot, at |θ| in rad: 2 sin(|θ|/2), and |θ| in simplified models."""
    large = isinstance(model, NonlinearModel) and model.complete
    return 2.0 * np.sin(0.5 * turn) if large else turn


def tendon_forces(model: RockingModel, nodes: Array) -> Array:
    """Force of each tendon in N, shape (n_nodes, n_tendons); `nodes` as in `History`."""
    p = model.properties
    rotation = nodes[:, 3 + 2 * p.n_modes]
    stretch = stretch_per_arm(model, np.abs(rotation))
    forces = np.empty((nodes.shape[0], len(p.tendons)))
    for k, tendon in enumerate(p.tendons):
        arm = p.half_width - np.sign(rotation) * tendon.position
        forces[:, k] = tendon.initial_force + tendon.stiffness * arm * stretch
    return forces


def largest_tendon_force(model: RockingModel, rotation: float) -> tuple[float, float]:
    """Largest force of any tendon in N, and over its yield force, up to a rotation |θ|.

    Zero without tendons; the latter is NaN where no yield force is known. A tendon off the centre has a mirror image,
    so that one of the two is stretched by the longer arm.
    """
    p = model.properties
    if not p.tendons:
        return 0.0, 0.0
    stretch = float(stretch_per_arm(model, np.array([rotation]))[0])
    largest = [
        each.initial_force + each.stiffness * (p.half_width + abs(each.position)) * stretch for each in p.tendons
    ]
    shares = [force / each.yield_force for force, each in zip(largest, p.tendons, strict=True) if each.yield_force]
    return max(largest), max(shares, default=math.nan)
