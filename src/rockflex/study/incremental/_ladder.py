"""The search for the scales at which a motion overturns a structure, which keeps every run."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from rockflex.study.plan._tables import Row


def rungs(smallest: float, largest: float, growth: float) -> list[float]:
    """Scales from `smallest`, each larger by `growth`, to `largest`, which is the last."""
    count = math.ceil(math.log(largest / smallest) / math.log(growth) - 1e-9)
    return [*(smallest * growth**step for step in range(count)), largest]


def steps_between(growth: float, tolerance: float) -> int:
    """Most bisections between two neighbouring rungs."""
    return max(0, math.ceil(math.log2((growth - 1.0) / tolerance)))


def steps_from_rest(tolerance: float) -> int:
    """Most bisections below the lowest rung, which a thousandth of it ends at the latest."""
    return math.ceil(math.log2(1.0 / tolerance)) + 10


@dataclass
class Ladder:
    """Runs of one structure under one record at rising scales.

    Overturning is not monotone: a structure may fall at a scale and stand at a larger one. All rungs are run, so what
    they show of it is kept; then bisection narrows the first boundary, and the last.

    Parameters
    ----------
    run
        The row of a scale, with its `overturned` True, False, or None where the run could not be solved.
    scales
        The rungs, rising.
    growth, tolerance
        Of neighbouring rungs, and relative width of the boundaries found.
    """

    run: Callable[[float], Row]
    scales: Sequence[float]
    growth: float
    tolerance: float
    rows: list[Row] = field(default_factory=list[Row])

    def climb(self) -> list[Row]:
        """Run all, and return the rows in order of their scales, each with what the ladder as a whole says."""
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
        """Neighbouring scales of which the lower stands and the upper overturns; at zero everything stands."""
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
