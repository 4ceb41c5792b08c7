"""Checks of arguments, with messages that state what was given, what is expected and how to correct it."""

import math
import operator
import sys
from collections.abc import Collection, Iterable, Sequence
from contextlib import suppress
from numbers import Real
from typing import Any, SupportsIndex, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun, shown

T = TypeVar("T")

_NO_NUMBERS = bool, np.bool_, str, bytes, bytearray, complex, np.complexfloating
_IN_WORDS = {"c": "complex numbers", "S": "texts", "U": "texts", "b": "booleans"}
_DAMPING_HINT = "Give the fraction of critical damping: 2 % is 0.02."


def checked_positive(name: str, value: float, unit: str, *, zero: bool = False, infinite: bool = False) -> float:
    """Return `value` as a positive float (or zero, or infinity, if allowed)."""
    number = _checked_number(name, value, unit)
    low_enough = number > 0 or (zero and number == 0)
    if not low_enough or math.isnan(number) or (math.isinf(number) and not infinite):
        kind = "zero or positive" if zero else "positive"
        kind += "" if infinite else ", finite"
        measured = f" in {unit}" if unit else ""
        raise InputError(f"{name} must be a {kind} number{measured}, but {shown(value)} was given.", field=name)
    return number


def checked_in_range(
    name: str, value: float, low: float, high: float, *, closed: bool = False, hint: str = "", field: str | None = None
) -> float:
    """Return `value` as a float in [low, high), or [low, high] if it is `closed`.

    `field` is the argument to which a `name` such as zeta[1] belongs.
    """
    number = _checked_number(name, value, "")
    if not (low <= number < high or (closed and number == high)):
        message = f"{name} must lie in [{low:g}, {high:g}{']' if closed else ')'}, but {shown(value)} was given."
        raise InputError(f"{message} {hint}".rstrip(), field=field or name)
    return number


def checked_finite_vector(
    name: str, values: ArrayLike, unit: str, *, field: str | None = None, booleans: bool = False
) -> Array:
    """Return `values` as a read-only float64 array (n,) of finite numbers; `field` as in `checked_in_range`."""
    field = field or name
    array = float_array(values, booleans=booleans)
    if array is None:
        measured = f" in {unit}" if unit else ""
        raise InputError(
            f"{name} must be a sequence of numbers{measured}, but {_type_in_words(values)} was given.", field=field
        )
    if array.ndim != 1:
        raise InputError(f"{name} must be one-dimensional, but an array of shape {array.shape} was given.", field=field)
    if not np.isfinite(array).all():
        bad = np.flatnonzero(~np.isfinite(array))
        raise InputError(
            f"{name} must be finite, but {bad.size} of {array.size} values are not, the first "
            f"({array[bad[0]]}) at index {bad[0]}. Remove or repair them before use.",
            field=field,
        )
    array.setflags(write=False)
    return array


def check_all_positive(name: str, values: Array, unit: str, hint: str = "", *, field: str | None = None) -> None:
    """Raise an InputError unless all `values` are positive; `field` as in `checked_in_range`."""
    if values.min(initial=math.inf) <= 0.0:
        i = int(np.argmin(values))
        message = f"{name} must be positive, but {name}[{i}] = {values[i]:g} {unit} was given. {hint}"
        raise InputError(message.rstrip(), field=field or name)


def checked_finite(name: str, value: float, unit: str) -> float:
    """Return `value` as a finite float."""
    number = _float_or_none(value)
    if number is None or not math.isfinite(number):
        raise InputError(
            f"{name} must be a finite number{unit and f' in {unit}'}, but {shown(value)} was given.", field=name
        )
    return number


def checked_row(name: str, values: Any) -> tuple[float, ...]:
    """Return at least one finite number of a sequence as a tuple."""
    plain = isinstance(values, Sequence) and not isinstance(values, str | bytes)
    is_row = cast("Array", values).ndim == 1 if isinstance(values, np.ndarray) else plain
    numbers = tuple(map(real_or_nan, values)) if is_row else ()
    if not numbers or not all(map(math.isfinite, numbers)):
        raise InputError(f"{name} must be a row of numbers, but {shown(values)} was given.", field=name)
    return numbers


