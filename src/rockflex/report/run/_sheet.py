"""The common parts of all reports: head and foot, texts, room on a sheet, and how they become HTML."""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date as Date  # noqa: N812
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from rockflex.foundation.errors import InputError
from rockflex.foundation.language import chosen_language, translated
from rockflex.foundation.shown import shortened, shown
from rockflex.foundation.versions import package_versions
from rockflex.report._publication_files import inline_svg, jinja_templates_in
from rockflex.report.run._report_tables import ReportFact, ReportTable

WIDTH, HEIGHT = 186.0, 272.0  # of a sheet of A4 within its margins, in mm
FIGURE_HEIGHTS = (58.0, 160.0)  # least and largest height of the figure in mm
STRIP = (65.0, 22.0)  # the figure of the record, mm
MIN_SCALE = 0.75  # of the usual size of the type, on a sheet that is full
ROW = 3.4  # height of a line of text in mm
ROW_LETTERS = 130  # in a line over the whole width
TEMPLATES = Path(__file__).parent / "templates"
MAX_LETTERS = {"title": 110, "name": 70, "source": 110, "warning": 400}  # letters
MAX_WARNINGS = 4  # texts
MAX_NOTES = 800  # letters of all notes
_MAX_NOTE_LINES = 6  # of more, each does not have a line of its own
_SUBSCRIPT, _SUPERSCRIPT = re.compile(r"([^\W\d_]\*?)_([\w*–]+)"), re.compile(r"\^(−?\d+)")


class Drawing(NamedTuple):
    """A place in a document for one of the figures of a page."""

    stem: str
    share: float = 1.0  # of the width


Figures = Mapping[str, tuple[str, Any]]  # by a short name: what a figure shows, and the figure of matplotlib
Block = ReportTable | Sequence[ReportFact] | Sequence[tuple[str, str]] | Drawing | str | None


@dataclass(frozen=True)
class ReportTexts:
    """The texts that users give: title, date, what is below the heading, the author, and notes."""

    title: str | None
    date: str
    heads: Sequence[tuple[str, str]]  # project, author and checker, as far as they are given
    author: str
    notes: Sequence[str]


def checked_report_texts(title: Any, date: Any, notes: Any, project: Any, author: Any, checker: Any) -> ReportTexts:
    """Check the texts of a report."""
    if not isinstance(title, str | None):
        raise InputError(f"title must be a text, but {shown(title)} was given.", field="title")
    named = {"project": project, "author": author, "checker": checker}
    for name, text in named.items():
        if not isinstance(text, str):
            raise InputError(f"{name} must be a text, but {shown(text)} was given.", field=name)
    heads = [(translated("Project"), project), (translated("Author"), author), (translated("Checked by"), checker)]
    heads = [(name, shortened(text, MAX_LETTERS["name"])) for name, text in heads if text]
    return ReportTexts(title, _checked_report_date(date), heads, author, _joined_notes(_checked_report_notes(notes)))


def _checked_report_date(date: Any) -> str:
    if isinstance(date, str):
        return date
    if date is None or isinstance(date, Date):
        return (date or Date.today()).strftime("%Y-%m-%d")
    raise InputError(f"date must be a text or a datetime.date, but {shown(date)} was given.", field="date")


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


def _joined_notes(notes: Sequence[str]) -> list[str]:
    """Return the notes without breaks of lines; many of them as one paragraph."""
    texts = [text for text in (" ".join(note.split()) for note in notes) if text]
    return texts if len(texts) <= _MAX_NOTE_LINES else [" • ".join(texts)]


def report_versions() -> str:
    """Return the versions that computed a report."""
    found = package_versions(("rockflex", "numpy"))
    found["Python"] = found.pop("python")
    return ", ".join(f"{name} {version}" for name, version in found.items())


@dataclass(frozen=True, eq=False, kw_only=True)
class ReportPage(ABC):
    """Contents of a page; those of each kind of report follow, in the order of its template."""

    template: ClassVar[str]

    title: str
    texts: ReportTexts
    warnings: Sequence[str]
    inputs: str = ""  # hash of what was computed
    versions: str = field(default_factory=report_versions)

    @property
    @abstractmethod
    def sections(self) -> list[tuple[str, Sequence[Block]]]:
        """The contents with their headings, one below the other as in a document."""

    @property
    def scale(self) -> float:
        """Size of everything on the sheet."""
        return 1.0


class OneSheet(ReportPage):
    """A page whose contents share one sheet with a figure."""

    @property
    @abstractmethod
    def height(self) -> float:
        """About the height in mm of all but the figure: the browser makes the layout, and the figure takes the rest."""

    @property
    def scale(self) -> float:
        """Size of everything on the sheet: 1, or less to make room for all texts."""
        return min(1.0, max(MIN_SCALE, HEIGHT / (self.height + FIGURE_HEIGHTS[0])))

    @property
    def figure_height(self) -> float:
        """Height in mm for which the figure is drawn, before it is scaled."""
        low, high = FIGURE_HEIGHTS
        return min(max(HEIGHT / self.scale - self.height, low), high)


def line_count_of_text(text: str) -> int:
    """Return about how many lines a text takes."""
    return math.ceil(len(text) / ROW_LETTERS)


def line_count_of_table(table: ReportTable | None) -> int:
    """Return about how many lines a table takes with its heading."""
    if table is None:
        return 0
    cells = [[name for name, _ in table.heads], *([cell.text for cell in row] for row in table.rows)]
    across = sum(1 + max(map(len, column)) for column in zip(*cells, strict=True))
    return 3 + len(table.rows) * math.ceil(across / ROW_LETTERS)


def first_warnings(texts: Sequence[str]) -> list[str]:
    """Return the warnings that a sheet has room for, and how many more there are."""
    rest = len(texts) - MAX_WARNINGS
    more = translated(
        "and {n} more warning; see the responses" if rest == 1 else "and {n} more warnings; see the responses", n=rest
    )
    return [
        *(shortened(text, MAX_LETTERS["warning"]) for text in texts[:MAX_WARNINGS]),
        *([more] if rest > 0 else []),
    ]


def page_as_html(page: ReportPage, figures: Figures) -> str:
    """Return a page as HTML that needs no other file."""
    from markupsafe import Markup

    from rockflex.plot._figures import figure_as_svg

    drawings = {
        stem: (label, Markup(inline_svg(figure_as_svg(figure), stem, label)))
        for stem, (label, figure) in figures.items()
    }
    templates = jinja_templates_in(TEMPLATES)
    templates.filters |= {"symbols": _symbols_as_html, "shortened": shortened}
    given: dict[str, Any] = {
        "t": translated,
        "language": chosen_language()[0],
        "max_letters": MAX_LETTERS,
        "drawings": drawings,
    }
    return templates.get_template(page.template).render(page=page, **given)


def _symbols_as_html(text: str) -> str:
    """Write "_" as a subscript and "^" as a superscript."""
    from markupsafe import Markup, escape

    lowered = _SUBSCRIPT.sub(r"\1<sub>\2</sub>", str(escape(text)))
    return Markup(_SUPERSCRIPT.sub(r"<sup>\1</sup>", lowered))
