"""Numbers in fields of equal width, as Fortran prints them, which may leave no blank between them."""

from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion._text import parse_decimal


def lines_of(count: int, columns: int) -> int:
    """Return how many lines hold some numbers."""
    return -(-count // max(columns, 1))


def check_lines_follow(
    file: Path, lines: list[str], begin: int, count: int, columns: int, what: str, before: int = 0
) -> None:
    """Raise an InputError if the lines end before `count` numbers that begin at a place among them.

    `before` is the number of lines of the file before these ones.
    """
    end = begin + lines_of(count, columns)
    if end > len(lines) or (end > begin and not lines[end - 1].strip()):
        raise InputError(
            f"{file} is truncated: {count} {what} are announced, in lines {before + begin + 1} to {before + end}, but "
            f"there are only {before + len(lines)} lines. Download the record again."
        )


def fixed_width_numbers(
    file: Path, lines: list[str], begin: int, count: int, columns: int, width: int, what: str, before: int = 0
) -> Array:
    """Return the numbers that begin at a place among the lines, so many columns a line; `before` as there."""
    check_lines_follow(file, lines, begin, count, columns, what, before)
    found: list[float] = []
    for i in range(begin, begin + lines_of(count, columns)):
        line = lines[i].rstrip()
        cells = [line[k : k + width].strip() for k in range(0, len(line), width)]
        expected = min(columns, count - len(found))
        if len(cells) != expected:
            raise InputError(
                f"{file}, line {before + i + 1}: {expected} {what} are expected, in columns of {width} characters, but "
                f"found {len(cells)}: {shown(line)}. The file was changed: download the record again."
            )
        found += [parse_decimal(cell, file, before + i + 1) for cell in cells]
    return np.array(found)
