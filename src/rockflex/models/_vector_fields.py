"""The vector field of a phase of a model."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rockflex.models._elements import LEFT, MOMENT, RIGHT, element_force_sums, hold_shares, is_held, set_off
from rockflex.models._fields import RockingField
from rockflex.models._ground_fields import GroundField
from rockflex.models._modal_model import ModalModel
from rockflex.models._nonlinear import Numbers
from rockflex.models._nonlinear_ground import on_ground
from rockflex.models._phase import Key


def field_of(
    model: ModalModel,
    numbers: Numbers,
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
    slides = on_ground(model)
    if slides is not None:
        return GroundField(numbers, slides.ground_phase(key, branch), list(stops), list(checks))
    p, elements = model.properties, model.elements
    branches = model.element_key(key)
    pulls = element_force_sums(p, elements, branches)
    releases, grip = None, 0.0
    if model.complete and is_held(p, elements, branches):
        after = (element_force_sums(p, elements, set_off(p, elements, branches, turn)) for turn in (RIGHT, LEFT))
        releases = np.array([sums[MOMENT] for sums in after])
        grip = float(hold_shares(p, elements, branches[0]).sum())
    return RockingField(numbers, key[0], branch, pulls, list(stops), releases, grip)
