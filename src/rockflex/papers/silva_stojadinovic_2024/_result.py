"""The result of a target."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any

from rockflex.papers.silva_stojadinovic_2024._beside import Check, Remark
from rockflex.papers.silva_stojadinovic_2024._number import Number
from rockflex.papers.silva_stojadinovic_2024._verdict import Verdict


@dataclass(frozen=True, eq=False)
class Result:
    """A reproduced table or figure.

    Attributes
    ----------
    name, title : str
        Name and title of the target.
    numbers : tuple of Number
        Every printed number that belongs to it.
    figures : mapping of str to callable
        Functions that draw the figures, by the stem of the file; nothing is drawn before they are called.
    note : str
        Assumptions that the paper leaves open, which the reader must know before the figures.
    checks : tuple of Check
        Checks that hold by construction and are not counted.
    remarking : tuple of callable
        Functions without arguments that compute the remarks.
    """

    name: str
    title: str
    numbers: tuple[Number, ...] = ()
    figures: Mapping[str, Callable[[], Any]] = field(default_factory=dict[str, Callable[[], Any]])
    note: str = ""
    checks: tuple[Check, ...] = ()
    remarking: tuple[Callable[[], Remark], ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "numbers", tuple(self.numbers))
        object.__setattr__(self, "figures", MappingProxyType(dict(self.figures)))

    @property
    def remarks(self) -> tuple[Remark, ...]:
        """Additional computations, made when first requested, because some take half a minute."""
        return self._remarks

    @cached_property
    def _remarks(self) -> tuple[Remark, ...]:
        return tuple(remark() for remark in self.remarking)

    def count(self, verdict: Verdict) -> int:
        """Return how many numbers have a verdict."""
        return sum(number.verdict is verdict for number in self.numbers)
