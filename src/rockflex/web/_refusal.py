"""The answer of the server when an input cannot be used."""

from collections.abc import Generator, Mapping
from contextlib import contextmanager
from errno import EDQUOT, ENOSPC
from pathlib import Path
from tempfile import TemporaryDirectory

from rockflex.foundation.errors import InputError, SolverError

DISK_FULL = "The server's disk is full. Try again later, or tell whoever runs the server."
NOT_STORED = "the server could not store the file temporarily. Try again."


class Refusal(Exception):  # noqa: N818 - an answer, not a failure
    """Messages by the dotted path of the field at fault, such as ``structure.frame.period``; empty for none of them.

    Every function of this layer that uses what a visitor sent may raise it.
    """

    def __init__(self, errors: Mapping[str, str] | str, status: int = 422) -> None:
        self.errors = {"": errors} if isinstance(errors, str) else dict(errors)
        self.status = status
        super().__init__("; ".join(f"{path}: {text}" if path else text for path, text in self.errors.items()))


@contextmanager
def errors_as_refusals(path: str, before: str = "") -> Generator[None]:
    """Turn an error about the field at a path into a refusal, whose message begins with `before`."""
    try:
        yield
    except (InputError, SolverError) as error:
        raise Refusal({path: f"{before}{error}"}) from error


@contextmanager
def storage_as_refusals(path: str) -> Generator[None]:
    """Turn errors of the server's disk, also those put into words already, into a refusal that names no file."""
    try:
        yield
    except OSError as error:
        raise Refusal({path: DISK_FULL if _is_of_full_disk(error) else NOT_STORED}, 503) from error
    except (InputError, Refusal) as error:
        if not _is_of_full_disk(error):
            raise
        raise Refusal({path: DISK_FULL}, 503) from error


def _is_of_full_disk(error: BaseException | None) -> bool:
    """Return whether an error, or one from which it was raised, says that there is no space."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in (ENOSPC, EDQUOT):
            return True
        error = error.__cause__
    return False


@contextmanager
def temporary_folder(path: str) -> Generator[Path]:
    """Yield a temporary folder, whose errors become refusals about the field at a path."""
    with storage_as_refusals(path), TemporaryDirectory(prefix="rockflex-") as folder:
        yield Path(folder)
