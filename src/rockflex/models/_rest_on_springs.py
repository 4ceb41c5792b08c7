"""A base at rest on springs that cannot pull."""

import numpy as np

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.modal import RockingProperties, Springs
from rockflex.models._elements import elements_of

STABLE = 1e-9  # relative: least stiffness of a base against toppling

Pose = tuple[float, float]  # rotation in rad and heave in m


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


def heave_at(springs: Springs, rotation: float, weight: float) -> float:
    """Return the heave in m at which the springs carry a weight in N at a rotation in rad."""
    ends = springs.positions * rotation  # a spring is compressed while the heave is below its end
    order = np.argsort(-ends)
    stiffness = np.cumsum(springs.stiffness[order])
    heaves = (np.cumsum(springs.stiffness[order] * ends[order]) - weight) / stiffness
    fits = np.append(heaves[:-1] >= ends[order][1:], True)
    return float(heaves[np.argmax(fits)])
