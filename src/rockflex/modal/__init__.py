"""From mass, stiffness and heights to modes, and from modes to the parameters of a rocking structure."""

from rockflex.modal._adequacy import Adequacy, AdequacyTolerance, adequacy
from rockflex.modal._analysis import FloorModes, ModalProperties, modal_properties
from rockflex.modal._attachment import PLACE, Attachment, YieldingStory, element_parameters
from rockflex.modal._devices import STEELS, STRANDS, Steel, Strand, bar_fuse, strand_tendon, u_plate_fuse
from rockflex.modal._element_law import Branch, BranchEnd, ElementLaw, slow_path
from rockflex.modal._elements import (
    BaseElement,
    FrictionDamper,
    Tendon,
    ViscousDamper,
    YieldingDissipator,
    base_element_tuple,
    initial_force,
)
from rockflex.modal._ground import Ground, Springs, asce41_bed, gazetas_bed, winkler_bed
from rockflex.modal._law_bars import BARS, FlagShapedBar, GapBar, MultilinearBar
from rockflex.modal._participation import MassNormalisedModes, excited_mode_indices, rocking_properties
from rockflex.modal._pivot import Pivot
from rockflex.modal._rocking import RockingProperties
from rockflex.modal._uplifted import PinnedBeam, UpliftedModes, frequency_equation, pinned_beam, uplifted_modes

__all__ = [
    "BARS",
    "PLACE",
    "STEELS",
    "STRANDS",
    "Adequacy",
    "AdequacyTolerance",
    "Attachment",
    "BaseElement",
    "Branch",
    "BranchEnd",
    "ElementLaw",
    "FlagShapedBar",
    "FloorModes",
    "FrictionDamper",
    "GapBar",
    "Ground",
    "MassNormalisedModes",
    "ModalProperties",
    "MultilinearBar",
    "PinnedBeam",
    "Pivot",
    "RockingProperties",
    "Springs",
    "Steel",
    "Strand",
    "Tendon",
    "UpliftedModes",
    "ViscousDamper",
    "YieldingDissipator",
    "YieldingStory",
    "adequacy",
    "asce41_bed",
    "bar_fuse",
    "base_element_tuple",
    "element_parameters",
    "excited_mode_indices",
    "frequency_equation",
    "gazetas_bed",
    "initial_force",
    "modal_properties",
    "pinned_beam",
    "rocking_properties",
    "slow_path",
    "strand_tendon",
    "u_plate_fuse",
    "uplifted_modes",
    "winkler_bed",
]
