"""From mass, stiffness and heights to modes, and from modes to the parameters of a rocking structure."""

from rockflex.modal._analysis import ModalProperties, modal_properties
from rockflex.modal._assembly import rocking_properties
from rockflex.modal._floors import FloorModes
from rockflex.modal._rocking import RockingProperties

__all__ = ["FloorModes", "ModalProperties", "RockingProperties", "modal_properties", "rocking_properties"]
