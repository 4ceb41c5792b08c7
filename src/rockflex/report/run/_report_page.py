"""The page of a run: its contents put together, laid out on one sheet, and written as HTML."""

import dataclasses
import hashlib
import math
import re
from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import date as Date  # noqa: N812
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from rockflex._errors import InputError
from rockflex._files import checked_file_path, write_file_atomically
from rockflex._shown import number_with_noun, shortened, shown
from rockflex._versions import package_versions
from rockflex.motion import GroundMotion
from rockflex.report._publication_files import inline_svg, jinja_templates_in
from rockflex.report.run import _report_tables
from rockflex.report.run._comparison_tables import (
    SHOWN,
    alternatives_table,
    demand_table,
    model_line,
    reported_alternatives,
)
from rockflex.report.run._reported_runs import ReportedRuns, checked_reported_runs
from rockflex.report.run._run_checks import labels_of_long_runs, limit_check_table, run_check_legend, run_check_table
from rockflex.report.run._set_page import SetReportPage, set_drawing, set_report_page
from rockflex.response import (
    STATISTICS,
    CheckLimits,
    Comparison,
    RecordSet,
    Response,
    check,
    friction_coefficient,
    warnings_of,
)
from rockflex.structure import structure_warnings

WIDTH, HEIGHT = 186.0, 272.0  # of a sheet of A4 within its margins, in mm
FIGURE_HEIGHTS = (58.0, 160.0)  # least and largest height of the figure in mm
MIN_SCALE = 0.75  # of the usual size of the type, on a sheet that is full
ROW = 3.4  # height of a line of text in mm
ROW_LETTERS = 130  # in a line over the whole width
TEMPLATES = Path(__file__).parent / "templates"
MAX_LETTERS = {"title": 110, "name": 70, "source": 110, "warning": 400}  # letters
MAX_WARNINGS = 4  # texts
_MAX_NOTE_LINES = 6  # of more, each does not have a line of its own
_STRIP = (65.0, 22.0)  # mm
_OUTLINES = 48.0  # height in mm of the structures of a comparison
_CELL_LETTERS = 60  # in a line of its elements
_SUBSCRIPT, _SUPERSCRIPT = re.compile(r"([^\W\d_]\*?)_([\w*–]+)"), re.compile(r"\^(−?\d+)")
SUFFIXES = (".html", ".htm")
MAX_NOTES = 800  # letters of all notes


def line_count_of_text(text: str) -> int:
    """Return about how many lines a text takes."""
    return math.ceil(len(text) / ROW_LETTERS)


def line_count_of_table(table: _report_tables.ReportTable | None) -> int:
    """Return about how many lines a table takes with its heading."""
    if table is None:
        return 0
    cells = [[name for name, _ in table.heads], *([cell.text for cell in row] for row in table.rows)]
    across = sum(1 + max(map(len, column)) for column in zip(*cells, strict=True))
    return 3 + len(table.rows) * math.ceil(across / ROW_LETTERS)


class _Sheet(ABC):
    """How the contents of a page share one sheet with its figure."""

    @property
    @abstractmethod
    def height(self) -> float:
        """About the height in mm of all but the figure."""

    @property
    def scale(self) -> float:
        """Size of everything on the sheet: 1, or less to make room for all texts."""
        return min(1.0, max(MIN_SCALE, HEIGHT / (self.height + FIGURE_HEIGHTS[0])))

    @property
    def figure_height(self) -> float:
        """Height in mm for which the figure is drawn, before it is scaled."""
        low, high = FIGURE_HEIGHTS
        return min(max(HEIGHT / self.scale - self.height, low), high)


