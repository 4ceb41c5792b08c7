"""Models of a structure on a base that may uplift."""

from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import ImpactLaw, Restitution, VVELComplete, VVELSimplified, housner
from rockflex.models._label import Model, parse_model

__all__ = [
    "BoucWen",
    "ImpactLaw",
    "Model",
    "Restitution",
    "VVELComplete",
    "VVELSimplified",
    "housner",
    "parse_model",
]
