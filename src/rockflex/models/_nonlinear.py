"""The nonlinear models: complete (Eqs. 13-16 and 26-29), yielding (Eqs. 37-38), or both; what their fields know."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.modal import RockingProperties
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._layout import StateLayout
from rockflex.models._linear_model import LinearModel
from rockflex.models._modal_model import ModalModel


@dataclass(frozen=True, eq=False)
class NonlinearModel(ModalModel):
    """N modes on a base that may uplift, with large rotations, a yielding superstructure, or both.

    Parameters
    ----------
    label
        Label of the model, such as ``"2DOF-C"``.
    properties
        Parameters of the structure, with only the modes of this model.
    lifts
        Whether the base can lift; otherwise it is fixed.
    law
        Impact law.
    complete
        Whether to use Eqs. 13, 14 and 16 with all trigonometric, centrifugal and P-Δ terms, or Eqs. 23 and 24.
    bouc_wen
        Hysteresis of the one mode, or None for an elastic superstructure.
    missing_mass, gravity
        As in `LinearModel`.
    """

    label: str
    properties: RockingProperties
    lifts: bool = True
    law: ImpactLaw = field(default_factory=VVELSimplified)
    complete: bool = True  # pyright: ignore[reportIncompatibleMethodOverride]
    bouc_wen: BoucWen | None = None  # pyright: ignore[reportIncompatibleMethodOverride]
    missing_mass: bool = False
    gravity: float = GRAVITY

    @property
    def integrated(self) -> bool:
        """Always True: the model is integrated while it rocks, and with a hysteretic spring also in contact."""
        return True

    @property
    def linear(self) -> LinearModel:
        """The simplified, elastic model of the same modes."""
        return LinearModel(self.label, self.properties, self.lifts, self.law, self.missing_mass, self.gravity)


@dataclass(frozen=True, eq=False)
class Numbers:
    """What a vector field knows of a model."""

    properties: RockingProperties
    bouc_wen: BoucWen | None
    complete: bool
    viscous: bool
    gravity: float
    resting: float  # vertical reaction at rest
    layout: StateLayout
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
        layout=model.layout,
        kinds=kinds,
        levers=np.zeros((len(kinds), 2)) if levers is None else levers,
    )
