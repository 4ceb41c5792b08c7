"""Target spectra as they are written on the command line."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion import (
    UNITS,
    TargetSpectrum,
    acceleration_in,
    asce7_site_spectrum,
    asce7_spectrum,
    ec8_second_spectrum,
    ec8_spectrum,
    read_target,
)

WORDS = {"yes": True, "no": False}
Reader = Callable[[str, str], Any]


def parse_target(text: str, damping: float | None) -> TargetSpectrum:
    """Return the target of ``ec8:ag=0.25g,ground=C``, ``ec8-2024:...``, ``asce7:sds=1g,sd1=0.6g,tl=8`` or of a file.

    `damping` is the damping ratio of a target from a file; None means 5 %.

    Raises
    ------
    InputError
        If a code or a key is unknown, a key is missing or repeated, a value is no number or has no unit, or the file
        cannot be read.
    """
    code, colon, rest = text.partition(":")
    if not colon or code not in ("ec8", "ec8-2024", "asce7"):
        if not Path(text).exists():
            raise InputError(
                f"--target {shown(text)} is neither a file nor a code. Write ec8:ag=0.25g,ground=C, or "
                "ec8-2024:s_alpha=0.6g,s_beta=0.2g,site=C, or asce7:sds=1g,sd1=0.6g,tl=8, or "
                'asce7:ss=1.5g,s1=0.6g,site=D,tl=8, or name a file with the columns "period (s), sa (g)".'
            )
        return read_target(text, damping_ratio=0.05 if damping is None else damping)
    if damping is not None:
        raise InputError(
            "--damping is for a target from a file. Write ec8:...,damping=0.02; ASCE 7 has 5 %: leave --damping out."
        )
    items = _items(code, rest)
    if code == "ec8":
        given = _read(code, items, {"ag": _acceleration}, {
            "ground": _word, "type": _number, "importance": _number, "damping": _number,
        })  # fmt: skip
        return ec8_spectrum(**_renamed(given))
    if code == "ec8-2024":
        given = _read(code, items, {"s_alpha": _acceleration, "s_beta": _acceleration}, {
            "site": _word, "f_alpha": _number, "f_beta": _number, "topography": _number, "damping": _number,
        })  # fmt: skip
        factors = [given.pop(key, None) for key in ("f_alpha", "f_beta")]
        if (factors[0] is None) != (factors[1] is None):
            raise InputError(f"--target {code}:...: give both f_alpha and f_beta, or neither.")
        amplification = None if factors[0] is None else tuple(factors)
        return ec8_second_spectrum(**_renamed(given), amplification=amplification)
    if "ss" in items or "s1" in items or "site" in items:
        needed: dict[str, Reader] = {"ss": _acceleration, "s1": _acceleration, "site": _word, "tl": _number}
        return asce7_site_spectrum(**_read(code, items, needed, {"mce": _yes}))
    needed = {"sds": _acceleration, "sd1": _acceleration, "tl": _number}
    return asce7_spectrum(**_read(code, items, needed, {"mce": _yes}))


def _renamed(given: dict[str, Any]) -> dict[str, Any]:
    names = {"type": "kind", "damping": "damping_ratio"}
    return {names.get(key, key): value for key, value in given.items()}


def numbers(flag: str, text: str, least: int, most: int | None = None) -> list[float]:
    """Return numbers separated by commas.

    Raises
    ------
    InputError
        If one is not a number, or there are too few or too many.
    """
    values = [_number(flag, part.strip()) for part in text.split(",")]
    if len(values) < least or (most is not None and len(values) > most):
        count = f"{least}" if most == least else f"at least {least}"
        raise InputError(f"{flag} needs {count} numbers separated by commas, but {shown(text)} was given.")
    return values


def _items(code: str, rest: str) -> dict[str, str]:
    items: dict[str, str] = {}
    for part in filter(None, (part.strip() for part in rest.split(","))):
        key, equals, value = (each.strip() for each in part.partition("="))
        if not equals or not value or key in items:
            reason = "occurs twice" if key in items else "has no value"
            raise InputError(
                f"--target {code}:...: {shown(key)} {reason}. Write each key once, as in {code}:key=value,..."
            )
        items[key] = value
    return items


def _read(code: str, items: dict[str, str], needed: dict[str, Reader], optional: dict[str, Reader]) -> dict[str, Any]:
    readers = needed | optional
    unknown, missing = [key for key in items if key not in readers], [key for key in needed if key not in items]
    if unknown or missing:
        what = f"{shown(unknown[0])} is not known" if unknown else f"{missing[0]} is missing"
        raise InputError(
            f"--target {code}:...: {what}. The keys are {', '.join(needed)}"
            + (f", and {', '.join(optional)} if wanted." if optional else ".")
        )
    return {key: readers[key](f"--target {code}: {key}", value) for key, value in items.items()}


def _acceleration(name: str, text: str) -> float:
    value = acceleration_in(text)
    if value is None:
        raise InputError(
            f"{name} must be a number with its unit, such as 0.25g or 2.45m/s2, but {shown(text)} was given. The units "
            f"are {', '.join(UNITS)}."
        )
    return value


def _number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{name} must be a number, but {shown(text)} was given.") from None


def _word(name: str, text: str) -> str:
    del name
    return text


def _yes(name: str, text: str) -> bool:
    if text not in WORDS:
        raise InputError(f"{name} must be yes or no, but {shown(text)} was given.")
    return WORDS[text]
