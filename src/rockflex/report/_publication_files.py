"""A report on a publication as files: HTML, Markdown, a table of its numbers, and its figures."""

import csv
import io
import math
import re
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from rockflex.foundation.csv import guarded_text
from rockflex.foundation.files import write_file_atomically
from rockflex.report._document import FinishedResult, PublicationReport, PublishedLine

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATES = Path(__file__).parent / "templates"
CLASSES = ("best", "good", "fair", "open", "bad")  # of the verdicts, best first; the last one is bad
CHECKS = ("place", "check", "paper", "rockflex", "unit", "holds", "criterion and remarks")
HEAD = ("place", "number", "paper", "rockflex", "unit", "difference", "verdict", "criterion and remarks")
COLUMNS = ("target", "place", "name", "printed", "rockflex", "unit", "difference", "criterion", "verdict", "note")


def inline_svg(drawing: str, stem: str, label: str) -> str:
    """Turn the text of an SVG file into an element of a page, which fills the available width.

    The prolog, metadata and namespaces of a separate file are removed. Identifiers get the stem, which no other figure
    in the page has, as a prefix. `label` is the text for readers who cannot see the figure, without quotes or markup.
    """
    body = drawing[drawing.index("<svg") :]
    body = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", body, flags=re.DOTALL)
    body = re.sub(r'\s+xmlns(:\w+)?="[^"]*"', "", body).replace("xlink:href=", "href=")
    body = re.sub(r'(\bid="|\bhref="#|\burl\(#)', rf"\g<1>{stem}-", body)
    head, rest = body.split(">", 1)
    head = re.sub(r'\s(width|height)="[^"]*"', "", head)
    # A rule of one figure would hold for the whole page.
    rest = re.sub(r'<style type="text/css">.*?</style>', "", rest, flags=re.DOTALL)
    return f'{head} role="img" aria-label="{label}" class="drawing">{rest}'


def report_to_html(document: PublicationReport) -> str:
    """Write the document as a page."""
    from markupsafe import Markup, escape

    figures = {
        stem: Markup(inline_svg(drawing, stem, str(escape(section.title))))
        for section in document.sections
        for stem, drawing in section.drawings.items()
    }
    *better, worst = document.verdicts
    looks = {name: CLASSES[min(place, 3)] for place, name in enumerate(better)} | {worst: CLASSES[-1]}
    failing = [line for s in document.sections for line in s.numbers if line.verdict == worst]
    template = jinja_templates_in(TEMPLATES).get_template("report.html.jinja")
    return template.render(
        document=document, figures=figures, looks=looks, counts=document.counts, failing=failing, worst=worst
    )


@lru_cache(maxsize=2)
def jinja_templates_in(folder: Path) -> "Environment":
    """Return the templates of a folder; everything is escaped but figures, which are marked as safe."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(folder), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip


def report_to_markdown(document: PublicationReport) -> str:
    """Write the document as GitHub-flavoured Markdown; figures are links to ``<stem>.svg``."""
    counts, plain = document.counts, _escaped_markdown
    versions = ", ".join(f"{name} {plain(version)}" for name, version in document.versions.items())
    verdicts = [(name, str(counts[name]), meaning) for name, meaning in document.verdicts.items()]
    parts = [
        f"# {plain(document.title)}",
        plain(document.source),
        f"Records. {plain(document.records)}",
        f"Versions. {versions}.",
        *([f"**{plain(document.gaps)}**"] if document.gaps else []),
        _table_in_markdown(("verdict", "numbers", "meaning"), verdicts),
        plain(document.checks),
        "\n".join(f"- *Remark, {plain(kind)}.* {plain(meaning)}" for kind, meaning in document.remarks.items()),
        *(part for section in document.sections for part in _section_in_markdown(section)),
    ]
    return "\n\n".join(parts) + "\n"


def _section_in_markdown(section: FinishedResult) -> Iterable[str]:
    yield f"## {_escaped_markdown(section.name)}: {_escaped_markdown(section.title)}"
    if section.note:
        yield _escaped_markdown(section.note)
    for stem in section.drawings:
        yield f"![{_escaped_markdown(section.title)}]({stem}.svg)"
    numbers = [(line, (line.difference_as_text, f"**{line.verdict}**")) for line in section.numbers]
    checks = [(check, ("yes" if check.holds else "**no**",)) for check in section.checks]
    if numbers:
        yield _table_in_markdown(HEAD, [_row_of_line(*each) for each in numbers])
    if checks:
        yield "Checks of ourselves, not counted:"
        yield _table_in_markdown(CHECKS, [_row_of_line(*each) for each in checks])
    for remark in section.remarks:
        kind, title, text = map(_escaped_markdown, (remark.kind, remark.title, remark.text))
        yield f"**Remark, {kind}: {title}.** {text}"
        if remark.head:
            yield _table_in_markdown(remark.head, remark.rows)


def _row_of_line(line: PublishedLine, found: Iterable[str]) -> tuple[str, ...]:
    return line.place, line.name, line.printed, line.ours_as_text, line.unit, *found, line.remarks


def _table_in_markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [[_escaped_markdown(cell) for cell in head], ["---"] * len(head)]
    lines += [[cell if cell.startswith("**") else _escaped_markdown(cell) for cell in row] for row in rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _escaped_markdown(text: str) -> str:
    """Escape characters that Markdown would read as markup."""
    return re.sub(r"([\\`*_\[\]<>|#])", r"\\\1", text)


def report_numbers_to_csv(document: PublicationReport) -> str:
    """Write one row per number, with a header, in UTF-8; `rockflex` has all digits, or "inf" or "nan"."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for section in document.sections:
        for line in section.numbers:
            ours = repr(line.ours) if math.isfinite(line.ours) else f"{line.ours:g}"
            first = map(guarded_text, (section.name, line.place, line.name))  # which may be names of records
            rest = (line.printed, ours, line.unit, line.difference_as_text, line.criterion, line.verdict)
            writer.writerow((*first, *rest, guarded_text(line.note)))
    return out.getvalue()


def write_publication_report(document: PublicationReport, folder: Path, *, only: str | None = None) -> list[Path]:
    """Write the figures as SVG, ``report.html``, ``report.md`` and ``numbers.csv``, each completely or not at all.

    With `only`, figures of other sections are taken to be there. Returns the files of the report, figures first.
    """
    files: list[Path] = []
    for section in document.sections:
        for stem, drawing in section.drawings.items():
            files.append(folder / f"{stem}.svg")
            if only in (None, section.name):
                write_file_atomically(files[-1], drawing.encode())
    texts = {
        "report.html": report_to_html(document),
        "report.md": report_to_markdown(document),
        "numbers.csv": report_numbers_to_csv(document),
    }
    return [*files, *(write_file_atomically(folder / name, text.encode()) for name, text in texts.items())]
