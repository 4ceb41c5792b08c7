"""Checks of paths, the text in files, and atomic writing of files that survive a loss of power."""

import codecs
import os
import platform
import re
import stat
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from uuid import uuid4
from zlib import crc32

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import path_shown, shown

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def checked_file_path(name: str, given: object) -> Path:
    """Return a given path for which the system can check whether a file exists.

    Raises
    ------
    InputError
        If it is not a path, or not a path that a file can have.
    """
    if not isinstance(given, str | Path):
        raise InputError(f"{name} must be a path, but {type(given).__name__} was given.", field=name)
    path = Path(given)
    try:
        os.fsencode(path)
        path.exists()
        reason = "a path cannot contain a null character" if "\0" in str(path) else ""
    except UnicodeEncodeError:
        reason = "it contains a character that is not allowed in a path"
    except OSError as error:
        reason = error.strerror
    if reason:
        raise InputError(f"{name} must be a valid path, but {shown(str(path))} was given: {reason}.", field=name)
    return path


def irregular_file_kind(path: Path) -> str:
    """Return what `path` is if not a regular file, such as "a pipe"; empty for a regular or a missing file."""
    try:
        mode = path.stat().st_mode
    except OSError:  # reported by the reader
        return ""
    return next((kind for is_kind, kind in _KINDS if is_kind(mode)), "")


def check_regular_file(path: Path, name: str = "") -> None:
    """Reject anything but regular files, such as pipes, which may never end; every reader calls this first.

    Raises
    ------
    InputError
        If there is something other than a regular file at `path`; `name` is the argument, for the message.
    """
    kind = irregular_file_kind(path)
    if kind:
        remedy = "Give a file in it." if kind == "a folder" else "Write its content to a file, and give that."
        raise InputError(
            f"{name}{': ' * bool(name)}{path} is {kind}, but a regular file is expected. {remedy}",
            field=name or None,
        )


def unicode_text(content: bytes) -> str:
    """Return the text in the bytes of a file: UTF-8, or UTF-16, as some editors save it, with any byte-order mark.

    Ends of lines become line feeds.

    Raises
    ------
    UnicodeDecodeError
        If it is in another encoding.
    """
    wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    # Without a mark: the first character of a text that is not of another script has a byte of zero.
    little, big = content[1:2] == b"\0", content[:1] == b"\0"
    encoding = "utf-16" if wide else "utf-16-le" if little else "utf-16-be" if big else "utf-8-sig"
    return content.decode(encoding).replace("\r\n", "\n").replace("\r", "\n")


def write_file_atomically(path: Path, content: bytes) -> Path:
    """Write `content` to a temporary file, flush it to disk and move it to `path`; on failure `path` is unchanged."""
    with writing_atomically(path, tidy=False) as temporary, temporary.open("xb") as file:
        file.write(content)
    return path


def write_given_file(path: Path, content: bytes) -> Path:
    """Write `content` as `write_file_atomically` to the path that a call was given.

    Raises
    ------
    InputError
        If the system does not let it.
    """
    try:
        with writing_atomically(path) as temporary, temporary.open("xb") as file:
            file.write(content)
        return path
    except OSError as error:
        raise InputError(
            f"Cannot write to {path_shown(path)}: {error.strerror or error}. Give a path that can be written to.",
            field="path",
        ) from error


@contextmanager
def writing_atomically(path: Path, suffix: str = "", *, tidy: bool = True) -> Generator[Path]:
    """Yield the path of a temporary file; what was written to it is flushed to disk and moved to `path` at the end.

    The name of the temporary file ends in `suffix`. On failure it is removed, and `path` is unchanged. Where `path` is
    a link, the file is replaced that it leads to. With `tidy` those are removed that killed processes left beside it,
    for which the whole folder is listed.
    """
    if path.is_symlink():
        with suppress(FileNotFoundError):  # a link to a new file
            path.stat()  # an error if links lead in a circle
        path = Path(os.path.realpath(path))
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}-{_host()}{uuid4().hex[8:]}{suffix}")
    if tidy:
        _remove_files_of_dead_processes(path)
    try:
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())  # before the move: network file systems report a full disk only here
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    _sync_folder_to_disk(path.parent)


def _host() -> str:
    return f"{crc32(platform.node().encode()):08x}"


def _remove_files_of_dead_processes(path: Path) -> None:
    """Remove the temporary files of a file whose processes, of this machine, run no more."""
    begun = re.compile(rf"{re.escape(f'.{path.name}.')}(\d{{1,9}}+)-{_host()}[0-9a-f]{{24}}")
    with suppress(OSError), os.scandir(path.parent) as folder:
        for each in folder:
            found = begun.match(each.name)
            if found is not None and not process_runs(int(found[1])):
                Path(each).unlink()


def process_runs(pid: int) -> bool:
    """Whether there is a process on this machine with this number."""
    if os.name == "nt":  # where signal 0 interrupts the process
        return True
    try:
        os.kill(pid, 0)
    except OSError as error:
        return isinstance(error, PermissionError)
    return True


def remove_temporary_files(folder: Path, pattern: str) -> None:
    """Remove temporary files of killed processes for names that match `pattern`."""
    for left in folder.glob(f".{pattern}.*"):
        left.unlink(missing_ok=True)


def _sync_folder_to_disk(folder: Path) -> None:
    if os.name == "nt":  # Windows cannot open a folder
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
