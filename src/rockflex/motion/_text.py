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
from rockflex.motion._units import Unit

LIMIT = 5.0  # in g; no recorded ground acceleration comes near it
# Possessive, like all of these patterns: a match is never retried in part, so no text takes long.
DECIMAL = re.compile(r"[+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[EeDd][+-]?+\d++)?+")


def read_content(path: str | Path) -> bytes:
    """Return the bytes of a file, or raise an error that explains why it cannot be read."""
    file = Path(path)
    if file.is_dir():
        raise InputError(f"{file} is a directory. Read all its records with read_suite({shown(str(file))}).")
    check_regular(file)
    try:
        return file.read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"{file} does not exist (working directory: {Path.cwd()}).") from error
    except OSError as error:
        raise InputError(f"{file} cannot be read: {error.strerror}.") from error


def read_lines(path: str | Path) -> list[str]:
    """Return the lines of a text file, or raise an error that explains why it cannot be read."""
    return lines_of(Path(path), read_content(path))


def lines_of(file: Path, content: bytes) -> list[str]:
    """Return the lines in the bytes of a text file.

    Raises
    ------
    InputError
        If it is binary or empty.
    """
    text = decoded(content)
    if text is None:
        raise InputError(f"{file} is a binary file; a record is expected as text (AT2, CSV or columns).")
    if not text.strip():
        raise InputError(f"{file} is empty.")
    return re.split("\r\n|\r|\n", text)


def decoded(data: bytes) -> str | None:
    """Return the text in the bytes of a file, or None if they are no text."""
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


def real(text: str) -> float | None:
    """Return the number in a field of a header, or None if there is none."""
    if not DECIMAL.fullmatch(text.strip()):
        return None
    value = float(re.sub("[Dd]", "E", text.strip()))
    return value if np.isfinite(value) else None


def known(value: float | None) -> float | None:
    """Return a value that a header or table gives; -999 and other negative numbers stand for an unknown one."""
    return None if value is None or not value >= 0.0 else value


def build_motion(
    file: Path, values: Array, unit: Unit, dt: float, info: RecordInfo, remedy: str, name: str | None = None
) -> GroundMotion:
    """Build a motion named after its file."""
    acceleration = acceleration_of(file, values, unit, remedy, info.scale)
    try:
        return GroundMotion(acceleration, dt, name=file.stem if name is None else name, metadata=info)
    except InputError as error:
        raise InputError(f"{file}: {error}") from error


def acceleration_of(file: Path, values: Array, unit: Unit, remedy: str, scale: float | None = None) -> Array:
    """Convert to m/s² and reject amplitudes that indicate a wrong unit, unless a factor on the record explains them."""
    with np.errstate(over="ignore"):
        acceleration = values * unit.si
    peak = float(np.max(np.abs(values), initial=0.0))
    if peak * unit.si > LIMIT * GRAVITY * max(abs(scale or 1.0), 1.0):
        smaller = {"g": "m/s² or cm/s²", "m/s2": "cm/s²"}.get(str(unit), "a smaller unit")
        raise InputError(
            f"{file}: the peak acceleration is {peak:g} {unit}, above {LIMIT:g} g. "
            f"It looks like {smaller}, although {unit} was declared. {remedy} If the values are correct, "
            "build GroundMotion(acceleration, dt) from the array; motions can be scaled without limit.",
            field="units",
        )
    return acceleration
