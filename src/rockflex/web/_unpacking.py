"""Many files in one request: a list of their names and sizes, then their contents; ZIP archives among them unpacked.

Nothing is written here. The names that come out are those of files in one folder: without folders, different from
each other, and short.
"""

import io
import re
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

from rockflex.web._limits import FILE, FILES, FOLDER
from rockflex.web._refusal import Refusal
from rockflex.web._state import parse_json

FIELD = "record.folder"  # of the messages
STEM, SUFFIX = 70, 12  # letters of a name that are kept
BYTES = 200  # of them, because file systems count bytes: most take 255 with the suffix
HEAD = 500_000  # bytes of the list
FORBIDDEN = re.compile(r'[<>:"|?*\x00-\x1f\x7f-\x9f]')
ENTRY = b"PK\x01\x02"  # before each name in the list of an archive
DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError, OSError)


@dataclass(frozen=True)
class GivenFile:
    """A file of a visitor; without content if it is too large, with its size in bytes."""

    name: str
    content: bytes | None
    size: int


def unpacked(body: bytes) -> list[GivenFile]:
    """Return the files in a request.

    Parameters
    ----------
    body
        A line of JSON, ``[{"name": "folder/a.AT2", "size": 120, "sent": true}, ...]``, and the contents in this order;
        a file that was too large to be sent has ``"sent": false`` and no content.

    Raises
    ------
    Refusal
        If the list does not fit the contents, there are too many or too large files, a name points out of the folder,
        or an archive cannot be unpacked.
    """
    paths, found, work = list[str](), list[tuple[bytes | None, int]](), 0
    for path, content, size in _listed(body):
        if content is not None and path.lower().endswith(".zip"):
            inside = _archived(path, content, FOLDER - work)
        else:
            inside = [(path, content, size)]
        for name, each, length in inside:
            paths.append(name)
            found.append((each, length))
            work += _work(each)
            if work > FOLDER:
                raise _too_large()
            if len(paths) > FILES:
                raise _refused(f"there are more than {FILES} files, which is more than the page takes. Choose fewer.")
    if not paths:
        raise _refused("there is no file in it.")
    return [GivenFile(name, *each) for name, each in zip(flat_names(paths), found, strict=True)]


def _listed(body: bytes) -> Iterator[tuple[str, bytes | None, int]]:
    head, end, _ = body[:HEAD].partition(b"\n")
    if not end:
        raise Refusal("The list of files does not end.", 400)
    place, entries = len(head) + 1, parse_json(head)
    for entry in entries if isinstance(entries, list) else [None]:
        name, size, sent = _entry(entry)
        content = body[place : place + size] if sent else None
        if content is not None and len(content) < size:
            raise Refusal("The request ends before its files do.", 400)
        yield _checked(name), content, size
        place += size if sent else 0
    if place < len(body):
        raise Refusal("The request holds more than the files of its list.", 400)


def _entry(entry: Any) -> tuple[str, int, bool]:
    known = isinstance(entry, dict) and isinstance(entry.get("name"), str) and type(entry.get("size")) is int
    if not known or entry["size"] < 0 or not isinstance(entry.get("sent"), bool):
        raise Refusal("A list of files with name, size and sent is expected before their contents.", 400)
    large = entry["size"] > FILE and not entry["name"].lower().endswith(".zip")
    return entry["name"], entry["size"], entry["sent"] and not large


def _archived(path: str, content: bytes, room: int) -> Iterator[tuple[str, bytes | None, int]]:
    """Yield the files of an archive, of which no more than `room` bytes are unpacked."""
    shown = flat_names([path])[0]
    if content.count(ENTRY) > 2 * FILES:  # opening it would take an object for each
        raise _refused(f"{shown} holds more than {FILES} files, which is more than the page takes. Pack fewer.")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = [each for each in archive.infolist() if not each.is_dir()]
            if len(entries) > FILES:
                raise _refused(f"{shown} holds {len(entries)} files, but the page takes {FILES} at most. Pack fewer.")
            for each in entries:
                inner = _checked(each.filename)
                if each.file_size > FILE:
                    yield inner, None, each.file_size
                    continue
                with archive.open(each) as file:
                    data = file.read(min(FILE, room) + 1)  # whatever the archive says of its size
                room -= len(data)
                if room < 0:
                    raise _too_large()
                yield (inner, data, len(data)) if len(data) <= FILE else (inner, None, len(data))
    except DAMAGED as error:
        locked = isinstance(error, RuntimeError) and "password" in str(error)
        reason = "is protected by a password" if locked else "is a damaged archive, or packed in an unknown way"
        raise _refused(f"{shown} {reason}. Unpack it, and give the folder instead.") from error


def _work(content: bytes | None) -> int:
    """The bytes that are read of a file: of a workbook, which is an archive too, those unpacked."""
    if content is None or not content.startswith(b"PK"):
        return len(content or b"")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            return sum(each.file_size for each in archive.infolist())
    except DAMAGED:
        return len(content)


def _checked(path: str) -> str:
    """Return a path within the folder of a visitor.

    Raises
    ------
    Refusal
        If it points out of the folder.
    """
    parts = re.split(r"[/\\]", path)
    if ".." in parts or not parts[0] or re.match(r"[A-Za-z]:", path):
        raise _refused(f"the name {path[:80]!r} points out of its folder. Pack the records anew, without such names.")
    return path


def flat_names(paths: Iterable[str]) -> list[str]:
    """Return a different name for each path: its last part, with its folders only where two are equal."""
    names: list[str] = []
    used: set[str] = set()
    for path in paths:
        parts = [part for each in re.split(r"[/\\]", path) if (part := _clean(each))] or ["file"]
        name = _short(parts[-1])
        if name.casefold() in used:
            name = _short("_".join(parts[1:] if len(parts) > 2 else parts))
        plain, count = PurePosixPath(name), 1
        while name.casefold() in used:
            count += 1
            name = f"{plain.stem}-{count}{plain.suffix}"
        used.add(name.casefold())
        names.append(name)
    return names


def _clean(part: str) -> str:
    text = FORBIDDEN.sub("_", part.encode("utf-8", "replace").decode()).strip()
    return "" if text in (".", "..") else text


def _short(name: str) -> str:
    path = PurePosixPath(name)
    stem = path.stem[:STEM].encode()[:BYTES].decode("utf-8", "ignore")
    return f"{stem}{path.suffix[:SUFFIX]}"


def _too_large() -> Refusal:
    message = f"the files have more than {FOLDER / 1e6:g} MB, which is more than the page takes. Choose fewer."
    return _refused(message, 413)


def _refused(message: str, status: int = 422) -> Refusal:
    return Refusal({FIELD: message}, status)
