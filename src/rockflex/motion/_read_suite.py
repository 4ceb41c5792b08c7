"""Reading many record files into a suite: which files are records, and which components are taken."""

import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from pathlib import Path
from typing import Literal, get_args

from rockflex.foundation.checks import checked_positive
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.foundation.files import checked_file_path
from rockflex.foundation.shown import first_texts_shown, number_with_noun, shown
from rockflex.motion._copies import duplicate_components, uncorrected_components
from rockflex.motion._declared import Declared
from rockflex.motion._findings import NoAccelerationError
from rockflex.motion._ground_motion import GroundMotion, is_vertical_component, record_info_of
from rockflex.motion._readers import components_in_file, stated_peak_mismatch
from rockflex.motion._record_files import fault_of_file, files_of_folder, record_files
from rockflex.motion._record_table import RecordTable, entry_for_file, read_record_table, record_table_in_content
from rockflex.motion._recordings import file_names_text, pair_vertical_records
from rockflex.motion._suite import Suite
from rockflex.motion._text import read_file_bytes
from rockflex.motion._units import AccelerationUnit, declared_acceleration_unit

UnitsArgument = str | Mapping[str, str]
TABLE_SUFFIXES = (".csv", ".txt", ".tsv", ".xlsx", ".xlsm")
OnError = Literal["raise", "skip"]
Vertical = Literal["pair"]
MAX_REPORTED = 10  # files whose errors are reported in full; beyond these only the names are listed
MAX_MESSAGE_LENGTH = 50_000  # most characters of a message that lists every file


@dataclass(frozen=True)
class RecordFileContent:
    """The content of a file: motions by paths named after them, or a table about records, or the error."""

    file: Path
    motions: Mapping[Path, GroundMotion] = field(default_factory=dict[Path, GroundMotion])
    fault: InputError | None = None
    table: RecordTable | None = None


def read_record_files(
    files: Iterable[Path],
    units: UnitsArgument | None,
    dt: float | None,
    table: str | Path | None = None,
    *,
    use_obspy: bool = True,
) -> list[RecordFileContent]:
    """Read files, in their order; files that cannot be read have a fault. `use_obspy` as in `components_in_file`."""
    given = _units_by_file_name(units)
    step = None if dt is None else checked_positive("dt", dt, "s")
    if table is not None:
        given = given.joined(read_record_table(checked_file_path("table", table)))
    found: list[RecordFileContent] = []
    for file in files:
        own = None
        try:
            if file.suffix.lower() in TABLE_SUFFIXES:
                own = record_table_in_content(file, read_file_bytes(file))
            found.append(RecordFileContent(file, table=own))
        except InputError as error:
            found.append(RecordFileContent(file, fault=fault_of_file(file, error)))
        given = given if own is None else given.joined(own)
    common = declared_acceleration_unit(units) if isinstance(units, str) else None
    return [
        each if each.table or each.fault else _read_record_file(each.file, given, common, step, use_obspy=use_obspy)
        for each in found
    ]


def _units_by_file_name(units: UnitsArgument | None) -> RecordTable:
    """Return the units of files that a caller gives by their names."""
    if units is None or isinstance(units, str):
        return RecordTable()
    if not isinstance(units, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            "units must be a text such as 'g', or a dictionary of texts by file names, such as {'a*.txt': 'g'}, but "
            f"{shown(units)} was given.",
            field="units",
        )
    return RecordTable(units={str(name).casefold(): declared_acceleration_unit(unit) for name, unit in units.items()})


def _read_record_file(
    file: Path, given: RecordTable, common: AccelerationUnit | None, dt: float | None, *, use_obspy: bool
) -> RecordFileContent:
    own, step = entry_for_file(given.units, file), entry_for_file(given.steps, file)
    for_many = own is None and step is None
    try:
        said = Declared(own or common, dt if step is None else step, common=for_many)
        found = components_in_file(file, said, use_obspy=use_obspy)
    except InputError as error:
        return RecordFileContent(file, fault=fault_of_file(file, error))
    motions: dict[Path, GroundMotion] = {}
    for motion in found:
        key = file if motion.name == file.stem else file.parent / (motion.name.replace("/", "_") + file.suffix)
        motions[key] = replace(motion, metadata=given.completed(file, record_info_of(motion)))
    return RecordFileContent(file, motions)


