"""Text of record files: encodings, numbers, and tables of numbers."""

import csv
import re
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.motion._findings import NoAccelerationError
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._labels import parse_label
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._units import BRACKET, AccelerationUnit, end_of_last_bracket, parse_unit

MAX_HINTED = 40  # characters of a cell about which a hint is given
MAX_PEAK_G = 5.0  # in g; no recorded ground acceleration comes near it
# Possessive, like all of these patterns: a match is never retried in part, so no text takes long.
DECIMAL = re.compile(r"[+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[EeDd][+-]?+\d++)?+")
COMMA = re.compile(r"([+-]?+\d*+),\d++(?:[EeDd][+-]?+\d++)?+")  # a number with a decimal comma
TIME_LABEL = re.compile(r"(?:t|time|zeit|temps|tempo|tiempo)\b", re.IGNORECASE)
# Signs and blanks as word processors write them.
PLAIN_SIGNS = str.maketrans({"\u2212": "-", "\u00a0": " ", "\u2009": " ", "\u202f": " ", "\ufeff": None})
COMMENT_SIGN = re.compile(r"[#%!]")
COMMENT = re.compile(r"(?:(?<=[\s;,])|^)[#%!]")
ERROR_CELL = re.compile(
    r"#(?:N/A|NV|NA|DIV/0!|VALUE!|WERT!|VALOR!|VALEUR!|REF!|BEZUG!|NAME\?|NUM!|ZAHL!|NULL!|#)", re.IGNORECASE
)
PERCENT = re.compile(r"%[\s;,]*+")  # after a number, its unit
MISTYPED = re.compile(r"[OolI.,+-]*+\d[\dOolIxX.,+-]*+")  # a number with a letter in it
STATEMENT = re.compile(r"\w++\s*+[:=]")  # such as "units: g", whose words are no labels
QUOTED = re.compile(r'"[^"]*+"')
QUOTED_OR_WORD = re.compile(r'"[^"]*+"|[^\s"]++')
THOUSANDS = re.compile(r"(?<![\d.,])\d{1,3}(?:,\d{3})++\.\d")
EXPECTED_RECORD = "a record is expected as AT2, CSV or columns of text"


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
        text = text.rstrip("\x1a").translate(PLAIN_SIGNS)
        return None if re.search(r"[\x00-\x08\x0e-\x1b\x7f]", text) else text
    return None


def parse_decimal(token: str, file: str | Path, line: int) -> float:
    """Return a decimal number (also with a Fortran D exponent), or raise an error that names the line."""
    if DECIMAL.fullmatch(token):
        value = float(re.sub("[Dd]", "E", token))
        if np.isfinite(value):
            return value
    raise InputError(f"{file}, line {line}: expected a finite number, but found {token[:40]!r}.{_number_hint(token)}")


def _number_hint(token: str) -> str:
    """Return how to mend a cell that is no number."""
    if len(token) > MAX_HINTED:
        return ""
    if re.fullmatch(r"[+-]?\d+,\d+", token):
        return " Write decimals with a point."
    if THOUSANDS.match(token.lstrip("+-")):
        return " Write numbers without separators of thousands."
    if re.fullmatch(r"[+-]?\d*\.\d+[+-]\d{1,3}", token):
        return " It may have lost the E of its exponent: write it again."
    if not token or ERROR_CELL.match(token) or token.casefold() in ("nan", "na", "n/a", "null", "none", "-", "%"):
        return " A record without gaps is expected: fill the gap, or cut the record there."
    return ""


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


@dataclass(frozen=True)
class NumericTable:
    """Rows of cells, each with its line, under labels; and the lines before them, with their numbers."""

    labels: list[str]  # empty if there are none
    rows: list[tuple[int, list[str]]]
    head_lines: list[tuple[int, str]]
    gaps: tuple[int, ...] = ()  # lines without a number between rows
    label_lines: tuple[int, ...] = ()

    @property
    def heads(self) -> list[str]:
        """The lines before the rows, without comment signs."""
        return [text.strip().lstrip("#%! \t") for _, text in self.head_lines]


