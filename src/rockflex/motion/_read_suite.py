"""Reading many record files into a suite."""

import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Literal, get_args

from rockflex._errors import InputError, RecordWarning
from rockflex._files import path_of
from rockflex._shown import shown
from rockflex.motion._direction import is_vertical
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._pairs import named, paired
from rockflex.motion._readers import read_motion
from rockflex.motion._suite import Suite

OnError = Literal["raise", "skip"]
Vertical = Literal["pair"]

SUFFIXES = (".at2", ".csv", ".dat", ".tsv", ".txt")
REPORTED = 10  # files whose errors are reported in full; beyond these only the names are listed
NAMES = 50_000  # most characters of a message that lists every file


def read_suite(
    paths: str | Path | Iterable[str | Path],
    units: str | None = None,
    dt: float | None = None,
    on_error: OnError = "raise",
    vertical: Vertical | None = None,
) -> Suite:
    """Read the horizontal components among record files into a suite, sorted by file name.

    Vertical components, such as RSN953_NORTHR_MUL-UP.AT2, are left out, and a warning lists them; with
    ``vertical="pair"`` each horizontal component gets the vertical one of its station. The direction of a record is
    taken from its header or file name; see `RecordInfo.direction`.

    Parameters
    ----------
    paths : path or iterable of paths
        A directory, in which every file with the suffix .at2, .csv, .dat, .tsv or .txt (in any case) is read,
        or the files themselves.
    units, dt : optional
        As in `read_motion`, for files that do not state them.
    on_error : {"raise", "skip"}
        If files cannot be read: raise an error that lists all of them, or continue with the others and list them in a
        warning.
    vertical : {"pair"}, optional
        Pair the components of a station. They belong together if their file names, in one folder, differ only in the
        component (ABC090 or ABC-NS, and ABC-UP); else if they have the same record sequence number; else if their
        headers name the same event, year and station. Lengths and signs are as in `GroundMotion.with_vertical`. Records
        without a vertical component remain in the suite, and a warning lists them; leave them out with
        ``Suite(motion for motion in suite if motion.vertical is not None)``.

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
        If a vertical component, or a file that cannot be read, is left out, or a record has no vertical component
        although `vertical` is "pair".

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> np.savetxt("a.txt", [0.0, 0.1, 0.0])
    >>> np.savetxt("b.txt", [0.0, 0.2, 0.0])
    >>> rf.read_suite(["a.txt", "b.txt"], units="g", dt=0.01).names
    ('a', 'b')
    """
    if isinstance(paths, str | Path):
        name, files = _folder(path_of("paths", paths))
    elif isinstance(paths, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
        name, files = "", [path_of("paths", path) for path in paths]
    else:
        raise InputError(f"paths must be a directory or a sequence of files, but {type(paths).__name__} was given.")
    files.sort(key=lambda file: (file.name, str(file)))
    return Suite(read_files(files, units, dt, on_error, vertical).values(), name)


def read_files(
    files: Sequence[Path],
    units: str | None,
    dt: float | None,
    on_error: OnError,
    vertical: Vertical | None = None,
    skip: str = 'on_error="skip"',
) -> dict[Path, GroundMotion]:
    """Return the horizontal components among record files by file; see `read_suite`.

    `skip` is the option that an error message suggests to continue with the other files.
    """
    if on_error not in get_args(OnError):
        raise InputError(f'on_error must be "raise" or "skip", but {shown(on_error)} was given.')
    if vertical not in (None, *get_args(Vertical)):
        raise InputError(
            f'vertical must be "pair" or None, but {shown(vertical)} was given. A file of its own is for one record: '
            "read_motion(path, vertical=...).",
            field="vertical",
        )
    motions: dict[Path, GroundMotion] = {}
    faults: dict[Path, str] = {}
    fields: list[str | None] = []
    for file in files:
        try:
            motions[file] = read_motion(file, units=units, dt=dt)
        except InputError as error:
            faults[file] = str(error)
            fields.append(error.field)
    upright = {file: motion for file, motion in motions.items() if is_vertical(motion)}
    horizontal = {file: motion for file, motion in motions.items() if not is_vertical(motion)}
    if faults:
        message = _fault_message(faults, len(files))
        if on_error == "raise" or not motions:
            message += f" {skip} continues with the other files." if motions else ""
            field = next((name for name in fields[:REPORTED] if name in ("units", "dt")), None)
            raise InputError(message, longest=NAMES, field=field)
        warnings.warn(f"Left out: {message}", RecordWarning, stacklevel=3)
    left = list(upright)
    if vertical is not None and horizontal:
        horizontal, left = _pair(horizontal, upright, on_error, skip)
    if left:
        names = ", ".join(file.name for file in left)
        components = f"{len(left)} vertical component{'s' * (len(left) > 1)}"
        if not horizontal:
            raise InputError(
                f"No horizontal component was given, only {components}: {names}. Give horizontal ones; if a "
                "header or file name is wrong, correct it."
            )
        warnings.warn(f"Left out: {components}, {names}.", RecordWarning, stacklevel=3)
    return horizontal


def _pair(
    horizontal: dict[Path, GroundMotion], upright: dict[Path, GroundMotion], on_error: OnError, skip: str
) -> tuple[dict[Path, GroundMotion], list[Path]]:
    """Return the records with their vertical components, and the vertical records that belong to none."""
    both, without, left = paired(horizontal, upright)
    faults = {file: reason for file, reason in without.items() if reason}
    if faults:
        reasons = " ".join(f"{file.name}: {reason}" for file, reason in list(faults.items())[:REPORTED])
        message = f"{len(faults)} of {len(both)} records cannot be paired with a vertical component. {reasons}"
        if on_error == "raise":
            raise InputError(f"{message} {skip} keeps them without it.", longest=NAMES, field="vertical")
        warnings.warn(message, RecordWarning, stacklevel=4)
    if len(without) == len(both) and not faults:
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
    return both, left


def folder_files(folder: Path) -> list[Path]:
    """Return the record files of a directory, by suffix, sorted by name.

    Raises
    ------
    InputError
        If there are none.
    """
    files = [file for file in folder.iterdir() if file.suffix.lower() in SUFFIXES and file.is_file()]
    if not files:
        raise InputError(f"{folder} holds no record: no file ends in {', '.join(SUFFIXES)}.")
    return sorted(files)


def _folder(folder: Path) -> tuple[str, list[Path]]:
    if not folder.is_dir():
        raise InputError(
            f"{folder} is not a directory. Give a directory or a list of files; use read_motion for a single file."
        )
    return folder.resolve().name, folder_files(folder)


def _fault_message(faults: dict[Path, str], n_files: int) -> str:
    """List every file that cannot be read, with the errors of the first few."""
    shown, others = list(faults.values())[:REPORTED], [str(file) for file in list(faults)[REPORTED:]]
    message = " ".join(shown) if n_files == 1 else f"{len(faults)} of {n_files} files cannot be read. {' '.join(shown)}"
    return f"{message} The others: {', '.join(others)}." if others else message
