"""Models of a structure on a base that may uplift."""

from rockflex.models._base_motion import horizontal_reaction
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._element import Element, FrictionElement
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
    arm_of_element,
    element_force_sums,
    elements_of,
    rate_of_elongation_row,
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
from rockflex.models._label import Model, parse_model
from rockflex.models._landing import GainsEnergyError
from rockflex.models._linear_system import LinearSystemBase, linear_system_base, linear_system_of
from rockflex.models._motion_between_states import (
    IntervalsOfPhase,
    LinearMotion,
    MotionBetween,
    VerticalShaking,
    series_between_states,
)
from rockflex.models._named_quantities import (
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
from rockflex.models._nonlinear_system import nonlinear_system_key, states_with_branch_codes
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
    joined_quantities,
    rows_of_quantities,
)
from rockflex.models._reactions import Reactions, printed_reactions, reactions, spring_forces
from rockflex.models._rigid_ground_system import may_stack, system_on_rigid_ground
from rockflex.models._rocking_model import LEVEL, Pose, RockingModel
from rockflex.models._sliding import SlidingModel
from rockflex.models._spring_model import LOADED, SpringModel
from rockflex.models._state_checks import check_states
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME, StateLayout
from rockflex.models._stored_energies import floor_accelerations, soil_strain, stored_energies
from rockflex.models._values_at_states import (
    accelerations_at_states,
    acting_side,
    phases_at_states,
    quantities_at_states,
    rates_at_states,
    under_more_gravity,
)

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
    "ForgottenLaw",
    "FrictionElement",
    "GainsEnergyError",
    "ImpactLaw",
    "IntervalsOfPhase",
    "Key",
    "LinearMotion",
    "LinearSystemBase",
    "Model",
    "MotionBetween",
    "Pose",
    "Quantities",
    "Reactions",
    "Restitution",
    "RockingModel",
    "SidedRestitution",
    "SlidingModel",
    "SpringModel",
    "StateLayout",
    "VVELComplete",
    "VVELSimplified",
    "VerticalShaking",
    "accelerations_at_states",
    "acting_side",
    "arm_of_element",
    "check_states",
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
    "joined_quantities",
    "linear_system_base",
    "linear_system_of",
    "may_stack",
    "modal_displacement",
    "nonlinear_system",
    "nonlinear_system_key",
    "parse_model",
    "phases_at_states",
    "plastic_stretches",
    "printed_reactions",
    "quantities",
    "quantities_at_states",
    "rate_of_elongation_row",
    "rates_at_states",
    "reactions",
    "rotation_by_side",
    "rotation_rate_by_side",
    "rows_of_quantities",
    "series_between_states",
    "soil_strain",
    "spring_forces",
    "states_with_branch_codes",
    "stiffness_of_fuses",
    "stored_energies",
    "system_on_rigid_ground",
    "tracked_elements",
    "under_more_gravity",
]
