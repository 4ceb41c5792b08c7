"""Errors about a study's folder, and their messages."""
# pyright: reportUnknownParameterType=false
# (pyarrow comes without types)

import errno
import shutil
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.store._spec import listed

if TYPE_CHECKING:
    import pyarrow as pa

FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


def refuse_other_columns(path: Path, old: "pa.Schema", new: "pa.Schema", number: int | None = None) -> None:
    """Raise an error if the columns `new`, of the chunk `number` or of the file at `path`, differ from `old`."""
    if old.equals(new):
        return
    before, now = ({field.name: str(field.type) for field in schema} for schema in (old, new))
    names = [*before, *(name for name in now if name not in before)]
    lines = [f"{name}: {before.get(name)}, {now.get(name)}" for name in names if before.get(name) != now.get(name)]
    what = f"Chunk {number} has" if number is not None else f"{path} and the first part have"
    against = f" other columns than {path}" if number is not None else " other columns"
    raise InputError(
        f"{what}{against}:{listed(lines or ['the order of the columns'])}\nAll chunks must have the same columns."
    )


def refuse_foreign(folder: Path, own: set[str]) -> None:
    """Raise an error for a file, or a folder with anything but hidden files and the remains of a killed study."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder} is a file. Give a folder for the study.")
    names = sorted(path.name for path in folder.iterdir()) if folder.exists() else []
    foreign = [name for name in names if name not in own and not name.startswith(".")]
    if foreign:
        raise InputError(
            f"{folder} is not a study, and not empty ({shown(foreign[0])} is in it). Give an empty or a new folder, or "
            "that of a study."
        )


@contextmanager
def reported(folder: Path, size: int = 0) -> Generator[None]:
    """Convert system errors while writing `size` bytes into messages with a remedy."""
    try:
        yield
    except OSError as error:
        if error.errno in FULL:
            free = f"{shutil.disk_usage(folder).free / 1e6:.1f} MB are free" if folder.exists() else "it is full"
            message = (
                f"No room on the disk of {folder}: {size / 1e6:.3f} MB were to be written, {free} ({error.strerror}). "
                "The parts already written are kept. Make room and run the study again."
            )
        else:
            message = (
                f"{folder} cannot be used: {error.strerror or error}. Give a folder that you may write into. "
                "The parts already written are kept."
            )
        raise InputError(message) from error
