"""Models of a structure on a base that may uplift."""

from rockflex.models._impact import ImpactLaw, Restitution, VVELComplete, VVELSimplified, housner
from rockflex.models._label import Model, parse_model
from rockflex.models._linear import LinearModel
from rockflex.models._strike import Impact, impact_of, kinetic_energy, stick, strike

__all__ = [
    "Impact",
    "ImpactLaw",
    "LinearModel",
    "Model",
    "Restitution",
    "VVELComplete",
    "VVELSimplified",
    "housner",
    "impact_of",
    "kinetic_energy",
    "parse_model",
    "stick",
    "strike",
]
