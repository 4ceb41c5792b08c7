"""What is no number of the paper: checks of ourselves, and remarks. Neither has a verdict, and neither is counted."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from rockflex.papers.silva_stojadinovic_2024._printed import range_of
from rockflex.papers.silva_stojadinovic_2024._shown import digits_of, shown


@dataclass(frozen=True)
class Check:
    """Something that must hold by construction, of the library or of an equivalent specimen.

    Attributes
    ----------
    name, place : str
        What it is, and where the paper has what it is held to.
    stated : str
        What the paper has there.
    ours : float
        In `unit`.
    unit : str
        Empty for a ratio.
    criterion : str
        What `ours` must meet.
    holds : bool
        Whether it does.
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
    """Hold a value to a bound, such as ``"< 1"``, or without one to the printed number `stated`."""
    wanted, value = range_of(criterion or stated), float(ours)
    digits = digits_of(wanted, value)
    return Check(name, place, stated, value, unit, criterion or "must round to it", value in wanted, digits, note)


class Kind(StrEnum):
    """What sort of remark it is."""

    AFTERWARDS = "chosen after the fact"
    BESIDE = "beside the paper"

    @property
    def meaning(self) -> str:
        """How to take it, in one sentence."""
        return _MEANINGS[self]


_MEANINGS = {
    Kind.AFTERWARDS: (
        "A reading, or a value, that was chosen with the printed one in view. It shows what would have to be so, and "
        "is no evidence that the authors did so."
    ),
    Kind.BESIDE: "Computed beside what the paper prints, to tell what a number of it rests on.",
}


@dataclass(frozen=True)
class Remark:
    """Something computed beside the printed numbers.

    Attributes
    ----------
    kind : Kind
        How to take it.
    title : str
        Heading.
    text : str
        What was computed, and what it says.
    head : sequence of str
        Columns of its table; none without one.
    rows : sequence of sequences of str
        The table's cells.
    """

    kind: Kind
    title: str
    text: str
    head: Sequence[str] = ()
    rows: Sequence[Sequence[str]] = ()
