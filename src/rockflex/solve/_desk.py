"""The work arrays of runs, handed on from run to run: to allocate them takes longer than to clear them."""

from functools import lru_cache

import numpy as np

from rockflex._arrays import Array
from rockflex.models import StateLayout
from rockflex.solve.layout import FEWEST_TERMS, Motion, motion_of

SPARE = 8  # desks kept for later runs


class Desk:
    """The work arrays of one run.

    Parameters
    ----------
    fresh
        The arrays as a run finds them, which are never written to.
    """

    def __init__(self, fresh: Motion) -> None:
        self._fresh = fresh
        self._motion = Motion._make(array.copy() for array in fresh)

    def cleared(self, start: Array) -> "Desk":
        """Return the desk as at the start of a run from a state."""
        for mine, fresh in zip(self._motion, self._fresh, strict=True):
            mine[...] = fresh if mine.shape == fresh.shape else 0.0  # those of the series may have grown
        self._motion.state[:] = start
        return self

    def motion(self, terms: int) -> Motion:
        """Return the motion, with room for power series of that many terms."""
        rows, had = self._motion.polys.shape
        if terms > had:
            series = np.zeros((terms, self._motion.series.shape[1]))
            self._motion = self._motion._replace(series=series, polys=np.zeros((rows, terms)))
        return self._motion


class Desks:
    """Desks for runs with the same layout and number of rows, of which every run takes one; threads may share them.

    Parameters
    ----------
    layout
        The layout of the state.
    rows
        Number of rows, with the fences.
    """

    def __init__(self, layout: StateLayout, rows: int) -> None:
        self._fresh = motion_of(np.zeros(layout.size), layout, rows, FEWEST_TERMS)
        self._spare = list[Desk]()

    def taken(self, start: Array) -> Desk:
        """Return a desk for a run from a state."""
        try:
            desk = self._spare.pop()
        except IndexError:
            desk = Desk(self._fresh)
        return desk.cleared(start)

    def returned(self, desk: Desk) -> None:
        """Take back the desk of a run that has ended."""
        if len(self._spare) < SPARE:
            self._spare.append(desk)


@lru_cache(maxsize=32)
def desks_of(layout: StateLayout, rows: int) -> Desks:
    """Return the desks for a layout and a number of rows, the same ones for all models."""
    return Desks(layout, rows)
