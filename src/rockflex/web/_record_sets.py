"""A set of records of the Response tab: its runs as a job, and its statistics, design values and checks."""

import json
import math
from contextlib import suppress
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

from rockflex.engine.stops import check_interruption
from rockflex.foundation.json import as_json_value
from rockflex.foundation.language import translated, use_language
from rockflex.foundation.units import UnitSystem
from rockflex.models._label import parse_model
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._suite import Selection
from rockflex.report.run._report_page import run_report_as_html
from rockflex.response._comparison import Comparison
from rockflex.response._limit_checks import check
from rockflex.response._outputs import DEMANDS_BY_RECORD, DEMANDS_OF_SET, OUTPUTS
from rockflex.response._record_set import RecordSet, checked_rule
from rockflex.response._response import Response
from rockflex.studies._compare import MAX_ALTERNATIVES
from rockflex.studies._prepared_case import PreparedCase
from rockflex.web._alternatives import model_of_alternative, next_free_name
from rockflex.web._earthquake import chosen_motion
from rockflex.web._encoding import envelope_indices, pack_array_as_base64
from rockflex.web._inputs import input_notes
from rockflex.web._jobs import RunsJob
from rockflex.web._limits import check_size_of_set, check_work_of_runs
from rockflex.web._refusal import Refusal, errors_as_refusals
from rockflex.web._response import checks_view
from rockflex.web._script import record_set_script
from rockflex.web._selection import (
    SELECTED,
    SELECTIONS,
    VisitorRecords,
    records_of_named_suites,
    target_spectrum_of_choice,
)
from rockflex.web._state import PageState, refusals_of_alternative
from rockflex.web._structure import SLICED, BuiltStructure, build_page_structure, ground_under_page_structure
from rockflex.web._studies import StudyPage
from rockflex.web._uploads import LatestValuesCache, UploadedRecords

LEAST_PERIOD = 0.02  # s
CURVE_POINTS = 500  # of the rotation under one record
MAX_KEPT_BYTES = 200_000_000  # of the states of all sets in memory


def _bytes_of_set(found: RecordSet) -> int:
    return sum(run.history.states.nbytes for run in found.responses if run.history is not None)


_SETS = LatestValuesCache[RecordSet](MAX_KEPT_BYTES, _bytes_of_set)
_WITH_FRICTION = LatestValuesCache[bool](200)  # those whose responses know the friction that they require


@dataclass(frozen=True, eq=False)
class RunsOfSet:
    """The runs of one structure under a set; `friction` tells whether the checks need what is required.

    `key` identifies what the runs are made from: whoever asks for the same has them at once.
    """

    name: str
    state: PageState
    built: BuiltStructure
    case: PreparedCase
    friction: bool
    key: str


@dataclass(frozen=True, eq=False)
class RecordSetStudy:
    """The runs of the present structure under a set of records, and of those that it is compared with."""

    own: RunsOfSet
    others: tuple[RunsOfSet, ...]
    records: VisitorRecords
    motions: tuple[GroundMotion, ...]
    selection: Selection | None

    @property
    def periods(self) -> tuple[float, float] | None:
        """Smallest and largest period in s for which the records were chosen."""
        return None if self.selection is None else (float(self.selection.periods[0]), float(self.selection.periods[-1]))

    @property
    def all(self) -> tuple[RunsOfSet, ...]:
        """The present structure, and the others."""
        return self.own, *self.others

    @property
    def kept(self) -> tuple[RunsOfSet, ...]:
        """The alternatives, without the fixed base of the present structure."""
        return tuple(each for each in self.others if each.state is not self.own.state)

    @property
    def fixed(self) -> RunsOfSet | None:
        """The present structure on a fixed base; None if the set would be too large with it, or it cannot lift."""
        return next((each for each in self.others if each.state is self.own.state), None)

    @property
    def compared(self) -> tuple[RunsOfSet, ...]:
        """Those side by side: the kept ones in their order, the present one unless it is kept, and the fixed base."""
        present = [] if any(each.key == self.own.key for each in self.kept) else [self.own]
        return (*self.kept, *present, *([] if self.fixed is None else [self.fixed]))


FIXED = "fixed"  # the present structure on a fixed base


