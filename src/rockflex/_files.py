"""Files that appear whole or not at all, and that outlast a loss of power once they have appeared."""

import os
from pathlib import Path
from uuid import uuid4

__all__ = ["sweep", "write_whole"]


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
