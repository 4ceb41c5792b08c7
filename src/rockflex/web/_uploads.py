"""Uploaded files: checked before they are parsed, and stored only in memory."""

import hashlib
import io
import re
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any, Generic, TypeVar

import numpy as np

from rockflex.foundation.archives import ArchiveLimits, array_from_npy, npy_shape_and_type, open_archive
from rockflex.foundation.errors import InputError
from rockflex.motion._ground_motion import GroundMotion, is_vertical_component
from rockflex.motion._readers import read_motion_without_obspy
from rockflex.web._folders import FIELD, RecordFolder, SentRecordFile, read_record_folder, unpacked_record_files
from rockflex.web._limits import MAX_CACHED_SAMPLES, MAX_FILE_BYTES, MAX_FREEDOMS, check_record_length
from rockflex.web._refusal import Refusal, errors_as_refusals, temporary_folder

MAX_RECORDS = 64  # in memory
MAX_NAME = 60  # characters of the name under which a file is stored while it is read
MATRICES = ("mass", "stiffness", "heights", "rotations")
MATRICES_LIMITS = ArchiveLimits(100, MAX_FILE_BYTES, 4 * MAX_FILE_BYTES)


Cached = TypeVar("Cached")


class LatestValuesCache(Generic[Cached]):
    """The values last stored or read, by their keys, as many as fit; safe for threads.

    Parameters
    ----------
    capacity
        Largest sum of the sizes of all values; the last one stays even if it alone is larger.
    size
        Returns the size of a value.
    """

    def __init__(self, capacity: int, size: Callable[[Cached], int] = lambda _: 1) -> None:
        self._values: OrderedDict[str, Cached] = OrderedDict()
        self._lock, self._capacity, self._size = Lock(), capacity, size

    def put(self, key: str, value: Cached) -> None:
        """Store a value, and forget those that have not been used for the longest time."""
        with self._lock:
            self._values[key] = value
            self._values.move_to_end(key)
            while len(self._values) > 1 and sum(map(self._size, self._values.values())) > self._capacity:
                self._values.popitem(last=False)

    def get(self, key: str) -> Cached | None:
        """Return a value; None if it is not, or no longer, stored."""
        with self._lock:
            value = self._values.get(key)
            if value is not None:
                self._values.move_to_end(key)
        return value

    def items(self) -> dict[str, Cached]:
        """Return all values by their keys."""
        with self._lock:
            return dict(self._values)


FOLDER_LOST = (
    "the server no longer has these records: it was restarted, or others gave newer ones. Give the folder again on "
    "the Earthquake tab; a link does not contain it."
)
NO_FOLDER = "no records were given yet. Choose a folder on the Earthquake tab first."