def record_set_study(state: PageState, uploads: UploadedRecords) -> RecordSetStudy:
    """Return the runs of the set of records of a state, of its alternatives and of a fixed base."""
    choice = state.record_set
    records = records_of_named_suites(state, choice.suites, uploads, "record_set.suites")
    motions = tuple(each if choice.scale == 1.0 else each.scaled(choice.scale) for each in records.load(Path()))
    acting = _checksum_of_motions(motions)

    def runs(name: str, each: PageState, label: str, path: str) -> RunsOfSet:
        built = build_page_structure(each.structure)
        ground = ground_under_page_structure(each.ground, built.properties) if label != FIXED else None
        with errors_as_refusals(path, f"{label}: "):
            options = each.run_options(ground)
            case = options.case(parse_model(label), built.properties, history=True, floors=True)
        made_from = [each.structure.model_dump(exclude_none=True), each.option_keys([label]), label]
        made_from += [state.free_vibration, acting]
        return RunsOfSet(
            name, each, built, case, "friction" in state.limits, sha256(json.dumps(made_from).encode()).hexdigest()
        )

    own = runs(next_free_name(state), state, state.model_of_set, "record_set.model")
    others = list[RunsOfSet]()
    for kept in state.alternatives:
        with refusals_of_alternative(kept.name):
            others.append(runs(kept.name, state.kept_state(kept), model_of_alternative(kept), "alternatives"))
    if own.built.properties.n_modes and own.case.model.lifts and FIXED not in (each.name for each in others):
        others.append(runs(FIXED, state, FIXED, "record_set.model"))
    try:
        check_size_of_set([each.case for each in (own, *others)], motions, "record_set.suites")
    except Refusal:
        if not others:
            raise
        others = []  # the present structure alone may fit
        check_size_of_set([own.case], motions, "record_set.suites")
    with errors_as_refusals("record_set.rule"):
        checked_rule(choice.rule or None, len(motions))
    chosen = SELECTIONS.of(state, uploads)[0] if choice.suites == [SELECTED] else None
    return RecordSetStudy(own, tuple(others), records, motions, chosen)


def _checksum_of_motions(motions: tuple[GroundMotion, ...]) -> str:
    found = sha256()
    for each in motions:
        found.update(f"{each.name} {each.dt!r} {each.vertical is not None} {each.acceleration.size}".encode())
        found.update(each.acceleration.tobytes())
        found.update(b"" if each.vertical is None else each.vertical.tobytes())
    return found.hexdigest()


class RecordSetJob(RunsJob):
    """Sets of records, computed record after record."""

    def __init__(self, study: RecordSetStudy, kind: str) -> None:
        super().__init__(kind)
        self.study = study

    def work(self) -> None:
        """Run all records, and compute of each what the views of the set ask for at once."""
        for each in self.study.all:
            known = _SETS.get(each.key)
            if known is None:
                self._run(each)
            elif each.friction and _WITH_FRICTION.get(each.key) is None:
                for run in known.responses:
                    self._check(run, each)
            else:
                self.runs += len(self.study.motions)
            if each.friction:
                _WITH_FRICTION.put(each.key, True)

    def _check(self, run: Response, runs: RunsOfSet) -> None:
        check_interruption()
        check(run, self.study.own.state.check_limits(friction=runs.friction))
        self.runs += 1

    def _run(self, runs: RunsOfSet) -> None:
        found = list[Response]()
        for motion in self.study.motions:
            check_interruption()
            with errors_as_refusals("record_set.suites", f"{motion.name}: "):
                found.append(runs.case.run(motion))
            _ = found[-1].warnings  # its energies, which the response then has
            self._check(found[-1], runs)
        given: dict[str, Any] = {"properties": runs.built.properties, "rule": None, "periods": None}
        _SETS.put(runs.key, RecordSet(responses=tuple(found), motions=self.study.motions, **given))


def _set_of_job(job: RecordSetJob, state: PageState, runs: RunsOfSet | None = None) -> RecordSet:
    """Return a set, by default that of the present structure, with the rule of a state."""
    found = _SETS.get((runs or job.study.own).key)
    if job.status != "done" or found is None:
        raise Refusal("The server does not have all records of this set (any more). Simulate it again.", 404)
    with errors_as_refusals("record_set.rule"):
        rule = checked_rule(state.record_set.rule or None, len(found.responses))
    return replace(found, rule=rule, periods=job.study.periods)


def _compared_view(job: RecordSetJob, state: PageState) -> dict[str, Any] | None:
    """Return values for design and checks of all alternatives; None without one."""
    if not job.study.kept:
        return None
    compared = job.study.compared
    sets = [_set_of_job(job, state, each) for each in compared]
    design = [found.statistics["design"].to_dict() for found in sets]
    demands = [name for name in OUTPUTS if name in {*DEMANDS_OF_SET} & {each for one in design for each in one}]
    tables = [checks_view(found, state, friction=each.friction) for found, each in zip(sets, compared, strict=True)]
    columns = list[dict[str, Any]]()
    for each, found, table in zip(compared, sets, tables, strict=True):
        ran = found.responses[0].history
        lifted = sum(run.status != "no_uplift" for run in found.responses) if ran and ran.model.lifts else 0
        columns.append({"name": each.name, "lifted": lifted, "fell": found.n_overturned, "checks": table["rows"],
                        "model": found.responses[0].model, "present": each is job.study.own})  # fmt: skip
    units = UnitSystem(state.units)
    return {
        "columns": columns,
        "records": len(job.study.motions),
        "demands": [
            {"name": name, "symbol": OUTPUTS[name].symbol, "unit": OUTPUTS[name].unit_in(units).name,
             "size": OUTPUTS[name].unit_in(units).size, "values": [each.get(name) for each in design]}
            for name in demands
        ],
    }  # fmt: skip


