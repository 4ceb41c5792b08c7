"""Values as short tables in notebooks."""

from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from rockflex.foundation.arrays import Array
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


def svg_picture(content: tuple[float, float, Iterable[str]], words: str) -> Any:
    """Return a picture as SVG in HTML from its width and height in pixels and its elements; `words` describe it."""
    from markupsafe import Markup

    width, height, drawn = content
    return Markup(
        f'<svg width="{width:.0f}" height="{height:.0f}" viewBox="0 0 {width:.0f} {height:.0f}" role="img">'
        f"<title>{{}}</title>{''.join(drawn)}</svg>"
    ).format(words)


def curve_svg(x: Array, y: Array, width: float = 320.0, height: float = 60.0) -> tuple[float, float, list[str]]:
    """Return a curve over a line at zero, as for `svg_picture`; of many points the extremes of each pixel."""
    count = int(width)
    place = np.clip(((x - x[0]) / ((x[-1] - x[0]) or 1.0) * (count - 1)).astype(int), 0, count - 1)
    starts = np.flatnonzero(np.diff(place, prepend=-1))
    ends = np.stack((np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)))
    scale = (0.5 * height - 2.0) / (float(np.abs(y).max()) or 1.0)
    points = " ".join(
        f"{column},{0.5 * height - scale * value:.1f}"
        for column, pair in zip(place[starts].tolist(), ends.T.tolist(), strict=True)
        for value in dict.fromkeys(pair)
    )
    zero = f'<path d="M0 {0.5 * height:g}H{width:g}" stroke="#8c8c8c" stroke-width="0.7"/>'
    return width, height, [zero, f'<polyline points="{points}" fill="none" stroke="currentColor"/>']


def value_range_text(values: Iterable[float]) -> str:
    """Write the smallest and the largest of some values; once if they are the same."""
    known = list(values)
    ends = dict.fromkeys(f"{end:.4g}" for end in (min(known), max(known)))
    return " to ".join(ends)


def _html_cell_text(value: Any) -> str:
    if hasattr(value, "__html__"):
        return value
    if isinstance(value, str):
        return shortened(value)
    if isinstance(value, float):
        return f"{value:.5g}"
    if isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind == "f":
        more = f", ... ({value.size})" if value.size > MOST else ""
        return ", ".join(f"{each:.5g}" for each in value[:MOST].tolist()) + more
    return shown(value)
