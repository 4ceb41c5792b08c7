"""Records in the sheets of Excel workbooks, as columns of numbers."""

import io
import re
import warnings
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import chain, pairwise
from pathlib import Path
from typing import Any

import numpy as np

from rockflex.foundation.archives import ArchiveError, ArchiveLimits, archive_bytes, open_archive
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.foundation.shown import first_texts_shown
from rockflex.motion import _text
from rockflex.motion._columns import parse_columns
from rockflex.motion._declared import Declared
from rockflex.motion._findings import NoAccelerationError
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import unique_record_names
from rockflex.motion._record_signs import is_table_of_something_else

ZIP_MAGIC, OLD_EXCEL_MAGIC = b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
MAX_UNPACKED_BYTES = 100_000_000  # bytes of a workbook when unpacked
MAX_MEMBERS = 5_000  # files in it
MAX_ROW_BYTES = 2_000_000  # bytes of a row, all of whose cells openpyxl makes before it gives the first
MAX_CELLS = 5_000_000  # cells of a workbook, also empty ones; every 20 characters in a cell count as one
ROW_EDGES = re.compile(rb"<(?:\w+:)?row\b|</(?:\w+:)?sheetData>")
MAX_COLUMNS = 16384  # of a sheet
MAX_TAG_BYTES = 400  # on either side of an attribute
HIDDEN = re.compile(rb'\bhidden="(?:1|true)"')
HIDDEN_TAG = re.compile(rb"<(?:\w++:)?+(row|col)\b")
ATTRIBUTE = re.compile(rb'\b(min|max|r)="[A-Z]*+(\d{1,9}+)"')
# A formula that is all there is in its cell, and the end of the cell.
VALUELESS_FORMULA = re.compile(
    rb"<(?:\w++:)?+f\b[^>]{0,400}+>(?:(?<=/>)|[^<]*+</(?:\w++:)?+f>)\s*+"
    rb"(?:<(?:\w++:)?+v\s*+/>|<(?:\w++:)?+v></(?:\w++:)?+v>)?+\s*+</(?:\w++:)?+c>"
)
ERROR_CELL = re.compile(r"#[A-Z][A-Z0-9/_]*+[!?]?+")  # #N/A, #DIV/0!, #NAME?
DATE = re.compile(r"\d{4}-\d\d-\d\d|\d++:\d\d:\d\d|\d++ days?,")  # as openpyxl writes them
INSTALL = "Install it: pip install 'rockflex[excel]', or save the sheet as CSV."


def is_excel_workbook(content: bytes) -> bool:
    """Return whether the bytes begin as an Excel workbook, or as another file in the same container (ZIP, OLE)."""
    return content.startswith((ZIP_MAGIC, OLD_EXCEL_MAGIC))


@dataclass(frozen=True)
class ExcelSheet:
    """A sheet of a workbook as text, from its first row and column, and what of it a reader of the workbook sees."""

    title: str
    rows: list[list[str]]
    hidden: bool
    hidden_rows: frozenset[int]  # counted from one, as Excel does
    hidden_columns: frozenset[int]  # counted from zero
    uncalculated_rows: frozenset[int]  # those with a formula whose value is not stored


