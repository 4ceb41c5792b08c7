"""The types of records in the arrays of kernels."""

from typing import Any

import numpy as np


def record_of(fields: list[tuple[str, Any]]) -> np.dtype[Any]:
    """Return the type of a record whose fields are attributes."""
    return np.dtype((np.record, np.dtype(fields, align=True)))


PHASE = record_of(
    [
        ("side", np.float64),  # pivot about which the base rotates
        ("free", np.bool_),  # whether it rotates: it neither rests on the ground nor is held at a rotation
        ("decays", np.bool_),  # whether free vibration comes to rest
        ("turns", np.int64),  # sign of |θ|' while an element yields or slides; 0 if none does
        ("active", np.int64),  # number of pairs of coordinates that may move
        ("fences", np.int64),
        ("marches", np.bool_),  # whether it is advanced over whole samples, rather than by power series
        ("levels", np.int64),  # of the grid
        ("terms", np.int64),  # of the power series that converge over the finest step
        ("linear", np.bool_),  # solved in closed form
        ("dense", np.bool_),  # linear, but cannot be uncoupled
        ("block", np.int64),  # samples that its tables cover at once, at most `BLOCK`
        ("fastest", np.float64),  # largest eigenvalue magnitude, rad/s
    ]
)

# A block of samples in which peaks may lie; it need not be searched if later samples turn out to be higher.
DEFERRED = record_of(
    [
        ("waits", np.bool_),
        ("phase", np.int64),
        ("offset", np.int64),  # samples before the stretch of acceleration
        ("index", np.int64),  # its first sample within the stretch
        ("slope", np.float64),  # of the acceleration, to which w refers
        ("count", np.int64),  # samples that no event ends
        ("stated", np.bool_),  # whether the state is that at the start of the block
    ]
)

# How a run ended.
END = record_of(
    [
        ("status", np.int64),
        ("samples", np.int64),  # completed
        ("left", np.float64),  # of the work that it may take, s
        ("uplifts", np.int64),
        ("impacts", np.int64),
    ]
)
