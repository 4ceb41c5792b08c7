"""Records of California's CSMIP (CDMG, CGS): V1 and RAW, which are uncorrected, and V2, corrected; old and new ones.

A file holds the channels of an instrument or a structure, one after the other: lines of text, integers, real numbers,
a line that announces the accelerations with their number, step and unit, and the accelerations, eight a line. Old files
of V1 have pairs of time and acceleration instead. Format: Shakal AF, Huang MJ. Standard tape format for CSMIP
strong-motion data tapes. Report OSMS 85-03, California Division of Mines and Geology, 1985.
"""

import re
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion._findings import Evidence, NoAccelerationError, quoted_line, settled
from rockflex.motion._fixed_width import fixed_width_numbers, lines_of
from rockflex.motion._gmprocess import is_of_another_network
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo, component_record_names, found_component
from rockflex.motion._recorded import UNCORRECTED, printed_peak, recorded_motion
from rockflex.motion._units import NUMBER, AccelerationUnit, acceleration_unit

FIRST_LINE = re.compile(r"\s*+(?:UN)?+CORRECTED ACCELEROGRAM\b")
V1_MARK = "UNCORRECTED ACCELEROGRAM DATA"  # in the first line of V1, the second one of V2, the third one of V3
SPECTRA = "RESPONSE AND FOURIER AMPLITUDE SPECTRA"  # V3
END = "/&"  # begins the line after a channel
V1_LINES, V2_LINES = 13, 25  # of text
V1_NUMBERS = 14  # lines of integers and real numbers of V1
COLUMNS, PAIRED_COLUMNS = 8, 10  # numbers a line
MAX_LINE = 200  # characters of a line of text
DATA_LINE = re.compile(
    r"\s*+(\d{1,9})\s++(?:POINTS OF (ACCEL|VELOC|DISPL)\w*+ DATA|(ACCEL|VELOC|DISPL)\w*+ POINTS)\b", re.IGNORECASE
)
STEP = re.compile(rf"\bEQUALLY[- ]SPACED\s++(?:AT|INTERVALS OF)\s++({NUMBER})\s*+SEC", re.IGNORECASE)
RATE = re.compile(rf"\bAT\s++({NUMBER})\s*+(?:PTS|POINTS|SAMPLES)/SEC", re.IGNORECASE)
DATA_UNIT = re.compile(r"\bUNITS:\s*+([^)]++)\)|\bIN\s++(?:UNITS OF\s++)?+([\w/*^]++)", re.IGNORECASE)
TEXT_UNIT = re.compile(r"\bUNITS\b.*?\b(?:AND|IS)\s++([\w/*^]++)", re.IGNORECASE)
FORMAT = re.compile(r"\(([1-9]\d?+)[FE]([1-9]\d?+)\b", re.IGNORECASE)
CHANNEL = re.compile(r"\s*+CHAN\w*+\s*+\d*+\s*+:\s*+(?:(\d{1,3})\s*+DEG|(\w++))", re.IGNORECASE)
COUNT = re.compile(r"\bNO\. OF POINTS\s*+=\s*+([1-9]\d{0,8}+)", re.IGNORECASE)
PEAK = re.compile(rf"\b(?:PEAK\s++ACCEL\w*+|(?<!UNCOR )MAX)\s*+=\s*+({NUMBER})\s*+([\w/*^]++)", re.IGNORECASE)
MAGNITUDE = re.compile(r"\bM([WLS])\s*+=\s*+(\d\.\d++)", re.IGNORECASE)
TIME_ROUNDING = 1.1e-3  # s, of the difference of two printed times


@dataclass(frozen=True)
class Channel:
    """The lines of a channel in a file."""

    file: Path
    before: int  # number of the lines before them
    lines: list[str]

    @property
    def corrected(self) -> bool:
        """Whether it is of V2."""
        return V1_MARK not in self.lines[0].upper()

    @property
    def text(self) -> list[str]:
        """The lines of text."""
        return [line[:MAX_LINE] for line in self.lines[: V2_LINES if self.corrected else V1_LINES]]

    def said(self, i: int) -> str:
        """Return a line as evidence."""
        return quoted_line(self.before + i + 1, self.lines[i])

    def stated(self, pattern: re.Pattern[str], place: int | None = None) -> Evidence[re.Match[str]] | None:
        """Return the first match in the text, or in one line, with the line as evidence."""
        for i in range(len(self.text)) if place is None else [place]:
            if found := pattern.search(self.lines[i][:MAX_LINE]):
                return Evidence(found, self.said(i))
        return None

    def numbers(self, begin: int, count: int, columns: int, width: int) -> Array:
        """Return the accelerations from a line on."""
        return fixed_width_numbers(self.file, self.lines, begin, count, columns, width, "accelerations", self.before)


