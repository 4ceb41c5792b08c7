"""The errors of runs that go wrong."""

from typing import Any

import numpy as np

from rockflex.engine.system import Key, LinearPhase, NonlinearPhase, StepTooLongError
from rockflex.foundation.errors import InputError, SolverError


class VectorLevelError(InputError, ImportError):
    """The level of vector instructions asked for is not there."""


def missing_vector_level_error(level: str) -> VectorLevelError:
    """The processor lacks a level of vector instructions."""
    return VectorLevelError(
        f"ROCKFLEX_SIMD={level!r} is not a level of vector instructions that this processor has. Give 'baseline', "
        "'v3' (AVX2) or 'v4' (AVX-512), or leave it out for the best one."
    )


def check_key(key: Key) -> None:
    """A key must be hashable."""
    try:
        hash(key)
    except TypeError as error:
        raise InputError(f"The key {key!r} of a phase must be hashable, as a tuple is.") from error


def broken_off_run_error() -> SolverError:
    """A run that has failed is asked to go on."""
    return SolverError("This run has been broken off by an error; begin it anew by `restart`.")


def growth(key: Key, time: float) -> SolverError:
    """The motion overflows."""
    return SolverError(f"The motion in the phase {key!r} grows without bound before t = {time:.9g}.")


def endless(key: Key, phase: LinearPhase, which: int, h: float) -> StepTooLongError:
    """The motion of a system overflows within a time step."""
    words = f"phase {key!r}: the motion grows without bound within one time step of {h:.9g}."
    return StepTooLongError(words, float(np.linalg.eigvals(phase.of(which).A).real.max()))


def limit(samples: int) -> SolverError:
    """The limit of the work is reached."""
    return SolverError(f"The run has reached the limit of its work, {samples} samples.")


def accumulation(key: Key, phase: LinearPhase | NonlinearPhase, event: int, time: float) -> SolverError:
    """Events follow each other without end."""
    return SolverError(
        f"Events of the phase {key!r}, such as {phase.events[event].name!r}, accumulate without end at t = {time:.9g}."
    )


def step_too_small(key: Key, phase: NonlinearPhase, time: float) -> BaseException:
    """No step is short enough; or a field in Python has raised an exception, which is then returned."""
    field: Any = phase.field
    failure = getattr(field, "failure", None)
    if failure is None:
        return SolverError(f"No step in the phase {key!r} is short enough at t = {time:.9g}.")
    field.failure = None
    return failure
