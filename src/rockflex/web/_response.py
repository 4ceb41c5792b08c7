"""The Response tab: several models, with histories thinned to the resolution of a screen, and exact peaks."""

import math
from collections.abc import Sequence
from contextlib import suppress
from time import monotonic
from typing import Any

import numpy as np

from rockflex.engine.stops import RunStoppedError, asked_to_stop, stopping_when
from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.json import as_json_value
from rockflex.foundation.language import translated
from rockflex.foundation.units import UnitSystem
from rockflex.models._label import parse_model
from rockflex.models._work import cost_model_of
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._history import History
from rockflex.response._limit_checks import NO_LIMIT, check, check_in_units
from rockflex.response._record_set import RecordSet
from rockflex.response._response import Response, warnings_of_energy, warnings_of_response, warnings_of_sensitivity
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._prepared_case import PreparedCase
from rockflex.web._earthquake import chosen_motion
from rockflex.web._encoding import envelope_indices, pack_array_as_base64
from rockflex.web._limits import check_work_of_runs
from rockflex.web._refusal import Refusal, errors_as_refusals
from rockflex.web._state import PageState
from rockflex.web._structure import (
    SLICED,
    BuiltStructure,
    build_page_structure,
    ground_under_page_structure,
    structure_outline_view,
)
from rockflex.web._uploads import UploadedRecords


def chosen_element(asked: object, p: RockingProperties) -> int | None:
    """Return the element whose loop is drawn: the one asked for, or the first; None if there are none."""
    if not p.elements:
        return None
    return asked if type(asked) is int and 0 <= asked < len(p.elements) else 0


def elements_response_view(p: RockingProperties, response: Response, *, energies: bool) -> dict[str, Any]:
    """Return the peaks of every element in a model that lifts; their energies, which take longer, if wanted."""
    dissipated = response.element_energy.tolist() if energies else [None] * len(p.elements)
    prestress = iter(response.remaining_prestress.tolist())
    columns = (response.max_element_force, response.max_element_elongation, response.element_yielded)
    rows = [
        {
            "force": force,
            "elongation": elongation,
            "energy": energy,
            "yielded": yielded,
            "broken": element.breaks_at <= elongation,
            "prestress": next(prestress) if element.prestressed else None,
        }
        for element, force, elongation, yielded, energy in zip(
            p.elements, *(column.tolist() for column in columns), dissipated, strict=True
        )
    ]
    return {"label": response.model, "rows": rows}


def self_centring_view(p: RockingProperties, rotation: float) -> list[dict[str, Any]]:
    """Return whether weight and prestress close the base about each edge, where dissipators keep it open.

    `ratio` is λ at a vanishing rotation, and `at` that at a rotation in rad, the smaller of both edges.
    """
    at = p.recentring_ratio_at(rotation) if rotation > 0.0 and p.elements else None
    return [
        {"side": pivot.side, "closes": pivot.self_centring, "ratio": pivot.recentring_ratio, "at": at}
        for pivot in p.pivots
        if pivot.dissipator_moment > 0.0
    ]


MAX_HISTORY_POINTS = 2000  # of a history, events aside
MAX_JOINTS_DRAWN = 3  # joints above the base whose rotations are curves, at most
MAX_EVENT_NODES = 600  # nodes of events that are retained, at most
CURVES = ("rotation", "top_displacement", "base_moment", "base_shear", "total_top_displacement")
MAX_ENERGY_COST = 1.0  # s of estimated computing time of the energies, see `CostModel`


def simulate_state_models(
    state: PageState, uploads: UploadedRecords
) -> tuple[BuiltStructure, GroundMotion, list[Response]]:
    """Simulate the models of a state."""
    built = build_page_structure(state.structure)
    motion = chosen_motion(state.record, uploads).scaled(state.scale)
    options = state.run_options(ground_under_page_structure(state.ground, built.properties))
    cases = dict[str, PreparedCase]()
    for label in state.models:
        with errors_as_refusals("models", f"{label}: "):
            cases[label] = options.case(parse_model(label), built.properties, history=True, floors=True)
    check_work_of_runs(list(cases.values()), motion)
    found = list[Response]()
    for label, case in cases.items():
        with errors_as_refusals("models", f"{label}: "):
            found.append(case.run(motion))
    return built, motion, found


