"""Signs in a text by which it may be a record, or is none, before it is read and when it cannot be read."""

import re
from collections.abc import Iterable, Sequence

from rockflex.motion import _text
from rockflex.motion._record_info import VERTICAL_NAME, is_horizontal_component_name
from rockflex.motion._units import acceleration_unit

ACCELERATION_WORD = re.compile(r"\b(?:acc|acel|accél|beschl)|\bstrong.motion\b", re.IGNORECASE)
# As in the headers of PEER, of NGA and of many programs.
STATED_NUMBER = re.compile(r"\b(?:NPTS|NDATA|DT|DELTA_?T|SAMPLING[ _]INTERVAL[\w()]*+)\s*+[=:]\s*+[\d.]", re.IGNORECASE)
MIN_ROWS = 3  # of numbers; a record needs as many samples
MAX_SIGN_LINE = 500  # characters of a line that are searched
MAX_HEADER_LINES = 100


def has_rows_of_numbers(lines: Iterable[str]) -> bool:
    """Return whether some lines in a row hold nothing but numbers."""
    count = 0
    for line in lines:
        count = count + 1 if _is_row_of_numbers(line) else 0
        if count == MIN_ROWS:
            return True
    return False


def names_acceleration(lines: Sequence[str]) -> bool:
    """Return whether lines say of the numbers below them that they are an acceleration, or state a time step."""
    heads = [line[:MAX_SIGN_LINE] for line in lines_before_numbers(lines)]
    return any(_speaks_of_acceleration(head) or STATED_NUMBER.search(head) for head in heads)


def lines_before_numbers(lines: Sequence[str]) -> list[str]:
    """Return the lines above the first row of numbers, of long headers the first ones."""
    head = lines[:MAX_HEADER_LINES]
    return list(head[: next((i for i, line in enumerate(head) if _is_row_of_numbers(line)), len(head))])


def is_table_of_something_else(labels: Sequence[str], heads: Iterable[str]) -> bool:
    """Return whether columns have labels of which none names an acceleration, a component or the time."""
    return bool(labels) and not any(
        [*map(_may_be_of_record, labels), *(_speaks_of_acceleration(head[:MAX_SIGN_LINE]) for head in heads)]
    )


def _is_row_of_numbers(line: str) -> bool:
    cells = re.split(r"[\s;,]++", re.split("[#%!]", line, maxsplit=1)[0].strip(' \t"'))
    return bool(cells[0]) and all(_text.is_number_cell(cell.strip('"')) for cell in cells if cell)


def _speaks_of_acceleration(text: str) -> bool:
    brackets = _text.BRACKET.findall(text[: _text.end_of_last_bracket(text)])
    return bool(ACCELERATION_WORD.search(text)) or any(acceleration_unit(each) is not None for each in brackets)


def _may_be_of_record(label: str) -> bool:
    end = _text.end_of_last_bracket(label)
    name = (_text.BRACKET.sub("", label[:end]) + label[end:]).strip(" _-.")
    named = VERTICAL_NAME.fullmatch(name) or is_horizontal_component_name(name) or _text.TIME_LABEL.match(name)
    return bool(named) or _speaks_of_acceleration(label)
