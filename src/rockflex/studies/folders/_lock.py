"""One process at a time: a file that names the process and its host, and that the system locks while it lives."""

import errno
import os
import platform
import time
import weakref
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import IO
from uuid import uuid4

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import process_runs, remove_temporary_files
from rockflex.foundation.shown import shortened

LOCK = "lock"  # the name of the file
PATIENCE = 0.5  # s; readers hold a lock for a moment, to see whether anyone does
NAMELESS_AGE = 60.0  # s after which a file without a name is left over, where the file system has no locks
BUSY = {errno.EAGAIN, errno.EACCES, errno.EDEADLK}  # what the system answers for a lock that another one holds
BEYOND_THE_NAME = 1 << 30  # Windows locks bytes, which then cannot be read


class FolderLock:
    """The right to write into a folder; it ends with `release`, with the object, or with the process."""

    def __init__(self, path: Path, file: IO[bytes]) -> None:
        self.path, self._file = path, file
        self._end = weakref.finalize(self, _released, path, file, os.getpid())
        _HELD.add(self)

    @property
    def held(self) -> bool:
        """Whether it is neither released, nor its file deleted or replaced."""
        try:
            return self._end.alive and os.path.samestat(os.fstat(self._file.fileno()), self.path.stat())
        except (OSError, ValueError):
            return False

    def release(self) -> None:
        """Let another process write; a forked child leaves the right to its parent."""
        self._end()

    def forget(self) -> None:
        """Close the file in a forked child, which would hold the lock after the end of its parent."""
        self._file.close()


_HELD = weakref.WeakSet[FolderLock]()


def _forget_held_locks() -> None:
    for each in _HELD:
        each.forget()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_held_locks)


def _released(path: Path, file: IO[bytes], owner: int) -> None:
    if os.getpid() != owner:
        return
    try:
        ours = os.path.samestat(os.fstat(file.fileno()), path.stat())
    except OSError:
        ours = False
    if os.name == "nt":  # which deletes no open file
        file.close()
    with suppress(OSError):
        if ours:
            path.unlink()
    file.close()


def locked_folder(path: Path) -> FolderLock:
    """Return the right to write into the folder of the file `path`; that of a dead process on this host is taken over.

    An `InputError` names a process that holds it.
    """
    if path.is_dir():
        raise InputError(f"{path} is not a file, but the study's lock belongs there. Move it away and try again.")
    end = time.monotonic() + PATIENCE
    while True:
        file = _taken(path)
        if file is not None:
            remove_temporary_files(path.parent, LOCK)
            return FolderLock(path, file)
        if time.monotonic() > end:
            break
        time.sleep(0.02)
    holder = lock_holder(path)
    if holder is None:
        holder = (
            f"a process that left no name (a file {path.name} without one is taken over {NAMELESS_AGE:.0f} s after its "
            "last change, where the file system knows no locks)"
        )
    raise InputError(
        f"{path.parent} is in use by {holder}. Wait until it has finished, or end it. If it no longer runs, delete "
        f"{path} and try again."
    )


def check_folder_locked(lock: FolderLock) -> None:
    """Raise an InputError if the lock is no longer held: released, or its file deleted or taken over."""
    if not lock.held:
        raise InputError(
            f"The lock {lock.path} is no longer held: the folder was closed, or the file was deleted or taken "
            "over. The parts already written are kept. Open the study again."
        )


def lock_holder(path: Path) -> str | None:
    """Return which process holds a lock, in words; None if none does, or the file cannot be read."""
    try:
        with path.open("rb") as file:
            pid, host = _name_in(file.read(1024))
            since = datetime.fromtimestamp(path.stat().st_mtime, UTC)
            dead = host == platform.node() and not _is_held(file, pid)
    except (OSError, ValueError):
        return None
    return None if dead else f"process {pid} on {shortened(host)} since {since.isoformat(timespec='seconds')}"


def _taken(path: Path) -> IO[bytes] | None:
    """Return the open file of the lock if it is ours now: new, or left by a process that is dead; else None."""
    try:
        file = path.open("rb+")
    except FileNotFoundError:
        return _new_lock(path)
    try:
        if _is_left_over(path, file) and os.path.samestat(os.fstat(file.fileno()), path.stat()):
            file.seek(0)
            file.write(_own_name())
            file.truncate()
            file.flush()
            return file
    except FileNotFoundError:  # released since it was opened
        pass
    except BaseException:
        file.close()
        raise
    file.close()
    return None


def _new_lock(path: Path) -> IO[bytes] | None:
    """Make the file with its name in it and locked, before anyone can see it under `path`."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}-{uuid4().hex}")
    file = temporary.open("xb+")
    try:
        file.write(_own_name())
        file.flush()
        _lock_file(file)
        try:
            os.link(temporary, path)
        except FileExistsError:
            file.close()
            return None
        except FileNotFoundError:  # cleaned away by a process that was faster
            file.close()
            return None
        except OSError:  # no hard links here; a rename would replace the lock of another process
            file.close()
            file = path.open("xb+")
            _lock_file(file)
            file.write(_own_name())
            file.flush()
    except FileExistsError:
        return None
    except BaseException:
        file.close()
        raise
    finally:
        temporary.unlink(missing_ok=True)
    return file


def _is_left_over(path: Path, file: IO[bytes]) -> bool:
    """Whether nobody holds an open lock; then it is locked for this process, if the file system can do so."""
    try:
        pid, host = _name_in(file.read(1024))
    except ValueError:
        locked = _lock_file(file)
        return locked or (locked is None and time.time() - path.stat().st_mtime > NAMELESS_AGE)
    if host != platform.node():  # file systems of several hosts may grant a lock to two of them
        return False
    locked = _lock_file(file)
    return locked or (locked is None and not process_runs(pid))


def _own_name() -> bytes:
    return f"{os.getpid()}\n{platform.node()}\n".encode()


def _name_in(content: bytes) -> tuple[int, str]:
    """Process and host in a lock; a ValueError if they are not there, or not in full."""
    pid, host, *_, end = content.decode().split("\n")
    if end or not 0 < int(pid) < 2**31:
        raise ValueError
    return int(pid), host


def _is_held(file: IO[bytes], pid: int) -> bool:
    """Whether a process holds a lock that is open for reading; its number decides where the system cannot say."""
    free = _lock_file(file, shared=True)
    return process_runs(pid) if free is None else not free


def _lock_file(file: IO[bytes], *, shared: bool = False) -> bool | None:
    """Lock an open file until it is closed; False if another one holds it, None if the file system has no locks."""
    try:
        if os.name == "nt":
            import msvcrt

            place = file.tell()
            file.seek(BEYOND_THE_NAME)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # pyright: ignore[reportAttributeAccessIssue, reportUnknownMemberType]
            file.seek(place)
        else:
            import fcntl

            fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except OSError as error:
        return False if error.errno in BUSY else None
    return True