@dataclass(frozen=True)
class ChosenComponents:
    """Components by their paths: the horizontal ones that are taken, and the ones left out."""

    taken: Mapping[Path, GroundMotion]
    vertical: Sequence[Path]  # that belong to no horizontal component
    boreholes: Sequence[Path]  # beneath a station at the surface
    unpaired: Mapping[Path, str]  # why a record that is to be paired has no vertical component; empty if none was found
    paired: Sequence[Path]  # vertical components of horizontal ones
    copies: Mapping[Path, Path]  # the component that each one repeats
    uncorrected: Mapping[Path, Path]  # the corrected component that is taken for each one


def choose_components(found: Sequence[RecordFileContent], *, pair: bool) -> ChosenComponents:
    """Take the horizontal components, with the vertical ones if `pair`.

    Copies of other components are left out, uncorrected ones beside corrected ones, and boreholes beneath surface
    records.
    """
    motions = {path: motion for each in found for path, motion in each.motions.items()}
    files = {path: each.file for each in found for path in each.motions}
    copies = duplicate_components(motions, files)
    motions = {path: motion for path, motion in motions.items() if path not in copies}
    uncorrected = uncorrected_components(motions, files)
    motions = {path: motion for path, motion in motions.items() if path not in uncorrected}
    surface = {_site_key(motion) for motion in motions.values() if record_info_of(motion).location == "surface"}
    boreholes = [
        path
        for path, each in motions.items()
        if record_info_of(each).location == "borehole" and _site_key(each) in surface
    ]
    beneath = set(boreholes)
    motions = {path: motion for path, motion in motions.items() if path not in beneath}
    vertical = {path: motion for path, motion in motions.items() if is_vertical_component(motion)}
    taken = {path: motion for path, motion in motions.items() if path not in vertical}
    if not pair or not taken:
        return ChosenComponents(taken, list(vertical), boreholes, {}, [], copies, uncorrected)
    both, unpaired, left = pair_vertical_records(taken, vertical)
    paired = [path for path in vertical if path not in left]
    return ChosenComponents(both, left, boreholes, unpaired, paired, copies, uncorrected)


def _site_key(motion: GroundMotion) -> tuple[object, ...]:
    info = record_info_of(motion)
    return info.event, info.network, info.station


