"""Tables as CSV whose texts no spreadsheet takes for formulas."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

FORMULA_SIGNS = ("=", "+", "-", "@", "\t", "\r")


def guarded_text(value: Any) -> Any:
    """Return a text that a spreadsheet would take for a formula behind an apostrophe; numbers and others as they are.

    Names of records come from strangers: OWASP, CSV injection.
    """
    if not isinstance(value, str):
        return value
    plain = value.replace("\r", " ")  # which would end the row
    if not value.startswith(FORMULA_SIGNS):
        return plain
    try:
        float(value)
    except ValueError:
        return f"'{plain}"
    return plain


def table_as_csv(table: "pd.DataFrame", **how: Any) -> str:
    """Return a table as CSV without its index, texts and headings as of `guarded_text`; `how` is that of `to_csv`."""
    safe = table.rename(columns=guarded_text)
    for place, kind in enumerate(safe.dtypes):
        if kind.kind == "O":  # texts and categories
            texts: Any = safe.iloc[:, place].astype(object).map(guarded_text, na_action="ignore")
            safe.isetitem(place, texts)
    options: dict[str, Any] = {"index": False, "lineterminator": "\n"} | how
    return safe.to_csv(**options)
