"""The units in which risk programs take intensity measures; here all of them are in SI units."""

import math
import re

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown

# Names and units of OpenQuake's intensity measure types, and one of them in SI units.
_UNITS = {
    "PGA": ("g", GRAVITY),
    "PGV": ("cm/s", 0.01),
    "PGD": ("cm", 0.01),
    "SA": ("g", GRAVITY),
    "AvgSA": ("g", GRAVITY),
    "IA": ("m/s", 1.0),
    "CAV": ("g s", GRAVITY),
    "RSD": ("s", 1.0),
}
_OF_PERIOD = re.compile(r"(?P<kind>SA|AvgSA)\((?P<period>\d+\.?\d*)\)")


def unit_of(measure: str) -> tuple[str, float]:
    """Return OpenQuake's unit of a measure such as "PGV" or "SA(1.0)", and this unit in SI units.

    Raises
    ------
    InputError
        If there is no such measure.
    """
    kind, _ = parts_of(measure)
    return _UNITS[kind]


def parts_of(measure: str) -> tuple[str, str]:
    """Return the kind of a measure and its period as it is written, which is empty where there is none.

    Raises
    ------
    InputError
        If there is no such measure.
    """
    if isinstance(measure, str):  # pyright: ignore[reportUnnecessaryIsInstance]
        found = _OF_PERIOD.fullmatch(measure)
        if found and math.isfinite(float(found["period"])) and float(found["period"]) > 0.0:
            return found["kind"], found["period"]
        if measure in _UNITS and measure != "SA":
            return measure, ""
    names = ", ".join(name for name in _UNITS if name != "SA")
    raise InputError(
        f"measure must be one of {names}, SA(T) and AvgSA(T) with a period T in s, such as SA(1.0), but "
        f"{shown(measure)} was given.",
        field="measure",
    )
