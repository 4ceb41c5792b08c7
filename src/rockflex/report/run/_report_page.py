"""The page of a run: its contents put together, laid out on one sheet, and written as HTML."""

import dataclasses
import hashlib
import math
import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from datetime import date as Date  # noqa: N812
from pathlib import Path
from typing import Any

import numpy as np

from rockflex._errors import InputError
from rockflex._files import checked_file_path, write_file_atomically
from rockflex._shown import number_with_noun, shortened, shown
from rockflex._versions import package_versions
from rockflex.motion import GroundMotion
from rockflex.report._publication_files import inline_svg, jinja_templates_in
from rockflex.report.run import _report_tables
from rockflex.report.run._report_appendix import ReportAppendix, report_appendix
from rockflex.report.run._report_files import chromium, page_as_pdf, report_as_word, word_module
from rockflex.report.run._reported_runs import ReportedRuns, checked_reported_runs
from rockflex.report.run._run_checks import labels_of_long_runs, run_check_legend, run_check_table
from rockflex.response import Response, friction_coefficient, warnings_of
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
_FEW = 4  # elements, whose loops are readable in half a sheet
_STRIP = (65.0, 22.0)  # mm
_SUBSCRIPT, _SUPERSCRIPT = re.compile(r"([^\W\d_]\*?)_([\w*–]+)"), re.compile(r"\^(−?\d+)")
SUFFIXES = (".html", ".htm", ".pdf", ".docx")
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


@dataclass(frozen=True, eq=False)
class RunReportPage:
    """Contents of a page, in the order of the template."""

    title: str
    date: str
    author: str
    heads: Sequence[tuple[str, str]]  # project, author and checker, as far as they are given
    kind: str
    facts: Sequence[_report_tables.ReportFact]
    modes: _report_tables.ReportTable | None
    record: _report_tables.ReportedRecord
    lines: Sequence[tuple[str, str]]
    elements: _report_tables.ReportTable | None
    peaks: _report_tables.ReportTable
    checks: _report_tables.ReportTable
    legend: Sequence[str]
    warnings: Sequence[str]
    notes: Sequence[str]
    versions: str
    inputs: str
    appendix: ReportAppendix

    @property
    def height(self) -> float:
        """About the height in mm of all but the figure: the browser makes the layout, and the figure takes the rest."""
        structure = len(self.facts) / 2 + (0 if self.modes is None else 2 + len(self.modes.rows))
        record = 8 + len(self.record.facts)
        lines = sum(line_count_of_text(f"{head} {text}") for head, text in self.lines)
        tables = line_count_of_table(self.elements) + line_count_of_table(self.peaks) + line_count_of_table(self.checks)
        texts = line_count_of_text(" ".join(self.legend)) + sum(map(line_count_of_text, (*self.warnings, *self.notes)))
        return ROW * (
            8 + bool(self.heads) + line_count_of_text(self.title) + max(structure, record) + lines + tables + texts
        )

    @property
    def scale(self) -> float:
        """Size of everything on the sheet: 1, or less to make room for all texts."""
        return min(1.0, max(MIN_SCALE, HEIGHT / (self.height + FIGURE_HEIGHTS[0])))

    @property
    def figure_height(self) -> float:
        """Height in mm for which the figure is drawn, before it is scaled."""
        low, high = FIGURE_HEIGHTS
        return min(max(HEIGHT / self.scale - self.height, low), high)


def _run_report_page_as_html(page: RunReportPage, report: ReportedRuns) -> str:
    from markupsafe import Markup

    from rockflex.plot import figure_as_svg

    strip, sheet, *loops = [
        (label, Markup(inline_svg(figure_as_svg(figure), stem, label)))
        for stem, (label, figure) in _figures_of_report(page, report).items()
    ]
    templates = jinja_templates_in(TEMPLATES)
    templates.filters |= {"symbols": _symbols_as_html, "shortened": shortened}
    template = templates.get_template("run.html.jinja")
    return template.render(page=page, max_letters=MAX_LETTERS, sheet=sheet[1], strip=strip[1], loops=loops)


