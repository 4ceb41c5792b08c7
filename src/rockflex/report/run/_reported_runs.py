"""The runs of a report, checked: one structure under one record, by a few models, each with its history."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.units import UnitSystem
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._history import History
from rockflex.response._response import Response, history_of
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import structure_warnings

MAX_RUNS = 6  # runs, for which a page has room
_HOW = 'Give what simulate(..., output="history") returned, or several of these.'
_COMPARED = ("m_tot", "half_width", "l0r", "i_theta", "eccentricity")
_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class ReportedRuns:
    """The checked input of a report: one value of each run, and what is known of all."""

    responses: tuple[Response, ...]
    histories: tuple[History, ...]
    labels: tuple[str, ...]  # the models, numbered where one occurs twice
    properties: RockingProperties  # with all modes that are known
    structure: Any  # None if it is not known
    motion: GroundMotion | None  # before scaling
    scale: float  # by which it acted on the structure; 1 without a record
    units: UnitSystem  # of the page


def checked_reported_runs(
    responses: Response | Iterable[Response], structure: Any, motion: Any, units: UnitSystem
) -> ReportedRuns:
    """Check the input of a report."""
    runs = _checked_responses(responses)
    histories = tuple(history_of(run, place) for place, run in enumerate(runs))
    differing = _differing_ground_motions_text([run.motion for run in runs], histories)
    if differing:
        raise InputError(
            f"A report is of one record at one scale, but the responses {differing}. Write a report of each.",
            field="responses",
        )
    properties = _common_rocking_properties(structure, histories)
    scale = 1.0 if motion is None else _scale_of_record_in_run(motion, histories[0], runs[0].motion)
    counts, seen = Counter(run.model for run in runs), Counter[str]()
    labels: list[str] = []
    for run in runs:
        seen[run.model] += 1
        labels.append(run.model if counts[run.model] == 1 else f"{run.model} ({seen[run.model]})")
    return ReportedRuns(runs, histories, tuple(labels), properties, structure, motion, scale, units)


def _checked_responses(responses: Any) -> tuple[Response, ...]:
    if isinstance(responses, Response):
        return (responses,)
    if not isinstance(responses, Iterable) or isinstance(responses, str):
        raise InputError(
            f"responses must be one or several responses, but {shown(responses)} was given. {_HOW}", field="responses"
        )
    runs: tuple[Any, ...] = tuple(responses)
    for place, run in enumerate(runs):
        if not isinstance(run, Response):
            raise InputError(
                f"responses[{place}] must be a Response, but {type(run).__name__} was given. {_HOW}", field="responses"
            )
    if not runs:
        raise InputError(f"There is no response to report. {_HOW}", field="responses")
    if len(runs) > MAX_RUNS:
        raise InputError(
            f"A page has room for {MAX_RUNS} runs, but {len(runs)} were given. Choose the models that matter, or write "
            "several reports.",
            field="responses",
        )
    return runs


def _differing_ground_motions_text(motions: list[str], histories: tuple[History, ...]) -> str:
    """Return in words how the ground of some runs differs; empty if it does not."""
    names, (first, *others) = set(motions), histories
    if len(names) > 1:
        return f"are of {len(names)} records, {', '.join(shown(name) for name in sorted(names))}"
    if not all(_same_ground_acceleration(first, each) for each in others):
        return "are of several scales"
    if not all(_same_ground_acceleration(first, each, "vertical_ground_acceleration") for each in others):
        return "differ in the vertical acceleration of the ground"
    return ""


def _same_ground_acceleration(one: History, other: History, of: str = "ground_acceleration") -> bool:
    """Whether two runs had the same ground acceleration, or that named by `of`, while both lasted."""
    jumps = one.time[~_instants_without_jumps(one.time)]
    compared = (other.time <= one.time[-1]) & _instants_without_jumps(other.time) & ~np.isin(other.time, jumps)
    there: Array = getattr(one, of)
    here: Array = getattr(other, of)
    return _equal_accelerations(
        np.interp(other.time[compared], one.time, there), here[compared], float(np.max(np.abs(there)))
    )


def _equal_accelerations(one: Array, other: Array, largest: float) -> bool:
    return bool(np.max(np.abs(one - other), initial=0.0) <= _TOLERANCE * largest)


def _instants_without_jumps(time: Array) -> Bools:
    """Return which instants have one row; where there are two, the acceleration may jump, as at the end of a record."""
    double = np.diff(time) == 0.0
    return ~(np.append(double, False) | np.append(False, double))


def _common_rocking_properties(structure: Any, histories: tuple[History, ...]) -> RockingProperties:
    """Return the properties of the structure, after comparing them with every run."""
    if structure is None:
        whole = max((each.model.properties for each in histories), key=lambda p: p.n_modes)
    else:
        structure_warnings(structure)  # raises if it is no structure
        whole: RockingProperties = structure.rocking()
    for history in histories:
        ran = history.model.properties
        modes = min(ran.n_modes, whole.n_modes)
        values: dict[str, tuple[Any, Any]] = {name: (getattr(ran, name), getattr(whole, name)) for name in _COMPARED}
        values["omega"] = ran.omega[:modes], whole.omega[:modes]
        differing = (name for name, pair in values.items() if not np.allclose(*pair, rtol=_TOLERANCE, atol=0.0))
        first = next(differing, None)
        if first is not None:
            one, other = (shown(np.asarray(getattr(each, first)).tolist()) for each in (ran, whole))
            said = f"{history.model.label} was run with {first} = {one}, not {other}"
            if structure is None:
                message = f"A report is of one structure, but {said}. Write a report of each structure."
            else:
                message = f"structure is not that of the responses: {said}. Give the structure that was simulated."
            raise InputError(message, field="responses" if structure is None else "structure")
    return whole


def _scale_of_record_in_run(motion: Any, history: History, name: str) -> float:
    """Return the factor on the record that gives the ground acceleration of a run."""
    if not isinstance(motion, GroundMotion):
        raise InputError(
            f"motion must be a GroundMotion, but {type(motion).__name__} was given. Give the one that was simulated.",
            field="motion",
        )
    # At its end a record may jump to zero, and a run that ends there has one side of the jump only.
    compared = (history.time < (1.0 - _TOLERANCE) * motion.duration) & _instants_without_jumps(history.time)
    time, ran = history.time[compared], history.ground_acceleration[compared]
    record = np.interp(time, motion.time, motion.acceleration)
    size = float(record @ record)
    scale = float(record @ ran) / size if size > 0.0 else 1.0
    if not _equal_accelerations(ran, scale * record, float(np.max(np.abs(ran), initial=0.0))) or (
        size > 0.0 and scale == 0.0
    ):
        raise InputError(
            f"motion is not that of the responses: {shown(motion.name)} at no scale is the ground acceleration of "
            f"{shown(name)} during the run. Give the record that was simulated, scaled or not.",
            field="motion",
        )
    rise = 0.0 * time if motion.vertical is None else scale * np.interp(time, motion.time, motion.vertical)
    shook = history.vertical_ground_acceleration[compared]
    if not _equal_accelerations(shook, rise, float(np.max(np.abs(rise), initial=0.0))):
        had, has = ("with" if np.any(each) else "without" for each in (shook, rise))
        raise InputError(
            f"motion is not that of the responses: they were run {had} vertical acceleration, but {shown(motion.name)} "
            f"is {has} it{', or with another' if had == has else ''}. Give the record that was simulated, scaled or "
            "not.",
            field="motion",
        )
    return float(f"{scale:.9g}")
