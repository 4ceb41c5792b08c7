"""What an intensity measure is."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from rockflex.motion._shaking import Shaking


@dataclass(frozen=True, kw_only=True)
class Measure:
    """An intensity measure: its names, its unit, and how it is computed.

    Attributes
    ----------
    name : str
        What files, the command line and columns of tables call it.
    label : str
        What a reader is shown, such as ``"PGV"``.
    unit : str
        SI unit; empty if it has none.
    words : str
        What it is, such as ``"peak ground velocity"``; empty if the label says it.
    of : callable
        Computes it from a `Shaking`.
    of_what : {"motion", "mode", "base"}
        What it depends on: the motion alone, also the first mode, or also the base.
    power : {0, 1, 2}
        Power of the factor on the acceleration with which it grows. A motion cannot be scaled to a measure of power 0.
    short : str
        For the heads of narrow columns, if it is shorter than the label.
    symbol : str
        In figures, as Matplotlib's mathtext, if it is another than the label.
    """

    name: str
    label: str
    unit: str
    words: str = ""
    of: Callable[[Shaking], float]
    of_what: Literal["motion", "mode", "base"] = "motion"
    power: Literal[0, 1, 2] = 1
    short: str = ""
    symbol: str = ""

    @property
    def title(self) -> str:
        """Label and words, for a list to choose from."""
        return f"{self.label}, {self.words}" if self.words not in ("", self.label) else self.label

    @property
    def head(self) -> str:
        """Name over a narrow column."""
        return self.short or self.label

    @property
    def sign(self) -> str:
        """Symbol in a figure."""
        return self.symbol or self.label

    @property
    def axis(self) -> str:
        """Name and unit on the axis of a figure; words that are the label are not abbreviated by the symbol."""
        return self.with_unit(self.label if self.words == self.label else self.sign)

    def with_unit(self, name: str) -> str:
        """Return a name with the unit in brackets, if there is one."""
        return f"{name} [{self.unit}]" if self.unit else name

    def scaled(self, value: float, factor: float) -> float:
        """Return what a value becomes when the acceleration is multiplied by a factor of either sign."""
        for _ in range(self.power):
            value *= abs(factor)
        return value

    def factor(self, value: float, level: float) -> float:
        """Return the factor on the acceleration that takes a value to a level; infinite or NaN where none does."""
        if not value > 0.0 or not self.power:
            return math.inf
        return math.sqrt(level / value) if self.power == 2 else level / value
