"""How a run ends, and the errors of runs that could not be solved."""

from contextlib import AbstractContextManager
from enum import IntEnum

from rockflex._arrays import Array
from rockflex._errors import InputError, SolverError
from rockflex._overflow import explaining_overflow
from rockflex._shown import shown
from rockflex.models import RockingModel
from rockflex.solve._work import Task

LONGEST_FALL = 300.0  # e-folds of the rotation within a time step; more would overflow


class Status(IntEnum):
    """The status of a run; negative values are failures, with a message and a remedy.

    The placeholders in the texts are the `label` of the model, the impact `law`, and the `time` in s.
    """

    what: str
    mend: str

    def __new__(cls, value: int, what: str = "", mend: str = "") -> "Status":
        """Create a member that is a number."""
        member = int.__new__(cls, value)
        member._value_ = value
        member.what, member.mend = what, mend
        return member

    ENDED = 0
    OVERTURNED = 1
    SETTLED = 2
    CHATTER = (
        -2,
        "The events of {label}, such as impacts, accumulate without end in the sample before {time:.6g} s.",
        "Check the model's parameters, and refine the record.",
    )
    GAINED = (
        -3,
        "The impact law {law} returns energy in the sample before {time:.6g} s.",
        "A law can only lose energy: correct its `after`, or lower its restitution.",
    )
    STALLED = (
        -4,
        "The motion of {label} cannot be integrated in the sample before {time:.6g} s: no step is short enough.",
        "Check the parameters.",
    )
    UNSETTLED = (
        -5,
        "The free vibration of {label} has not settled {time:.6g} s after the start.",
        "Give free_vibration in seconds, or more damping.",
    )
    INFINITE = -6, "The motion of {label} is not finite at {time:.6g} s.", "Check the parameters."


def failure_of_run(model: RockingModel, status: Status, samples: int, dt: float, state: Array) -> SolverError:
    """Return the error for a run that ended with a status after a number of completed samples."""
    # A failure inside a sample is reported with the time at the end of the sample.
    time = (samples + (status not in (Status.UNSETTLED, Status.INFINITE))) * dt
    what = status.what.format(label=model.label, law=shown(model.law), time=time)
    return _in_state(model, what, status.mend, state)


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


def explaining_engine_failures(model: RockingModel) -> AbstractContextManager[None]:
    """Report arithmetic failures during the preparation of an engine in terms of the parameters of the model."""
    return explaining_overflow(lambda: _described(model))


def _described(model: RockingModel) -> str:
    p = model.properties
    modes = f"omega from {p.omega.min():.3g} to {p.omega.max():.3g} rad/s, " if p.n_modes else ""
    return (
        f"The motion of {model.label} with {modes}i_theta = {p.i_theta:.3g} kg m², l0r = {p.l0r:.3g} kg m, "
        f"m_tot = {p.m_tot:.3g} kg and half_width = {p.half_width:.3g} m"
    )
