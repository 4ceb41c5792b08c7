"""The vector fields of phases of nonlinear models, complete (Eqs. 13-16, 26-29) and yielding (Eqs. 37-38)."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rockflex.models._elements import (
    LEFT,
    MOMENT,
    RIGHT,
    branches_of_moving_elements,
    element_force_sums,
    friction_damper_shares,
    is_held_by_dampers,
)
from rockflex.models._field_numbers import FieldNumbers
from rockflex.models._fields import RockingField
from rockflex.models._ground_fields import GroundField
from rockflex.models._phase import Key
from rockflex.models._rocking_model import RockingModel


def field_of(
    model: RockingModel,
    numbers: FieldNumbers,
    key: Key,
    branch: int,
    stops: Sequence[tuple[int, int, tuple[float, float]]] = (),
    checks: Sequence[tuple[Any, ...]] = (),
) -> RockingField | GroundField:
    """Return the vector field of a phase.

    Parameters
    ----------
    model, numbers
        The model, and what its fields know.
    key
        The phase, as a key of the model.
    branch
        The sign of the velocity of a hysteretic spring.
    stops
        Limits of the rotation on rigid ground that end the phase, see `RockingField`.
    checks
        Conditions that are not linear, see `GroundField`.
    """
    ground = model.ground_phase(key, branch) if model.integrated else None
    if ground is not None:
        return GroundField(numbers, ground, list(stops), list(checks))
    p, elements = model.properties, model.elements
    branches = model.element_key(key)
    pulls = element_force_sums(p, elements, branches)
    releases, grip = None, 0.0
    if model.complete and is_held_by_dampers(p, elements, branches):
        after = (
            element_force_sums(p, elements, branches_of_moving_elements(p, elements, branches, turn))
            for turn in (RIGHT, LEFT)
        )
        releases = np.array([sums[MOMENT] for sums in after])
        grip = float(friction_damper_shares(p, elements, branches[0]).sum())
    return RockingField(numbers, key[0], branch, pulls, list(stops), releases, grip)
