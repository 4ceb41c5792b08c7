"""Models of a structure on a base that may uplift."""

from rockflex.models._bouc_wen import BoucWen
from rockflex.models._field import EXTRA, Field, field_rates, inertia_left
from rockflex.models._impact import ForgottenLaw, ImpactLaw, Restitution, VVELComplete, VVELSimplified, housner
from rockflex.models._label import Model, RockingModel, parse_model
from rockflex.models._linear import LinearModel
from rockflex.models._nonlinear import NonlinearModel
from rockflex.models._strike import Impact, impact_of, kinetic_energy, stick, strike

__all__ = [
    "EXTRA",
    "BoucWen",
    "Field",
    "ForgottenLaw",
    "Impact",
    "ImpactLaw",
    "LinearModel",
    "Model",
    "NonlinearModel",
    "Restitution",
    "RockingModel",
    "VVELComplete",
    "VVELSimplified",
    "field_rates",
    "housner",
    "impact_of",
    "inertia_left",
    "kinetic_energy",
    "parse_model",
    "stick",
    "strike",
]
