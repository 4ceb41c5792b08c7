"""What the headers of a COSMOS channel mean. Places are counted from 1, as in the definition of the format."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.motion._direction import Direction, azimuth_of
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._text import known
from rockflex.motion._units import Unit, spelled

# Table 2 of the format: the units of accelerations.
PHYSICAL = {2: Unit("g"), 4: Unit("cm/s2"), 7: Unit("in/s2"), 10: Unit("cm/s2"), 11: Unit("mg"), 12: Unit("mg", 1e-3)}
COUNTS = 50
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
KM = 10.0  # V_s30 is in km/s below it, and in m/s above it


@dataclass
class Channel:
    """The headers of a channel, its acceleration, and the line that announces it."""

    text: list[str]
    integers: Array = field(default_factory=lambda: np.zeros(0))
    reals: Array = field(default_factory=lambda: np.zeros(0))
    values: Array | None = None
    announced: str = ""

    def integer(self, place: int) -> int | None:
        """Return a value of the integer header; None if it is unknown."""
        value = self.integers[place - 1] if place <= self.integers.size else -999.0
        return None if value == -999.0 else int(value)

    def real(self, place: int) -> float | None:
        """Return a value of the real header; None if it is unknown."""
        value = self.reals[place - 1] if place <= self.reals.size else -999.0
        return None if value == -999.0 else float(value)

    @property
    def counts(self) -> bool:
        """Whether the samples are raw counts of the recorder."""
        return self.integer(3) == COUNTS


def unit_of(file: Path, channel: Channel) -> Unit:
    """Return the unit of the samples; that of counts follows from the recorder and the sensor."""
    code = channel.integer(3)
    if code == COUNTS:
        step, sensitivity = channel.real(22), channel.real(42)  # µV a count, V a g
        if not step or not sensitivity or step < 0.0:
            raise InputError(
                f"{file} holds raw counts, and its real header does not state what one count is (places 22 and 42). "
                "Download the corrected record (V2)."
            )
        return Unit("g", step * MICROVOLT / abs(sensitivity) / (known(channel.real(47)) or 1.0))
    if code in PHYSICAL:
        return PHYSICAL[code]
    written = re.search(r"units\s*+=\s*+([^(,]++)", channel.announced)
    unit = spelled(written[1]) if written and code is None else None
    if unit is None:
        raise InputError(
            f"{file}: the unit of the acceleration is not known: code {code} in place 3 of the integer header, "
            f"{channel.announced.strip()[:80]!r}. Download the corrected record (V2)."
        )
    return Unit(unit)


def step_of(file: Path, channel: Channel, n_samples: int) -> float:
    """Return the time step in s."""
    milliseconds, seconds = channel.real(62), channel.real(34)
    dt = seconds if not milliseconds else 1e-3 * milliseconds
    if dt is None or not dt > 0.0:
        raise InputError(
            f"{file}: no positive time step is stated in place 62 of the real header. Download the record again."
        )
    length = known(channel.real(63))
    if length and abs(length - n_samples * dt) > max(2.0 * dt, 0.01 * length):
        raise InputError(
            f"{file}: the header states a length of {length:g} s, but {n_samples} samples at steps of {dt:g} s last "
            f"{n_samples * dt:g} s. Download the record again."
        )
    return float(f"{dt:.12g}")


def info_of(file: Path, channel: Channel) -> RecordInfo:
    """Return what the headers say of the record."""
    component, direction, azimuth = _sensor(channel)
    lines = [*channel.text, *[""] * 13]
    code = re.search(r"Code:\s*+(\w++)-(\S++)", lines[4])
    event, year = _event(lines[1])
    magnitude, scale = _magnitude(channel)
    peak = channel.real(64)
    vs30 = known(channel.real(4))
    return RecordInfo(
        event=event,
        year=year,
        magnitude=magnitude,
        magnitude_type=scale,
        epicentral_km=known(channel.real(17)),
        vs30=None if not vs30 else 1e3 * vs30 if vs30 < KM else vs30,
        component=component,
        direction=direction,
        azimuth=azimuth,
        station=code and code[2],
        network=code and code[1],
        location=lines[8].partition("Location:")[2].strip() or None,
        start_time=_start(channel, lines[7]),
        source=file.name,
        source_format="COSMOS",
        # The peak of raw counts contains their offset.
        stated_pga=None if not peak or channel.counts else abs(peak) * unit_of(file, channel).si,
        processing="mean subtracted" if channel.counts else None,
    )


def _sensor(channel: Channel) -> tuple[str | None, Direction | None, float | None]:
    """Return the name, the direction and the azimuth of the component."""
    code = channel.integer(54)
    if code is None:
        stated = re.search(r"Chan\s*+\d*+\s*+:\s*+(\d{1,3}(?=\s*+deg)|Up|Down)", " ".join(channel.text[8:9]), re.I)
        codes = {"up": 400, "down": 401}
        code = None if stated is None else codes.get(stated[1].lower()) or int(stated[1])
    if code is None:
        return None, None, None
    if 0 <= code <= 360:
        return f"{code:03d}", "horizontal", azimuth_of(str(code))
    return (*DIRECTIONS.get(code, (str(code), None)), None)


def _event(line: str) -> tuple[str | None, int | None]:
    """Return name and year of the earthquake in the second line of the text."""
    about = re.match(r"\s*+Re?co?rd of\s*+(.*)", line, re.IGNORECASE)
    name, _, date = (about[1] if about else "").partition("Earthquake of")
    year = re.search(r"\b(?:19|20)\d\d\b", date or name)
    # Aftershocks have the name of their main shock.
    return ", ".join(filter(None, (name.strip(), date.strip()))) or None, year and int(year[0])


def _magnitude(channel: Channel) -> tuple[float | None, str | None]:
    for place, scale in ((13, "Mw"), (15, "ML"), (14, "Ms"), (16, None)):
        value = known(channel.real(place))
        if value:
            return value, scale
    return None, None


def _start(channel: Channel, line: str) -> str | None:
    parts = [channel.integer(place) for place in (40, 42, 43, 44, 45)]
    seconds = channel.real(30)
    if None in parts or seconds is None or not 0.0 <= seconds < 61.0:
        return None
    year, month, day, hour, minute = (part or 0 for part in parts)
    universal = "+00:00" if re.search(r"\b(?:UTC|GMT)\b", line) else ""
    return f"{year:04d}-{month:02d}-{day:02d}T{hour:02d}:{minute:02d}:{seconds:06.3f}{universal}"
