"""Tables about records: PEER's search results, the flatfiles of NGA and of ESM, and tables of one's own.

The columns of ESM's flatfile: Lanzano G et al. The pan-European Engineering Strong Motion (ESM) flatfile: compilation
criteria and data statistics. *Bull Earthq Eng* 2019;17(2):561–582.
"""

import csv
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TypeAlias, TypeVar

from rockflex.foundation.checks import checked_positive
from rockflex.foundation.errors import InputError
from rockflex.motion import _text
from rockflex.motion._excel import excel_sheets, is_excel_workbook
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._units import AccelerationUnit, declared_acceleration_unit

V = TypeVar("V")
Recording: TypeAlias = tuple[str, str | None, str]  # event, network and station

MAX_HEADER_LINE = 80  # lines before the header of the table; PEER's search results state their criteria first
# Labels of columns, reduced to letters and digits, by the field that they give.
LABELS = {
    "rsn": ("recordsequencenumber", "rsn"),
    "event": ("earthquakename", "eventname", "event"),
    "year": ("year",),
    "event_id": ("eventid",),
    "network": ("networkcode", "network"),
    "station": ("stationname", "stationcode", "station"),
    "magnitude": ("earthquakemagnitude", "magnitude", "mw", "m"),
    "distance_km": ("rrupkm", "rrup", "clstdkm", "closestdistancekm", "distancekm", "rupdist"),
    "distance_jb_km": ("rjbkm", "rjb", "joynerbooredistkm", "distancejbkm", "jbdist"),
    "epicentral_km": ("repikm", "repi", "epidkm", "epicentralkm", "epidist"),
    "vs30": ("vs30msec", "vs30ms", "vs30msselectedforanalysis", "preferredvs30ms", "vs30"),
    "units": ("units", "unit"),
    "dt": ("dt", "dts"),
}
FILE_LABELS = {
    "file": None,
    "filename": None,
    "horizontal1accfilename": "horizontal",
    "horizontal2accfilename": "horizontal",
    "verticalaccfilename": "vertical",
    "filenamehorizontal1": "horizontal",
    "filenamehorizontal2": "horizontal",
    "filenamevertical": "vertical",
}
# Where the first column has no value: the moment magnitude of EMEC, and Vs30 after Wald and Allen from the slope.
FALLBACK_LABELS = {"magnitude": "emecmw", "vs30": "vs30msecwa"}
NUMBER_FIELDS = ("magnitude", "distance_km", "distance_jb_km", "epicentral_km", "vs30")
TEXT_FIELDS = ("event", "station", "network", "event_id")


@dataclass(frozen=True)
class RecordTable:
    """Information about records from tables: by record sequence number, by file, and by event, network and station."""

    by_number: dict[int, RecordInfo] = field(default_factory=dict[int, RecordInfo])
    by_file: dict[str, RecordInfo] = field(default_factory=dict[str, RecordInfo])
    by_recording: dict[Recording, RecordInfo] = field(default_factory=dict[Recording, RecordInfo])
    units: dict[str, AccelerationUnit] = field(default_factory=dict[str, AccelerationUnit])
    steps: dict[str, float] = field(default_factory=dict[str, float])

    def joined(self, other: "RecordTable") -> "RecordTable":
        """Return both tables; this one prevails."""
        return RecordTable(*(getattr(other, each.name) | getattr(self, each.name) for each in fields(self)))

    def completed(self, file: Path, info: RecordInfo) -> RecordInfo:
        """Return the metadata of a record, with unknown fields taken from the tables."""
        rsn = info.rsn
        if rsn is None and (named := re.match(r"RSN(\d{1,9})(?!\d)", file.name, re.IGNORECASE)):
            rsn = int(named[1])
        found = self.by_file.get(file.name.casefold())
        if found is None and (recording := _recording_key(info)):
            found = self.by_recording.get(recording)
        if found is not None:
            info = info.completed(found)
        numbered = None if rsn is None else self.by_number.get(rsn)
        return info if numbered is None else info.completed(replace(numbered, direction=None))

    def missing(self, names: Iterable[str]) -> list[str]:
        """Return the files that the table lists, but are not among the names."""
        present = {name.casefold() for name in names}
        return [
            info.source or key
            for key, info in self.by_file.items()
            if key not in present and not any(mark in key for mark in "*?[")
        ]


def entry_for_file(by_name: Mapping[str, V], file: Path) -> V | None:
    """Return what a table states for a file, by its name or by a pattern."""
    name = file.name.casefold()
    if name in by_name:
        return by_name[name]
    return next((value for pattern, value in by_name.items() if fnmatchcase(name, pattern)), None)


