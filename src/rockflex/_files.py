"""Paths as they are given, and files that appear whole or not at all and outlast a loss of power afterwards."""

import os
import stat
from pathlib import Path
from uuid import uuid4

from rockflex._errors import InputError
from rockflex._shown import shown

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def path_of(name: str, given: object) -> Path:
    """Return what was given as a path, of which the system can at least say whether there is a file.

    Raises
    ------
    InputError
        If it is no path, or none that a file can have.
    """
    if not isinstance(given, str | Path):
        raise InputError(f"{name} must be a path, but {type(given).__name__} was given.", field=name)
    path = Path(given)
    try:
        os.fsencode(path)
        path.exists()
        reason = "a path holds no null character" if "\0" in str(path) else ""
    except UnicodeEncodeError:
        reason = "it holds a character that no path has"
    except OSError as error:
        reason = error.strerror
    if reason:
        raise InputError(f"{name} must be that of a file, but {shown(str(path))} was given: {reason}.", field=name)
    return path


def irregular(path: Path) -> str:
    """Say what stands at `path` in place of a regular file, as "a pipe"; empty for such a file, and where none is."""
    try:
        mode = path.stat().st_mode
    except OSError:  # told by who reads it
        return ""
    return next((kind for is_kind, kind in _KINDS if is_kind(mode)), "")


def check_regular(path: Path, name: str = "") -> None:
    """Refuse what may never end when it is read, or cannot be; every reader asks before it opens.

    Raises
    ------
    InputError
        If there is something at `path`, and no regular file; `name` says in the message which argument it was.
    """
    kind = irregular(path)
    if kind:
        remedy = "Give a file in it." if kind == "a folder" else "Write what it gives to a file, and give that."
        raise InputError(
            f"{name}{': ' * bool(name)}{path} is {kind}, but a regular file is expected. {remedy}",
            field=name or None,
        )


def write_whole(path: Path, content: bytes) -> Path:
    """Write `content` beside `path`, force it to the disk and move it there; a failure leaves what was there before."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}-{uuid4().hex}")
    try:
        with temporary.open("xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())  # before the move: network file systems report a full disk only here
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    _sync_names(path.parent)
    return path


def sweep(folder: Path, pattern: str) -> None:
    """Remove what a killed process left of files whose names match `pattern`."""
    for left in folder.glob(f".{pattern}.*"):
        left.unlink(missing_ok=True)


def _sync_names(folder: Path) -> None:
    if os.name == "nt":  # a folder cannot be opened there
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
