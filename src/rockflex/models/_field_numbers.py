"""The numbers of a model that the vector fields of nonlinear models need."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import StateLayout
from rockflex.structure._rocking import RockingProperties


@dataclass(frozen=True, eq=False)
class FieldNumbers:
    """The numbers of a model that a vector field needs."""

    properties: RockingProperties
    bouc_wen: BoucWen | None
    complete: bool
    viscous: bool
    gravity: float
    resting: float  # vertical reaction at rest
    layout: StateLayout
    kinds: Sequence[int]  # of the outputs
    levers: Array


def field_numbers(model: RockingModel, kinds: Sequence[int] = (), levers: Array | None = None) -> FieldNumbers:
    """Return what the vector field of a model knows, with outputs of these kinds, each with two levers."""
    return FieldNumbers(
        properties=model.properties,
        bouc_wen=model.bouc_wen,
        complete=model.complete,
        viscous=model.layout.swept >= 0,
        gravity=model.gravity,
        resting=model.properties.resting_reaction,
        layout=model.layout,
        kinds=kinds,
        levers=np.zeros((len(kinds), 2)) if levers is None else levers,
    )