def real_or_nan(value: object) -> float:
    """Return a real number as a float; NaN for booleans, strings, arrays, and numbers too large for a float."""
    if type(value) is float:  # the other tests take long
        return value
    if isinstance(value, bool) or not isinstance(value, Real):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.nan


def checked_magnitude(name: str, value: float, limit: float, unit: str) -> float:
    """Return `value` as a float of magnitude below `limit`; booleans, strings and arrays are rejected."""
    number = real_or_nan(value)
    if not abs(number) < limit:
        raise InputError(
            f"{name} must be a number between {-limit:g} and {limit:g} {unit}, but {shown(value)} was given.",
            field=name,
        )
    return number


def checked_whole_number(
    name: str, value: SupportsIndex, low: int, high: int | None = None, *, field: str | None = None
) -> int:
    """Return `value` as an int from `low` to `high`; booleans and floats are rejected.

    `field` as in `checked_in_range`.
    """
    number = None
    if not isinstance(value, bool | np.bool_):
        with suppress(TypeError):
            number = operator.index(value)
    if number is None or number < low or (high is not None and number > high):
        span = f"of at least {low}" if high is None else f"from {low} to {high}"
        raise InputError(f"{name} must be a whole number {span}, but {shown(value)} was given.", field=field or name)
    return number


def checked_mode_count(n_modes: SupportsIndex | None, available: int) -> int:
    """Return the requested number of modes; None means all that are available."""
    return available if n_modes is None else checked_whole_number("n_modes", n_modes, 1, available)


def checked_damping_ratios(name: str, values: ArrayLike, n_modes: int) -> Array:
    """Return a read-only array of one damping ratio in [0, 1) per mode, from one or from `n_modes` numbers."""
    if number_of_dimensions(values) == 0:
        ratio = checked_in_range(name, values, 0.0, 1.0, hint=_DAMPING_HINT)  # pyright: ignore[reportArgumentType]
        ratios = np.full(n_modes, ratio)
        ratios.setflags(write=False)
        return ratios
    ratios = checked_finite_vector(name, values, "fractions of critical damping")
    if ratios.size != n_modes:
        raise InputError(
            f"{name} must be one number, or one for each of the {n_modes} modes, but {ratios.size} were given.",
            field=name,
        )
    outside = np.flatnonzero((ratios < 0.0) | (ratios >= 1.0))
    if outside.size:
        first = int(outside[0])
        checked_in_range(f"{name}[{first}]", float(ratios[first]), 0.0, 1.0, hint=_DAMPING_HINT, field=name)
    return ratios


def number_of_dimensions(values: ArrayLike) -> int:
    """Return the number of dimensions of `values`; 1 for ragged rows, which a later check rejects."""
    try:
        return np.ndim(values)
    except ValueError:
        return 1


