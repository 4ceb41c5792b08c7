"""Models of a structure on a base that may uplift."""

from rockflex.models._bouc_wen import BoucWen
from rockflex.models._elements import CLOSED, LEFT, RIGHT, Element
from rockflex.models._field import EXTRA, PULLS, Field, field_rates, inertia_left, pivot_at
from rockflex.models._impact import (
    ForgottenLaw,
    ImpactLaw,
    Restitution,
    SidedRestitution,
    VVELComplete,
    VVELSimplified,
    housner,
)
from rockflex.models._kept import accelerations, acting_side, phases_at, pulls_at, rates_of, values_of
from rockflex.models._label import Model, RockingModel, parse_model
from rockflex.models._layout import GROUND, HEADER, SIDE, TIME, StateLayout, layout_of
from rockflex.models._linear import LinearModel
from rockflex.models._named import floor_quantities, modal_displacement, quantities, rotation_by_side
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
from rockflex.models._phase import CHANGES, FREEDOMS, LANDS, LIFTS, OVERTURNS, Arrow, Border, Exit, Guard, Key, Phase
from rockflex.models._pulls import SUMS, pulls_of
from rockflex.models._quantities import Quantities, lost_support_row, rows_of, turning_row
from rockflex.models._reactions import Reactions, printed_reactions, reactions
from rockflex.models._stored import floor_accelerations, stored_energies, stretch_per_arm, tendon_energy
from rockflex.models._strike import Impact, impact_of, kinetic_energy, may_pass, stick, strike

__all__ = [
    "CHANGES",
    "CLOSED",
    "EXTRA",
    "FREEDOMS",
    "GROUND",
    "HEADER",
    "HORIZONTAL",
    "LANDS",
    "LEFT",
    "LEFT_OUT",
    "LIFTS",
    "LINEAR",
    "OVERTURNS",
    "PULLS",
    "RIGHT",
    "SIDE",
    "SUMS",
    "SWAY",
    "TIME",
    "VERTICAL",
    "Arrow",
    "Border",
    "BoucWen",
    "Element",
    "Exit",
    "Field",
    "ForgottenLaw",
    "Guard",
    "Impact",
    "ImpactLaw",
    "Key",
    "LinearModel",
    "Model",
    "NonlinearModel",
    "Phase",
    "Posture",
    "Quantities",
    "Reactions",
    "Restitution",
    "RockingModel",
    "SidedRestitution",
    "StateLayout",
    "VVELComplete",
    "VVELSimplified",
    "accelerations",
    "acting_side",
    "field_rates",
    "floor_accelerations",
    "floor_quantities",
    "housner",
    "impact_of",
    "inertia_left",
    "kinetic_energy",
    "layout_of",
    "lost_support_row",
    "may_pass",
    "modal_displacement",
    "observe",
    "observe_all",
    "parse_model",
    "phases_at",
    "pivot_at",
    "posture_of",
    "printed_reactions",
    "pulls_at",
    "pulls_of",
    "quantities",
    "rates_of",
    "reactions",
    "rotation_by_side",
    "rows_of",
    "stick",
    "stored_energies",
    "stretch_per_arm",
    "strike",
    "tendon_energy",
    "turning_row",
    "values_of",
]
