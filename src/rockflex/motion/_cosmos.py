"""Records in the COSMOS strong-motion format: channels, each with headers of text, integers and real numbers.

Format: Consortium of Organizations for Strong-Motion Observation Systems, COSMOS Strong Motion Data Format, version
1.20 (2001). Places in headers are counted from 1, as there.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.motion import _text
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import Direction, RecordInfo, component_azimuth, component_record_names
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
# Table 9: directions of a sensor that are no azimuth.
DIRECTIONS: dict[int, tuple[str, Direction | None]] = {
    400: ("UP", "vertical"),
    401: ("DOWN", "down"),
    402: ("VERT", "vertical"),
    500: ("RADL", "horizontal"),
    501: ("TRAN", "horizontal"),
    600: ("LONG", "horizontal"),
    601: ("TANG", "horizontal"),
    700: ("H1", "horizontal"),
    701: ("H2", "horizontal"),
}
MICROVOLT = 1e-6
MAX_VS30_KM_S = 10.0  # V_s30 is in km/s below it, and in m/s above it
FIRST_LINE = re.compile(r"\(Format\s*+v[\d.]++\s*+with\s*+(\d{1,3})\s*+text lines\)", re.IGNORECASE)
BLOCK_LINE = re.compile(r"\s*+(\d{1,9})\s++(\w++(?:-header)?+)", re.IGNORECASE)
NUMBER_FORMAT = re.compile(r"Format\s*+=\s*+\(\s*+(\d{0,3}+)[IFEGD](\d{1,3}+)", re.IGNORECASE)


@dataclass
class CosmosChannel:
    """The headers of a channel, its acceleration, and the line that announces it."""

    text: list[str]
    integers: Array = field(default_factory=lambda: np.zeros(0))
    reals: Array = field(default_factory=lambda: np.zeros(0))
    values: Array | None = None
    announced: str = ""

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


def channel_unit(file: Path, channel: CosmosChannel) -> AccelerationUnit:
    """Return the unit of the samples; a count is converted with the constants of recorder and sensor."""
    code = channel.integer(3)
    if code == COUNTS_CODE:
        step, sensitivity = channel.real(22), channel.real(42)  # µV a count, V a g
        if not step or not sensitivity or step < 0.0:
            raise InputError(
                f"{file} holds raw counts, and its real header does not state the value of one count (places 22 "
                "and 42). Download the corrected record (V2)."
            )
        gain = _text.non_negative_or_none(channel.real(47)) or 1.0
        return AccelerationUnit("g", step * MICROVOLT / abs(sensitivity) / gain)
    if code in UNIT_CODES:
        return UNIT_CODES[code]
    written = re.search(r"units\s*+=\s*+([^(,]++)", channel.announced)
    unit = acceleration_unit(written[1]) if written and code is None else None
    if unit is None:
        raise InputError(
            f"{file}: the unit of the acceleration is not known: code {code} in place 3 of the integer header, "
            f"{channel.announced.strip()[:80]!r}. Download the corrected record (V2)."
        )
    return unit


def channel_time_step(file: Path, channel: CosmosChannel, n_samples: int) -> float:
    """Return the time step in s."""
    milliseconds, seconds = channel.real(62), channel.real(34)
    dt = seconds if not milliseconds else 1e-3 * milliseconds
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
    return float(f"{dt:.12g}")


def channel_record_info(file: Path, channel: CosmosChannel) -> RecordInfo:
    """Return the metadata in the headers."""
    component, direction, azimuth = _channel_direction(channel)
    lines = [*channel.text, *[""] * 13]
    code = re.search(r"Code:\s*+(\w++)-(\S++)", lines[4])
    event, year = _event_in_cosmos_header(lines[1])
    magnitude, scale = _channel_magnitude(channel)
    peak = channel.real(64)
    vs30 = _text.non_negative_or_none(channel.real(4))
    return RecordInfo(
        event=event,
        year=year,
        magnitude=magnitude,
        magnitude_type=scale,
        epicentral_km=_text.non_negative_or_none(channel.real(17)),
        vs30=None if not vs30 else 1e3 * vs30 if vs30 < MAX_VS30_KM_S else vs30,
        component=component,
        direction=direction,
        azimuth=azimuth,
        station=code and code[2],
        network=code and code[1],
        location=lines[8].partition("Location:")[2].strip() or None,
        start_time=_channel_start_time(channel, lines[7]),
        source=file.name,
        source_format="COSMOS",
        # The peak of raw counts contains their offset.
        stated_pga=None if not peak or channel.counts else abs(peak) * channel_unit(file, channel).si,
        processing="mean subtracted" if channel.counts else None,
    )


def _channel_direction(channel: CosmosChannel) -> tuple[str | None, Direction | None, float | None]:
    """Return the name, the direction and the azimuth of the component."""
    code = channel.integer(54)
    if code is None:
        stated = re.search(r"Chan\s*+\d*+\s*+:\s*+(\d{1,3}(?=\s*+deg)|Up|Down)", " ".join(channel.text[8:9]), re.I)
        codes = {"up": 400, "down": 401}
        code = None if stated is None else codes.get(stated[1].lower()) or int(stated[1])
    if code is None:
        return None, None, None
    if 0 <= code <= 360:
        return f"{code:03d}", "horizontal", component_azimuth(str(code))
    return (*DIRECTIONS.get(code, (str(code), None)), None)


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
    channels = [each for each in _read_cosmos_channels(file, lines) if each.values is not None]
    if not channels:
        raise InputError(
            f"{file} is a COSMOS file without a series of acceleration. Give the file of the acceleration."
        )
    infos = [channel_record_info(file, each) for each in channels]
    names = component_record_names(file.stem, [info.component or "channel" for info in infos])
    motions: list[GroundMotion] = []
    for channel, info, name in zip(channels, infos, names, strict=True):
        values = np.zeros(0) if channel.values is None else channel.values
        if info.processing is not None and values.size:
            values = values - values.mean()
        unit, step = channel_unit(file, channel), channel_time_step(file, channel, values.size)
        remedy = "Check the units in the integer header."
        motions.append(_text.motion_from_samples(file, values, unit, step, info, remedy, name))
    return motions


def _read_cosmos_channels(file: Path, lines: list[str]) -> list[CosmosChannel]:
    found: list[CosmosChannel] = []
    i = 0
    while i < len(lines):
        first = FIRST_LINE.search(lines[i][:500])
        block = BLOCK_LINE.match(lines[i])
        if first:
            found.append(CosmosChannel(lines[i : i + int(first[1])]))
            i += max(1, int(first[1]))
        elif block is None or not found:
            i += 1  # the end of the data of a channel, or a blank line
        elif block[2].lower() == "comment":
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
    count, columns = int(block[1]), int(form[1] or 1)
    end = i + 1 + -(-count // max(columns, 1))
    name = {"integer-header": "integers", "real-header": "reals", "acceleration": "values"}.get(block[2].lower())
    if name is not None:  # velocities and displacements are passed over
        setattr(channel, name, _fixed_width_numbers(file, lines, i + 1, end, count, int(form[2])))
    if name == "values":
        channel.announced = lines[i]
    return end


def _fixed_width_numbers(file: Path, lines: list[str], begin: int, end: int, count: int, width: int) -> Array:
    """Return numbers in fields of equal width."""
    found: list[float] = []
    for i in range(begin, min(end, len(lines))):
        line = lines[i].rstrip()
        if line.startswith("End-of-data"):
            break
        found += [_text.parse_decimal(line[k : k + width].strip(), file, i + 1) for k in range(0, len(line), width)]
    if len(found) != count:
        raise InputError(
            f"{file}, line {begin}: {count} numbers are announced, but {len(found)} follow. The file is truncated or "
            "was changed: download the record again."
        )
    return np.array(found)
