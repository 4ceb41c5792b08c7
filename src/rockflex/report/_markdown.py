"""A report as Markdown, with its figures beside it."""

import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockflex.report._document import Document, Section

__all__ = ["to_markdown"]

HEAD = ("place", "number", "paper", "rockflex", "unit", "difference", "verdict", "criterion and remarks")


def to_markdown(document: "Document") -> str:
    """Write the document as GitHub-flavoured Markdown; figures are links to ``<stem>.svg``."""
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
        *(part for section in document.sections for part in _section(section)),
    ]
    return "\n\n".join(parts) + "\n"


def _section(section: "Section") -> Iterable[str]:
    yield f"## {_plain(section.name)}: {_plain(section.title)}"
    if section.note:
        yield _plain(section.note)
    for stem in section.figures:
        yield f"![{_plain(section.title)}]({stem}.svg)"
    rows = [
        (
            line.place, line.name, line.printed, line.ours_as_text, line.unit, line.difference_as_text,
            f"**{line.verdict}**", "; ".join(part for part in (line.criterion, line.note) if part),
        )
        for line in section.numbers
    ]  # fmt: skip
    if rows:
        yield _table(HEAD, rows)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head)]
    lines += [[cell if cell.startswith("**") else _plain(cell) for cell in row] for row in rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _plain(text: str) -> str:
    """Keep what is no markup from being read as such."""
    return re.sub(r"([\\`*_\[\]<>|#])", r"\\\1", text)
