"""Tables of results: the same columns in every chunk, with missing values where a run could not be solved."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd

ArrowTable: TypeAlias = Any  # a pyarrow.Table: pyarrow has no type annotations

# The type of a column, or for a column of names the names that its codes refer to.
Columns = Mapping[str, type | Sequence[str]]
Row = dict[str, Any]

TYPES = {float: "float64", int: "int64", bool: "bool", str: "string"}


def kinds_of(names: str, kind: type) -> dict[str, type]:
    """Return columns of one kind; blanks separate their names."""
    return dict.fromkeys(names.split(), kind)


def tabulate(rows: Sequence[Row], columns: Columns) -> ArrowTable:
    """Return a table of rows; NaN and the columns that a row lacks are missing values."""
    import pyarrow as pa

    return pa.table({name: _column([row.get(name) for row in rows], kind) for name, kind in columns.items()})


def _column(values: list[Any], kind: type | Sequence[str]) -> Any:
    import pyarrow as pa

    if isinstance(kind, type):
        return pa.array(values, TYPES[kind], from_pandas=True)
    # All chunks list all names, so that their tables have one schema and can be joined directly.
    return pa.DictionaryArray.from_arrays(pa.array(values, pa.int32()), pa.array(kind, pa.string()))


class Sheet:
    """Results of some runs, filled column by column, for a table in memory.

    Parameters
    ----------
    size
        Number of rows.
    columns
        Columns of results; those that are never filled stay missing. `error` is a text for each row that has none.
    """

    def __init__(self, size: int, columns: Columns) -> None:
        self._columns, self.size = columns, size
        self._values = {
            name: np.zeros(size, kind if isinstance(kind, type) else np.int32)
            for name, kind in columns.items()
            if kind is not str
        }
        self._missing = np.ones(size, dtype=np.bool_)
        self._errors: list[str | None] = [None] * size

    def put(self, places: Sequence[int], values: Mapping[str, NDArray[Any]]) -> None:
        """Fill some rows, if there are values at all."""
        if values:
            for name, column in self._values.items():
                column[places] = values[name]
            self._missing[places] = False

    def fail(self, places: Sequence[int], error: str) -> None:
        """Give rows an error, and no results."""
        for place in places:
            self._errors[place] = error
        self._missing[places] = True

    @staticmethod
    def joined(sheets: "Sequence[Sheet]") -> dict[str, Any]:
        """Return the columns of all sheets, one after another, for a DataFrame as `to_frame` gives it."""
        import pandas as pd

        missing = np.concatenate([sheet._missing for sheet in sheets])
        errors = [error for sheet in sheets for error in sheet._errors]
        found = dict[str, Any]()
        for name, kind in sheets[0]._columns.items():
            if kind is str:
                found[name] = pd.array(errors, dtype=pd.StringDtype())
                continue
            values: NDArray[Any] = np.concatenate([sheet._values[name] for sheet in sheets])
            if kind is float:
                found[name] = np.where(missing, np.nan, values)
            elif kind is int:
                found[name] = pd.arrays.IntegerArray(values, missing.copy())
            elif kind is bool:
                found[name] = pd.arrays.BooleanArray(values, missing.copy())
            elif not isinstance(kind, type):
                codes = np.where(missing, -1, values)
                found[name] = pd.Categorical.from_codes(codes, dtype=pd.CategoricalDtype(list(kind)))
        return found


def to_frame(*tables: ArrowTable) -> "pd.DataFrame":
    """Join tables into a DataFrame: names become categories; integers, flags and text get types that allow NA."""
    import pandas as pd
    import pyarrow as pa

    kinds = {pa.int64(): pd.Int64Dtype(), pa.bool_(): pd.BooleanDtype(), pa.string(): pd.StringDtype()}
    return pa.concat_tables(tables).to_pandas(types_mapper=kinds.get)
