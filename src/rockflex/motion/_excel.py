"""Records in the sheets of Excel workbooks, as columns of numbers."""

import io
import re
import warnings
import zipfile
from dataclasses import replace
from itertools import chain, pairwise
from pathlib import Path
from typing import Any

from rockflex._errors import InputError
from rockflex.motion import _text
from rockflex.motion._columns import parse_columns
from rockflex.motion._declared import Declared
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import unique_record_names

ZIP_MAGIC, OLD_EXCEL_MAGIC = b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
MAX_UNPACKED_BYTES = 100_000_000  # bytes of a workbook when unpacked
MAX_ROW_BYTES = 2_000_000  # bytes of a row, all of whose cells openpyxl makes before it gives the first
MAX_CELLS = 5_000_000  # cells of a workbook, also empty ones; every 20 characters in a cell count as one
ROW_EDGES = re.compile(rb"<(?:\w+:)?row\b|</(?:\w+:)?sheetData>")
INSTALL = "Install it: pip install 'rockflex[excel]', or save the sheet as CSV."


def is_excel_workbook(content: bytes) -> bool:
    """Return whether the bytes begin as an Excel workbook, or as another file in the same container (ZIP, OLE)."""
    return content.startswith((ZIP_MAGIC, OLD_EXCEL_MAGIC))


def parse_excel(file: Path, content: bytes, given: Declared) -> list[GroundMotion]:
    """Build the motions from all sheets of a workbook that hold rows of numbers, read as columns of text are."""
    tables = {
        name: table
        for name, cells in excel_sheet_cells(file, content).items()
        if (table := _table_in_excel_sheet(cells))
    }
    if not tables:
        raise InputError(f"{file} holds no numbers: a sheet is expected with columns of time and acceleration.")
    motions: list[GroundMotion] = []
    for sheet, table in tables.items():
        name = file.stem if len(tables) == 1 else f"{file.stem}-{sheet}"
        try:
            motions += parse_columns(file, table, given, name)
        except InputError as error:
            if len(tables) == 1:
                raise
            text = f"Sheet {sheet[:40]!r}: {error}"
            raise InputError(text, field=error.field) from error
    names = unique_record_names([motion.name for motion in motions])
    return [replace(motion, name=name) for motion, name in zip(motions, names, strict=True)]


def excel_sheet_cells(file: Path, content: bytes) -> dict[str, list[list[str]]]:
    """Return the cells of every sheet of a workbook as text, by its name."""
    if content.startswith(OLD_EXCEL_MAGIC):
        raise InputError(f"{file} is a workbook of the old format. Save it as .xlsx or CSV.")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            size = sum(each.file_size for each in archive.infolist())
            workbook = "xl/workbook.xml" in archive.namelist()
    except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
        raise InputError(f"{file} is a damaged archive or workbook. Download it again.") from error
    if not workbook:
        raise InputError(f"{file} is an archive, but no workbook. Unpack it, and give the files in it.")
    if size > MAX_UNPACKED_BYTES:
        raise InputError(
            f"{file} has {size / 1e6:.0f} MB when unpacked, above {MAX_UNPACKED_BYTES / 1e6:g} MB. Save it as CSV."
        )
    try:
        import openpyxl
    except ImportError as error:
        raise InputError(f"{file} is an Excel workbook, which needs openpyxl to be read. {INSTALL}") from error
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            if any(_longest_excel_row(archive.read(part)) > MAX_ROW_BYTES for part in archive.namelist()):
                raise InputError(
                    f"{file} has a row of more than {MAX_ROW_BYTES / 1e6:g} MB. Delete the cells beside the record."
                )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about styles and other extensions that do not matter here
            book: Any = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
            return _cells_of_open_workbook(file, book)
    except InputError:
        raise
    except Exception as error:  # damaged workbooks raise many kinds of errors
        raise InputError(f"{file} cannot be read as an Excel workbook: {str(error)[:200]}.") from error


def _longest_excel_row(part: bytes) -> int:
    """Return the bytes of the longest row in a part of a workbook; 0 if it is no sheet."""
    ends = (each.start() for each in ROW_EDGES.finditer(part)) if b"sheetData" in part else ()
    return max((after - before for before, after in pairwise(chain(ends, [len(part)]))), default=0)


def _cells_of_open_workbook(file: Path, book: Any) -> dict[str, list[list[str]]]:
    """Return the cells of the sheets of an open workbook; sheets whose few cells lie far apart are refused."""
    sheets: dict[str, list[list[str]]] = {}
    count, empty = 0, list[str]()
    for sheet in book.worksheets:
        sheet.reset_dimensions()  # a file may claim any, and each row would be filled up to them
        rows = sheets[str(sheet.title)] = list[list[str]]()
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


def _table_in_excel_sheet(cells: list[list[str]]) -> _text.NumericTable | None:
    """Return the rows of numbers in a sheet, without columns that are empty; None if there are none."""
    numbered = [(i, row) for i, row in enumerate(cells, 1)]
    begin = next((k for k, (_, row) in enumerate(numbered) if _is_numeric_row(row)), None)
    if begin is None:
        return None
    rows = [(i, row) for i, row in numbered[begin:] if any(row)]
    heads = [row for _, row in numbered[:begin] if any(row)]
    used = sorted({k for _, row in rows for k, cell in enumerate(row) if cell})

    def kept(row: list[str]) -> list[str]:
        return [row[k] if k < len(row) else "" for k in used]

    found = next((kept(row) for row in reversed(heads) if all(kept(row))), [])
    labels = found if any(not _text.DECIMAL.fullmatch(label) for label in found) else []
    above = [(i, " ".join(filter(None, row))) for i, row in enumerate(heads, 1)]
    return _text.NumericTable(labels, [(i, kept(row)) for i, row in rows], above)


def _is_numeric_row(row: list[str]) -> bool:
    """Return whether a row begins the numbers: its filled cells are all numbers."""
    filled = [cell for cell in row if cell]
    return bool(filled) and all(map(_text.is_number_cell, filled))
