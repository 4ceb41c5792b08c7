"""How many runs of a study would lift the pivot, or left the range of their model."""

from typing import TYPE_CHECKING, NamedTuple

from rockflex._cases import cases
from rockflex.response import complete_of, leaves_range

if TYPE_CHECKING:
    import pandas as pd

LEAST = "min_vertical_reaction"


class PivotLifts(NamedTuple):
    """Numbers of runs that rock and stand, of those whose pivot would lift, and of those beyond α, of one case."""

    structure: str
    model: str
    rocking: int
    lifting: int
    beyond: int = 0

    def __str__(self) -> str:
        return " ".join(self.warnings)

    @property
    def warnings(self) -> list[str]:
        """What to tell of these runs, a text each."""
        found: list[str] = []
        if self.lifting:
            found.append(
                f"{self.structure}, {self.model}: in {self.lifting} of {self.rocking} runs that rock and stand the "
                f"model pulls the base down ({LEAST} below zero), which no ground can: the pivot would lift. Read what "
                "follows in such a run with care."
            )
        if self.beyond:
            found.append(
                f"{self.structure}, {self.model}: in {self.beyond} of {self.rocking} runs that rock and stand θ passes "
                "α, at which the static moment vanishes (balance_ratio above one). The model is for small rotations: "
                f"whether these overturn is to be decided by a complete model on rigid ground, such as "
                f"{complete_of(self.model)}."
            )
        return found


def pivot_lifts(runs: "pd.DataFrame") -> list[PivotLifts]:
    """Count the runs in which the vertical reaction falls below zero or a simplified θ passes α, by case.

    Parameters
    ----------
    runs
        A table with one row a run.
    """
    standing = runs[runs["status"] == "rocking"]
    found: list[PivotLifts] = []
    for structure, model, each in cases(standing):
        past = 0  # where a table of an earlier version does not tell
        if "balance_ratio" in each:
            past = int(leaves_range(each["model"], each["balance_ratio"], each["max_rotation"]).sum())
        found.append(PivotLifts(structure, model, len(each), int((each[LEAST] < 0.0).sum()), past))
    return found
