"""The contents of a report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rockflex.report._result import Result


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
    sections : sequence of Result
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
    sections: Sequence[Result]

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
