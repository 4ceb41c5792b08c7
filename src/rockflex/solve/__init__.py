"""Solvers: an exact engine for the piecewise linear models, an adaptive one for the nonlinear models."""

from rockflex.solve._engine import Engine, preparing
from rockflex.solve._observables import Observables
from rockflex.solve._solution import Solution
from rockflex.solve.adaptive.engine import AdaptiveEngine
from rockflex.solve.exact.engine import ExactEngine

__all__ = ["AdaptiveEngine", "Engine", "ExactEngine", "Observables", "Solution", "preparing"]
