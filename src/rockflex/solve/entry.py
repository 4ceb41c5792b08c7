"""The kernels that Python calls: one for models in closed form, one for those that are integrated.

Each is compiled for one set of types. The former has no vector field, and is compiled without the integrator.
"""

from rockflex._kernel import kernel
from rockflex.models import Impact
from rockflex.solve.adaptive.layout import Flow, Stages
from rockflex.solve.layout import Course, Log, Motion, Progress, System
from rockflex.solve.run import run

__all__ = ["run_in_closed_form", "run_integrated"]


@kernel
def run_in_closed_form(system: System, impact: Impact, course: Course, at: Progress, log: Log, motion: Motion) -> int:
    """Carry a run of a linear model on: see `run`."""
    return run(system, None, impact, course, at, log, motion, None)


@kernel
def run_integrated(
    system: System,
    flow: Flow,
    impact: Impact,
    course: Course,
    at: Progress,
    log: Log,
    motion: Motion,
    stages: Stages,
) -> int:
    """Carry a run of an integrated model on: see `run`."""
    return run(system, flow, impact, course, at, log, motion, stages)
