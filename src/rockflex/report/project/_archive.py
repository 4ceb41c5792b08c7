"""The archive of a project's file: members with plain names, of which few are tables."""

import re
from pathlib import Path

from rockflex.foundation.archives import ArchiveError, ArchiveLimits, OpenArchive, open_archive
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file, checked_file_path
from rockflex.foundation.shown import shown

MAX_TOML_BYTES = 50_000_000  # of the tables together: they are read slowly
_MEMBER = re.compile(r"(?:[\w+-][\w.+-]*/)?[\w+-][\w.+-]*")


def read_archive(path: str | Path, kind: str) -> dict[str, bytes]:
    """Return the members of a ZIP by name; nothing is written to disk. `kind` names the file in messages.

    Raises
    ------
    InputError
        If the file does not exist, or as `unpacked_members`.
    """
    file = checked_file_path("path", path)
    check_regular_file(file)
    if not file.exists():
        raise InputError(f"The {kind} file {file} does not exist (working directory: {Path.cwd()}).", field="path")
    return unpacked_members(file, str(file), kind, ArchiveLimits(), MAX_TOML_BYTES)


def unpacked_members(
    file: Path | bytes, name: str, kind: str, most: ArchiveLimits, toml_bytes: int
) -> dict[str, bytes]:
    """Return the members of a ZIP by name, in memory; `name` is that of the file in messages.

    Raises
    ------
    InputError
        If it is damaged or protected, holds more than `most`, TOML of more than `toml_bytes`, or a member whose name
        points elsewhere or occurs twice.
    """
    try:
        with open_archive(file, most) as archive:
            wrong = _wrong_members(archive, toml_bytes)
            found = {} if wrong else archive.contents()
    except ArchiveError as error:
        if error.kind == "damaged":
            raise InputError(
                f"{name} is not a {kind} file, or a damaged one ({error}). Give a file that was saved completely.",
                field="path",
            ) from error
        wrong, found = str(error), {}
    if wrong:
        raise InputError(f"The {kind} file {name} {wrong}. It is not read.", field="path")
    return found


def _wrong_members(archive: OpenArchive, toml_bytes: int) -> str:
    """Return what is wrong about the names of the members and the size of the tables; empty for nothing."""
    names = [each.filename for each in archive.entries]
    toml = sum(each.file_size for each in archive.entries if each.filename.endswith(".toml"))
    if toml > toml_bytes:
        return f"holds TOML of {toml / 1e6:.0f} MB, more than {toml_bytes / 1e6:g} MB"
    if bad := [name for name in names if not _MEMBER.fullmatch(name)]:
        return f"holds a file named {shown(bad[0])}, which is no plain name in one of its folders"
    return "holds two files of the same name" if len({name.casefold() for name in names}) < len(names) else ""
