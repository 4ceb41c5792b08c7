"""What one visitor may ask of the page: the same for forms, for links and for files."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.models import parse_model
from rockflex.motion import GroundMotion
from rockflex.web._refusal import Refusal

if TYPE_CHECKING:
    from rockflex.study.plans import CloudPlan

__all__ = [
    "BODY",
    "FILE",
    "FREEDOMS",
    "INFINITE",
    "MODELS",
    "RANGES",
    "RUNS",
    "check_motion",
    "check_numbers",
    "check_runs",
    "check_together",
    "errors_of_numbers",
    "pace",
]

FILE = 5_000_000  # bytes of an upload
BODY = 6_000_000  # bytes of any request
FREEDOMS = 200  # stories, masses, rows of a matrix
SAMPLES = 200_000
DURATION = 300.0  # s of a record
MODELS = 4  # side by side
RUNS = 20_000  # of a study
EFFORT = 5e7  # of one run, see `Pace`: some seconds
TOGETHER = 8e7  # of the runs of one answer
STUDY_EFFORT = 6e9  # of all runs of a study: some ten minutes

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


@dataclass(frozen=True)
class Pace:
    """What the work of a model grows with.

    Attributes
    ----------
    label
        Model.
    modes
        How many it has of the structure's.
    fastest
        Its highest circular frequency in rad/s, on the ground or uplifted: on a very narrow base far above ω_k.
    """

    label: str
    modes: int
    fastest: float

    def history(self, motion: GroundMotion, free_vibration: float) -> float:
        """Return about how much work a run with its history is, in some 1e-7 s; as the others, from measurements."""
        return self._work(motion, free_vibration, 20.0 + self.modes**2 / 7.0, 120.0 if self._integrated else 35.0)

    def peaks(self, motion: GroundMotion, free_vibration: float) -> float:
        """Return about how much work a run of which only peaks are kept is."""
        return self._work(motion, free_vibration, 5.0 + self.modes / 2.0, 60.0 if self._integrated else 12.0)

    def energy(self, motion: GroundMotion, free_vibration: float) -> float:
        """Return about how much work the energies of a run are, after the run."""
        turned = (35.0 + 4.0 * self.fastest * motion.dt) * (1.0 + self.modes / 10.0)
        return self._work(motion, free_vibration, 15.0 + 5.0 * self.modes, turned)

    @property
    def _integrated(self) -> bool:
        model = parse_model(self.label)
        return model.complete or model.yields

    def _work(self, motion: GroundMotion, free_vibration: float, each: float, turned: float) -> float:
        """Work of all samples, of which each takes so much, and so much more for each radian of the fastest motion."""
        samples = motion.acceleration.size + free_vibration / motion.dt
        return samples * (each + turned * self.fastest * motion.dt)

    def check(self, work: float, motion: GroundMotion, path: str) -> None:
        """Refuse a run whose work would keep the page busy for long."""
        if work > EFFORT:
            message = (
                f"{self.label} with {self.modes} modes over {motion.acceleration.size} samples takes too long for a "
                "page. Choose a model with fewer modes, a wider base or a shorter record, or use the library."
            )
            raise Refusal({path: message})


def pace(properties: RockingProperties, label: str) -> Pace:
    """Return the pace of a model of a structure."""
    count = parse_model(label).n_modes
    modes = properties.n_modes if count is None else min(count, properties.n_modes)
    if not modes:
        return Pace(label, 0, 0.0)
    p = properties.truncated(modes)
    highest = float(p.omega[-1])
    if not parse_model(label).lifts:
        return Pace(label, modes, highest)
    mass = np.eye(modes + 1)
    mass[0, 0] = p.i_theta
    mass[0, 1:] = mass[1:, 0] = np.sqrt(p.effective_mass) * p.effective_height
    stiffness = np.diag(np.concatenate(([p.rocking_stiffness], p.omega**2)))
    try:
        from scipy.linalg import eigh

        squares = eigh(stiffness, mass, eigvals_only=True)
    except np.linalg.LinAlgError:  # the inertia that is left to rotate is rounding
        return Pace(label, modes, math.inf)
    return Pace(label, modes, max(math.sqrt(max(float(squares[-1]), 0.0)), highest))


def check_together(properties: RockingProperties, labels: Sequence[str], motion: GroundMotion, free: float) -> None:
    """Refuse runs with their histories that take too long, one by one or together."""
    together = 0.0
    for label in labels:
        known = pace(properties, label)
        work = known.history(motion, free)
        known.check(work, motion, "models")
        together += work
    if together > TOGETHER:
        message = "these models take too long together for a page. Choose fewer of them, or a shorter record."
        raise Refusal({"models": message})


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
    each = plan.n_runs / (len(bench.structures) * len(bench.labels) * len(bench.motions))
    free = bench.assumptions.free_vibration or 0.0
    work = 0.0
    for properties in bench.structures:
        for label in bench.labels:
            _check_model(plan, properties, label, path)
            known = pace(properties, label)
            for motion in bench.motions:
                one = known.peaks(motion, free)
                known.check(one, motion, path)
                work += each * one
    if work > STUDY_EFFORT:
        message = "it takes too long for a page. Choose models with fewer modes, or use the command line."
        raise Refusal({path: message})
