"""The periods of spectra, checked."""

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector
from rockflex._errors import InputError
from rockflex._shown import shown

SHORTEST = 1e-6  # s
RANGE = 50  # periods at which a range is examined


def checked_periods(periods: ArrayLike) -> Array:
    """Return periods in s, each zero or at least 1e-6 s.

    Raises
    ------
    InputError
        If one is negative, too short or not finite.
    """
    period = finite_vector("periods", periods, "s")
    bad = np.flatnonzero((period < 0) | ((period > 0) & (period < SHORTEST)))
    if bad.size:
        raise InputError(
            f"periods must be zero or at least 1e-6 s, but {period[bad[0]]:g} was given at index {bad[0]}. "
            "A period of zero gives the peak ground acceleration."
        )
    return period


def examined_periods(periods: ArrayLike) -> Array:
    """Return the periods at which spectra are compared: those between two ends, evenly in ln T, or those given.

    Raises
    ------
    InputError
        If there is none, the ends are not in order, or one is negative or not finite.
    """
    given = finite_vector("periods", periods, "s")
    if given.size == 2:
        if not 0.0 < given[0] < given[1]:
            raise InputError(
                f"periods must be a range such as (0.2, 2.0), but ({given[0]:g}, {given[1]:g}) was given. Two periods "
                "are the ends of a range, in order and positive; give three or more for single periods.",
                field="periods",
            )
        return np.geomspace(given[0], given[1], RANGE)
    if not given.size or given.min() < 0.0 or (np.diff(given) <= 0.0).any():
        raise InputError(
            f"periods must be the two ends of a range, or increasing periods in s, but {shown(periods)} was given.",
            field="periods",
        )
    return given
