"""The contents of a report."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol


class Line(Protocol):
    """One number of a publication and our value; texts are plain."""

    @property
    def name(self) -> str:
        """What it is."""
        ...

    @property
    def place(self) -> str:
        """Where it is in the publication."""
        ...

    @property
    def printed(self) -> str:
        """As printed."""
        ...

    @property
    def ours(self) -> float:
        """Our value."""
        ...

    @property
    def ours_as_text(self) -> str:
        """Our value, rounded."""
        ...

    @property
    def unit(self) -> str:
        """Unit of both values; empty for a ratio."""
        ...

    @property
    def criterion(self) -> str:
        """Criterion for our value."""
        ...

    @property
    def verdict(self) -> str:
        """One of the document's verdicts."""
        ...

    @property
    def difference_as_text(self) -> str:
        """Our value minus the printed one; empty if there is none."""
        ...

    @property
    def note(self) -> str:
        """A remark."""
        ...


class Proof(Protocol):
    """Something that must hold by construction; texts are plain."""

    @property
    def name(self) -> str:
        """What it is."""
        ...

    @property
    def place(self) -> str:
        """Where the reference value is in the publication."""
        ...

    @property
    def stated(self) -> str:
        """The value in the publication."""
        ...

    @property
    def ours_as_text(self) -> str:
        """Our value, rounded."""
        ...

    @property
    def unit(self) -> str:
        """Unit of the value; empty for a ratio."""
        ...

    @property
    def criterion(self) -> str:
        """Criterion for our value."""
        ...

    @property
    def holds(self) -> bool:
        """Whether our value meets it."""
        ...

    @property
    def note(self) -> str:
        """The reason why it must hold."""
        ...


class Side(Protocol):
    """A remark: something computed in addition to the numbers."""

    @property
    def kind(self) -> str:
        """One of the document's kinds of remarks."""
        ...

    @property
    def title(self) -> str:
        """Heading."""
        ...

    @property
    def text(self) -> str:
        """What was computed, and what follows."""
        ...

    @property
    def head(self) -> Sequence[str]:
        """Columns of its table; none without one."""
        ...

    @property
    def rows(self) -> Sequence[Sequence[str]]:
        """Cells of its table."""
        ...


class Section(Protocol):
    """A table or figure with its numbers."""

    @property
    def name(self) -> str:
        """Anchor in the page."""
        ...

    @property
    def title(self) -> str:
        """Heading."""
        ...

    @property
    def note(self) -> str:
        """A note before the figures."""
        ...

    @property
    def numbers(self) -> Sequence[Line]:
        """Lines of its table."""
        ...

    @property
    def checks(self) -> Sequence[Proof]:
        """Checks that hold by construction; they are not counted."""
        ...

    @property
    def remarks(self) -> Sequence[Side]:
        """Additional results; they are not counted."""
        ...

    @property
    def figures(self) -> Mapping[str, Callable[[], Any]]:
        """A function that draws the figure, by the stem of its file."""
        ...


@dataclass(frozen=True, eq=False)
class Document:
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
    sections : sequence of Section
        In the publication's order.

    Examples
    --------
    >>> from rockflex.report import Document
    >>> document = Document("A title", "A paper, 2024", "none", {"rockflex": "1"}, {"met": "within 1 %"}, {}, [])
    >>> document.counts
    {'met': 0}
    """

    title: str
    source: str
    records: str
    versions: Mapping[str, str]
    verdicts: Mapping[str, str]
    remarks: Mapping[str, str]
    sections: Sequence[Section]

    @property
    def counts(self) -> dict[str, int]:
        """Lines with each verdict."""
        lines = [str(line.verdict) for section in self.sections for line in section.numbers]
        return {verdict: lines.count(verdict) for verdict in self.verdicts}

    @property
    def checks(self) -> str:
        """How many checks there are, and how many hold, in a sentence."""
        found = [check.holds for section in self.sections for check in section.checks]
        return (
            f"{sum(found)} of {len(found)} checks of ourselves hold. They follow from how the library, or an "
            "equivalent specimen, is built, and so are not among the numbers; nor are remarks. A value that the "
            "publication repeats is counted once."
        )
