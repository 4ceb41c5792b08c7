"""Text of record files: encodings, numbers, and tables of numbers."""

import re
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._files import check_regular_file
from rockflex._shown import number_with_noun, shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._units import AccelerationUnit, acceleration_unit

MAX_PEAK_G = 5.0  # in g; no recorded ground acceleration comes near it
# Possessive, like all of these patterns: a match is never retried in part, so no text takes long.
DECIMAL = re.compile(r"[+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[EeDd][+-]?+\d++)?+")
COMMA = re.compile(r"([+-]?+\d*+),\d++(?:[EeDd][+-]?+\d++)?+")  # a number with a decimal comma
SECONDS = ("s", "sec", "secs", "second", "seconds")
TIME_LABEL = re.compile(r"(?:t|time|zeit|temps|tempo|tiempo)\b", re.IGNORECASE)
BRACKET = re.compile(r"[(\[]([^)\]]*+)[)\]]")
EXPECTED_RECORD = "a record is expected as AT2, CSV or columns of text"


def agreed_unit_name(file: Path, where: str, written: str, given: str | None, units: str) -> str | None:
    """Return the unit that a header states, or the one given; they must agree. `units` may be written."""
    unit = acceleration_unit(written)
    stated = None if unit is None else str(unit)
    if written and stated is None:
        raise InputError(
            f"{file}: the {where} gives the unit {shown(written)}, which is not known. "
            f"Write it as {units}, and convert the values if necessary."
        )
    if stated and given not in (None, stated):
        raise InputError(
            f"{file}: the {where} says {stated}, but units={shown(given)} was given. Leave units out.", field="units"
        )
    return stated or given


def read_file_bytes(path: str | Path) -> bytes:
    """Return the bytes of a file, or raise an error that explains why it cannot be read."""
    file = Path(path)
    if file.is_dir():
        raise InputError(f"{file} is a directory. Read all its records with read_suite({shown(str(file))}).")
    check_regular_file(file)
    try:
        return file.read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"{file} does not exist (working directory: {Path.cwd()}).") from error
    except OSError as error:
        raise InputError(f"{file} cannot be read: {error.strerror}.") from error


def read_text_lines(path: str | Path) -> list[str]:
    """Return the lines of a text file, or raise an error that explains why it cannot be read."""
    return text_lines(Path(path), read_file_bytes(path))


def text_lines(file: Path, content: bytes) -> list[str]:
    """Return the lines in the bytes of a text file, or raise an error if it is binary or empty."""
    text = decoded_text(content)
    if text is None:
        raise InputError(f"{file} is a binary file; a record is expected as text (AT2, CSV or columns).")
    if not text.strip():
        raise InputError(f"{file} is empty. Give a file with a record, or copy it again.")
    return re.split("\r\n|\r|\n", text)


def decoded_text(data: bytes) -> str | None:
    """Return the text in the bytes of a file, or None if they are no text."""
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    # Latin-1 accepts every byte, so it comes last; old headers use it.
    for encoding in ("utf-16",) if wide else ("utf-8-sig", "latin-1"):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        text = text.rstrip("\x1a")
        return None if re.search(r"[\x00-\x08\x0e-\x1b\x7f]", text) else text
    return None


def parse_decimal(token: str, file: str | Path, line: int) -> float:
    """Return a decimal number (also with a Fortran D exponent), or raise an error that names the line."""
    if DECIMAL.fullmatch(token):
        value = float(re.sub("[Dd]", "E", token))
        if np.isfinite(value):
            return value
    hint = " Write decimals with a point." if re.fullmatch(r"[+-]?+\d++,\d++", token) else ""
    raise InputError(f"{file}, line {line}: expected a finite number, but found {token[:40]!r}.{hint}")


def parse_optional_decimal(text: str) -> float | None:
    """Return the number in a field of a header, or None if there is none."""
    if not DECIMAL.fullmatch(text.strip()):
        return None
    value = float(re.sub("[Dd]", "E", text.strip()))
    return value if np.isfinite(value) else None


