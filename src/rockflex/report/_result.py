"""A table or figure of a publication, reproduced."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any

from rockflex.report._line import Check, Number


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
class Result:
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
    numbers: Sequence[Number] = ()
    figures: Mapping[str, Callable[[], Any]] = field(default_factory=dict[str, Callable[[], Any]])
    note: str = ""
    checks: Sequence[Check] = ()
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
