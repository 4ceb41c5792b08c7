"""Response quantities as weighted sums, independent of the phase, and their rows in each phase."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.engine.tables import by_rows
from rockflex.foundation.arrays import Array
from rockflex.models._elements import RIGHT
from rockflex.models._phase import Key
from rockflex.models._rocking_model import RockingModel

# Kinds of quantities (Silva & Stojadinović 2024, Eqs. 3-22). In contact, and always in the simplified models, each is a
# linear row over the motion. While a complete model rocks, displacements are nonlinear in the rotation, and forces
# depend on accelerations: `RockingField.observe` then replaces the value of the row by that of the quantity, for which
# it has two levers.
LINEAR = 0  # the row itself
SWAY = 1  # horizontal displacement of a point at the height levers[0]; the row gives its u (Eq. 3)
LEFT_OUT = 2  # the row and the masses left out: levers[0] is Σ m_i or Σ m_i h_i, levers[1] Σ m_i h_i or Σ m_i h_i²
SWING = 3  # rate of the elongation of an element per unit distance from the pivot; the row gives θ'
HORIZONTAL = 4  # Σ F_x (Eq. 21) including the forces of elements
LIFT = 6  # rise of a point of a base on springs at the distance -levers[0] from the axis; the row gives the heave
CLIMB = 7  # its rate; the row gives that of small rotations
# By how much Σ F_z is below its value at rest (Eq. 22 with the sign of the weight corrected), including these forces.
VERTICAL = 5

Share = tuple[int, dict[str, Any]]  # the kind of a quantity, and its shares by name

OF_MODES = ("displacement", "restoring", "acceleration", "velocity")
OF_BASE = ("ties", "rotation", "right", "turn", "ground")
OF_SWING = ("swing", "right_swing")
OF_SHIFT = ("slip", "slipping", "heave", "heaving")
OF_JOINTS = ("joint", "right_joint", "joint_turn", "joint_spin", "right_joint_spin", "joint_force")
TIES, ROTATION, RIGHT_ROTATION, TURN, GROUND = -5, -4, -3, -2, -1  # columns of `Quantities.shares`


@dataclass(frozen=True, eq=False)
class Quantities:
    """F quantities, each a weighted sum of displacements, accelerations and the velocity of the rotation.

    Attributes
    ----------
    shares : ndarray, shape (F, 4 N + 5)
        Weights of D_n (`displacement`), of the restoring acceleration of each mode (`restoring`: ω_n² D_n, or that of
        Eq. 37 or of stories that yield), of D''_n (`acceleration`), of D'_n (`velocity`), of the pull of ties from a
        height (`ties`), of θ (`rotation`), of θ while the base rotates about its right pivot (`right`), of θ''
        (`turn`) and of the acceleration of the base (`ground`).
    swings : ndarray, shape (F, 2)
        Weights of θ' (`swing`), and of θ' while the base rotates about its right pivot (`right_swing`).
    shifts : ndarray, shape (F, 4)
        Weights of the `slip` and the `heave` of the base and of their rates (`slipping`, `heaving`), in models that
        have them.
    joints : ndarray, shape (F, 6, J)
        Weights of the rotation of each joint above the base (`joint`), of that while it is open to the right
        (`right_joint`), of its acceleration (`joint_turn`), of its rate, likewise (`joint_spin`, `right_joint_spin`),
        and of its axial force (`joint_force`).
    kinds : ndarray, shape (F,)
        Kind of the quantity for large rotations; see `rockflex.models._quantities`.
    """

    shares: Array
    swings: Array
    shifts: Array
    joints: Array
    kinds: NDArray[np.int64]

    @classmethod
    def of(cls, count: int, modes: int, kind: int = LINEAR, **shares: ArrayLike) -> "Quantities":
        """Return `count` quantities of a model with the given number of modes; shares not given are zero."""
        values = np.zeros((count, len(OF_MODES) * modes + len(OF_BASE)))
        swings, shifts = np.zeros((count, len(OF_SWING))), np.zeros((count, len(OF_SHIFT)))
        joints = _joint_shares(count, shares)
        for name, share in shares.items():
            if name in OF_JOINTS:
                joints[:, OF_JOINTS.index(name)] = share
            elif name in OF_SWING:
                swings[:, OF_SWING.index(name)] = share
            elif name in OF_SHIFT:
                shifts[:, OF_SHIFT.index(name)] = share
            else:
                values[:, _columns(modes)[name]] = share
        return cls(values, swings, shifts, joints, np.full(count, kind, dtype=np.int64))

    @classmethod
    def none(cls, modes: int) -> "Quantities":
        """Return an empty set of quantities."""
        return cls.of(0, modes)

    def __len__(self) -> int:
        return self.kinds.size

    def __add__(self, other: "Quantities") -> "Quantities":
        return joined_quantities((self, other))

    @property
    def levers(self) -> Array:
        """Additional coefficients of quantities that are nonlinear in large rotations, (F, 2); see above."""
        rotation, turn, ground = (self.shares[:, column] for column in (ROTATION, TURN, GROUND))
        near = np.where(
            (self.kinds == SWAY) | (self.kinds == LIFT), rotation, np.where(self.kinds == LEFT_OUT, -ground, 0.0)
        )
        return np.column_stack((near, np.where(self.kinds == LEFT_OUT, -turn, 0.0)))


def _joint_shares(count: int, *shares: Mapping[str, ArrayLike]) -> Array:
    """Return blank weights for the joints of some shares, as many as the most that one names."""
    most = max(
        [np.shape(share)[-1] for given in shares for name, share in given.items() if name in OF_JOINTS], default=0
    )
    return np.zeros((count, len(OF_JOINTS), most))


@lru_cache(maxsize=256)
def _columns(modes: int) -> dict[str, slice | int]:
    """Return the places of the shares in a row of `Quantities.shares`, by name."""
    of_modes = {name: slice(k * modes, (k + 1) * modes) for k, name in enumerate(OF_MODES)}
    return of_modes | {name: k - len(OF_BASE) for k, name in enumerate(OF_BASE)}


def collected_quantities(modes: int, shares: Sequence[Share]) -> Quantities:
    """Return one quantity for each pair of kind and shares."""
    count, columns = len(shares), _columns(modes)
    values, shifts = np.zeros((count, len(OF_MODES) * modes + len(OF_BASE))), np.zeros((count, len(OF_SHIFT)))
    joints = _joint_shares(count, *(given for _, given in shares))
    for k, (_, given) in enumerate(shares):
        for name, share in given.items():
            if name in columns:
                values[k, columns[name]] = share
            elif name in OF_SHIFT:
                shifts[k, OF_SHIFT.index(name)] = share
            else:
                joints[k, OF_JOINTS.index(name), : np.shape(share)[-1]] = share
    kinds = np.array([kind for kind, _ in shares], dtype=np.int64)
    return Quantities(values, np.zeros((count, len(OF_SWING))), shifts, joints, kinds)


def joined_quantities(parts: Sequence[Quantities]) -> Quantities:
    """Return all quantities of the parts, in their order."""
    if len(parts) == 1:
        return parts[0]
    shares, swings, shifts, kinds = (
        np.concatenate([getattr(part, name) for part in parts]) for name in ("shares", "swings", "shifts", "kinds")
    )
    return Quantities(shares, swings, shifts, _beside_one_another([part.joints for part in parts]), kinds)


def _beside_one_another(parts: Sequence[Array]) -> Array:
    """Return the weights of joints of all parts, of which some know none."""
    most = max((part.shape[-1] for part in parts), default=0)
    if not most:  # as nearly always, where padding would take longer than all else
        return np.zeros((sum(map(len, parts)), len(OF_JOINTS), 0))
    return np.concatenate(
        [
            np.zeros((0, len(OF_JOINTS), most)),
            *(np.pad(part, ((0, 0), (0, 0), (0, most - part.shape[-1]))) for part in parts),
        ]
    )


def rows_of_quantities(model: RockingModel, quantities: Quantities, key: Key) -> Array:
    """Return the rows of the quantities in one phase, shape (F, C).

    While a complete model rocks, the row of a nonlinear quantity contains only its displacements and forces;
    `RockingField.observe` adds the rest.
    """
    shares = quantities.shares
    large = bool(model.bends(key[0]))
    if large:
        bends = quantities.kinds != LINEAR
        shares = shares.copy()
        for column in (ROTATION, RIGHT_ROTATION, GROUND):
            shares[bends, column] = 0.0
    rows = by_rows(shares, _moving(model, key, large=large))
    if model.is_free(key) and quantities.swings.any():
        rows[:, model.layout.spin] += quantities.swings @ (1.0, float(key[0] == RIGHT))
    slip, heave = model.layout.slip, model.layout.heave
    places = slip, slip + 1 if slip >= 0 else -1, heave, heave + 1 if heave >= 0 else -1
    for place, weights in zip(places, quantities.shifts.T, strict=True):
        if place >= 0:
            rows[:, place] += weights
    if quantities.joints.shape[-1]:
        _add_joints(model, quantities, key, rows)
    return rows


def _add_joints(model: RockingModel, quantities: Quantities, key: Key, rows: Array) -> None:
    """Add what the joints above the base contribute to the rows of quantities; nothing where the base is fixed."""
    places, stance = model.layout.rotations[1:], model.stance(key)
    if not places:
        return
    turn, right_turn, turning, spin, right_spin, force = quantities.joints.swapaxes(0, 1)
    right = np.array(stance[1:]) == RIGHT
    rows[:, places] += turn + right_turn * right
    rows[:, [place + 1 for place in places]] += spin + right_spin * right
    rows += turning @ model.accelerations(key)[-len(places) :]
    if force.any():
        rows += force @ model.axial_forces(key)


def _moving(model: RockingModel, key: Key, *, large: bool) -> Array:
    """Return the rows, in one phase, that `Quantities.shares` multiply, (4 N + 5, C); no accelerations if `large`."""
    n, layout = model.properties.n_modes, model.layout
    rows = np.zeros((len(OF_MODES) * n + len(OF_BASE), layout.columns))
    modes = np.arange(n)
    rows[modes, modes] = rows[3 * n + modes, n + modes] = 1.0
    rows[n : 2 * n] = model.restoring_in(key)
    rows[TIES] = model.ties(key)
    rows[ROTATION, layout.rotation] = 1.0
    rows[RIGHT_ROTATION, layout.rotation] = key[0] == RIGHT
    rows[GROUND, -2] = 1.0
    if layout.slip >= 0 and not large:  # the base moves with the ground and slides on it
        rows[GROUND] += model.accelerations(key)[n + 1]
    if not large:
        rows[2 * n : 3 * n] = model.modal_accelerations(key)
        if model.is_free(key):
            rows[TURN] = model.angular_acceleration(key)
    return rows
