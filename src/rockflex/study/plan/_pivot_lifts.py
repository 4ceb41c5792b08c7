"""How many runs of a study would lift the pivot."""

from typing import TYPE_CHECKING, NamedTuple

from rockflex._cases import cases

if TYPE_CHECKING:
    import pandas as pd

LEAST = "min_vertical_reaction"


class PivotLifts(NamedTuple):
    """Numbers of runs that rock and stand, and of those whose pivot would lift, for one structure and model."""

    structure: str
    model: str
    rocking: int
    lifting: int

    def __str__(self) -> str:
        return (
            f"{self.structure}, {self.model}: in {self.lifting} of {self.rocking} runs that rock and stand the model "
            f"pulls the base down ({LEAST} below zero), which no ground can: the pivot would lift. Read what follows "
            "in such a run with care."
        )


def pivot_lifts(runs: "pd.DataFrame") -> list[PivotLifts]:
    """Count the runs in which the vertical reaction falls below zero, by structure and model.

    Parameters
    ----------
    runs
        A table with one row a run.
    """
    standing = runs[runs["status"] == "rocking"]
    return [
        PivotLifts(structure, model, len(each), int((each[LEAST] < 0.0).sum()))
        for structure, model, each in cases(standing)
    ]
