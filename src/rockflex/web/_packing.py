"""Numbers on their way to the browser."""

import base64
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray


def pack(values: ArrayLike) -> str:
    """Write an array as base64 of little-endian single precision: enough for a picture, and half of the size."""
    with np.errstate(over="ignore"):
        return base64.b64encode(np.asarray(values, dtype="<f4").tobytes()).decode()


def envelope(curves: list[NDArray[np.float64]], most: int) -> NDArray[np.intp]:
    """Indices of at most about `most` points that keep the highest and the lowest of every curve in every stretch.

    Parameters
    ----------
    curves
        Curves over the same points, shape (n,) each.
    most
        How many points to keep; all of them if there are no more.

    Returns
    -------
    ndarray
        Rising indices, the first and the last point among them.
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
