"""A report on a publication: its numbers, checks and remarks, and the results they belong to."""

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from types import MappingProxyType
from typing import Any, Self


@dataclass(frozen=True)
class PublishedLine:
    """A value or a statement of a publication, and our value; texts are plain."""

    name: str
    place: str  # in the publication
    printed: str  # as printed, or the statement in words
    ours: float  # in `unit`; not finite where a quantity has no bound
    unit: str  # of both values; empty for a ratio
    criterion: str  # for `ours`
    digits: int  # decimals with which `ours` is shown
    note: str  # for the reader, such as why a check must hold

    @property
    def ours_as_text(self) -> str:
        """Our value, rounded to `digits`."""
        return decimal_text(self.ours, self.digits)

    @property
    def remarks(self) -> str:
        """Criterion and note, as in the last column of a table."""
        return "; ".join(part for part in (self.criterion, self.note) if part)


@dataclass(frozen=True)
class PublishedNumber(PublishedLine):
    """A number of a publication and ours."""

    verdict: str  # one of the document's verdicts
    difference: float | None  # ours minus the printed value; None for a statement, and for a bound that holds
    relative: float | None  # the difference over the printed value

    @property
    def difference_as_text(self) -> str:
        """The difference with its sign, and in per cent; empty if there is none."""
        if self.difference is None:
            return ""
        text = f"{self.difference:+.{self.digits}f}"
        if float(text) == 0.0:
            return "0"
        return (text if self.relative is None else f"{text} ({_percent_text(self.relative)})").replace("-", "−")


@dataclass(frozen=True)
class ConstructionCheck(PublishedLine):
    """A condition that must hold by construction, and is not counted."""

    holds: bool


def decimal_text(value: float, digits: int) -> str:
    """Write a value with a number of decimals, or with an exponent if they are too few."""
    if not math.isfinite(value):
        return "∞" if value > 0.0 else "−∞" if value < 0.0 else "none"
    if value != 0.0 and abs(value) < 0.5 * 10.0**-digits:
        return f"{value:.1e}".replace("-", "−")
    return f"{value:.{digits}f}".replace("-", "−")


def _percent_text(relative: float) -> str:
    """Write a ratio in per cent, with its sign."""
    found = 100.0 * relative
    return f"{found:+.0f} %" if abs(found) >= 10.0 else f"{found:+.2g} %"


@dataclass(frozen=True)
class Remark:
    """A computation in addition to the printed numbers."""

    kind: str  # one of the document's kinds of remarks
    title: str
    text: str  # what was computed, and what follows from it
    head: Sequence[str] = ()  # columns of its table; empty without a table
    rows: Sequence[Sequence[str]] = ()


@dataclass(frozen=True, eq=False)
class ReproducedResult:
    """A reproduced table or figure."""

    name: str  # also its anchor in the page
    title: str
    numbers: Sequence[PublishedNumber] = ()  # every printed number that belongs to it
    # Functions that draw the figures, by the stem of the file; nothing is drawn before they are called.
    figures: Mapping[str, Callable[[], Any]] = field(default_factory=dict[str, Callable[[], Any]])
    note: str = ""  # assumptions that the publication leaves open, which the reader must know before the figures
    checks: Sequence[ConstructionCheck] = ()  # that hold by construction and are not counted
    remarking: Sequence[Callable[[], Remark]] = ()  # functions that compute the remarks

    def __post_init__(self) -> None:
        for name in ("numbers", "checks", "remarking"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        object.__setattr__(self, "figures", MappingProxyType(dict(self.figures)))

    def finished(self, *, whole: bool = True) -> "FinishedResult":
        """Compute the remarks, and draw the figures; without either unless it is to be `whole`."""
        if not whole:
            return FinishedResult(self.name, self.title, self.numbers, note=self.note, checks=self.checks)
        from rockflex.plot._figures import figure_as_svg

        remarks = tuple(remark() for remark in self.remarking)
        drawings = {stem: figure_as_svg(draw()) for stem, draw in self.figures.items()}
        return FinishedResult(self.name, self.title, self.numbers, drawings, self.note, self.checks, remarks)


@dataclass(frozen=True)
class FinishedResult:
    """A reproduced table or figure with all that a report shows of it: plain data, which can be stored."""

    name: str
    title: str
    numbers: Sequence[PublishedNumber] = ()
    drawings: Mapping[str, str] = field(default_factory=dict[str, str])  # the text of the SVG file of each, by its stem
    note: str = ""
    checks: Sequence[ConstructionCheck] = ()
    remarks: Sequence[Remark] = ()

    def count(self, verdict: str) -> int:
        """Return how many numbers have a verdict."""
        return sum(number.verdict == verdict for number in self.numbers)

    def to_json(self) -> str:
        """Write everything as JSON, in which numbers may be Infinity or NaN."""
        return json.dumps(asdict(self), ensure_ascii=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Read what `to_json` wrote."""
        found = json.loads(text)
        parts = {"numbers": PublishedNumber, "checks": ConstructionCheck, "remarks": Remark}
        return cls(**found | {name: tuple(kind(**each) for each in found[name]) for name, kind in parts.items()})


@dataclass(frozen=True, eq=False)
class PublicationReport:
    """A report on a publication."""

    title: str
    source: str  # the publication in one line
    records: str  # which were used
    versions: Mapping[str, str]  # of everything that the numbers depend on
    verdicts: Mapping[str, str]  # meaning of every verdict, best first
    remarks: Mapping[str, str]  # meaning of every kind of remark
    sections: Sequence[FinishedResult]  # in the publication's order
    missing: Sequence[str] = ()  # names of tables and figures that are still to be computed

    @property
    def counts(self) -> dict[str, int]:
        """Lines with each verdict."""
        return {verdict: sum(section.count(verdict) for section in self.sections) for verdict in self.verdicts}

    @property
    def checks(self) -> str:
        """How many checks there are, and how many hold, in a sentence."""
        found = [check.holds for section in self.sections for check in section.checks]
        return (
            f"{sum(found)} of {len(found)} checks of ourselves hold. They follow from how the library, or an "
            "equivalent specimen, is built, and so are not among the numbers; nor are remarks. A value that the "
            "publication repeats is counted once."
        )

    @property
    def gaps(self) -> str:
        """The parts that the report lacks, in a sentence; empty for a complete one."""
        return f"Unfinished: {', '.join(self.missing)} still to be computed." if self.missing else ""
