"""One process at a time: a file that names the process and its host."""

import os
import platform
from datetime import UTC, datetime
from pathlib import Path

from filelock import SoftFileLock, Timeout

from rockflex._errors import InputError
from rockflex._shown import shortened

LOCK = "lock"  # the name of the file
PATIENCE = 3.0  # s; filelock takes over a file that names no process once it has not changed for 2 s


def locked_folder(path: Path) -> SoftFileLock:
    """Return the right to write into the folder of the file `path`; that of a dead process on this host is taken over.

    It ends with `release`, with the object, or with the process. An `InputError` names a process that holds it.
    """
    if path.is_dir():
        raise InputError(f"{path} is not a file, but the study's lock belongs there. Move it away and try again.")
    lock = SoftFileLock(path, timeout=0, thread_local=False)
    try:
        lock.acquire(timeout=0 if lock_holder(path) else PATIENCE)
    except Timeout as error:
        holder = lock_holder(path) or "a process that left no name"
        raise InputError(
            f"{path.parent} is in use by {holder}. Wait until it has finished, or end it. If it no longer runs, delete "
            f"{path} and try again."
        ) from error
    return lock


def check_folder_locked(lock: SoftFileLock) -> None:
    """Raise an InputError if the lock is no longer held: released, or its file deleted or taken over."""
    if not (lock.is_locked and lock.is_lock_held_by_us):
        raise InputError(
            f"The lock {lock.lock_file} is no longer held: the folder was closed, or the file was deleted or taken "
            "over. The parts already written are kept. Open the study again."
        )


def lock_holder(path: Path) -> str | None:
    """Return which process holds a lock, in words; None if none does, or the file cannot be read."""
    try:
        pid, host = SoftFileLock(path).pid, path.read_text("utf-8").splitlines()[1]
        since = datetime.fromtimestamp(path.stat().st_mtime, UTC)
    except (OSError, ValueError, LookupError):
        return None
    if pid is None or (host == platform.node() and not _process_runs(pid)):
        return None
    return f"process {pid} on {shortened(host)} since {since.isoformat(timespec='seconds')}"


def _process_runs(pid: int) -> bool:
    if os.name == "nt":  # where signal 0 interrupts the process
        return True
    try:
        os.kill(pid, 0)
    except OSError as error:
        return isinstance(error, PermissionError)
    return True
