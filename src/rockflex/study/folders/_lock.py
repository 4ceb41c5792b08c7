"""One process at a time: a file that names the process, its start and its host."""

import json
import os
import platform
import time
import weakref
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Self
from uuid import uuid4

from rockflex._errors import InputError
from rockflex._shown import shortened

LOCK = "lock"  # the name of the file
MIN_STALE_AGE = 1.0  # s; a file that stays empty for longer was left by a process killed between two calls


@dataclass(frozen=True)
class FolderLock:
    """The right to write into a folder; given up by `release`, or when the object or the process ends normally."""

    path: Path
    content: str

    @classmethod
    def acquire(cls, path: Path) -> Self:
        """Create the file, or take over the file of a dead process on this host.

        Raises
        ------
        InputError
            If a running process, or one on another host, holds it, or the path is not a file.
        """
        me = {"pid": os.getpid(), "start": _process_start(os.getpid()), "host": platform.node()}
        since = datetime.now(UTC).isoformat(timespec="seconds")
        content = json.dumps(me | {"since": since, "token": uuid4().hex})
        begin = time.monotonic()
        while True:
            try:
                descriptor = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o644)
            except FileExistsError:
                _remove_stale_lock(path, time.monotonic() - begin)
                continue
            with os.fdopen(descriptor, "w", encoding="utf-8") as file:
                file.write(content)
            lock = cls(path, content)
            weakref.finalize(lock, _release_lock, path, content)
            return lock

    def check(self) -> None:
        """Raise an `InputError` if the file is no longer this lock's: released, deleted or taken over."""
        if _lock_text(self.path) != self.content:
            raise InputError(
                f"The lock {self.path} is no longer held: the folder was closed, or the file was deleted or taken "
                "over. The parts already written are kept. Open the study again."
            )

    def release(self) -> None:
        _release_lock(self.path, self.content)


def lock_holder(path: Path) -> str | None:
    """Return which process holds a lock, in words; None if none does, or the file cannot be read."""
    try:
        holder = _parsed_lock(_lock_text(path))
    except OSError:
        return None
    if holder is None or _is_lock_holder_dead(holder):
        return None
    return _described_lock_holder(holder)


def _described_lock_holder(holder: dict[str, Any]) -> str:
    return f"process {holder['pid']} on {shortened(holder['host'])} since {shortened(holder['since'])}"


def _release_lock(path: Path, content: str) -> None:
    # A forked child inherits the object, but not the right.
    if json.loads(content)["pid"] == os.getpid() and _lock_text(path) == content:
        path.unlink(missing_ok=True)


def _remove_stale_lock(path: Path, waited: float) -> None:
    if path.exists() and not path.is_file():
        raise InputError(f"{path} is not a file, but the study's lock belongs there. Move it away and try again.")
    text = _lock_text(path)
    holder = _parsed_lock(text)
    if holder is None:
        try:
            age = time.time() - path.lstat().st_mtime
        except FileNotFoundError:
            return
        if age < 0.0:  # dated in the future, by another host's clock: our own patience counts
            age = waited
        if age < MIN_STALE_AGE:
            time.sleep(0.05)
            return
    elif not _is_lock_holder_dead(holder):
        raise InputError(
            f"{path.parent} is in use by {_described_lock_holder(holder)}. "
            f"Wait until it has finished, or end it. If it no longer runs, delete {path} and try again."
        )
    aside = path.with_name(f".{path.name}.{uuid4().hex}")
    try:
        path.rename(aside)  # succeeds for one process only
    except FileNotFoundError:
        return
    taken = _lock_text(aside)
    if taken == text:
        aside.unlink()
    else:  # another was faster and this is its new file
        aside.rename(path)


def _lock_text(path: Path) -> str | None:
    try:
        return path.read_text("utf-8", errors="surrogateescape")
    except FileNotFoundError:
        return None


def _parsed_lock(text: str | None) -> dict[str, Any] | None:
    """The process named in a lock; None if the lock is empty or damaged."""
    try:
        holder = json.loads(text or "")
        words = all(isinstance(holder[key], str) for key in ("start", "host", "since"))
        return holder if words and type(holder["pid"]) is int and 0 < holder["pid"] < 2**31 else None
    except (ValueError, TypeError, LookupError, RecursionError):
        return None


def _is_lock_holder_dead(holder: dict[str, Any]) -> bool:
    if holder["host"] != platform.node():
        return False
    start = _process_start(holder["pid"])
    # A number is given to a new process in time; the start tells them apart.
    return start is None or bool(start and holder["start"] and start != holder["start"])


def _process_start(pid: int) -> str | None:
    """Start of a process in ticks since the host started; empty if unknown, None if the process is dead."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text("utf-8").rpartition(")")[2].split()
        return None if fields[0] in "ZX" else fields[19]
    except OSError:
        pass
    if os.name == "nt":  # where signal 0 interrupts the process
        return ""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return None
    except PermissionError:
        pass
    return ""
