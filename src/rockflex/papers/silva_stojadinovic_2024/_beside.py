"""Checks and remarks: not numbers of the paper, so they have no verdict and are not counted."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from rockflex.papers.silva_stojadinovic_2024._printed import range_of
from rockflex.papers.silva_stojadinovic_2024._shown import digits_of, shown


@dataclass(frozen=True)
class Check:
    """Something that must hold by construction, for the library or an equivalent specimen.

    Attributes
    ----------
    name, place : str
        What is checked, and where the paper has the value it is compared with.
    stated : str
        The value in the paper.
    ours : float
        In `unit`.
    unit : str
        Empty for a ratio.
    criterion : str
        The criterion that `ours` must meet.
    holds : bool
        Whether `ours` meets it.
    digits : int
        Decimals with which `ours` is shown.
    note : str
        Why it must hold.
    """

    name: str
    place: str
    stated: str
    ours: float
    unit: str
    criterion: str
    holds: bool
    digits: int
    note: str

    @property
    def ours_as_text(self) -> str:
        """Our value with sensible digits."""
        return shown(self.ours, self.digits)


def check(
    name: str, place: str, stated: str, ours: float, criterion: str = "", unit: str = "", *, note: str = ""
) -> Check:
    """Check a value against a bound, such as ``"< 1"``, or by default against the printed number `stated`."""
    wanted, value = range_of(criterion or stated), float(ours)
    digits = digits_of(wanted, value)
    return Check(name, place, stated, value, unit, criterion or "must round to it", value in wanted, digits, note)


class Kind(StrEnum):
    """The kind of a remark."""

    AFTERWARDS = "chosen after the fact"
    BESIDE = "beside the paper"

    @property
    def meaning(self) -> str:
        """Explanation in one sentence."""
        return _MEANINGS[self]


_MEANINGS = {
    Kind.AFTERWARDS: (
        "An interpretation or a value that was chosen to match the printed one. It shows what would have to be the "
        "case, but is not evidence that the authors did this."
    ),
    Kind.BESIDE: "Computed in addition to the printed numbers, to show what one of them depends on.",
}


@dataclass(frozen=True)
class Remark:
    """A computation in addition to the printed numbers.

    Attributes
    ----------
    kind : Kind
        The kind of the remark.
    title : str
        Heading.
    text : str
        What was computed, and what follows from it.
    head : sequence of str
        Columns of its table; empty without a table.
    rows : sequence of sequences of str
        The table's cells.
    """

    kind: Kind
    title: str
    text: str
    head: Sequence[str] = ()
    rows: Sequence[Sequence[str]] = ()
