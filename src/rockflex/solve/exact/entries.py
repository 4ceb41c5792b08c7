"""The tables of a system: those that kernels fill, that of the modes, and larger ones with the same content."""

from typing import Any, NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex._numba_vectors import padded
from rockflex.solve.layout import System


class Tables(NamedTuple):
    """The tables of `System` that kernels fill; fewer arrays compile faster."""

    dt: float
    modes: Array
    phases: Any
    limits: Array
    border: Array
    base: Array
    push: Array
    plain_rows: Array
    basis: Array
    forced: Array
    rows: Array
    row_forcing: Array
    blocks: Array
    bounds: Array
    ahead: Array
    kicked: Array
    leap: Array
    pushed: Array
    leeway: Array
    stray: Array


def tables_of(system: System) -> Tables:
    """Return the tables that kernels fill."""
    return Tables(*(getattr(system, name) for name in Tables._fields))


def modes_of(omega: Array, zeta: Array, pairs: int) -> Array:
    """Return the table of the modes; `pairs` counts the freedoms of the base too."""
    modes = np.zeros((3, padded(pairs)))
    modes[:, : omega.size] = omega**2, 2.0 * zeta * omega, np.ones(omega.size)
    return modes


def grown(system: System, larger: System) -> System:
    """Return `larger` with the content of `system`."""
    for old, new in zip(system[2:], larger[2:], strict=True):
        if isinstance(old, int) or isinstance(new, int):
            continue
        if old.size and new.shape != old.shape:
            new[tuple(slice(length) for length in old.shape)] = old
        elif old.size:
            new[...] = old
    return larger