def checked_finite_matrix(
    name: str, values: ArrayLike, unit: str, shape: tuple[int, int], *, field: str | None = None
) -> Array:
    """Return a float64 copy of finite `values` with the given shape; `field` as in `checked_in_range`."""
    field = field or name
    array = float_array(values)
    if array is None:
        raise InputError(
            f"{name} must be a matrix of numbers in {unit}, but {_type_in_words(values)} was given.", field=field
        )
    if array.shape != shape:
        raise InputError(
            f"{name} must have the shape {shape}, but an array of shape {array.shape} was given.", field=field
        )
    if not np.isfinite(array).all():
        row, column = (int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise InputError(
            f"{name} must be finite, but its entry [{row}, {column}] is {array[row, column]}.", field=field
        )
    return array


def checked_finite_rows(name: str, values: ArrayLike, unit: str, columns: int) -> Array:
    """Return a read-only float64 copy of `values`: at least one row of `columns` finite numbers each."""
    rows = np.shape(values)[0] if number_of_dimensions(values) == 2 else 1
    array = checked_finite_matrix(name, values, unit, (max(rows, 1), columns))
    array.setflags(write=False)
    return array


def float_array(values: ArrayLike, *, booleans: bool = False) -> Array | None:
    """Return a float64 copy of real numbers; None for anything else.

    That is ragged rows, complex numbers, dates, texts, too large numbers, masked values, and booleans unless they are
    asked for.
    """
    strange = (str, bytes) if booleans else (str, bytes, bool, np.bool_)
    try:
        if masked_count(values):
            return None
        given = np.asarray(values)
        if given.dtype.kind in ("cmMSU" if booleans else "cmMSUb"):
            return None
        if given.dtype.kind == "O" and any(isinstance(each, strange) for each in given.flat):
            return None
        return np.array(given, dtype=np.float64)
    except (TypeError, ValueError, OverflowError, RecursionError):
        return None


def is_masked_array(given: object) -> bool:
    """Return whether an object is a masked array of NumPy, without loading numpy.ma, which takes some 20 ms."""
    masked = getattr(sys.modules.get("numpy.ma"), "MaskedArray", None)  # None while another thread imports it
    return masked is not None and isinstance(given, masked)


def masked_count(values: object, depth: int = 2) -> int:
    """Return how many values of a masked array, or of those in rows, are masked, which NumPy forgets in silence."""
    if is_masked_array(values):
        return int(np.ma.count_masked(cast("np.ma.MaskedArray[Any, Any]", values)))
    if depth == 0 or not isinstance(values, list | tuple):
        return 0
    held = (
        each for each in cast("Sequence[object]", values) if isinstance(each, list | tuple) or is_masked_array(each)
    )
    return sum(masked_count(each, depth - 1) for each in held)


def checked_instance(name: str, value: Any, kind: type[T]) -> T:
    """Return `value` if it is a `kind`."""
    if not isinstance(value, kind):
        raise InputError(f"{name} must be of type {kind.__name__}, but {_kind_of(value)} was given.", field=name)
    return value


def checked_instances(name: str, values: Iterable[Any], kind: type[T]) -> tuple[T, ...]:
    """Return `values`, each of which must be a `kind`, as a tuple."""
    try:
        given = tuple(values)
    except TypeError:
        message = f"{name} must be a sequence of {kind.__name__} objects, but {shown(values)} was given."
        raise InputError(message, field=name) from None
    for each in given:
        if not isinstance(each, kind):
            message = f"{name} must hold {kind.__name__} objects, but {_kind_of(each)} was given."
            raise InputError(message, field=name)
    return given


def _kind_of(value: object) -> str:
    return f"the class {value.__name__}" if isinstance(value, type) else type(value).__name__


def is_one_of(value: object, words: Collection[str]) -> bool:
    """Return whether `value` is a string among `words`; False for an array of strings."""
    return isinstance(value, str) and value in words


def _type_in_words(values: object) -> str:
    name, masked = type(values).__name__, masked_count(values)
    if masked:
        mend = "leave them out (.compressed()) or fill them (.filled(number)) first"
        return f"{name} with {number_with_noun(masked, 'masked value')} ({mend})"
    try:
        given = np.asarray(values)
        if given.dtype.kind in _IN_WORDS and not isinstance(values, str | bytes):
            return f"{name} of {_IN_WORDS[given.dtype.kind]}"
        np.array(given, dtype=np.float64)
    except OverflowError:
        return f"{name} with a number too large for double precision"
    except (TypeError, ValueError):
        return f"{name} whose rows differ in length" if _has_ragged_rows(values) else name
    return name


def _has_ragged_rows(values: object) -> bool:
    try:
        np.asarray(values)
    except ValueError:
        return True
    return False


def _checked_number(name: str, value: float, unit: str) -> float:
    number = _float_or_none(value)
    if number is None:
        of_unit = f" in {unit}" if unit else ""
        raise InputError(f"{name} must be a number{of_unit}, but {shown(value)} was given.", field=name)
    return number


def _float_or_none(value: Any) -> float | None:
    """Return a number as a float; None for anything else, and numbers too large for a float.

    Booleans and texts are no numbers, nor are complex numbers and arrays of them.
    """
    if isinstance(value, np.ndarray):
        array = cast("NDArray[Any]", value)
        value = None if array.ndim or is_masked_array(array) else array[()]
    if isinstance(value, _NO_NUMBERS):
        return None
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        return None
