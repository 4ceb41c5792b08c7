"""Structures above a base that can rock: how masses, stiffness and geometry are assembled."""

from rockflex.structure._beam import Beam
from rockflex.structure._block import rigid_block
from rockflex.structure._cantilever import CantileverWithTipMass
from rockflex.structure._cross_section import Section
from rockflex.structure._eccentric import Eccentric
from rockflex.structure._fish_bone import FishBone
from rockflex.structure._frame import Frame
from rockflex.structure._from_matrices import from_matrices, from_modes
from rockflex.structure._lumped import LumpedStructure
from rockflex.structure._modal_structure import ModalStructure
from rockflex.structure._plausible import structure_warnings
from rockflex.structure._restrained import Restrained
from rockflex.structure._ritz import RitzShapes, cosine_shapes
from rockflex.structure._sections import LumpedMasses
from rockflex.structure._tapered_tower import TaperedTower
from rockflex.structure._wall_frame import WallFrame

__all__ = [
    "Beam",
    "CantileverWithTipMass",
    "Eccentric",
    "FishBone",
    "Frame",
    "LumpedMasses",
    "LumpedStructure",
    "ModalStructure",
    "Restrained",
    "RitzShapes",
    "Section",
    "TaperedTower",
    "WallFrame",
    "cosine_shapes",
    "from_matrices",
    "from_modes",
    "rigid_block",
    "structure_warnings",
]
