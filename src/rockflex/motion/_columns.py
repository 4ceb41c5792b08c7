"""Records as columns of numbers in text files and Excel workbooks."""

import io
import re
import warnings
import zipfile
from dataclasses import dataclass, fields, replace
from itertools import chain, pairwise
from pathlib import Path
from typing import Any

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import number_with_noun, shown
from rockflex.motion import _text
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import (
    HORIZONTAL_NAME,
    VERTICAL_NAME,
    RecordInfo,
    component_azimuth,
    component_direction,
    is_horizontal_component_name,
    unique_record_names,
)

PREFIX = r"(?:acc[a-z]*+|a)[\s_.-]++"
VERTICAL_LABEL = re.compile(
    rf"(?:{PREFIX})?+(?:ver|vert|vertical|up|ud|u-d)(?![a-z])|(?:{PREFIX}|a)[vz](?![a-z])", re.IGNORECASE
)
# The letter a alone needs the name of a component: a_x, ax, a NS.
ACCELERATION_LABEL = re.compile(
    r"(?:acc|acel|beschl)[^\W\d_]*+\.?|"
    rf"a(?=(?:[xyz]|[\s_.-]++(?:[xyz]|{HORIZONTAL_NAME.pattern}|{VERTICAL_NAME.pattern}))(?!\w))",
    re.IGNORECASE,
)
STATED_UNIT = re.compile(r"\bunits?\s*+[:=]\s*+\(?([^\s,;()]++)", re.IGNORECASE)
STATED_STEP = re.compile(rf"\bdt\s*+[:=]\s*+({_text.DECIMAL.pattern})\s*+(?:s|sec|seconds)?+\s*+$", re.IGNORECASE)
REMEDY = 'Declare the unit of the file: units="m/s2" or units="cm/s2".'
ZIP_MAGIC, OLD_EXCEL_MAGIC = b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
MAX_UNPACKED_BYTES = 100_000_000  # bytes of a workbook when unpacked
MAX_ROW_BYTES = 2_000_000  # bytes of a row, all of whose cells openpyxl makes before it gives the first
MAX_CELLS = 5_000_000  # cells of a workbook, also empty ones; every 20 characters in a cell count as one
ROW_EDGES = re.compile(rb"<(?:\w+:)?row\b|</(?:\w+:)?sheetData>")
INSTALL = "Install it: pip install 'rockflex[excel]', or save the sheet as CSV."
RECORD_MARK = "Record of rockflex"
NOT_WRITTEN = ("source_format", "stated_pga")  # they are about the file that was read
FIELD_TYPES: dict[Any, type[int | float]] = {int | None: int, float | None: float}
RECORD_FIELDS = {
    each.name: FIELD_TYPES.get(each.type, str) for each in fields(RecordInfo) if each.name not in NOT_WRITTEN
}


@dataclass(frozen=True)
class ColumnRoles:
    """Indices of the columns of time (None if there is none), horizontal accelerations, and the vertical one."""

    time: int | None
    horizontal: tuple[int, ...]
    vertical: int | None


def parse_columns(
    file: Path, table: _text.NumericTable, units: _text.AccelerationUnit | None, dt: float | None, name: str
) -> list[GroundMotion]:
    """Build the motions from rows of numbers; of several accelerations, each is a motion, the vertical one too."""
    roles = _column_roles(file, table.labels, len(table.rows[0][1]))
    places = [*roles.horizontal, *([] if roles.vertical is None else [roles.vertical])]
    stated = {k: _column_unit(file, table, k, units) for k in places}
    values = {k: _column_samples(file, table, k) for k in places}
    step = _column_time_step(file, table, roles.time, dt)
    if len(roles.horizontal) == 1:
        (column,), vertical = roles.horizontal, roles.vertical
        alone = bool(table.labels) and VERTICAL_LABEL.match(table.labels[column])
        direction = "vertical" if alone else component_direction(file)
        info = RecordInfo(source=file.name, direction=direction, source_format="columns")
        info = record_info_in_csv(file, table.heads).completed(info)
        motion = _text.motion_from_samples(file, values[column], stated[column], step, info, REMEDY, name)
        if vertical is None:
            return [motion]
        upwards = _text.checked_acceleration_in_si(file, values[vertical], stated[vertical], REMEDY, info.scale)
        return [motion.with_vertical(upwards)]
    names = [_component_in_label(table.labels[k]) or str(k + 1) for k in places]
    motions: list[GroundMotion] = []
    for k, component, apart in zip(places, names, unique_record_names(names), strict=True):
        info = RecordInfo(
            source=file.name,
            component=component,
            direction="vertical" if k == roles.vertical else "horizontal",
            azimuth=None if k == roles.vertical else component_azimuth(component),
            source_format="columns",
        )
        motions.append(_text.motion_from_samples(file, values[k], stated[k], step, info, REMEDY, f"{name}-{apart}"))
    return motions


