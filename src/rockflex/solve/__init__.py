"""Solvers: an exact engine for the piecewise linear models."""

from rockflex.solve._solution import Solution
from rockflex.solve.exact.engine import ExactEngine

__all__ = ["ExactEngine", "Solution"]
