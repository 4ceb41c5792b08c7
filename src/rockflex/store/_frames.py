"""Tables of Arrow as tables of pandas."""
# pyright: reportUnknownParameterType=false
# (pyarrow comes without types)

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa


def in_pandas(table: "pa.Table") -> "pd.DataFrame":
    """Return a table with a plain index.

    Columns from pandas keep their types; in other tables, integers and booleans become nullable types of pandas.
    """
    import pandas as pd
    import pyarrow as pa

    if b"pandas" in (table.schema.metadata or {}):
        return table.to_pandas().reset_index(drop=True)
    widths = {pa.int8(): "Int8", pa.int16(): "Int16", pa.int32(): "Int32", pa.int64(): "Int64"}
    kinds: dict[Any, Any] = {kind: pd.api.types.pandas_dtype(name) for kind, name in widths.items()}
    return table.to_pandas(types_mapper=(kinds | {pa.bool_(): pd.BooleanDtype()}).get)