@dataclass(frozen=True, eq=False)
class RunReportPage(_Sheet):
    """Contents of a page, in the order of the template."""

    template: ClassVar[str] = "run.html.jinja"

    title: str
    date: str
    kind: str
    facts: Sequence[_report_tables.ReportFact]
    modes: _report_tables.ReportTable | None
    record: _report_tables.ReportedRecord
    lines: Sequence[tuple[str, str]]
    elements: _report_tables.ReportTable | None
    peaks: _report_tables.ReportTable
    checks: _report_tables.ReportTable
    legend: Sequence[str]
    limits: _report_tables.ReportTable | None
    warnings: Sequence[str]
    notes: Sequence[str]
    versions: str
    inputs: str

    @property
    def height(self) -> float:
        """About the height in mm of all but the figure: the browser makes the layout, and the figure takes the rest."""
        structure = len(self.facts) / 2 + (0 if self.modes is None else 2 + len(self.modes.rows))
        record = 8 + len(self.record.facts)
        lines = sum(line_count_of_text(f"{head} {text}") for head, text in self.lines)
        tables = line_count_of_table(self.elements) + line_count_of_table(self.peaks) + line_count_of_table(self.checks)
        tables += line_count_of_table(self.limits)
        texts = line_count_of_text(" ".join(self.legend)) + sum(map(line_count_of_text, (*self.warnings, *self.notes)))
        return ROW * (8 + line_count_of_text(self.title) + max(structure, record) + lines + tables + texts)


@dataclass(frozen=True, eq=False)
class ComparisonPage(_Sheet):
    """Contents of the page of a comparison, in the order of the template."""

    template: ClassVar[str] = "comparison.html.jinja"

    title: str
    date: str
    several: bool  # records
    records: str
    alternatives: _report_tables.ReportTable
    lines: Sequence[tuple[str, str]]
    demands: _report_tables.ReportTable
    record: _report_tables.ReportedRecord
    warnings: Sequence[str]
    notes: Sequence[str]
    versions: str

    @property
    def height(self) -> float:
        """About the height in mm of all but the figure."""
        lines = sum(line_count_of_text(f"{head} {text}") for head, text in self.lines)
        rows = sum(max(math.ceil(len(cell.text) / _CELL_LETTERS) for cell in row) for row in self.alternatives.rows)
        texts = sum(map(line_count_of_text, (*self.warnings, *self.notes)))
        return _OUTLINES + _STRIP[1] + ROW * (15 + rows + lines + 1.2 * len(self.demands.rows) + texts)


def _run_report_page_as_html(page: RunReportPage | ComparisonPage, report: ReportedRuns, **more: Any) -> str:
    from rockflex.plot import draw_record_strip, draw_run_sheet

    sheet = draw_run_sheet(report.responses, report.labels, width=WIDTH / page.scale, height=page.figure_height)
    strip = draw_record_strip(page.record.time, page.record.acceleration, width=_STRIP[0], height=_STRIP[1])
    drawings = {
        "sheet": (sheet, "Histories and loops of all models"),
        "strip": (strip, "Ground acceleration"),
        **more,
    }
    return _page_as_html(page, drawings)


def _page_as_html(page: RunReportPage | ComparisonPage | SetReportPage, drawings: Mapping[str, tuple[Any, str]]) -> str:
    from markupsafe import Markup

    from rockflex.plot import figure_as_svg

    found = {stem: Markup(inline_svg(figure_as_svg(figure), stem, label)) for stem, (figure, label) in drawings.items()}
    templates = jinja_templates_in(TEMPLATES)
    templates.filters |= {"symbols": _symbols_as_html, "shortened": shortened}
    return templates.get_template(page.template).render(page=page, max_letters=MAX_LETTERS, **found)


def _warnings_of_runs(report: ReportedRuns, omitted: Collection[str]) -> list[str]:
    """Return the warnings of the runs, each with its models; of the peaks only for the labels in `omitted`."""
    found: dict[str, list[str]] = {}
    for label, run in zip(report.labels, report.responses, strict=True):
        for text in warnings_of(run.model, run.peaks()) if label in omitted else run.warnings:
            found.setdefault(text, []).append(label)
    return [f"{', '.join(labels)}: {text}" for text, labels in found.items()]


def _joined_notes(notes: Sequence[str]) -> list[str]:
    """Return the notes without breaks of lines; many of them as one paragraph."""
    texts = [text for text in (" ".join(note.split()) for note in notes) if text]
    return texts if len(texts) <= _MAX_NOTE_LINES else [" • ".join(texts)]


