"""Hybrid systems: phases, events, jumps and outputs. It knows no structure."""

from rockflex.engine.run import Run
from rockflex.engine.system import Event, LinearPhase, NonlinearPhase, Rest, StateLayout, System

__all__ = [
    "Event",
    "LinearPhase",
    "NonlinearPhase",
    "Rest",
    "Run",
    "StateLayout",
    "System",
]