def _figures_of_report(page: RunReportPage, report: ReportedRuns) -> dict[str, tuple[str, Any]]:
    """Return what each figure shows, and the figure, by a short name: the record, the runs, and loops of elements."""
    from rockflex.plot import draw_record_strip, draw_run_sheet, plot_loops

    record, height = page.record, page.figure_height
    strip = draw_record_strip(record.time, record.acceleration, width=_STRIP[0], height=_STRIP[1])
    sheet = draw_run_sheet(report.responses, report.labels, width=WIDTH / page.scale, height=height)
    found = {"strip": ("Ground acceleration", strip), "sheet": ("Histories and loops of all models", sheet)}
    for place, (label, run) in enumerate(page.appendix.loops):
        size = "page" if len(report.properties.elements) > _FEW else (7.2, 4.2)  # of which a sheet has room for two
        found[f"loops{place}"] = (f"Loops of base and elements, {label}", plot_loops(run, title="", size=size))
    return found


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
    responses: Response | Iterable[Response],
    path: str | Path,
    *,
    structure: Any = None,
    motion: GroundMotion | None = None,
    title: str | None = None,
    date: str | Date | None = None,
    friction: float | None = None,
    notes: str | Iterable[str] = (),
    project: str = "",
    author: str = "",
    checker: str = "",
    appendix: bool = False,
) -> Path:
    """Write the response of a structure to one record on one sheet of A4: HTML that needs no other file, PDF or DOCX.

    The page has the parameters of the structure and its modes, the record, what is assumed, the histories and the loop
    of base moment and rotation of every model, their largest values, checks with their warnings, and the versions
    that computed them. Any browser prints it on exactly one sheet. A PDF is that page, printed by Chromium, Chrome or
    Edge, found on the path or named by the environment variable ``ROCKFLEX_BROWSER``. A document of Word has the same
    contents, on as many sheets as they take; it needs the extra ``rockflex[docx]``.

    The checks compare the rotation with the nominal limit of overturning, 0.7 atan(B/h*_1) (Section 3.3), the vertical
    reaction with zero, the friction that each run requires (Eqs. 20-22) with `friction`, the forces of tendons with
    those at which they yield, and the balance of the energies with zero. Friction and energies of a run on many stiff
    springs would take minutes; they are left out, and the page says so.

    Parameters
    ----------
    responses
        Up to six responses of one structure to one record at one scale, each with its history.
    path
        The file to write, which ends in .html, .pdf or .docx; an existing one is replaced. Missing folders are created.
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
    project, author, checker
        Texts for a line below the heading.
    appendix
        Whether further sheets follow: cross-sections with their material, if the structure has any, and the loops of
        base and elements of every run that lifts.

    Returns
    -------
    Path
        The file written. It is written completely or not at all.

    Raises
    ------
    InputError
        If there are no responses or more than six, one has no history, they are not of one structure and one record, or
        `structure` or `motion` are not theirs; if the path is a folder or has another suffix, or cannot be written to;
        if the friction is not positive, or the notes are too long; if there is no browser for a PDF, or python-docx is
        not installed.

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
    given: dict[str, Any] = {"structure": structure, "motion": motion, "title": title, "date": date, "notes": notes}
    given |= {"friction": friction, "project": project, "author": author, "checker": checker, "appendix": appendix}
    page, report = _run_report_page(responses, **given)
    if target.suffix.lower() == ".docx":
        from rockflex.plot import figure_as_png

        drawings = [(label, figure_as_png(figure)) for label, figure in _figures_of_report(page, report).values()]
        content = report_as_word(page, drawings)
    else:
        text = _run_report_page_as_html(page, report)
        content = page_as_pdf(text) if target.suffix.lower() == ".pdf" else text.encode()
    try:
        return write_file_atomically(target, content)
    except OSError as error:
        raise InputError(
            f"Cannot write to {target}: {error.strerror or error}. Give a path that can be written to.", field="path"
        ) from error


def run_report_as_html(responses: Response | Iterable[Response], **options: Any) -> str:
    """Return the page of `write_report` with these options as text; no energies and no friction of models `omitted`."""
    return _run_report_page_as_html(*_run_report_page(responses, **options))


def _run_report_page(
    responses: Response | Iterable[Response],
    *,
    structure: Any = None,
    motion: GroundMotion | None = None,
    title: str | None = None,
    date: str | Date | None = None,
    friction: float | None = None,
    notes: str | Iterable[str] = (),
    omitted: Collection[str] = (),
    project: str = "",
    author: str = "",
    checker: str = "",
    appendix: bool = False,
) -> tuple[RunReportPage, ReportedRuns]:
    """Return the contents of a report, and its runs."""
    if not isinstance(title, str | None):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"title must be a text, but {shown(title)} was given.", field="title")
    named = {"Project": project, "Author": author, "Checked by": checker}
    for name, text in zip(("project", "author", "checker"), named.values(), strict=True):
        if not isinstance(text, str):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(f"{name} must be a text, but {shown(text)} was given.", field=name)
    heads = [(name, shortened(text, MAX_LETTERS["name"])) for name, text in named.items() if text]
    day = _checked_report_date(date)
    coefficient = None if friction is None else _checked_friction_coefficient(friction)
    texts = _checked_report_notes(notes)
    report = checked_reported_runs(responses, structure, motion)
    known = report.properties if structure is None else structure
    record, kind = _report_tables.reported_record(report), _report_tables.structure_kind_text(known)
    left_out = labels_of_long_runs(report).union(omitted)
    fell = any(run.status == "overturned" for run in report.responses)
    page = RunReportPage(
        title=shortened(title or f"{kind} under {record.name or 'a ground motion'}", MAX_LETTERS["title"]),
        date=day,
        author=author,
        heads=heads,
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
        warnings=_first_warnings_of_report([*structure_warnings(known), *_warnings_of_runs(report, left_out)]),
        notes=_joined_notes(texts),
        versions=_report_versions(),
        inputs=report_fingerprint(report, record),
        appendix=report_appendix(report) if appendix else ReportAppendix(None, ()),
    )
    return page, report


def checked_report_path(name: str, path: str | Path) -> Path:
    """Return the path of a report."""
    target = checked_file_path(name, path)
    if target.is_dir():
        raise InputError(
            f"{name} {target} is a folder. Give a file in it, such as {target / 'report.html'}.", field="path"
        )
    if target.suffix.lower() not in SUFFIXES:
        raise InputError(
            f"A report is a page of HTML, a PDF or a document of Word, but the {name} {shown(str(target))} ends in "
            f"{shown(target.suffix)}. Let it end in .html, .pdf or .docx.",
            field="path",
        )
    needed = {".pdf": chromium, ".docx": word_module}.get(target.suffix.lower())
    if needed is not None:
        needed()  # raises where it is missing, before anything is computed
    return target


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
