"""Models of a structure on a base that may uplift."""

from rockflex.models._bouc_wen import BoucWen
from rockflex.models._decay import restitution_from_decay
from rockflex.models._impact import (
    AngularMomentum,
    ImpactLaw,
    PivotImpulse,
    Restitution,
    VVELComplete,
    VVELSimplified,
    housner,
)
from rockflex.models._label import Model, parse_model

__all__ = [
    "AngularMomentum",
    "BoucWen",
    "ImpactLaw",
    "Model",
    "PivotImpulse",
    "Restitution",
    "VVELComplete",
    "VVELSimplified",
    "housner",
    "parse_model",
    "restitution_from_decay",
]
