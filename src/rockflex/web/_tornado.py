"""What matters most on the Response tab: each number of the structure at both ends of a range, as a job."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockflex.engine.stops import check_interruption
from rockflex.foundation.json import as_json_value
from rockflex.models._label import parse_model
from rockflex.motion._ground_motion import GroundMotion
from rockflex.studies._arguments import free_vibration_argument
from rockflex.studies._parameters import SCALE, Subject
from rockflex.studies._prepared_case import RunOptions
from rockflex.studies._tornado import Range, Tornado, possible_ranges, tornado
from rockflex.web._alternatives import model_of_alternative
from rockflex.web._earthquake import chosen_motion
from rockflex.web._jobs import RunsJob
from rockflex.web._limits import check_work_of_tornado
from rockflex.web._refusal import Refusal, errors_as_refusals
from rockflex.web._script import tornado_script
from rockflex.web._selection import VisitorRecords, records_of_named_suites
from rockflex.web._state import PageState
from rockflex.web._structure import build_page_structure, ground_under_page_structure
from rockflex.web._studies import StudyPage
from rockflex.web._uploads import UploadedRecords


@dataclass(frozen=True, eq=False)
class TornadoStudy:
    """A structure under one record or a set, and the range of each of its numbers."""

    structure: Any
    records: VisitorRecords
    motions: tuple[GroundMotion, ...]
    model: str
    ranges: dict[str, Range]
    demand: str
    options: RunOptions

    @property
    def n_cases(self) -> int:
        """Number of structures that are run: as given, and at both ends of each range."""
        return 1 + 2 * len(self.ranges)


def tornado_study(state: PageState, uploads: UploadedRecords) -> TornadoStudy:
    """Return the study of a state: of the record that is shown, or of the set of records."""
    choice, built = state.tornado, build_page_structure(state.structure)
    if state.record_set.shown:
        records = records_of_named_suites(state, state.record_set.suites, uploads, "record_set.suites")
        motions, scale, label = tuple(records.load(Path())), state.record_set.scale, state.model_of_set
    else:
        motions, scale, label = (chosen_motion(state.record, uploads),), state.scale, model_of_alternative(state)
        records = VisitorRecords.of([], motions)
    options, model = state.run_options(ground_under_page_structure(state.ground, built.properties)), parse_model(label)
    with errors_as_refusals("tornado", f"{label}: "):
        subject = Subject(built.structure, options.for_models([model]))
        case = subject.case(model)
        ranges: dict[str, Range] = {**possible_ranges(subject, model, choice.share), SCALE: choice.share}
    acting = tuple(each.scaled(scale) for each in motions)
    study = TornadoStudy(built.structure, records, acting, label, ranges, choice.demand, options)
    check_work_of_tornado(case, acting, study.n_cases, "tornado")
    return study


class TornadoJob(RunsJob):
    """The runs of a tornado; `found` is what they gave."""

    def __init__(self, study: TornadoStudy, kind: str) -> None:
        super().__init__(kind)
        self.study = study
        self.found: Tornado | None = None

    def work(self) -> None:
        """Run all cases, each under all records."""

        def told(done: int, _: int) -> None:
            check_interruption()
            self.runs = done * len(self.study.motions)

        given, options = self.study, self.study.options
        with errors_as_refusals("tornado"):
            self.found = tornado(
                given.structure, given.motions, given.model, given.ranges, demand=given.demand, workers=1,
                progress=told, free_vibration=free_vibration_argument(options.free_vibration),
                impact=options.impact, bouc_wen=options.bouc_wen, ground=options.ground, work_limit=options.work_limit
            )  # fmt: skip


def tornado_view(job: TornadoJob, _: PageState) -> dict[str, Any]:
    """Return the progress; of a finished job the demand as given, and at both ends of each range, widest first."""
    study, found = job.study, job.found
    view: dict[str, Any] = {
        "status": job.status,
        "message": job.message,
        "errors": job.errors,
        "done": job.runs,
        "total": study.n_cases * len(study.motions),
        "ready": found is not None,
    }
    if found is None:
        return view
    rows = [
        {"name": name, "factors": factors, "values": values, "overturned": fell}
        for name, factors, values, fell in zip(
            found.parameters, found.factors.tolist(), found.values.tolist(), found.overturned.tolist(), strict=True
        )
    ]
    more = {"model": study.model, "demand": found.demand, "base": found.base, "n_records": found.n_records}
    return as_json_value(view | more | {"rows": rows})


def _found_of(job: TornadoJob) -> Tornado:
    if job.found is None:
        raise Refusal("There are no runs yet.")
    return job.found


def _tornado_figure(job: TornadoJob, _: PageState) -> Any:
    from rockflex.plot._tornado import plot_tornado

    return plot_tornado(_found_of(job))


TORNADO_PAGE = StudyPage(
    study=tornado_study,
    view=tornado_view,
    table=lambda job, _: _found_of(job).to_frame().reset_index(),
    figure=_tornado_figure,
    script=tornado_script,
    table_name="tornado",
    figure_name="tornado",
    job=TornadoJob,
)
