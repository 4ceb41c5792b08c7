"""Records in the COSMOS strong-motion format: channels, each with headers of text, integers and real numbers.

Format: Consortium of Organizations for Strong-Motion Observation Systems, COSMOS Strong Motion Data Format, version
1.20 (2001). Places in headers are counted from 1, as there.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.motion import _text
from rockflex.motion._findings import Evidence, NoAccelerationError, quoted_line, settled
from rockflex.motion._fixed_width import fixed_width_numbers, lines_of
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import FoundComponent, RecordInfo, component_record_names, found_component
from rockflex.motion._recorded import MEAN_SUBTRACTED, UNCORRECTED, recorded_motion
from rockflex.motion._units import AccelerationUnit, acceleration_unit

# Table 2 of the format: the units of accelerations.
UNIT_CODES = {
    2: AccelerationUnit("g"),
    4: AccelerationUnit("cm/s2"),
    7: AccelerationUnit("in/s2"),
    10: AccelerationUnit("cm/s2"),
    11: AccelerationUnit("mg"),
    12: AccelerationUnit("mg", 1e-3),
}
COUNTS_CODE = 50
MAX_AZIMUTH = 360
HEADERS = {"integer-header": "integers", "real-header": "reals"}
# Table 9: directions of a sensor that are no azimuth.
DIRECTIONS = {
    400: "UP",
    401: "DOWN",
    402: "VERT",
    500: "RADL",
    501: "TRAN",
    600: "LONG",
    601: "TANG",
    700: "H1",
    701: "H2",
}
STAGES = (0, 1)  # of processing, in place 1 of the integer header: raw and uncorrected
MICROVOLT = 1e-6
MAX_VS30_KM_S = 10.0  # V_s30 is in km/s below it, and in m/s above it
FIRST_LINE = re.compile(r"\(Format\s*+v[\d.]++\s*+with\s*+(\d{1,3})\s*+text lines\)", re.IGNORECASE)
# The series of raw accelerations is called "raw accel.".
BLOCK_LINE = re.compile(r"\s*+(\d{1,9})\s++((?:raw\s++)?+[\w-]++)", re.IGNORECASE)
CHANNEL_LINE = re.compile(
    r"Chan?+\s*+:?+\s*+[\d?]*+\s*+:\s*+(?:(\d{1,3})(?=\s*+deg)|(Up|Down|Vert)|(Other))", re.IGNORECASE
)
SCNL = re.compile(r"\|?+\s*+<SCNL>\s*+[^.\s]++\.(\w{3})\b", re.IGNORECASE)  # the channel, between dots
NUMBER_FORMAT = re.compile(r"Format\s*+=\s*+\(\s*+(\d{0,3}+)[IFEGD](\d{1,3}+)", re.IGNORECASE)


@dataclass
class CosmosChannel:
    """The headers of a channel, its acceleration, the line that announces it, and other series that there are."""

    line: int  # the first one of the text, from 1
    text: list[str]
    integers: Array = field(default_factory=lambda: np.zeros(0))
    reals: Array = field(default_factory=lambda: np.zeros(0))
    values: Array | None = None
    announced: Evidence[str] = field(default_factory=lambda: Evidence("", ""))
    comments: list[Evidence[str]] = field(default_factory=list[Evidence[str]])
    others: list[str] = field(default_factory=list[str])

    def real(self, place: int, header: Array | None = None) -> float | None:
        """Return a value of the real header, or of another one; None if it is unknown."""
        values = self.reals if header is None else header
        return float(values[place - 1]) if place <= values.size and values[place - 1] != -999.0 else None

    def integer(self, place: int) -> int | None:
        """Return a value of the integer header; None if it is unknown."""
        value = self.real(place, self.integers)
        return None if value is None else int(value)

    @property
    def counts(self) -> bool:
        """Whether the samples are raw counts of the recorder."""
        return self.integer(3) == COUNTS_CODE


def channel_unit(file: Path, channel: CosmosChannel) -> Evidence[AccelerationUnit]:
    """Return the unit of the samples; a count is converted with the constants of recorder and sensor."""
    code = channel.integer(3)
    if code == COUNTS_CODE:
        step, sensitivity = channel.real(22), channel.real(42)  # µV a count, V a g
        if not step or not sensitivity or step < 0.0:
            raise InputError(
                f"{file} holds raw counts ({channel.announced.said}), which need scaling, and its real header does not "
                "state the value of one count (places 22 and 42). Download the corrected record (V2)."
            )
        gain = _text.non_negative_or_none(channel.real(47)) or 1.0
        said = f"raw counts; real header, places 22, 42 and 47: {step:g} µV, {sensitivity:g} V/g, gain {gain:g}"
        return Evidence(AccelerationUnit("g", step * MICROVOLT / abs(sensitivity) / gain), said)
    stated: list[Evidence[AccelerationUnit]] = []
    if code in UNIT_CODES:
        stated.append(Evidence(UNIT_CODES[code], f"integer header, place 3: {code}"))
    written = re.search(r"units\s*+=\s*+([^(,]++)", channel.announced.value)
    unit = acceleration_unit(written[1]) if written else None
    if unit is not None and (stated or code is None):
        stated.append(Evidence(unit, channel.announced.said))
    found = settled(file, "unit", stated, None, "Download the record again.", lambda one, other: one.same(other))
    if found is None:
        raise InputError(
            f"{file}: the unit of the acceleration is not known: code {code} in place 3 of the integer header, "
            f"{channel.announced.said}. Download the corrected record (V2)."
        )
    return found


def channel_time_step(file: Path, channel: CosmosChannel, n_samples: int) -> Evidence[float]:
    """Return the time step in s."""
    milliseconds, seconds = channel.real(62), channel.real(34)
    dt = seconds if not milliseconds else 1e-3 * milliseconds
    said = f"real header, place 62: {milliseconds:g} ms" if milliseconds else "real header, place 34"
    if dt is None or not dt > 0.0:
        raise InputError(
            f"{file}: no positive time step is stated in place 62 of the real header. Download the record again."
        )
    length = _text.non_negative_or_none(channel.real(63))
    if length and abs(length - n_samples * dt) > max(2.0 * dt, 0.01 * length):
        raise InputError(
            f"{file}: the header states a length of {length:g} s, but {n_samples} samples at steps of {dt:g} s last "
            f"{n_samples * dt:g} s. Download the record again."
        )
    return Evidence(float(f"{dt:.12g}"), said)


def channel_record_info(channel: CosmosChannel, unit: AccelerationUnit) -> RecordInfo:
    """Return the metadata in the headers."""
    lines = [*channel.text, *[""] * 13]
    code = re.search(r"Code:\s*+(\w++)-(\S++)", lines[4])
    event, year = _event_in_cosmos_header(lines[1])
    magnitude, scale = _channel_magnitude(channel)
    peak = channel.real(64)
    vs30 = _text.non_negative_or_none(channel.real(4))
    uncorrected = channel.counts or channel.integer(1) in STAGES
    done = [UNCORRECTED] * uncorrected + [MEAN_SUBTRACTED] * channel.counts
    return RecordInfo(
        event=event,
        year=year,
        magnitude=magnitude,
        magnitude_type=scale,
        epicentral_km=_text.non_negative_or_none(channel.real(17)),
        vs30=None if not vs30 else 1e3 * vs30 if vs30 < MAX_VS30_KM_S else vs30,
        station=code and code[2],
        network=code and code[1],
        location=lines[8].partition("Location:")[2].strip() or None,
        start_time=_channel_start_time(channel, lines[7]),
        source_format="COSMOS",
        # The peak of raw counts contains their offset.
        stated_pga=None if not peak or channel.counts else abs(peak) * unit.si,
        processing="; ".join(done) or None,
    )


def _channel_component(file: Path, channel: CosmosChannel, *, several: bool) -> FoundComponent:
    """Return the component by its code, its line of the text and its channel in a comment.

    Where the line says "Other", a code of zero is no azimuth.
    """
    code, line = channel.integer(54), " ".join(channel.text[8:9])
    written = CHANNEL_LINE.search(line)
    stated: list[Evidence[str]] = []
    if code is not None and not (written and written[3]):
        name = f"{code:03d}" if 0 <= code <= MAX_AZIMUTH else DIRECTIONS.get(code, str(code))
        stated.append(Evidence(name, f"integer header, place 54: {code}"))
    if written and (written[2] or (written[1] and int(written[1]) <= MAX_AZIMUTH)):
        stated.append(Evidence(written[2] or f"{int(written[1]):03d}", quoted_line(channel.line + 8, line)))
    stated += channel.comments
    return found_component(file, *stated, several=several)


def _event_in_cosmos_header(line: str) -> tuple[str | None, int | None]:
    """Return name and year of the earthquake in the second line of the text."""
    about = re.match(r"\s*+Re?co?rd of\s*+(.*)", line, re.IGNORECASE)
    name, _, date = (about[1] if about else "").partition("Earthquake of")
    year = re.search(r"\b(?:19|20)\d\d\b", date or name)
    # Aftershocks have the name of their main shock.
    return ", ".join(filter(None, (name.strip(), date.strip()))) or None, year and int(year[0])


def _channel_magnitude(channel: CosmosChannel) -> tuple[float | None, str | None]:
    for place, scale in ((13, "Mw"), (15, "ML"), (14, "Ms"), (16, None)):
        value = _text.non_negative_or_none(channel.real(place))
        if value:
            return value, scale
    return None, None


def _channel_start_time(channel: CosmosChannel, line: str) -> str | None:
    parts = [channel.integer(place) for place in (40, 42, 43, 44, 45)]
    seconds = channel.real(30)
    if None in parts or seconds is None or not 0.0 <= seconds < 61.0:
        return None
    year, month, day, hour, minute = (part or 0 for part in parts)
    universal = "+00:00" if re.search(r"\b(?:UTC|GMT)\b", line) else ""
    return f"{year:04d}-{month:02d}-{day:02d}T{hour:02d}:{minute:02d}:{seconds:06.3f}{universal}"


def is_cosmos(lines: list[str]) -> bool:
    """Return whether the lines begin as a COSMOS file does."""
    return FIRST_LINE.search(lines[0][:500]) is not None


def parse_cosmos(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motions of all channels of acceleration; from raw counts the mean is subtracted."""
    found = _read_cosmos_channels(file, lines)
    channels = [each for each in found if each.values is not None]
    if not channels:
        others = [other for each in found for other in each.others]
        raise NoAccelerationError(
            f"{file} is a COSMOS file without a series of acceleration: it holds {'; '.join(others) or 'none'}. Give "
            "the file of the acceleration."
        )
    components = [_channel_component(file, each, several=len(channels) > 1) for each in channels]
    names = component_record_names(file.stem, [each.name or "channel" for each in components])
    motions: list[GroundMotion] = []
    for channel, component, name in zip(channels, components, names, strict=True):
        values = np.zeros(0) if channel.values is None else channel.values
        if channel.counts and values.size:
            values = values - values.mean()
        unit, dt = channel_unit(file, channel), channel_time_step(file, channel, values.size)
        info, remedy = channel_record_info(channel, unit.value), "Check the units in the integer header."
        said = channel.announced.said
        motions.append(recorded_motion(file, values, said, unit, dt, component, info, remedy, name))
    return motions


