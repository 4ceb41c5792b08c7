"""The resisting moment of a run on springs, about the axis of the masses."""

from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.models import SpringModel
from rockflex.response._history import History
from rockflex.response._moment_rotation_on_springs import MomentRotationOnSprings
from rockflex.response._springs_path import springs_path


class SpringsResistance(NamedTuple):
    """Contributions of the springs and of the weight, shape (n,), and of each element, shape (n, E), in N m."""

    springs: Array
    weight: Array
    elements: Array

    @property
    def moment(self) -> Array:
        """Their sum, shape (n,)."""
        return self.springs + self.weight + self.elements.sum(axis=1)


def resistance_on_springs(history: History) -> SpringsResistance | None:
    """Return the resisting moment at the states of a run; None on rigid ground."""
    model, p = history.model, history.model.properties
    if not isinstance(model, SpringModel):
        return None
    gravity = GRAVITY + history.vertical_ground_acceleration
    return SpringsResistance(
        history.spring_force @ model.springs.positions,
        -p.l0r * gravity * history.rotation,
        -history.element_force * np.array([each.position for each in p.elements]),
    )


def push_on_springs(history: History, rotation: float) -> MomentRotationOnSprings | None:
    """Return the slow push of the base of a run to a rotation in rad on either side; None on rigid ground."""
    model = history.model
    return springs_path(model, np.array([rotation, -rotation])) if isinstance(model, SpringModel) else None
