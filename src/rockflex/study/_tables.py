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
    return _named(pa.array(values, pa.int32()), kind)


def _named(codes: Any, names: Sequence[str]) -> Any:
    """Return a column of names; all chunks list all of them, so that their tables have one schema and can be joined."""
    import pyarrow as pa

    return pa.DictionaryArray.from_arrays(codes, pa.array(names, pa.string()))


class Sheet:
    """A table of results that is filled column by column.

    Parameters
    ----------
    size
        Number of rows.
    columns
        Columns of results; those that are never filled stay missing. `error` is a text for each row that has none.
    """

    def __init__(self, size: int, columns: Columns) -> None:
        self._columns = columns
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

    def table(self) -> ArrowTable:
        """Return the table; NaN are missing values."""
        import pyarrow as pa

        found = dict[str, Any]()
        for name, kind in self._columns.items():
            if kind is str:
                found[name] = pa.array(self._errors, pa.string())
                continue
            column = self._values[name]
            missing = self._missing | np.isnan(column) if kind is float else self._missing
            array = pa.array(column, TYPES[kind] if isinstance(kind, type) else pa.int32(), mask=missing)
            found[name] = array if isinstance(kind, type) else _named(array, kind)
        return pa.table(found)


def to_frame(*tables: ArrowTable) -> "pd.DataFrame":
    """Join tables into a DataFrame: names become categories; integers, flags and text get types that allow NA."""
    import pandas as pd
    import pyarrow as pa

    kinds = {pa.int64(): pd.Int64Dtype(), pa.bool_(): pd.BooleanDtype(), pa.string(): pd.StringDtype()}
    return pa.concat_tables(tables).to_pandas(types_mapper=kinds.get)