def _first_warnings_of_report(texts: Sequence[str]) -> list[str]:
    rest = len(texts) - MAX_WARNINGS
    return [
        *(shortened(text, MAX_LETTERS["warning"]) for text in texts[:MAX_WARNINGS]),
        *([f"and {number_with_noun(rest, 'more warning')}; see the responses"] if rest > 0 else []),
    ]


def _report_versions() -> str:
    found = package_versions(("rockflex", "numpy"))
    found["Python"] = found.pop("python")
    return ", ".join(f"{name} {version}" for name, version in found.items())


def _symbols_as_html(text: str) -> str:
    """Write "_" as a subscript and "^" as a superscript."""
    from markupsafe import Markup, escape

    lowered = _SUBSCRIPT.sub(r"\1<sub>\2</sub>", str(escape(text)))
    return Markup(_SUPERSCRIPT.sub(r"<sup>\1</sup>", lowered))


def write_report(
    responses: Response | Iterable[Response] | RecordSet | Comparison,
    path: str | Path,
    *,
    structure: Any = None,
    motion: GroundMotion | None = None,
    title: str | None = None,
    date: str | Date | None = None,
    friction: float | None = None,
    notes: str | Iterable[str] = (),
    limits: CheckLimits | None = None,
) -> Path:
    """Write the response of a structure to one record on one sheet of A4, as HTML that needs no other file.

    Of a set of records the page has the peaks by record, their statistics, the values for design and the checks, on as
    many sheets as it takes; `motion` and `friction` are not for it.

    The page has the parameters of the structure and its modes, the record, what is assumed, the histories and the loop
    of base moment and rotation of every model, their largest values, checks with their warnings, and the versions
    that computed them. Any browser prints it on exactly one sheet.

    The checks compare the rotation with the nominal limit of overturning, 0.7 atan(B/h*_1) (Section 3.3), the vertical
    reaction with zero, the friction that each run requires (Eqs. 20-22) with `friction`, the forces of tendons with
    those at which they yield, and the balance of the energies with zero. Friction and energies of a run on many stiff
    springs would take minutes; they are left out, and the page says so.

    Parameters
    ----------
    responses
        Up to six responses of one structure to one record at one scale, each with its history; or what `simulate_set`
        returned. Or a `Comparison`: then the page has all alternatives as they rock, their demands with the
        differences, statistics over several records, and the histories under the governing one.
    path
        The file to write, which ends in .html; an existing file is replaced. Missing folders are created.
    structure
        The structure, or its `RockingProperties`: it gives the page its kind, and all of its modes. Default: the
        properties of the response with the most modes.
    motion
        The record, scaled or not: the page then has its origin, its measures and its scale, relative to the
        record as `RecordInfo.scale` knows it. Default: the ground acceleration of the responses.
    title
        Heading. Default: the kind of the structure, and the record.
    date
        Date on the page. Default: today.
    friction
        Coefficient of friction between base and ground, to compare with the one that each run requires.
    notes
        A text, or several, to add to the page; up to 800 letters together.
    limits
        Limits of `check`, whose table the page of a run then has for every model. A set has it always.

    Returns
    -------
    Path
        The file written. It is written completely or not at all.

    Raises
    ------
    InputError
        If there are no responses or more than six, one has no history, they are not of one structure and one record, or
        `structure` or `motion` are not theirs; if the path is a folder or has another suffix, or cannot be written to;
        if the friction is not positive, or the notes are too long; if a set comes with a motion or a friction.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> pulse = rf.ricker_pulse(4.0, 0.6)
    >>> runs = [rf.simulate(frame, pulse, model, output="history") for model in ("2DOF-S", "MDOF-S", "fixed")]
    >>> folder = Path(tempfile.mkdtemp())
    >>> rf.write_report(runs, folder / "report.html", structure=frame, motion=pulse, friction=0.5).name
    'report.html'
    """
    target = checked_report_path("path", path)
    if isinstance(responses, Comparison):
        given = {"structure": structure, "motion": motion, "friction": friction, "limits": limits}
        unused = next((name for name, value in given.items() if value is not None), None)
        if unused is not None:
            raise InputError(f"A report of a comparison takes no {unused}. Leave it out.", field=unused)
        text = comparison_report_as_html(responses, title=title, date=date, notes=notes)
    else:
        text = run_report_as_html(
            responses,
            structure=structure,
            motion=motion,
            title=title,
            date=date,
            friction=friction,
            notes=notes,
            limits=limits,
        )
    try:
        return write_file_atomically(target, text.encode())
    except OSError as error:
        raise InputError(
            f"Cannot write to {target}: {error.strerror or error}. Give a path that can be written to.", field="path"
        ) from error


