"""Alternatives that the page keeps: side by side with the present structure, drawn, tabled and reported."""

from contextlib import nullcontext
from string import ascii_uppercase
from typing import Any

from rockflex.foundation.json import as_json_value
from rockflex.foundation.language import translated, use_language
from rockflex.foundation.units import UnitSystem
from rockflex.models._label import parse_model
from rockflex.report.project._project import Project
from rockflex.report.run._comparison_page import demand_table
from rockflex.report.run._report_page import write_report
from rockflex.studies._compare import MAX_ALTERNATIVES
from rockflex.studies._prepared_case import PreparedCase
from rockflex.web._earthquake import chosen_motion
from rockflex.web._limits import RUN_WORK_LIMIT, check_work_of_runs
from rockflex.web._refusal import Refusal, errors_as_refusals, temporary_folder
from rockflex.web._response import SKETCH_POINTS, response_curves
from rockflex.web._state import Alternative, PageState, refusals_of_alternative
from rockflex.web._structure import (
    build_page_structure,
    ground_under_page_structure,
    structure_outline_view,
)
from rockflex.web._uploads import UploadedRecords


def alternatives_of_state(state: PageState) -> dict[str, PageState]:
    """Return the kept alternatives by their names, and the present structure by a free letter if it is another one.

    Each is a state of the page by itself.
    """
    found = {each.name: state.kept_state(each) for each in state.alternatives}
    if not any(_runs_as(each, state) for each in state.alternatives):
        if len(found) == MAX_ALTERNATIVES:
            raise Refusal({"alternatives": f"they are {MAX_ALTERNATIVES + 1} with the present one. Remove one."})
        found[next_free_name(state)] = state
    return found


def next_free_name(state: PageState) -> str:
    """Return the letter of the present structure: the first that no kept one has."""
    return next(letter for letter in ascii_uppercase if letter not in {each.name for each in state.alternatives})


def model_of_alternative(state: PageState | Alternative) -> str:
    """Return the model of an alternative: the first that lifts, if one does."""
    return next((label for label in state.models if parse_model(label).lifts), state.models[0])


def _runs_as(kept: Alternative, state: PageState) -> bool:
    own = Alternative.model_fields.keys() - {"name", "models"}
    return model_of_alternative(kept) == model_of_alternative(state) and all(
        getattr(kept, name) == getattr(state, name) for name in own
    )


def project_of_state(state: PageState, uploads: UploadedRecords) -> Project:
    """Return the project of the kept alternatives and the present structure, whose runs may not take too long."""
    motion, cases = chosen_motion(state.record, uploads).scaled(state.scale), list[PreparedCase]()
    given: dict[str, dict[str, Any]] = {name: {} for name in ("structures", "model", "ground", "bouc_wen", "impact")}
    for name, each in alternatives_of_state(state).items():
        with nullcontext() if each is state else refusals_of_alternative(name), errors_as_refusals(""):
            built = build_page_structure(each.structure)
            ground, model = ground_under_page_structure(each.ground, built.properties), model_of_alternative(each)
            options = each.run_options(ground)
            cases.append(options.case(parse_model(model), built.properties, history=True, floors=True))
            yielding = each.hysteresis() if parse_model(model).yields else None
            own = (built.structure, model, ground, yielding, each.law())
            for part, value in zip(given.values(), own, strict=True):
                part |= {} if value is None else {name: value}
    check_work_of_runs(cases, motion)
    with errors_as_refusals("alternatives"):
        structures = given.pop("structures")
        own = {"limits": state.check_limits(), "head": state.head_texts()}
        return Project(structures, motion, **given, free_vibration=state.free_vibration, **own)  # pyright: ignore[reportArgumentType]


def alternatives_view(state: PageState, uploads: UploadedRecords) -> dict[str, Any]:
    """Return the table of demands and differences, and how each kept alternative moves."""
    found, kept = alternatives_of_state(state), [each.name for each in state.alternatives]
    if len(found) < 2:  # the present structure is the one that was kept
        return {"heads": [], "rows": [], "present": "", "kept": []}
    project = project_of_state(state, uploads)
    with errors_as_refusals("alternatives"):
        comparison = project.comparison(1, RUN_WORK_LIMIT)
    ghosts, table = list[dict[str, Any]](), demand_table(comparison, UnitSystem(state.units))
    for name, response in zip(kept, comparison.responses, strict=False):  # the present one is the last
        entry = found[name].structure
        built = build_page_structure(entry)
        moving = {"name": name, "models": [response_curves(built, response, None, SKETCH_POINTS)]}
        ghosts.append(structure_outline_view(entry, built, project.ground.get(name)) | moving)
    return as_json_value(
        {
            "heads": [f"{name} [{unit}]" if unit else name for name, unit in table.heads],
            "rows": [[{"text": cell.text, "value": cell.value} for cell in row] for row in table.rows],
            "present": "".join(name for name in found if name not in kept),
            "kept": ghosts,
        }
    )


def comparison_report_file(state: PageState, uploads: UploadedRecords) -> tuple[str, bytes]:
    """Return the name and the content of the report of all alternatives."""
    project = project_of_state(state, uploads)
    with temporary_folder("alternatives") as folder, errors_as_refusals("alternatives"), use_language(state.language):
        comparison = project.comparison(1, RUN_WORK_LIMIT)
        told: dict[str, Any] = {"units": state.units, "language": state.language, **project.head}
        if state.scale != 1.0 and "title" not in told:
            record = f"{project.motions[0].name or translated('a ground motion')} × {state.scale:g}"
            told["title"] = translated(
                "{structure} under {record}", structure=", ".join(project.structures), record=record
            )
        file = write_report(comparison, folder / "comparison.html", **told)
        return file.name, file.read_bytes()
