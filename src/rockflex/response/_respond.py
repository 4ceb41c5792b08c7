"""From the solutions of runs to their responses, or to columns of a table for many runs."""

import math
from collections.abc import Mapping, Sequence
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.engine.solution import Solution, Solutions
from rockflex.foundation.arrays import Array
from rockflex.models._rocking_model import RockingModel
from rockflex.models._stored_energies import floor_accelerations
from rockflex.response._floors import FloorPeaks
from rockflex.response._history import History
from rockflex.response._outputs import outputs_of
from rockflex.response._peaks import (
    FLOORS,
    GLOBAL,
    ROTATIONS,
    TrackedPeaks,
    column_pull,
    largest_rotations,
    leaning_push,
    may_fall,
    peak_numbers,
)
from rockflex.response._response import PEAKS, Response


def response_of_solution(model: RockingModel, motion: str, solution: Solution, tracked: TrackedPeaks) -> Response:
    """Return the response of a model from the solution of a run, and what this tracked."""
    p, final, known = model.properties, solution.final_state, peak_numbers(model, solution, tracked)
    peaks, times = tracked.of(solution), tracked.peaks.named(solution.peak_times)
    rotation, (right, left) = known["max_rotation"], largest_rotations(peaks)
    left_ground = solution.n_uplifts > 0 or solution.n_impacts > 0
    left_ground = left_ground or model.stayed_uplifted(rotation, final)
    status = "rocking" if left_ground else "no_uplift"
    known |= {f"time_of_max_{name}": float(times[name]) for name in ("rotation", *GLOBAL)}
    if p.top_height is None:
        known["time_of_max_total_top_displacement"] = math.nan
    known["time_of_min_joint_force"] = 0.0
    if tracked.extremes is not None and model.joints:
        least = int(np.argmax(peaks["joint_relief"]))
        known["time_of_min_joint_force"] = float(tracked.extremes.named(solution.extreme_times)["joint_relief"][least])
    return Response(
        model=model.label,
        motion=motion,
        status="overturned" if solution.overturned else status,
        **known,
        time_of_min_vertical_reaction=solution.time_of_lost_support,
        n_uplifts=solution.n_uplifts,
        n_impacts=solution.n_impacts,
        guarded_impacts=solution.n_guarded / max(solution.n_impacts, 1),
        nominal_overturning=right > p.pivot(1).nominal_overturning_rotation
        or left > p.pivot(-1).nominal_overturning_rotation,
        may_fall=bool(
            may_fall(
                [p],
                model.layout,
                final[None],
                np.array([rotation]),
                np.array([status == "rocking" and not (solution.overturned or solution.settled)]),
            )[0]
        ),
        end_time=solution.end_time,
        settled=solution.settled,
        floors=_floor_peaks(model, solution, peaks),
        history=None if solution.states is None else History(model, solution.states),
    )


def _floor_peaks(model: RockingModel, solution: Solution, peaks: Mapping[str, Array]) -> FloorPeaks | None:
    """Return the peaks of the floors if they are tracked."""
    found, floors = {name: peaks[name] for name in FLOORS if name in peaks}, model.properties.floors
    if not found or floors is None:
        return None
    if "floor_acceleration" not in found and solution.states is not None:
        # Not a linear functional for large rotations: take the largest value at samples and events.
        found["floor_acceleration"] = np.abs(floor_accelerations(model, floors, solution.states)).max(axis=0)
    return FloorPeaks(**found)


STATUSES = ("no_uplift", "rocking", "overturned")

NAMES = ("status", *(name for name in PEAKS if name not in ("model", "motion", "status")))

_values_of = attrgetter(*NAMES)

MAX_OF_STORIES = ("max_ductility", "max_residual_drift_ratio")
BY_STORY = ("ductility", "residual_drift")

OF_MOVING_BASES = outputs_of("sliding", "springs", "joints")

Columns = dict[str, NDArray[Any]]


def missing_values(count: int, kind: Any) -> NDArray[Any]:
    """Return a column of NaN; of zeros if the kind has no NaN."""
    return np.full(count, math.nan if np.dtype(kind).kind == "f" else 0, kind)


def response_columns_of_runs(models: Sequence[RockingModel], solutions: Solutions, tracked: TrackedPeaks) -> Columns:
    """Return the status and every number and flag of the responses of R runs, as `columns_of_responses` does.

    There is a model for every run; they are of one kind, differ only in numbers, and tracked the same.
    """
    first = models[0]
    if not first.has_bare_base:
        return columns_of_responses(
            [
                None if place in solutions.failures else response_of_solution(model, "", solutions.one(place), tracked)
                for place, model in enumerate(models)
            ]
        )
    return _of_bare_base(models, solutions, tracked)


