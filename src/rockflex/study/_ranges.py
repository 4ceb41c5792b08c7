"""Ranges of scale factors, in place of a list of each."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from rockflex._checks import one_of, real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown

MOST = 1000
_ROOM = 1e-9  # of a step: the largest factor is met in spite of rounding
_EXAMPLES = (
    "{smallest = 0.5, largest = 3.0, step = 0.25}, or with a count in place of the step, and then perhaps with "
    'spacing = "logarithmic"'
)


def expanded(given: Any) -> Any:
    """Return the factors of a mapping with `smallest`, `largest` and `step` or `count`; anything else unchanged.

    Both ends are included, the largest one if a whole number of steps leads there.

    Raises
    ------
    InputError
        If a key is missing or unknown, a value is out of range, or there are more than a thousand factors.
    """
    if not isinstance(given, Mapping):
        return given
    values: dict[Any, Any] = {**given}
    spacing = values.pop("spacing", "linear")
    keys = set(values)
    logarithmic = spacing == "logarithmic"
    known = one_of(spacing, ("linear", "logarithmic")) and not (logarithmic and "step" in keys)
    smallest, largest = real_or_nan(values.get("smallest")), real_or_nan(values.get("largest"))
    if known and keys == {"smallest", "largest", "step"}:
        return stepped(smallest, largest, real_or_nan(values["step"]))
    if known and keys == {"smallest", "largest", "count"} and type(values["count"]) is int:
        count = values["count"]
        if _rises(smallest, largest) and 2 <= count <= MOST and not (logarithmic and smallest <= 0.0):
            spaced = np.geomspace if logarithmic else np.linspace
            return [_tidy(factor) for factor in spaced(smallest, largest, count)]
    raise InputError(
        f"scales must be a list, or a range such as {_EXAMPLES}, of at most {MOST} factors, but {shown(given)} was "
        "given.",
        field="scales",
    )


def parsed(text: str) -> list[float]:
    """Return the factors of a text: a number, or a range such as ``0.5:3.0:0.25`` of smallest, largest and step.

    Raises
    ------
    InputError
        If the text is neither.
    """
    numbers = [_number(part) for part in text.split(":")]
    if None in numbers or len(numbers) not in (1, 3):
        raise InputError(
            f"scales must be numbers, or ranges such as 0.5:3.0:0.25, but {shown(text)} was given.", field="scales"
        )
    found = [number for number in numbers if number is not None]
    return found if len(found) == 1 else stepped(*found)


def stepped(smallest: float, largest: float, step: float) -> list[float]:
    """Return the factors from the smallest in steps up to the largest.

    Raises
    ------
    InputError
        If they do not rise, or are too many.
    """
    if _rises(smallest, largest) and 0.0 < step < math.inf:
        steps = (largest - smallest) / step + _ROOM
        if 1.0 <= steps < MOST:
            return [_tidy(smallest + place * step) for place in range(int(steps) + 1)]
    raise InputError(
        f"scales must rise in 1 to {MOST - 1} steps, but a range from {smallest:g} to {largest:g} in steps of {step:g} "
        "was given.",
        field="scales",
    )


def _rises(smallest: float, largest: float) -> bool:
    return -math.inf < smallest < largest < math.inf


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _tidy(factor: float) -> float:
    """The factor without the rounding of its sum, such as 0.3 in place of 0.30000000000000004."""
    return float(f"{factor:.12g}")
