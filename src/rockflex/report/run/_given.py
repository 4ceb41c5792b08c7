"""The runs of a report, checked: one structure under one record, by a few models, each with its history."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.motion import GroundMotion
from rockflex.response import History, Response

MOST = 6  # runs, for which a page has room
_HOW = 'Give what simulate(..., output="history") returned, or several of these.'
_SAME = ("m_tot", "half_width", "l0r", "i_theta", "eccentricity")
_CLOSE = 1e-6


@dataclass(frozen=True, eq=False)
class Given:
    """What a report is about.

    Attributes
    ----------
    responses, histories, labels
        Of each run; labels are the models, numbered where one occurs twice.
    properties
        Of the structure, with all modes that are known.
    structure
        The structure itself, or None.
    motion
        The record before scaling, or None.
    scale
        Factor by which it acted on the structure; 1 without a record.
    """

    responses: tuple[Response, ...]
    histories: tuple[History, ...]
    labels: tuple[str, ...]
    properties: RockingProperties
    structure: Any
    motion: GroundMotion | None
    scale: float

    @property
    def widest(self) -> History:
        """The history with the most modes, of a model that lifts if there is one."""
        return max(self.histories, key=lambda h: (h.model.lifts, h.model.properties.n_modes))


def given(responses: Response | Iterable[Response], structure: Any, motion: Any) -> Given:
    """Check what a report is to be made of.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, they are not of one structure and one record, or
        `structure` or `motion` are not theirs.
    """
    runs = _runs(responses)
    histories = tuple(_history(place, run) for place, run in enumerate(runs))
    names = {run.motion for run in runs}
    if len(names) > 1 or not all(_same_ground(histories[0], each) for each in histories[1:]):
        what = f"are of {len(names)} records, {_listed(names)}" if len(names) > 1 else "are of several scales"
        raise InputError(
            f"A report is of one record at one scale, but the responses {what}. Write a report of each.",
            field="responses",
        )
    properties = _properties(structure, histories)
    scale = 1.0 if motion is None else _scale(motion, histories[0], runs[0].motion)
    counts, seen = Counter(run.model for run in runs), Counter[str]()
    labels: list[str] = []
    for run in runs:
        seen[run.model] += 1
        labels.append(run.model if counts[run.model] == 1 else f"{run.model} ({seen[run.model]})")
    return Given(runs, histories, tuple(labels), properties, structure, motion, scale)


def _runs(responses: Any) -> tuple[Response, ...]:
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
    if len(runs) > MOST:
        raise InputError(
            f"A page has room for {MOST} runs, but {len(runs)} were given. Choose the models that matter, or write "
            "several reports.",
            field="responses",
        )
    return runs


def _history(place: int, run: Response) -> History:
    if run.history is None:
        raise InputError(
            f"responses[{place}] ({run.model} under {shown(run.motion)}) keeps peaks only, but a report draws the "
            'history. Simulate it with output="history".',
            field="responses",
        )
    return run.history


def _listed(names: Iterable[str]) -> str:
    return ", ".join(shown(name) for name in sorted(names))


def _same_ground(one: History, other: History) -> bool:
    """Whether two runs had the same ground acceleration while both lasted."""
    end = min(one.time[-1], other.time[-1])
    kept = other.time <= end
    there = np.interp(other.time[kept], one.time, one.ground_acceleration)
    largest = float(np.max(np.abs(one.ground_acceleration)))
    return bool(np.max(np.abs(there - other.ground_acceleration[kept]), initial=0.0) <= _CLOSE * largest)


def _properties(structure: Any, histories: tuple[History, ...]) -> RockingProperties:
    """Return the properties of the structure, which must be that of every run."""
    known = max((each.model.properties for each in histories), key=lambda p: p.n_modes)
    whole = known if structure is None else _rocking(structure)
    for history in histories:
        ran = history.model.properties
        differing = [name for name in _SAME if not _close(getattr(ran, name), getattr(whole, name))]
        modes = min(ran.n_modes, whole.n_modes)
        if not np.allclose(ran.omega[:modes], whole.omega[:modes], rtol=_CLOSE, atol=0.0):
            differing.append("omega")
        if differing:
            first = differing[0]
            values = (
                f"{history.model.label} was run with {first} = {shown(_plain(getattr(ran, first)))}, not "
                f"{shown(_plain(getattr(whole, first)))}"
            )
            if structure is None:
                message = f"A report is of one structure, but {values}. Write a report of each structure."
            else:
                message = f"structure is not that of the responses: {values}. Give the structure that was simulated."
            raise InputError(message, field="responses" if structure is None else "structure")
    return whole


def _rocking(structure: Any) -> RockingProperties:
    from rockflex.structure import structure_warnings

    structure_warnings(structure)  # refuses what is not a structure
    return structure if isinstance(structure, RockingProperties) else structure.rocking()


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


def _close(one: float, other: float) -> bool:
    return bool(np.isclose(one, other, rtol=_CLOSE, atol=0.0))


def _scale(motion: Any, history: History, name: str) -> float:
    """Return the factor on the record that gives the ground acceleration of a run."""
    if not isinstance(motion, GroundMotion):
        raise InputError(
            f"motion must be a GroundMotion, but {type(motion).__name__} was given. Give the one that was simulated.",
            field="motion",
        )
    kept = history.time <= motion.duration
    ran: Array = history.ground_acceleration[kept]
    record = np.interp(history.time[kept], motion.time, motion.acceleration)
    size = float(record @ record)
    scale = float(record @ ran) / size if size > 0.0 else 1.0
    largest = float(np.max(np.abs(ran), initial=0.0))
    if np.max(np.abs(ran - scale * record), initial=0.0) > _CLOSE * largest or (size > 0.0 and scale == 0.0):
        raise InputError(
            f"motion is not that of the responses: {shown(motion.name)} at no scale is the ground acceleration of "
            f"{shown(name)} during the run. Give the record that was simulated, scaled or not.",
            field="motion",
        )
    return float(f"{scale:.9g}")
