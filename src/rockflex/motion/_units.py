"""Units as people write them, in headers, labels of columns, names of columns and arguments."""

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

Quantity = Literal["acceleration", "velocity", "displacement", "force", "counts", "spectrum", "time", "frequency"]
UNITS = {"g": GRAVITY, "m/s2": 1.0, "cm/s2": 0.01, "mm/s2": 1e-3, "mg": 1e-3 * GRAVITY, "in/s2": 0.0254}
MAX_UNIT_LENGTH = 100  # characters of a unit
# Possessive, like all of these patterns: a match is never retried in part, so no text takes long.
NUMBER = r"[+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[Ee][+-]?+\d++)?+"
FACTOR = re.compile(rf"\s*+({NUMBER})\s*+[*x]?+(?=[\s*a-zA-Z%])\s*+(.*)", re.DOTALL)
FACTOR_AFTER = re.compile(rf"([^\d*/]++(?:/[a-z]++\d?)?+)([*/])({NUMBER})")  # G*0.1, G/10
LENGTHS = {
    "m": "m",
    "meter": "m",
    "meters": "m",
    "metre": "m",
    "metres": "m",
    "cm": "cm",
    "centimeter": "cm",
    "centimeters": "cm",
    "centimetre": "cm",
    "centimetres": "cm",
    "mm": "mm",
    "millimeter": "mm",
    "millimeters": "mm",
    "millimetre": "mm",
    "millimetres": "mm",
    "in": "in",
    "inch": "in",
    "inches": "in",
    "ft": "ft",
    "foot": "ft",
    "feet": "ft",
}
SECOND = r"(?:s|sec|secs|second|seconds|seg)"
OVER = re.compile(
    rf"({'|'.join(sorted(LENGTHS, key=len, reverse=True))})"
    rf"(?:(?P<one>/{SECOND}|{SECOND}-1)|(?P<two>/\(?{SECOND}2\)?|/\(?{SECOND}/?{SECOND}\)?|/{SECOND}/{SECOND}|"
    rf"{SECOND}-2|{SECOND}-1{SECOND}-1))?"
)
BRACKET = re.compile(r"[(\[]([^)\]]*+)[)\]]")
GRAVITIES = {"g": 1.0, "g's": 1.0, "gs": 1.0, "gn": 1.0, "%g": 0.01, "percentg": 0.01, "mg": 1e-3}
GALS = {"gal": 1.0, "gals": 1.0, "galileo": 1.0, "mgal": 1e-3, "milligal": 1e-3}
COUNTS = ("count", "counts", "cnt", "cnts", "digits", "lsb")
FORCES = ("kn", "kip", "kips", "lb", "lbf", "kgf", "tf", "tonf")
FREQUENCIES = {"hz": 1.0, "hertz": 1.0, "1/s": 1.0, "cps": 1.0, "sps": 1.0, "khz": 1e3}
TIMES = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds", "seg", "segundos", "sek", "sekunden", "secondi"), 1.0),
    **dict.fromkeys(("ms", "msec", "msecs", "millisec", "millisecond", "milliseconds"), 1e-3),
    **dict.fromkeys(("us", "usec", "microsecond", "microseconds", "µs", "μs"), 1e-6),
    **dict.fromkeys(("ns", "nanosecond", "nanoseconds"), 1e-9),
    **dict.fromkeys(("min", "minute", "minutes"), 60.0),
    **dict.fromkeys(("d", "day", "days"), 86400.0),
}


@dataclass(frozen=True)
class AccelerationUnit:
    """A unit of acceleration, a key of `UNITS`, or a multiple of one, such as one count of a recorder."""

    name: str
    factor: float = 1.0  # how many of it the number 1 in the file means

    def __str__(self) -> str:
        return self.name if self.factor == 1.0 else f"{self.factor:.12g} {self.name}"

    @property
    def si(self) -> float:
        """The unit in m/s²."""
        return self.factor * UNITS[self.name]

    def same(self, other: "AccelerationUnit") -> bool:
        """Return whether both mean the same acceleration, to the digits of the standard gravity in files."""
        return abs(self.si - other.si) <= 1e-9 * other.si


@dataclass(frozen=True)
class Unit:
    """A unit of any quantity, as a file writes it; `acceleration` if it is one of those."""

    quantity: Quantity
    acceleration: AccelerationUnit | None = None
    si: float = 1.0  # of times and frequencies, in s and Hz


