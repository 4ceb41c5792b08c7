"""A ZIP of named files as bytes: the same content gives the same bytes, and a hostile one is refused unread."""

import io
import re
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from rockflex._errors import InputError
from rockflex._files import check_regular_file, checked_file_path
from rockflex._shown import number_with_noun, shown

_DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError, OSError)
_PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # which unpack in pieces of a known size
_MEMBER = re.compile(r"(?:[\w+-][\w.+-]*/)?[\w+-][\w.+-]*")


@dataclass(frozen=True)
class ArchiveLimits:
    """The most that is unpacked: members, bytes of one and of all of them, and bytes of those that are TOML."""

    members: int = 10_000
    member_bytes: int = 200_000_000
    total_bytes: int = 1_000_000_000
    toml_bytes: int = 50_000_000


def archive_bytes(members: Mapping[str, bytes]) -> bytes:
    """Return a ZIP with these members, in their order and all of one date."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


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
    return unpacked_members(file, str(file), kind, ArchiveLimits())


def unpacked_members(file: Path | BinaryIO, name: str, kind: str, most: ArchiveLimits) -> dict[str, bytes]:
    """Return the members of a ZIP by name, in memory; `name` is that of the file in messages.

    Raises
    ------
    InputError
        If it is damaged or protected, holds more than `most`, or a member whose name points elsewhere or occurs twice.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            entries = [each for each in archive.infolist() if not each.filename.endswith("/")]
            _check_entries(name, kind, entries, most)
            found = dict[str, bytes]()
            for each in entries:
                with archive.open(each) as member:
                    found[each.filename] = member.read(each.file_size + 1)  # no more, whatever is packed
            return found
    except InputError:
        raise
    except _DAMAGED as error:
        raise InputError(
            f"{name} is not a {kind} file, or a damaged one ({type(error).__name__}: {error}). Give a file that was "
            "saved completely.",
            field="path",
        ) from error


def _check_entries(file: str, kind: str, entries: list[zipfile.ZipInfo], most: ArchiveLimits) -> None:
    names = [each.filename for each in entries]
    size = sum(each.file_size for each in entries)
    toml = sum(each.file_size for each in entries if each.filename.endswith(".toml"))
    wrong = ""
    if len(entries) > most.members or size > most.total_bytes:
        wrong = f"holds {number_with_noun(len(entries), 'file')} of {size / 1e6:.0f} MB, more than {most.members} or "
        wrong += f"{most.total_bytes / 1e6:g} MB"
    elif large := [each for each in entries if each.file_size > most.member_bytes]:
        wrong = f"holds {shown(large[0].filename)} of {large[0].file_size / 1e6:.0f} MB, more than "
        wrong += f"{most.member_bytes / 1e6:g} MB"
    elif toml > most.toml_bytes:
        wrong = f"holds TOML of {toml / 1e6:.0f} MB, more than {most.toml_bytes / 1e6:g} MB"
    elif bad := [name for name in names if not _MEMBER.fullmatch(name)]:
        wrong = f"holds a file named {shown(bad[0])}, which is no plain name in one of its folders"
    elif len({name.casefold() for name in names}) < len(names):
        wrong = "holds two files of the same name"
    elif any(each.compress_type not in _PACKED or each.flag_bits & 1 for each in entries):
        wrong = "is protected by a password, or packed in another way than by deflation"
    if wrong:
        raise InputError(f"The {kind} file {file} {wrong}. It is not read.", field="path")
