"""Checks of the columns and curves given to a fit, and of the values at which it is evaluated."""

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_finite_vector, checked_in_range, float_array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

Curve = Callable[[Array], Array]


def log_column(name: str, values: ArrayLike, leave_out: str) -> Array:
    """Natural logarithm of a column of positive numbers; `leave_out` says which rows to drop otherwise."""
    column = checked_finite_vector(name, values, "one unit")
    bad = np.flatnonzero(column <= 0.0)
    if bad.size:
        raise InputError(
            f"{name} must be positive, as logarithms are fitted, but {bad.size} of {column.size} values are not, the "
            f"first ({column[bad[0]]:g}) in row {bad[0]}. {leave_out}"
        )
    return np.log(column)


def log_measures(im: ArrayLike, name: str = "im") -> Array:
    """Natural logarithm of a column of intensity measures, at least two different ones."""
    column = log_column(name, im, f"Leave those runs out: keep the rows with {name} > 0.")
    if column.size < 2 or np.ptp(column) == 0.0:
        raise InputError(
            f"{name} must hold at least two different values, but {np.unique(column).size} were given in "
            f"{column.size} runs. A slope needs motions of different intensity."
        )
    return column


def boolean_column(name: str, values: ArrayLike) -> Bools:
    """Boolean array of a column of true and false, or of 1 and 0."""
    numbers = float_array(values, booleans=True)
    if numbers is None:
        raise InputError(f"{name} must hold True or False for every run. Leave out the runs in which it is missing.")
    if numbers.ndim != 1:
        raise InputError(f"{name} must be one-dimensional, but an array of shape {numbers.shape} was given.")
    bad = np.flatnonzero((numbers != 0.0) & (numbers != 1.0))
    if bad.size:
        raise InputError(
            f"{name} must hold True or False (or 1 or 0) for every run, but {bad.size} of {numbers.size} values are "
            f"neither, the first ({numbers[bad[0]]:g}) in row {bad[0]}. Compare with a limit first: {name} > limit."
        )
    return numbers == 1.0


def check_same_column_length(**columns: NDArray[np.generic]) -> None:
    """Raise an InputError unless all columns have as many rows as the first."""
    sizes = {name: len(column) for name, column in columns.items()}
    if len(set(sizes.values())) > 1:
        listed = ", ".join(f"{name} has {size}" for name, size in sizes.items())
        raise InputError(
            f"The columns must have one row per run, but {listed}. Take them from the same rows of one table."
        )


def log_of_evaluation_points(im: ArrayLike, name: str = "im") -> Array:
    """Natural logarithm of the positive numbers, of any shape, at which a fit is evaluated."""
    array = float_array(im)
    if array is None:
        raise InputError(f"{name} must be a number or an array of numbers, but {type(im).__name__} was given.")
    bad = array[~(np.isfinite(array) & (array > 0.0))]
    if bad.size:
        raise InputError(
            f"{name} must be positive and finite, but {bad[0]:g} is among the values. Start a grid above zero."
        )
    return np.log(array)


def checked_probabilities(name: str, values: ArrayLike) -> Array:
    """Numbers strictly between 0 and 1, of any shape."""
    array = float_array(values)
    if array is None or not ((array > 0.0) & (array < 1.0)).all():
        raise InputError(
            f"{name} must lie between 0 and 1, but {shown(values)} was given. The 84 % quantile is {name}=0.84."
        )
    return array


def checked_confidence(confidence: float) -> float:
    """Confidence of a band, in [0, 1)."""
    return checked_in_range("confidence", confidence, 0.0, 1.0, hint="A 90 % band is confidence=0.9.")


class FragilityCurve(Protocol):
    """Any curve that gives a probability of failure at a measure."""

    def probability(self, im: Array, /) -> Array:
        """Probability of failure, of the shape of `im`."""
        ...


def checked_fragility_curve(fragility: FragilityCurve | Curve, name: str = "fragility") -> Curve:
    """Return the probability as a function of an array of measures, which checks it; `name` is for messages."""
    function: Any = getattr(fragility, "probability", fragility)
    if not callable(function):
        raise InputError(
            f"{name} must have a method probability(im), or be a function of im, but {type(fragility).__name__} was "
            "given."
        )

    def checked(im: Array) -> Array:
        given: Any = function(im)
        p = float_array(given)
        if p is None:
            raise InputError(f"{name} must give an array of probabilities, but it gave something else.")
        bad = p[~((p >= 0.0) & (p <= 1.0))]
        if bad.size:
            raise InputError(
                f"{name} must give probabilities from 0 to 1, but gave {bad[0]:g}. A part that could not be fitted "
                "gives NaN."
            )
        return p

    return checked
