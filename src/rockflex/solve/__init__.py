"""Solvers: an exact engine for the piecewise linear models, an adaptive one for the nonlinear models."""

from rockflex.solve._engine import Engine, preparing
from rockflex.solve._observables import Observables
from rockflex.solve._pace import Pace, Work, pace_of
from rockflex.solve._solution import Solution
from rockflex.solve._task import Task, WorkLimitError
from rockflex.solve.adaptive.engine import AdaptiveEngine
from rockflex.solve.exact.engine import ExactEngine

__all__ = [
    "AdaptiveEngine",
    "Engine",
    "ExactEngine",
    "Observables",
    "Pace",
    "Solution",
    "Task",
    "Work",
    "WorkLimitError",
    "pace_of",
    "preparing",
]
