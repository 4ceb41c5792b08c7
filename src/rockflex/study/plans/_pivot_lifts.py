"""In how many runs of a study the pivot would lift."""

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import pandas as pd

LEAST = "min_vertical_reaction"


class PivotLifts(NamedTuple):
    """Of one structure, set of tendons or population, and of one model: runs that rock and stand, and would lift."""

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


def pivot_lifts(table: "pd.DataFrame") -> list[PivotLifts]:
    """Count the runs of a study's table in which the vertical reaction falls below zero, by structure and model.

    Parameters
    ----------
    table
        What a study returned; of a population, one row a pair of runs.
    """
    import pandas as pd

    if "status" in table:
        # The widths of a design are counted together.
        part, name = ("tendon", "Designs, tendons: {}") if "tendon" in table else ("structure", "{}")
        runs: Any = table.assign(name=table[part].astype(str).map(name.format))
    else:
        pairs = (("mdof", "MDOF-S"), ("2dof", "2DOF-S"))
        parts = [
            pd.DataFrame({"model": model, "status": table[f"status_{key}"], LEAST: table[f"{LEAST}_{key}"]})
            for key, model in pairs
        ]
        runs = pd.concat(parts).assign(name="Population")
    standing = runs[runs["status"] == "rocking"]
    return [
        PivotLifts(structure, str(model), len(each), int((each[LEAST] < 0.0).sum()))
        for (structure, model), each in standing.groupby(["name", "model"], observed=True, sort=False)
    ]
