"""How much of the sheet its parts take, by an estimate that errs on the large side."""

import math
from collections.abc import Sequence

from rockflex.report.run._table import Fact, Table

WIDTH, HEIGHT = 186.0, 272.0  # of a sheet of A4 within its margins, in mm
FIGURE = (58.0, 160.0)  # least and largest height of the figure in mm
SMALLEST = 0.75  # of the usual size of the type, on a sheet that is full
LINE = 3.4  # height of a line of text in mm
SMALL = 0.9  # size of small text over that of text
_EM = 2.61  # mm
_ROW, _HEAD = 0.7, 4.4  # what a row of a table has above its lines, and the heading of a part, in mm
_LEFT, _RIGHT = 116.0, 65.0  # columns at the top in mm
_NARROW, _WIDE = frozenset(" .,:;!|'’ijltfrI()[]/-"), frozenset("MWmw@%—…")


def lines_of(text: str, width: float = WIDTH, size: float = 1.0) -> int:
    """Return how many lines of `width` mm a text takes in type of a relative size."""
    return max(1, math.ceil(1.04 * _length(text) * size / (width - 2.0)))


def _length(text: str) -> float:
    """Return the length of a text in one line in mm, in a font without serifs."""
    return _EM * sum(_share(letter) for letter in text)


def _share(letter: str) -> float:
    if letter in _WIDE or ord(letter) >= 0x2E80:  # ideographs and symbols
        return 1.0
    if letter in _NARROW:
        return 0.34
    return 0.72 if letter.isupper() else 0.57


def height_of_facts(facts: Sequence[Fact], width: float, columns: int) -> float:
    """Return the height in mm of facts in some columns."""
    share = width / columns - 4.0
    lines = [lines_of(f"{fact.name}  {fact.cell.text} {fact.unit:6}", share) for fact in facts]
    rows = [max(lines[place : place + columns]) for place in range(0, len(lines), columns)]
    return sum(LINE * row + 0.2 for row in rows)


def height_of_table(table: Table | None, *, units: bool = False) -> float:
    """Return the height in mm of a table, whose `units` may be below its headings."""
    if table is None:
        return 0.0
    rows = [[name for name, _ in table.heads], *([cell.text for cell in row] for row in table.rows)]
    widths = [max(_length(row[place]) for row in rows) + 1.7 for place in range(len(table.heads))]
    if units:  # numbers do not wrap, their headings may
        return 3.0 * LINE + _ROW + len(table.rows) * (LINE + _ROW)
    lines = math.ceil(1.04 * sum(widths) / WIDTH)
    return LINE + _ROW + len(table.rows) * (lines * LINE + _ROW)


def height_above(facts: Sequence[Fact], modes: Table | None, kind: str) -> float:
    """Return the height in mm of the structure."""
    table = 0.0 if modes is None else 1.2 + 2.0 * LINE + _ROW + len(modes.rows) * (LINE + _ROW)
    return _HEAD + LINE * (lines_of(f"Structure {kind}", _LEFT, 1.2) - 1) + height_of_facts(facts, _LEFT, 2) + table


def height_beside(facts: Sequence[Fact], name: str, source: str) -> float:
    """Return the height in mm of the record with its strip."""
    told = LINE * lines_of(source, _RIGHT, SMALL) if source else 0.0
    return (
        _HEAD + LINE * (lines_of(f"Record {name}", _RIGHT, 1.2) - 1) + told + 23.0 + height_of_facts(facts, _RIGHT, 1)
    )


def part(*heights: float) -> float:
    """Return the height in mm of a part with its heading and the gap below it."""
    return _HEAD + sum(heights) + 1.5
