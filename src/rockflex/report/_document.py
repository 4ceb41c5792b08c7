"""A report on a publication: its numbers, checks and remarks, and the results they belong to."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any


@dataclass(frozen=True)
class PublishedLine:
    """A value or a statement of a publication, and our value; texts are plain.

    Attributes
    ----------
    name, place : str
        Name of the value, and its place in the publication.
    printed : str
        As printed, or the statement in words.
    ours : float
        In `unit`; not finite where a quantity has no bound.
    unit : str
        Of both values; empty for a ratio.
    criterion : str
        The criterion for `ours`.
    digits : int
        Decimals with which `ours` is shown.
    note : str
        A note for the reader, such as why a check must hold.
    """

    name: str
    place: str
    printed: str
    ours: float
    unit: str
    criterion: str
    digits: int
    note: str

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
    """A number of a publication and ours.

    Attributes
    ----------
    verdict : str
        One of the document's verdicts.
    difference : float or None
        Ours minus the printed value in `unit`; None for a statement, and for a bound that holds.
    relative : float or None
        The difference over the printed value.
    """

    verdict: str
    difference: float | None
    relative: float | None

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
    """A computation in addition to the printed numbers.

    Attributes
    ----------
    kind : str
        One of the document's kinds of remarks.
    title : str
        Heading.
    text : str
        What was computed, and what follows from it.
    head : sequence of str
        Columns of its table; empty without a table.
    rows : sequence of sequences of str
        The table's cells.
    """

    kind: str
    title: str
    text: str
    head: Sequence[str] = ()
    rows: Sequence[Sequence[str]] = ()


@dataclass(frozen=True, eq=False)
class ReproducedResult:
    """A reproduced table or figure.

    Attributes
    ----------
    name, title : str
        Name, which is also its anchor in the page, and heading.
    numbers : tuple of Number
        Every printed number that belongs to it.
    figures : mapping of str to callable
        Functions that draw the figures, by the stem of the file; nothing is drawn before they are called.
    note : str
        Assumptions that the publication leaves open, which the reader must know before the figures.
    checks : tuple of Check
        Checks that hold by construction and are not counted.
    remarking : tuple of callable
        Functions without arguments that compute the remarks.
    """

    name: str
    title: str
    numbers: Sequence[PublishedNumber] = ()
    figures: Mapping[str, Callable[[], Any]] = field(default_factory=dict[str, Callable[[], Any]])
    note: str = ""
    checks: Sequence[ConstructionCheck] = ()
    remarking: Sequence[Callable[[], Remark]] = ()

    def __post_init__(self) -> None:
        for name in ("numbers", "checks", "remarking"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        object.__setattr__(self, "figures", MappingProxyType(dict(self.figures)))

    @cached_property
    def remarks(self) -> tuple[Remark, ...]:
        """Additional computations, made when first requested, because some take half a minute."""
        return tuple(remark() for remark in self.remarking)

    def count(self, verdict: str) -> int:
        """Return how many numbers have a verdict."""
        return sum(number.verdict == verdict for number in self.numbers)


@dataclass(frozen=True, eq=False)
class PublicationReport:
    """A report on a publication.

    Attributes
    ----------
    title, source : str
        Heading, and the publication in one line.
    records : str
        Which records were used.
    versions : mapping of str to str
        Versions of everything that the numbers depend on.
    verdicts : mapping of str to str
        Meaning of every verdict, best first.
    remarks : mapping of str to str
        Meaning of every kind of remark.
    sections : sequence of Result
        In the publication's order.

    Examples
    --------
    >>> from rockflex.report import PublicationReport
    >>> document = PublicationReport("A title", "A paper", "none", {"rockflex": "1"}, {"met": "within 1 %"}, {}, [])
    >>> document.counts
    {'met': 0}
    """

    title: str
    source: str
    records: str
    versions: Mapping[str, str]
    verdicts: Mapping[str, str]
    remarks: Mapping[str, str]
    sections: Sequence[ReproducedResult]

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
