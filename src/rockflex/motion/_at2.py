"""Records in the AT2 format of the PEER databases, and others with NPTS and DT above values in sequence."""

import re
from datetime import date
from pathlib import Path

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path
from rockflex.motion import _text
from rockflex.motion._declared import Declared
from rockflex.motion._findings import Finding, quoted_line
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._header import MAX_LINE, NUMBERS_FIRST, header_of_lines
from rockflex.motion._record_info import RecordInfo, component_azimuth, component_direction
from rockflex.motion._sequence import Sequence, motion_of_sequence, numbers_in_lines

HEADER_LINES = 12
NPTS = re.compile(r"\bNPTS\s*+[=:]\s*+\d", re.IGNORECASE)
DT = re.compile(r"\bDT\s*+[=:]\s*+[+-]?+[.\d]", re.IGNORECASE)
TEXT = re.compile(r"\s*+[#%!]?+\s*+[A-Za-z][A-Za-z]")
DATE = re.compile(r"(\d{1,2})/(\d{1,2})/(\d{4}|\d{2})\b(?:\s++\d{1,2}:?\d{2}(?::\d{2})?(?=\s*+,))?")
FIRST_RECORDS = (
    33  # the first strong motions were recorded in 1933, so a year of two digits below it is of this century
)


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
    >>> np.savetxt("DEMO.AT2", [0.0, 0.1, -0.2, 0.0],
    ...     header="NPTS= 4, DT= .0100 SEC", comments="")
    >>> rf.read_at2("DEMO.AT2")
    GroundMotion('DEMO', 4 samples, dt=0.01 s, duration=0.03 s, pga=1.962 m/s²)
    """
    file = checked_file_path("path", path)
    motion = parse_at2(file, _text.read_text_lines(file), Declared())
    return motion if vertical is None else motion.with_vertical(read_at2(checked_file_path("vertical", vertical)))


def at2_header_end(lines: list[str]) -> int | None:
    """Return the number of lines above the values under NPTS and DT, or None if these are not stated."""
    npts = dt = False
    for i, line in enumerate(lines[:HEADER_LINES]):
        if line.lstrip().startswith(("#", "%", "!")):
            continue  # a comment in a plain text file, whose values may stand in columns
        begin = line[:MAX_LINE]
        npts, dt = npts or NPTS.search(begin) is not None, dt or DT.search(begin) is not None
        if (npts and dt) or NUMBERS_FIRST.match(begin):
            end = i + 1
            break
    else:
        return None
    # The unit may stand below; a word without a digit is no number with an error in it.
    while end < min(len(lines), HEADER_LINES) and (not lines[end].strip() or TEXT.match(lines[end])):
        end += 1
    return end


def parse_at2(file: Path, lines: list[str], given: Declared) -> GroundMotion:
    """Build the motion from the lines of an AT2 file."""
    start = at2_header_end(lines)
    header = None if start is None else header_of_lines(file, list(enumerate(lines[:start], 1)))
    if start is None or header is None or not header.counts or not header.steps:
        raise InputError(
            f"{file}: no header line with NPTS and DT among the first {HEADER_LINES} lines, such as "
            '"NPTS= 4000, DT= .00500 SEC". Read columns of numbers with read_motion instead.'
        )
    values, places = numbers_in_lines(file, lines, start)
    found = Sequence(values, places, header, header.counts[0].said)
    return motion_of_sequence(file, found, given, _at2_record_info(file, lines[:start]))


def _at2_record_info(file: Path, header: list[str]) -> RecordInfo:
    number_in_name = re.match(r"RSN(\d+)", file.name, re.IGNORECASE)
    rsn = int(number_in_name[1]) if number_in_name else None
    for number, line in enumerate(header, 1):
        when = DATE.search(line)
        if when:
            rest = [part.strip() for part in line[when.end() :].strip(" ,").split(",")]
            component = rest[-1]
            if component.endswith(")"):
                component = component.partition("(")[0].rstrip()
            direction = component_direction(file, component)
            named = component_direction(Path(), component) is not None
            said = quoted_line(number, line) if named else f'name of the file "{file.name}"'
            way = f"{component}, {direction}" if named else f"{direction}"
            return RecordInfo(
                event=line[: when.start()].strip(" ,") or None,
                year=whole_year(int(when[3])),
                station=", ".join(rest[:-1]) or None,
                component=component or None,
                direction=direction,
                findings=() if direction is None else (Finding("component", way, said),),
                azimuth=component_azimuth(component),
                source=line.strip(),
                rsn=rsn,
                source_format="AT2",
            )
    return RecordInfo(source=file.name, rsn=rsn, source_format="AT2")


def whole_year(year: int) -> int:
    """Return a year that may be written with two digits."""
    if year > 99:
        return year
    return year + (2000 if year < FIRST_RECORDS and 2000 + year <= date.today().year else 1900)
