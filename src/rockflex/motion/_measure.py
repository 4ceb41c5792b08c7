"""The definition of an intensity measure."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from rockflex.motion._shaking import Shaking


@dataclass(frozen=True, kw_only=True)
class Measure:
    """An intensity measure: its names, its unit, and the function that computes it.

    Attributes
    ----------
    name : str
        Name in files, on the command line and in table columns.
    label : str
        Name shown to readers, such as ``"PGV"``.
    unit : str
        SI unit; empty if it has none.
    words : str
        Description, such as ``"peak ground velocity"``; empty if the label is clear enough.
    of : callable
        Computes it from a `Shaking`.
    of_what : {"motion", "vertical", "mode", "base"}
        What it depends on: only the horizontal motion, also the vertical one, also the first mode, or also the base.
        Measures of the vertical motion are NaN without one.
    power : {0, 1, 2}
        The measure is proportional to this power of the acceleration. Motions cannot be scaled to a measure of power 0.
    short : str
        Name for the headers of narrow columns, if shorter than the label.
    symbol : str
        Name in figures, as Matplotlib mathtext, if different from the label.
    """

    name: str
    label: str
    unit: str
    words: str = ""
    of: Callable[[Shaking], float]
    of_what: Literal["motion", "vertical", "mode", "base"] = "motion"
    power: Literal[0, 1, 2] = 1
    short: str = ""
    symbol: str = ""

    @property
    def title(self) -> str:
        """Label and description, for a selection list."""
        return f"{self.label}, {self.words}" if self.words not in ("", self.label) else self.label

    @property
    def head(self) -> str:
        """Header of a narrow column."""
        return self.short or self.label

    @property
    def sign(self) -> str:
        """Symbol in a figure."""
        return self.symbol or self.label

    @property
    def axis(self) -> str:
        """Name and unit for the axis of a figure; if the label is the description, the label rather than the symbol."""
        return self.with_unit(self.label if self.words == self.label else self.sign)

    def with_unit(self, name: str) -> str:
        """Return a name with the unit in brackets, if there is one."""
        return f"{name} [{self.unit}]" if self.unit else name

    def scaled(self, value: float, factor: float) -> float:
        """Return the value after multiplying the acceleration by a factor of either sign."""
        for _ in range(self.power):
            value *= abs(factor)
        return value

    def factor(self, value: float, level: float) -> float:
        """Return the factor on the acceleration that scales a value to a level; infinite or NaN if there is none."""
        if not value > 0.0 or not self.power:
            return math.inf
        return math.sqrt(level / value) if self.power == 2 else level / value