def _column_samples(file: Path, table: _text.NumericTable, k: int) -> Array:
    return np.array([_text.parse_decimal(cells[k], file, line) for line, cells in table.rows])


def _component_in_label(label: str) -> str:
    """Return the label without the words for acceleration and the unit: the name of the component."""
    end = _text.end_of_last_bracket(label)
    return ACCELERATION_LABEL.sub("", _text.BRACKET.sub("", label[:end]) + label[end:], 1).strip(" _-.")


def _column_roles(file: Path, labels: list[str], n_columns: int) -> ColumnRoles:
    """Return which columns are which."""
    times = [i for i, label in enumerate(labels) if _text.TIME_LABEL.match(label)]
    along, upwards = _component_columns(labels, times)
    if len(upwards) > 1:
        given = ", ".join(shown(labels[i]) for i in upwards)
        raise InputError(f"{file}: the header names {len(upwards)} columns as vertical, {given}. Keep one of them.")
    vertical = upwards[0] if upwards else None
    if len(along) == 1 and (len(times) == 1 or (n_columns == 2 and vertical is not None)):
        return ColumnRoles(times[0] if times else None, (along[0],), vertical)
    names = {_component_in_label(labels[i]) for i in along} - {""}
    if len(along) > 1 and len(times) <= 1 and len(names) == len(along):
        return ColumnRoles(times[0] if times else None, tuple(along), vertical)
    if n_columns <= 2:
        time = None if n_columns == 1 else 1 if times == [1] else 0
        column = 1 if time == 0 else 0
        if labels and re.match("vel|dis", labels[column], re.IGNORECASE):
            raise InputError(
                f"{file}: an acceleration is expected, but the column is labelled {shown(labels[column])}. "
                "Give the file of the acceleration."
            )
        return ColumnRoles(time, (column,), None)
    raise InputError(
        f"{file} has {n_columns} columns, and its header does not name one as time and at least one as "
        'acceleration ("time (s), acc (g), ..."). Keep the columns time and acceleration; a vertical one may be '
        'added as "vertical (g)", and further horizontal ones with names of their own, "acc NS (g), acc EW (g)".'
    )


def _component_columns(labels: list[str], times: list[int]) -> tuple[list[int], list[int]]:
    """Return the columns of horizontal and of vertical accelerations, as far as labels tell."""
    # Of two columns one is the time, unless the labels name two components.
    beside = len(labels) > 2 or (len(labels) == 2 and not times)
    upwards = [i for i, label in enumerate(labels) if VERTICAL_LABEL.match(label)] if beside else []
    others = [i for i in range(len(labels)) if i not in (*times, *upwards)]
    along = [i for i in others if ACCELERATION_LABEL.match(labels[i])]
    if along or not beside or (len(labels) == 2 and {"X", "Y"}.intersection(labels)):  # X and Y may be a curve
        return along, upwards
    names = {i: _component_in_label(labels[i]) for i in others}  # NS (gal), Z (gal)
    alone = [i for i, name in names.items() if name.upper() in ("Z", "V")]
    rest = [i for i in others if i not in alone]
    return (rest, [*upwards, *alone]) if all(is_horizontal_component_name(names[i]) for i in rest) else ([], upwards)


def _column_unit(
    file: Path, table: _text.NumericTable, k: int, units: _text.AccelerationUnit | None
) -> _text.AccelerationUnit:
    """Return the unit stated by the label, a line above it, or the caller; they must agree."""
    written, where = _bracket_in_label(table.labels[k]) if table.labels else "", "column header"
    if not written:
        found = next((each for head in table.heads if (each := STATED_UNIT.search(head[:500]))), None)
        written, where = (found[1] if found else ""), "header"
    name = _text.agreed_unit_name(file, where, written, None if units is None else str(units), "g, m/s2 or cm/s2")
    if units is not None:
        return units
    if name is not None:
        return _text.AccelerationUnit(name)
    raise InputError(
        f"{file} does not state the unit of its acceleration. Declare it: "
        'read_motion(path, units="g"), "m/s2" or "cm/s2"; or label the column "acc (g)".',
        field="units",
    )


def _column_time_step(file: Path, table: _text.NumericTable, column: int | None, dt: float | None) -> float:
    """Return the time step in s, from the column of times, the caller or the header."""
    if column is None:
        found = next((each for head in table.heads if (each := STATED_STEP.search(head[:500]))), None)
        stated = 0.0 if found is None else _text.parse_decimal(found[1], file, 1)
        if stated > 0.0 and dt not in (None, stated):
            raise InputError(
                f"{file} states DT = {stated:g} s, but dt={shown(dt)} was given. Leave dt out.", field="dt"
            )
        if stated > 0.0:
            return stated
        if dt is None:
            columns = "one column" if len(table.rows[0][1]) == 1 else f"{len(table.rows[0][1])} columns"
            raise InputError(
                f"{file} has {columns} and no times: give the sampling step, read_motion(path, dt=0.01).", field="dt"
            )
        return dt
    unit = _bracket_in_label(table.labels[column]) if table.labels else None
    if unit is not None and unit.strip().lower() not in _text.SECONDS:
        raise InputError(f"{file}: the times are in {shown(unit)}, but seconds are expected. Convert the column to s.")
    return _common_time_step(file, _column_samples(file, table, column), [line for line, _ in table.rows], dt)


