"""Records in the AT2 format of the PEER databases."""

import re
from pathlib import Path

import numpy as np

from rockflex._errors import InputError
from rockflex._files import checked_file_path
from rockflex.motion import _text
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo, component_azimuth, component_direction
from rockflex.motion._units import AccelerationUnit

HEADER_LINES = 12
_MAX_NPTS_DIGITS = 18  # of NPTS that are read; no file has more samples
_COUNT, _NUMBER, _APART = r"(\d++)", rf"({_text.DECIMAL.pattern})", r"(?:\s*+,\s++|\s++)"
NPTS = re.compile(rf"\bNPTS\s*+[=:]\s*+{_COUNT}", re.IGNORECASE)
DT = re.compile(rf"\bDT\s*+[=:]\s*+{_NUMBER}", re.IGNORECASE)
NUMBERS_FIRST = re.compile(rf"\s*+{_COUNT}{_APART}{_NUMBER}{_APART}NPTS\s*+,?+\s*+DT\b", re.IGNORECASE)
DATE = re.compile(r"(\d{1,2})/(\d{1,2})/(\d{4}|\d{2})\b(?:\s++\d{1,2}:?\d{2}(?::\d{2})?(?=\s*+,))?")
# Numbers may be adjacent if the next one begins with a sign; an exponent must then end before the sign.
TOKEN = re.compile(r"[+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[EeDd][+-]?\d{1,3}+)?(?=[\s,+-]|$)")


def read_at2(path: str | Path, vertical: str | Path | None = None) -> GroundMotion:
    """Read an AT2 file of a PEER strong-motion database.

    The header gives the number of samples and the time step, as ``NPTS= 4000, DT= .00500 SEC`` or as
    ``4000 0.0050 NPTS, DT``, in old and new databases alike. The values after it may be wrapped in any way, and
    adjacent values need no separator if the next one begins with a sign. They are in g by definition, and are
    multiplied by 9.81 m/s². The motion gets the name of the file, without its suffix.

    Parameters
    ----------
    path : str or Path
        The file.
    vertical : str or Path, optional
        The AT2 file of the vertical component; see `GroundMotion.with_vertical`.

    Returns
    -------
    GroundMotion
        The record. Its metadata contain the information in the title line (event, year, station, component and
        direction) and, for file names such as RSN953_..., the record sequence number.

    Raises
    ------
    InputError
        If the file is missing, empty or binary, NPTS or DT is not found, there are fewer or more values than
        NPTS, a value is not a finite number, the header states another unit than g, or the peak exceeds 5 g. With
        `vertical` also if the time steps differ, or a component is known to have the other direction.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> np.savetxt("DEMO.AT2", [0.0, 0.1, -0.2, 0.0], header="NPTS= 4, DT= .0100 SEC", comments="")
    >>> rf.read_at2("DEMO.AT2")
    GroundMotion('DEMO', 4 samples, dt=0.01 s, duration=0.03 s, pga=1.962 m/s²)
    """
    file = checked_file_path("path", path)
    motion = parse_at2(file, _text.read_text_lines(file))
    return motion if vertical is None else motion.with_vertical(read_at2(checked_file_path("vertical", vertical)))


def find_at2_header(lines: list[str]) -> tuple[int, int, str] | None:
    """Return the number of header lines, NPTS and DT, or None if there is no such header."""
    npts = dt = None
    for i, line in enumerate(lines[:HEADER_LINES]):
        if line.lstrip().startswith(("#", "%", "!")):
            continue  # a comment in a plain text file, which says nothing about units
        if bare := NUMBERS_FIRST.match(line):
            return i + 1, int(bare[1][:_MAX_NPTS_DIGITS]), bare[2]
        npts = NPTS.search(line) or npts
        dt = DT.search(line) or dt
        if npts and dt:
            return i + 1, int(npts[1][:_MAX_NPTS_DIGITS]), dt[1]
    return None


def parse_at2(file: Path, lines: list[str]) -> GroundMotion:
    """Build the motion from the lines of an AT2 file."""
    header = find_at2_header(lines)
    if header is None:
        raise InputError(
            f"{file}: no header line with NPTS and DT among the first {HEADER_LINES} lines, such as "
            '"NPTS= 4000, DT= .00500 SEC". Read columns of numbers with read_motion instead.'
        )
    start, npts, step = header
    unit = re.search(r"units\s++of\s++\(?([\w/]++)", "\n".join(lines[:start]), re.IGNORECASE)
    if unit and unit[1].upper() != "G":
        raise InputError(
            f"{file}: the header states units of {unit[1]}, but an AT2 file contains an acceleration in g. "
            "Use the AT2 file of the record, not VT2 or DT2; save values in m/s² in a plain text file."
        )
    dt = _text.parse_decimal(step, file, start)
    if dt <= 0:
        raise InputError(f"{file}, line {start}: DT must be positive, but it is {step}.")
    values = _at2_samples(file, lines, start)
    if values.size != npts:
        raise _text.wrong_sample_count_error(file, values.size, npts, f"NPTS = {npts}")
    remedy = (
        "AT2 files are in g by definition: save only the values as a text file and declare their unit, "
        f'read_motion(path, units="m/s2", dt={dt:g}).'
    )
    return _text.motion_from_samples(
        file, values, AccelerationUnit("g"), dt, _at2_record_info(file, lines[: start - 1]), remedy
    )


def _at2_samples(file: Path, lines: list[str], start: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    try:
        values = np.array([float(token) for line in lines[start:] for token in line.split()])
        if np.isfinite(values).all() and not any("_" in line for line in lines[start:]):
            return values
    except ValueError:
        pass
    # The slow way: adjacent tokens, D exponents, or an error to report.
    found: list[float] = []
    for i, line in enumerate(lines[start:], start + 1):
        position = 0
        for word in re.finditer(r"[^\s,]+", line):
            position = word.start()
            while position < word.end():
                token = TOKEN.match(line, position)
                if token is None:
                    found.append(_text.parse_decimal(line[position : word.end()], file, i))
                    break
                found.append(_text.parse_decimal(token[0], file, i))
                position = token.end()
    return np.array(found)


def _at2_record_info(file: Path, header: list[str]) -> RecordInfo:
    number_in_name = re.match(r"RSN(\d+)", file.name, re.IGNORECASE)
    rsn = int(number_in_name[1]) if number_in_name else None
    for line in header:
        date = DATE.search(line)
        if date:
            rest = [part.strip() for part in line[date.end() :].strip(" ,").split(",")]
            year = int(date[3])
            component = rest[-1]
            if component.endswith(")"):
                component = component.partition("(")[0].rstrip()
            return RecordInfo(
                event=line[: date.start()].strip(" ,") or None,
                # Two-digit years are from the database of 1999 and earlier.
                year=year if year > 99 else 1900 + year,
                station=", ".join(rest[:-1]) or None,
                component=component or None,
                direction=component_direction(file, component),
                azimuth=component_azimuth(component),
                source=line.strip(),
                rsn=rsn,
                source_format="AT2",
            )
    return RecordInfo(source=file.name, rsn=rsn, direction=component_direction(file), source_format="AT2")
