"""Curves in the form that a browser receives."""

import base64
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._arrays import Array


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
    buckets = max(most // (2 * len(curves)), 1)
    edges = np.linspace(0, n, buckets + 1).astype(np.intp)
    kept = [np.array([0, n - 1])]
    for values in curves:
        for low, high in pairwise(edges):
            part = values[low:high]
            kept.append(np.array([low + int(part.argmin()), low + int(part.argmax())]))
    return np.unique(np.concatenate(kept))