def _common_time_step(file: Path, times: Array, lines: list[int], dt: float | None) -> float:
    """Return the common time step in s."""
    if times.size < 3:
        raise InputError(f"{file} has {number_with_noun(times.size, 'sample')}, but a record needs at least 3.")
    steps = np.diff(times)
    if np.any(steps <= 0):
        k = int(np.argmax(steps <= 0))
        raise InputError(
            f"{file}, line {lines[k + 1]}: time must increase, but it goes from {times[k]:g} s to "
            f"{times[k + 1]:g} s. The first of two columns is taken as the time."
        )
    if dt is not None:
        away = np.abs(times - times[0] - dt * np.arange(times.size)) >= 0.5 * dt
        if np.any(away):
            k = int(np.argmax(away))
            raise InputError(
                f"{file}, line {lines[k]}: the time {times[k]:g} s does not fit dt={shown(dt)} s. "
                "Leave dt out, or remove the column of times.",
                field="dt",
            )
        return dt
    uneven = np.abs(steps - steps[0]) > 1e-3 * steps[0]
    if np.any(uneven):
        k = int(np.argmax(uneven))
        raise InputError(
            f"{file}, line {lines[k + 1]}: the time step is {steps[k]:.6g} s, but {steps[0]:.6g} s before. "
            "Equal steps are expected: resample the record, for example with numpy.interp. If the printed times are "
            "only rounded, give the step: read_motion(path, dt=...).",
            field="dt",
        )
    # The mean is better than one printed difference; twelve digits remove the rounding of the subtraction.
    return float(f"{(times[-1] - times[0]) / (times.size - 1):.12g}")


def _bracket_in_label(label: str) -> str | None:
    bracket = _text.BRACKET.search(label, 0, _text.end_of_last_bracket(label))
    return bracket[1] if bracket else None


def is_excel_workbook(content: bytes) -> bool:
    """Return whether the bytes begin as an Excel workbook, or as another file in the same container (ZIP, OLE)."""
    return content.startswith((ZIP_MAGIC, OLD_EXCEL_MAGIC))


def parse_excel(
    file: Path, content: bytes, units: _text.AccelerationUnit | None, dt: float | None
) -> list[GroundMotion]:
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
            motions += parse_columns(file, table, units, dt, name)
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
    return _text.NumericTable(
        labels, [(i, kept(row)) for i, row in rows], [" ".join(filter(None, row)) for row in heads]
    )


def _is_numeric_row(row: list[str]) -> bool:
    """Return whether a row begins the numbers: its filled cells are all numbers."""
    filled = [cell for cell in row if cell]
    return bool(filled) and all(map(_text.is_number_cell, filled))


def record_csv(motion: GroundMotion) -> str:
    """Return a motion as the text of a CSV file, to the last bit, that `read_motion` reads with all that is known."""
    info = motion.metadata or RecordInfo()
    known = {name: value for name in RECORD_FIELDS if (value := getattr(info, name)) is not None}
    heads = [f"# {RECORD_MARK}", *(f"# {name}: {' '.join(str(value).split())}" for name, value in known.items())]
    columns = {"time (s)": motion.time, "acceleration (m/s2)": motion.acceleration}
    if motion.vertical is not None:
        columns["vertical (m/s2)"] = motion.vertical
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return "\n".join([*(heads if known else []), ",".join(columns), *(",".join(map(repr, row)) for row in rows), ""])


def record_info_in_csv(file: Path, heads: list[str]) -> RecordInfo:
    """Return the metadata in the first lines of a file that `record_csv` wrote; empty for other files."""
    found: dict[str, str | int | float] = {}
    lines = [head.strip("# ,;\t") for head in heads]  # as spreadsheets leave them
    for line, head in enumerate(lines if lines[:1] == [RECORD_MARK] else [], 1):
        name, _, text = (part.strip() for part in head.partition(":"))
        if name not in RECORD_FIELDS or not text:
            continue
        kind = RECORD_FIELDS[name]
        value = text if kind is str else _text.parse_optional_decimal(text)
        if value is None or value != kind(value):
            raise InputError(f"{file}, line {line}: {name} must be a number, but {shown(text)} was given.")
        found[name] = kind(value)
    if found.get("direction", "horizontal") not in ("horizontal", "vertical", "down"):
        raise InputError(
            f'{file}: direction must be "horizontal", "vertical" or "down", but {shown(found["direction"])} was given.'
        )
    return RecordInfo(**found)  # pyright: ignore[reportArgumentType]
