"""One solver for all models, exact for linear phases, and integrated to about ten digits for the others."""

from rockflex.solve._failures import preparing
from rockflex.solve._solution import Excitation, Solution, Solutions
from rockflex.solve._work import (
    Pace,
    RunStoppedError,
    Task,
    Work,
    WorkLimitError,
    asked_to_stop,
    check_interruption,
    pace_of,
    stopping_when,
)
from rockflex.solve.engine import Engine, Start, gather, run_all

__all__ = [
    "Engine",
    "Excitation",
    "Pace",
    "RunStoppedError",
    "Solution",
    "Solutions",
    "Start",
    "Task",
    "Work",
    "WorkLimitError",
    "asked_to_stop",
    "check_interruption",
    "gather",
    "pace_of",
    "preparing",
    "run_all",
    "stopping_when",
]