def parse_excel(file: Path, content: bytes, given: Declared) -> list[GroundMotion]:
    """Build the motions from all sheets of a workbook that hold rows of numbers, read as columns of text are.

    What is hidden is left out, and so are sheets beside a record that hold something else; a warning names them.
    """
    sheets = excel_sheets(file, content)
    left = [f"hidden sheet {_named(each)}" for each in sheets if each.hidden and _first_numeric_row(each.rows)]
    sheets = [each for each in sheets if not each.hidden]
    found: dict[str, list[GroundMotion]] = {}
    others: list[InputError] = []
    for sheet in sheets:
        try:
            table = _table_in_excel_sheet(file, sheet)
            if table is None:
                continue
            try:
                found[sheet.title] = parse_columns(file, table, given, f"{file.stem}-{sheet.title}")
            except InputError as error:
                if not is_table_of_something_else(file, table):
                    raise
                raise NoAccelerationError(str(error), found="table", field=error.field) from error
            left += [f"hidden column {_letters(k)} of sheet {_named(sheet)}" for k in _hidden_numbers(sheet)]
        except NoAccelerationError as error:
            left.append(f"sheet {_named(sheet)} ({error.found})")
            others.append(error)
        except InputError as error:
            if len(sheets) == 1:
                raise
            raise InputError(f"Sheet {_named(sheet)}: {error}", field=error.field) from error
    if not found and others:
        raise others[0]
    if not found:
        raise NoAccelerationError(
            f"{file} holds no numbers: a sheet is expected with columns of time and acceleration."
            + f" Left out: {first_texts_shown(left)}; unhide what holds a record." * bool(left),
            found="no numbers",
        )
    if left:
        warnings.warn(f"{file.name}: left out {first_texts_shown(left)}.", RecordWarning, stacklevel=2)
    if len(found) == 1:
        ((title, motions),) = found.items()
        long = len(f"{file.stem}-{title}")
        return [replace(motion, name=file.stem + motion.name[long:]) for motion in motions]
    everything = [motion for motions in found.values() for motion in motions]
    names = unique_record_names([motion.name for motion in everything])
    return [replace(motion, name=name) for motion, name in zip(everything, names, strict=True)]


def _named(sheet: ExcelSheet) -> str:
    return repr(sheet.title[:40])


def _hidden_numbers(sheet: ExcelSheet) -> list[int]:
    """Return the hidden columns that hold numbers."""
    cells = (each for row in sheet.rows for each in enumerate(row) if sheet.hidden_columns)
    return sorted({k for k, cell in cells if k in sheet.hidden_columns and _text.is_number_cell(cell)})


def excel_sheets(file: Path, content: bytes) -> list[ExcelSheet]:
    """Return the sheets of a workbook, also hidden ones."""
    if content.startswith(OLD_EXCEL_MAGIC):
        raise InputError(f"{file} is a workbook of the old format. Save it as .xlsx or CSV.")
    try:
        with open_archive(content, ArchiveLimits(MAX_MEMBERS, MAX_UNPACKED_BYTES, MAX_UNPACKED_BYTES)) as archive:
            if not any(each.filename == "xl/workbook.xml" for each in archive.entries):
                raise InputError(f"{file} is an archive, but no workbook. Unpack it, and give the files in it.")
            members = archive.contents()
    except ArchiveError as error:
        if error.kind == "size":
            raise InputError(f"{file} {error}. Save it as CSV.") from error
        raise InputError(f"{file} is a damaged archive or workbook. Download it again.") from error
    try:
        import openpyxl
    except ImportError as error:
        raise InputError(f"{file} is an Excel workbook, which needs openpyxl to be read. {INSTALL}") from error
    try:
        parts = {name: _sheet_part(part) for name, part in members.items()}
        if any(part.longest_row > MAX_ROW_BYTES for part in parts.values()):
            raise InputError(
                f"{file} has a row of more than {MAX_ROW_BYTES / 1e6:g} MB. Delete the cells beside the record."
            )
        # What was counted, and not what else may be packed: openpyxl unpacks all of it.
        counted = archive_bytes(members, zipfile.ZIP_STORED)
        del members
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about styles and other extensions that do not matter here
            book: Any = openpyxl.load_workbook(io.BytesIO(counted), read_only=True, data_only=True)
            return _sheets_of_open_workbook(file, book, parts)
    except InputError:
        raise
    except Exception as error:  # damaged workbooks raise many kinds of errors
        raise InputError(f"{file} cannot be read as an Excel workbook: {str(error)[:200]}.") from error


@dataclass(frozen=True)
class SheetPart:
    """The part of a sheet's XML that openpyxl does not tell of a workbook that is read row by row."""

    longest_row: int  # bytes
    hidden_rows: frozenset[int]
    hidden_columns: frozenset[int]
    uncalculated_rows: frozenset[int]


