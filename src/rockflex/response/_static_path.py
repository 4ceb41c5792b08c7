"""A path of a base that is pushed slowly, and the elements along it."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex._values import Value
from rockflex.modal import BaseElement, RockingProperties

if TYPE_CHECKING:
    import pandas as pd

_OF_ELEMENTS = ("element_force", "element_elongation", "plastic_stretch", "element_losses")


@dataclass(frozen=True, eq=False, repr=False)
class StaticPath(Value, ABC):
    """What paths on rigid ground and on springs have in common; between adjacent points everything is linear."""

    properties: RockingProperties
    rotation: Array
    given: Bools
    element_force: Array
    element_elongation: Array
    plastic_stretch: Array
    element_losses: Array

    @cached_property
    @abstractmethod
    def moment(self) -> Array:
        """Moment M in N m, shape (n,)."""

    @property
    def elements(self) -> tuple[BaseElement, ...]:
        """The elements, in their order."""
        return self.properties.elements

    @property
    def work(self) -> Array:
        """Work of the moment up to each point in J, shape (n,)."""
        steps = 0.5 * (self.moment[1:] + self.moment[:-1]) * np.diff(self.rotation)
        return np.concatenate(([0.0], np.cumsum(steps)))

    @property
    def element_energy(self) -> Array:
        """Energy that each element has dissipated along the whole path in J, shape (E,)."""
        return self.element_losses[-1]

    @property
    def dissipated_energy(self) -> Array:
        """Energy that all elements have dissipated up to each point in J, shape (n,)."""
        return self.element_losses.sum(axis=1)

    def _frame(self, *names: str) -> "pd.DataFrame":
        """Return these quantities and those of the elements, counted from 1, as a table."""
        import pandas as pd

        columns = {name: getattr(self, name) for name in names}
        for place in range(len(self.elements)):
            columns |= {f"{name}_{place + 1}": getattr(self, name)[:, place] for name in _OF_ELEMENTS}
        return pd.DataFrame(columns)
