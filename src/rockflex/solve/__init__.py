"""One solver for all models, exact for linear phases, and integrated to about ten digits for the others."""

from rockflex.solve._pace import Pace, Work, pace_of
from rockflex.solve._preparing import preparing
from rockflex.solve._solution import Excitation, Solution
from rockflex.solve._solutions import Solutions
from rockflex.solve._task import Task, WorkLimitError
from rockflex.solve.engine import Engine, gather
from rockflex.solve.interruption import RunStoppedError, asked_to_stop, check_interruption, stopping_when

__all__ = [
    "Engine",
    "Excitation",
    "Pace",
    "RunStoppedError",
    "Solution",
    "Solutions",
    "Task",
    "Work",
    "WorkLimitError",
    "asked_to_stop",
    "check_interruption",
    "gather",
    "pace_of",
    "preparing",
    "stopping_when",
]
