"""Checks of arguments that the modal and structure layers share."""

import operator
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._checks import finite_vector, in_range
from rockflex._errors import InputError

__all__ = ["damping_ratios", "dimensions", "finite_matrix", "mode_count", "whole_number"]

Float = NDArray[np.float64]

_DAMPING_HINT = "Give the fraction of critical damping: 2 % is 0.02."


def whole_number(name: str, value: SupportsIndex, low: int, high: int | None = None) -> int:
    """Return `value` as an int of at least `low` and at most `high`; booleans and floats are refused."""
    span = f"of at least {low}" if high is None else f"from {low} to {high}"
    message = f"{name} must be a whole number {span}, but {value!r} was given."
    if isinstance(value, bool | np.bool_):
        raise InputError(message)
    try:
        number = operator.index(value)
    except TypeError as error:
        raise InputError(message) from error
    if number < low or (high is not None and number > high):
        raise InputError(message)
    return number


def mode_count(n_modes: SupportsIndex | None, available: int) -> int:
    """Return the number of modes asked for; None asks for all that are available."""
    return available if n_modes is None else whole_number("n_modes", n_modes, 1, available)


def damping_ratios(name: str, values: ArrayLike, n_modes: int) -> Float:
    """Return one damping ratio in [0, 1) a mode, read-only, from one number or from `n_modes` numbers."""
    if dimensions(values) == 0:
        ratio = in_range(name, values, 0.0, 1.0, hint=_DAMPING_HINT)  # pyright: ignore[reportArgumentType]
        ratios = np.full(n_modes, ratio)
        ratios.setflags(write=False)
        return ratios
    ratios = finite_vector(name, values, "fractions of critical damping")
    if ratios.size != n_modes:
        message = f"{name} must be one number, or one for each of the {n_modes} modes, but {ratios.size} were given."
        raise InputError(message)
    outside = np.flatnonzero((ratios < 0.0) | (ratios >= 1.0))
    if outside.size:
        first = int(outside[0])
        in_range(f"{name}[{first}]", float(ratios[first]), 0.0, 1.0, hint=_DAMPING_HINT)
    return ratios


def dimensions(values: ArrayLike) -> int:
    """Return the number of dimensions of `values`; 1 for ragged rows, which a later check refuses."""
    try:
        return np.ndim(values)
    except ValueError:
        return 1


def finite_matrix(name: str, values: ArrayLike, unit: str, shape: tuple[int, int]) -> Float:
    """Return a float64 copy of `values` that has the given shape and finite entries only."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        message = f"{name} must be a matrix of numbers in {unit}, but {type(values).__name__} was given."
        raise InputError(message) from error
    if array.shape != shape:
        message = f"{name} must have the shape {shape}, but an array of shape {array.shape} was given."
        raise InputError(message)
    if not np.isfinite(array).all():
        row, column = (int(i) for i in np.argwhere(~np.isfinite(array))[0])
        message = f"{name} must be finite, but its entry [{row}, {column}] is {array[row, column]}."
        raise InputError(message)
    return array