@dataclass(frozen=True)
class Samples:
    """Accelerations with their unit and step, and what says that they are accelerations."""

    values: Array
    unit: Evidence[AccelerationUnit]
    dt: Evidence[float]
    said: str


def is_csmip(lines: list[str]) -> bool:
    """Return whether the lines begin as a CSMIP file does; networks that took its layout over say their names."""
    first = [line[:MAX_LINE].upper() for line in lines[:3]]
    begins = FIRST_LINE.match(first[0]) or SPECTRA in first[0]
    return bool(begins) and any(V1_MARK in line for line in first) and not is_of_another_network(lines)


def parse_csmip(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motions of all channels; velocities and displacements are passed over."""
    if SPECTRA in lines[0].upper():
        raise NoAccelerationError(
            f"{file} holds response spectra ({quoted_line(1, lines[0])}), but an acceleration is expected. Give the "
            "file of V2.",
            found="spectrum",
        )
    ends = [i for i, line in enumerate(lines) if line.startswith(END)]
    channels: list[Channel] = []
    for end, other in pairwise([-1, *ends, len(lines)]):
        begin = next((i for i in range(end + 1, other) if lines[i].strip()), None)
        if begin is not None:
            channels.append(Channel(file, begin, lines[begin:other]))
    stated = [each.stated(CHANNEL) for each in channels]
    words = [
        [] if each is None else [Evidence(each.value[2] or f"{int(each.value[1]):03d}", each.said)] for each in stated
    ]
    components = [found_component(file, *each, several=len(channels) > 1) for each in words]
    names = component_record_names(file.stem, [each.name or "channel" for each in components])
    motions: list[GroundMotion] = []
    for channel, component, name in zip(channels, components, names, strict=True):
        samples = _samples(channel)
        peak = channel.stated(PEAK)
        unit, dt = samples.unit, samples.dt
        info = replace(
            _record_info(channel),
            source_format="CSMIP",
            stated_pga=peak and printed_peak(peak.value[1], peak.value[2], samples.values, unit.value),
            processing=None if channel.corrected else UNCORRECTED,
        )
        remedy = "Check the unit in the line before the samples."
        motions.append(recorded_motion(file, samples.values, samples.said, unit, dt, component, info, remedy, name))
    return motions


def _samples(channel: Channel) -> Samples:
    """Return the accelerations after the line that announces them; without one, those of pairs with times."""
    file, lines = channel.file, channel.lines
    place = next((i for i, line in enumerate(lines) if DATA_LINE.match(line[:MAX_LINE])), None)
    head = None if place is None else channel.stated(DATA_LINE, place)
    if place is None or head is None:
        return _paired_samples(channel)
    if "ACCEL" not in head.value[0].upper():
        raise NoAccelerationError(f"{file}: an acceleration is expected, but found {head.said}. Give the file of V2.")
    count, form = int(head.value[1]), channel.stated(FORMAT, place)
    columns = int(form.value[1]) if form else COLUMNS
    width = int(form.value[2]) if form else _width(lines, place + 1, min(count, columns))
    values = channel.numbers(place + 1, count, columns, width)
    after = place + 1 + lines_of(count, columns)
    if after < len(lines) and lines[after].strip() and not DATA_LINE.match(lines[after][:MAX_LINE]):
        raise InputError(
            f"{file}, line {channel.before + after + 1}: {count} accelerations are announced, but more follow: "
            f"{shown(lines[after].strip()[:40])}. Download the record again."
        )
    steps = [_step(channel, place), _step(channel)]
    return _settled_samples(channel, values, [_unit(channel, DATA_UNIT, place)], steps, head.said)


def _paired_samples(channel: Channel) -> Samples:
    """Return the accelerations of pairs of time and acceleration."""
    file, begin, count = channel.file, V1_LINES + V1_NUMBERS, channel.stated(COUNT)
    if channel.corrected or count is None:
        raise InputError(
            f"{file} begins as a file of CSMIP, but a line such as "
            '"3251 POINTS OF ACCEL DATA EQUALLY SPACED AT .020 SEC." is missing. Download the record again.'
        )
    n = int(count.value[1])
    pairs = channel.numbers(begin, 2 * n, PAIRED_COLUMNS, _width(channel.lines, begin, min(2 * n, PAIRED_COLUMNS)))
    times, values = pairs[0::2], pairs[1::2]
    dt = (times[-1] - times[0]) / max(n - 1, 1)
    if not dt > 0.0 or np.max(np.abs(times - times[0] - dt * np.arange(n))) > TIME_ROUNDING:
        raise InputError(
            f"{file}: the times of the samples are not equally spaced, as in records that were digitised from film. "
            "Give the corrected record (V2)."
        )
    steps = [_step(channel), Evidence(float(f"{dt:.6g}"), "times of the samples")]
    return _settled_samples(channel, values, [], steps, count.said)


def _width(lines: list[str], place: int, columns: int) -> int:
    """Return the width of the columns that fill a line."""
    return max(1, -(-len(lines[place].rstrip()) // max(columns, 1))) if place < len(lines) else 1


def _step(channel: Channel, place: int | None = None) -> Evidence[float] | None:
    if (found := channel.stated(STEP, place)) is not None:
        return Evidence(float(found.value[1]), found.said)
    found = channel.stated(RATE, place)
    rate = 0.0 if found is None else float(found.value[1])
    return None if found is None or not rate > 0.0 else Evidence(float(f"{1.0 / rate:.12g}"), found.said)


def _unit(channel: Channel, pattern: re.Pattern[str], place: int | None = None) -> Evidence[AccelerationUnit] | None:
    found = channel.stated(pattern, place)
    written = next(filter(None, found.value.groups()), "") if found else ""
    unit = acceleration_unit(written)
    return None if found is None or unit is None else Evidence(unit, found.said)


def _settled_samples(
    channel: Channel,
    values: Array,
    units: list[Evidence[AccelerationUnit] | None],
    steps: list[Evidence[float] | None],
    said: str,
) -> Samples:
    """Return samples with the unit and the step on which all lines agree."""
    remedy = "Download the record again."
    stated = [each for each in [*units, _unit(channel, TEXT_UNIT)] if each is not None]
    unit = settled(channel.file, "unit", stated, None, remedy, lambda one, other: one.same(other))
    written = [each for each in steps if each is not None]
    dt = settled(channel.file, "time step", written, None, remedy, lambda one, other: abs(one - other) <= 1e-3 * one)
    if unit is None or dt is None or not dt.value > 0.0:
        what = "unit" if unit is None else "time step"
        raise InputError(
            f"{channel.file}: no {what} of the accelerations is stated ({said}). Download the record again."
        )
    return Samples(values, unit, dt, said)


def _record_info(channel: Channel) -> RecordInfo:
    """Return what the text says of earthquake and station."""
    # Fields of a line are two blanks apart.
    lines = [re.split(r"\s{2,}", line.strip(), maxsplit=1)[0] for line in channel.text]
    first = 2 if channel.corrected else 1
    event = lines[first : first + 2]
    newer = event[0].partition("Record of ")[2] if event else ""
    event = newer or ", ".join(filter(None, event))
    year = re.search(r"\b(?:19|20)\d\d\b", event)
    station = channel.stated(re.compile(r"\bSTATION NO\.\s*+(\w++)", re.IGNORECASE))
    place = channel.stated(re.compile(r"\bLOCATION:\s*+(\S.*)", re.IGNORECASE))
    text = " ".join(channel.text)
    magnitudes = {kind.upper(): float(value) for kind, value in MAGNITUDE.findall(text)}
    kind = next((each for each in "WLS" if each in magnitudes), None)
    return RecordInfo(
        event=event or None,
        year=int(year[0]) if year else None,
        magnitude=magnitudes[kind] if kind else None,
        magnitude_type={"W": "Mw", "L": "ML", "S": "Ms"}[kind] if kind else None,
        station=station.value[1] if station else None,
        network="CE" if re.search(r"\b(?:CDMG|CGS|CSMIP)\b", text) else None,
        location=place.value[1].strip() if place else None,
    )
