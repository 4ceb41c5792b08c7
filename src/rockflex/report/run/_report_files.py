"""Reports as files of other programs: PDF, printed by a browser, and documents of Word."""

import errno
import io
import os
import re
import shutil
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rockflex.foundation.errors import InputError
from rockflex.foundation.language import chosen_language, translated
from rockflex.foundation.processes import ProcessWithFolder
from rockflex.foundation.shown import shortened
from rockflex.report.run._report_tables import ReportFact, ReportTable
from rockflex.report.run._sheet import Drawing, ReportPage

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")
BROWSER_VARIABLE = "ROCKFLEX_BROWSER"
_MAX_SECONDS = 120.0
_LEAST_ROOM = 1_000_000  # bytes on the disk, below which a print fails for want of them
_MARGIN, _WIDTH = 12.0, 186.0  # of a sheet of A4 in mm
_SUBSCRIPT = re.compile(r"(?<=[^\W\d_])(\*?)_([\w*–]+)|\^(−?\d+)")


def found_browser() -> str | None:
    """Return the program of a browser of the Chromium family; None if there is none."""
    named = os.environ.get(BROWSER_VARIABLE)
    return shutil.which(named) if named else next(filter(None, map(shutil.which, BROWSERS)), None)


def chromium() -> str:
    """Return the program of a browser of the Chromium family.

    Raises
    ------
    InputError
        If there is none.
    """
    found, named = found_browser(), os.environ.get(BROWSER_VARIABLE)
    if found is None:
        said = f"{BROWSER_VARIABLE} is {named}, which is no program" if named else f"none of {', '.join(BROWSERS)} is"
        raise InputError(
            f"A PDF is printed by Chromium, Chrome or Edge, but {said}{'' if named else ' on the path'}. Install one, "
            f"let {BROWSER_VARIABLE} name it, or write a report that ends in .html, which any browser prints as PDF.",
            field="path",
        )
    return found


