"""Hybrid systems: phases, events, jumps and outputs. It knows no structure."""

from rockflex.engine.batch import Batch
from rockflex.engine.field import Field, Jump
from rockflex.engine.loops import LEVEL as VECTOR_LEVEL
from rockflex.engine.run import Run
from rockflex.engine.system import (
    MAX_STATES,
    Event,
    LinearPhase,
    NonlinearPhase,
    Rest,
    StateLayout,
    StepTooLongError,
    System,
)
from rockflex.engine.tables import by_rows, exponentials_less_identity, halvings_of, spectral_radius_bound

__all__ = [
    "MAX_STATES",
    "VECTOR_LEVEL",
    "Batch",
    "Event",
    "Field",
    "Jump",
    "LinearPhase",
    "NonlinearPhase",
    "Rest",
    "Run",
    "StateLayout",
    "StepTooLongError",
    "System",
    "by_rows",
    "exponentials_less_identity",
    "halvings_of",
    "spectral_radius_bound",
]
