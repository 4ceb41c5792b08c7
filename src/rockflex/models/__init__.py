"""Models of a structure on a base that may uplift."""

from rockflex.models._base_motion import horizontal_reaction
from rockflex.models._between import LinearMotion, MotionBetween, Part, Shaking, inside
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._element import Element, Slider
from rockflex.models._element_states import (
    element_energies,
    element_forces,
    plastic_stretches,
)
from rockflex.models._elements import (
    CLOSED,
    LEFT,
    RIGHT,
    SUMS,
    arm_of,
    element_force_sums,
    elements_of,
    rate_of,
    stiffness_of_fuses,
)
from rockflex.models._impact import (
    ForgottenLaw,
    ImpactLaw,
    Restitution,
    SidedRestitution,
    VVELComplete,
    VVELSimplified,
    housner,
)
from rockflex.models._kept import (
    accelerations,
    acting_side,
    phases_at,
    rates_of,
    under_more_gravity,
    values_of,
)
from rockflex.models._label import Model, parse_model
from rockflex.models._landing import GainsEnergyError
from rockflex.models._layout import GROUND, HEADER, RISE, SIDE, TIME, StateLayout
from rockflex.models._linear_system import ElementBase, element_base, linear_system_of
from rockflex.models._named import (
    element_moves,
    element_speeds,
    floor_quantities,
    modal_displacement,
    quantities,
    rotation_by_side,
    rotation_rate_by_side,
    tracked_elements,
)
from rockflex.models._nonlinear_ground_system import nonlinear_system
from rockflex.models._nonlinear_system import key_of, with_marks
from rockflex.models._phase import BorderedSystem, Key
from rockflex.models._quantities import (
    HORIZONTAL,
    LEFT_OUT,
    LIFT,
    LINEAR,
    SWAY,
    SWING,
    VERTICAL,
    Quantities,
    joined,
    rows_of,
)
from rockflex.models._reactions import Reactions, printed_reactions, reactions, spring_forces
from rockflex.models._rocking_model import LEVEL, Pose, RockingModel
from rockflex.models._sliding import SlidingModel
from rockflex.models._spring_model import LOADED, SpringModel
from rockflex.models._stored import floor_accelerations, soil_strain, stored_energies
from rockflex.models._system import may_stack, system_of

__all__ = [
    "CLOSED",
    "GROUND",
    "HEADER",
    "HORIZONTAL",
    "LEFT",
    "LEFT_OUT",
    "LEVEL",
    "LIFT",
    "LINEAR",
    "LOADED",
    "RIGHT",
    "RISE",
    "SIDE",
    "SUMS",
    "SWAY",
    "SWING",
    "TIME",
    "VERTICAL",
    "BorderedSystem",
    "BoucWen",
    "Element",
    "ElementBase",
    "ForgottenLaw",
    "GainsEnergyError",
    "ImpactLaw",
    "Key",
    "LinearMotion",
    "Model",
    "MotionBetween",
    "Part",
    "Pose",
    "Quantities",
    "Reactions",
    "Restitution",
    "RockingModel",
    "Shaking",
    "SidedRestitution",
    "Slider",
    "SlidingModel",
    "SpringModel",
    "StateLayout",
    "VVELComplete",
    "VVELSimplified",
    "accelerations",
    "acting_side",
    "arm_of",
    "element_base",
    "element_energies",
    "element_force_sums",
    "element_forces",
    "element_moves",
    "element_speeds",
    "elements_of",
    "floor_accelerations",
    "floor_quantities",
    "horizontal_reaction",
    "housner",
    "inside",
    "joined",
    "key_of",
    "linear_system_of",
    "may_stack",
    "modal_displacement",
    "nonlinear_system",
    "parse_model",
    "phases_at",
    "plastic_stretches",
    "printed_reactions",
    "quantities",
    "rate_of",
    "rates_of",
    "reactions",
    "rotation_by_side",
    "rotation_rate_by_side",
    "rows_of",
    "soil_strain",
    "spring_forces",
    "stiffness_of_fuses",
    "stored_energies",
    "system_of",
    "tracked_elements",
    "under_more_gravity",
    "values_of",
    "with_marks",
]
