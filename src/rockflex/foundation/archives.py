"""ZIP archives: the same content gives the same bytes, and of a hostile one no more is unpacked than is allowed.

Every reader of archives goes through `open_archive`, and every array of NumPy in them through `array_from_npy`.
"""

import io
import math
import zipfile
import zlib
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Literal

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun, shown

MAX_NPY_HEADER = 10_000  # bytes of the header of an array, as NumPy allows
_DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError, OSError)
_PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # the others unpack all they can before anything is counted
_LISTED, _END, _LONG_END = b"PK\x01\x02", b"PK\x05\x06", b"PK\x06\x07"  # before each name in the list, and at its end
_END_BYTES, _COMMENT_BYTES = 22, 65_535
_HEADERS: dict[tuple[int, int], tuple[int, Callable[[BinaryIO], tuple[tuple[int, ...], bool, Any]]]] = {
    (1, 0): (2, np.lib.format.read_array_header_1_0),
    (2, 0): (4, np.lib.format.read_array_header_2_0),
}


@dataclass(frozen=True)
class ArchiveLimits:
    """The most that an archive may hold: members, bytes of one, and bytes that are unpacked of all of them."""

    members: int = 10_000
    member_bytes: int = 200_000_000
    total_bytes: int = 1_000_000_000


class ArchiveError(InputError):
    """An archive that is not read; the message has no subject: "holds 501 files, more than 500".

    Attributes
    ----------
    kind : str
        "damaged", "packed" (protected, or packed in another way than by deflation), "members" or "size".
    """

    def __init__(self, kind: Literal["damaged", "packed", "members", "size"], message: str) -> None:
        super().__init__(message)
        self.kind = kind


class OpenArchive:
    """The members of an archive, `entries`, and their contents as far as the limits allow.

    An entry never yields more bytes than it states, so what is stated is checked before anything is unpacked.
    """

    def __init__(self, archive: zipfile.ZipFile, most: ArchiveLimits) -> None:
        self.entries = [each for each in archive.infolist() if not each.filename.endswith("/")]
        self._archive, self._most, self._unpacked = archive, most, 0

    def read(self, entry: zipfile.ZipInfo) -> bytes:
        """Return the content of a member.

        Raises
        ------
        ArchiveError
            If it is damaged or protected, or larger than the limits, or than what they leave after the others.
        """
        if entry.flag_bits & 1 or entry.compress_type not in _PACKED:
            raise ArchiveError("packed", "is protected by a password, or packed in another way than by deflation")
        if entry.file_size > self._most.member_bytes:
            raise ArchiveError(
                "size",
                f"holds {shown(entry.filename)} of {entry.file_size / 1e6:.0f} MB, more than "
                f"{self._most.member_bytes / 1e6:g} MB",
            )
        self._unpacked += entry.file_size
        if self._unpacked > self._most.total_bytes:
            raise ArchiveError("size", f"holds more than {self._most.total_bytes / 1e6:g} MB when unpacked")
        with _damage_told(), self._archive.open(entry) as member:
            content = member.read(entry.file_size + 1)  # without a number all that is packed would be unpacked first
        if len(content) != entry.file_size:
            raise ArchiveError("damaged", f"is damaged: {shown(entry.filename)} is not as long as it states")
        return content

    def contents(self) -> dict[str, bytes]:
        """Return the contents of all members by name; of two with one name, the last."""
        if sum(each.file_size for each in self.entries) > self._most.total_bytes:
            raise ArchiveError("size", f"holds more than {self._most.total_bytes / 1e6:g} MB when unpacked")
        return {each.filename: self.read(each) for each in self.entries}


@contextmanager
def open_archive(file: Path | bytes, most: ArchiveLimits) -> Generator[OpenArchive]:
    """Open a ZIP archive whose list of members is within the limits.

    Raises
    ------
    ArchiveError
        If it is damaged, or holds too many members.
    """
    with _damage_told():
        stream: BinaryIO = io.BytesIO(file) if isinstance(file, bytes) else file.open("rb")
    with stream:
        with _damage_told():
            if _listed_members(stream) > 2 * most.members:  # folders count too; opening takes an object for each
                raise ArchiveError("members", f"holds more than {most.members} files")
            archive = zipfile.ZipFile(stream)
        with archive:
            opened = OpenArchive(archive, most)
            if len(opened.entries) > most.members:
                counted = number_with_noun(len(opened.entries), "file")
                raise ArchiveError("members", f"holds {counted}, more than {most.members}")
            yield opened


@contextmanager
def _damage_told() -> Generator[None]:
    try:
        yield
    except ArchiveError:
        raise
    except _DAMAGED as error:
        raise ArchiveError("damaged", f"is damaged, or no archive ({type(error).__name__}: {error})") from error


def _listed_members(stream: BinaryIO) -> int:
    """Return how many members the list of an archive has at most, without an object for each."""
    size = stream.seek(0, io.SEEK_END)
    stream.seek(max(0, size - _END_BYTES - _COMMENT_BYTES))
    tail = stream.read()
    end = tail.rfind(_END)
    begin = size  # without an end there is no list
    if end >= 0:
        listed = int.from_bytes(tail[end + 12 : end + 16], "little")
        # A list of the long form states its size elsewhere.
        begin = 0 if _LONG_END in tail else max(0, size - len(tail) + end - listed)
    stream.seek(begin)
    found = stream.read().count(_LISTED)
    stream.seek(0)
    return found


def archive_bytes(members: Mapping[str, bytes], packing: int = zipfile.ZIP_DEFLATED) -> bytes:
    """Return a ZIP with these members, in their order and all of one date."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", packing) as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name), content, packing)
    return packed.getvalue()


def npy_shape_and_type(content: bytes) -> tuple[tuple[int, ...], np.dtype[Any]]:
    """Return the shape and the type of an array in NumPy's format, of which only the header is read.

    Raises
    ------
    ArchiveError
        If the header is damaged, or longer than any of NumPy's.
    """
    file = io.BytesIO(content)
    with _damage_told():
        version = np.lib.format.read_magic(file)
        if version not in _HEADERS:
            raise ArchiveError("damaged", f"has an array of the unknown version {version[0]}.{version[1]}")
        width, read = _HEADERS[version]
        length = int.from_bytes(content[file.tell() : file.tell() + width], "little")
        if length > MAX_NPY_HEADER:
            raise ArchiveError("size", f"has an array with a header of {length} bytes, more than {MAX_NPY_HEADER}")
        shape, _, kind = read(file)
    return shape, kind


def array_from_npy(content: bytes) -> NDArray[Any]:
    """Return an array in NumPy's format; one of Python objects is refused.

    Raises
    ------
    ArchiveError
        As `npy_shape_and_type`, if the header claims more numbers than follow it, or for objects.
    """
    shape, kind = npy_shape_and_type(content)
    wanted = math.prod(shape) * kind.itemsize
    if min(shape, default=0) < 0 or wanted > len(content):
        raise ArchiveError("damaged", f"has an array {shape} of {wanted} bytes, but {len(content)} bytes are there")
    with _damage_told():
        return np.lib.format.read_array(io.BytesIO(content), allow_pickle=False)


def arrays_from_npz(file: Path | bytes, most: ArchiveLimits) -> dict[str, NDArray[Any]]:
    """Return the arrays of an archive as `numpy.savez` writes it, by name.

    Raises
    ------
    ArchiveError
        As `OpenArchive.contents` and `array_from_npy`.
    """
    with open_archive(file, most) as archive:
        return {name.removesuffix(".npy"): array_from_npy(content) for name, content in archive.contents().items()}
