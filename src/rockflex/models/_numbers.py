"""What the compiled vector field knows of a model."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array
from rockflex.modal import RockingProperties
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._modal_model import ModalModel


@dataclass(frozen=True, eq=False)
class Numbers:
    """What a vector field knows of a model."""

    properties: RockingProperties
    bouc_wen: BoucWen | None
    complete: bool
    viscous: bool
    gravity: float
    resting: float  # vertical reaction at rest
    memory: int  # place of the first memory of an element
    kinds: Sequence[int]  # of the outputs
    levers: Array


def numbers_of(model: ModalModel, kinds: Sequence[int] = (), levers: Array | None = None) -> Numbers:
    """Return what the vector field of a model knows, with outputs of these kinds, each with two levers."""
    return Numbers(
        properties=model.properties,
        bouc_wen=model.bouc_wen,
        complete=model.complete,
        viscous=model.layout.swept >= 0,
        gravity=model.gravity,
        resting=model.properties.resting_reaction,
        memory=model.layout.memory,
        kinds=kinds,
        levers=np.zeros((len(kinds), 2)) if levers is None else levers,
    )
