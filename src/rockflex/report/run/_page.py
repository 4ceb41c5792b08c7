"""The page: everything that a report shows, put together and written as HTML."""

import math
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from rockflex._shown import counted, shortened
from rockflex._versions import versions_of
from rockflex.report._svg import inline
from rockflex.report.run._base import assumption_lines, element_table, follows_law
from rockflex.report.run._checks import check_table, ground_friction, is_bedded, legend, long_runs
from rockflex.report.run._given import Given
from rockflex.report.run._inputs import fingerprint
from rockflex.report.run._peaks import FELL, peak_table
from rockflex.report.run._record import Record, record_of
from rockflex.report.run._room import (
    FIGURE,
    HEIGHT,
    LINE,
    SMALL,
    SMALLEST,
    WIDTH,
    height_above,
    height_beside,
    height_of_table,
    lines_of,
    part,
)
from rockflex.report.run._structure import kind_of, mode_table, structure_facts
from rockflex.report.run._table import Fact, Table
from rockflex.response import warnings_of

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATES = Path(__file__).parent / "templates"
LONGEST = {"title": 110, "name": 70, "source": 110, "warning": 400}  # letters
WARNINGS = 4  # texts
_NOTES = 6  # of more, each does not have a line of its own
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
    def needed(self) -> float:
        """Height in mm of all but the figure, the warnings and the notes."""
        record = self.record
        above = height_above(self.facts, self.modes, shortened(self.kind, LONGEST["name"]))
        source = shortened(record.source, LONGEST["source"])
        beside = height_beside(record.facts, shortened(record.name, LONGEST["name"]), source)
        base = sum(LINE * lines_of(f"{head}. {text}") for head, text in self.lines)
        return (
            5.2 * lines_of(self.title, WIDTH - 40.0, 1.75) + 3.0
            + max(above, beside) + 1.5
            + (part(base, height_of_table(self.elements)) if self.lines or self.elements else 0.0)
            + part(height_of_table(self.peaks, units=True))
            + part(height_of_table(self.checks), LINE * lines_of(" ".join(self.legend), size=SMALL))
            + LINE * lines_of(self.versions, WIDTH - 40.0, SMALL) + 4.0
        )  # fmt: skip

    @property
    def scale(self) -> float:
        """Size of everything on the sheet: 1, or less where that makes room for the warnings and notes."""
        told = LINE * sum(self.lines_of_texts(10**6)) + 3.0
        return min(1.0, max(SMALLEST, HEIGHT / (self.needed + FIGURE[0] + told)))

    @property
    def held(self) -> list[int]:
        """Lines of each warning and then of each note, which are cut off after these."""
        return self.lines_of_texts(max(0, math.floor((HEIGHT / self.scale - self.needed - FIGURE[0] - 3.0) / LINE)))

    @property
    def room(self) -> float:
        """Height in mm that is left for the figure, before it is scaled."""
        left = HEIGHT / self.scale - self.needed - LINE * sum(self.held) - 3.0
        return min(max(left, FIGURE[0]), FIGURE[1])

    def lines_of_texts(self, most: int) -> list[int]:
        """Return the lines that each warning and each note has, one at least, if there is room for `most` lines."""
        lines: list[int] = []
        texts = [*(f"Warning. {each}" for each in self.warnings), *self.notes]
        for place, text in enumerate(texts):
            after = len(texts) - place - 1
            lines.append(max(1, min(lines_of(text, WIDTH - 2.0), most - after)))
            most -= lines[-1]
        return lines


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
        omitted=bool(left_out), held=bool(about.properties.elements), bedded=any(map(is_bedded, about.histories)),
        impacts=any(follows_law(each.model) for each in about.histories),
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
        warnings=_few([*warnings, *_warnings(about, left_out)]),
        notes=_run_together(notes),
        versions=", ".join(f"{name} {version}" for name, version in _versions().items()),
        inputs=fingerprint(about, record),
    )


def html_of(page: Page, about: Given) -> str:
    """Return a page as HTML with its figures."""
    from markupsafe import Markup

    from rockflex.plot import record_strip, run_sheet, svg_of

    sheet = run_sheet(about.responses, about.labels, width=WIDTH / page.scale, height=page.room)
    strip = record_strip(page.record.time, page.record.acceleration, width=_STRIP[0], height=_STRIP[1])
    drawings = {
        "sheet": Markup(inline(svg_of(sheet), "sheet", "Histories and loops of all models")),
        "strip": Markup(inline(svg_of(strip), "strip", "Ground acceleration")),
    }
    template = _environment().get_template("run.html.jinja")
    return template.render(page=page, longest=LONGEST, **drawings)


def _warnings(about: Given, omitted: Collection[str]) -> list[str]:
    """Return the warnings of the runs, each with its models; for the labels in `omitted` those of the peaks only."""
    found: dict[str, list[str]] = {}
    for label, run in zip(about.labels, about.responses, strict=True):
        for text in warnings_of(run.model, run.peaks()) if label in omitted else run.warnings:
            found.setdefault(text, []).append(label)
    return [f"{', '.join(labels)}: {text}" for text, labels in found.items()]


def _run_together(notes: Sequence[str]) -> list[str]:
    """Return the notes without breaks of lines; many of them as one paragraph."""
    texts = [text for text in (" ".join(note.split()) for note in notes) if text]
    return texts if len(texts) <= _NOTES else [" • ".join(texts)]


def _few(texts: Sequence[str]) -> list[str]:
    rest = len(texts) - WARNINGS
    return [
        *(shortened(text, LONGEST["warning"]) for text in texts[:WARNINGS]),
        *([f"and {counted(rest, 'more warning')}; see the responses"] if rest > 0 else []),
    ]


def _versions() -> dict[str, str]:
    found = versions_of(("rockflex", "numpy"))
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
