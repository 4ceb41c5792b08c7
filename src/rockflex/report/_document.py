"""What a report holds."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

__all__ = ["Document", "Line", "Section"]


class Line(Protocol):
    """One number of a publication beside ours; texts are plain."""

    @property
    def name(self) -> str:
        """What it is."""
        ...

    @property
    def place(self) -> str:
        """Where the publication has it."""
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
        """Our value with sensible digits."""
        ...

    @property
    def unit(self) -> str:
        """Of both values; empty for a ratio."""
        ...

    @property
    def criterion(self) -> str:
        """What our value had to meet."""
        ...

    @property
    def verdict(self) -> str:
        """One of the document's verdicts."""
        ...

    @property
    def difference_as_text(self) -> str:
        """Ours less printed; empty where there is none."""
        ...

    @property
    def note(self) -> str:
        """What to know of it."""
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
        """What to know before the figures."""
        ...

    @property
    def numbers(self) -> Sequence[Line]:
        """Lines of its table."""
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
        Of everything that the numbers depend on.
    verdicts : mapping of str to str
        Meaning of every verdict, best first.
    sections : sequence of Section
        In the publication's order.
    """

    title: str
    source: str
    records: str
    versions: Mapping[str, str]
    verdicts: Mapping[str, str]
    sections: Sequence[Section]

    @property
    def counts(self) -> dict[str, int]:
        """Lines with each verdict."""
        lines = [str(line.verdict) for section in self.sections for line in section.numbers]
        return {verdict: lines.count(verdict) for verdict in self.verdicts}
