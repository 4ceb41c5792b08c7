"""The table that `simulate_many` returns."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rockflex.response import Response
from rockflex.study._results import RESULTS, STATUSES

if TYPE_CHECKING:
    import pandas as pd

TYPES = {float: "f8", int: "i8", bool: "?"}


class RunTable:
    """Columns of fixed length, filled row by row from any thread."""

    def __init__(self, rows: int, *, keep: bool) -> None:
        self.status = np.full(rows, -1, dtype=np.int8)
        self.columns: dict[str, NDArray[Any]] = {}
        for name, kind in RESULTS.items():
            self.columns[name] = np.full(rows, np.nan if kind is float else 0, dtype=TYPES[kind])
        self.errors: dict[int, str] = {}
        self.responses: NDArray[np.object_] | None = np.full(rows, None, dtype=object) if keep else None

    def enter(self, row: int, response: Response) -> None:
        self.status[row] = STATUSES.index(response.status)
        for name, column in self.columns.items():
            column[row] = getattr(response, name)
        if self.responses is not None:
            self.responses[row] = response

    def frame(
        self,
        shape: tuple[int, ...],
        structures: list[str] | None,
        motions: list[str],
        scales: list[float],
        models: list[str],
    ) -> "pd.DataFrame":
        import pandas as pd

        structure, motion, model, scale = (axis.ravel() for axis in np.indices(shape, dtype=np.int32))
        error = pd.array(np.full(structure.size, None, dtype=object), dtype="string")
        for row, message in self.errors.items():
            error[row] = message
        table = pd.DataFrame(
            {
                "structure": structure if structures is None else _category(structure, structures),
                "motion": _category(motion, motions),
                "scale": np.asarray(scales)[scale],
                "model": _category(model, models),
                "status": pd.Categorical.from_codes(self.status, dtype=pd.CategoricalDtype(list(STATUSES))),
                "error": error,
                **{name: _with_gaps(values, self.status < 0) for name, values in self.columns.items()},
            }
        )
        if self.responses is not None:
            table["response"] = self.responses
        return table


def _category(codes: NDArray[np.int32], names: list[str]) -> "pd.Categorical[Any]":
    """Return a categorical column; names that occur twice share a category."""
    import pandas as pd

    categories = list(dict.fromkeys(names))
    places = np.array([categories.index(name) for name in names], dtype=np.int32)
    return pd.Categorical.from_codes(places[codes], dtype=pd.CategoricalDtype(categories))


def _with_gaps(values: NDArray[Any], missing: NDArray[np.bool_]) -> Any:
    """Return a column with missing rows: floats hold NaN already, other types become one that allows NA."""
    import pandas as pd

    if values.dtype.kind == "f":
        return values
    nullable = pd.arrays.IntegerArray if values.dtype.kind == "i" else pd.arrays.BooleanArray
    return nullable(values, missing.copy())
