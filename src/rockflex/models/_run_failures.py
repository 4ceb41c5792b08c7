"""The errors of runs that could not be solved."""

from contextlib import AbstractContextManager

from rockflex.engine.solution import Status
from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.shown import shown
from rockflex.models._rocking_model import RockingModel
from rockflex.models._work import Task

LONGEST_FALL = 300.0  # e-folds of the rotation within a time step; more would overflow


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
    layout, given = model.layout, [f"{value:.6g}" for value in state[: model.layout.core]]
    modes = [("D", given[: layout.modes]), ("D'", given[layout.modes : layout.rotation])] if layout.modes else []
    told = [f"{name} = [{', '.join(values)}]" for name, values in modes]
    others = ["θ", "θ'", *(["x", "x'"] if layout.slip >= 0 else []), *(["z", "z'"] if layout.heave >= 0 else [])]
    others += [f"θ_{k + 2}{rate}" for k in range(layout.n_joints) for rate in ("", "'")]
    told += [f"{name} = {value}" for name, value in zip(others, given[layout.rotation :], strict=True)]
    return SolverError(f"{what} The state there is {', '.join(told)}. {mend}")


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
