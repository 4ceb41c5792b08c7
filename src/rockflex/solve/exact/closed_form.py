"""A linear model's motion between the states of a history, in closed form."""

import math
from functools import cached_property

import numpy as np

from rockflex.models import GROUND, HEADER, SIDE, TIME, LinearModel
from rockflex.solve.exact.basis import Basis, basis_of
from rockflex.solve.exact.tables import propagate
from rockflex.solve.layout import Array

__all__ = ["ClosedForm"]


class ClosedForm:
    """The phases of a linear model, uncoupled.

    Parameters
    ----------
    model
        The model.
    """

    def __init__(self, model: LinearModel) -> None:
        self._model = model

    @cached_property
    def _bases(self) -> dict[int, Basis]:
        keys = {side: self._model.start(side) for side in self._model.sides}
        return {
            side: basis_of(self._model, self._model.arrow(key), self._model.accelerations(key))
            for side, key in keys.items()
        }

    @property
    def fastest(self) -> float:
        """Largest eigenvalue magnitude of all phases, rad/s."""
        return max(basis.fastest for basis in self._bases.values())

    def between(self, states: Array, fraction: float) -> Array:
        """States at one fraction of the way from every kept state to the next, shape (n - 1, 2N + 2)."""
        steps = np.diff(states[:, TIME])
        # Samples' distances differ by the rounding of their times; alike, they share one propagator.
        steps = np.round(steps, 12 - math.ceil(math.log10(max(float(states[-1, TIME]), 1.0))))
        safe = np.where(steps > 0.0, steps, 1.0)
        slopes = np.where(steps > 0.0, np.diff(states[:, GROUND]) / safe, 0.0)
        start = np.column_stack((states[:-1, GROUND], slopes, np.ones(steps.size)))
        end = start.copy()
        end[:, 0] += fraction * steps * slopes
        moved = states[:-1, HEADER:].copy()
        for side, basis in self._bases.items():
            chosen = states[:-1, SIDE] == side
            if chosen.any():
                forced = basis.steady @ basis.inverse.T
                w = moved[chosen] @ basis.inverse.T - start[chosen] @ forced
                carried = propagate(basis, w, fraction * steps[chosen]) + end[chosen] @ forced
                moved[chosen] = carried @ basis.basis.T
        return moved
