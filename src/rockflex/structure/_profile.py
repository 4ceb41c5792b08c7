"""A quantity that varies along the height, given as a number, a function or a table."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector, positive
from rockflex._errors import InputError
from rockflex._shown import counted
from rockflex._values import Value

Along: TypeAlias = float | Callable[[Array], ArrayLike] | tuple[ArrayLike, ArrayLike]
"""A number, a function of heights (n,) that returns values (n,), or a table (heights, values) to interpolate."""

_LOOKS = 65
_ROOM = 1e-9  # of the height: tolerance for printed digits in the last row of a table


@dataclass(frozen=True)
class Constant:
    """The same value at every height."""

    value: float

    def __call__(self, z: Array) -> Array:
        return np.full(z.shape, self.value)


@dataclass(frozen=True, eq=False)
class Interpolated(Value):
    """A table of values (n,) at heights (n,) in m, linear between its rows."""

    heights: Array
    values: Array

    def __call__(self, z: Array) -> Array:
        return np.interp(z, self.heights, self.values)


@dataclass(frozen=True, eq=False)
class Profile(Value):
    """Values along the height, checked whenever they are evaluated.

    Attributes
    ----------
    name, unit : str
        Name and unit of the property, for messages.
    function : callable
        Returns the values at given heights.
    kinks : ndarray
        Heights in m where the values are not smooth.
    zero : bool
        Whether zero is allowed.
    """

    name: str
    unit: str
    function: Callable[[Array], ArrayLike]
    kinks: Array
    zero: bool

    @property
    def given(self) -> Along:
        """The number, the function, or the table (as read-only arrays) that was given."""
        if isinstance(self.function, Constant):
            return self.function.value
        if isinstance(self.function, Interpolated):
            return self.function.heights, self.function.values
        return self.function

    def at(self, z: Array) -> Array:
        """Return the values at heights `z`, in the shape of `z`.

        Raises
        ------
        InputError
            If a value is missing, not finite, or not positive.
        """
        flat = z.ravel()
        try:
            with np.errstate(all="ignore"):  # values that are not finite are rejected below
                values = np.broadcast_to(np.asarray(self.function(flat), dtype=np.float64), flat.shape)
        except (TypeError, ValueError) as error:
            raise InputError(
                f"{self.name} must return one number for each height, an array of shape {flat.shape}, but it did not: "
                f"{error}.",
                field=self.name,
            ) from error
        allowed = (values >= 0.0) if self.zero else (values > 0.0)
        bad = np.flatnonzero(~(allowed & np.isfinite(values)))
        if bad.size:
            i = int(bad[0])
            kind = "zero or positive" if self.zero else "positive"
            raise InputError(
                f"{self.name} must be {kind} and finite along the whole height, but it is {values[i]:g} "
                f"{self.unit} at {flat[i]:.6g} m.",
                field=self.name,
            )
        return values.reshape(z.shape)


def profile(name: str, given: Along, height: float, unit: str, *, zero: bool = False) -> Profile:
    """Return the given property as a profile from the base to `height`.

    Raises
    ------
    InputError
        If a table does not extend from the base to the top, its heights decrease, or a value is not positive.
    """
    if callable(given):
        result = Profile(name, unit, given, np.zeros(0), zero)
    elif isinstance(given, tuple):
        result = _table(name, given, height, unit, zero)
    else:
        constant = positive(name, given, unit, zero=zero)
        result = Profile(name, unit, Constant(constant), np.zeros(0), zero)
    result.at(np.linspace(0.0, height, _LOOKS))
    return result


def _table(name: str, given: tuple[ArrayLike, ArrayLike], height: float, unit: str, zero: bool) -> Profile:
    if len(given) != 2:  # pyright: ignore[reportUnnecessaryComparison]
        raise InputError(
            f"{name} must be a table (heights, values), but {counted(len(given), 'column was', 'columns were')} given.",
            field=name,
        )
    z = finite_vector(f"{name}, heights", given[0], "m", field=name)
    values = finite_vector(f"{name}, values", given[1], unit, field=name)
    if z.size != values.size or z.size < 2:
        raise InputError(
            f"{name} must contain one value for each height of its table, and at least two rows, but {z.size} heights "
            f"and {values.size} values were given.",
            field=name,
        )
    falls = np.flatnonzero(z[1:] < z[:-1])
    if falls.size:
        i = int(falls[0])
        raise InputError(
            f"{name}: the heights of a table must not decrease, but {z[i + 1]:g} m follows {z[i]:g} m. Sort the rows; "
            "two rows at the same height are a jump.",
            field=name,
        )
    if z[0] > _ROOM * height or z[-1] < height * (1.0 - _ROOM):
        raise InputError(
            f"{name}: a table must extend from the base (0 m) to the top ({height:g} m), but it covers {z[0]:g} m to "
            f"{z[-1]:g} m. Add the missing rows.",
            field=name,
        )
    low = values < 0.0 if zero else values <= 0.0
    if low.any():
        i = int(np.flatnonzero(low)[0])
        kind = "zero or positive" if zero else "positive"
        raise InputError(
            f"{name} must be {kind}, but its table contains {values[i]:g} {unit} at {z[i]:g} m.", field=name
        )
    inside = z[(z > 0.0) & (z < height)]
    return Profile(name, unit, Interpolated(z, values), np.unique(inside), zero)
