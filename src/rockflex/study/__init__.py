"""Studies: one run, the cross product of many, and rocking and overturning spectra."""

from rockflex.study._arguments import WORK_LIMIT, RockingStructure, properties_of
from rockflex.study._case import Case
from rockflex.study._frequency_ratios import frequency_ratios
from rockflex.study._initial import InitialState
from rockflex.study._modal_combination import CombinedPeaks, SecondMode, modal_combination
from rockflex.study._moment_rotation import moment_rotation
from rockflex.study._overturning import OverturningScales, overturning_scales, overturning_spectrum
from rockflex.study._rocking_spectrum import rocking_spectrum
from rockflex.study._simulate import simulate
from rockflex.study._simulate_many import simulate_many

__all__ = [
    "WORK_LIMIT",
    "Case",
    "CombinedPeaks",
    "InitialState",
    "OverturningScales",
    "RockingStructure",
    "SecondMode",
    "frequency_ratios",
    "modal_combination",
    "moment_rotation",
    "overturning_scales",
    "overturning_spectrum",
    "properties_of",
    "rocking_spectrum",
    "simulate",
    "simulate_many",
]
