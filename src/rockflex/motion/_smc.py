"""Records in the SMC format of the U.S. Geological Survey, one component a file, in cm/s².

A file holds 11 lines of text, 48 integers, 50 real numbers, comments, and the samples, eight a line in fields of ten
characters. Places in the integers and in the real numbers are counted from 1, as in the format:
https://escweb.wr.usgs.gov/nsmp-data/smcfmt.html
"""

import re
from pathlib import Path

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion import _text
from rockflex.motion._findings import Evidence, NoAccelerationError, quoted_line
from rockflex.motion._fixed_width import fixed_width_numbers
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo, found_component
from rockflex.motion._recorded import UNCORRECTED, recorded_motion
from rockflex.motion._units import AccelerationUnit

FIRST_LINE = re.compile(r"\s*+[1-9]\s++((?:(UN)?+CORRECTED\s++)?+ACCELERO|VELOC|DISPL|RESPONSE|FOURIER)", re.IGNORECASE)
TEXT_LINES = 11
INTEGERS = (48, 8, 10)  # numbers, columns and width
REALS = (50, 5, 15)
COLUMNS, WIDTH = 8, 10  # of the samples
UNIT = AccelerationUnit("cm/s2")
EVENT_LINE = re.compile(r"\s*+(\d{4})\s++(\d{1,2})\s++(\d{1,2})\s++(\d{2})(\d{2})\s++(\S.*)")
COMPONENT = re.compile(r"\bcomponent\s*+=\s*+([^\s,]++)", re.IGNORECASE)
UP, HORIZONTAL, DOWN = 0, 90, 180  # degrees from the vertical
MAGNITUDES = {"Mw": 5, "Ms": 6, "ML": 7}  # among the real numbers, from 0
TILTS = {UP: "UP", DOWN: "DOWN"}


def is_smc(lines: list[str]) -> bool:
    """Return whether the lines begin as an SMC file does."""
    return FIRST_LINE.match(lines[0][:80]) is not None


def parse_smc(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motion from the lines of an SMC file."""
    first = FIRST_LINE.match(lines[0][:80])
    if first is None or not first[1].upper().endswith("ACCELERO"):
        raise NoAccelerationError(
            f"{file}: an acceleration is expected, but the file begins with {shown(lines[0].strip()[:40])}. Give the "
            "file of the corrected accelerogram."
        )
    i = TEXT_LINES
    whole = fixed_width_numbers(file, lines, i, *INTEGERS, "integers of the header")
    i += INTEGERS[0] // INTEGERS[1]
    reals = fixed_width_numbers(file, lines, i, *REALS, "real numbers of the header")
    rate_line = i + 1
    i += REALS[0] // REALS[1]
    # The first ones stand for unknown values.
    integers = [None if value == whole[0] else int(value) for value in whole]
    real = [None if abs(value) >= abs(reals[0]) else float(value) for value in reals]
    count, rate = integers[16], real[1]
    if not count or count < 0 or not rate or rate < 0.0:
        raise InputError(
            f"{file}: a number of samples and their frequency in Hz are expected in place 17 of the integers and in "
            f"place 2 of the real numbers, but they are {count} and {rate}. Download the record again."
        )
    i += max(integers[15] or 0, 0)
    values = fixed_width_numbers(file, lines, i, count, COLUMNS, WIDTH, "accelerations")
    more = next((line for line in lines[i + -(-count // COLUMNS) :] if line.strip()), None)
    if more is not None:
        raise InputError(f"{file}: {count} samples are announced, but more follow: {shown(more.strip()[:40])}.")
    peaks = [abs(each) for each in (real[29], real[31]) if each is not None]
    named = next((found for line in lines[:TEXT_LINES] if (found := COMPONENT.search(line[:200]))), None)
    tilt, azimuth = integers[12:14]
    stated = [] if named is None else [Evidence(named[1], f'text "{named[0]}"')]
    if tilt in TILTS:
        stated.append(Evidence(TILTS[tilt], f"integers, place 13: {tilt}"))
    elif tilt == HORIZONTAL and azimuth is not None:
        stated.append(Evidence(str(azimuth), f"integers, places 13 and 14: {tilt}, {azimuth}"))
    component = found_component(file, *stated)
    dt = Evidence(float(f"{1.0 / rate:.12g}"), f"line {rate_line}, column 2: {rate:g} samples a second")
    event = EVENT_LINE.match(lines[3][:200])
    distance = _text.non_negative_or_none(real[16])
    kind = next((k for k in ("Mw", "ML", "Ms") if real[MAGNITUDES[k]]), None)
    info = RecordInfo(
        event=f"{event[6].strip()}, {event[1]}-{event[2]:0>2}-{event[3]:0>2} {event[4]}:{event[5]}" if event else None,
        year=int(event[1]) if event else None,
        magnitude=real[MAGNITUDES[kind]] if kind else None,
        magnitude_type=kind,
        epicentral_km=distance,
        station=lines[2].strip() or None,
        network="US" if "USGS" in lines[7] else None,
        source_format="SMC",
        stated_pga=UNIT.si * max(peaks) if peaks else None,
        processing=UNCORRECTED if first[2] else None,
    )
    quantity, unit = quoted_line(1, lines[0]), Evidence(UNIT, "format SMC")
    return [recorded_motion(file, values, quantity, unit, dt, component, info, "Download the record again.")]
