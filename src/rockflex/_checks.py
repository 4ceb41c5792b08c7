"""Checks of arguments, with messages that say what was given, what is expected and how to mend it."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._errors import InputError

__all__ = ["finite_vector", "in_range", "positive"]

Float = NDArray[np.float64]


def positive(name: str, value: float, unit: str, *, zero: bool = False, infinite: bool = False) -> float:
    """Return `value` as a float that is positive (or zero, or infinite, where allowed)."""
    number = _number(name, value, unit)
    low_enough = number > 0 or (zero and number == 0)
    if not low_enough or math.isnan(number) or (math.isinf(number) and not infinite):
        kind = "zero or positive" if zero else "positive"
        kind += "" if infinite else ", finite"
        message = f"{name} must be a {kind} number in {unit}, but {value!r} was given."
        raise InputError(message)
    return number


def in_range(name: str, value: float, low: float, high: float, *, hint: str = "") -> float:
    """Return `value` as a float in [low, high)."""
    number = _number(name, value, "")
    if not low <= number < high:
        message = f"{name} must lie in [{low:g}, {high:g}), but {value!r} was given."
        raise InputError(f"{message} {hint}".rstrip())
    return number


def finite_vector(name: str, values: ArrayLike, unit: str) -> Float:
    """Return `values` as a read-only one-dimensional float64 array of finite numbers."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        message = f"{name} must be a sequence of numbers in {unit}, but {type(values).__name__} was given."
        raise InputError(message) from error
    if array.ndim != 1:
        message = f"{name} must be one-dimensional, but an array of shape {array.shape} was given."
        raise InputError(message)
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        message = (
            f"{name} must be finite, but {bad.size} of {array.size} values are not, the first "
            f"({array[bad[0]]}) at index {bad[0]}. Remove or repair them before use."
        )
        raise InputError(message)
    array.setflags(write=False)
    return array


def _number(name: str, value: float, unit: str) -> float:
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        of_unit = f" in {unit}" if unit else ""
        message = f"{name} must be a number{of_unit}, but {value!r} was given."
        raise InputError(message) from error
