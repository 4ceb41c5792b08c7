"""A set of records of the Response tab: its runs as a job, and its statistics, design values and checks."""

import secrets
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rockflex.engine.stops import check_interruption
from rockflex.foundation.json import as_json_value
from rockflex.foundation.language import translated
from rockflex.foundation.units import UnitSystem
from rockflex.models._label import parse_model
from rockflex.motion._ground_motion import GroundMotion
from rockflex.report.run._report_page import run_report_as_html
from rockflex.response._limit_checks import check
from rockflex.response._outputs import DEMANDS_BY_RECORD, OUTPUTS
from rockflex.response._record_set import RecordSet, checked_rule
from rockflex.response._response import Response
from rockflex.studies._prepared_case import PreparedCase
from rockflex.web._encoding import envelope_indices, pack_array_as_base64
from rockflex.web._jobs import RunsJob
from rockflex.web._limits import check_size_of_set
from rockflex.web._refusal import Refusal, errors_as_refusals
from rockflex.web._response import checks_view
from rockflex.web._script import record_set_script
from rockflex.web._selection import SELECTED, SELECTIONS, VisitorRecords, records_of_named_suites
from rockflex.web._state import PageState
from rockflex.web._structure import BuiltStructure, build_page_structure, ground_under_page_structure
from rockflex.web._studies import StudyPage
from rockflex.web._uploads import LatestValuesCache, UploadedRecords

CURVE_POINTS = 500  # of the rotation under one record
MAX_KEPT_BYTES = 200_000_000  # of the states of all sets in memory


def _bytes_of_set(found: RecordSet) -> int:
    return sum(run.history.states.nbytes for run in found.responses if run.history is not None)


_SETS = LatestValuesCache[RecordSet](MAX_KEPT_BYTES, _bytes_of_set)


@dataclass(frozen=True, eq=False)
class RecordSetStudy:
    """The runs of one model under a set of records; `friction` tells whether the checks need what is required."""

    built: BuiltStructure
    case: PreparedCase
    records: VisitorRecords
    motions: tuple[GroundMotion, ...]
    periods: tuple[float, float] | None
    friction: bool
    state: PageState


def record_set_study(state: PageState, uploads: UploadedRecords) -> RecordSetStudy:
    """Return the runs of the set of records of a state."""
    choice, label, built = state.record_set, state.model_of_set, build_page_structure(state.structure)
    options = state.run_options(ground_under_page_structure(state.ground, built.properties))
    with errors_as_refusals("record_set.model", f"{label}: "):
        case = options.case(parse_model(label), built.properties, history=True, floors=True)
    records = records_of_named_suites(state, choice.suites, uploads, "record_set.suites")
    motions = tuple(each if choice.scale == 1.0 else each.scaled(choice.scale) for each in records.load(Path()))
    check_size_of_set(case, motions, "record_set.suites")
    with errors_as_refusals("record_set.rule"):
        checked_rule(choice.rule or None, len(motions))
    periods = None
    if choice.suites == [SELECTED]:
        chosen = SELECTIONS.of(state, uploads)[0].periods
        periods = (float(chosen[0]), float(chosen[-1]))
    # On springs the required friction takes minutes.
    friction = "friction" in state.limits and case.model.springs is None
    return RecordSetStudy(built, case, records, motions, periods, friction, state)


class RecordSetJob(RunsJob):
    """A set of records, computed record after record."""

    def __init__(self, study: RecordSetStudy, kind: str) -> None:
        super().__init__(kind)
        self.study, self.key = study, secrets.token_hex()

    def work(self) -> None:
        """Run all records, and compute of each what the views of the set ask for at once."""
        found, study = list[Response](), self.study
        for motion in study.motions:
            check_interruption()
            with errors_as_refusals("record_set.suites", f"{motion.name}: "):
                found.append(study.case.run(motion))
            _ = found[-1].warnings  # its energies, which the response then has
            check(found[-1], study.state.check_limits(friction=study.friction))
            self.runs += 1
        given: dict[str, Any] = {"properties": study.built.properties, "rule": None, "periods": study.periods}
        _SETS.put(self.key, RecordSet(responses=tuple(found), motions=study.motions, **given))


def _set_of_job(job: RecordSetJob, state: PageState) -> RecordSet:
    """Return the set with the rule of a state."""
    found = _SETS.get(job.key)
    if job.status != "done" or found is None:
        raise Refusal("The server does not have all records of this set (any more). Simulate it again.", 404)
    with errors_as_refusals("record_set.rule"):
        return replace(found, rule=checked_rule(state.record_set.rule or None, len(found.responses)))


def record_set_view(job: RecordSetJob, state: PageState) -> dict[str, Any]:
    """Return the progress; of a finished set its peaks, statistics, checks, warnings, and rotations over time."""
    view: dict[str, Any] = {
        "status": job.status,
        "message": job.message,
        "done": job.runs,
        "total": len(job.study.motions),
    }
    view["ready"] = job.status == "done"
    if not view["ready"]:
        return view
    found = _set_of_job(job, state)
    peaks, statistics = found.peaks, found.statistics
    units = {str(name): OUTPUTS[str(name)].unit_in(UnitSystem(state.units)) for name in statistics.index}
    view["demands"] = [
        {"name": name, "symbol": OUTPUTS[name].symbol, "unit": unit.name, "size": unit.size,
         "listed": name in DEMANDS_BY_RECORD, "peaks": peaks[name].tolist(), **statistics.loc[name].to_dict()}
        for name, unit in units.items()
    ]  # fmt: skip
    view["records"] = [
        {"name": run.motion, "status": run.status, "scale": None if motion.metadata is None else motion.metadata.scale,
         "pga": motion.pga, **_rotation_curve(run)}
        for run, motion in zip(found.responses, found.motions, strict=True)
    ]  # fmt: skip
    view["model"], view["warnings"] = found.responses[0].model, found.warnings
    view["checks"] = checks_view(found, state, friction=job.study.friction)
    return as_json_value(view)


def _rotation_curve(run: Response) -> dict[str, str]:
    history = run.history
    assert history is not None  # every run of a set has one
    kept = envelope_indices([history.rotation], CURVE_POINTS)
    return {"t": pack_array_as_base64(history.time[kept]), "rotation": pack_array_as_base64(history.rotation[kept])}


def _record_set_figure(job: RecordSetJob, state: PageState) -> Any:
    from rockflex.plot._record_set import plot_set

    return plot_set(_set_of_job(job, state))


def _record_set_report(job: RecordSetJob, state: PageState) -> str:
    found, study = _set_of_job(job, state), job.study
    name, n = study.state.structure.name or translated("Structure"), len(found.responses)
    return run_report_as_html(
        found,
        structure=study.built.structure,
        units=state.units,
        language=state.language,
        title=translated(
            "{structure} under {n} record" if n == 1 else "{structure} under {n} records", structure=name, n=n
        ),
        limits=state.check_limits(friction=study.friction),
    )


RECORD_SET_PAGE = StudyPage(
    study=record_set_study,
    view=record_set_view,
    table=lambda job, state: _set_of_job(job, state).peaks.reset_index(),
    figure=_record_set_figure,
    script=record_set_script,
    table_name="peaks",
    figure_name="records",
    job=RecordSetJob,
    report=_record_set_report,
)
