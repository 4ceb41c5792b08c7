"""A report as Markdown, with its figures in separate files."""

import re
from collections.abc import Iterable, Sequence

from rockflex.report._document import Document
from rockflex.report._line import Check
from rockflex.report._result import Result

CHECKS = ("place", "check", "paper", "rockflex", "unit", "holds", "criterion and remarks")
HEAD = ("place", "number", "paper", "rockflex", "unit", "difference", "verdict", "criterion and remarks")


def to_markdown(document: Document) -> str:
    """Write the document as GitHub-flavoured Markdown; figures are links to ``<stem>.svg``.

    Examples
    --------
    >>> from rockflex.report import Document, to_markdown
    >>> document = Document("A title", "A paper, 2024", "none", {"rockflex": "1"}, {"met": "within 1 %"}, {}, [])
    >>> to_markdown(document).splitlines()[0]
    '# A title'
    """
    counts = document.counts
    parts = [
        f"# {_plain(document.title)}",
        _plain(document.source),
        f"Records. {_plain(document.records)}",
        "Versions. " + ", ".join(f"{name} {_plain(version)}" for name, version in document.versions.items()) + ".",
        _table(
            ("verdict", "numbers", "meaning"),
            [(name, str(counts[name]), meaning) for name, meaning in document.verdicts.items()],
        ),
        _plain(document.checks),
        "\n".join(f"- *Remark, {_plain(kind)}.* {_plain(meaning)}" for kind, meaning in document.remarks.items()),
        *(part for section in document.sections for part in _section(section)),
    ]
    return "\n\n".join(parts) + "\n"


def _section(section: Result) -> Iterable[str]:
    yield f"## {_plain(section.name)}: {_plain(section.title)}"
    if section.note:
        yield _plain(section.note)
    for stem in section.figures:
        yield f"![{_plain(section.title)}]({stem}.svg)"
    rows = [
        (
            line.place, line.name, line.printed, line.ours_as_text, line.unit, line.difference_as_text,
            f"**{line.verdict}**", line.remarks,
        )
        for line in section.numbers
    ]  # fmt: skip
    if rows:
        yield _table(HEAD, rows)
    if section.checks:
        yield "Checks of ourselves, not counted:"
        yield _table(CHECKS, [_check(check) for check in section.checks])
    for remark in section.remarks:
        yield f"**Remark, {_plain(remark.kind)}: {_plain(remark.title)}.** {_plain(remark.text)}"
        if remark.head:
            yield _table(remark.head, remark.rows)


def _check(check: Check) -> tuple[str, ...]:
    holds = "yes" if check.holds else "**no**"
    return check.place, check.name, check.printed, check.ours_as_text, check.unit, holds, check.remarks


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [[_plain(cell) for cell in head], ["---"] * len(head)]
    lines += [[cell if cell.startswith("**") else _plain(cell) for cell in row] for row in rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _plain(text: str) -> str:
    """Escape characters that Markdown would read as markup."""
    return re.sub(r"([\\`*_\[\]<>|#])", r"\\\1", text)
