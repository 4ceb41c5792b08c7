"""Structures above a base that can rock: how masses, stiffness and geometry are assembled."""

from rockflex.structure._frame import Frame
from rockflex.structure._lumped import LumpedStructure

__all__ = ["Frame", "LumpedStructure"]