MAX_SKETCH_COST = 0.05  # s of estimated computing time of a run; beyond it one mode is drawn
SKETCH_POINTS = 600  # of the history that is drawn
SKETCH = "2DOF-S"  # the model that is fast enough to follow a handle that is dragged


def sketch_view(state: PageState, uploads: UploadedRecords, *, quick: bool) -> dict[str, Any]:
    """Return how the first model that lifts moves, and what a fixed base under the same record would do.

    A `quick` one, and one that would take long, has one mode, whose spectral displacement tells what the fixed base
    does. Where no run is possible, a note says why. The fixed base stands on rigid ground.
    """
    built = build_page_structure(state.structure)
    p = built.properties
    ground = ground_under_page_structure(state.ground, p)
    lifting = next((label for label in state.models if parse_model(label).lifts), "MDOF-S" if p.n_modes else "rigid")
    simple = p.n_modes > 0 and not parse_model(lifting).yields and not p.stories
    drifts = not quick and "drift_ratio" in state.limits  # which only floors have
    moment = top = fixed = None
    try:
        motion = chosen_motion(state.record, uploads).scaled(state.scale)

        def case(label: str, *, main: bool) -> PreparedCase:
            with errors_as_refusals("models", f"{label}: "):
                options = state.run_options(ground if main else None)
                return options.case(parse_model(label), p, history=main or not quick, floors=main and drifts)

        def run(label: str, *, main: bool) -> Response:
            prepared = case(label, main=main)
            check_work_of_runs([prepared], motion)
            with errors_as_refusals("models", f"{label}: "):
                return prepared.run(motion)

        if not quick:
            simple = simple and case(lifting, main=True).task(motion).work().total > MAX_SKETCH_COST
        response = run(SKETCH if simple else lifting, main=True)
    except Refusal as error:
        return {"note": " ".join(error.errors.values())}
    if simple:
        displacement = motion.sd(2.0 * math.pi / float(p.omega[0]), float(p.zeta[0]))
        moment = float(p.effective_mass[0] * p.moment_heights[0] * p.omega[0] ** 2) * displacement
        top = None if p.top_height is None else abs(float(p.top_ordinate[0])) * displacement
    elif p.n_modes:
        with suppress(Refusal):
            fixed = run("fixed", main=False)
            moment, top = fixed.max_base_moment, fixed.max_total_top_displacement
    drawn: dict[str, Any] = {
        "models": [_sketch_curves(built, response, SKETCH_POINTS // 2 if quick else SKETCH_POINTS)],
        "nominal": p.nominal_overturning_rotation,
        "fixed_base_moment": moment,
        "fixed_top_displacement": top,
    }
    if not quick:
        kept = envelope_indices([motion.acceleration], SKETCH_POINTS)
        drawn |= {
            "twin": None if fixed is None else _sketch_curves(built, fixed, SKETCH_POINTS),
            "accelerogram": {
                "t": pack_array_as_base64(motion.time[kept]),
                "a": pack_array_as_base64(motion.acceleration[kept]),
            },
            "checks": checks_view(response, state, friction=friction_is_known(response, state)),
        }
    return as_json_value(drawn)


def _sketch_curves(built: BuiltStructure, response: Response, points: int) -> dict[str, Any]:
    """Return a response as the first tab draws it, with the peaks that it reads."""
    curves = response_curves(built, response, None, points, CURVES[:2])
    unread = [name for name in curves["peaks"] if name.startswith("time_of_") and name != "time_of_max_rotation"]
    curves["peaks"] = {name: value for name, value in curves["peaks"].items() if name not in unread}
    return curves


def response_view(
    state: PageState, uploads: UploadedRecords, focus: object = "", element: object = 0
) -> dict[str, Any]:
    """Return histories, events and peaks of all models, and the loop of one element.

    The energies and the elements are those of the model named `focus`, or of the first; elements of the first that
    lifts if that one does not.
    """
    built, motion, found = simulate_state_models(state, uploads)
    main = next((r for r in found if r.model == focus), found[0])
    p = built.properties
    drawn = chosen_element(element, p)
    energy, curves = _energy_view(motion, main, state), [response_curves(built, response, drawn) for response in found]
    for each, run in zip(curves, found, strict=True):
        each["warnings"] = warnings_of_response(run.model, run.peaks(), UnitSystem(state.units))
        each["warnings"] += () if is_long_run(run, motion, state) else warnings_of_sensitivity(run)
    curves[found.index(main)]["warnings"] += warnings_of_energy(energy.get("closing_error", 0.0))
    return as_json_value(
        {
            **structure_outline_view(state.structure, built, ground_under_page_structure(state.ground, p)),
            "nominal": p.nominal_overturning_rotation,
            "models": curves,
            "element": drawn,
            "held": _element_peaks_view(p, motion, main, found, state),
            "self_centring": self_centring_view(
                p, max((r.max_rotation for r in found if r.status == "rocking"), default=0.0)
            ),
            "suggested_yield": _suggested_yield_displacement(p, motion),
            "energy": energy,
            "floors": floors_view(found[0], stories=state.structure.kind not in SLICED),
            "checks": checks_view(found[0], state, friction=friction_is_known(found[0], state)),
        }
    )


MAX_FLOORS = 60  # of a table


def floors_view(response: Response, *, stories: bool) -> list[dict[str, float]]:
    """Return the peaks of each floor from the top down, with its height in m; none if they are not known.

    Floors that are slices have no `stories`, hence no drifts.
    """
    assert response.history is not None  # asked for in `simulate_state_models`
    peaks, floors = response.floors, response.history.model.properties.floors
    if peaks is None or floors is None or floors.heights.size > MAX_FLOORS:
        return []
    if floors.story_heights.min() <= 0.0:
        return []
    drifts = {"story_drift": peaks.story_drift, "drift_ratio": peaks.story_drift / floors.story_heights}
    columns = {
        "height": floors.heights,
        **(drifts if stories else {}),
        "story_shear": peaks.story_shear,
        "floor_acceleration": peaks.floor_acceleration,
        "total_floor_displacement": peaks.total_floor_displacement,
    }
    if response.ductility.size == floors.heights.size:  # stories that can yield
        columns |= {"ductility": response.ductility, "residual_drift": response.residual_drift}
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    return [dict(zip(columns, row, strict=True)) for row in rows][::-1]


def _suggested_yield_displacement(p: RockingProperties, motion: GroundMotion) -> float | None:
    """Suggest a yield displacement in m, beyond the uplift of the base and below the demand on a fixed base."""
    if not p.n_modes:
        return None
    stiffness = float(p.effective_mass[0] * p.moment_heights[0] * p.omega[0] ** 2)
    held = 1.5 * p.resisting_moment / stiffness
    fixed = 0.5 * motion.sd(2.0 * np.pi / float(p.omega[0]), float(p.zeta[0]))
    return float(f"{min(max(min(held, fixed), 1e-4), 10.0):.2g}")


def response_curves(
    built: BuiltStructure,
    response: Response,
    element: int | None,
    points: int = MAX_HISTORY_POINTS,
    names: Sequence[str] = CURVES,
) -> dict[str, Any]:
    """Return a response as the page draws it, with its peaks and the loop of one element."""
    history = response.history
    assert history is not None  # asked for in `simulate_state_models`
    known = history.model.properties.top_height is not None
    curves = {name: getattr(history, name) for name in names if known or name != "total_top_displacement"}
    curves |= base_motion_curves(history)
    if element is not None and history.model.lifts:
        curves["element_force"] = history.element_force[:, element]
        curves["element_elongation"] = history.element_elongation[:, element]
        points *= 2  # loops need more points than curves over time
    events = np.flatnonzero(np.diff(history.time) == 0.0)[: MAX_EVENT_NODES // 2]
    kept = np.unique(np.concatenate((envelope_indices(list(curves.values()), points), events, events + 1)))
    drawn = built.outline.sway(history.modal_displacement[kept], history.joint_rotation[kept])
    return {
        "label": response.model,
        "status": response.status,
        "peaks": response.peaks(),
        "lifts": history.model.lifts,
        "fall_time": _overturning_time(history),
        "impact_times": history.impact_times[:MAX_EVENT_NODES],
        "t": pack_array_as_base64(history.time[kept]),
        **{name: pack_array_as_base64(values[kept]) for name, values in curves.items()},
        "uplifted": pack_array_as_base64(history.uplifted[kept]),
        "points": pack_array_as_base64(drawn),
        "yielding": _times_of_yielding(history),
    }


def _times_of_yielding(history: History) -> dict[str, list[Any]] | None:
    """Return when each element first yields and breaks, and each story first yields, in s, None if it does not.

    None where nothing can. An element that slides has no such time.
    """
    p = history.model.properties
    if not history.model.elements:
        return None
    states, time, n = history.element_state, history.time, len(p.elements)

    def first(place: int, state: int) -> float | None:
        found = np.flatnonzero(states[:, place] == state)
        return float(time[found[0]]) if found.size else None

    yields = [first(k, 1) if each.states[1] == "yielding" else None for k, each in enumerate(p.elements)]
    return {
        "elements": yields,
        "broken": [first(k, 2) for k in range(n)],
        "stories": [[each.floor, first(n + k, 1)] for k, each in enumerate(p.stories)],
    }


def base_motion_curves(history: History) -> dict[str, Array]:
    """Return how the base of a history moves on its ground, in m, shapes (n_states,); none on rigid ground.

    The slip if it can slide, and on springs the heave and the rise of the edges; and the rotations in rad of up to
    three joints above the base.
    """
    curves = {f"joint_{k}": each for k, each in enumerate(history.joint_rotation.T[:MAX_JOINTS_DRAWN], 1)}
    layout = history.model.layout
    if layout.slip >= 0:
        curves["slip"] = history.slip
    if layout.heave >= 0:
        left, right = history.edge_uplift.T
        curves |= {"heave": history.heave, "left_edge": left, "right_edge": right}
    return curves


def _overturning_time(history: History) -> float | None:
    """Return the time after which the rotation stays beyond the point of balance, if there is one."""
    p = history.model.properties
    balance = np.where(history.rotation < 0.0, p.pivot(-1).balance_rotation, p.pivot(1).balance_rotation)
    inside = np.flatnonzero(np.abs(history.rotation) <= balance)
    if not inside.size or inside[-1] == history.time.size - 1:
        return None
    return float(history.time[inside[-1] + 1])


def _element_peaks_view(
    p: RockingProperties, motion: GroundMotion, main: Response, found: list[Response], state: PageState
) -> dict[str, Any] | None:
    """Return the peaks of the elements in the model `main`, or in the first that lifts; None if nothing is held."""
    shown = next((r for r in (main, *found) if r.history is not None and r.history.model.lifts), None)
    if not p.elements or shown is None:
        return None
    try:
        check_work_of_energy(shown, motion, state)
        return elements_response_view(p, shown, energies=True)
    except (Refusal, InputError):
        return elements_response_view(p, shown, energies=False)


def check_work_of_energy(response: Response, motion: GroundMotion, state: PageState) -> None:
    """Refuse energies that would take too long to compute."""
    assert response.history is not None  # asked for in `simulate_state_models`
    model = response.history.model
    samples = motion.acceleration.size + state.free_vibration / motion.dt
    work = cost_model_of(model, 1).energy(samples, motion.dt) * (
        1.0 + 0.5 * len(model.elements)
    )  # more branches to follow
    if work > MAX_ENERGY_COST:
        raise Refusal({"energy": "the energy is not computed here for so many or such fast modes over so long a time."})


def is_long_run(response: Response, motion: GroundMotion, state: PageState) -> bool:
    """Whether the energies of a run, or its sensitivity, would take too long for an answer or a report."""
    try:
        check_work_of_energy(response, motion, state)
    except Refusal:
        return True
    return False


FRICTION_SECONDS = 2.0  # of an answer, for the friction that a run requires


def friction_is_known(run: Response, state: PageState) -> bool:
    """Compute the friction that a run requires, if it is limited, and tell whether it was in time; the run keeps it."""
    if "friction" not in state.limits or run.history is None or run.history.model.layout.slip >= 0:
        return True
    end, left = monotonic() + FRICTION_SECONDS, asked_to_stop()
    try:
        with stopping_when(lambda: left() or monotonic() > end), suppress(InputError):
            run.history.required_friction_excluding_impacts()
    except RunStoppedError:
        if left():
            raise
        return False
    return True


def checks_view(result: Response | RecordSet, state: PageState, *, friction: bool) -> dict[str, Any]:
    """Return the checks against the limits of a state; `friction` tells whether to compute what friction is required.

    `unlimited` has the names of the checks that only need a limit, and `missing` what the others lack.
    """
    table = check(result, state.check_limits(friction=friction))
    long = translated(
        "the friction that it requires takes more than {n} s here; a set of records computes it in the background",
        n=f"{FRICTION_SECONDS:g}",
    )
    left_out = {"sliding": long} if "friction" in state.limits and not friction else {}
    missing = [(name, left_out.get(name, lacks)) for name, lacks in table.missing]
    rows: list[dict[str, Any]] = []
    for each in table.rows:
        demand, limit, unit = check_in_units(each, UnitSystem(state.units))
        row: dict[str, Any] = {"name": each.name, "value": each.demand, "demand": demand, "limit": limit, "unit": unit}
        rows.append(row | {key: getattr(each, key) for key in ("ratio", "ok", "at_least", "source", "note")})
    return {
        "rows": rows,
        "missing": [each for each in missing if not each[1].startswith(NO_LIMIT)],
        "unlimited": [name for name, lacks in missing if lacks.startswith(NO_LIMIT)],
    }


def _energy_view(motion: GroundMotion, response: Response, state: PageState) -> dict[str, Any]:
    """Return the energies over time, or a note if they cannot be computed."""
    history = response.history
    assert history is not None  # asked for in `simulate_state_models`
    try:
        check_work_of_energy(response, motion, state)
        ledger = history.energy
    except (Refusal, InputError) as error:
        said = error.errors["energy"].capitalize() if isinstance(error, Refusal) else str(error)
        return {"label": response.model, "note": said}
    of_base = ("soil_strain", "friction")
    names = ("kinetic", "strain", "gravity", "element_strain", "damped", "yielded", "lost", "input", *of_base)
    curves = {name: np.asarray(getattr(ledger, name)) for name in names}
    curves["elements"] = ledger.elements.sum(axis=1)
    held = -min(float(ledger.element_strain.min()), 0.0)  # at t = 0, and given back later
    sunk = -min(float(ledger.gravity.min()), 0.0) if history.model.layout.heave >= 0 else 0.0
    curves["soil"] = ledger.soil.sum(axis=1)
    curves["element_strain"] = curves["element_strain"] + held
    curves["gravity"] = curves["gravity"] + sunk  # from the deepest position of a base on springs
    curves["input"] = curves["input"] + float(ledger.stored[0]) + held + sunk
    kept = envelope_indices([curves["kinetic"], curves["strain"]], 1000)
    kept = np.unique(np.concatenate((kept, np.flatnonzero(np.diff(ledger.lost) != 0.0)[:MAX_EVENT_NODES] + 1)))
    return {
        "label": response.model,
        "t": pack_array_as_base64(history.time[kept]),
        **{name: pack_array_as_base64(values[kept]) for name, values in curves.items()},
        "closing_error": ledger.closing_error,
    }