def _comparison_report(job: RecordSetJob, state: PageState) -> str:
    """Return the report of all alternatives under the set, with their values for design and their checks."""
    import pandas as pd

    compared = job.study.compared[:MAX_ALTERNATIVES]
    if not job.study.kept:
        raise Refusal({"alternatives": "there is none to compare with. Keep the present structure, and change it."})
    sets, names = [_set_of_job(job, state, each) for each in compared], [each.name for each in compared]
    frames = [found.peaks.reset_index().assign(structure=name) for name, found in zip(names, sets, strict=True)]
    governing = int(sets[0].peaks["max_rotation"].to_numpy(float).argmax())
    comparison = Comparison(
        tuple(names),
        tuple(each.built.structure for each in compared),
        pd.concat(frames, ignore_index=True),
        job.study.motions[governing],
        tuple(found.responses[governing] for found in sets),
    )
    limits = [state.check_limits(friction=each.friction) for each in compared]
    tables = tuple(check(found, own) for found, own in zip(sets, limits, strict=True))
    told: dict[str, Any] = {"units": state.units, "language": state.language, **state.head_texts()}
    if state.record_set.scale != 1.0 and "title" not in told:
        known = {"structure": ", ".join(names), "n": len(job.study.motions)}
        with use_language(state.language):
            told["title"] = f"{translated('{structure} under {n} records', **known)} × {state.record_set.scale:g}"
    with errors_as_refusals("alternatives"):
        return run_report_as_html(comparison, sets=tuple(sets), checks=tables, **told)


LEAST_SHARE = 0.2  # of the first period, from which the range begins (EN 1998-1:2004, 3.2.3.1.2)


def periods_view(state: PageState, uploads: UploadedRecords) -> dict[str, float]:
    """Return the range of periods in s that matters: from 0.2 T_1 to the period that rocking reaches.

    It is reached under the set, if the server has it, and else under the record of the page. No target goes on further
    than it is defined.
    """
    built = build_page_structure(state.structure)
    p, known = built.properties, None
    with suppress(Refusal):
        known = _SETS.get(record_set_study(state.model_copy(update={"alternatives": []}), uploads).own.key)
    if known is None:
        motion, label = chosen_motion(state.record, uploads).scaled(state.scale), model_of_alternative(state)
        options = state.run_options(ground_under_page_structure(state.ground, p))
        with errors_as_refusals("target.longest", f"{label}: "):
            case = options.case(parse_model(label), p, history=True, floors=False)
            check_work_of_runs([case], motion)
            run = case.run(motion)
        known = RecordSet(responses=(run,), motions=(motion,), properties=p, rule=None, periods=None)
    target = target_spectrum_of_choice(state.target)
    longest = min(known.rocking_period, float(target.periods[-1]))
    first = 2.0 * math.pi / float(p.omega[0]) if p.n_modes else longest
    shortest = max(LEAST_SHARE * first, float(target.periods[0]), LEAST_PERIOD)
    return {"shortest": float(f"{shortest:.3g}"), "longest": float(f"{max(longest, 1.01 * shortest):.3g}")}


def record_set_view(job: RecordSetJob, state: PageState) -> dict[str, Any]:
    """Return the progress; of a finished set its peaks, statistics, checks, warnings, and rotations over time."""
    view: dict[str, Any] = {
        "status": job.status,
        "message": job.message,
        "done": job.runs,
        "total": len(job.study.motions) * len(job.study.all),
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
        if name != "max_story_drift" or state.structure.kind not in SLICED
    ]  # fmt: skip
    view["records"] = [
        {"name": run.motion, "status": run.status, "scale": None if motion.metadata is None else motion.metadata.scale,
         "pga": motion.pga, **_rotation_curve(run)}
        for run, motion in zip(found.responses, found.motions, strict=True)
    ]  # fmt: skip
    own = job.study.own
    view["friction_due"] = "friction" in state.limits and not own.friction
    reached = found.rocking_period
    view["short"] = found.periods is not None and found.periods[1] < min(reached, _longest_of_target(state))
    view["model"], view["warnings"] = found.responses[0].model, found.warnings
    view["checks"] = checks_view(found, state, friction=own.friction)
    view["compared"] = _compared_view(job, state)
    fixed = job.study.fixed and _set_of_job(job, state, job.study.fixed)
    view["fixed_moment"] = fixed and fixed.statistics.loc["max_base_moment", "design"]
    return as_json_value(view)


def _longest_of_target(state: PageState) -> float:
    with suppress(Refusal):
        return float(target_spectrum_of_choice(state.target).periods[-1])
    return 0.0


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
    name, n = study.own.state.structure.name or translated("Structure"), len(found.responses)
    times = "" if state.record_set.scale == 1.0 else f" × {state.record_set.scale:g}"
    text = "{structure} under {n} record" if n == 1 else "{structure} under {n} records"
    head: dict[str, Any] = {"title": translated(text, structure=name, n=n) + times, **state.head_texts()}
    return run_report_as_html(
        found,
        structure=study.own.built.structure,
        units=state.units,
        language=state.language,
        notes=input_notes(state, of_set=True),
        selection=study.selection,
        **head,
        limits=state.check_limits(friction=study.own.friction),
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
    comparison=_comparison_report,
)