def _sheet_part(part: bytes) -> SheetPart:
    """Return the facts of a part of a workbook; none if it is no sheet."""
    if b"sheetData" not in part:
        return SheetPart(0, frozenset(), frozenset(), frozenset())
    ends = (each.start() for each in ROW_EDGES.finditer(part))
    longest = max((after - before for before, after in pairwise(chain(ends, [len(part)]))), default=0)
    tags = [_tag_around(part, each.start()) for each in HIDDEN.finditer(part)]
    hidden = [(found[1], _attributes(tag)) for tag in tags if (found := HIDDEN_TAG.match(tag))]
    rows = (each.get("r", 0) for name, each in hidden if name == b"row")
    spans = (each for name, each in hidden if name == b"col")
    columns = np.zeros(MAX_COLUMNS, dtype=np.bool_)
    for each in spans:
        columns[max(each.get("min", 1) - 1, 0) : each.get("max", 0)] = True
    cells = (part[part.rfind(b"<", 0, each.start()) : each.start()] for each in VALUELESS_FORMULA.finditer(part))
    return SheetPart(
        longest,
        frozenset(rows),
        frozenset(np.flatnonzero(columns).tolist()),
        # A text that is empty is a value.
        frozenset(_attributes(cell).get("r", 0) for cell in cells if b't="str"' not in cell),
    )


def _tag_around(part: bytes, place: int) -> bytes:
    begin = part.rfind(b"<", max(0, place - MAX_TAG_BYTES), place)
    return b"" if begin < 0 else part[begin : place + MAX_TAG_BYTES].partition(b">")[0]


def _attributes(tag: bytes) -> dict[str, int]:
    """Return the whole numbers in a tag by the names of their attributes; of a cell such as B7 that of the row."""
    return {each[1].decode(): int(each[2]) for each in ATTRIBUTE.finditer(tag)}


def _sheets_of_open_workbook(file: Path, book: Any, parts: Mapping[str, SheetPart]) -> list[ExcelSheet]:
    """Return the sheets of an open workbook; those whose few cells lie far apart are refused."""
    sheets: list[ExcelSheet] = []
    count, empty = 0, list[str]()
    for sheet in book.worksheets:
        sheet.reset_dimensions()  # a file may claim any, and each row would be filled up to them
        part, rows = parts[sheet._worksheet_path], list[list[str]]()
        hidden = sheet.sheet_state != "visible"
        sheets.append(
            ExcelSheet(str(sheet.title), rows, hidden, part.hidden_rows, part.hidden_columns, part.uncalculated_rows)
        )
        for row in sheet.iter_rows(values_only=True):
            cells = [""] * len(row)
            for k, cell in enumerate(row):
                cells[k] = _excel_cell_text(cell)
                count += 1 + len(cells[k]) // 20
                if count > MAX_CELLS:
                    break
            count += not cells
            if count > MAX_CELLS:
                raise InputError(
                    f"{file}: more than {MAX_CELLS / 1e6:g} million cells lie before its last filled ones, with the "
                    "empty ones between them. Delete the cells far from the record, or save the sheet as CSV."
                )
            rows.append(cells if any(cells) else empty)
    return sheets


def _excel_cell_text(cell: object) -> str:
    if isinstance(cell, float | int) and not isinstance(cell, bool):
        return repr(float(cell))
    return "" if cell is None else str(cell).strip()


def _table_in_excel_sheet(file: Path, sheet: ExcelSheet) -> _text.NumericTable | None:
    """Return the rows of numbers in a sheet, without columns that are empty or hidden; None if there are none."""
    seen = [
        ["" if k in sheet.hidden_columns else cell for k, cell in enumerate(row)] if sheet.hidden_columns else row
        for row in sheet.rows
    ]
    begin = _first_numeric_row(seen)
    _check_no_dates(file, seen)
    valueless = [row for row in sheet.uncalculated_rows if begin is None or row >= begin]
    if valueless:
        raise InputError(
            f"{file}, row {min(valueless)}: a formula has no stored value. Open the workbook in Excel or LibreOffice "
            "and save it, which stores the values; or replace the formulas by their values."
        )
    if begin is None:
        return None
    numbered = list(enumerate(seen, 1))
    heads = [(i, row) for i, row in numbered[: begin - 1] if any(row)]
    body = [(i, row) for i, row in numbered[begin - 1 :] if any(row)]
    used = sorted({k for _, row in body for k, cell in enumerate(row) if _text.is_number_cell(cell)})
    _check_row_above(file, heads)
    _check_body(file, sheet, body, used)

    def kept(row: list[str]) -> list[str]:
        return [row[k] if k < len(row) else "" for k in used]

    found = next((kept(row) for _, row in reversed(heads) if all(kept(row))), [])
    labels = found if any(not _text.DECIMAL.fullmatch(label) for label in found) else []
    above = [(i, " ".join(filter(None, row))) for i, row in heads]
    return _text.NumericTable(labels, [(i, kept(row)) for i, row in body], above)


