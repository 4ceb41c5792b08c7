"""What is to be tracked of a run, as functionals of the motion."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rockflex.models import LINEAR, RockingModel, row_size

__all__ = ["Observables"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Observables:
    """Rows over the motion in contact and while rocking, (F, C) each: see `rockflex.models.row_size` for their columns.

    While a complete model rocks, `kinds` (F,) say what becomes of a row there, with `levers` (F, 2): see
    `rockflex.models.observe`. Where they are not given, and in all other models, every row is `LINEAR`.
    """

    contact: Array
    rocking: Array
    kinds: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    levers: Array = field(default_factory=lambda: np.zeros((0, 2)))

    def __post_init__(self) -> None:
        rows = self.contact.shape[0]
        object.__setattr__(self, "kinds", np.append(self.kinds, np.full(rows - self.kinds.size, LINEAR, np.int64)))
        object.__setattr__(self, "levers", np.vstack((self.levers, np.zeros((rows - self.levers.shape[0], 2)))))

    @classmethod
    def none(cls, model: RockingModel) -> "Observables":
        """Nothing but what every run tracks."""
        empty = np.zeros((0, row_size(model)))
        return cls(empty, empty)

    def __add__(self, other: "Observables") -> "Observables":
        return Observables(
            np.vstack((self.contact, other.contact)),
            np.vstack((self.rocking, other.rocking)),
            np.append(self.kinds, other.kinds),
            np.vstack((self.levers, other.levers)),
        )
