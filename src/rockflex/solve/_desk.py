"""The work arrays of runs, handed on from run to run: to allocate them takes longer than to clear them."""

from functools import lru_cache

import numpy as np

from rockflex.models import StateLayout
from rockflex.solve.layout import FEWEST_TERMS, Motion, motion_of

SPARE = 8  # desks kept for later runs


class Desk:
    """The work arrays of one run after another. Each run clears what it may read before it has written it.

    Parameters
    ----------
    motion
        The arrays, of any content.
    """

    def __init__(self, motion: Motion) -> None:
        self._motion = motion

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
        self._layout, self._rows = layout, rows
        self._spare = list[Desk]()

    def taken(self) -> Desk:
        """Return a desk for a run."""
        try:
            return self._spare.pop()
        except IndexError:
            return Desk(motion_of(np.zeros(self._layout.size), self._layout, self._rows, FEWEST_TERMS))

    def returned(self, desk: Desk) -> None:
        """Take back the desk of a run that has ended."""
        if len(self._spare) < SPARE:
            self._spare.append(desk)


@lru_cache(maxsize=32)
def desks_of(layout: StateLayout, rows: int) -> Desks:
    """Return the desks for a layout and a number of rows, the same ones for all models."""
    return Desks(layout, rows)
