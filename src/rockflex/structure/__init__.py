"""Structures above a base that can rock: how masses, stiffness and geometry are assembled."""

from rockflex.structure._beam import Beam
from rockflex.structure._beam_modes import RitzShapes, cosine_shapes
from rockflex.structure._beam_sections import LumpedMasses
from rockflex.structure._cross_section import Section
from rockflex.structure._frames import FishBone, Frame, LumpedStructure
from rockflex.structure._from_matrices import from_matrices, from_modes
from rockflex.structure._leaning import Leaning
from rockflex.structure._structure import Eccentric, ModalStructure, Restrained, structure_warnings
from rockflex.structure._towers import CantileverWithTipMass, TaperedTower, rigid_block
from rockflex.structure._wall_frame import WallFrame
from rockflex.structure._yielding_stories import YieldingStories

__all__ = [
    "Beam",
    "CantileverWithTipMass",
    "Eccentric",
    "FishBone",
    "Frame",
    "Leaning",
    "LumpedMasses",
    "LumpedStructure",
    "ModalStructure",
    "Restrained",
    "RitzShapes",
    "Section",
    "TaperedTower",
    "WallFrame",
    "YieldingStories",
    "cosine_shapes",
    "from_matrices",
    "from_modes",
    "rigid_block",
    "structure_warnings",
]
