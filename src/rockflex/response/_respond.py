"""From the solution of a run to its response."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex.models import HEADER, RockingModel, SpringModel, floor_accelerations, lifted_springs, swing_by_side
from rockflex.response._edges import balance_ratio, edges_of, tilt_at_rest
from rockflex.response._element_peaks import Reach, element_peaks, moves_about_pivots, moves_on_springs
from rockflex.response._floor_peaks import FloorPeaks
from rockflex.response._global import EDGES, GLOBAL, is_damped, is_sided, tracked_of_floors
from rockflex.response._history import History
from rockflex.response._response import Response
from rockflex.solve import Solution

MAXIMA = tuple(f"max_{name}" for name in GLOBAL)
TIMES = tuple(f"time_of_{name}" for name in MAXIMA)


def respond(model: RockingModel, motion: str, solution: Solution, *, floors: bool = False) -> Response:
    """Return the response for a solution whose rows are those of `asked_of`, with or without the floors."""
    p = model.properties
    rotation, peaks = float(solution.peaks[0]), solution.peaks[1:]
    right = left = rotation
    swing = (0.0, 0.0)
    end = len(GLOBAL)
    if is_sided(model):
        right, left = peaks[end : end + 2].tolist()
        end += 2
    if is_damped(model):
        count = len(swing_by_side(model))
        swing = float(peaks[end]), float(peaks[end + count - 1])
        end += count
    slid = 0.0
    if model.layout.slip >= 0:
        slid = float(peaks[end])
        end += 1
    if isinstance(model, SpringModel):
        count = len(model.elements)
        right, left = (max(each, 0.0) for each in solution.extremes[len(EDGES) - 2 : len(EDGES)].tolist())
        moves = moves_on_springs(model, solution.extremes[len(EDGES) :], peaks[end : end + count])
        end += count
    else:
        moves = moves_about_pivots(model, Reach((right, left), swing))
    edges = edges_of(model, (right, left), solution)
    left_ground = solution.n_uplifts > 0 or solution.n_impacts > 0
    left_ground = left_ground or _open_throughout(model, rotation, solution.final_state)
    status = "rocking" if left_ground else "no_uplift"
    known = dict(zip(MAXIMA, peaks[: len(GLOBAL)].tolist(), strict=True))
    times = dict(zip(TIMES, solution.peak_times[1 : 1 + len(GLOBAL)].tolist(), strict=True))
    if p.top_height is None:
        known["max_total_top_displacement"] = times["time_of_max_total_top_displacement"] = math.nan
    of_elements = element_peaks(model, moves, solution.final_state)
    final = solution.final_state
    return Response(
        model=model.label,
        motion=motion,
        status="overturned" if solution.overturned else status,
        max_rotation=rotation,
        time_of_max_rotation=float(solution.peak_times[0]),
        **known,
        **times,
        min_vertical_reaction=_least_support(model, p.resting_reaction - solution.lost_support),
        time_of_min_vertical_reaction=solution.time_of_lost_support,
        **of_elements._asdict(),
        residual_rotation=math.nan
        if solution.overturned
        else float(final[model.layout.rotation]) - tilt_at_rest(model),
        balance_ratio=float(balance_ratio(model, right, left)),
        max_slip=slid,
        residual_slip=float(final[model.layout.slip]) if model.layout.slip >= 0 else 0.0,
        max_edge_uplift=max(edges.uplift),
        max_edge_settlement=max(edges.settlement),
        n_uplifts=solution.n_uplifts,
        n_impacts=solution.n_impacts,
        nominal_overturning=right > p.pivot(1).nominal_overturning_rotation
        or left > p.pivot(-1).nominal_overturning_rotation,
        end_time=solution.end_time,
        settled=solution.settled,
        floors=_floor_peaks(model, solution, peaks[end:]) if floors and p.floors is not None else None,
        history=None if solution.states is None else History(model, solution.states),
    )


def _open_throughout(model: RockingModel, rotation: float, final: Array) -> bool:
    """Return whether the base of a run without uplift and impact was off the ground from its start to its end."""
    if not isinstance(model, SpringModel):
        return rotation > 0.0
    edges = lifted_springs(model, np.concatenate((np.zeros(HEADER), final))[None])[0, [0, -1]]
    return bool(edges.any())


def _least_support(model: RockingModel, found: float) -> float:
    """Return the smallest vertical reaction in N; springs cannot pull, and in flight only rounding would say so."""
    return max(found, 0.0) if isinstance(model, SpringModel) else found


def _floor_peaks(model: RockingModel, solution: Solution, peaks: Array) -> FloorPeaks:
    names = tracked_of_floors(model)
    found = dict(zip(names, np.split(peaks, len(names)), strict=True))
    floors = model.properties.floors
    if "floor_acceleration" not in found and floors is not None and solution.states is not None:
        # Not a linear functional for large rotations: take the largest value at samples and events.
        found["floor_acceleration"] = np.abs(floor_accelerations(model, floors, solution.states)).max(axis=0)
    return FloorPeaks(**found)
