"""Records in the ASCII format of the Engineering Strong-Motion database (ESM) and of ITACA, DYNA 1.2.

A header of lines ``KEY: value``, and one sample a line after it. The database and its format: Luzi L et al. The
Engineering Strong-Motion Database: a platform to access pan-European accelerometric data. *Seismol Res Lett*
2016;87(4):987–997; https://esm-db.eu.
"""

import re
from pathlib import Path

import numpy as np

from rockflex._errors import InputError
from rockflex.motion import _text
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo, component_azimuth, component_direction
from rockflex.motion._units import acceleration_unit

ENTRY = re.compile(r"([A-Z][A-Z0-9_/^ -]*+):(.*)")
FIRST_KEYS = ("EVENT_NAME:", "EVENT_ID:")
EVENT_TIME = re.compile(r"(\d{4})(\d{2})(\d{2})(\d{2})(\d{2})\d{2}")
START_TIME = re.compile(r"(\d{4})(\d{2})(\d{2})_(\d{2})(\d{2})(\d{2}(?:\.\d{1,6})?)")


def is_esm(lines: list[str]) -> bool:
    """Return whether the lines begin as an ESM file does."""
    return lines[0].lstrip().startswith(FIRST_KEYS)


def parse_esm(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motion from the lines of an ESM file."""
    entries = [ENTRY.fullmatch(line.strip()) for line in lines]
    start = next((i for i, entry in enumerate(entries) if entry is None and lines[i].strip()), len(lines))
    header = {entry[1].strip(): entry[2].strip() for entry in entries[:start] if entry}
    dt = _text.parse_optional_decimal(header.get("SAMPLING_INTERVAL_S", ""))
    n_samples = _text.parse_optional_decimal(header.get("NDATA", ""))
    if not dt or dt <= 0.0 or n_samples is None:
        raise InputError(
            f"{file}: a positive SAMPLING_INTERVAL_S and NDATA are expected in the header of an ESM file, but they are "
            f"{header.get('SAMPLING_INTERVAL_S', '')[:40]!r} and {header.get('NDATA', '')[:40]!r}. Download the record "
            "again."
        )
    kind = header.get("DATA_TYPE", "ACCELERATION").upper()
    if kind != "ACCELERATION":
        raise InputError(
            f"{file}: an acceleration is expected, but DATA_TYPE is {kind[:40]!r}. Use the file of the acceleration, "
            "whose name contains ACC."
        )
    unit = acceleration_unit(header.get("UNITS", ""))
    if unit is None:
        raise InputError(
            f"{file}: UNITS is {header.get('UNITS', '')[:40]!r}, but an acceleration is expected, such as cm/s^2. "
            "Download the processed record."
        )
    values = np.array(
        [_text.parse_decimal(line.strip(), file, i) for i, line in enumerate(lines[start:], start + 1) if line.strip()]
    )
    if values.size != n_samples:
        raise _text.wrong_sample_count_error(file, values.size, n_samples, f"NDATA = {n_samples:g}")
    info = _esm_record_info(file, header)
    return [_text.motion_from_samples(file, values, unit, dt, info, "Check UNITS in the header.")]


def _esm_record_info(file: Path, header: dict[str, str]) -> RecordInfo:
    component = header.get("STREAM") or None
    moment, local = (
        _text.non_negative_or_none(_text.parse_optional_decimal(header.get(f"MAGNITUDE_{scale}", ""))) for scale in "WL"
    )
    year = header.get("EVENT_DATE_YYYYMMDD", "")[:4]
    stamp = START_TIME.match(header.get("DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS", ""))
    peak = _text.parse_optional_decimal(header.get("PGA_CM/S^2", ""))
    event = [header.get("EVENT_NAME", ""), header.get("EVENT_ID", "")]
    name = next((each for each in event if each not in ("", "None")), None)
    when = EVENT_TIME.fullmatch(header.get("EVENT_DATE_YYYYMMDD", "") + header.get("EVENT_TIME_HHMMSS", ""))
    return RecordInfo(
        # Many earthquakes are named after their region, so the time of origin is added.
        event=name if name is None or when is None else "{} {}-{}-{} {}:{}".format(name, *when.groups()),
        year=int(year) if year.isdecimal() and year.isascii() else None,
        magnitude=local if moment is None else moment,
        magnitude_type=None if moment is None and local is None else "ML" if moment is None else "Mw",
        epicentral_km=_text.non_negative_or_none(
            _text.parse_optional_decimal(header.get("EPICENTRAL_DISTANCE_KM", ""))
        ),
        vs30=_text.non_negative_or_none(_text.parse_optional_decimal(header.get("VS30_M/S", ""))) or None,
        component=component,
        direction=component_direction(file, component),
        azimuth=component_azimuth(component),
        station=header.get("STATION_CODE") or None,
        network=header.get("NETWORK") or None,
        location=header.get("LOCATION") or None,
        start_time=None if stamp is None else "{}-{}-{}T{}:{}:{}+00:00".format(*stamp.groups()),
        source=file.name,
        source_format="ESM",
        stated_pga=None if peak is None else 0.01 * abs(peak),
        event_id=event[1] if event[1] not in ("", "None") else None,
    )
