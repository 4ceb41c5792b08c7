"""The tables of a system that kernels fill."""

from typing import Any, NamedTuple

from rockflex._arrays import Array
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
