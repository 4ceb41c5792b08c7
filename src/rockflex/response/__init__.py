"""Responses: forces, displacements, energies and peaks from a solution."""

from rockflex.response._base_path import base_path
from rockflex.response._columns import NAMES, STATUSES, columns_among, columns_of
from rockflex.response._edges import springs_of, tilt_at_rest
from rockflex.response._energy import EnergyLedger
from rockflex.response._floor_peaks import FloorPeaks
from rockflex.response._friction import IMPACT_WINDOW, friction_coefficient
from rockflex.response._global import GLOBAL, asked_of, extremes_of
from rockflex.response._history import History, SampledHistory
from rockflex.response._history_columns import UNITS_OF_GROUND, UNITS_OF_HISTORY, ground_columns, history_columns
from rockflex.response._moment_rotation import MomentRotation
from rockflex.response._moment_rotation_on_springs import MomentRotationOnSprings
from rockflex.response._resistance import element_resistance, large_resistance, weight_resistance
from rockflex.response._resistance_on_springs import push_on_springs, resistance_on_springs
from rockflex.response._respond import respond
from rockflex.response._response import PEAKS, Response
from rockflex.response._springs_path import springs_path
from rockflex.response._warnings import BALANCED, complete_of, leaves_range, warnings_of, warnings_of_energy

__all__ = [
    "BALANCED",
    "GLOBAL",
    "IMPACT_WINDOW",
    "NAMES",
    "PEAKS",
    "STATUSES",
    "UNITS_OF_GROUND",
    "UNITS_OF_HISTORY",
    "EnergyLedger",
    "FloorPeaks",
    "History",
    "MomentRotation",
    "MomentRotationOnSprings",
    "Response",
    "SampledHistory",
    "asked_of",
    "base_path",
    "columns_among",
    "columns_of",
    "complete_of",
    "element_resistance",
    "extremes_of",
    "friction_coefficient",
    "ground_columns",
    "history_columns",
    "large_resistance",
    "leaves_range",
    "push_on_springs",
    "resistance_on_springs",
    "respond",
    "springs_of",
    "springs_path",
    "tilt_at_rest",
    "warnings_of",
    "warnings_of_energy",
    "weight_resistance",
]
