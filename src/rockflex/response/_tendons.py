"""Tendon forces."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex.models import RockingModel, stretch_per_arm


def tendon_forces(model: RockingModel, states: Array) -> Array:
    """Return the force of each tendon in N, shape (n_states, n_tendons); `states` as in `History`."""
    p = model.properties
    rotation = model.layout.of(states, model.layout.rotation)
    stretch = stretch_per_arm(model, np.abs(rotation))
    forces = np.empty((states.shape[0], len(p.tendons)))
    for k, tendon in enumerate(p.tendons):
        side = np.where(rotation < 0.0, -1.0, 1.0)
        arm = np.where(side < 0.0, p.pivot(-1).arm, p.pivot(1).arm) - side * tendon.position
        forces[:, k] = tendon.initial_force + tendon.stiffness * arm * stretch
    return forces


def largest_tendon_force(model: RockingModel, right: float, left: float) -> tuple[float, float]:
    """Return the largest tendon force in N, and the largest ratio to a yield force, up to rotations |θ| to each side.

    Both are zero without tendons; the ratio is NaN if no yield force is given.
    """
    p = model.properties
    if not p.tendons:
        return 0.0, 0.0
    stretches = stretch_per_arm(model, np.array([right, left]))
    largest = [
        each.initial_force
        + each.stiffness
        * max(
            float((p.pivot(side).arm - side * each.position) * stretch)
            for side, stretch in zip((1, -1), stretches, strict=True)
        )
        for each in p.tendons
    ]
    shares = [force / each.yield_force for force, each in zip(largest, p.tendons, strict=True) if each.yield_force]
    return max(largest), max(shares, default=math.nan)
