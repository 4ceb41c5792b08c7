"""The search for the scales at which a motion overturns a structure, with a row for every run."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

from rockflex.study._tables import Row


class Steps(NamedTuple):
    """The first and the last scale, each over the one before, and the width to which bisection narrows a boundary."""

    smallest: float
    largest: float
    growth: float
    tolerance: float


def rungs(smallest: float, largest: float, growth: float) -> list[float]:
    """Return scales from `smallest` to `largest`, each `growth` times the one before; the last step may be smaller."""
    count = math.ceil(math.log(largest / smallest) / math.log(growth) - 1e-9)
    return [*(smallest * growth**step for step in range(count)), largest]


def steps_between(growth: float, tolerance: float) -> int:
    """Return the largest number of bisections between two neighbouring rungs."""
    return max(0, math.ceil(math.log2((growth - 1.0) / tolerance)))


def steps_from_rest(tolerance: float) -> int:
    """Return the largest number of bisections below the lowest rung, down to a thousandth of it."""
    return math.ceil(math.log2(1.0 / tolerance)) + 10


@dataclass
class Ladder:
    """Runs of one structure under one record at rising scales.

    Overturning is not monotone: a structure may overturn at a scale and survive a larger one. Therefore all rungs are
    run; bisection then narrows the first and the last boundary.

    Parameters
    ----------
    run
        Returns the row of a scale; `overturned` is True, False, or None if the run could not be solved.
    scales
        The rungs, in rising order.
    growth, tolerance
        Ratio of neighbouring rungs, and relative width of the boundaries found.
    """

    run: Callable[[float], Row]
    scales: Sequence[float]
    growth: float
    tolerance: float
    rows: list[Row] = field(default_factory=list[Row])

    def climb(self) -> list[Row]:
        """Run the ladder and return its rows, sorted by scale, each with the summary of the whole ladder."""
        for scale in self.scales:
            self._try(scale)
        boundaries = self._boundaries()
        for stands, falls in dict.fromkeys((boundaries[0], boundaries[-1]) if boundaries else ()):
            self._bisect(stands, falls)
        self.rows.sort(key=lambda row: row["scale"])
        summary = self._summary()
        return [row | summary for row in self.rows]

    def _try(self, scale: float) -> bool | None:
        row = self.run(scale)
        self.rows.append(row)
        return row["overturned"]

    def _boundaries(self) -> list[tuple[float, float]]:
        """Return neighbouring scales of which the lower survives and the upper overturns; zero always survives."""
        known = [(0.0, False), *((row["scale"], row["overturned"]) for row in self._known())]
        return [(lower, upper) for (lower, fell), (upper, falls) in pairwise(known) if falls and not fell]

    def _bisect(self, stands: float, falls: float) -> None:
        steps = steps_between(self.growth, self.tolerance) if stands > 0.0 else steps_from_rest(self.tolerance)
        for _ in range(steps):
            if falls - stands <= self.tolerance * falls:
                break
            middle = 0.5 * (stands + falls)
            fell = self._try(middle)
            if fell is None:
                break
            stands, falls = (stands, middle) if fell else (middle, falls)

    def _known(self) -> list[Row]:
        return [row for row in self.rows if row["overturned"] is not None]

    def _summary(self) -> Row:
        known = self._known()
        falls = [row["scale"] for row in known if row["overturned"]]
        stands = [row["scale"] for row in known if not row["overturned"]]
        return {
            "first_overturning_scale": min(falls, default=None),
            "last_survival_scale": max(stands, default=None),
            "resurrections": sum(lower["overturned"] and not upper["overturned"] for lower, upper in pairwise(known)),
            "right_censored": not falls if known else None,
        }
