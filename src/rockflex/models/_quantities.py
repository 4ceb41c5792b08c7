"""What is asked of a motion: sums of shares of what moves, whichever phase it is in, and their rows in each phase."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.models._elements import CLOSED, RIGHT
from rockflex.models._modal_model import ModalModel
from rockflex.models._observe import LEFT_OUT, LINEAR, SWAY
from rockflex.models._phase import Key

Array = NDArray[np.float64]

Share = tuple[int, dict[str, Any]]  # the kind of one quantity, and its shares by name

OF_MODES = ("displacement", "restoring", "acceleration")
OF_BASE = ("rotation", "right", "turn", "ground")
ROTATION, RIGHT_ROTATION, TURN, GROUND = -4, -3, -2, -1  # columns of `Quantities.shares`


@dataclass(frozen=True, eq=False)
class Quantities:
    """F quantities, each a sum of shares of what moves.

    Attributes
    ----------
    shares : ndarray, shape (F, 3 N + 4)
        Of D_n (`displacement`), of the restoring acceleration of each mode (`restoring`: ω_n² D_n, or that of Eq. 37),
        of D''_n (`acceleration`), of θ (`rotation`), of θ while the base turns about its right pivot (`right`), of θ''
        (`turn`) and of the ground acceleration (`ground`).
    kinds : ndarray, shape (F,)
        What becomes of the quantity in large rotations: `rockflex.models.observe`.
    """

    shares: Array
    kinds: NDArray[np.int64]

    @classmethod
    def of(cls, count: int, modes: int, kind: int = LINEAR, **shares: ArrayLike) -> "Quantities":
        """Return `count` quantities of a model with so many modes; shares that are not named are zero."""
        values = np.zeros((count, 3 * modes + len(OF_BASE)))
        for name, share in shares.items():
            values[:, _column(name, modes)] = share
        return cls(values, np.full(count, kind, dtype=np.int64))

    @classmethod
    def none(cls, modes: int) -> "Quantities":
        """No quantity."""
        return cls.of(0, modes)

    def __len__(self) -> int:
        return self.kinds.size

    def __add__(self, other: "Quantities") -> "Quantities":
        return joined((self, other))

    @property
    def levers(self) -> Array:
        """What a quantity that bends in large rotations needs beside its row: `rockflex.models.observe`, (F, 2)."""
        rotation, turn, ground = (self.shares[:, column] for column in (ROTATION, TURN, GROUND))
        near = np.where(self.kinds == SWAY, rotation, np.where(self.kinds == LEFT_OUT, -ground, 0.0))
        return np.column_stack((near, np.where(self.kinds == LEFT_OUT, -turn, 0.0)))


def _column(name: str, modes: int) -> slice | int:
    if name in OF_MODES:
        first = OF_MODES.index(name) * modes
        return slice(first, first + modes)
    return OF_BASE.index(name) - len(OF_BASE)


def collected(modes: int, shares: Sequence[Share]) -> Quantities:
    """Return one quantity for each kind and its shares."""
    total = Quantities.of(len(shares), modes)
    for k, (kind, values) in enumerate(shares):
        total.kinds[k] = kind
        for name, share in values.items():
            total.shares[k, _column(name, modes)] = share
    return total


def joined(parts: Sequence[Quantities]) -> Quantities:
    """Return all quantities of the parts, in their order."""
    return Quantities(np.concatenate([part.shares for part in parts]), np.concatenate([part.kinds for part in parts]))


def rows_of(model: ModalModel, quantities: Quantities, key: Key) -> Array:
    """Rows of the quantities in one phase, shape (F, C).

    While a complete model rocks, a quantity that bends has the row of its displacements and forces alone; the rest is
    `rockflex.models.observe`'s.
    """
    shares = quantities.shares
    large = model.complete and key[0] != CLOSED
    if large:
        bends = quantities.kinds != LINEAR
        shares = shares.copy()
        for column in (ROTATION, RIGHT_ROTATION, GROUND):
            shares[bends, column] = 0.0
    return shares @ _moving(model, key, large=large)


def _moving(model: ModalModel, key: Key, *, large: bool) -> Array:
    """What `Quantities.shares` are shares of, as rows of one phase, shape (3 N + 4, C); no accelerations if `large`."""
    n, layout = model.properties.n_modes, model.layout
    rows = np.zeros((3 * n + len(OF_BASE), layout.columns))
    modes = np.arange(n)
    rows[modes, modes] = 1.0
    rows[n : 2 * n] = model.restoring
    rows[ROTATION, layout.rotation] = 1.0
    rows[RIGHT_ROTATION, layout.rotation] = key[0] == RIGHT
    rows[GROUND, -2] = 1.0
    if not large:
        rows[2 * n : 3 * n] = model.modal_accelerations(key)
        if key[0] != CLOSED:
            rows[TURN] = model.angular_acceleration(key)
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
