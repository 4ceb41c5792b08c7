"""What a study derives from histories: the required friction, and demands of the user's own."""

from collections.abc import Callable, Collection, Mapping
from typing import cast

import numpy as np

from rockflex._checks import real_or_nan
from rockflex._errors import InputError, SolverError
from rockflex._shown import few, shown
from rockflex.response import Response
from rockflex.study._tables import Row

Demands = Mapping[str, Callable[[Response], float]]


def checked_demands(demands: Demands | None, taken: Collection[str]) -> Demands:
    """Return demands whose names are free and whose values can be called.

    Raises
    ------
    InputError
        If they are no mapping from names to functions, or a name is that of another column.
    """
    if demands is None:
        return {}
    if not isinstance(demands, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"demands must be a dictionary from names of columns to functions of a Response, but {shown(demands)} was "
            'given. Write demands={"roof_acceleration": function}.',
            field="demands",
        )
    for name, demand in demands.items():
        if not isinstance(name, str) or not name or not callable(demand):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"demands must be functions of a Response by the names of their columns, but {shown(name)} is "
                f"{shown(demand)}. Give a text as the name, and a function.",
                field="demands",
            )
    known = [name for name in demands if name in taken]
    if known:
        raise InputError(
            f"demands: the table has a column {few(known)} already. Give the demand another name.", field="demands"
        )
    return dict(demands)


def derived(response: Response, demands: Demands, *, friction: bool) -> Row:
    """Return the friction that a response with its history requires, if asked for, and the value of each demand.

    A friction that cannot be found is a message in `error`.

    Raises
    ------
    InputError
        If a function returns anything but a real number; NaN is one.
    """
    found: Row = {name: _value(name, demand, response) for name, demand in demands.items()}
    return found | _friction(response) if friction else found


def _friction(response: Response) -> Row:
    try:
        return {"required_friction": response.required_friction}
    except (SolverError, InputError) as error:
        return {"error": f"No required friction: {error}"}


def _is_nan(found: object) -> bool:
    """Return whether a function answered NaN, as a number of Python or NumPy or an array without dimensions."""
    array = np.asarray(found)
    return array.ndim == 0 and array.dtype.kind == "f"


def _value(name: str, demand: Callable[[Response], float], response: Response) -> float:
    what = f"{response.model} under {response.motion}"
    try:
        found = cast("object", demand(response))
    except Exception as error:
        error.add_note(f"This was raised by the demand {shown(name)} of {what}.")
        raise
    value = real_or_nan(found)
    if value != value and not _is_nan(found):
        raise InputError(
            f"The demand {shown(name)} must return one number, but for {what} it returned {shown(found)}. Reduce it, "
            "by abs(...).max() for instance.",
            field="demands",
        )
    return value