def run_report_as_html(
    responses: Response | Iterable[Response] | RecordSet,
    *,
    structure: Any = None,
    motion: GroundMotion | None = None,
    title: str | None = None,
    date: str | Date | None = None,
    friction: float | None = None,
    notes: str | Iterable[str] = (),
    omitted: Collection[str] = (),
    limits: CheckLimits | None = None,
) -> str:
    """Return the page of `write_report` as text; no energies and no friction of the models in `omitted`."""
    heading = _checked_report_title(title)
    day = _checked_report_date(date)
    coefficient = None if friction is None else _checked_friction_coefficient(friction)
    texts = _checked_report_notes(notes)
    if isinstance(responses, RecordSet):
        if motion is not None or coefficient is not None:
            raise InputError(
                "The report of a set has its records, and the friction among its limits. Leave motion and friction "
                "out, and give limits=CheckLimits(friction=...).",
                field="friction" if motion is None else "motion",
            )
        page = set_report_page(
            responses,
            structure=structure,
            title=heading,
            date=day,
            limits=limits,
            notes=_joined_notes(texts),
            versions=_report_versions(),
        )
        return _page_as_html(page, {"drawing": set_drawing(responses)})
    report = checked_reported_runs(responses, structure, motion)
    known = report.properties if structure is None else structure
    record, kind = _report_tables.reported_record(report), _report_tables.structure_kind_text(known)
    left_out = labels_of_long_runs(report).union(omitted)
    fell = any(run.status == "overturned" for run in report.responses)
    page = RunReportPage(
        title=shortened(heading or f"{kind} under {record.name or 'a ground motion'}", MAX_LETTERS["title"]),
        date=day,
        kind=kind,
        facts=_report_tables.structure_facts(report.properties),
        modes=_report_tables.mode_table(report.properties),
        record=record,
        lines=_report_tables.assumption_lines(report),
        elements=_report_tables.element_table(report),
        peaks=_report_tables.peak_table(report),
        checks=run_check_table(report, coefficient, left_out),
        legend=[
            *[f"{_report_tables.DAGGER} The values of a run that overturned include its fall."] * fell,
            *run_check_legend(report, coefficient, omitted=bool(left_out)),
        ],
        limits=None if limits is None else _limits_of_runs(report, limits, left_out),
        warnings=_first_warnings_of_report([*structure_warnings(known), *_warnings_of_runs(report, left_out)]),
        notes=_joined_notes(texts),
        versions=_report_versions(),
        inputs=report_fingerprint(report, record),
    )
    return _run_report_page_as_html(page, report)


def _limits_of_runs(report: ReportedRuns, limits: CheckLimits, omitted: Collection[str]) -> _report_tables.ReportTable:
    """Return the checks of runs against limits, without the friction of the models in `omitted`."""
    tables = [
        check(run, dataclasses.replace(limits, friction=None) if label in omitted else limits)
        for label, run in zip(report.labels, report.responses, strict=True)
    ]
    return limit_check_table(report.labels, tables)


def comparison_report_as_html(
    comparison: Comparison,
    *,
    title: str | None = None,
    date: str | Date | None = None,
    notes: str | Iterable[str] = (),
) -> str:
    """Return the page of `write_report` of a comparison as text."""
    from rockflex.plot import draw_alternatives

    report = reported_alternatives(comparison)
    record = _report_tables.reported_record(report)
    records, several = number_with_noun(comparison.n_records, "record"), comparison.n_records > 1
    usual = f"{', '.join(comparison.names)} under {records if several else record.name or 'a ground motion'}"
    fell = [
        f"{name} overturned under {n} of {records}"
        for name, n in zip(comparison.names, comparison.overturned, strict=True)
        if n
    ]
    page = ComparisonPage(
        title=shortened(_checked_report_title(title) or usual, MAX_LETTERS["title"]),
        date=_checked_report_date(date),
        several=several,
        records=f"of {records}: {' / '.join(STATISTICS[each] for each in SHOWN)}" if several else "",
        alternatives=alternatives_table(comparison),
        lines=[model_line(comparison), *_report_tables.assumption_lines(report)],
        demands=demand_table(comparison),
        record=record,
        warnings=_first_warnings_of_report([*fell, *_warnings_of_runs(report, ())]),
        notes=_joined_notes(_checked_report_notes(notes)),
        versions=_report_versions(),
    )
    outlines = draw_alternatives(comparison, width=WIDTH, height=_OUTLINES)
    return _run_report_page_as_html(page, report, outlines=(outlines, "The alternatives as they rock"))


