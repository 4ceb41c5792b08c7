"""The peaks of many runs of a model as columns, without a response for each."""

from collections.abc import Sequence
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.models import RockingModel, SpringModel
from rockflex.response._edges import balance_ratio
from rockflex.response._global import GLOBAL, is_sided
from rockflex.response._respond import MAXIMA, TIMES, respond
from rockflex.response._response import PEAKS, Response
from rockflex.solve import Solutions

STATUSES = ("no_uplift", "rocking", "overturned")

NAMES = ("status", *(name for name in PEAKS if name not in ("model", "motion", "status")))

_values_of = attrgetter(*NAMES)

Columns = dict[str, NDArray[Any]]


def columns_of(model: RockingModel, solutions: Solutions) -> Columns:
    """Return the status and every number and flag of the responses of R runs, as `columns_among` does."""
    if model.properties.elements or isinstance(model, SpringModel) or model.layout.slip >= 0:
        runs = range(len(solutions))
        return columns_among([None if k in solutions.failures else respond(model, "", solutions.one(k)) for k in runs])
    return _of_bare_base(model, solutions)


def columns_among(responses: Sequence[Response | None]) -> Columns:
    """Return the status, as a place in `STATUSES`, and every number and flag of R responses, each of shape (R,).

    The values where there is no response mean nothing; if there is none at all, there are no columns.
    """
    found: Columns = {}
    for place, response in enumerate(responses):
        if response is None:
            continue
        for name, value in zip(NAMES, _values_of(response), strict=True):
            if name not in found:
                found[name] = np.zeros(len(responses), np.int64 if name == "status" else type(value))
            found[name][place] = STATUSES.index(value) if name == "status" else value
    return found


def _of_bare_base(model: RockingModel, solutions: Solutions) -> Columns:
    """Return the columns of a base on rigid ground without elements, on which it does not slide."""
    p, runs, last = model.properties, len(solutions), 1 + len(GLOBAL)
    rotation = solutions.peaks[:, 0]
    right, left = (solutions.peaks[:, last], solutions.peaks[:, last + 1]) if is_sided(model) else (rotation, rotation)
    found: Columns = dict(zip(MAXIMA, solutions.peaks[:, 1:last].T, strict=True))
    found |= dict(zip(TIMES, solutions.peak_times[:, 1:last].T, strict=True))
    if p.top_height is None:
        missing = np.full(runs, np.nan)
        found |= {"max_total_top_displacement": missing, "time_of_max_total_top_displacement": missing}
    rocks = (solutions.n_uplifts > 0) | (solutions.n_impacts > 0) | (rotation > 0.0)
    lever = np.maximum(np.sin(left), np.sin(right)) if model.complete else np.maximum(left, right)
    nothing, never = np.zeros(runs), np.zeros(runs, dtype=np.bool_)
    return found | {
        "status": np.where(solutions.overturned, 2, rocks.astype(np.int64)),
        "max_rotation": rotation,
        "time_of_max_rotation": solutions.peak_times[:, 0],
        "min_vertical_reaction": p.resting_reaction - solutions.lost_support,
        "time_of_min_vertical_reaction": solutions.time_of_lost_support,
        "max_tendon_force": nothing,
        "tendon_utilisation": nothing,
        "tendon_yield": never,
        "tendon_overload": never,
        "residual_rotation": np.where(solutions.overturned, np.nan, solutions.final_state[:, model.layout.rotation]),
        "balance_ratio": balance_ratio(model, right, left),
        "max_slip": nothing,
        "residual_slip": nothing,
        "max_edge_uplift": 2.0 * p.half_width * lever,
        "max_edge_settlement": nothing,
        "n_uplifts": solutions.n_uplifts,
        "n_impacts": solutions.n_impacts,
        "nominal_overturning": (right > p.pivot(1).nominal_overturning_rotation)
        | (left > p.pivot(-1).nominal_overturning_rotation),
        "end_time": solutions.end_time,
        "settled": solutions.settled,
    }
