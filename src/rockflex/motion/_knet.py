"""Records in the ASCII format of K-NET and KiK-net, the networks of NIED in Japan.

Format: https://www.kyoshin.bosai.go.jp/kyoshin/man/knetform_en.html
"""

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.motion import _text
from rockflex.motion._findings import Evidence, quoted_line
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo, found_component, stem_with_component
from rockflex.motion._recorded import MEAN_SUBTRACTED, recorded_motion
from rockflex.motion._units import AccelerationUnit

HEADER_LINES = 17  # the last one is "Memo."
TRIGGER_DELAY = timedelta(seconds=15)  # of the trigger, in the recording time of the header
JAPAN_OFFSET = "+09:00"
EARTH_RADIUS_KM = 6371.0  # km, mean radius
SCALE_FACTOR = re.compile(r"([\d.]+)\s*\(\s*gal\s*\)\s*/\s*([\d.]+)", re.IGNORECASE)
# Channels of KiK-net: three in the borehole, three at the surface.
CHANNELS = {"1": "N-S", "2": "E-W", "3": "U-D", "4": "N-S", "5": "E-W", "6": "U-D"}


def is_knet(lines: list[str]) -> bool:
    """Return whether the lines begin as a K-NET file does."""
    return lines[0].lstrip().startswith("Origin Time")


def parse_knet(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motion from the lines of a K-NET or KiK-net file.

    The mean of the record is subtracted, as for the peak in the header.
    """
    header = _knet_header(file, lines)
    scale = SCALE_FACTOR.search(header["Scale Factor"])
    if scale is None or not all(_text.parse_optional_decimal(part) for part in scale.groups()):
        raise InputError(
            f'{file}: the scale factor is expected as "3920(gal)/6182761", but it is '
            f"{header['Scale Factor'][:40]!r}. Download the record again."
        )
    frequency = re.match(r"[\d.]+", header["Sampling Freq(Hz)"])
    rate = _text.parse_optional_decimal(frequency[0]) if frequency else None
    duration = _text.parse_optional_decimal(header["Duration Time(s)"])
    if not rate or not duration:
        raise InputError(
            f"{file}: a sampling frequency and a duration are expected in lines 11 and 12, but they are "
            f"{header['Sampling Freq(Hz)'][:40]!r} and {header['Duration Time(s)'][:40]!r}. Download the record again."
        )
    places = enumerate(lines[HEADER_LINES:], HEADER_LINES + 1)
    counts = np.array([_text.parse_decimal(word, file, i) for i, line in places for word in line.split()])
    if not counts.size or abs(counts.size - duration * rate) > rate:
        raise _text.wrong_sample_count_error(file, counts.size, duration * rate, f"{duration:g} s at {rate:g} Hz")
    unit = AccelerationUnit("cm/s2", float(scale[1]) / float(scale[2]))
    direction = header["Dir."].strip().upper()
    said = {line[:18].strip(): quoted_line(i, line) for i, line in enumerate(lines[:HEADER_LINES], 1)}
    component = found_component(file, Evidence(CHANNELS.get(direction, direction), said["Dir."]))
    location = None if direction not in CHANNELS else "borehole" if direction in "123" else "surface"
    info = replace(
        knet_record_info(header),
        location=location,
        source_format="KiK-net" if location else "K-NET",
        processing=MEAN_SUBTRACTED,
    )
    stated = Evidence(unit, said["Scale Factor"]), Evidence(1.0 / rate, said["Sampling Freq(Hz)"])
    remedy, name = "Check the scale factor in line 14.", stem_with_component(file)
    return [recorded_motion(file, counts - counts.mean(), "format K-NET", *stated, component, info, remedy, name)]


def _knet_header(file: Path, lines: list[str]) -> dict[str, str]:
    """Return the entries of the header by their names, the two names that vary without full stop."""
    found: dict[str, str] = {}
    for line in lines[:HEADER_LINES]:
        name = line[:18].strip()
        found[name.replace("Max.", "Max").replace("Long.", "Lon.")] = line[18:].strip()
    needed = ("Station Code", "Record Time", "Sampling Freq(Hz)", "Duration Time(s)", "Dir.", "Scale Factor")
    missing = [name for name in needed if name not in found]
    if missing:
        raise InputError(
            f"{file} begins as a K-NET file, but {', '.join(map(repr, missing))} is missing among its first "
            f"{HEADER_LINES} lines. Download the record again."
        )
    return found


def knet_record_info(header: Mapping[str, str]) -> RecordInfo:
    """Return what a header says of earthquake and station, by the names in the ASCII files of K-NET."""
    origin = _knet_time(header.get("Origin Time", ""))
    started = _knet_time(header.get("Record Time", ""))
    peak = _text.parse_optional_decimal(header.get("Max Acc. (gal)", ""))
    return RecordInfo(
        event=None if origin is None else f"{origin:%Y-%m-%d %H:%M}",
        year=None if origin is None else origin.year,
        magnitude=_text.non_negative_or_none(_text.parse_optional_decimal(header.get("Mag.", ""))),
        magnitude_type="MJMA",
        epicentral_km=_epicentral_distance(header),
        station=header.get("Station Code") or None,
        network="NIED",
        start_time=None if started is None else f"{started - TRIGGER_DELAY:%Y-%m-%dT%H:%M:%S}{JAPAN_OFFSET}",
        stated_pga=None if peak is None else 0.01 * abs(peak),
    )


def _knet_time(text: str) -> datetime | None:
    try:
        return datetime.strptime(text, "%Y/%m/%d %H:%M:%S")
    except ValueError:
        return None


def _epicentral_distance(header: Mapping[str, str]) -> float | None:
    """Return the distance along the surface of a sphere, in km, to a metre."""
    names = ("Lat.", "Lon.", "Station Lat.", "Station Lon.")
    degrees = [_text.parse_optional_decimal(header.get(name, "")) for name in names]
    places = [math.radians(each) for each in degrees if each is not None]
    if len(places) < 4:
        return None
    north, east, other_north, other_east = places
    square = math.sin((other_north - north) / 2) ** 2
    square += math.cos(north) * math.cos(other_north) * math.sin((other_east - east) / 2) ** 2
    return round(2.0 * EARTH_RADIUS_KM * math.asin(min(1.0, math.sqrt(square))), 3)
