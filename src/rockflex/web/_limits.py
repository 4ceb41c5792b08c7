"""What one visitor may ask of the page: the same for forms, for links and for files."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from rockflex.modal import RockingProperties
from rockflex.models import parse_model
from rockflex.motion import GroundMotion
from rockflex.web._refusal import Refusal

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
    "check_run",
    "effort",
]

FILE = 5_000_000  # bytes of an upload
BODY = 6_000_000  # bytes of any request
FREEDOMS = 200  # stories, masses, rows of a matrix
SAMPLES = 200_000
DURATION = 300.0  # s of a record
MODELS = 4  # side by side
RUNS = 20_000  # of a cloud
EFFORT = 4e7  # of one run, see `effort`: some seconds
SWINGS = 2e6  # duration times the highest circular frequency, of a complete model

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
}
"""Least and largest value of a field by its name, whichever structure it belongs to."""


def check_numbers(path: str, value: Any) -> None:
    """Refuse numbers outside their range, lists that are too long, and text in place of numbers.

    Text would be the path of a file: nothing that a visitor writes reaches the file system.
    """
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
    if errors:
        raise Refusal(errors)


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


def effort(properties: RockingProperties, motion: GroundMotion, label: str, free_vibration: float = 0.0) -> float:
    """Return about how much work a run is, in some 1e-7 s: n (k² + ω dt (20 + k/3)), as was measured.

    Here n is the number of samples, k that of modes, and ω the fastest circular frequency, uplifted or not.
    """
    modes = _modes(properties, label)
    samples = motion.acceleration.size + free_vibration / motion.dt
    return samples * (modes**2 + _fastest(properties, label) * motion.dt * (20.0 + modes / 3.0) + 20.0)


def check_run(properties: RockingProperties, motion: GroundMotion, label: str, free_vibration: float) -> None:
    """Refuse a run that would keep the page busy for long."""
    slow = effort(properties, motion, label, free_vibration) > EFFORT
    if parse_model(label).complete:
        slow |= (motion.duration + free_vibration) * _fastest(properties, label) > SWINGS
    if slow:
        message = (
            f"{label} with {_modes(properties, label)} modes over {motion.acceleration.size} samples takes too long "
            "for a page. Choose a model with fewer modes, a wider base or a shorter record, or use the library."
        )
        raise Refusal({"models": message})


def _modes(properties: RockingProperties, label: str) -> int:
    count = parse_model(label).n_modes
    return properties.n_modes if count is None else min(count, properties.n_modes)


def _fastest(properties: RockingProperties, label: str) -> float:
    """Highest circular frequency of a model; on a very narrow base that of the uplifted structure is far above ω_k."""
    modes = _modes(properties, label)
    if not modes:
        return 0.0
    p = properties.truncated(modes)
    if not parse_model(label).lifts:
        return float(p.omega[-1])
    mass = np.eye(modes + 1)
    mass[0, 0] = p.i_theta
    mass[0, 1:] = mass[1:, 0] = np.sqrt(p.effective_mass) * p.effective_height
    stiffness = np.diag(np.concatenate(([p.rocking_stiffness], p.omega**2)))
    try:
        from scipy.linalg import eigh

        squares = eigh(stiffness, mass, eigvals_only=True)
    except np.linalg.LinAlgError:  # the inertia that is left to rotate is rounding
        return math.inf
    return math.sqrt(max(float(squares[-1]), float(p.omega[-1]) ** 2))
