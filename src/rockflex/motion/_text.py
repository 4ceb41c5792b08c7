"""Reading the text of a record file, and the checks common to all formats."""

import re
from pathlib import Path

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._files import check_regular
from rockflex._shown import shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo

UNITS = {"g": GRAVITY, "m/s2": 1.0, "cm/s2": 0.01}
LIMIT = 5.0  # in g; no recorded ground acceleration comes near it
# Possessive, like all of these patterns: a match is never retried in part, so no text takes long.
DECIMAL = re.compile(r"[+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[EeDd][+-]?+\d++)?+")


def read_lines(path: str | Path) -> list[str]:
    """Return the lines of a text file, or raise an error that explains why it cannot be read."""
    file = Path(path)
    if file.is_dir():
        raise InputError(f"{file} is a directory. Read all its records with read_suite({shown(str(file))}).")
    check_regular(file)
    try:
        data = file.read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"{file} does not exist (working directory: {Path.cwd()}).") from error
    except OSError as error:
        raise InputError(f"{file} cannot be read: {error.strerror}.") from error
    text = _decode(data)
    if text is None:
        raise InputError(f"{file} is a binary file; a record is expected as text (AT2, CSV or columns).")
    if not text.strip():
        raise InputError(f"{file} is empty.")
    return re.split("\r\n|\r|\n", text)


def _decode(data: bytes) -> str | None:
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    # Latin-1 accepts every byte, so it comes last; old headers use it.
    for encoding in ("utf-16",) if wide else ("utf-8-sig", "latin-1"):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        text = text.rstrip("\x1a")
        return None if re.search(r"[\x00-\x08\x0e-\x1b\x7f]", text) else text
    return None


def number(token: str, file: str | Path, line: int) -> float:
    """Return a decimal number (also with a Fortran D exponent), or raise an error that names the line."""
    if DECIMAL.fullmatch(token):
        value = float(re.sub("[Dd]", "E", token))
        if np.isfinite(value):
            return value
    hint = " Write decimals with a point." if re.fullmatch(r"[+-]?+\d++,\d++", token) else ""
    raise InputError(f"{file}, line {line}: expected a finite number, but found {token[:40]!r}.{hint}")


def build_motion(file: Path, values: Array, units: str, dt: float, info: RecordInfo, remedy: str) -> GroundMotion:
    """Build a motion named after its file."""
    acceleration = acceleration_of(file, values, units, remedy)
    try:
        return GroundMotion(acceleration, dt, name=file.stem, metadata=info)
    except InputError as error:
        raise InputError(f"{file}: {error}") from error


def acceleration_of(file: Path, values: Array, units: str, remedy: str) -> Array:
    """Convert to m/s² and reject amplitudes that indicate a wrong unit."""
    acceleration = values * UNITS[units]
    peak = float(np.max(np.abs(values), initial=0.0))
    if peak * UNITS[units] > LIMIT * GRAVITY:
        smaller = {"g": "m/s² or cm/s²", "m/s2": "cm/s²", "cm/s2": "a smaller unit"}[units]
        raise InputError(
            f"{file}: the peak acceleration is {peak:g} {units}, above {LIMIT:g} g. "
            f"It looks like {smaller}, although {units} was declared. {remedy} If the values are correct, "
            "build GroundMotion(acceleration, dt) from the array; motions can be scaled without limit.",
            field="units",
        )
    return acceleration
