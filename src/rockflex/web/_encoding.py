"""Curves in the form that a browser receives."""

import base64

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array


def pack_array_as_base64(values: ArrayLike) -> str:
    """Encode an array as base64 of little-endian single precision, which is enough for a figure."""
    with np.errstate(over="ignore"):
        return base64.b64encode(np.asarray(values, dtype="<f4").tobytes()).decode()


def envelope_indices(curves: list[Array], most: int) -> NDArray[np.intp]:
    """Return the indices of about `most` points that include the extremes of every curve in every interval.

    Parameters
    ----------
    curves
        Curves over the same points, shape (n,) each.
    most
        Number of points; all points are retained if there are no more.

    Returns
    -------
    ndarray
        Increasing indices, including the first and the last point.
    """
    n = curves[0].size
    if n <= most:
        return np.arange(n)
    step = -(-n // max(most // (2 * len(curves)), 1))
    first = np.arange(0, n, step)
    values = np.pad(np.array(curves), ((0, 0), (0, -n % step)), "edge").reshape(len(curves), -1, step)
    kept = np.concatenate(([0, n - 1], *(first + values.argmin(axis=2)), *(first + values.argmax(axis=2))))
    return np.unique(np.minimum(kept, n - 1))
