"""Structures above a base that can rock: masses, stiffness and geometry; their modes; elements, and the ground."""

from rockflex.structure._adequacy import Adequacy, AdequacyTolerance, adequacy
from rockflex.structure._analysis import FloorModes, ModalProperties, modal_properties
from rockflex.structure._attachment import Attachment
from rockflex.structure._beam import Beam
from rockflex.structure._beam_modes import RitzShapes, cosine_shapes
from rockflex.structure._beam_sections import LumpedMasses
from rockflex.structure._beds import asce41_bed, gazetas_bed, winkler_bed
from rockflex.structure._cross_section import Section
from rockflex.structure._devices import STEELS, STRANDS, Steel, Strand, bar_fuse, strand_tendon, u_plate_fuse
from rockflex.structure._element_law import Branch, BranchEnd, ElementLaw
from rockflex.structure._elements import FrictionDamper, Tendon, ViscousDamper, YieldingDissipator
from rockflex.structure._frames import FishBone, Frame, LumpedStructure
from rockflex.structure._from_matrices import from_matrices, from_modes
from rockflex.structure._ground import Ground, Springs
from rockflex.structure._joint import Joint
from rockflex.structure._jointed import Jointed
from rockflex.structure._law_bars import FlagShapedBar, GapBar, MultilinearBar
from rockflex.structure._leaning import Leaning
from rockflex.structure._one_sided import OneSided
from rockflex.structure._participation import rocking_properties
from rockflex.structure._pivot import Pivot
from rockflex.structure._podium import Podium
from rockflex.structure._rigid_bodies import rigid_block, rocking_frame
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Eccentric, ModalStructure, Restrained, structure_warnings
from rockflex.structure._towers import CantileverWithTipMass, TaperedTower
from rockflex.structure._uplifted import PinnedBeam, UpliftedModes, frequency_equation, pinned_beam, uplifted_modes
from rockflex.structure._wall_frame import WallFrame
from rockflex.structure._yielding_stories import YieldingStories

__all__ = [
    "STEELS",
    "STRANDS",
    "Adequacy",
    "AdequacyTolerance",
    "Attachment",
    "Beam",
    "Branch",
    "BranchEnd",
    "CantileverWithTipMass",
    "Eccentric",
    "ElementLaw",
    "FishBone",
    "FlagShapedBar",
    "FloorModes",
    "Frame",
    "FrictionDamper",
    "GapBar",
    "Ground",
    "Joint",
    "Jointed",
    "Leaning",
    "LumpedMasses",
    "LumpedStructure",
    "ModalProperties",
    "ModalStructure",
    "MultilinearBar",
    "OneSided",
    "PinnedBeam",
    "Pivot",
    "Podium",
    "Restrained",
    "RitzShapes",
    "RockingProperties",
    "Section",
    "Springs",
    "Steel",
    "Strand",
    "TaperedTower",
    "Tendon",
    "UpliftedModes",
    "ViscousDamper",
    "WallFrame",
    "YieldingDissipator",
    "YieldingStories",
    "adequacy",
    "asce41_bed",
    "bar_fuse",
    "cosine_shapes",
    "frequency_equation",
    "from_matrices",
    "from_modes",
    "gazetas_bed",
    "modal_properties",
    "pinned_beam",
    "rigid_block",
    "rocking_frame",
    "rocking_properties",
    "strand_tendon",
    "structure_warnings",
    "u_plate_fuse",
    "uplifted_modes",
    "winkler_bed",
]
