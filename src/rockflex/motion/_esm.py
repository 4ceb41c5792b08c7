"""Records with a header of lines ``KEY: value`` and one sample a line: of ESM, ITACA and AFAD.

These are the Engineering Strong-Motion database and ITACA (DYNA 1.2; ITACA also before DYNA), and Turkey's TADAS, which
has lines ``AAD_...`` of its own before these. The database and its format: Luzi L et al. The Engineering Strong-Motion
Database: a platform to access pan-European accelerometric data. *Seismol Res Lett* 2016;87(4):987–997;
https://esm-db.eu.
"""

import re
from pathlib import Path

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion import _text
from rockflex.motion._findings import Evidence, NoAccelerationError, quoted_line
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo, found_component
from rockflex.motion._recorded import UNCORRECTED, recorded_motion
from rockflex.motion._units import acceleration_unit

ENTRY = re.compile(r"([A-Z][A-Z0-9_/^ -]*+):(.*)")
FIRST_KEYS = ("EVENT_NAME:", "EVENT_ID:")
TADAS_KEY = "AAD_"
ACCELERATION = re.compile(r"(?:(?:UN)?PROCESSED |(?:UN)?CORRECTED |CONVERTED |RAW )?ACCELERATION")
NOT_CORRECTED = re.compile(r"\b(?:UNPROCESSED|UNCORRECTED|RAW|UNFILTERED|BASELINE NOT REMOVED)\b")
EVENT_TIME = re.compile(r"(\d{4})(\d{2})(\d{2})(\d{2})(\d{2})\d{2}.*+")
START_TIME = re.compile(r"(\d{4})/?+(\d{2})/?+(\d{2})[_ ](\d{2}):?+(\d{2}):?+(\d{2}(?:\.\d{1,6})?)")


class Header(dict[str, str]):
    """The values in a header by their keys, with the lines that they stand in; empty where a key is missing."""

    def __init__(self, lines: list[str]) -> None:
        found = [(i, entry) for i, line in enumerate(lines, 1) if (entry := ENTRY.fullmatch(line.strip()))]
        super().__init__((entry[1].strip(), entry[2].strip()) for _, entry in found)
        self._said = {entry[1].strip(): quoted_line(i, entry[0]) for i, entry in found}

    def __missing__(self, key: str) -> str:
        return ""

    def said(self, key: str) -> str:
        """Return the line of a key as evidence."""
        return self._said[key]

    def number(self, key: str) -> float | None:
        """Return a value as a number; None if it is none."""
        return _text.parse_optional_decimal(self[key])


def is_esm(lines: list[str]) -> bool:
    """Return whether the lines begin as a file of ESM, ITACA or TADAS does."""
    return lines[0].lstrip().startswith((*FIRST_KEYS, TADAS_KEY))


def parse_esm(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motion from the lines of a file."""
    heads = [bool(ENTRY.fullmatch(line.strip())) or line.lstrip().startswith(TADAS_KEY) for line in lines]
    start = next((i for i, head in enumerate(heads) if not head and lines[i].strip()), len(lines))
    header = Header(lines[:start])
    kind = header["DATA_TYPE"].upper()
    if kind and not ACCELERATION.fullmatch(kind):
        raise NoAccelerationError(
            f"{file}: an acceleration is expected, but DATA_TYPE is {kind[:40]!r} ({header.said('DATA_TYPE')}). Use "
            "the file of the acceleration, whose name contains ACC.",
            found=kind[:40].lower(),
        )
    dt, n_samples = header.number("SAMPLING_INTERVAL_S"), header.number("NDATA")
    if not dt or dt <= 0.0 or n_samples is None:
        raise InputError(
            f"{file}: a positive SAMPLING_INTERVAL_S and NDATA are expected in the header of an ESM file, but they are "
            f"{shown(header['SAMPLING_INTERVAL_S'])} and {shown(header['NDATA'])}. Download the record again."
        )
    unit = acceleration_unit(header["UNITS"])
    if unit is None:
        raise InputError(
            f"{file}: UNITS is {shown(header['UNITS'])}, but an acceleration is expected, such as cm/s^2. "
            "Download the processed record."
        )
    values = np.array(
        [_text.parse_decimal(line.strip(), file, i) for i, line in enumerate(lines[start:], start + 1) if line.strip()]
    )
    if values.size != n_samples:
        raise _text.wrong_sample_count_error(file, values.size, n_samples, f"NDATA = {n_samples:g}")
    key = "STREAM" if header["STREAM"] else "COMPONENT"  # of ITACA before DYNA
    component = found_component(file, *([Evidence(header[key], header.said(key))] if header[key] else []))
    quantity = header.said("DATA_TYPE" if kind else "UNITS")
    stated = Evidence(unit, header.said("UNITS")), Evidence(dt, header.said("SAMPLING_INTERVAL_S"))
    info = _esm_record_info(lines, header)
    return [recorded_motion(file, values, quantity, *stated, component, info, "Check UNITS in the header.")]


def _esm_record_info(lines: list[str], header: Header) -> RecordInfo:
    moment, local = (_text.non_negative_or_none(header.number(f"MAGNITUDE_{scale}")) for scale in "WL")
    year = header["EVENT_DATE_YYYYMMDD"][:4]
    stamp = START_TIME.match(header["DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS"])
    peak = header.number("PGA_CM/S^2")
    event = [header["EVENT_NAME"], header["EVENT_ID"]]
    name = next((each for each in event if each not in ("", "None")), None)
    when = EVENT_TIME.fullmatch(re.sub(r"[/:]", "", header["EVENT_DATE_YYYYMMDD"] + header["EVENT_TIME_HHMMSS"]))
    tadas = lines[0].lstrip().startswith(TADAS_KEY)
    kinds = " ".join([lines[0].replace("_", " ") if tadas else "", header["DATA_TYPE"], header["BASELINE_CORRECTION"]])
    return RecordInfo(
        # Many earthquakes are named after their region, so the time of origin is added.
        event=name if name is None or when is None else "{} {}-{}-{} {}:{}".format(name, *when.groups()),
        year=int(year) if year.isdecimal() and year.isascii() else None,
        magnitude=local if moment is None else moment,
        magnitude_type=None if moment is None and local is None else "ML" if moment is None else "Mw",
        epicentral_km=_text.non_negative_or_none(header.number("EPICENTRAL_DISTANCE_KM")),
        vs30=_text.non_negative_or_none(header.number("VS30_M/S")) or None,
        station=header["STATION_CODE"] or None,
        network=header["NETWORK"] or None,
        location=header["LOCATION"] or None,
        start_time=None if stamp is None else "{}-{}-{}T{}:{}:{}+00:00".format(*stamp.groups()),
        source_format="TADAS" if tadas else "ESM" if header["HEADER_FORMAT"] else "ITACA",
        stated_pga=None if peak is None else 0.01 * abs(peak),
        processing=UNCORRECTED if NOT_CORRECTED.search(kinds.upper()) else None,
        event_id=event[1] if event[1] not in ("", "None") else None,
    )
