"""Values as short tables in notebooks."""

from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from rockflex.foundation.shown import shortened, shown

MOST = 6  # values of an array


class HtmlTable:
    """A dataclass that notebooks show as a table of its fields, or of what `_shown_as` returns, in SI units."""

    def _shown_as(self) -> Mapping[str, Any]:
        return {each.name: getattr(self, each.name) for each in fields(self) if each.repr}  # pyright: ignore[reportArgumentType]

    def _repr_html_(self) -> str:
        return html_table(type(self).__name__, self._shown_as())


def html_table(title: str, rows: Mapping[str, Any]) -> str:
    """Return a table of names and values as HTML, everything escaped; None is left out."""
    from markupsafe import Markup

    row = Markup('<tr><th style="text-align: left">{}</th><td style="text-align: left">{}</td></tr>')
    body = Markup("").join(
        row.format(name, _html_cell_text(value)) for name, value in rows.items() if value is not None
    )
    return str(Markup("<table><caption>{}</caption><tbody>{}</tbody></table>").format(title, body))


def value_range_text(values: Iterable[float]) -> str:
    """Write the smallest and the largest of some values; once if they are the same."""
    known = list(values)
    ends = dict.fromkeys(f"{end:.4g}" for end in (min(known), max(known)))
    return " to ".join(ends)


def _html_cell_text(value: Any) -> str:
    if isinstance(value, str):
        return shortened(value)
    if isinstance(value, float):
        return f"{value:.5g}"
    if isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind == "f":
        more = f", ... ({value.size})" if value.size > MOST else ""
        return ", ".join(f"{each:.5g}" for each in value[:MOST].tolist()) + more
    return shown(value)
