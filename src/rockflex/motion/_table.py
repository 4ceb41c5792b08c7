"""Rows of numbers and the labels of their columns, from text: which character separates, and which marks decimals."""

import re
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from rockflex._errors import InputError
from rockflex.motion._text import DECIMAL, number

COMMA = re.compile(r"([+-]?+\d*+),\d++(?:[EeDd][+-]?+\d++)?+")  # a number with a decimal comma
TIME = re.compile(r"(?:t|time|zeit|temps|tempo|tiempo)\b", re.IGNORECASE)
BRACKET = re.compile(r"[(\[]([^)\]]*+)[)\]]")


@dataclass
class Table:
    """Rows of cells, each with its line, under labels; and the lines before them."""

    labels: list[str]  # empty if there are none
    rows: list[tuple[int, list[str]]]
    heads: list[str]


RECORD = "a record is expected as AT2, CSV or columns of text"


def table_of(file: Path, lines: list[str], expected: str = RECORD) -> Table:
    """Return the rows of numbers in the lines of a text file.

    Cells are separated by semicolons, commas, tabs or blanks; ``#``, ``%`` and ``!`` begin comments. A comma is a
    decimal one where something else separates the cells; and in a single column, unless the numbers before it increase
    like times. `expected` says in the message for a file without numbers what it should hold.
    """
    heads: list[str] = []
    plain: list[tuple[int, str]] = []  # header lines that are not comments
    body: list[tuple[int, str]] = []
    for i, line in enumerate(lines, 1):
        content = re.split("[#%!]", line, maxsplit=1)[0].strip()
        if not body and (not content or not is_number(re.split(r"[;,\s]", content, maxsplit=1)[0] or content)):
            heads.append(line.strip().lstrip("#%! \t"))
            plain.append((i, content))
        elif content:
            body.append((i, content))
    if not body:
        raise InputError(f"{file} holds no numbers: {expected}.")
    separator, commas = _separator(body)
    rows: list[tuple[int, list[str]]] = []
    for i, content in body:
        cells = [cell.strip() for cell in content.split(separator)]
        if separator and cells[-1] == "":
            cells.pop()
        if rows and len(cells) != len(rows[0][1]):
            raise InputError(
                f"{file}, line {i}: expected {len(rows[0][1])} columns as in line {rows[0][0]}, but found {len(cells)}."
            )
        rows.append((i, [_with_point(file, i, cell) for cell in cells] if commas else cells))
    return Table(_found_labels(file, heads, plain, separator, len(rows[0][1])), rows, heads)


def _separator(body: list[tuple[int, str]]) -> tuple[str | None, bool]:
    """Return the character between cells (None for blanks), and whether decimals are marked by commas."""
    first = body[0][1]
    if ";" in first:
        return ";", any("," in content for _, content in body)
    if "," not in first:
        # A column of decimals may begin with whole numbers: 0, 0,01, 0,02.
        some = next((content for _, content in body if "," in content), None)
        return None, some is not None and all(_decimal(word) for word in some.split())
    words = first.split()
    if len(words) > 1 and all(map(_decimal, words)):
        return None, True
    if len(words) == 1 and _alone(body):
        return None, True
    return ",", False


def _decimal(word: str) -> bool:
    return bool(COMMA.fullmatch(word) or DECIMAL.fullmatch(word))


def _alone(body: list[tuple[int, str]]) -> bool:
    """Return whether the lines are one column with decimal commas, and not times and whole numbers apart by commas."""
    found = [COMMA.fullmatch(content) or DECIMAL.fullmatch(content) for _, content in body]
    if not all(found):
        return False
    times = [float(content.partition(",")[0] + ".0") if "," in content else float("nan") for _, content in body]
    return not all(later > earlier for earlier, later in pairwise(times))


def _with_point(file: Path, line: int, cell: str) -> str:
    if "," in cell and not COMMA.fullmatch(cell):
        number(cell, file, line)
    if "." in cell:
        raise InputError(
            f"{file}, line {line}: {cell[:40]!r} has a decimal point, but other numbers have decimal commas. Write all "
            "of them in one way."
        )
    return cell.replace(",", ".")


def _found_labels(
    file: Path, heads: list[str], plain: list[tuple[int, str]], separator: str | None, n_columns: int
) -> list[str]:
    """Return the labels in the last header line that has as many as there are columns."""
    for i, content in plain:
        cells = _labels(content, separator)
        # A row of numbers with a typing error is not a header, and must not be skipped.
        if len(cells) == n_columns and any(re.match(r"[+-]?\.?\d", cell) for cell in cells):
            wrong = next((cell for cell in cells if not is_number(cell) and not COMMA.fullmatch(cell)), None)
            if wrong is not None and not TIME.match(wrong):
                number(wrong, file, i)
    for head in reversed(heads):
        apart = [cell.strip().strip('"') for cell in head.split("\t")] if separator is None and "\t" in head else []
        labels = apart if len(apart) == n_columns else _labels(head, separator)
        if len(labels) == n_columns and any(re.search("[a-zA-Z]", label) for label in labels):
            return labels
    return []


def _labels(head: str, separator: str | None) -> list[str]:
    if separator is None:
        # There may be a blank between a label and its unit in brackets, and inside the unit.
        end = after_brackets(head)
        head = BRACKET.sub(lambda unit: unit[0].replace(" ", ""), head[:end]) + head[end:]
        head = re.sub(r"(?<!\s)\s++(?=[(\[])", "", head)
        return re.split(r"[;,\s]\s*", head)
    cells = [cell.strip().strip('"') for cell in head.split(separator)]
    return cells[:-1] if cells[-1] == "" else cells


def after_brackets(text: str) -> int:
    """Return the end of the last closing bracket, so that no regular expression searches beyond it in vain."""
    return max(text.rfind(")"), text.rfind("]")) + 1


def is_number(token: str) -> bool:
    """Return whether a cell is a number, or a word for none such as nan."""
    return bool(DECIMAL.fullmatch(token)) or token.lower() in ("nan", "inf", "-inf")
