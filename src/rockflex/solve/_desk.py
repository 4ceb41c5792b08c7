"""The work arrays of runs, handed on from run to run: to allocate them takes longer than to clear them."""

import numpy as np

from rockflex._arrays import Array
from rockflex.models import RockingModel
from rockflex.solve.layout import Motion, System, motion_of

FEWEST = 4  # terms of a power series
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
        self._motion = Motion(*(array.copy() for array in fresh))
        self._fits: System | None = None

    def cleared(self, start: Array) -> "Desk":
        """Return the desk as at the start of a run from a state."""
        for mine, fresh in zip(self._motion, self._fresh, strict=True):
            mine[...] = fresh if mine.shape == fresh.shape else 0.0  # those of the series may have grown
        self._motion.state[:] = start
        return self

    def motion(self, system: System) -> Motion:
        """Return the motion, with room for the terms that the phases need."""
        if system is not self._fits:
            terms, (rows, had) = int(system.phases["terms"].max(initial=FEWEST)), self._motion.polys.shape
            if terms > had:
                series = np.zeros((self._motion.series.shape[0], terms))
                self._motion = self._motion._replace(series=series, polys=np.zeros((rows, terms)))
            self._fits = system
        return self._motion


class Desks:
    """The desks of an engine, of which every run takes one; threads may share them.

    Parameters
    ----------
    model
        The model.
    rows
        Number of its rows, without fences.
    """

    def __init__(self, model: RockingModel, rows: int) -> None:
        state = np.zeros(model.layout.size)
        self._fresh = motion_of(state, model.layout, rows + model.most_fences, FEWEST)
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
