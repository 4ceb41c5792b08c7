"""The page: everything that a report shows, put together and written as HTML."""

import math
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from rockflex._shown import shortened
from rockflex._versions import versions_of
from rockflex.report._svg import inline
from rockflex.report.run._base import assumption_lines, element_table
from rockflex.report.run._checks import check_table, ground_friction, legend, long_runs
from rockflex.report.run._given import Given
from rockflex.report.run._inputs import fingerprint
from rockflex.report.run._peaks import FELL, peak_table
from rockflex.report.run._record import Record, record_of
from rockflex.report.run._structure import kind_of, mode_table, structure_facts
from rockflex.report.run._table import Fact, Table

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATES = Path(__file__).parent / "templates"
LONGEST = {"title": 110, "name": 70, "source": 110}  # letters
WARNINGS = 4  # texts
_WIDTH, _HEIGHT = 186.0, 272.0  # of a sheet of A4 within its margins, in mm
_LINE, _LETTERS = 3.5, 150.0  # height of a line of small text in mm, and its letters
_FIGURE = (58.0, 160.0)  # least and largest height of the figure in mm
_STRIP = (65.0, 22.0)  # mm
_DOWN, _UP = re.compile(r"([^\W\d_]\*?)_([\w*–]+)"), re.compile(r"\^(−?\d+)")


@dataclass(frozen=True, eq=False)
class Page:
    """What a page shows; see the template."""

    title: str
    date: str
    kind: str
    facts: Sequence[Fact]
    modes: Table | None
    record: Record
    lines: Sequence[tuple[str, str]]
    elements: Table | None
    peaks: Table
    checks: Table
    legend: Sequence[str]
    warnings: Sequence[str]
    notes: Sequence[str]
    versions: str
    inputs: str

    @property
    def room(self) -> float:
        """Height in mm that is left for the figure, by an estimate that errs on the small side."""
        rows = len(self.peaks.rows) + len(self.checks.rows) + 6
        rows += 0 if self.elements is None else len(self.elements.rows)
        texts = [*self.warnings, *self.notes, " ".join(self.legend), *(text for _, text in self.lines), self.versions]
        lines = sum(math.ceil(len(text) / _LETTERS) for text in texts)
        modes = 0 if self.modes is None else len(self.modes.rows) + 2
        above = 4.1 * (math.ceil(len(self.facts) / 2) + modes) + 5.0
        beside = 31.0 + 4.1 * len(self.record.facts)
        least, largest = _FIGURE
        return min(max(_HEIGHT - max(above, beside) - 4.0 * rows - _LINE * lines - 13.0, least), largest)


def page_of(
    about: Given,
    *,
    title: str | None,
    date: str,
    friction: float | None,
    warnings: Sequence[str],
    notes: Sequence[str],
    omitted: Collection[str] = (),
) -> Page:
    """Put together what a page shows; for the labels in `omitted` nothing is computed that takes long."""
    left_out = long_runs(about).union(omitted)
    known = about.properties if about.structure is None else about.structure
    record, kind = record_of(about), kind_of(known)
    if not title:
        title = f"{kind} under {record.name or 'a ground motion'}"
    fell = any(run.status == "overturned" for run in about.responses)
    own = [f"{FELL} The values of a run that overturned include its fall."] * fell
    sliding = [ground_friction(each.model) is not None for each in about.histories]
    told = legend(
        friction, sided=about.properties.eccentricity != 0.0, slides=any(sliding), stays=not all(sliding),
        omitted=bool(left_out),
    )  # fmt: skip
    return Page(
        title=shortened(title, LONGEST["title"]),
        date=date,
        kind=kind,
        facts=structure_facts(about.properties),
        modes=mode_table(about.properties),
        record=record,
        lines=assumption_lines(about),
        elements=element_table(about),
        peaks=peak_table(about),
        checks=check_table(about, friction, left_out),
        legend=[*own, *told],
        warnings=_few([*warnings, *_warnings(about)]),
        notes=notes,
        versions=", ".join(f"{name} {version}" for name, version in _versions().items()),
        inputs=fingerprint(about, record),
    )


def html_of(page: Page, about: Given) -> str:
    """Return a page as HTML with its figures."""
    from markupsafe import Markup

    from rockflex.plot import record_strip, run_sheet, svg_of

    sheet = run_sheet(about.responses, about.labels, width=_WIDTH, height=page.room)
    strip = record_strip(page.record.time, page.record.acceleration, width=_STRIP[0], height=_STRIP[1])
    drawings = {
        "sheet": Markup(inline(svg_of(sheet), "sheet", "Histories and loops of all models")),
        "strip": Markup(inline(svg_of(strip), "strip", "Ground acceleration")),
    }
    template = _environment().get_template("run.html.jinja")
    return template.render(page=page, longest=LONGEST, **drawings)


def _warnings(about: Given) -> list[str]:
    """Return the warnings of the runs, each with its model."""
    return [
        f"{label}: {text}"
        for label, run in zip(about.labels, about.responses, strict=True)
        for text in run.warnings
    ]  # fmt: skip


def _few(texts: Sequence[str]) -> list[str]:
    rest = len(texts) - WARNINGS
    return [*texts[:WARNINGS], *([f"and {rest} more warnings; see the responses"] if rest > 0 else [])]


def _versions() -> dict[str, str]:
    found = versions_of(("rockflex", "numpy", "numba"))
    python = found.pop("python")
    return found | {"Python": python}


@lru_cache(maxsize=1)
def _environment() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, keep_trailing_newline=True,
    )  # fmt: skip
    made.filters["symbols"] = _symbols
    made.filters["shortened"] = shortened
    return made


def _symbols(text: str) -> str:
    """Set what follows "_" as an index and what follows "^" as an exponent."""
    from markupsafe import Markup, escape

    lowered = _DOWN.sub(r"\1<sub>\2</sub>", str(escape(text)))
    return Markup(_UP.sub(r"<sup>\1</sup>", lowered))