def page_as_pdf(text: str) -> bytes:
    """Print a page of HTML that needs no other file.

    Raises
    ------
    InputError
        If there is no browser, or it writes nothing.
    """
    program = chromium()

    def command(folder: Path) -> list[str]:
        page = folder / "report.html"
        page.write_text(text, "utf-8")
        given = [program, "--headless", "--disable-gpu", "--disable-dev-shm-usage", "--no-pdf-header-footer"]
        given += [f"--user-data-dir={folder}/profile", f"--print-to-pdf={folder}/report.pdf"]
        if getattr(os, "geteuid", lambda: 1)() == 0:
            given.append("--no-sandbox")  # which it refuses to do without for root, as in containers
        return [*given, page.as_uri()]

    try:
        running = ProcessWithFolder(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        raise _not_printed(program, error.strerror or str(error)) from error
    with running:
        printed = running.folder / "report.pdf"
        try:
            said = running.process.communicate(timeout=_MAX_SECONDS)[1]
        except subprocess.TimeoutExpired as error:
            said = str(error)
        if not printed.exists():
            full = shutil.disk_usage(running.folder).free < _LEAST_ROOM
            cause = OSError(errno.ENOSPC, "the disk is full") if full else None
            raise _not_printed(program, said.replace(str(running.folder), "…")) from cause
        return printed.read_bytes()


def _not_printed(program: str, said: str) -> InputError:
    return InputError(
        f"{program} printed no PDF: {shortened(said.strip() or 'it said nothing', 300)}. Write a report that ends in "
        ".html, and print it from a browser.",
        field="path",
    )


def word_module() -> Any:
    """Return python-docx.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        import docx
    except ImportError as error:
        raise InputError(
            'A report for Word needs python-docx, which is not installed: pip install "rockflex[docx]". Or write one '
            "that ends in .html.",
            field="path",
        ) from error
    return docx


def report_as_word(page: ReportPage, drawings: Mapping[str, tuple[str, bytes]]) -> bytes:
    """Return a page as a document of Word; `drawings` are the captions and the PNG files of its figures."""
    docx = word_module()
    document: Any = docx.Document()
    body = document.sections[0]
    body.page_width, body.page_height = docx.shared.Mm(210), docx.shared.Mm(297)
    for side in ("left", "right", "top", "bottom"):
        setattr(body, f"{side}_margin", docx.shared.Mm(_MARGIN))
    usual = document.styles["Normal"]
    usual.font.name, usual.font.size = "Arial", docx.shared.Pt(8)
    usual.paragraph_format.space_after = docx.shared.Pt(3)
    properties = document.core_properties
    properties.title, properties.author, properties.comments = page.title, page.texts.author, ""
    properties.language = chosen_language()[0]

    document.add_heading(page.title, 1)
    _add_lines(document, [*page.texts.heads, (translated("Date"), page.texts.date)])
    for heading, blocks in page.sections:
        document.add_heading(heading, 2)
        for block in blocks:
            _add_block(docx, document, block, drawings)
    _add_lines(document, [(translated("Warning"), text) for text in page.warnings])
    for text in page.texts.notes:
        document.add_paragraph(text)
    made = [translated("Computed by {versions}", versions=page.versions)]
    made += [translated("inputs {hash}", hash=page.inputs)] if page.inputs else []
    document.add_paragraph("; ".join(made))
    content = io.BytesIO()
    document.save(content)
    return content.getvalue()


def _add_block(docx: Any, document: Any, block: Any, drawings: Mapping[str, tuple[str, bytes]]) -> None:
    """Add a table, a list of facts, headed lines, a figure or a text; nothing for None."""
    if isinstance(block, Drawing):
        caption, content = drawings[block.stem]
        document.add_picture(io.BytesIO(content), width=docx.shared.Mm(block.share * _WIDTH))
        document.add_paragraph(caption)
    elif isinstance(block, ReportTable):
        _add_table(document, block)
    elif isinstance(block, str):
        _add_runs(document.add_paragraph(), block)
    elif block and isinstance(block[0], ReportFact):
        _add_facts(document, block)
    elif block:
        _add_lines(document, block)


def _add_runs(paragraph: Any, text: str, *, bold: bool = False) -> None:
    """Add a text to a paragraph, with subscripts after "_" and superscripts after "^"."""
    last = 0
    for found in _SUBSCRIPT.finditer(text):
        star, low, high = found.groups()
        paragraph.add_run(text[last : found.start()] + (star or "")).bold = bold
        part = paragraph.add_run(low or high)
        part.bold = bold
        setattr(part.font, "subscript" if low else "superscript", True)
        last = found.end()
    paragraph.add_run(text[last:]).bold = bold


def _add_lines(document: Any, lines: Iterable[tuple[str, str]]) -> None:
    for head, text in lines:
        paragraph = document.add_paragraph()
        paragraph.add_run(f"{head}: ").bold = True
        _add_runs(paragraph, text)


def _add_facts(document: Any, facts: Sequence[Any]) -> None:
    table = document.add_table(rows=0, cols=4)
    for first, second in zip(facts[::2], [*facts[1::2], *[None] * (len(facts) % 2)], strict=True):
        cells = table.add_row().cells
        for place, fact in ((0, first), (2, second)):
            if fact is not None:
                _add_runs(cells[place].paragraphs[0], fact.name)
                _add_runs(cells[place + 1].paragraphs[0], f"{fact.cell.text} {fact.unit}".strip())


def _add_table(document: Any, given: Any) -> None:
    table = document.add_table(rows=1, cols=len(given.heads), style="Light Grid")
    for cell, (name, unit) in zip(table.rows[0].cells, given.heads, strict=True):
        _add_runs(cell.paragraphs[0], f"{name} [{unit}]" if unit else name, bold=True)
    for row in given.rows:
        for cell, each in zip(table.add_row().cells, row, strict=True):
            _add_runs(cell.paragraphs[0], each.text, bold=each.wrong)
    document.add_paragraph()
