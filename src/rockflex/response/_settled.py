"""The rotation at which a base comes to rest after a run."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.models import HEADER, SIDE, Quantities, RockingModel
from rockflex.response._edges import tilt_at_rest
from rockflex.solve import Engine


def settled_rotation(model: RockingModel, states: Array, work_limit: float | None) -> float:
    """Continue a run from its last state until it settles; see `History.settled_rotation`."""
    layout, last = model.layout, states[-1:]
    if model.bouc_wen is not None:
        raise InputError(f"The hysteretic spring of {model.label} never comes to rest, so no rotation remains.")
    if abs(layout.of(last, layout.rotation)[0]) >= 0.5 * math.pi:
        return math.nan
    (key,) = model.branches_at(last[:, SIDE], layout.of(last, layout.rotation), last).astype(np.int64).tolist()
    step = float(np.median(np.diff(np.unique(states[:, 0])))) if states.shape[0] > 1 else 0.01
    found = Engine(model, Quantities.none(layout.modes)).run(
        np.zeros(2), step, free_vibration=None, state=(tuple(key), last[0, HEADER:].copy()), work_limit=work_limit
    )
    return math.nan if found.overturned else float(found.final_state[layout.rotation]) - tilt_at_rest(model)
