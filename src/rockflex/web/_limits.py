"""What one visitor may ask of the page: the same for forms, for links and for files."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.models import parse_model
from rockflex.motion import GroundMotion
from rockflex.solve import Task
from rockflex.study import Case
from rockflex.web._refusal import Refusal

if TYPE_CHECKING:
    from rockflex.study.cloud import CloudPlan

FILE = 5_000_000  # bytes of an upload
BODY = 6_000_000  # bytes of any request
FREEDOMS = 200  # stories, masses, rows of a matrix
SAMPLES = 200_000
DURATION = 300.0  # s of a record
MODELS = 4  # side by side
RUNS = 20_000  # of a study
RUN = 1.5  # s of computing that one run may take, as it is estimated (`rockflex.solve.Pace`)
STOP = 5.0  # s of computing at which it is stopped: a hard run takes three times its estimate
TOGETHER = 3.0  # s of the runs of one answer, as they are estimated
STUDY = 180.0  # s of all runs of a study: some minutes

INFINITE = frozenset({"stiffness_ratio", "stiffness_parameter", "beam_stiffness"})
LARGEST = 1e15

RANGES: dict[str, tuple[float, float]] = {
    "n_stories": (1, FREEDOMS),
    "n_modes": (1, 100),
    "n_elements": (2, 2000),
    "story_height": (0.1, 100.0),
    "story_heights": (0.1, 100.0),
    "height": (0.01, 2000.0),
    "period": (0.01, 60.0),
    "aspect_ratio": (0.1, 100.0),
    "damping_ratio": (0.0, 0.99),
    "zeta": (0.0, 0.99),
    "half_width": (1e-3, 1000.0),
    "eccentricity": (-1000.0, 1000.0),
    "base_radius": (1e-2, 500.0),
    "top_radius": (1e-2, 500.0),
    "wall": (1e-3, 100.0),
    "density": (1.0, 1e5),
    "story_mass": (1e-3, 1e12),
    "base_mass": (0.0, 1e12),
    "omega": (1e-3, 1e6),
    "slenderness": (1e-4, 1.5),
    "half_diagonal": (1e-3, 1000.0),
    "stiffness_ratio": (0.0, math.inf),
    "stiffness_parameter": (0.0, math.inf),
    "yield_displacement": (1e-6, 100.0),
    "post_yield_ratio": (0.0, 0.99),
    "gamma": (1e-3, 10.0),
    "beta": (-10.0, 10.0),
    "exponent": (1.0, 50.0),
}
"""Least and largest value of a field by its name, whichever structure it belongs to."""


def check_numbers(path: str, value: Any) -> None:
    """Refuse numbers outside their range, lists that are too long, and text in place of numbers.

    Text would be the path of a file: nothing that a visitor writes reaches the file system.
    """
    errors = errors_of_numbers(path, value)
    if errors:
        raise Refusal(errors)


def errors_of_numbers(path: str, value: Any) -> dict[str, str]:
    """What is wrong with numbers, lists and text, each by itself, in a message for each field."""
    errors: dict[str, str] = {}
    for place, name, each in _leaves(path, value):
        if isinstance(each, str):
            if name not in ("method", "name"):
                errors[place] = "it must be numbers, not the name of a file: import the file instead."
        elif isinstance(each, list):
            errors[place] = f"it holds {len(each)} values, but the page takes {FREEDOMS} at most."
        elif isinstance(each, int | float) and not isinstance(each, bool):
            low, high = RANGES.get(name, (-LARGEST, LARGEST))
            if math.isinf(each) and each > 0.0 and name in INFINITE:
                continue
            if not low <= each <= high:  # NaN, too
                errors[place] = f"it must be from {low:g} to {high:g}, but {each:g} was given."
    return errors


def _leaves(path: str, value: Any, name: str = "") -> Iterator[tuple[str, str, Any]]:
    """Every number and text, with the field that it belongs to, and every list that is too long."""
    if isinstance(value, Mapping):
        for key, each in value.items():
            # The heights of freedoms are a table of their indices.
            field, inner = (name, path) if str(key).isdigit() else (str(key), f"{path}.{key}")
            yield from _leaves(inner, each, field)
    elif isinstance(value, list | tuple):
        if len(value) > FREEDOMS:
            yield path, name, list(value)
            return
        for place, each in enumerate(value):
            yield from _leaves(f"{path}.{place}" if isinstance(each, Mapping) else path, each, name)
    elif value is not None:
        yield path, name, value


def check_motion(motion: GroundMotion, path: str) -> None:
    """Refuse records that are too long."""
    if motion.acceleration.size > SAMPLES or motion.duration > DURATION:
        message = (
            f"the record has {motion.acceleration.size} samples over {motion.duration:.6g} s, but the page takes "
            f"{SAMPLES} samples and {DURATION:g} s at most. Cut it, or use the library."
        )
        raise Refusal({path: message})


def check_together(cases: Sequence[Case], motion: GroundMotion) -> None:
    """Refuse runs that take too long, one by one or together."""
    together = sum(_checked_work(case.task(motion), "models") for case in cases)
    if together > TOGETHER:
        message = "these models take too long together for a page. Choose fewer of them, or a shorter record."
        raise Refusal({"models": message})


def _checked_work(task: Task, path: str) -> float:
    """The work of a run in s; refuse one that would keep the page busy for long."""
    work = task.work().total
    if work > RUN:
        message = (
            f"{task.model.label} with {task.pace.modes} modes over {task.record.size} samples takes too long for a "
            "page. Choose a model with fewer modes, a wider base or a shorter record, or use the library."
        )
        raise Refusal({path: message})
    return work


def _check_model(plan: "CloudPlan", properties: RockingProperties, label: str, path: str) -> None:
    """Refuse a model that the structure cannot have, as one with modes of a rigid block."""
    assumptions, model = plan.bench.assumptions, parse_model(label)
    try:
        model.of(properties, assumptions.impact, assumptions.bouc_wen if model.yields else None)
    except InputError as error:
        raise Refusal({path: str(error)}) from error


def check_runs(plan: "CloudPlan", path: str) -> None:
    """Refuse a study of which no run can be made, that has too many, or whose runs take too long."""
    if plan.n_runs > RUNS:
        message = f"it has {plan.n_runs} runs, but the page takes {RUNS} at most. Use the command line."
        raise Refusal({path: message})
    bench = plan.bench
    largest = max(plan.scales, key=abs)
    work = 0.0
    for structure, properties in enumerate(bench.structures):
        for model, label in enumerate(bench.labels):
            _check_model(plan, properties, label, path)
            for record in range(len(bench.motions)):
                task = bench.task(structure, record, model, largest)
                if task is not None:
                    work += len(plan.scales) * _checked_work(task, path)
    if work > STUDY:
        message = "it takes too long for a page. Choose models with fewer modes, or use the command line."
        raise Refusal({path: message})