@dataclass(frozen=True)
class NumericLines:
    """The lines of a file from the first one that is all numbers on, without comments; and those before them."""

    head_lines: list[tuple[int, str]]
    body: list[tuple[int, str]]
    gaps: tuple[int, ...]


def split_numeric_lines(file: Path, lines: list[str], expected: str = EXPECTED_RECORD) -> NumericLines:
    """Return the lines of numbers in a text file, and the lines before them.

    `expected` describes the expected content in the message for a file without numbers.
    """
    heads: list[tuple[int, str]] = []
    body: list[tuple[int, str]] = []
    blank: list[int] = []
    for i, line in enumerate(lines, 1):
        content = _without_comment(line)
        if not body:
            if content and _begins_numbers(content):
                body.append((i, content))
            else:
                heads.append((i, line))
        elif content:
            body.append((i, content))
        else:
            blank.append(i)
    if not body:
        raise NoAccelerationError(f"{file} holds no numbers: {expected}.", found="no numbers")
    last = body[-1][0]
    return NumericLines(heads, body, tuple(line for line in blank if line < last))


def _without_comment(line: str) -> str:
    """Return a line without the comment that begins at a sign at its start or after a blank."""
    if not COMMENT_SIGN.search(line):
        return line.strip()
    for sign in COMMENT.finditer(line):
        # Errors such as #N/A are cells of a spreadsheet.
        if not ERROR_CELL.match(line, sign.start()) and not PERCENT.fullmatch(line, sign.start()):
            return line[: sign.start()].strip()
    return line.strip()


def _begins_numbers(content: str) -> bool:
    cells = [cell for cell in re.split(r"[;,\s]++", content.replace('"', " ")) if cell]
    return bool(cells) and is_number_cell(cells[0]) and all(map(is_number_cell, cells))


def parse_numeric_table(file: Path, lines: list[str], expected: str = EXPECTED_RECORD) -> NumericTable:
    """Return the rows of numbers in the lines of a text file.

    Cells are separated by semicolons, commas, tabs or blanks, and may stand in quotes; ``#``, ``%`` and ``!`` begin
    comments at the start of a line or after a blank. A comma is a decimal one where something else separates the cells;
    and in a single column, unless the numbers before it increase like times. `expected` as in `split_numeric_lines`.
    """
    return numeric_table(file, split_numeric_lines(file, lines, expected))


def numeric_table(file: Path, found: NumericLines) -> NumericTable:
    """Return the rows in the lines of numbers; see `parse_numeric_table`."""
    body = found.body
    separator, commas = _separator_of_quoted(body[0][1]) if '"' in body[0][1] else _cell_separator(body)
    rows: list[tuple[int, list[str]]] = []
    for i, content in body:
        cells = _cells(content, separator, len(rows[0][1]) if rows else 0)
        if rows and len(cells) != len(rows[0][1]):
            raise InputError(
                f"{file}, line {i}: expected {number_with_noun(len(rows[0][1]), 'column')} as in line {rows[0][0]}, "
                f"but found {len(cells)}. {_remedy_of_row(content)}"
            )
        rows.append((i, cells))
    if commas:
        rows = [(i, [_with_decimal_point(file, i, cell) for cell in cells]) for i, cells in rows]
    n_columns = len(rows[0][1])
    labels, label_lines = _column_labels(file, found.head_lines, separator, n_columns)
    if not labels and separator is None and n_columns > 1 and _counts_rows(rows):
        # Tables in print have no label above the numbers of their rows.
        labels, label_lines = _column_labels(file, found.head_lines, separator, n_columns - 1)
        labels = ["", *labels] if any(parse_label(label).kind == "acceleration" for label in labels) else []
    return NumericTable(labels, rows, found.head_lines, found.gaps, label_lines)


def _counts_rows(rows: list[tuple[int, list[str]]]) -> bool:
    first = rows[0][1][0]
    return first in ("0", "1") and all(cells[0] == str(int(first) + k) for k, (_, cells) in enumerate(rows))


def _separator_of_quoted(content: str) -> tuple[str | None, bool]:
    """Return the character between cells of which some stand in quotes, and whether decimals in these are commas."""
    between = QUOTED.sub("", content)
    return next((sign for sign in ";,\t" if sign in between), None), "," in "".join(QUOTED.findall(content))


