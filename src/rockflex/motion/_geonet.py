"""Records in the format of GeoNet in New Zealand: V1A (uncorrected) and V2A (corrected).

A file holds the components of one instrument, one after the other: 16 lines of text, 40 integers, 60 real numbers, the
accelerations in mm/s², and in corrected files the velocities and displacements. Numbers stand in fields of 8
characters, ten a line. Format: https://www.geonet.org.nz/data/supplementary/strong_motion_file_formats. Places in the
integers and in the real numbers are counted from 1, as there.
"""

import re
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.motion._findings import Evidence, quoted_line
from rockflex.motion._fixed_width import check_lines_follow, fixed_width_numbers, lines_of
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import FoundComponent, RecordInfo, component_record_names, found_component
from rockflex.motion._recorded import UNCORRECTED, recorded_motion
from rockflex.motion._text import non_negative_or_none
from rockflex.motion._units import AccelerationUnit

TEXT_LINES, N_INTEGERS, N_REALS = 16, 40, 60
COLUMNS, WIDTH = 10, 8
UNIT = AccelerationUnit("mm/s2")
FIRST_LINE = re.compile(r"\s*+(un)?+corrected accelerogram\b(?:.*_(\d\d)\b)?", re.IGNORECASE)
SITE_LINE = re.compile(r"\s*+Site\s++(\S++)", re.IGNORECASE)
COMPONENT_LINE = re.compile(
    r"\s*+Component\s++(\S(?:(?!\s++\w++\s++Accelerometer Axis).)*+)(?:\s++(\w++)\s++Accelerometer Axis)?+",
    re.IGNORECASE,
)
MAGNITUDES = {17: "Mw", 15: "ML", 16: "Ms", 18: "mb"}  # places among the real numbers, the best scale first


@dataclass(frozen=True)
class Component:
    """The headers of a component and its accelerations in mm/s²; `uncorrected` if it was not filtered."""

    text: list[str]
    integers: list[int]
    reals: Array
    values: Array
    dt: Evidence[float]  # s
    found: FoundComponent
    uncorrected: bool

    def integer(self, place: int) -> int:
        """Return a value of the integers."""
        return self.integers[place - 1]

    def real(self, place: int) -> float:
        """Return a value of the real numbers."""
        return float(self.reals[place - 1])


def is_geonet(lines: list[str]) -> bool:
    """Return whether the lines begin as a GeoNet file does.

    CSMIP's older files begin with "Corrected accelerogram" as well, but not with a site.
    """
    return len(lines) > 1 and _first(lines[0]) is not None and SITE_LINE.match(lines[1]) is not None


def parse_geonet(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motions of all components in a GeoNet file; velocities and displacements are passed over."""
    found: list[Component] = []
    i = 0
    while i < len(lines):
        if lines[i].strip():
            component, i = _component(file, lines, i)
            found.append(component)
        else:
            i += 1
    names = component_record_names(file.stem, [each.found.name or "" for each in found])
    said, remedy = "format GeoNet", "The format states mm/s²: download the record again."
    unit = Evidence(UNIT, said)
    return [
        recorded_motion(file, each.values, said, unit, each.dt, each.found, _info(each), remedy, name)
        for each, name in zip(found, names, strict=True)
    ]


def _first(line: str) -> re.Match[str] | None:
    return FIRST_LINE.match(line[:200])


def _component(file: Path, lines: list[str], begin: int) -> tuple[Component, int]:
    """Return the component whose text begins at a place among the lines, and the place after its numbers."""
    text = lines[begin : begin + TEXT_LINES]
    first = _first(text[0])
    if first is None:
        raise InputError(
            f'{file}, line {begin + 1}: the next component is expected, with a line "Corrected accelerogram ...", but '
            f"found {text[0].strip()[:40]!r}. A line is missing or too many: download the record again."
        )
    named = COMPONENT_LINE.match(text[12][:80]) if len(text) == TEXT_LINES else None
    if named is None:
        raise InputError(
            f'{file}, line {begin + 13}: a direction is expected, such as "Component N30E" or "Component Up", but '
            f"found {' '.join(text[12:13]).strip()[:40]!r}. Download the record again."
        )
    i = begin + TEXT_LINES
    integers = fixed_width_numbers(file, lines, i, N_INTEGERS, COLUMNS, WIDTH, "integers of the header")
    i += N_INTEGERS // COLUMNS
    reals = fixed_width_numbers(file, lines, i, N_REALS, COLUMNS, WIDTH, "real numbers of the header")
    i += N_REALS // COLUMNS
    counts = [int(value) for value in integers[33:36]]
    if counts[0] < 1 or min(counts) < 0:
        raise InputError(
            f"{file}, line {begin + 20}: the numbers of accelerations, velocities and displacements are expected in "
            f"columns 4 to 6, but they are {', '.join(map(str, counts))}. Download the record again."
        )
    if not reals[25] > 0.0:
        raise InputError(
            f"{file}, line {begin + 23}: a positive time step in s is expected in column 6, but it is {reals[25]:g}. "
            "Download the record again."
        )
    values = fixed_width_numbers(file, lines, i, counts[0], COLUMNS, WIDTH, "accelerations")
    i += lines_of(counts[0], COLUMNS)
    for count, what in zip(counts[1:], ("velocities", "displacements"), strict=True):
        check_lines_follow(file, lines, i, count, COLUMNS, what)
        i += lines_of(count, COLUMNS)
    whole = [int(value) for value in integers]
    said = quoted_line(begin + 13, text[12])
    words = [Evidence(" ".join((word or "").split()), said) for word in named.groups()]
    # A file holds all directions, so its name states none.
    component = found_component(file, *words, several=True)
    dt = Evidence(float(reals[25]), f"line {begin + 23}, column 6")
    return Component(text, whole, reals, values, dt, component, first[1] is not None), i


def _info(component: Component) -> RecordInfo:
    origin = _time(component, 1, 2, 3, 4, 5)
    site = SITE_LINE.match(component.text[1][:80])
    first = _first(component.text[0])
    magnitude = next((place for place in MAGNITUDES if component.real(place) > 0.0), None)
    # Before filtering and after it.
    peak = component.real(31 if component.uncorrected else 36)
    return RecordInfo(
        event=None if origin is None else f"{origin:%Y-%m-%d %H:%M}",
        year=None if origin is None else origin.year,
        magnitude=None if magnitude is None else component.real(magnitude),
        magnitude_type=None if magnitude is None else MAGNITUDES[magnitude],
        epicentral_km=None if origin is None else non_negative_or_none(float(component.integer(30))),
        station=None if site is None else site[1],
        network="NZ",
        location=None if first is None else first[2],
        start_time=_start_time(component),
        source_format="GeoNet",
        stated_pga=abs(peak) * UNIT.si or None,
        processing=UNCORRECTED if component.uncorrected else None,
    )


def _time(component: Component, *places: int) -> datetime | None:
    """Return the time whose year, month, day, hour and minute stand in places of the integers."""
    year, month, day, hour, minute = (component.integer(place) for place in places)
    try:
        return datetime(year, month, day, hour, minute)
    except (ValueError, OverflowError):
        return None


def _start_time(component: Component) -> str | None:
    begin = _time(component, 9, 10, 19, 20, 39)
    milliseconds = component.integer(40)
    # Whether samples added before the first one come before this time is not documented.
    if begin is None or component.integer(32) or not 0 <= milliseconds < 61_000:
        return None
    try:
        return f"{(begin + timedelta(milliseconds=milliseconds)).isoformat(timespec='milliseconds')}+00:00"
    except OverflowError:
        return None
