"""Reports overflow and similar arithmetic failures in terms of the given values."""

from collections.abc import Callable, Generator
from contextlib import contextmanager

import numpy as np

from rockflex.foundation.errors import InputError


@contextmanager
def explaining_overflow(what: str | Callable[[], str], field: str | None = None) -> Generator[None]:
    """Turn an arithmetic failure into an error that states what cannot be computed; a context or a decorator.

    Parameters
    ----------
    what
        What is computed from what, as the subject of a sentence, or a function that returns this text.
    field
        The argument responsible, if there is a single one.

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
