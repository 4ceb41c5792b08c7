"""Observed fractions, which a fitted curve can be compared with."""

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools


def observed_fractions(im: Array, exceeded: Bools, groups: int) -> list[tuple[float, float]]:
    """Return the geometric mean of the measures and the fraction of runs beyond a limit, in groups of neighbours.

    Parameters
    ----------
    im : ndarray, shape (n,)
        Intensity measure of every run, positive.
    exceeded : ndarray, shape (n,)
        Whether each run exceeds the limit.
    groups
        Number of groups, of equal size as far as possible; groups without a run are left out.

    Examples
    --------
    >>> import numpy as np
    >>> from rockflex.fragility import observed_fractions
    >>> found = observed_fractions(np.array([0.4, 0.1, 0.1, 0.4]), np.array([True, False, False, False]), 2)
    >>> [(round(at, 3), share) for at, share in found]
    [(0.1, 0.0), (0.4, 0.5)]
    """
    parts: list[NDArray[np.intp]] = np.array_split(np.argsort(im, kind="stable"), groups)
    return [(float(np.exp(np.log(im[part]).mean())), float(exceeded[part].mean())) for part in parts if part.size]