def non_negative_or_none(value: float | None) -> float | None:
    """Return a value that a header or table gives; -999 and other negative numbers stand for an unknown one."""
    return None if value is None or not value >= 0.0 else value


def wrong_sample_count_error(file: Path, n_found: int, n_stated: float, stated: str) -> InputError:
    """Return the error of a file with fewer or more values than its header states."""
    fault = "is truncated" if n_found < n_stated else "contains too many values"
    found = number_with_noun(n_found, "value follows", "values follow")
    return InputError(f"{file} {fault}: its header says {stated}, but {found}. Download the record again.")


def motion_from_samples(
    file: Path, values: Array, unit: AccelerationUnit, dt: float, info: RecordInfo, remedy: str, name: str | None = None
) -> GroundMotion:
    """Build a motion named after its file."""
    acceleration = checked_acceleration_in_si(file, values, unit, remedy, info.scale)
    try:
        return GroundMotion(acceleration, dt, name=file.stem if name is None else name, metadata=info)
    except InputError as error:
        raise InputError(f"{file}: {error}") from error


def checked_acceleration_in_si(
    file: Path, values: Array, unit: AccelerationUnit, remedy: str, scale: float | None = None
) -> Array:
    """Convert to m/s² and reject amplitudes that indicate a wrong unit, unless a factor on the record explains them."""
    with np.errstate(over="ignore"):
        acceleration = values * unit.si
    peak = float(np.max(np.abs(values), initial=0.0))
    if peak * unit.si > MAX_PEAK_G * GRAVITY * max(abs(scale or 1.0), 1.0):
        smaller = {"g": "m/s² or cm/s²", "m/s2": "cm/s²"}.get(str(unit), "a smaller unit")
        raise InputError(
            f"{file}: the peak acceleration is {peak:g} {unit}, above {MAX_PEAK_G:g} g. "
            f"It looks like {smaller}, although {unit} was declared. {remedy} If the values are correct, "
            "build GroundMotion(acceleration, dt) from the array; motions can be scaled without limit.",
            field="units",
        )
    return acceleration


@dataclass
class NumericTable:
    """Rows of cells, each with its line, under labels; and the lines before them."""

    labels: list[str]  # empty if there are none
    rows: list[tuple[int, list[str]]]
    heads: list[str]


def parse_numeric_table(file: Path, lines: list[str], expected: str = EXPECTED_RECORD) -> NumericTable:
    """Return the rows of numbers in the lines of a text file.

    Cells are separated by semicolons, commas, tabs or blanks; ``#``, ``%`` and ``!`` begin comments. A comma is a
    decimal one where something else separates the cells; and in a single column, unless the numbers before it increase
    like times. `expected` describes the expected content in the message for a file without numbers.
    """
    heads: list[str] = []
    plain: list[tuple[int, str]] = []  # header lines that are not comments
    body: list[tuple[int, str]] = []
    for i, line in enumerate(lines, 1):
        content = re.split("[#%!]", line, maxsplit=1)[0].strip()
        if not body and (not content or not is_number_cell(re.split(r"[;,\s]", content, maxsplit=1)[0] or content)):
            heads.append(line.strip().lstrip("#%! \t"))
            plain.append((i, content))
        elif content:
            body.append((i, content))
    if not body:
        raise InputError(f"{file} holds no numbers: {expected}.")
    separator, commas = _cell_separator(body)
    rows: list[tuple[int, list[str]]] = []
    for i, content in body:
        cells = [cell.strip() for cell in content.split(separator)]
        if separator and cells[-1] == "":
            cells.pop()
        if rows and len(cells) != len(rows[0][1]):
            raise InputError(
                f"{file}, line {i}: expected {len(rows[0][1])} columns as in line {rows[0][0]}, but found {len(cells)}."
            )
        rows.append((i, [_with_decimal_point(file, i, cell) for cell in cells] if commas else cells))
    return NumericTable(_column_labels(file, heads, plain, separator, len(rows[0][1])), rows, heads)


