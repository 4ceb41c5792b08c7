"""From mass, stiffness and heights to modes, and from modes to the parameters of a rocking structure."""

from rockflex.modal._adequacy import Adequacy, adequacy
from rockflex.modal._adequacy_tolerance import AdequacyTolerance
from rockflex.modal._analysis import ModalProperties, modal_properties
from rockflex.modal._assembly import rocking_properties
from rockflex.modal._devices import BaseElement, FrictionDamper, ViscousDamper, YieldingDissipator, element_set
from rockflex.modal._floors import FloorModes
from rockflex.modal._ground import Ground, Springs
from rockflex.modal._participation import MassNormalisedModes, modes_that_take_part
from rockflex.modal._pinned_beam import PinnedBeam, pinned_beam
from rockflex.modal._pivot import Pivot
from rockflex.modal._rocking import RockingProperties
from rockflex.modal._tendons import Tendon
from rockflex.modal._uplifted import UpliftedModes, frequency_equation, uplifted_modes
from rockflex.modal._winkler import asce41_bed, winkler_bed

__all__ = [
    "Adequacy",
    "AdequacyTolerance",
    "BaseElement",
    "FloorModes",
    "FrictionDamper",
    "Ground",
    "MassNormalisedModes",
    "ModalProperties",
    "PinnedBeam",
    "Pivot",
    "RockingProperties",
    "Springs",
    "Tendon",
    "UpliftedModes",
    "ViscousDamper",
    "YieldingDissipator",
    "adequacy",
    "asce41_bed",
    "element_set",
    "frequency_equation",
    "modal_properties",
    "modes_that_take_part",
    "pinned_beam",
    "rocking_properties",
    "uplifted_modes",
    "winkler_bed",
]
