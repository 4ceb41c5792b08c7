"""Studies: one run, or the cross product of many."""

from rockflex.study._initial import InitialState
from rockflex.study._simulate import simulate
from rockflex.study._simulate_many import simulate_many

__all__ = ["InitialState", "simulate", "simulate_many"]
