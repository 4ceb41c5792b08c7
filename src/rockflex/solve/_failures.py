"""The errors of runs that could not be solved."""

from rockflex._arrays import Array
from rockflex._errors import InputError, SolverError
from rockflex._shown import shown
from rockflex.models import RockingModel
from rockflex.solve._task import Task
from rockflex.solve.status import Status

LONGEST_FALL = 300.0  # e-folds of the rotation within a time step; more would overflow


def failure_of(model: RockingModel, status: Status, samples: int, dt: float, state: Array) -> SolverError:
    """Return the error for a run that ended with a status after a number of completed samples."""
    # A failure inside a sample is reported with the time at the end of the sample.
    time = (samples + (status not in (Status.UNSETTLED, Status.INFINITE))) * dt
    what = status.what.format(label=model.label, law=shown(model.law), time=time)
    return _in_state(model, what, status.mend, state)


def failure_of_law(model: RockingModel, failure: BaseException) -> BaseException:
    """Return the error for a run that a failure of the user's impact law ended; Ctrl-C and the like as they are."""
    if not isinstance(failure, Exception):
        return failure
    error = InputError(f"{Status.BROKEN.what.format(law=shown(model.law))}: {failure}")
    error.__cause__ = failure
    return error


def failure_of_step(rate: float, dt: float) -> InputError:
    """Return the error for a time step within which a rotation that grows at a rate in 1/s overflows."""
    return InputError(
        f"The time step of {dt:g} s is too long: a rocking rotation of this structure grows e-fold in "
        f"{1.0 / rate:.3g} s. Give the motion at a step of at most {LONGEST_FALL / rate:.3g} s."
    )


def failure_of_limit(task: Task, samples: int, work_limit: float | None, state: Array) -> SolverError:
    """Return the error for a run that reached its work limit after a number of completed samples."""
    what, mend = task.stopped(samples * task.dt, work_limit)
    return _in_state(task.model, what, mend, state)


def _in_state(model: RockingModel, what: str, mend: str, state: Array) -> SolverError:
    values = ", ".join(f"{value:.6g}" for value in state[: model.layout.core])
    return SolverError(f"{what} The state [D, D', θ, θ'] there is [{values}]. {mend}")
