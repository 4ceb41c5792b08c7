"""Numbers that leave the range of double precision, told in terms of what was given."""

from collections.abc import Callable, Generator
from contextlib import contextmanager

import numpy as np

from rockflex._errors import InputError


@contextmanager
def computable(what: str | Callable[[], str], field: str | None = None) -> Generator[None]:
    """Turn a failure of arithmetic into an error that says what cannot be computed; a block or a decorator.

    Parameters
    ----------
    what
        What is computed and from what, as the subject of a sentence; or a function that says so.
    field
        The argument that it depends on, where it is one.

    Raises
    ------
    InputError
        If a number overflows, is divided by zero or is undefined, or a matrix cannot be factorised.
    """
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            yield
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        words = error.args[-1] if error.args else type(error).__name__
        subject = what if isinstance(what, str) else what()
        raise InputError(
            f"{subject} cannot be computed: numbers arise that double precision cannot hold ({words}). Check the "
            "units (kg, m, s, N, rad throughout), and whether values that belong together are many orders of magnitude "
            "apart.",
            field=field,
        ) from error
