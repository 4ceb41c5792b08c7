"""One solver for all models, exact for linear phases, and integrated to about ten digits for the others."""

from rockflex.solve._failures import explaining_engine_failures
from rockflex.solve._solution import Excitation, Solution, Solutions
from rockflex.solve._work import (
    CostModel,
    EstimatedWork,
    RunStoppedError,
    Task,
    WorkLimitError,
    asked_to_stop,
    check_interruption,
    cost_model_of,
    stopping_when,
)
from rockflex.solve.engine import Engine, Start, run_all, share_engine_preparation

__all__ = [
    "CostModel",
    "Engine",
    "EstimatedWork",
    "Excitation",
    "RunStoppedError",
    "Solution",
    "Solutions",
    "Start",
    "Task",
    "WorkLimitError",
    "asked_to_stop",
    "check_interruption",
    "cost_model_of",
    "explaining_engine_failures",
    "run_all",
    "share_engine_preparation",
    "stopping_when",
]