def _first_numeric_row(rows: list[list[str]]) -> int | None:
    """Return the row in which the numbers begin, counted from one."""
    return next((i for i, row in enumerate(rows, 1) if _is_numeric_row(row)), None)


def _is_numeric_row(row: list[str]) -> bool:
    """Return whether the filled cells of a row are all numbers, and there are any."""
    filled = [cell for cell in row if cell]
    return bool(filled) and all(map(_text.is_number_cell, filled))


def _check_no_dates(file: Path, rows: list[list[str]]) -> None:
    """Refuse dates in the place of times: two rows that begin with one, and numbers beside it."""
    before = False
    for i, row in enumerate(rows, 1):
        first, *rest = [*filter(None, row), ""]
        dated = bool(DATE.match(first)) and any(map(_text.is_number_cell, rest))
        if dated and before:
            raise InputError(
                f"{file}, row {i}: the first column holds dates or times of day, such as {first[:40]!r}, but times "
                "in s are expected. Delete that column, and give the step: read_motion(path, dt=0.01).",
                field="dt",
            )
        before = dated


def _check_row_above(file: Path, heads: list[tuple[int, list[str]]]) -> None:
    """Refuse a row above the numbers that seems to be one of them, because it begins with a number."""
    if not heads:
        return
    i, row = heads[-1]
    cells = [cell for cell in row if cell]
    wrong = next((cell for cell in cells if not _text.is_number_cell(cell)), None)
    if wrong is not None and (_text.is_number_cell(cells[0]) or ERROR_CELL.fullmatch(wrong)):
        raise _no_number(file, i, wrong)


def _no_number(file: Path, i: int, cell: str) -> InputError:
    what = "an error of a formula" if ERROR_CELL.fullmatch(cell) else "no number"
    return InputError(f"{file}, row {i}: {cell[:40]!r} is {what}. Correct the cell, or delete the row.")


def _check_body(file: Path, sheet: ExcelSheet, body: list[tuple[int, list[str]]], used: list[int]) -> None:
    """Refuse rows of numbers that are hidden, have an empty cell or one without a number, or are two blocks."""
    rows = [(i, [row[k] if k < len(row) else "" for k in used]) for i, row in body]
    above = rows[0][0] - 1
    for i, cells in rows:
        if i == above + 1 and i not in sheet.hidden_rows and all(map(_text.is_number_cell, cells)):
            above = i
            continue
        apart = i > above + 1 or not any(map(_text.is_number_cell, cells))
        if apart and any(k >= i and any(map(_text.is_number_cell, later)) for k, later in rows):
            raise InputError(
                f"{file}, row {i}: a second block of numbers begins here. Put each block on a sheet of its own; if "
                "they are one record, delete the rows between them."
            )
        wrong = next((cell for cell in cells if cell and not _text.is_number_cell(cell)), None)
        if wrong is not None:
            raise _no_number(file, i, wrong)
        if "" in cells:
            raise InputError(
                f"{file}, row {i}: column {_letters(used[cells.index('')])} has no value, but one in each row is "
                "expected. Complete or delete the row; of two tables side by side, put each on a sheet of its own."
            )
        raise InputError(f"{file}, row {i} is hidden among the numbers. Unhide it, or delete it.")


def _letters(k: int) -> str:
    """Return the name of a column, counted from zero, as Excel writes it: A, ..., Z, AA, ..."""
    return (_letters(k // 26 - 1) if k >= 26 else "") + chr(ord("A") + k % 26)