def checksum_of_files(files: Sequence[SentRecordFile], options: str) -> str:
    """Return the SHA-256 of the names and the contents of files, whatever their order, and of how they are read."""
    digest = hashlib.sha256(options.encode())
    for each in sorted(files, key=lambda file: file.name):
        content = each.content or b""
        digest.update(f"\0{each.name}\0{each.size}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()


def read_sent_folder(body: bytes, units: str | None, dt: float | None) -> tuple[str, RecordFolder]:
    """Return the checksum of the files in a request, and their records."""
    files = unpacked_record_files(body)
    return checksum_of_files(files, f"{units} {dt}"), read_record_folder(files, units, dt)


class RecordFolders:
    """Sets of records by the checksum of their files; the latest ones of all visitors, as far as memory is set aside.

    The checksum is known only to those who have the files or a link with it.
    """

    def __init__(self) -> None:
        self._folders = LatestValuesCache[RecordFolder](MAX_CACHED_SAMPLES, lambda folder: folder.samples)

    def add(self, folder: RecordFolder, files: Sequence[SentRecordFile], options: str) -> str:
        """Keep a set, and return its checksum."""
        token = checksum_of_files(files, options)
        self.put(token, folder)
        return token

    def put(self, token: str, folder: RecordFolder) -> None:
        """Keep a set under its checksum."""
        self._folders.put(token, folder)

    def items(self) -> dict[str, RecordFolder]:
        """Return all sets by their checksums."""
        return self._folders.items()

    def get(self, token: str) -> RecordFolder:
        """Return a set."""
        found = self._folders.get(token)
        if found is None:
            raise Refusal({FIELD: FOLDER_LOST if token else NO_FOLDER}, 410)
        return found


class UploadedRecords:
    """Records by the checksum of their file; the latest `MAX_RECORDS` of all visitors. `folders` holds sets of records.

    The checksum is known only to those who have the file or a link with it.
    """

    def __init__(self) -> None:
        self._records = LatestValuesCache[GroundMotion](MAX_RECORDS)
        self.folders = RecordFolders()

    def add(self, motion: GroundMotion, content: bytes, options: str) -> str:
        """Store a record, and return its checksum."""
        key = hashlib.sha256(content + b"\0" + options.encode()).hexdigest()
        self._records.put(key, motion)
        return key

    def items(self) -> tuple[dict[str, GroundMotion], dict[str, RecordFolder]]:
        """Return all records and sets of records by their checksums."""
        return self._records.items(), self.folders.items()

    def take(self, given: tuple[Mapping[str, GroundMotion], Mapping[str, RecordFolder]]) -> None:
        """Store what the `items` of another one are."""
        for key, motion in given[0].items():
            self._records.put(key, motion)
        for token, folder in given[1].items():
            self.folders.put(token, folder)

    def get(self, key: str) -> GroundMotion:
        """Return a record."""
        motion = self._records.get(key)
        if motion is None:
            message = (
                "the record of this link was an uploaded file, which a link does not contain. Choose the file again."
            )
            raise Refusal({"record.upload": message}, 410)
        return motion


def read_uploaded_record(name: str, content: bytes, units: str | None, dt: float | None) -> GroundMotion:
    """Read a record from the bytes of a file.

    Parameters
    ----------
    name
        The visitor's name for the file; used in messages and as the motion's name, never as a path.
    content
        Its bytes.
    units, dt
        As in `read_motion`, or None.
    """
    named = _read_uploaded_motion(name, content, units, dt, "record.upload")
    if is_vertical_component(named):
        shown = clean_upload_name(name)
        message = (
            f"{shown} is a vertical component by its header or its name. Choose a horizontal one here, and this one as "
            "its vertical component."
        )
        raise Refusal({"record.upload": message})
    return named


def read_uploaded_vertical(
    name: str, content: bytes, units: str | None, dt: float | None, along: GroundMotion
) -> GroundMotion:
    """Return a stored horizontal record with the vertical component in a file, as `read_uploaded_record` reads it."""
    upwards = _read_uploaded_motion(name, content, units, dt, "record.vertical")
    with errors_as_refusals("record.vertical"):
        motion = along.with_vertical(upwards)
    check_record_length(motion, "record.vertical")
    return motion


def _read_uploaded_motion(name: str, content: bytes, units: str | None, dt: float | None, field: str) -> GroundMotion:
    """Read a motion of any direction, named as its file."""
    shown = clean_upload_name(name)
    _check_upload_size(shown, content, field)
    with temporary_folder(field) as folder:
        # The name and its suffix are evidence of what the file holds.
        file = folder / (re.sub(r"[^A-Za-z0-9._-]", "_", shown)[-MAX_NAME:].lstrip(".") or "record.txt")
        file.write_bytes(content)
        try:
            motion = read_motion_without_obspy(file, units=units, dt=dt)
        except InputError as error:
            said = str(error).replace(str(file), shown)
            if error.field == "component":
                said = f"{said.partition(' Name one:')[0]} Choose a file with a single one."
            raise Refusal({field: said}) from error
    named = replace(motion, name=Path(shown).stem or "record")
    if motion.metadata is not None and motion.metadata.source == file.name:
        named = replace(named, metadata=replace(motion.metadata, source=shown))
    check_record_length(named, field)
    return named


def clean_upload_name(name: str) -> str:
    """Return a name without folders and control characters, and not too long."""
    last = re.split(r"[/\\]", name)[-1]
    return re.sub(r"[^\w.()+ -]", "_", last)[:80].strip() or "record"


def motion_file_name(motion: GroundMotion) -> str:
    """Return the name of a motion as a file name; a unit in it, such as m/s, is not a path."""
    return clean_upload_name(motion.name.replace("/", "_"))


def _check_upload_size(name: str, content: bytes, field: str) -> None:
    if len(content) > MAX_FILE_BYTES:
        message = f"{name} has {len(content) / 1e6:.1f} MB, but the page takes {MAX_FILE_BYTES / 1e6:g} MB at most."
        raise Refusal({field: message}, 413)


def read_uploaded_matrices(name: str, content: bytes, part: str) -> dict[str, Any]:
    """Read matrices from a ``.npz`` with arrays mass, stiffness, heights and rotations, or one of them from a CSV file.

    Heights are one for each freedom, NaN for none; or rows of an index and a height, or with NaN, which become a table.
    """
    shown = clean_upload_name(name)
    _check_upload_size(shown, content, "structure")
    try:
        if shown.lower().endswith(".npz"):
            return _matrices_from_npz(shown, content)
        if part not in MATRICES:
            raise Refusal({"structure": f"say which of {', '.join(MATRICES)} the file {shown} holds."})
        return {part: _matrix_as_numbers(shown, part, _matrix_from_text(content.decode("utf-8-sig")))}
    except Refusal:
        raise
    except Exception as error:  # damaged files raise many kinds of errors
        message = f"{shown} does not hold matrices that can be read: {str(error)[:200].rstrip('.')}."
        raise Refusal({"structure": message}) from error


def _matrix_from_text(text: str) -> Any:
    """Return the numbers of a CSV file, or between blanks; empty cells, which heights may have, are NaN."""
    if ";" in text:  # then commas are decimal commas
        text = text.replace(",", ".").replace(";", ",")
    return np.loadtxt(
        io.StringIO(text), delimiter="," if "," in text else None, ndmin=2,
        converters=lambda cell: float(cell) if cell.strip(" -–") else np.nan,
    )  # fmt: skip


def _matrices_from_npz(name: str, content: bytes) -> dict[str, Any]:
    found: dict[str, Any] = {}
    # A header may claim an array of any size, so it is read before any memory is allocated.
    with open_archive(content, MATRICES_LIMITS) as archive:
        members = {each.filename: each for each in archive.entries}
        for part in MATRICES:
            if f"{part}.npy" not in members:
                continue
            packed = archive.read(members[f"{part}.npy"])
            shape, kind = npy_shape_and_type(packed)
            if kind.kind not in "fiu" or len(shape) > 2 or max(shape, default=0) > MAX_FREEDOMS:
                message = (
                    f"{name}: {part} is an array {shape} of {kind}, but numbers for up to {MAX_FREEDOMS} freedoms are "
                    "expected."
                )
                raise Refusal({"structure": message})
            found[part] = _matrix_as_numbers(name, part, array_from_npy(packed))
    if "stiffness" not in found:
        message = f"{name} must hold the arrays mass, stiffness and heights, but it holds no stiffness."
        raise Refusal({"structure": message})
    return found


def _matrix_as_numbers(name: str, part: str, array: Any) -> Any:
    """Return an array as the state of the page stores it: numbers, or heights by the indices of their freedoms."""
    values = np.asarray(array, dtype=np.float64)
    blank = np.isnan(values) & (part == "heights")
    if not (np.isfinite(values) | blank).all() or blank.all() or max(values.shape) > MAX_FREEDOMS:
        raise Refusal({"structure": f"{name}: {part} must hold finite numbers for up to {MAX_FREEDOMS} freedoms."})
    if part == "heights" and values.ndim == 2 and values.shape[1] == 2 and len(values) > 1:
        found = {str(_index_of_freedom(name, part, each)): height for each, height in values.tolist()}
        if len(found) < len(values):
            raise Refusal({"structure": f"{name}: {part} must hold each freedom once."})
        return found
    if values.ndim == 2 and 1 in values.shape and part != "stiffness":
        values = values.ravel()
    if part == "rotations":
        return [_index_of_freedom(name, part, each) for each in values.ravel()]
    if blank.any():
        return {str(i): float(values.ravel()[i]) for i in np.flatnonzero(~blank)}
    return values.tolist()


def _index_of_freedom(name: str, part: str, number: float) -> int:
    if not number.is_integer():
        message = f"{name}: {part} must hold whole indices of freedoms, counted from 0, but {number:g} was found."
        raise Refusal({"structure": message})
    return int(number)
