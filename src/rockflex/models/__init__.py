"""Models of a structure on a base that may uplift."""

from rockflex.models._bouc_wen import BoucWen
from rockflex.models._field import EXTRA, Field, field_rates, inertia_left
from rockflex.models._forces import horizontal_row, lost_support_row, missing_mass_rows, row_size
from rockflex.models._impact import (
    ForgottenLaw,
    ImpactLaw,
    Restitution,
    SidedRestitution,
    VVELComplete,
    VVELSimplified,
    housner,
)
from rockflex.models._label import Model, RockingModel, parse_model
from rockflex.models._linear import LinearModel
from rockflex.models._nonlinear import NonlinearModel
from rockflex.models._observe import (
    HORIZONTAL,
    LEFT_OUT,
    LINEAR,
    SWAY,
    VERTICAL,
    Posture,
    observe,
    observe_all,
    posture_of,
)
from rockflex.models._strike import Impact, impact_of, kinetic_energy, stick, strike

__all__ = [
    "EXTRA",
    "HORIZONTAL",
    "LEFT_OUT",
    "LINEAR",
    "SWAY",
    "VERTICAL",
    "BoucWen",
    "Field",
    "ForgottenLaw",
    "Impact",
    "ImpactLaw",
    "LinearModel",
    "Model",
    "NonlinearModel",
    "Posture",
    "Restitution",
    "RockingModel",
    "SidedRestitution",
    "VVELComplete",
    "VVELSimplified",
    "field_rates",
    "horizontal_row",
    "housner",
    "impact_of",
    "inertia_left",
    "kinetic_energy",
    "lost_support_row",
    "missing_mass_rows",
    "observe",
    "observe_all",
    "parse_model",
    "posture_of",
    "row_size",
    "stick",
    "strike",
]