def story_results(response: Response) -> dict[str, float]:
    """Return `MAX_OF_STORIES`, and `BY_STORY` with the number of each story from 1, such as `ductility_1`.

    Nothing if no story of the model can yield.
    """
    if not response.ductility.size:
        return {}
    found = {name: getattr(response, name) for name in MAX_OF_STORIES}
    by_story = {name: getattr(response, name).tolist() for name in BY_STORY}
    return found | {f"{name}_{k}": each for name, values in by_story.items() for k, each in enumerate(values, 1)}


def columns_of_responses(responses: Sequence[Response | None]) -> Columns:
    """Return the status, as a place in `STATUSES`, every number and flag, and `story_results` of R responses.

    Each has the shape (R,). The values where there is no response mean nothing; if there is none at all, there are no
    columns. What a response has not is NaN.
    """
    found: Columns = {}
    for place, response in enumerate(responses):
        if response is None:
            continue
        values = dict(zip(NAMES, _values_of(response), strict=True)) | story_results(response)
        for name, value in values.items():
            if name not in found:
                found[name] = missing_values(len(responses), np.int64 if name == "status" else type(value))
            found[name][place] = STATUSES.index(value) if name == "status" else value
    return found


def _numbers_of(model: RockingModel) -> tuple[float, ...]:
    """Return whether a model has a top, its half width, its reaction at rest, and two rotations for each pivot."""
    p = model.properties
    sides = [p.pivot(side) for side in (1, -1)]
    rotations = [(each.balance_rotation, each.nominal_overturning_rotation) for each in sides]
    return p.top_height is not None, p.half_width, p.resting_reaction, *rotations[0], *rotations[1]


def _of_bare_base(models: Sequence[RockingModel], solutions: Solutions, tracked: TrackedPeaks) -> Columns:
    """Return the columns of bases on rigid ground without elements, on which they do not slide."""
    model, runs = models[0], len(solutions)
    peaks, times = (tracked.peaks.named(values) for values in (solutions.peaks, solutions.peak_times))
    distinct = {id(each): _numbers_of(each) for each in {id(each): each for each in models}.values()}
    numbers = np.array([distinct[id(each)] for each in models]).T
    has_top, half_width, resting, balance_right, nominal_right, balance_left, nominal_left = numbers
    right, left = (peaks.get(name, peaks["rotation"]) for name in ROTATIONS)
    found: Columns = {f"max_{name}": peaks[name] for name in ("rotation", *GLOBAL)}
    found |= {f"time_of_max_{name}": times[name] for name in ("rotation", *GLOBAL)}
    for name in ("max_total_top_displacement", "time_of_max_total_top_displacement"):
        found[name] = np.where(has_top > 0.0, found[name], np.nan)
    rocks = (solutions.n_uplifts > 0) | (solutions.n_impacts > 0) | (peaks["rotation"] > 0.0)
    lever = np.maximum(np.sin(left), np.sin(right)) if model.complete else np.maximum(left, right)
    leaning = np.zeros(runs)
    for k, each in enumerate(models):
        if each.properties.leaning_mass:
            leaning[k] = leaning_push(each.properties, peaks["rotation"][k], peaks["base_shear"][k])
    nothing, never = np.zeros(runs), np.zeros(runs, dtype=np.bool_)
    return found | {
        "status": np.where(solutions.overturned, 2, rocks.astype(np.int64)),
        "min_vertical_reaction": resting - solutions.lost_support,
        "time_of_min_vertical_reaction": solutions.time_of_lost_support,
        "time_of_min_joint_force": nothing,
        "max_tendon_force": nothing,
        "tendon_utilisation": nothing,
        "tendon_yield": never,
        "tendon_overload": never,
        "residual_rotation": np.where(solutions.overturned, np.nan, solutions.final_state[:, model.layout.rotation]),
        "balance_ratio": np.maximum(right / balance_right, left / balance_left),
        **dict.fromkeys(OF_MOVING_BASES, nothing),
        "max_edge_uplift": 2.0 * half_width * lever,
        "leaning_push": leaning,
        "column_pull": np.array(
            [
                column_pull(each.properties, float(moment))
                for each, moment in zip(models, peaks["base_moment"], strict=True)
            ]
        ),
        "n_uplifts": solutions.n_uplifts,
        "n_impacts": solutions.n_impacts,
        "guarded_impacts": solutions.guarded_impacts,
        "nominal_overturning": (right > nominal_right) | (left > nominal_left),
        "may_fall": may_fall(
            [each.properties for each in models],
            model.layout,
            solutions.final_state,
            peaks["rotation"],
            rocks & ~(solutions.overturned | solutions.settled),
        ),
        "end_time": solutions.end_time,
        "settled": solutions.settled,
    }
