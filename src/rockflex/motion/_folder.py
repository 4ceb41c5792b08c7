"""Which files of a folder are records."""

from collections.abc import Iterable
from pathlib import Path

from rockflex._errors import InputError
from rockflex._files import path_of
from rockflex.motion._cosmos import is_cosmos
from rockflex.motion._esm import is_esm
from rockflex.motion._knet import is_knet
from rockflex.motion._text import decoded

SUFFIXES = (
    *(".at2", ".csv", ".dat", ".tsv", ".txt"),
    *(".xlsx", ".xlsm", ".xls"),
    *(".mseed", ".miniseed", ".msd", ".sac", ".gse", ".gse2", ".evt"),
)
BEGINNING = 4096  # bytes of a file that tell its format


def files_of(paths: str | Path | Iterable[str | Path]) -> tuple[str, list[Path]]:
    """Return the name of a directory and its record files, or no name and the files given; sorted by name.

    Raises
    ------
    InputError
        If there is no such directory, it holds no record, or something else is given.
    """
    if isinstance(paths, str | Path):
        folder = path_of("paths", paths)
        if not folder.is_dir():
            raise InputError(
                f"{folder} is not a directory. Give a directory or a list of files; use read_motion for a single file."
            )
        name, files = folder.resolve().name, folder_files(folder)
    elif isinstance(paths, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
        name, files = "", [path_of("paths", path) for path in paths]
    else:
        raise InputError(f"paths must be a directory or a sequence of files, but {type(paths).__name__} was given.")
    return name, sorted(files, key=lambda file: (file.name, str(file)))


def folder_files(folder: Path) -> list[Path]:
    """Return the record files of a directory, by suffix or by their first lines, sorted by name.

    Raises
    ------
    InputError
        If there are none.
    """
    files = [file for file in folder.iterdir() if file.is_file() and is_record(file)]
    if not files:
        raise InputError(
            f"{folder} holds no record: no file ends in {', '.join(SUFFIXES)}, or begins as a K-NET, ESM or COSMOS "
            "file."
        )
    return sorted(files)


def is_record(file: Path) -> bool:
    """Return whether a file is read as a record when its folder is."""
    if file.name.startswith("."):
        return False
    if file.suffix.lower() in SUFFIXES:
        return True
    try:
        with file.open("rb") as stream:
            text = decoded(stream.read(BEGINNING))
    except OSError:
        return False
    lines = (text or "").splitlines()
    return bool(lines) and (is_knet(lines) or is_esm(lines) or is_cosmos(lines))
