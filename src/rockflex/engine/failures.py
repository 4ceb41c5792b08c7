"""The errors of runs that go wrong."""

from typing import Any

from rockflex._errors import SolverError
from rockflex.engine.system import Key, LinearPhase, NonlinearPhase


def broken_off() -> SolverError:
    """A run that has failed is asked to go on."""
    return SolverError("This run has been broken off by an error; begin it anew by `restart`.")


def growth(key: Key, time: float) -> SolverError:
    """The motion overflows."""
    return SolverError(f"The motion in the phase {key!r} grows without bound before t = {time:.9g}.")


def limit(samples: int) -> SolverError:
    """The limit of the work is reached."""
    return SolverError(f"The run has reached the limit of its work, {samples} samples.")


def accumulation(key: Key, phase: LinearPhase | NonlinearPhase, event: int, time: float) -> SolverError:
    """Events follow each other without end."""
    return SolverError(
        f"Events of the phase {key!r}, such as {phase.events[event].name!r}, accumulate without end at t = {time:.9g}."
    )


def stall(key: Key, phase: NonlinearPhase, time: float) -> BaseException:
    """No step is short enough; or a field in Python has raised an exception, which is then returned."""
    field: Any = phase.field
    failure = getattr(field, "failure", None)
    if failure is None:
        return SolverError(f"No step in the phase {key!r} is short enough at t = {time:.9g}.")
    field.failure = None
    return failure