def _remedy_of_row(content: str) -> str:
    """Return what may be wrong with a row that has another number of cells than the first."""
    if THOUSANDS.search(content):
        return "Write numbers without separators of thousands."
    if re.match(r"[A-Za-z#]", content):
        return "Keep one table in the file: delete the text below it, or save a second table on its own."
    return 'If the values follow each other in lines of any length, say so: layout="sequence".'


def _cells(content: str, separator: str | None, n_columns: int) -> list[str]:
    plain = '"' not in content
    cells = [cell.strip() for cell in content.split(separator)] if plain else _quoted_cells(content, separator)
    # A line may end in a separator; a cell of the first line's columns may be empty.
    if separator and len(cells) > max(n_columns, 1) and cells[-1] == "":
        cells.pop()
    return cells


def _quoted_cells(content: str, separator: str | None) -> list[str]:
    """Return cells of which some stand in quotes, within which a separator is none."""
    if separator is None:
        return [cell.strip('"') for cell in QUOTED_OR_WORD.findall(content)]
    try:
        row = next(csv.reader([content], delimiter=separator, skipinitialspace=True), [])
    except csv.Error:
        row = content.split(separator)
    return [cell.strip().strip('"').strip() for cell in row]


def _cell_separator(body: list[tuple[int, str]]) -> tuple[str | None, bool]:
    """Return the character between cells (None for blanks), and whether decimals are marked by commas."""
    first = body[0][1]
    if ";" in first:
        return ";", any("," in content and not THOUSANDS.search(content) for _, content in body)
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
    file: Path, head_lines: list[tuple[int, str]], separator: str | None, n_columns: int
) -> tuple[list[str], tuple[int, ...]]:
    """Return the labels in the last header line that has as many as there are columns, and its line.

    A line with a sentence may have as many words: above the last line, one of the labels must be known. Below the
    labels may stand a line with their units.
    """
    for i, line in head_lines:
        cells = _header_labels(_without_comment(line), separator)
        numbers = [is_number_cell(cell) or bool(COMMA.fullmatch(cell)) for cell in cells]
        # A row of numbers with a typing error is not a header, and must not be skipped.
        if len(cells) == n_columns and not all(numbers):
            wrong = cells[numbers.index(False)]
            if (2 * sum(numbers) >= len(cells) and numbers[0]) or MISTYPED.fullmatch(wrong):
                parse_decimal(wrong, file, i)
    units: list[str] = []
    units_line = ()
    filled = [(i, line.strip().lstrip("#%! \t")) for i, line in head_lines if line.strip()]
    for i, head in reversed(filled):
        apart = [cell.strip().strip('"') for cell in head.split("\t")] if separator is None and "\t" in head else []
        labels = apart if len(apart) == n_columns else _header_labels(head, separator)
        last = i == filled[-1][0] or bool(units)
        if len(labels) != n_columns or not any(re.search("[a-zA-Z]", label) for label in labels):
            continue
        if separator is None and n_columns > 1 and STATEMENT.match(head):
            continue
        if not last and not any(parse_label(label).kind in ("time", "acceleration") for label in labels):
            continue
        if not units and n_columns > 1 and all(map(parse_unit, labels)):
            units, units_line = labels, (i,)
            continue
        if units:
            labels = [f"{label} ({unit.strip('()[]')})" for label, unit in zip(labels, units, strict=True)]
        return labels, (i, *units_line)
    return units, units_line


def _header_labels(head: str, separator: str | None) -> list[str]:
    if separator is None:
        # There may be a blank between a label and its unit in brackets, and inside the unit.
        end = end_of_last_bracket(head)
        head = BRACKET.sub(lambda unit: unit[0].replace(" ", ""), head[:end]) + head[end:]
        head = re.sub(r"(?<!\s)\s++(?=[(\[])", "", head)
        return re.split(r"[;,\s]\s*", head)
    cells = [cell.strip().strip('"') for cell in head.split(separator)]
    return cells[:-1] if cells[-1] == "" else cells


def is_number_cell(token: str) -> bool:
    """Return whether a cell is a number, or a word for none such as nan."""
    return bool(DECIMAL.fullmatch(token)) or token.lower() in ("nan", "inf", "-inf")
