"""A report as one page of HTML: self-contained, with inline figures, light and dark."""

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from rockflex.report._document import Document
from rockflex.report._svg import inline

if TYPE_CHECKING:
    from jinja2 import Template

TEMPLATES = Path(__file__).parent / "templates"
CLASSES = ("best", "good", "fair", "open", "bad")  # of the verdicts, best first; the last one is bad


def to_html(document: Document, drawings: Mapping[str, str]) -> str:
    """Write the document as a page.

    Parameters
    ----------
    document
        The report.
    drawings
        Text of the SVG file of each figure, by its stem.

    Examples
    --------
    >>> from rockflex.report import Document, to_html
    >>> document = Document("A title", "A paper, 2024", "none", {"rockflex": "1"}, {"met": "within 1 %"}, {}, [])
    >>> "<h1>A title</h1>" in to_html(document, drawings={})
    True
    """
    from markupsafe import Markup, escape

    labels = {stem: str(escape(s.title)) for s in document.sections for stem in s.figures}
    figures = {stem: Markup(inline(drawings[stem], stem, label)) for stem, label in labels.items()}
    verdicts = list(document.verdicts)
    last = len(verdicts) - 1
    looks = {name: CLASSES[-1 if place == last else min(place, 3)] for place, name in enumerate(verdicts)}
    failing = [line for s in document.sections for line in s.numbers if line.verdict == verdicts[-1]]
    return _template().render(
        document=document, figures=figures, looks=looks, counts=document.counts, failing=failing, worst=verdicts[-1]
    )


@lru_cache(maxsize=1)
def _template() -> "Template":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    # Everything is escaped but the figures, which are ours.
    loaded = Environment(
        loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    return loaded.get_template("report.html.jinja")
