"""What is asked of a motion: sums of shares of what moves, whichever phase it is in, and their rows in each phase."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.models._elements import CLOSED, RIGHT
from rockflex.models._modal_model import ModalModel
from rockflex.models._observe import LEFT_OUT, LINEAR, SWAY
from rockflex.models._phase import Key

__all__ = ["Quantities", "Share", "collected", "joined", "lost_support_row", "rows_of"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Quantities:
    """F quantities, each a sum of these shares.

    Attributes
    ----------
    displacement, restoring, acceleration : ndarray, shape (F, N)
        Of D_n, of the restoring acceleration of each mode (ω_n² D_n, or that of Eq. 37), and of D''_n.
    rotation, right, turn, ground : ndarray, shape (F,)
        Of θ, of θ while the base turns about its right pivot, of θ'' and of the ground acceleration.
    kinds : ndarray, shape (F,)
        What becomes of the quantity in large rotations: `rockflex.models.observe`.
    """

    displacement: Array
    restoring: Array
    acceleration: Array
    rotation: Array
    right: Array
    turn: Array
    ground: Array
    kinds: NDArray[np.int64]

    @classmethod
    def of(cls, count: int, modes: int, kind: int = LINEAR, **shares: ArrayLike) -> "Quantities":
        """Return `count` quantities of a model with so many modes; shares that are not named are zero."""
        of_modes, of_base = ("displacement", "restoring", "acceleration"), ("rotation", "right", "turn", "ground")
        values: dict[str, Any] = {name: np.zeros((count, modes)) for name in of_modes}
        values |= {name: np.zeros(count) for name in of_base}
        for name, share in shares.items():
            values[name] += np.asarray(share, dtype=np.float64)
        return cls(**values, kinds=np.full(count, kind, dtype=np.int64))

    @classmethod
    def none(cls, modes: int) -> "Quantities":
        """No quantity."""
        return cls.of(0, modes)

    def __len__(self) -> int:
        return self.rotation.size

    def __add__(self, other: "Quantities") -> "Quantities":
        return joined((self, other))

    @property
    def levers(self) -> Array:
        """What a quantity that bends in large rotations needs beside its row: `rockflex.models.observe`, (F, 2)."""
        near = np.where(self.kinds == SWAY, self.rotation, np.where(self.kinds == LEFT_OUT, -self.ground, 0.0))
        return np.column_stack((near, np.where(self.kinds == LEFT_OUT, -self.turn, 0.0)))


Share = tuple[int, dict[str, Any]]  # the kind of one quantity, and its shares by name


def collected(modes: int, shares: Sequence[Share]) -> Quantities:
    """Return one quantity for each kind and its shares."""
    total = Quantities.of(len(shares), modes)
    for k, (kind, values) in enumerate(shares):
        total.kinds[k] = kind
        for name, share in values.items():
            getattr(total, name)[k] = share
    return total


NAMES = tuple(each.name for each in fields(Quantities))


def joined(parts: Sequence[Quantities]) -> Quantities:
    """Return all quantities of the parts, in their order."""
    return Quantities(*(np.concatenate([getattr(part, name) for part in parts]) for name in NAMES))


def rows_of(model: ModalModel, quantities: Quantities, key: Key) -> Array:
    """Rows of the quantities in one phase, shape (F, C).

    While a complete model rocks, a quantity that bends has the row of its displacements and forces alone; the rest is
    `rockflex.models.observe`'s.
    """
    n, layout = model.properties.n_modes, model.layout
    large = model.complete and key[0] != CLOSED
    rows = quantities.restoring @ model.restoring
    rows[:, :n] += quantities.displacement
    linear = quantities.kinds == LINEAR if large else np.ones(len(quantities), dtype=np.bool_)
    rows[linear, layout.rotation] += quantities.rotation[linear]
    if key[0] == RIGHT:
        rows[linear, layout.rotation] += quantities.right[linear]
    rows[linear, -2] += quantities.ground[linear]
    if large:
        return rows
    rows += quantities.acceleration @ model.modal_accelerations(key)
    if key[0] != CLOSED:
        rows += np.outer(quantities.turn, model.angular_acceleration(key))
    return rows


def lost_support_row(model: ModalModel, key: Key) -> Array:
    """By how much ΣF_z falls below its value at rest, in N: a row, shape (C,).

    ΣF_z = m_tot (g + s B θ'') and the pull of the tendons, Eq. 22 for small rotations with its sign mended; in contact
    it rests at m_tot g and their prestress. While a complete model rocks it is no row, but `observe`'s.
    """
    row = np.zeros(model.layout.columns)
    side = key[0]
    if side == CLOSED or model.complete:
        return row
    pivot = model.properties.pivot(side)
    row -= side * model.properties.m_tot * pivot.arm * model.angular_acceleration(key)
    row[model.layout.rotation] -= side * pivot.axial_stiffness_moment
    return row
