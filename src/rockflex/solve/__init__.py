"""One solver for all models, exact for linear phases, and integrated to about ten digits for the others."""

from rockflex.solve._failures import preparing
from rockflex.solve._solution import Excitation, Solution, Solutions
from rockflex.solve._work import (
    CostModel,
    RunStoppedError,
    Task,
    Work,
    WorkLimitError,
    asked_to_stop,
    check_interruption,
    cost_model_of,
    stopping_when,
)
from rockflex.solve.engine import Engine, Start, gather, run_all

__all__ = [
    "CostModel",
    "Engine",
    "Excitation",
    "RunStoppedError",
    "Solution",
    "Solutions",
    "Start",
    "Task",
    "Work",
    "WorkLimitError",
    "asked_to_stop",
    "check_interruption",
    "cost_model_of",
    "gather",
    "preparing",
    "run_all",
    "stopping_when",
]
