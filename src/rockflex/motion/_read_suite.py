"""Reading many record files into a suite."""

import warnings
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Literal, get_args

from rockflex._errors import InputError, RecordWarning
from rockflex._shown import counted, shown
from rockflex.motion._collect import Units, collect
from rockflex.motion._folder import files_of
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._pairs import named
from rockflex.motion._sorting import Sorted, sort_out
from rockflex.motion._suite import Suite

OnError = Literal["raise", "skip"]
Vertical = Literal["pair"]

REPORTED = 10  # files whose errors are reported in full; beyond these only the names are listed
NAMES = 50_000  # most characters of a message that lists every file


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
    report of what is taken, and what is not, see `survey_records`.

    Tables about the records among the files fill in what headers do not say: PEER's ``_SearchResults.csv``, a flatfile
    of NGA, or a CSV file or workbook of one's own with a column ``file`` or ``RSN`` and any of ``units``, ``dt``,
    ``magnitude``, ``Rrup (km)``, ``Rjb (km)``, ``Vs30 (m/s)``, ``event``, ``year``, ``station``. In the column
    ``file``, ``*`` and ``?`` stand for other characters, for units and steps.

    A record that two files hold, under different names or in different formats, is taken once, from the file that says
    more of it: if the steps and the samples (50 and more) are the same within 0.1 % of the peak, unless record sequence
    numbers, azimuths or names (ABC000, ABC090) say that they are different components.

    Vertical components, such as RSN953_NORTHR_MUL-UP.AT2, are left out, and a warning lists them; with
    ``vertical="pair"`` each horizontal component gets the vertical one of its station. The direction of a record is
    taken from its header or file name; see `RecordInfo.direction`.

    Parameters
    ----------
    paths : path or iterable of paths
        A directory, in which every file is read whose suffix is that of a record (.at2, .csv, .dat, .tsv, .txt, .xlsx,
        .mseed and the like, in any case) or whose content begins as a K-NET, ESM or COSMOS file; or the files
        themselves.
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
        If a vertical component, a borehole component beneath one at the surface (KiK-net), a copy of another record, or
        a file that cannot be read is left out, a record has no vertical component although `vertical` is "pair", or a
        peak differs by 1 to 20 % from that in the header.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> np.savetxt("a.txt", [0.0, 0.1, 0.0])
    >>> np.savetxt("b.txt", [0.0, 0.2, 0.0])
    >>> rf.read_suite(["a.txt", "b.txt"], units="g", dt=0.01).names
    ('a', 'b')
    """
    name, files = files_of(paths)
    found = read_files(files, units, dt, on_error, vertical, table=table)
    return Suite((motion for motions in found.values() for motion in motions), name)


def read_files(
    files: Sequence[Path],
    units: Units | None,
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
    check_vertical(vertical)
    found = collect(files, units, dt, table)
    records = [each for each in found if each.table is None]
    if not records and found:
        raise InputError(f"{named(files)}: only tables about records were given, but no record. Give the records too.")
    faults = {each.file: each.fault for each in records if each.fault is not None}
    if faults:
        message = _fault_message({file: str(error) for file, error in faults.items()}, len(records))
        if on_error == "raise" or len(faults) == len(records):
            message += f" {skip} continues with the other files." if len(faults) < len(records) else ""
            fields = [error.field for error in faults.values()]
            field = next((name for name in fields[:REPORTED] if name in ("units", "dt")), None)
            raise InputError(message, longest=NAMES, field=field)
        warnings.warn(f"Left out: {message}", RecordWarning, stacklevel=3)
    for note in (f"{path}: {note}." for each in records for path, note in each.notes.items() if note):
        warnings.warn(note, RecordWarning, stacklevel=3)
    result = sort_out(records, pair=vertical is not None)
    _tell_pairs(result, on_error, skip)
    _tell_left_out(result)
    taken: dict[Path, list[GroundMotion]] = {}
    for each in records:
        chosen = [result.taken[path] for path in each.motions if path in result.taken]
        if chosen:
            taken[each.file] = chosen
    return taken


def check_vertical(vertical: object) -> None:
    """Raise an InputError if `vertical` is not what `read_suite` takes."""
    if vertical not in (None, *get_args(Vertical)):
        raise InputError(
            f'vertical must be "pair" or None, but {shown(vertical)} was given. A file of its own is for one record: '
            "read_motion(path, vertical=...).",
            field="vertical",
        )


def _tell_left_out(result: Sorted) -> None:
    """Warn of components that are left out.

    Raises
    ------
    InputError
        If none is left.
    """
    if result.below:
        count = counted(len(result.below), "borehole component")
        warnings.warn(
            f"Left out: {count} beneath records at the surface, {named(result.below)}.", RecordWarning, stacklevel=4
        )
    if result.copies:
        first = [f"{path.name} (of {kept.name})" for path, kept in list(result.copies.items())[:REPORTED]]
        more = f" and {len(result.copies) - REPORTED} more" if len(result.copies) > REPORTED else ""
        count = counted(len(result.copies), "copy", "copies")
        warnings.warn(
            f"Left out: {count} of records in other files, {', '.join(first)}{more}.", RecordWarning, stacklevel=4
        )
    if not result.vertical:
        return
    names = ", ".join(path.name for path in result.vertical)
    components = counted(len(result.vertical), "vertical component")
    if not result.taken:
        raise InputError(
            f"No horizontal component was given, only {components}: {names}. Give horizontal ones; if a "
            "header or file name is wrong, correct it."
        )
    warnings.warn(f"Left out: {components}, {names}.", RecordWarning, stacklevel=4)


def _tell_pairs(result: Sorted, on_error: OnError, skip: str) -> None:
    """Warn of records without a vertical component.

    Raises
    ------
    InputError
        If a vertical component does not fit and `on_error` is "raise", or there is none for any record.
    """
    both, without = result.taken, result.without
    faults = {file: reason for file, reason in without.items() if reason}
    if faults:
        reasons = " ".join(f"{file.name}: {reason}" for file, reason in list(faults.items())[:REPORTED])
        message = f"{len(faults)} of {len(both)} records cannot be paired with a vertical component. {reasons}"
        if on_error == "raise":
            raise InputError(f"{message} {skip} keeps them without it.", longest=NAMES, field="vertical")
        warnings.warn(message, RecordWarning, stacklevel=4)
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
        count = f"{len(missing)} of {len(both)} records"
        warnings.warn(f"Without a vertical component: {count}, {named(missing)}.", RecordWarning, stacklevel=4)


def _fault_message(faults: dict[Path, str], n_files: int) -> str:
    """List every file that cannot be read, with the errors of the first few."""
    shown, others = list(faults.values())[:REPORTED], [str(file) for file in list(faults)[REPORTED:]]
    message = " ".join(shown) if n_files == 1 else f"{len(faults)} of {n_files} files cannot be read. {' '.join(shown)}"
    return f"{message} The others: {', '.join(others)}." if others else message