def read_suite(
    paths: str | Path | Iterable[str | Path],
    units: str | Mapping[str, str] | None = None,
    dt: float | None = None,
    on_error: OnError = "raise",
    vertical: Vertical | None = None,
    table: str | Path | None = None,
) -> Suite:
    """Read the horizontal components among record files into a suite, sorted by file name.

    The formats are those of `read_motion`. Of a file with several horizontal components, each becomes a motion. For a
    report of the files taken and left out, see `survey_records`.

    Tables about the records among the files fill in what headers do not say: PEER's ``_SearchResults.csv``, a flatfile
    of NGA, or a CSV file or workbook of one's own with a column ``file`` or ``RSN`` and any of ``units``, ``dt``,
    ``magnitude``, ``Rrup (km)``, ``Rjb (km)``, ``Vs30 (m/s)``, ``event``, ``year``, ``station``. In the column
    ``file``, ``*`` and ``?`` stand for other characters, for units and steps.

    A record that two files hold, under different names or in different formats, is taken once, from the file that says
    more of it: if the steps and the samples (50 and more) are the same within 0.1 % of the peak, unless record sequence
    numbers, azimuths or names (ABC000, ABC090) say that they are different components. Of an uncorrected and a
    corrected record of one component (CE36456.V1, CE36456.V2), the corrected one is taken.

    What is no record beside records is left out with a warning: velocities, displacements, spectra, texts and tables of
    something else. A record that cannot be read is an error.

    Vertical components, such as RSN953_NORTHR_MUL-UP.AT2, are left out, and a warning lists them; with
    ``vertical="pair"`` each horizontal component gets the vertical one of its station. The direction of a record is
    taken from its header or file name; see `RecordInfo.direction`.

    Parameters
    ----------
    paths : path or iterable of paths
        A directory, in which every file is read whose suffix is that of a record (.at2, .acc, .csv, .dat, .tsv, .txt,
        .xlsx, .mseed and the like, in any case), whose content begins as a file of a network (see `FORMATS`), or whose
        header names an acceleration above rows of numbers; or the files themselves.
    units, dt : optional
        As in `read_motion`, for files that do not state them. A dictionary gives the units of files by their names, in
        which ``*`` and ``?`` stand for other characters: ``{"lab-*.txt": "g", "old.csv": "cm/s2"}``.
    on_error : {"raise", "skip"}
        If files cannot be read: raise an error that lists all of them, or continue with the others and list them in a
        warning.
    vertical : {"pair"}, optional
        Pair the components of a station. They belong together if their file names, in one folder, differ only in the
        component (ABC090 or ABC-NS, and ABC-UP); else if they have the same record sequence number; else if their
        headers name the same event, year, network, station and location. Lengths and signs are as in
        `GroundMotion.with_vertical`. Records without a vertical component remain in the suite, and a warning lists
        them; leave them out with ``Suite(motion for motion in suite if motion.vertical is not None)``.
    table : path, optional
        A table about the records that is not among the files.

    Returns
    -------
    Suite
        The motions, named after their files without the suffix; the suite is named after the directory.

    Raises
    ------
    InputError
        If files cannot be read (see `read_motion`) and `on_error` is "raise", no file remains, a directory contains no
        record, or two files have the same name. With `vertical` also if no record has a vertical component, or one
        cannot be used, for example because its time step differs, and `on_error` is "raise".

    Warns
    -----
    RecordWarning
        If a vertical component, a borehole component beneath one at the surface (KiK-net), a copy of another record, an
        uncorrected one beside a corrected one, a file without an acceleration or one that cannot be read is left out; a
        file, archive or folder in the directory is not looked into; a record has no vertical component although
        `vertical` is "pair"; or a peak differs by 1 to 20 % from that in the header.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> np.savetxt("a.txt", [0.0, 0.1, 0.0])
    >>> np.savetxt("b.txt", [0.0, 0.2, 0.0])
    >>> rf.read_suite(["a.txt", "b.txt"], units="g", dt=0.01).names
    ('a', 'b')
    """
    folder = record_files(paths)
    found = read_components_by_file(folder.files, units, dt, on_error, vertical, table=table)
    for text in folder.remarks():
        warnings.warn(text, RecordWarning, stacklevel=2)
    return Suite((motion for motions in found.values() for motion in motions), folder.name)


def record_files_in_folder(folder: Path) -> list[Path]:
    """Return the record files of a directory, by suffix or by their beginning, sorted by name.

    Warns
    -----
    RecordWarning
        If something else lies in the folder, such as a folder or an archive.
    """
    found = files_of_folder(folder)
    for text in found.remarks():
        warnings.warn(text, RecordWarning, stacklevel=2)
    return found.files


def read_components_by_file(
    files: Sequence[Path],
    units: UnitsArgument | None,
    dt: float | None,
    on_error: OnError,
    vertical: Vertical | None = None,
    skip: str = 'on_error="skip"',
    table: str | Path | None = None,
) -> dict[Path, list[GroundMotion]]:
    """Return the horizontal components among record files by file; see `read_suite`.

    `skip` is the option that an error message suggests to continue with the other files.
    """
    if on_error not in get_args(OnError):
        raise InputError(f'on_error must be "raise" or "skip", but {shown(on_error)} was given.')
    check_vertical_option(vertical)
    found = read_record_files(files, units, dt, table)
    records = [each for each in found if each.table is None]
    if not records and found:
        raise InputError(
            f"{file_names_text(files)}: only tables about records were given, but no record. Give the records too."
        )
    others = {each.file: each.fault for each in records if isinstance(each.fault, NoAccelerationError)}
    faults = {each.file: each.fault for each in records if each.fault is not None and each.file not in others}
    none_left = len(faults) + len(others) == len(records)
    if faults:
        message = _unreadable_files_message({file: str(error) for file, error in faults.items()}, len(records))
        if on_error == "raise" or none_left:
            message += "" if none_left else f" {skip} continues with the other files."
            fields = [error.field for error in faults.values()]
            field = next((name for name in fields[:MAX_REPORTED] if name in ("units", "dt")), None)
            raise InputError(message, longest=MAX_MESSAGE_LENGTH, field=field)
        warnings.warn(f"Left out: {message}", RecordWarning, stacklevel=3)
    elif none_left and len(others) == 1:
        raise next(iter(others.values()))
    if others:
        what = first_texts_shown([f"{file.name} ({error.found})" for file, error in others.items()])
        without = f"{number_with_noun(len(others), 'file')} without an acceleration, {what}"
        if none_left:
            raise InputError(f"No record was given, only {without}. Give the files of the accelerations.")
        warnings.warn(f"Left out: {without}.", RecordWarning, stacklevel=3)
    for path, motion in (item for each in records for item in each.motions.items()):
        if note := stated_peak_mismatch(motion)[1]:
            warnings.warn(f"{path}: {note}.", RecordWarning, stacklevel=3)
    result = choose_components(records, pair=vertical is not None)
    for text in chain(_unpaired_records(result, on_error, skip), _left_out_components(result)):
        warnings.warn(text, RecordWarning, stacklevel=3)
    taken = {each.file: [result.taken[path] for path in each.motions if path in result.taken] for each in records}
    return {file: motions for file, motions in taken.items() if motions}


