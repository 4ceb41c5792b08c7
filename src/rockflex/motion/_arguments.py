"""Checks of scalar arguments that this layer shares."""

import math
import operator

from rockflex._errors import InputError

__all__ = ["finite", "whole"]


def finite(name: str, value: float, unit: str) -> float:
    """Return `value` as a finite float."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        message = f"{name} must be a finite number{unit and f' in {unit}'}, but {value!r} was given."
        raise InputError(message)
    return number


def whole(name: str, value: int, low: int) -> int:
    """Return `value` as an integer of at least `low`."""
    try:
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or number < low:
        message = f"{name} must be a whole number of at least {low}, but {value!r} was given."
        raise InputError(message)
    return number
