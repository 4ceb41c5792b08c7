"""The files of the page: figures, tables, records, studies, programs, a report and an animation."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rockflex.foundation.csv import table_as_csv
from rockflex.foundation.language import translated
from rockflex.motion._columns import record_csv
from rockflex.motion._suite import Selection
from rockflex.report.run._report_files import page_as_pdf
from rockflex.report.run._report_page import run_report_as_html
from rockflex.response._outputs import COLUMNS, described_output
from rockflex.response._response import Response
from rockflex.response._tables import history_columns
from rockflex.studies._record_tables import record_row
from rockflex.studies._study_kind import KINDS
from rockflex.studies.case import Case
from rockflex.web._alternatives import comparison_report_file
from rockflex.web._earthquake import chosen_motion
from rockflex.web._folders import records_as_zip
from rockflex.web._inputs import input_notes
from rockflex.web._jobs import RunsJob
from rockflex.web._projects import project_file
from rockflex.web._record_sets import RECORD_SET_PAGE
from rockflex.web._refusal import Refusal, errors_as_refusals, storage_as_refusals, temporary_folder
from rockflex.web._response import is_long_run, simulate_state_models
from rockflex.web._script import response_script, selection_script
from rockflex.web._selection import RECORDS_FOLDER, SELECTIONS, UNPACK_HINT, WHOLE_FOLDER, folder_suite
from rockflex.web._state import PageState
from rockflex.web._studies import CLOUD_PAGE, DESIGN_PAGE, StudyPage
from rockflex.web._tornado import TORNADO_PAGE
from rockflex.web._uploads import UploadedRecords, motion_file_name

if TYPE_CHECKING:
    import pandas as pd


PAGES = {"cloud": CLOUD_PAGE, "design": DESIGN_PAGE, "record_set": RECORD_SET_PAGE, "tornado": TORNADO_PAGE}
"""The kinds of study that the page shows, by their names."""


def run_report_file(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
    """Return the name and the text of the report of the runs of a state.

    Energies and friction that would keep a visitor waiting are left out, and the page says so.
    """
    built, acting, found = simulate_state_models(state, uploads)
    motion = chosen_motion(state.record, uploads)
    times = "" if state.scale == 1.0 else f" × {state.scale:g}"
    record = f"{motion.name or translated('a ground motion')}{times}"
    name = state.structure.name or translated("Structure")
    usual = translated("{structure} under {record}", structure=name, record=record)
    head: dict[str, Any] = {"title": usual, "notes": input_notes(state), **state.head_texts()}
    with errors_as_refusals("models"):
        text = run_report_as_html(
            found,
            structure=built.structure,
            motion=motion,
            units=state.units,
            language=state.language,
            **head,
            omitted=[response.model for response in found if is_long_run(response, acting, state)],
            limits=state.check_limits(),
        )
    return "report.html", text


FRAME_RATES = ((60.0, 25.0), (120.0, 12.5))
"""Longest animation in s, and its frames per second: at most 1500 frames, which take some 20 s to draw."""
ANIMATION_WIDTH = 800  # pixels


Progress = Callable[[int, int], None]


def animation_file(state: PageState, uploads: UploadedRecords, progress: Progress) -> tuple[str, bytes]:
    """Return the name and the content of a GIF of the models that are shown, at their true speed.

    `progress` is called with the number of frames drawn and that of all.
    """
    from rockflex.plot._figures import literal_text
    from rockflex.plot.animation._animate import animate

    built, motion, found = simulate_state_models(state, uploads)
    seconds = max(response.end_time for response in found)
    rate = next((rate for longest, rate in FRAME_RATES if seconds <= longest), None)
    if rate is None:
        message = (
            f"the animation would last {seconds:.4g} s, but the page draws {FRAME_RATES[-1][0]:g} s at most. Choose a "
            "shorter record or less free vibration, or take Python lines and add rf.animate(..., start=, stop=)."
        )
        raise Refusal({"free_vibration": message})
    title = None if state.scale == 1.0 else f"{literal_text(motion.name)} × {state.scale:g}"
    with temporary_folder("models") as folder, errors_as_refusals("models"):
        file = animate(
            found, folder / "animation.gif", structure=built.structure, frames_per_second=rate, title=title,
            width=ANIMATION_WIDTH, progress=progress,
        )  # fmt: skip
        return file.name, file.read_bytes()


MEDIA_TYPES = {
    ".zip": "application/zip",
    ".svg": "image/svg+xml",
    ".gif": "image/gif",
    ".html": "text/html",
    ".pdf": "application/pdf",
    ".rockflex": "application/zip",
    ".csv": "text/csv",
    ".toml": "application/toml",
    ".py": "text/x-python",
}
REPORTS_AS_PDF = {"report-pdf": "report", "comparison-pdf": "comparison"}
MAX_HISTORY_ROWS = 250_000  # of a table of histories
MAX_HISTORY_VALUES = 6_000_000  # of it: a bed has a column for every spring


def file_maker(state: PageState, what: str, uploads: UploadedRecords) -> Callable[[Progress], tuple[str, bytes]]:
    """Return the function that makes a file: it is given whom to tell of its progress, and returns name and content.

    Parameters
    ----------
    state
        The state of the page.
    what
        ``"animation"``, a key of `_MAKERS`, or one of a study: ``"cloud-study"``, ``"cloud-python"``,
        ``"cloud-records"``, and the same of the other kinds. A report in HTML, or with ``"-pdf"`` as PDF.
    uploads
        Records of visitors.
    """
    if what == "animation":
        return lambda progress: animation_file(state, uploads, progress)
    maker = _MAKERS.get(REPORTS_AS_PDF.get(what, what)) or _maker_of_study_input(what)
    if maker is None:
        raise _unknown_file(what)

    def make(_: Progress) -> tuple[str, bytes]:
        name, content = maker(state, uploads)
        return _printed(what, name, content if isinstance(content, bytes) else content.encode())

    return make


def _unknown_file(what: str) -> Refusal:
    return Refusal(f"There is no file named {what[:40]!r}.", 404)


def _printed(what: str, name: str, content: bytes) -> tuple[str, bytes]:
    if what not in REPORTS_AS_PDF:
        return name, content
    with storage_as_refusals(""), errors_as_refusals(""):
        return name.replace(".html", ".pdf"), page_as_pdf(content.decode())


def _history_figure_file(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
    from rockflex.plot._figures import figure_as_svg
    from rockflex.plot._history import plot_history

    return "response.svg", figure_as_svg(plot_history(simulate_state_models(state, uploads)[2]))


def _histories_table_file(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
    import pandas as pd

    found = simulate_state_models(state, uploads)[2]
    rows = sum(response.time.size for response in found)
    if rows > MAX_HISTORY_ROWS:
        message = (
            f"the histories have {rows} rows, but the page writes {MAX_HISTORY_ROWS} at most. Choose fewer models, or "
            "Python lines."
        )
        raise Refusal({"models": message})
    tables = [_history_table(each) for each in found]
    cells = sum(table.size for table in tables)
    if cells > MAX_HISTORY_VALUES:
        message = (
            f"the histories with the forces of all springs have {cells} values, but the page writes "
            f"{MAX_HISTORY_VALUES} at most. Choose fewer models or springs, or Python lines."
        )
        raise Refusal({"models": message})
    return "histories.csv", table_as_csv(pd.concat(tables), float_format="%.9g", na_rep="nan", lineterminator=None)


def _history_table(response: Response) -> "pd.DataFrame":
    """Return the columns of a history, and before those of its ground those of the elements, counted from one."""
    import pandas as pd

    columns = {
        f"{name} ({found.si})" if (found := described_output(name)) and found.si else name: values
        for name, values in history_columns(response.history).items()
    }
    table = pd.DataFrame({"model": response.model} | columns)
    place = 1 + len(COLUMNS)
    for k in reversed(range(response.element_force.shape[1])):
        table.insert(place, f"element_{k + 1}_force (N)", response.element_force[:, k])
        table.insert(place, f"element_{k + 1}_elongation (m)", response.element_elongation[:, k])
    return table


def _record_csv_file(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
    motion = chosen_motion(state.record, uploads)
    return f"{motion_file_name(motion)}.csv", record_csv(motion)


def _selection(state: PageState, uploads: UploadedRecords) -> Selection:
    return SELECTIONS.of(state, uploads)[0]


def _selection_figure_file(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
    from rockflex.plot._figures import figure_as_svg
    from rockflex.plot._motion import plot_selection

    return "selection.svg", figure_as_svg(plot_selection(_selection(state, uploads)))


def _csv(table: "pd.DataFrame") -> str:
    return table_as_csv(table)


def _response_python_file(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
    own = state.record.source in ("upload", "folder")
    name = motion_file_name(chosen_motion(state.record, uploads)) if own else ""
    return "response.py", response_script(state, name)


def _case_file(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
    """Return the runs of the Response tab as a case; a record that no suite has is the file that the page saves."""
    choice, note = state.record, ""
    if choice.source == "suite":
        records: dict[str, Any] = {"suites": [choice.suite], "include": [choice.name]}
    else:
        motion = chosen_motion(choice, uploads)
        file = f"{motion_file_name(motion)}.csv"
        records, note = {"files": [record_row(file, motion)]}, f"# with {file}, which the page saves: Record (CSV)\n"
    with errors_as_refusals(""):
        case = Case(
            structures=[state.structure.model_dump(exclude_none=True)],
            records=records,
            models=state.models,
            scales=[state.scale],
            free_vibration=state.free_vibration,
            **state.option_keys(state.models),
        )
        return "case.toml", f'# rockflex run case.toml, or rf.read_case("case.toml").run()\n{note}{case.to_toml()}'


def _maker_of_study_input(what: str) -> Callable[[PageState, UploadedRecords], tuple[str, str | bytes]] | None:
    """Return the maker of a file from which a study is run, such as "cloud-study" or "design-python"; None if none."""
    kind, _, form = what.partition("-")
    page = PAGES.get(kind)
    if page is None:
        return None

    def toml(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
        study = page.study(state, uploads)
        head = f"# rockflex {KINDS[kind].command} {kind}.toml --out study\n"
        head += UNPACK_HINT if study.records.folder else ""
        return f"{kind}.toml", head + study.to_toml()

    def python(state: PageState, uploads: UploadedRecords) -> tuple[str, str]:
        return f"{kind}.py", page.script(state, page.study(state, uploads))

    def records(state: PageState, uploads: UploadedRecords) -> tuple[str, bytes]:
        return f"{RECORDS_FOLDER}.zip", records_as_zip(page.study(state, uploads).records.motions)

    return {"study": toml if kind in KINDS else None, "python": python, "records": records}.get(form)


def study_file_maker(
    page: StudyPage, job: RunsJob, state: PageState, what: str
) -> Callable[[Progress], tuple[str, bytes]]:
    """Return the function that makes a file of a study from its runs so far, as `file_maker` does.

    It is the ``"table"``, the ``"figure"`` or, of a study that has one, the ``"report"`` or the ``"comparison"``, also
    with ``"-pdf"``.
    """

    def table(_: Progress) -> tuple[str, bytes]:
        return f"{page.table_name}.csv", table_as_csv(page.table(job, state), lineterminator=None).encode()

    def figure(_: Progress) -> tuple[str, bytes]:
        from rockflex.plot._figures import figure_as_svg

        with errors_as_refusals(""):
            return f"{page.figure_name}.svg", figure_as_svg(page.figure(job, state)).encode()

    def page_of(write: Callable[[RunsJob, PageState], str], name: str) -> Callable[[Progress], tuple[str, bytes]]:
        return lambda _: _printed(what, f"{name}.html", write(job, state).encode())

    makers = {"table": table, "figure": figure}
    written = {"report": page.report, "comparison": page.comparison}
    makers |= {name: page_of(write, name) for name, write in written.items() if write is not None}
    maker = makers.get(REPORTS_AS_PDF.get(what, what))
    if maker is None:
        raise _unknown_file(what)
    return maker


_MAKERS: dict[str, Callable[[PageState, UploadedRecords], tuple[str, str | bytes]]] = {
    "figure": _history_figure_file,
    "report": run_report_file,
    "comparison": comparison_report_file,
    "project": project_file,
    "histories": _histories_table_file,
    "record": _record_csv_file,
    "records": lambda state, uploads: (f"{WHOLE_FOLDER}.zip", records_as_zip(folder_suite(state, uploads))),
    "python": _response_python_file,
    "case": _case_file,
    "selection": lambda state, uploads: ("selection.csv", _csv(_selection(state, uploads).table())),
    "selection-spectra": lambda state, uploads: ("spectra.csv", _csv(_selection(state, uploads).spectra())),
    "selection-figure": _selection_figure_file,
    "selection-records": lambda state, given: ("scaled-records.zip", records_as_zip(_selection(state, given).suite)),
    "selection-python": lambda state, _: ("selection.py", selection_script(state.target)),
}
