"""Change record files at random and read them: every one is read, or refused by an InputError, soon.

Needs atheris: ``pip install atheris``, then ``python scripts/fuzz_readers.py FOLDER -max_total_time=600``, with a
folder of files to begin with. A file that raises something else, or takes longer than PATIENCE, ends the run, and is
kept.
"""

import sys
import tempfile
import time
import warnings
from contextlib import suppress
from pathlib import Path

import atheris  # pyright: ignore[reportMissingImports]

with atheris.instrument_imports(include=["rockflex.motion"]):
    import rockflex as rf
    from rockflex.motion import read_components, read_target

PATIENCE = 5.0  # s
SUFFIXES = (".txt", ".AT2", ".csv", ".V2", ".smc", ".asc", ".DAT", ".xlsx")
FOLDER = Path(tempfile.mkdtemp())


def read(data: bytes) -> None:
    """Read a file whose first byte chooses the suffix, and what the caller says."""
    if not data:
        return
    file = FOLDER / f"record{SUFFIXES[data[0] % len(SUFFIXES)]}"
    file.write_bytes(data[1:])
    given = {"units": "g", "dt": 0.01} if data[0] & 64 else {}
    start = time.monotonic()
    with suppress(rf.InputError):
        read_components(file, **given)  # pyright: ignore[reportArgumentType]
    if data[0] & 128:
        with suppress(rf.InputError):
            read_target(file, units="g" if given else None)
    if time.monotonic() - start > PATIENCE:
        raise TimeoutError(f"{len(data)} bytes took {time.monotonic() - start:.1f} s")


warnings.simplefilter("ignore")
atheris.Setup(sys.argv, read)
atheris.Fuzz()
