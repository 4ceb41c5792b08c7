"""Tables of results: the same columns in every chunk, with missing values where a run could not be solved."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

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


def to_frame(*tables: ArrowTable) -> "pd.DataFrame":
    """Join tables into a DataFrame: names become categories; integers, flags and text get types that allow NA."""
    import pandas as pd
    import pyarrow as pa

    kinds = {pa.int64(): pd.Int64Dtype(), pa.bool_(): pd.BooleanDtype(), pa.string(): pd.StringDtype()}
    return pa.concat_tables(tables).to_pandas(types_mapper=kinds.get)