def checked_report_path(name: str, path: str | Path) -> Path:
    """Return the path of a report."""
    target = checked_file_path(name, path)
    if target.is_dir():
        raise InputError(
            f"{name} {target} is a folder. Give a file in it, such as {target / 'report.html'}.", field="path"
        )
    if target.suffix.lower() not in SUFFIXES:
        raise InputError(
            f"A report is a page of HTML, but the {name} {shown(str(target))} ends in {shown(target.suffix)}. Let it "
            "end in .html; a browser prints the page, also as PDF.",
            field="path",
        )
    return target


def _checked_report_title(title: Any) -> str | None:
    if isinstance(title, str | None):
        return title
    raise InputError(f"title must be a text, but {shown(title)} was given.", field="title")


def _checked_report_date(date: Any) -> str:
    if isinstance(date, str):
        return date
    if date is None or isinstance(date, Date):
        return (date or Date.today()).strftime("%Y-%m-%d")
    raise InputError(f"date must be a text or a datetime.date, but {shown(date)} was given.", field="date")


def _checked_friction_coefficient(friction: float) -> float:
    try:
        return friction_coefficient(friction)
    except InputError as error:
        raise InputError(str(error).replace("mu must", "friction must"), field="friction") from None


def _checked_report_notes(notes: Any) -> list[str]:
    texts: list[Any] = [notes] if isinstance(notes, str) else list(notes) if isinstance(notes, Iterable) else [notes]
    for text in texts:
        if not isinstance(text, str):
            raise InputError(f"notes must be texts, but {shown(text)} was given.", field="notes")
    size = sum(map(len, texts))
    if size > MAX_NOTES:
        raise InputError(
            f"The page has room for notes of {MAX_NOTES} letters, but {size} were given. Shorten them.", field="notes"
        )
    return texts


def report_fingerprint(report: ReportedRuns, record: _report_tables.ReportedRecord) -> str:
    """Return a hash of structure, ground and record, and of the assumptions and the initial state of each run."""
    p = report.properties
    numbers: list[Any] = [record.time, record.acceleration, record.vertical]
    numbers += [p.omega, p.effective_mass, p.effective_height, p.zeta, p.top_ordinate]
    numbers.append([p.i_theta, p.l0r, p.m_tot, p.half_width, p.translational_inertia, p.eccentricity])
    texts = [repr((p.elements, report.labels))]
    for history in report.histories:
        model = history.model
        # Initial states that follow from the input, such as rest on springs, have rounding errors.
        numbers += [[float(f"{value:.6g}") for value in history.states[0].tolist()], *_fingerprint_of_ground(model)]
        texts += [_fingerprint_of_impact_law(model), repr(model.bouc_wen), f"{float(history.time[-1]):.6g}"]
    content = b"".join(np.asarray(each, dtype=np.float64).tobytes() for each in numbers)
    return hashlib.sha256(content + "\n".join(texts).encode()).hexdigest()[:12]


def _fingerprint_of_ground(model: Any) -> list[Any]:
    friction = getattr(model, "friction", None)
    known = [] if friction is None else [friction]
    springs = model.springs
    return known if springs is None else [*known, springs.positions, springs.stiffness, springs.damping, model.inertia]


def _fingerprint_of_impact_law(model: Any) -> str:
    # An object that is no dataclass is written with its address, which no two sessions share.
    law = model.law
    return repr(law) if dataclasses.is_dataclass(law) else type(law).__name__
