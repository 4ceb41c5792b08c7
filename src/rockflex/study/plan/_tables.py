"""Tables of results: the same columns in every chunk, with gaps where a run could not be solved."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import pyarrow as pa

from rockflex.response import PEAKS, Response

if TYPE_CHECKING:
    import pandas as pd

Table: TypeAlias = Any  # a pyarrow.Table: pyarrow comes without types

# A kind of column, or the names that the codes of a column of names stand for.
Columns = Mapping[str, type | Sequence[str]]
Row = dict[str, Any]

RESULTS: dict[str, type] = {  # every number and flag of a Response, by its name
    name: Response.__annotations__[name] for name in PEAKS if Response.__annotations__[name] in (float, int, bool)
}
TYPES: dict[type, Any] = {float: pa.float64(), int: pa.int64(), bool: pa.bool_(), str: pa.string()}


def kinds_of(names: str, kind: type) -> dict[str, type]:
    """Columns of one kind, their names parted by blanks."""
    return dict.fromkeys(names.split(), kind)


def peaks_of(response: Response | None, suffix: str = "") -> Row:
    """Every number and flag of a response by its name; nothing of a run that has none."""
    if response is None:
        return {}
    return {name + suffix: getattr(response, name) for name in RESULTS}


def tabulate(rows: Sequence[Row], columns: Columns) -> Table:
    """A table of rows; what a row does not have, and NaN, is missing."""
    return pa.table({name: _column([row.get(name) for row in rows], kind) for name, kind in columns.items()})


def _column(values: list[Any], kind: type | Sequence[str]) -> Any:
    if isinstance(kind, type):
        return pa.array(values, TYPES[kind], from_pandas=True)
    # All chunks have all names, so that their tables are of one schema and join without a look at the names.
    return pa.DictionaryArray.from_arrays(pa.array(values, pa.int32()), pa.array(kind, pa.string()))


def to_frame(*tables: Table) -> "pd.DataFrame":
    """The tables, one below the other, in pandas: names as categories, and types that know NA for all but floats."""
    import pandas as pd

    kinds = {pa.int64(): pd.Int64Dtype(), pa.bool_(): pd.BooleanDtype(), pa.string(): pd.StringDtype()}
    return pa.concat_tables(tables).to_pandas(types_mapper=kinds.get)
