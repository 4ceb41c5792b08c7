"""The cases in a table of runs: a structure with a model, which every study reports apart."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

CASE = ["structure", "model"]


def runs_by_case(runs: "pd.DataFrame") -> "Iterator[tuple[str, str, pd.DataFrame]]":
    """Yield structure, model and rows of each case, in the order of the table."""
    for (structure, model), rows in runs.groupby(CASE, observed=True, sort=False):
        yield str(structure), str(model), rows


def runs_of_case(runs: "pd.DataFrame", structure: str, model: str) -> "pd.DataFrame":
    """Return the rows of one case."""
    return runs[(runs["structure"].astype(str) == structure) & (runs["model"].astype(str) == model)]
