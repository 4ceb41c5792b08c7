"""The files in a folder of records: which are read, and what is not looked into."""

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path
from rockflex.foundation.shown import first_texts_shown, number_with_noun, shown
from rockflex.motion import _text
from rockflex.motion._findings import NoAccelerationError
from rockflex.motion._readers import FORMATS, is_of_a_network
from rockflex.motion._record_signs import has_rows_of_numbers, is_table_of_something_else, names_acceleration
from rockflex.motion._samples import SUFFIXES

TEXT_SUFFIXES = (".csv", ".dat", ".tsv", ".txt")  # of records, and of much else
RECORD_SUFFIXES = (
    *(suffix for suffix, quantity in SUFFIXES.items() if quantity == "acceleration"),
    *TEXT_SUFFIXES,
    *(".xlsx", ".xlsm", ".xls"),
    *(".mseed", ".miniseed", ".msd", ".sac", ".gse", ".gse2", ".evt"),
)
ARCHIVE_SUFFIXES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar", ".z")
# Texts about records, which may name a network and accelerations as these do.
DOCUMENT_SUFFIXES = (".md", ".rst", ".html", ".htm", ".xml", ".json", ".toml")
# Files of the system, and that of `rockflex select` beside the records that it writes.
SYSTEM_NAMES = ("__macosx", "thumbs.db", "ehthumbs.db", "desktop.ini", "summary.json")
HEAD_BYTES = 4096  # bytes of a file that tell a format
SIGN_BYTES = 16384  # bytes of a file within which its numbers begin
MINISEED = re.compile(rb"[\d ]{6}[DRQM] ")
MAX_COUNTED_FILES = 10_000  # within a folder


@dataclass(frozen=True)
class FolderFiles:
    """The files that are read, and what else lies in their folder; no name and nothing else for files one by one."""

    name: str
    files: list[Path]
    others: list[Path] = field(default_factory=list[Path])  # no records by suffix and beginning
    archives: list[Path] = field(default_factory=list[Path])
    folders: dict[Path, int] = field(default_factory=dict[Path, int])  # with their numbers of files
    hidden: list[Path] = field(default_factory=list[Path])  # of which nobody need be told

    def remarks(self) -> Iterator[str]:
        """Yield what is not looked into."""
        for folder, count in self.folders.items():
            yield f"Not entered: the folder {folder.name} with {_count(count)}. Read it by itself: {_call(folder)}."
        if self.archives:
            yield f"Not unpacked: {_names(self.archives)}. Unpack archives that hold records."
        if self.others:
            yield f"Not tried, no records by suffix and beginning: {_names(self.others)}."


def _names(files: Iterable[Path]) -> str:
    return first_texts_shown([file.name for file in files])


def _count(number: int) -> str:
    return f"{MAX_COUNTED_FILES} files or more" if number >= MAX_COUNTED_FILES else number_with_noun(number, "file")


def _call(folder: Path) -> str:
    return f"read_suite({shown(folder.as_posix())})"


def record_files(paths: str | Path | Iterable[str | Path]) -> FolderFiles:
    """Return the record files of a directory, or the files given; sorted by name."""
    if isinstance(paths, str | Path):
        folder = checked_file_path("paths", paths)
        if not folder.is_dir():
            raise InputError(
                f"{folder} is not a directory. Give a directory or a list of files; use read_motion for a single file."
            )
        return files_of_folder(folder)
    if not isinstance(paths, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"paths must be a directory or a sequence of files, but {type(paths).__name__} was given.")
    files = [checked_file_path("paths", path) for path in paths]
    return FolderFiles("", sorted(files, key=lambda file: (file.name, str(file))))


def files_of_folder(folder: Path) -> FolderFiles:
    """Return the files of a directory, sorted by name; those that may be records, by suffix or beginning, are read."""
    found = FolderFiles(folder.resolve().name, [])
    for path in sorted(folder.iterdir()):
        if path.name.startswith((".", "~$")) or path.name.casefold() in SYSTEM_NAMES:
            if path.is_file():
                found.hidden.append(path)
        elif path.is_dir():
            if count := _number_of_files(path):
                found.folders[path] = count
        elif path.is_file():
            suffix = path.suffix.lower()
            read = suffix in RECORD_SUFFIXES or suffix in SUFFIXES
            archive = not read and suffix in ARCHIVE_SUFFIXES
            read = read or (not archive and suffix not in DOCUMENT_SUFFIXES and _begins_as_record(path))
            (found.files if read else found.archives if archive else found.others).append(path)
    if not found.files:
        text = (
            f"{folder} holds no record: no file ends in {', '.join(RECORD_SUFFIXES)}, begins as a file in one of the "
            f"formats {first_texts_shown(list(FORMATS))}, or names an acceleration above rows of numbers."
        )
        raise InputError(" ".join([text, *found.remarks()]))
    return found


def _number_of_files(folder: Path) -> int:
    names = (name for _, _, names in os.walk(folder) for name in names if not name.startswith("."))
    return sum(1 for _ in islice(names, MAX_COUNTED_FILES))


def _begins_as_record(file: Path) -> bool:
    """Return whether a file begins as a record of a network, or names an acceleration above rows of numbers."""
    try:
        with file.open("rb") as stream:
            content = stream.read(SIGN_BYTES)
    except OSError:
        return False
    if MINISEED.match(content):
        return True
    lines = (_text.decoded_text(content[:HEAD_BYTES]) or "").splitlines()
    if lines and is_of_a_network(lines):
        return True
    lines = (_text.decoded_text(content) or "").splitlines()
    return has_rows_of_numbers(lines) and names_acceleration(file, lines)


def fault_of_file(file: Path, error: InputError) -> InputError:
    """Return why a file is not read: the error, or that it is no record at all, as texts and tables are none."""
    suffix = file.suffix.lower()
    quantity = SUFFIXES.get(suffix)
    if isinstance(error, NoAccelerationError) or quantity == "acceleration":
        return error
    try:
        lines = _text.read_text_lines(file)
        if is_of_a_network(lines):
            return error
        if quantity is not None and not names_acceleration(file, lines):
            return NoAccelerationError(str(error), found=quantity, field=error.field)
        if suffix in TEXT_SUFFIXES and not has_rows_of_numbers(lines):
            return NoAccelerationError(f"{file} holds no rows of numbers, as a record does.", found="text")
        table = _text.parse_numeric_table(file, lines)
    except InputError:
        return error
    if not is_table_of_something_else(file, table):
        return error
    return NoAccelerationError(str(error), found="table", field=error.field)