def check_vertical_option(vertical: object) -> None:
    """Raise an InputError unless `vertical` is "pair" or None."""
    if vertical not in (None, *get_args(Vertical)):
        raise InputError(
            f'vertical must be "pair" or None, but {shown(vertical)} was given. A file of its own is for one record: '
            "read_motion(path, vertical=...).",
            field="vertical",
        )


def _left_out_components(result: ChosenComponents) -> Iterator[str]:
    """Yield which components are left out, or raise an error if none is left."""
    if result.boreholes:
        count = number_with_noun(len(result.boreholes), "borehole component")
        yield f"Left out: {count} beneath records at the surface, {file_names_text(result.boreholes)}."
    if result.copies:
        names = first_texts_shown([f"{path.name} (of {kept.name})" for path, kept in result.copies.items()])
        yield f"Left out: {number_with_noun(len(result.copies), 'copy', 'copies')} of records in other files, {names}."
    if result.uncorrected:
        names = first_texts_shown([f"{path.name} (of {kept.name})" for path, kept in result.uncorrected.items()])
        count = number_with_noun(len(result.uncorrected), "uncorrected record")
        yield f"Left out: {count} beside corrected ones, {names}."
    names = ", ".join(path.name for path in result.vertical)
    components = number_with_noun(len(result.vertical), "vertical component")
    if result.vertical and not result.taken:
        raise InputError(
            f"No horizontal component was given, only {components}: {names}. Give horizontal ones; if a "
            "header or file name is wrong, correct it."
        )
    if result.vertical:
        yield f"Left out: {components}, {names}."


def _unpaired_records(result: ChosenComponents, on_error: OnError, skip: str) -> Iterator[str]:
    """Yield which records have no vertical component, or raise an error if there is none, or one does not fit."""
    both, without = result.taken, result.unpaired
    faults = {file: reason for file, reason in without.items() if reason}
    if faults:
        reasons = " ".join(f"{file.name}: {reason}" for file, reason in list(faults.items())[:MAX_REPORTED])
        message = f"{len(faults)} of {len(both)} records cannot be paired with a vertical component. {reasons}"
        if on_error == "raise":
            raise InputError(f"{message} {skip} keeps them without it.", longest=MAX_MESSAGE_LENGTH, field="vertical")
        yield message
    if without and len(without) == len(both) and not faults:
        first = next(iter(both)).name
        which = first if len(both) == 1 else f"any of the {len(both)} records, such as {first}"
        raise InputError(
            f"No vertical component was found for {which}. "
            "It is recognised by its header or the end of its name: ABC-UP.AT2 (or -V, -UD, -DWN) belongs to "
            "ABC090.AT2. Rename the files, or join them in Python: read_motion(path, vertical=...).",
            field="vertical",
        )
    missing = [file for file, reason in without.items() if not reason]
    if missing:
        yield f"Without a vertical component: {len(missing)} of {len(both)} records, {file_names_text(missing)}."


def _unreadable_files_message(faults: dict[Path, str], n_files: int) -> str:
    """List every file that cannot be read, with the errors of the first few."""
    shown, others = list(faults.values())[:MAX_REPORTED], [str(file) for file in list(faults)[MAX_REPORTED:]]
    message = " ".join(shown) if n_files == 1 else f"{len(faults)} of {n_files} files cannot be read. {' '.join(shown)}"
    return f"{message} The others: {', '.join(others)}." if others else message