def parse_unit(text: str) -> Unit | None:
    """Return what a text that is nothing but a unit means, such as CM/SEC**2, (m/s/s), G*0.1 or %g; None if it is none.

    A quantity that an acceleration's unit follows from, such as counts, has no acceleration.
    """
    if len(text) >= MAX_UNIT_LENGTH:
        return None
    plain = _plain(text)
    if found := FACTOR.fullmatch(plain):
        unit = _named(found[2])
        return _multiple(unit, float(found[1]))
    if (unit := _named(plain)) is not None:
        return unit
    if found := FACTOR_AFTER.fullmatch(plain):
        number = float(found[3])
        return _multiple(_named(found[1]), number if found[2] == "*" else 1.0 / number if number else 0.0)
    return None


def _multiple(unit: Unit | None, factor: float) -> Unit | None:
    if unit is None or unit.acceleration is None or not (np.isfinite(factor) and factor > 0.0):
        return None
    return Unit("acceleration", AccelerationUnit(unit.acceleration.name, factor * unit.acceleration.factor))


def _plain(text: str) -> str:
    """Return a unit in small letters, with one way to write powers, products and minus signs."""
    text = text.strip().strip("()[]{}$\"'").rstrip(".").casefold()
    text = re.sub(r"[−–⁻]", "-", text.replace("²", "2").replace("¹", "1").replace("\\", "/"))
    text = re.sub(r"\bper\b", "/", text)
    text = re.sub(r"\b(?:squared|square)\b", "2", text)
    text = re.sub(r"\*\*|\^", "", text)
    text = re.sub(r"[{}]", "", text)  # of LaTeX
    # A star or a dot is a product between letters, as in m*s-2, and a factor before or after a number.
    text = re.sub(r"(?<=[a-z])\s*[*·.]\s*(?=[a-z])", "", text)
    return re.sub(r"[\s_]+", "", text)


def _named(plain: str) -> Unit | None:
    plain = plain.strip("()[]")
    if plain in GRAVITIES:
        factor = GRAVITIES[plain]
        return Unit("acceleration", AccelerationUnit("mg") if factor == 1e-3 else AccelerationUnit("g", factor))
    if plain in GALS:
        return Unit("acceleration", AccelerationUnit("cm/s2", GALS[plain]))
    if plain in TIMES:
        return Unit("time", si=TIMES[plain])
    if plain in FREQUENCIES:
        return Unit("frequency", si=FREQUENCIES[plain])
    if plain in COUNTS:
        return Unit("counts")
    if plain in FORCES:
        return Unit("force")
    found = OVER.fullmatch(plain)
    if found is None:
        return None
    length = LENGTHS[found[1]]
    if found["two"]:
        return Unit(
            "acceleration", AccelerationUnit("in/s2", 12.0) if length == "ft" else AccelerationUnit(f"{length}/s2")
        )
    return Unit("velocity" if found["one"] else "displacement")


def acceleration_unit(text: str) -> AccelerationUnit | None:
    """Return the unit of acceleration that a text is, such as cm/sec^2 or gal; None if it is none."""
    unit = parse_unit(text)
    return None if unit is None else unit.acceleration


def acceleration_in_text(text: str) -> float | None:
    """Return an acceleration in m/s² that is written with its unit, such as 0.25g or 2.45 m/s2; None without one."""
    found = FACTOR.fullmatch(text) if len(text) < MAX_UNIT_LENGTH else None
    unit = found and acceleration_unit(found[2])
    return None if not found or unit is None else float(found[1]) * unit.si


def declared_acceleration_unit(units: object) -> AccelerationUnit:
    """Return the unit that a caller names, with a number before it for a multiple, such as "2.4e-4 cm/s2"."""
    unit = acceleration_unit(units) if isinstance(units, str) else None
    if unit is not None:
        return unit
    raise InputError(
        f"units must be one of {', '.join(map(repr, UNITS))}, but {shown(units)} was given. If the file holds counts, "
        'write the value of one count: units="2.4e-4 cm/s2".',
        field="units",
    )


def end_of_last_bracket(text: str) -> int:
    """Return the end of the last closing bracket, so that no regular expression searches beyond it in vain."""
    return max(text.rfind(")"), text.rfind("]")) + 1
