"""Signs in a text by which it may be a record, or is none, before it is read and when it cannot be read."""

import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.motion import _text
from rockflex.motion._header import MAX_LINE, MAX_STEP, MIN_STEP, Lines, header_of_lines
from rockflex.motion._labels import ACCELERATION, parse_label

OF_RECORDS = re.compile(
    r"\b(?:PG[AVD]|magnitude|M_?w|R_?(?:rup|jb|epi)|V_?s_?30|RSN|stor(?:e?y|ies)|floor|level|scale[ _]?factor)\b",
    re.IGNORECASE,
)
MIN_ROWS = 3  # of numbers; a record needs as many samples
MAX_HEADER_LINES = 100


def has_rows_of_numbers(lines: Iterable[str]) -> bool:
    """Return whether some lines that follow each other hold nothing but numbers."""
    count = 0
    for line in lines:
        count = count + 1 if _is_row_of_numbers(line) else 0
        if count == MIN_ROWS:
            return True
    return False


def names_acceleration(file: Path, lines: Sequence[str]) -> bool:
    """Return whether the lines above the numbers call these an acceleration, or state their unit or time step."""
    heads = list(enumerate(lines[:MAX_HEADER_LINES], 1))
    above = heads[: next((k for k, (_, line) in enumerate(heads) if _is_row_of_numbers(line)), len(heads))]
    return _say_acceleration(file, above)


def is_table_of_something_else(file: Path, table: _text.NumericTable) -> bool:
    """Return whether columns have labels of which none may be that of an acceleration, nor a line above them.

    A column beside others without a time, such as PGA or magnitude, means a table of records or floors.
    A column by itself, or beside one that increases as times do, may be a record whatever its label.
    """
    labels = [parse_label(text) for text in table.labels]
    if any(map(OF_RECORDS.search, table.labels)) and not any(each.kind == "time" for each in labels):
        return True
    unknown = all(each.kind in ("unknown", "row number") and each.unit is None for each in labels)
    if not labels or not unknown or _say_acceleration(file, table.head_lines):
        return False
    return len(labels) > 2 or (len(labels) == 2 and not _may_be_times([cells[0] for _, cells in table.rows]))


def _may_be_times(cells: Sequence[str]) -> bool:
    values = [_text.parse_optional_decimal(cell) for cell in cells]
    times = np.array([math.nan if value is None else value for value in values])
    steps = np.diff(times)
    even = steps.size > 0 and bool(np.ptp(steps) <= 0.5 * abs(float(steps[0])))
    return even and MIN_STEP <= float(steps.mean()) <= MAX_STEP


def _is_row_of_numbers(line: str) -> bool:
    cells = [cell for cell in re.split(r"[\s;,\"]++", line.strip()) if cell]
    return bool(cells) and all(map(_text.is_number_cell, cells))


def _say_acceleration(file: Path, lines: Lines) -> bool:
    if any(ACCELERATION.search(line[:MAX_LINE]) for _, line in lines):
        return True
    try:
        header = header_of_lines(file, lines)
    except InputError:  # a step that cannot be one
        return True
    return bool(header.units or header.steps)