def read_record_table(file: Path) -> RecordTable:
    """Read a table about records from a CSV file or a workbook."""
    found = record_table_in_content(file, _text.read_file_bytes(file))
    if found is None:
        raise InputError(
            f"{file} is no table about records: a header line is expected with a column of files or record sequence "
            "numbers (file, RSN), or columns of events and stations (event_id, station_code), and at least one of "
            "units, dt, magnitude, Rrup (km), Rjb (km), Vs30 (m/s)."
        )
    return found


def record_table_in_content(file: Path, content: bytes) -> RecordTable | None:
    """Return the table about records in the bytes of a file, or None if there is none."""
    if is_excel_workbook(content):
        sheets = (_record_table_from_rows(file, each.rows) for each in excel_sheets(file, content) if not each.hidden)
        return next((found for found in sheets if found is not None), None)
    lines = (_text.decoded_text(content) or "").splitlines()
    for head in lines[:MAX_HEADER_LINE]:
        separator = max(";,\t", key=head.count)
        if _record_table_columns(_record_table_cells(head, separator)) is not None:
            return _record_table_from_rows(file, (_record_table_cells(line, separator) for line in lines))
    return None


def _record_table_cells(line: str, separator: str) -> list[str]:
    try:
        row = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    except csv.Error:
        return []
    return [cell.strip() for cell in row]


def _record_table_columns(cells: list[str]) -> dict[int, str] | None:
    """Return the field that each column gives, by its index; None if the cells are no header of such a table."""
    plain = [re.sub(r"[^a-z0-9]", "", cell.casefold()) for cell in cells]
    found: dict[int, str] = {}
    for name, labels in LABELS.items():
        for label in labels:
            if label in plain:
                found[plain.index(label)] = name
                break
    files = {k: label for k, label in enumerate(plain) if label in FILE_LABELS}
    names = set(found.values())
    keyed = bool(files) or "rsn" in names or {"event_id", "station"} <= names
    if not keyed or not names - {"rsn", "event", "event_id", "network", "station", "year"}:
        return None
    if "units" not in names:  # steps are given beside units only
        found = {k: name for k, name in found.items() if name != "dt"}
    return found | files | {plain.index(label): label for label in FALLBACK_LABELS.values() if label in plain}


def _record_table_from_rows(file: Path, rows: Iterable[list[str]]) -> RecordTable | None:
    """Return the table under the first header, down to the first row that is empty."""
    columns: dict[int, str] | None = None
    table = RecordTable()
    for line, cells in enumerate(rows, 1):
        if columns is None:
            columns = _record_table_columns(cells) if line <= MAX_HEADER_LINE else None
            continue
        if not any(cells):
            break
        stated = {name: cells[k] for k, name in columns.items() if k < len(cells) and cells[k]}
        info = _record_info_of_row(stated)
        if info.rsn is not None:
            table.by_number.setdefault(info.rsn, info)
        if recording := _recording_key(info):
            table.by_recording.setdefault(recording, info)
        try:
            _add_files_of_row(table, stated, info)
        except InputError as error:
            raise InputError(f"{file}, line {line}: {error}", field=error.field) from error
    return None if columns is None else table


def _add_files_of_row(table: RecordTable, stated: Mapping[str, str], info: RecordInfo) -> None:
    for label, direction in FILE_LABELS.items():
        # Flatfiles give folders too, with either slash; search results write ----- for no file.
        whole = re.split(r"[\\/]", stated.get(label, ""))[-1]
        name = whole.casefold()
        if not name.strip("- "):
            continue
        table.by_file.setdefault(name, replace(info, direction=direction, source=whole))  # pyright: ignore[reportArgumentType]
        if "units" in stated:
            table.units.setdefault(name, declared_acceleration_unit(stated["units"]))
        if "dt" in stated:
            step = _record_table_number(stated["dt"]) or 0.0
            table.steps.setdefault(name, checked_positive("dt", step, "s"))


def _recording_key(info: RecordInfo) -> Recording | None:
    return None if info.event_id is None or info.station is None else (info.event_id, info.network, info.station)


def _record_table_number(text: str) -> float | None:
    return _text.parse_optional_decimal(text.replace(",", "."))


def _record_info_of_row(stated: Mapping[str, str]) -> RecordInfo:
    texts = {name: stated.get(name) or stated.get(FALLBACK_LABELS.get(name, ""), "") for name in NUMBER_FIELDS}
    numbers = {name: _text.non_negative_or_none(_record_table_number(text)) for name, text in texts.items()}
    whole = {name: _text.non_negative_or_none(_record_table_number(stated.get(name, ""))) for name in ("rsn", "year")}
    # PEER writes underscores for commas.
    words = {
        name: stated[name].replace("_ ", ", ") for name in TEXT_FIELDS if stated.get(name, "-") not in ("-", "-999")
    }
    return RecordInfo(
        **numbers,  # pyright: ignore[reportArgumentType]
        **{name: None if value is None else int(value) for name, value in whole.items()},  # pyright: ignore[reportArgumentType]
        **words,  # pyright: ignore[reportArgumentType]
    )
