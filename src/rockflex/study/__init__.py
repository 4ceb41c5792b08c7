"""Studies: one run, the cross product of many, and spectra of what rocks."""

from rockflex.study._initial import InitialState
from rockflex.study._overturning import OverturningScales, overturning_scales, overturning_spectrum
from rockflex.study._rocking_spectrum import rocking_spectrum
from rockflex.study._simulate import simulate
from rockflex.study._simulate_many import simulate_many

__all__ = [
    "InitialState",
    "OverturningScales",
    "overturning_scales",
    "overturning_spectrum",
    "rocking_spectrum",
    "simulate",
    "simulate_many",
]