def _cell_separator(body: list[tuple[int, str]]) -> tuple[str | None, bool]:
    """Return the character between cells (None for blanks), and whether decimals are marked by commas."""
    first = body[0][1]
    if ";" in first:
        return ";", any("," in content for _, content in body)
    if "," not in first:
        # A column of decimals may begin with whole numbers: 0, 0,01, 0,02.
        some = next((content for _, content in body if "," in content), None)
        return None, some is not None and all(_is_decimal_number(word) for word in some.split())
    words = first.split()
    if len(words) > 1 and all(map(_is_decimal_number, words)):
        return None, True
    if len(words) == 1 and _is_single_column(body):
        return None, True
    return ",", False


def _is_decimal_number(word: str) -> bool:
    return bool(COMMA.fullmatch(word) or DECIMAL.fullmatch(word))


def _is_single_column(body: list[tuple[int, str]]) -> bool:
    """Return whether the lines are one column with decimal commas, and not times and whole numbers apart by commas."""
    found = [COMMA.fullmatch(content) or DECIMAL.fullmatch(content) for _, content in body]
    if not all(found):
        return False
    times = [float(content.partition(",")[0] + ".0") if "," in content else float("nan") for _, content in body]
    return not all(later > earlier for earlier, later in pairwise(times))


def _with_decimal_point(file: Path, line: int, cell: str) -> str:
    if "," in cell and not COMMA.fullmatch(cell):
        parse_decimal(cell, file, line)
    if "." in cell:
        raise InputError(
            f"{file}, line {line}: {cell[:40]!r} has a decimal point, but other numbers have decimal commas. Write all "
            "of them in one way."
        )
    return cell.replace(",", ".")


def _column_labels(
    file: Path, heads: list[str], plain: list[tuple[int, str]], separator: str | None, n_columns: int
) -> list[str]:
    """Return the labels in the last header line that has as many as there are columns."""
    for i, content in plain:
        cells = _header_labels(content, separator)
        # A row of numbers with a typing error is not a header, and must not be skipped.
        if len(cells) == n_columns and any(re.match(r"[+-]?\.?\d", cell) for cell in cells):
            wrong = next((cell for cell in cells if not is_number_cell(cell) and not COMMA.fullmatch(cell)), None)
            if wrong is not None and not TIME_LABEL.match(wrong):
                parse_decimal(wrong, file, i)
    for head in reversed(heads):
        apart = [cell.strip().strip('"') for cell in head.split("\t")] if separator is None and "\t" in head else []
        labels = apart if len(apart) == n_columns else _header_labels(head, separator)
        if len(labels) == n_columns and any(re.search("[a-zA-Z]", label) for label in labels):
            return labels
    return []


def _header_labels(head: str, separator: str | None) -> list[str]:
    if separator is None:
        # There may be a blank between a label and its unit in brackets, and inside the unit.
        end = end_of_last_bracket(head)
        head = BRACKET.sub(lambda unit: unit[0].replace(" ", ""), head[:end]) + head[end:]
        head = re.sub(r"(?<!\s)\s++(?=[(\[])", "", head)
        return re.split(r"[;,\s]\s*", head)
    cells = [cell.strip().strip('"') for cell in head.split(separator)]
    return cells[:-1] if cells[-1] == "" else cells


def end_of_last_bracket(text: str) -> int:
    """Return the end of the last closing bracket, so that no regular expression searches beyond it in vain."""
    return max(text.rfind(")"), text.rfind("]")) + 1


def is_number_cell(token: str) -> bool:
    """Return whether a cell is a number, or a word for none such as nan."""
    return bool(DECIMAL.fullmatch(token)) or token.lower() in ("nan", "inf", "-inf")
