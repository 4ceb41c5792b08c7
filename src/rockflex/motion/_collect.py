"""Reading many files: which of them are tables about records, what the others hold, and why some cannot be read."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from rockflex._checks import positive
from rockflex._errors import InputError
from rockflex._files import path_of
from rockflex._shown import shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._peak import disagreement
from rockflex.motion._readers import parts_of
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._record_table import RecordTable, read_table, table_in
from rockflex.motion._text import read_content
from rockflex.motion._units import Unit, declared

Units = str | Mapping[str, str]
TABLES = (".csv", ".txt", ".tsv", ".xlsx", ".xlsm")


@dataclass(frozen=True)
class FileRead:
    """What a file holds: motions, by a path that is named after them; or a table about records; or why neither."""

    file: Path
    motions: Mapping[Path, GroundMotion] = field(default_factory=dict[Path, GroundMotion])
    fault: InputError | None = None
    table: RecordTable | None = None
    notes: Mapping[Path, str] = field(default_factory=dict[Path, str])


def collect(
    files: Iterable[Path],
    units: Units | None,
    dt: float | None,
    table: str | Path | None = None,
    *,
    foreign: bool = True,
) -> list[FileRead]:
    """Read files, in their order; those that cannot be read have a fault. `foreign` as in `parts_of`.

    Raises
    ------
    InputError
        If units or dt are not valid, or `table` is no table about records.
    """
    given = _given(units)
    step = None if dt is None else positive("dt", dt, "s")
    if table is not None:
        given = given.joined(read_table(path_of("table", table)))
    found: list[FileRead] = []
    for file in files:
        try:
            own = table_in(file, read_content(file)) if file.suffix.lower() in TABLES else None
            found.append(FileRead(file, table=own))
        except InputError as error:
            found.append(FileRead(file, fault=error))
    for each in found:
        if each.table is not None:
            given = given.joined(each.table)
    common = declared(units) if isinstance(units, str) else None
    return [
        each if each.table or each.fault else _read(each.file, given, common, step, foreign=foreign) for each in found
    ]


def _given(units: Units | None) -> RecordTable:
    """Return the units of files that a caller gives by their names."""
    if units is None or isinstance(units, str):
        return RecordTable()
    if not isinstance(units, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            "units must be a text such as 'g', or a dictionary of texts by file names, such as {'a*.txt': 'g'}, but "
            f"{shown(units)} was given.",
            field="units",
        )
    return RecordTable(units={str(name).casefold(): declared(unit) for name, unit in units.items()})


def _read(file: Path, given: RecordTable, common: Unit | None, dt: float | None, *, foreign: bool) -> FileRead:
    own = given.unit_of(file)
    step = given.step_of(file)
    try:
        found = parts_of(
            file, own or common, dt if step is None else step, foreign=foreign, common=own is None and step is None
        )
    except InputError as error:
        return FileRead(file, fault=error)
    motions: dict[Path, GroundMotion] = {}
    notes: dict[Path, str] = {}
    for motion in found:
        info = given.completed(file, motion.metadata or RecordInfo())
        whole = GroundMotion(motion.acceleration, motion.dt, motion.name, info, motion.vertical)
        key = file if motion.name == file.stem else file.parent / (motion.name.replace("/", "_") + file.suffix)
        motions[key] = whole
        notes[key] = disagreement(whole)[1]
    return FileRead(file, motions, notes=notes)