def _read_cosmos_channels(file: Path, lines: list[str]) -> list[CosmosChannel]:
    found: list[CosmosChannel] = []
    i = 0
    while i < len(lines):
        first = FIRST_LINE.search(lines[i][:500])
        block = BLOCK_LINE.match(lines[i])
        if first:
            found.append(CosmosChannel(i + 1, lines[i : i + int(first[1])]))
            i += max(1, int(first[1]))
        elif block is None or not found:
            i += 1  # the end of the data of a channel, or a blank line
        elif block[2].lower() == "comment":
            rows = enumerate(lines[i + 1 : i + 1 + int(block[1])], i + 2)
            found[-1].comments += [
                Evidence(code[1], quoted_line(k, row)) for k, row in rows if (code := SCNL.match(row.lstrip()))
            ]
            i += 1 + int(block[1])
        else:
            i = _read_cosmos_block(file, lines, i, block, found[-1])
    return found


def _read_cosmos_block(file: Path, lines: list[str], i: int, block: re.Match[str], channel: CosmosChannel) -> int:
    """Store the numbers that a line announces, and return the number of the line after them."""
    form = NUMBER_FORMAT.search(lines[i][:500])
    if form is None or not int(form[2]):
        raise InputError(
            f'{file}, line {i + 1}: a format of numbers is expected, such as "Format=(8F10.3)". Download the record '
            "again."
        )
    count, columns, width = int(block[1]), int(form[1] or 1), int(form[2])
    what = " ".join(block[2].lower().split())
    if what in HEADERS:
        values = fixed_width_numbers(file, lines, i + 1, count, columns, width, f"values of the {what}")
        setattr(channel, HEADERS[what], values)
    elif re.match(r"(?:raw )?accel", what):
        channel.announced = Evidence(lines[i], quoted_line(i + 1, lines[i]))
        channel.values = fixed_width_numbers(file, lines, i + 1, count, columns, width, "accelerations")
    else:  # velocities and displacements are passed over
        channel.others.append(quoted_line(i + 1, lines[i]))
    return i + 1 + lines_of(count, columns)
